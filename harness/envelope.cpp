#include "harness/envelope.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "harness/magnitude.h"
#include "harness/pulls.h"

namespace plumb::harness {
namespace {

// Finite differences of the truth's velocities, from which the bounds' growth with the motion is computed.
struct Differences {
  std::optional<Vec2d> acceleration, jerk;
  std::optional<double> angular_acceleration, angular_jerk;
};

// Feedback of angle errors through the forces at a given time.
struct Feedback {
  double acceleration_per_rad = 0, angular_acceleration_per_rad = 0;
};

Feedback feedback_at(const Scene& scene, std::size_t body, double from, double to) {
  Feedback feedback;
  for (const ForceLaw& law : scene.forces) {
    const auto* force = std::get_if<PointForce>(&law);
    if (force == nullptr || find_body(scene, force->body) != body) continue;
    if (to <= force->start || from >= force->start + force->duration) continue;
    const Body& target = scene.bodies[body];
    if (force->frame == Frame::Body) {
      feedback.acceleration_per_rad += magnitude(force->force) / target.mass;
    } else if (!target.fixed_rotation) {
      feedback.angular_acceleration_per_rad +=
          magnitude(force->force) * magnitude(force->point) / inertia_of(target);
    }
  }
  return feedback;
}

// A jump that an engine may show earlier or later by `delay`.
struct Window {
  std::size_t body;
  double time, delay;
  Vec2d velocity;
  double angular_velocity;
};

// Bounds by component.
struct Parts {
  Vec2d position{}, velocity{};
  double angle = 0, angular_velocity = 0;
};

Vec2d absolute(Vec2d v) { return {std::abs(v.x), std::abs(v.y)}; }

// Returns the largest component along the unit vector `n` of a vector within `bound`.
double along(Vec2d bound, Vec2d n) { return dot(bound, absolute(n)); }

StateBound total(const Parts& parts) {
  return {magnitude(parts.position), parts.angle, magnitude(parts.velocity), parts.angular_velocity};
}

// Groups the dynamic bodies that joints connect, directly or through each other. Single bodies are left out.
std::vector<std::vector<std::size_t>> jointed_groups(const Scene& scene) {
  std::vector<std::size_t> parent(scene.bodies.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto moving = [&](const std::string& name) {
    const auto body = find_body(scene, name);
    return body && scene.bodies[*body].type == BodyType::Dynamic ? body : std::nullopt;
  };
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          const auto a = moving(j.body_a), b = moving(j.body_b);
          if (a && b) parent[root(*a)] = root(*b);
        },
        joint);
  }
  std::vector<std::vector<std::size_t>> by_root(scene.bodies.size());
  for (std::size_t i = 0; i < parent.size(); ++i) by_root[root(i)].push_back(i);
  std::erase_if(by_root, [](const auto& group) { return group.size() < 2; });
  return by_root;
}

class Growth {
 public:
  Growth(const scenarios::Problem& problem, const TruthTable& truth, const reference::Method& method,
         double tolerance)
      : problem_(problem), truth_(truth), method_(method), tolerance_(tolerance), impacts_(truth.impacts()) {
    const std::size_t bodies = truth.bodies();
    now_.resize(bodies);
    differences_.resize(bodies);
    growth_.resize(bodies);
    held_.resize(bodies);
    pulled_.resize(bodies);
    levers_.resize(bodies);
    groups_ = jointed_groups(problem.scene);
    if (method.order == 1) start_joints();
    has_turning_force_.resize(bodies, false);
    for (const ForceLaw& law : problem.scene.forces)
      has_pulls_ = has_pulls_ || std::holds_alternative<SpringForce>(law) ||
                   std::holds_alternative<AttractionForce>(law);
    for (const ForceLaw& law : problem.scene.forces)
      if (const auto* force = std::get_if<PointForce>(&law))
        if (const auto body = find_body(problem.scene, force->body)) has_turning_force_[*body] = true;
  }

  std::vector<StateBound> run() {
    std::vector<StateBound> out;
    out.reserve((static_cast<std::size_t>(truth_.steps()) + 1) * truth_.bodies());
    keep(out);
    const long samples = static_cast<long>(truth_.steps()) * truth_.refinement();
    for (long i = 1; i <= samples; ++i) {
      interval(i);
      if (i % truth_.refinement() == 0) keep(out);
    }
    for (const Window& window : windows_) open(window, out);
    return out;
  }

 private:
  // Joint forces start from free fall, so their first value counts as a change.
  void start_joints() {
    for (const Joint& joint : problem_.scene.joints) {
      std::visit(
          [&](const auto& j) {
            if constexpr (requires { j.anchor_a; }) add_lever(j.body_a, j.anchor_a);
            if constexpr (requires { j.anchor_b; }) add_lever(j.body_b, j.anchor_b);
            for (const std::string& name : {j.body_a, j.body_b})
              if (const auto body = find_body(problem_.scene, name))
                differences_[*body] = {problem_.scene.bodies[*body].gravity_scale * problem_.scene.gravity,
                                       std::nullopt, 0.0, std::nullopt};
          },
          joint);
    }
  }

  void add_lever(const std::string& name, Vec2d anchor) {
    if (const auto body = find_body(problem_.scene, name))
      levers_[*body] = std::max(levers_[*body], magnitude(anchor));
  }

  double substep() const { return method_.substep; }
  bool adaptive() const { return method_.order == 0; }

  void keep(std::vector<StateBound>& out) const {
    const double h = substep() * (1 + kRoundings * method_.epsilon);
    for (std::size_t body = 0; body < now_.size(); ++body) {
      StateBound bound = total(now_[body]);
      const double late = h * held_[body];
      const double turning = late * turn_per_push(body, bounding_radius(problem_.scene.bodies[body])) +
                             h * pulled_[body] * turn_per_push(body, levers_[body]);
      bound.velocity += late;
      bound.position += h * late;
      bound.angular_velocity += turning;
      bound.angle += h * turning;
      out.push_back(bound);
    }
  }

  // Returns the angular acceleration that a force at a lever arm causes, per linear acceleration.
  double turn_per_push(std::size_t index, double lever) const {
    const Body& body = problem_.scene.bodies[index];
    if (lever == 0 || body.type != BodyType::Dynamic || body.fixed_rotation) return 0;
    return body.mass * lever / inertia_of(body);
  }

  // Adds the error of persistent contact forces that act a substep early or late. The contacts correct this
  // error perpendicular to the permitted motion, so it does not accumulate there (`held_`). Along the motion
  // it stays, from the start of the contact on.
  void hold(std::size_t index, Vec2d acceleration, double angular_acceleration, Vec2d velocity, bool begins,
            Parts& growth) {
    const Body& body = problem_.scene.bodies[index];
    const Vec2d force = acceleration - body.gravity_scale * problem_.scene.gravity;
    held_[index] = std::max(held_[index], magnitude(force));
    const double speed = magnitude(velocity);
    if (!begins) return;
    if (speed > 0)
      growth.velocity += substep() * std::abs(dot(force, velocity)) / (speed * speed) * absolute(velocity);
    growth.angular_velocity += substep() * std::abs(angular_acceleration);
  }

  void interval(long i) {
    const double from = truth_.fine_time(i - 1), to = truth_.fine_time(i);
    const auto before = truth_.fine(i - 1), after = truth_.fine(i);
    for (std::size_t body = 0; body < now_.size(); ++body) {
      const bool moves = problem_.scene.bodies[body].type == BodyType::Dynamic;
      growth_[body] = moves ? growth_of(body, before[body], after[body], from, to) : Parts{};
    }
    for (const std::vector<std::size_t>& group : groups_) share(group);
    if (has_pulls_)
      for (const Pull& pull : pulls_in(problem_.scene, before)) feed_back(pull, to - from);
    for (std::size_t body = 0; body < now_.size(); ++body) grow(body, from, to);
    while (next_impact_ < impacts_.size() && impacts_[next_impact_].time <= to + kImpactMargin)
      collide(impacts_[next_impact_++]);
  }

  // Applies the worst bounds of a group of jointed bodies to each of them.
  void share(const std::vector<std::size_t>& group) {
    Parts worst;
    for (const std::size_t body : group) {
      const Parts& own = growth_[body];
      worst.position = {std::max(worst.position.x, own.position.x),
                        std::max(worst.position.y, own.position.y)};
      worst.velocity = {std::max(worst.velocity.x, own.velocity.x),
                        std::max(worst.velocity.y, own.velocity.y)};
      worst.angle = std::max(worst.angle, own.angle);
      worst.angular_velocity = std::max(worst.angular_velocity, own.angular_velocity);
    }
    for (const std::size_t body : group) growth_[body] = worst;
  }

  bool jumps_within(std::size_t body, double from, double to) const {
    // Impacts at the very time of a sample corrupt the differences on both of its sides.
    for (std::size_t k = next_impact_ == 0 ? 0 : next_impact_ - 1; k < impacts_.size(); ++k) {
      if (impacts_[k].time > to + kImpactMargin) break;
      if (impacts_[k].time < from - kImpactMargin) continue;
      for (const Jump& jump : impacts_[k].jumps)
        if (jump.body == body) return true;
    }
    return false;
  }

  // Returns the growth of the bounds caused by the method, from one sample of the truth to the next.
  Parts growth_of(std::size_t body, const BodyState& before, const BodyState& after, double from, double to) {
    const double span = to - from, h = substep();
    Differences& last = differences_[body];
    if (adaptive()) {
      const double part = Envelope::kAdaptiveSteps * tolerance_ * span / truth_.dt();
      const Scale& scale = truth_.scale();
      return {part * scale.extent * Vec2d{1, 1}, part * scale.speed * Vec2d{1, 1}, part * scale.angle,
              part * scale.angular_speed};
    }
    if (jumps_within(body, from, to)) {
      last = {};
      return {};
    }
    const Vec2d acceleration = (1 / span) * (after.velocity - before.velocity);
    const double angular_acceleration = (after.angular_velocity - before.angular_velocity) / span;
    const Vec2d change = last.acceleration ? acceleration - *last.acceleration : Vec2d{};
    const double angular_change =
        last.angular_acceleration ? angular_acceleration - *last.angular_acceleration : 0;
    Parts growth;
    pulled_[body] = std::max(
        pulled_[body],
        magnitude(acceleration - problem_.scene.bodies[body].gravity_scale * problem_.scene.gravity));
    if (problem_.truth.contacts_last)
      hold(body, acceleration, angular_acceleration, after.velocity, !last.acceleration, growth);
    if (method_.order == 1) {
      growth.position = h * span * absolute(acceleration);
      growth.velocity += h * absolute(change);
      growth.angle = h * span * std::abs(angular_acceleration);
      growth.angular_velocity += h * std::abs(angular_change);
    } else {
      const Vec2d jerk = (1 / span) * change;
      const double angular_jerk = angular_change / span;
      growth.position = h * h * absolute(change);
      growth.angle = h * h * std::abs(angular_change);
      if (last.jerk) growth.velocity += h * h * absolute(jerk - *last.jerk);
      if (last.angular_jerk) growth.angular_velocity += h * h * std::abs(angular_jerk - *last.angular_jerk);
      if (last.acceleration) last.jerk = jerk;
      if (last.angular_acceleration) last.angular_jerk = angular_jerk;
    }
    last.acceleration = acceleration;
    last.angular_acceleration = angular_acceleration;
    return growth;
  }

  // Adds the change of a law's force due to the existing errors, on velocity and spin.
  void feed_back(const Pull& pull, double span) {
    const Body& body = problem_.scene.bodies[pull.body];
    if (body.type != BodyType::Dynamic) return;
    const auto error = [&](std::size_t of, double arm) {
      const Parts& bound = now_[of];
      return pull.stiffness * (magnitude(bound.position) + arm * bound.angle) +
             pull.damping * (magnitude(bound.velocity) + arm * bound.angular_velocity);
    };
    const double off =
        error(pull.body, pull.arm) + (pull.partner ? error(*pull.partner, pull.partner_arm) : 0);
    now_[pull.body].velocity += span * off / body.mass * Vec2d{1, 1};
    const double inertia = inertia_of(body);
    if (inertia > 0)
      now_[pull.body].angular_velocity +=
          span * pull.arm * (off + pull.force * now_[pull.body].angle) / inertia;
  }

  void grow(std::size_t body, double from, double to) {
    const double span = to - from;
    const Parts& growth = growth_[body];
    Parts& bound = now_[body];
    const Feedback feedback =
        has_turning_force_[body] ? feedback_at(problem_.scene, body, from, to) : Feedback{};
    bound.angular_velocity +=
        growth.angular_velocity + feedback.angular_acceleration_per_rad * bound.angle * span;
    bound.angle += growth.angle + bound.angular_velocity * span;
    const double turned = feedback.acceleration_per_rad * bound.angle * span;
    bound.velocity += growth.velocity + Vec2d{turned, turned};
    bound.position += growth.position + bound.velocity * span;
  }

  void collide(const Impact& impact) {
    const std::vector<Parts> before = now_;
    const double time = impact.time, step = adaptive() ? tolerance_ * truth_.scale().duration : substep();
    const StateBound rounding = rounding_bound(truth_.scale(), method_.epsilon, time / substep(), time);
    for (const Jump& jump : impact.jumps) {
      Parts& bound = now_[jump.body];
      Vec2d position = before[jump.body].position + rounding.position * Vec2d{1, 1};
      Vec2d velocity = before[jump.body].velocity + rounding.velocity * Vec2d{1, 1};
      if (jump.partner) {
        position += before[*jump.partner].position;
        velocity += before[*jump.partner].velocity;
      }
      const Vec2d normal = jump.normal, tangent = perpendicular(jump.normal);
      const double closing = std::max(jump.closing, 1e-12);
      const double delay = std::min(step + along(position, normal) / closing, truth_.scale().duration);
      const double lever = std::max(jump.distance - closing * delay, jump.distance / 10);
      const double turn = (jump.sliding * delay + along(position, tangent)) / lever;
      const double gained = std::abs(dot(relative_gravity(jump), normal)) * delay;
      const double share = (turn * jump.sliding + along(velocity, normal) + gained) / closing;
      const double size = magnitude(jump.velocity);
      bound.velocity += size * (share * absolute(normal) + turn * absolute(tangent));
      bound.angular_velocity +=
          jump.angular_velocity * (share + turn) + size * spin_of_arm(jump, delay, position);
      bound.position += delay * absolute(jump.velocity);
      bound.angle += jump.angular_velocity * delay;
      windows_.push_back({jump.body, time, delay, jump.velocity, jump.angular_velocity});
    }
  }

  // Returns the relative acceleration by gravity towards the other body of an impact, which acts until the
  // engine detects the impact.
  Vec2d relative_gravity(const Jump& jump) const {
    double scale = problem_.scene.bodies[jump.body].gravity_scale;
    if (jump.partner && problem_.scene.bodies[*jump.partner].type == BodyType::Dynamic)
      scale -= problem_.scene.bodies[*jump.partner].gravity_scale;
    return scale * problem_.scene.gravity;
  }

  // Returns the angular velocity per unit of the velocity jump: the impulse's lever arm is off by the error
  // of the contact point. The arm of a disc lies along the normal for any contact point.
  double spin_of_arm(const Jump& jump, double delay, Vec2d position) const {
    const Body& body = problem_.scene.bodies[jump.body];
    if (body.fixed_rotation || body.type != BodyType::Dynamic) return 0;
    const auto central = [](const Shape& shape) {
      return std::holds_alternative<Circle>(shape.geometry) && shape.position == Vec2d{};
    };
    if (std::all_of(body.shapes.begin(), body.shapes.end(), central)) return 0;
    const double arm = jump.sliding * delay + along(position, perpendicular(jump.normal));
    return arm * body.mass / inertia_of(body);
  }

  void open(const Window& window, std::vector<StateBound>& out) const {
    const double dt = truth_.dt();
    const int first = std::max(0, static_cast<int>(std::floor((window.time - window.delay) / dt)));
    const int last = std::min(truth_.steps(), static_cast<int>(std::ceil((window.time + window.delay) / dt)));
    for (int k = first; k <= last; ++k) {
      const double time = k * dt;
      if (std::abs(time - window.time) > window.delay * (1 + 1e-9)) continue;
      StateBound& bound = out[static_cast<std::size_t>(k) * now_.size() + window.body];
      bound.velocity += magnitude(window.velocity);
      bound.angular_velocity += window.angular_velocity;
      if (time < window.time) {
        bound.position += magnitude(window.velocity) * window.delay;
        bound.angle += window.angular_velocity * window.delay;
      }
    }
  }

  const scenarios::Problem& problem_;
  const TruthTable& truth_;
  const reference::Method& method_;
  double tolerance_;
  const std::vector<Impact>& impacts_;
  std::size_t next_impact_ = 0;
  std::vector<Parts> now_;
  std::vector<Differences> differences_;
  std::vector<Parts> growth_;
  // Largest acceleration so far by a body's persistent contacts, and by everything except gravity, m/s^2.
  std::vector<double> held_, pulled_;
  std::vector<double> levers_;  // m, from a body's centre to its farthest joint
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<bool> has_turning_force_;
  bool has_pulls_ = false;
  std::vector<Window> windows_;
};

}  // namespace

StateBound rounding_bound(const Scale& scale, double epsilon, double steps, double time) {
  const double share = kRoundings * epsilon * (steps + 1);
  const double once = kRoundings * epsilon;
  const double gap_speed = time > 0 ? once * scale.joint_length * steps / time : 0;
  const double spin = share * scale.angular_speed + once * scale.impact_spin;
  return {.position = share * (scale.length + scale.extent + scale.speed * time),
          .angle = share * (scale.angle + scale.joint_length / scale.joint_arm) + spin * time,
          .velocity = share * scale.speed + gap_speed,
          .angular_velocity = spin + gap_speed / scale.joint_arm};
}

Envelope::Envelope(const scenarios::Problem& problem, const TruthTable& truth,
                   const reference::Method& method, double tolerance)
    : bodies_(truth.bodies()), bounds_(Growth(problem, truth, method, tolerance).run()) {}

}  // namespace plumb::harness
