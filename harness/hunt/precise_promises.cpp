// Judges Precise beyond its motion: forces, derivatives, error estimates, refusals, methods that
// agree, and its laws of impact and friction.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <sys/resource.h>

#include "engine/driver/sensitivity.h"
#include "engine/scene/error.h"
#include "engine/scene/number.h"
#include "engine/simulation/simulation.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"
#include "harness/hunt/subject.h"
#include "harness/isolate.h"

namespace plumb::harness::hunt {
namespace {

constexpr rlim_t kSeconds = 2;          // processor time limit
constexpr std::size_t kMostBodies = 8;  // dynamic ones, of a scene that is run several times

/// Runs a check in a process of its own, for as long as it may take, and objects with what it returns.
Verdict judged(const char* name, const char* right, const std::function<std::string()>& check) {
  const Outcome outcome = isolate(
      [&]() -> std::string {
        const rlimit limit{kSeconds, kSeconds + 1};
        setrlimit(RLIMIT_CPU, &limit);
        try {
          return check();
        } catch (const Error&) {
          return {};
        }
      },
      20.0 * kSeconds);
  if (outcome.kind != Outcome::Kind::Done || outcome.text.empty()) return {};
  return Objection{.law = name, .judge = name, .what = outcome.text, .right = right};
}

std::size_t dynamic_bodies(const Scene& scene) {
  return static_cast<std::size_t>(
      std::count_if(scene.bodies.begin(), scene.bodies.end(),
                    [](const Body& body) { return body.type == BodyType::Dynamic; }));
}

std::int64_t events_of(const Statistics& of) {
  std::int64_t sum = of.impacts;
  for (const EventCount& each : of.contacts) sum += each.count;
  return sum;
}

std::vector<BodyState> states_of(const Simulation& run) {
  std::vector<BodyState> out(run.body_count());
  run.read(out);
  return out;
}

double distance(const Scene& scene, const std::vector<double>& reach, const std::vector<BodyState>& a,
                const std::vector<BodyState>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (scene.bodies[i].type == BodyType::Dynamic)
      most = std::max(most,
                      length(a[i].position - b[i].position) + reach[i] * std::abs(a[i].angle - b[i].angle));
  return most;
}

// Checks that the forces of joints and contacts, with gravity and damping, explain the accelerations.
std::string balanced(const Case& one) {
  const Scene& scene = one.scene;
  for (const Joint& joint : scene.joints)
    if (std::holds_alternative<PulleyJoint>(joint) || std::holds_alternative<GearJoint>(joint)) return {};
  for (const Body& body : scene.bodies)
    for (const Shape& shape : body.shapes)
      if (shape.rolling_resistance != 0) return {};
  if (!scene.forces.empty() || dynamic_bodies(scene) > kMostBodies) return {};
  Random random(one.seed, one.index + 53);
  const double h = one.dt / 20;
  Simulation run = compile(scene, Precise{.tolerance = 1e-11, .max_dt = h});
  for (int look = 0; look < 4; ++look) {
    run.step(random.whole(5, 150));
    std::vector<std::vector<BodyState>> at;
    const std::int64_t before = events_of(run.statistics());
    Reactions forces;
    for (int k = 0; k < 5; ++k) {
      at.push_back(states_of(run));
      if (k == 2) forces = run.forces();
      if (k < 4) run.step();
    }
    if (events_of(run.statistics()) != before) continue;
    struct Load {
      Vec2d force{};
      double torque = 0, size = 0, turning = 0;
    };
    std::vector<Load> loads(scene.bodies.size());
    const auto push = [&](std::optional<std::size_t> body, Vec2d force, double torque, Vec2d point) {
      if (!body) return;
      Load& to = loads[*body];
      const Vec2d arm = point - at[2][*body].position;
      to.force += force, to.torque += torque + cross(arm, force);
      to.size += length(force), to.turning += std::abs(torque) + length(arm) * length(force);
    };
    for (std::size_t i = 0; i < forces.joints.size() && i < scene.joints.size(); ++i) {
      const JointReaction& of = forces.joints[i];
      std::visit(
          [&](const auto& joint) {
            push(find_body(scene, joint.body_b), of.force, of.torque, of.position);
            push(find_body(scene, joint.body_a), -1.0 * of.force, -of.torque, of.position);
          },
          scene.joints[i]);
    }
    for (const ContactReaction& of : forces.contacts) {
      const Vec2d tangent{-of.normal.y, of.normal.x},
          force = of.normal_force * of.normal + of.tangent_force * tangent;
      if (of.normal_force < -1e-9) return fmt::format("a contact pulls with {:.3g} N", -of.normal_force);
      push(of.body_b, force, 0, of.position), push(of.body_a, -1.0 * force, 0, of.position);
    }
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Body& body = scene.bodies[i];
      const double inertia = body.type == BodyType::Dynamic ? inertia_of(body) : 0;
      if (inertia == 0 || body.lock_x || body.lock_y) continue;
      const auto rate = [&](auto of) {
        return (1 / (12 * h)) * (8.0 * (of(at[3][i]) - of(at[1][i])) - (of(at[4][i]) - of(at[0][i])));
      };
      const auto rough = [&](auto of) { return (1 / (2 * h)) * (of(at[3][i]) - of(at[1][i])); };
      const auto velocity = [](const BodyState& s) { return s.velocity; };
      const auto spin = [](const BodyState& s) { return s.angular_velocity; };
      const BodyState& now = at[2][i];
      const Vec2d own = body.mass * (body.gravity_scale * scene.gravity - body.linear_damping * now.velocity);
      const Vec2d missing = body.mass * rate(velocity) - own - loads[i].force;
      const double turning =
          inertia * (rate(spin) + body.angular_damping * now.angular_velocity) - loads[i].torque;
      // A difference of order two is off by more than that of order four by far.
      const double slack = body.mass * length(rate(velocity) - rough(velocity)),
                   slack_turn = inertia * std::abs(rate(spin) - rough(spin));
      const double rounding = 1e-11 / h * (body.mass * (length(now.velocity) + 1) + inertia);
      const double bound = 1e-4 * (loads[i].size + length(own)) + slack + rounding,
                   bound_turn = 1e-4 * loads[i].turning + slack_turn + rounding;
      if (length(missing) > bound)
        return fmt::format("'{}' accelerates by {:.5g} N more than its forces, of {:.5g} N in all", body.name,
                           length(missing), loads[i].size + length(own));
      if (std::abs(turning) > bound_turn)
        return fmt::format("'{}' is turned by {:.5g} N m more than its torques, of {:.5g} N m in all",
                           body.name, std::abs(turning), loads[i].turning);
    }
  }
  return {};
}

/// Returns a number of the scene by which its motion may be differentiated.
std::string some_parameter(const Scene& scene, Random& random) {
  std::vector<std::string> names{"gravity.y"};
  for (const Body& body : scene.bodies) {
    const std::string of = "bodies." + body.name + ".";
    if (!body.shapes.empty()) {
      names.push_back(of + "shapes.friction"), names.push_back(of + "shapes.restitution");
      names.push_back(of + "shapes.restitution");
    }
    if (body.type != BodyType::Dynamic) continue;
    for (const char* number : {"mass", "position.y", "velocity.x", "velocity.y", "angular_velocity"})
      names.push_back(of + number);
  }
  return random.pick(names);
}

// Derivatives by a number of the scene are those of runs in which it differs a little, to either side.
std::string derived(const Case& one) {
  const Scene& scene = one.scene;
  if (dynamic_bodies(scene) > 4 || has_formulas(scene)) return {};
  Random random(one.seed, one.index + 59);
  const std::string name = some_parameter(scene, random);
  const int steps = std::min(one.steps, random.whole(5, 60));
  Scene changed = scene;
  const std::vector<double*> numbers = numbers_at(changed, name);
  if (numbers.empty()) return {};
  std::vector<double> usual;
  for (const double* each : numbers) usual.push_back(*each);
  if (usual.front() == 0 && kind_of_number(name) == NumberKind::Relative &&
      name.find("velocity") == std::string::npos)
    return {};
  const double scale = std::max(std::abs(usual.front()), 1.0), step = 1e-5 * scale;
  const Precise accuracy{.tolerance = 1e-12, .max_dt = one.dt};
  Simulation run = compile(scene, accuracy, {.parameters = {name}});
  run.step(steps);
  std::vector<BodyState> answer;
  try {
    answer = run.sensitivities(0);
  } catch (const NotDifferentiable&) {
    return {};
  }
  const std::int64_t events = events_of(run.statistics());
  const std::vector<BodyState> here = states_of(run);
  struct Beside {
    std::vector<BodyState> states;
    bool same = false;  // events
  };
  const auto beside = [&](double by) {
    for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = usual[i] + by;
    Simulation other = compile(changed, accuracy);
    other.step(steps);
    return Beside{states_of(other), events_of(other.statistics()) == events};
  };
  const Beside up = beside(step), up2 = beside(step / 2), down = beside(-step), down2 = beside(-step / 2);
  if (!up.same || !up2.same || !down.same || !down2.same) return {};
  const auto differs = [&](auto of, double size, const char* what) -> std::string {
    double most = 0;
    for (const BodyState& each : answer) most = std::max(most, std::abs(of(each)) * size);
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (scene.bodies[i].type != BodyType::Dynamic) continue;
      const double x = of(here[i]);
      const double right = (of(up.states[i]) - x) / step, right2 = (of(up2.states[i]) - x) / (step / 2),
                   left = (x - of(down.states[i])) / step, left2 = (x - of(down2.states[i])) / (step / 2);
      // Each side's own limit, by Richardson; sides that do not settle are not known.
      const double to_right = 2 * right2 - right, to_left = 2 * left2 - left;
      const double settled = std::abs(right2 - right) + std::abs(left2 - left);
      const double scale_of =
          std::abs(to_right) + std::abs(to_left) + most + 1e-3 * (1 + std::abs(x)) / scale;
      if (settled > 0.02 * scale_of) continue;
      const double found = of(answer[i]);
      if (std::abs(found - to_right) > 0.02 * scale_of || std::abs(found - to_left) > 0.02 * scale_of)
        return fmt::format("d {} of '{}' / d {} is {:.6g} and {:.6g} to either side, not {:.6g}", what,
                           scene.bodies[i].name, name, to_left, to_right, found);
    }
    return {};
  };
  const std::string wrong = differs([](const BodyState& s) { return s.position.x; }, 1, "x") +
                            differs([](const BodyState& s) { return s.position.y; }, 1, "y") +
                            differs([](const BodyState& s) { return s.angle; }, 1, "angle");
  return wrong;
}

// Checks that the estimate of the error is of the error's size.
std::string estimated(const Case& one) {
  if (dynamic_bodies(one.scene) > kMostBodies) return {};
  const int steps = std::min(one.steps, 60);
  const Precise rough{.tolerance = 1e-3, .max_dt = one.dt, .estimate_error = true},
      fine{.tolerance = 1e-11, .max_dt = one.dt};
  Simulation run = compile(one.scene, rough), truth = compile(one.scene, fine);
  double off = 0;
  for (int k = 0; k < steps; ++k) {
    run.step(), truth.step();
    // An event may be met in one of them alone.
    if (events_of(run.statistics()) > 0 || events_of(truth.statistics()) > 0) return {};
    const auto a = states_of(run), b = states_of(truth);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (one.scene.bodies[i].type == BodyType::Dynamic)
        off = std::max(off, length(a[i].position - b[i].position));
  }
  const ErrorEstimate error = run.statistics().error;
  if (!error.known) return "does not know the error that it was asked to estimate";
  // "Within a factor of ten" on motions that are named; of any motion a thousand.
  if (off > 1e-10 * largest_size(one.scene) && error.position < 1e-3 * off)
    return fmt::format("is off by {:.3g} m, and estimates {:.3g}", off, error.position);
  return {};
}

// Checks that a scene which starts with overlapping shapes, or with an open joint, is refused.
std::string refuses_start(const Case& one) {
  Random random(one.seed, one.index + 61);
  const double size = largest_size(one.scene);
  const auto goes_on = [&](const Scene& scene) {
    try {
      Simulation run = compile(scene, Precise{.max_dt = 1e-3});
      run.step();
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  if (!goes_on(one.scene)) return {};
  for (const Body& body : one.scene.bodies) {
    if (body.type != BodyType::Dynamic || body.shapes.empty()) continue;
    Scene scene = one.scene;
    Body other = body;
    other.name = "intruder";
    for (Shape& shape : other.shapes) shape.filter = {};
    bool meets = false;
    for (const Shape& shape : body.shapes) meets = meets || may_touch(shape.filter, Filter{});
    scene.bodies.push_back(other);
    if (meets && goes_on(scene)) return "goes on with shapes that start in each other";
    break;
  }
  for (std::size_t i = 0; i < one.scene.joints.size(); ++i) {
    Scene scene = one.scene;
    auto* hinge = std::get_if<RevoluteJoint>(&scene.joints[i]);
    if (hinge == nullptr) continue;
    hinge->anchor_a += 0.02 * size * Vec2d{random.pick({-1.0, 1.0}), random.pick({-1.0, 1.0})};
    if (goes_on(scene)) return "goes on with a hinge that starts open";
    break;
  }
  return {};
}

// Compares two methods of integration, which have nothing in common but the equations.
std::string alike_by_methods(const Case& one, const Motion& motion, const Engine& engine) {
  if (dynamic_bodies(one.scene) > kMostBodies) return {};
  const int steps = std::min(one.steps, 90);
  const auto by = [&](MotionMethod method) {
    return compile(one.scene, Precise{.tolerance = 1e-10, .max_dt = one.dt, .method = method});
  };
  Simulation first = by(MotionMethod::Explicit), second = by(MotionMethod::Implicit);
  const std::vector<double> reach = reaches(one.scene);
  const double size = largest_size(one.scene);
  std::vector<double> calm;
  for (int k = 0; k < steps; ++k) {
    first.step(), second.step();
    const double off = distance(one.scene, reach, states_of(first), states_of(second));
    if (off <= 1e-7 * size) continue;
    if (calm.empty()) calm = growth(one, engine, motion);
    const auto at = static_cast<std::size_t>(k) + 1;
    // Perturbations of 3e-5 grow to `calm`, so the tolerance's 1e-10 to 3e-6 of that.
    if (at >= calm.size() || off <= 1e-7 * size + 1e-3 * calm[at] || calm[at] > 0.03 * size) return {};
    return fmt::format("is {:.3g} m off by another method at {:.3g} s, where a perturbation is {:.2g} m", off,
                       first.time(), calm[at]);
  }
  return {};
}

/// Velocities of a body at the point where it strikes a floor, up and to the right.
struct Blow {
  double mass = 1, inertia = 1;
  Vec2d arm{};  // m, from the centre
  Vec2d velocity{};
  double spin = 0;

  double up() const { return velocity.y + spin * arm.x; }
  double along() const { return velocity.x - spin * arm.y; }
  double energy() const { return 0.5 * mass * dot(velocity, velocity) + 0.5 * inertia * spin * spin; }
  void push(double normal, double tangent) {
    velocity += (1 / mass) * Vec2d{tangent, normal};
    spin += (arm.x * normal - arm.y * tangent) / inertia;
  }
};

/// Follows an impact in many small parts (Routh), with Coulomb's friction in each.
Blow struck(Blow at, const ContactRules& rules, double e, double mu) {
  constexpr int kParts = 20000;
  const double start = std::abs(at.up()), slip = at.along(), before = at.energy();
  const double nn = 1 / at.mass + at.arm.x * at.arm.x / at.inertia, nt = -at.arm.x * at.arm.y / at.inertia,
               tt = 1 / at.mass + at.arm.y * at.arm.y / at.inertia;
  const double part = start / nn / kParts;
  const double way = slip > 0 ? 1 : -1;
  bool stopped = slip == 0;
  double normal = 0, tangent = 0, work = 0, compression = 0, taken = 0;
  bool pressed = false;
  for (int i = 0; i < 200 * kParts; ++i) {
    if (!pressed && at.up() >= 0) pressed = true, compression = normal, taken = -work, work = 0;
    if (pressed && rules.impact == ImpactRule::Poisson && normal >= (1 + e) * compression) break;
    if (pressed && rules.impact == ImpactRule::Stronge && work >= e * e * taken) break;
    double friction = -way * mu, own = part;
    if (stopped) {
      const double sticks = -nt / tt, later = mu * rules.friction_after_stop;
      friction = std::clamp(sticks, -later, later);
    }
    const double from = at.up();
    Blow then = at;
    then.push(own, friction * own);
    if (!stopped && then.along() * way <= 0) {
      // Ends this part where the slip does.
      own *= at.along() / (at.along() - then.along());
      stopped = true;
    }
    at.push(own, friction * own);
    normal += own, tangent += friction * own;
    work += 0.5 * own * (from + at.up());
  }
  if (rules.tangential_restitution > 0 && stopped && std::abs(at.along()) < 1e-6 * std::abs(slip)) {
    // The largest part of what is to be restored that friction, the gap and the energy allow.
    double low = 0, high = rules.tangential_restitution * std::abs(slip) / tt;
    const auto allowed = [&](double more) {
      Blow then = at;
      then.push(0, -way * more);
      return std::abs(tangent - way * more) <=
                 std::max(mu, mu * rules.friction_after_stop) * normal + 1e-12 &&
             then.up() >= 0 && then.energy() <= before;
    };
    if (allowed(high)) low = high;
    for (int i = 0; i < 60 && low < high; ++i)
      if (const double middle = 0.5 * (low + high); allowed(middle))
        low = middle;
      else
        high = middle;
    at.push(0, -way * low);
  }
  return at;
}

// Drops a box on a floor, on a corner or flat, and compares the velocities after the impact with the law of
// its scene. In a World only with restitution: without, impacts are left to the step's solver.
std::string blown(Random& random, const Accuracy& accuracy) {
  const bool precise = std::holds_alternative<Precise>(accuracy);
  const double s = random.ladder(0.2, 5), wide = s, high = s * random.within(0.2, 1),
               mass = random.ladder(0.1, 10);
  const double mu = random.pick({0.0, 0.1, 0.3, 0.6, 1.0}), e = random.within(precise ? 0 : 0.1, 1),
               gap = (precise ? 1e-7 : 1e-2) * s;
  const bool flat = random.chance(0.3);
  const double angle = flat ? 0 : random.within(0.15, 1.4);
  const double c = std::cos(angle), sn = std::sin(angle);
  const double speed = random.within(0.5, 3) * s;
  Scene scene{.name = "blow", .gravity = {0, 0}};
  ContactRules& rules = scene.contact_rules;
  if (precise) {
    rules.impact =
        random.pick({ImpactRule::Newton, ImpactRule::Poisson, ImpactRule::Stronge, ImpactRule::Stronge});
    if (rules.impact != ImpactRule::Newton && random.chance(0.5))
      rules.friction_after_stop = random.pick({0.0, 0.5, 0.75});
    if (rules.impact != ImpactRule::Newton && random.chance(0.4))
      rules.tangential_restitution = random.pick({0.3, 0.7, 1.0});
    if (random.chance(0.3)) rules.yield_speed = 0.2 * speed;
  }
  scene.bodies.push_back({.name = "floor",
                          .type = BodyType::Static,
                          .position = {0, -5 * s},
                          .shapes = {{.geometry = Box{40 * s, 10 * s}, .friction = mu, .restitution = e}}});
  // Arm from the centre to the lowest of the four corners.
  const Vec2d corner = flat ? Vec2d{random.pick({-0.5, 0.5}) * wide, -high / 2} : Vec2d{-wide / 2, -high / 2};
  const Vec2d arm = flat ? corner : Vec2d{c * corner.x - sn * corner.y, sn * corner.x + c * corner.y};
  Body box{.name = "box",
           .position = {-arm.x, gap - arm.y},
           .angle = angle,
           .mass = mass,
           .shapes = {{.geometry = Box{wide, high}, .friction = mu, .restitution = e}}};
  box.velocity = {random.within(-2, 2) * speed, -speed};
  const bool level = flat && random.chance(0.5);  // both corners together
  // A World meets what flies within a step; without spin it strikes as it starts.
  box.angular_velocity = level || !precise ? 0 : random.within(-1, 1) * speed / s;
  Blow blow{mass, inertia_of(box), arm, box.velocity, box.angular_velocity};
  scene.bodies.push_back(box);
  if (level && mu != 0) return {};
  if (level) blow.arm.x = 0;
  const double closing = -blow.up();
  if (closing < 0.1 * speed) return {};
  // The other corner of a flat box must open before and after.
  Blow other = blow;
  other.arm.x = -arm.x;
  if (flat && !level && other.up() < 0.05 * speed) return {};
  const double restitution = rules.yield_speed > 0 && closing > rules.yield_speed
                                 ? e * std::pow(closing / rules.yield_speed, -0.25)
                                 : e;
  Blow right = blow;
  if (rules.impact == ImpactRule::Newton) {
    const double nn = 1 / mass + blow.arm.x * blow.arm.x / blow.inertia,
                 nt = -blow.arm.x * arm.y / blow.inertia, tt = 1 / mass + arm.y * arm.y / blow.inertia,
                 wanted = (1 + restitution) * closing;
    const double slip = blow.along(), determinant = nn * tt - nt * nt;
    double normal = (wanted * tt + slip * nt) / determinant,
           tangent = -(wanted * nt + slip * nn) / determinant;
    if (std::abs(tangent) > mu * normal) {
      const double share = slip < 0 ? mu : -mu;
      normal = wanted / (nn + share * nt), tangent = share * normal;
      right.push(normal, tangent);
      if (normal < 0 || right.along() * slip < 0) return {};  // turned round: another branch
      right = blow;
    }
    right.push(normal, tangent);
    if (right.energy() > blow.energy() * (1 - 1e-9)) return {};  // scaled down: not judged here
  } else {
    right = struck(blow, rules, restitution, mu);
  }
  other.velocity = right.velocity, other.spin = right.spin;
  if (flat && !level && other.up() < 0.05 * speed) return {};
  const double dt = (precise ? 1e-4 : 0.02) * s / speed;
  // Another corner may be struck before the step ends.
  for (const Vec2d each : {Vec2d{-wide / 2, -high / 2}, Vec2d{wide / 2, -high / 2}, Vec2d{wide / 2, high / 2},
                           Vec2d{-wide / 2, high / 2}}) {
    const Vec2d at{c * each.x - sn * each.y, sn * each.x + c * each.y};
    const double height = at.y - arm.y, rate = right.velocity.y + right.spin * at.x;
    if (height > 1e-9 * s && height + 2 * dt * std::min(rate, box.velocity.y) < 0) return {};
  }
  Accuracy own = accuracy;
  if (auto* realtime = std::get_if<Realtime>(&own))
    realtime->dt = dt;
  else
    own = Precise{.max_dt = dt};
  Simulation run = compile(scene, own);
  const Vec2d before = run.state(1).velocity;
  for (int i = 0; i < 20 && run.state(1).velocity == before; ++i) run.step();
  if (run.state(1).velocity == before) return {};
  const BodyState found = run.state(1);
  const double off =
      length(found.velocity - right.velocity) + s * std::abs(found.angular_velocity - right.spin);
  // Impacts in flight are solved to rounding; Routh's method here is one of finite parts.
  const auto* realtime = std::get_if<Realtime>(&accuracy);
  const double share = realtime == nullptr ? 4e-3 : realtime->precision == Precision::Double ? 1e-9 : 2e-4;
  if (off > share * (length(box.velocity) + s * std::abs(box.angular_velocity)))
    return fmt::format(
        "a box that strikes a floor leaves it at {:.5g}, {:.5g} m/s and {:.5g} rad/s, not at {:.5g}, {:.5g} "
        "and {:.5g} "
        "(law {}, e {:.3g}, mu {:.3g})",
        found.velocity.x, found.velocity.y, found.angular_velocity, right.velocity.x, right.velocity.y,
        right.spin, static_cast<int>(rules.impact), restitution, mu);
  return {};
}

// Checks that a block on a floor or a slope slides by its kinetic friction, and starts only beyond the static
// one.
std::string slid(Random& random) {
  const double s = random.ladder(0.2, 5), mu = random.within(0.1, 0.8), share = random.within(0.3, 1),
               g = 9.81;
  const double slope = random.chance(0.5) ? 0 : random.within(0.1, 0.9),
               v = random.pick({0.0, 1.0}) * random.within(1, 4);
  Scene scene{.name = "slide", .gravity = {g * std::sin(slope), -g * std::cos(slope)}};
  scene.contact_rules.friction_while_sliding = share;
  scene.bodies = {{.name = "floor",
                   .type = BodyType::Static,
                   .position = {0, -s},
                   .shapes = {{.geometry = Box{400 * s, 2 * s}, .friction = mu}}},
                  {.name = "block",
                   .position = {0, 0.1 * s},
                   .velocity = {v, 0},
                   .mass = 2,
                   .shapes = {{.geometry = Box{2 * s, 0.2 * s}, .friction = mu}}}};
  const double pull = g * std::sin(slope), hold = mu * g * std::cos(slope);
  if (std::abs(pull - hold) < 0.01 * g || std::abs(pull - share * hold) < 0.01 * g) return {};
  const double t = 0.4;
  double right = 0;
  if (v == 0) {
    right = pull > hold ? (pull - share * hold) * t : 0;
  } else {
    const double a = pull - share * hold;
    right = v + a * t;
    if (right < 0) right = pull > hold ? (pull - share * hold) * (t + v / a) : 0;
  }
  Simulation run = compile(scene, Precise{.max_dt = t});
  run.step();
  const double found = run.state(1).velocity.x;
  if (std::abs(found - right) > 1e-6 * (v + g * t))
    return fmt::format(
        "a block that slides has {:.7g} m/s after {} s, not {:.7g} (mu {:.3g}, {:.3g} of it while it "
        "slides, slope {:.3g} rad)",
        found, t, right, mu, share, slope);
  return {};
}

// Checks that a motor holds its speed against less than its torque in both directions, and that a limit stops
// a hinge that reaches it.
std::string driven_hinge(Random& random) {
  const double s = random.ladder(0.2, 5), most = random.ladder(1, 100), w = random.pick({0.0, 1.0, -2.0});
  const double load = most * random.pick({-1.5, -0.9, -0.3, 0.3, 0.9, 1.5});
  Scene scene{.name = "motor", .gravity = {0, 0}};
  scene.bodies = {
      {.name = "bar", .angular_velocity = w, .mass = 2, .shapes = {{.geometry = Box{s, 0.2 * s}}}}};
  scene.joints = {RevoluteJoint{
      .name = "hinge", .body_a = std::string(kWorld), .body_b = "bar", .motor = Motor{w, most}}};
  scene.forces = {Torque{.body = "bar", .torque = load}};
  const double t = 0.2, excess = std::abs(load) > most ? load - std::copysign(most, load) : 0;
  const double right = w + excess * t / inertia_of(scene.bodies.front());
  Simulation run = compile(scene, Precise{.max_dt = t});
  run.step();
  const double found = run.state(0).angular_velocity;
  if (std::abs(found - right) > 1e-6 * (std::abs(right) + 1))
    return fmt::format(
        "a motor of {:.4g} rad/s and {:.4g} N m under {:.4g} N m turns at {:.7g} rad/s, not {:.7g}", w, most,
        load, found, right);
  // A bar that its weight holds on a limit, and a ball that falls on its end.
  const double e = random.within(0, 1), speed = random.within(1, 5), radius = 0.1 * s;
  Scene stop{.name = "stop"};
  stop.bodies = {{.name = "bar",
                  .position = {s / 2, 0},
                  .mass = 2,
                  .shapes = {{.geometry = Box{s, 0.2 * s}, .friction = 0, .restitution = e}}},
                 {.name = "ball",
                  .position = {0.8 * s, 0.1 * s + radius + 1e-6 * s},
                  .velocity = {0, -speed},
                  .mass = 1,
                  .shapes = {{.geometry = Circle{radius}, .friction = 0, .restitution = e}}}};
  stop.joints = {RevoluteJoint{.name = "hinge",
                               .body_a = std::string(kWorld),
                               .body_b = "bar",
                               .anchor_b = {-s / 2, 0},
                               .limits = Range{0, 1}}};
  Simulation falls = compile(stop, Precise{.max_dt = 1e-4 * s / speed});
  for (int i = 0; i < 20 && falls.statistics().impacts == 0; ++i) falls.step();
  if (falls.statistics().impacts == 0 || e < 0.05) return {};
  const double up = falls.state(1).velocity.y, turns = falls.state(0).angular_velocity;
  if (std::abs(up - e * speed) > 0.01 * speed || std::abs(turns) * s > 0.01 * speed)
    return fmt::format(
        "a ball that falls at {:.4g} m/s on a bar that a limit holds leaves it at {:.5g} m/s, not {:.5g}",
        speed, up, e * speed);
  return {};
}

bool is_precise(const Engine& engine) { return engine.kind == Engine::Kind::Precise; }

}  // namespace

bool on_precise(const Case& one, const Engine& engine) { return is_precise(engine) && !one.world_only(); }

Verdict forces(const Case& one, const Engine&, const Motion&) {
  return judged("forces", "a body accelerates by the forces of its joints and contacts, and its own",
                [&] { return balanced(one); });
}
Verdict derivatives(const Case& one, const Engine&, const Motion&) {
  return judged("derivatives", "derivatives are those of runs that differ a little, or are refused",
                [&] { return derived(one); });
}
Verdict estimates(const Case& one, const Engine&, const Motion&) {
  return judged("estimates", "an estimate of the error is of its size", [&] { return estimated(one); });
}
Verdict starts(const Case& one, const Engine&, const Motion&) {
  return judged("starts", "what starts in something else, or with a joint open, is refused",
                [&] { return refuses_start(one); });
}
Verdict methods(const Case& one, const Engine& engine, const Motion& motion) {
  return judged("methods", "the motion is the same by each method of integration",
                [&] { return alike_by_methods(one, motion, engine); });
}
Verdict blows(const Case& one, const Engine&, const Motion&) {
  return judged("blows", "impacts, friction, motors and limits follow the laws of their scene", [&] {
    Random random(one.seed, one.index + 67);
    std::string wrong;
    for (int i = 0; i < 3 && wrong.empty(); ++i) {
      wrong = blown(random, Precise{});
      for (const auto& draw : {slid, driven_hinge})
        if (wrong.empty()) wrong = draw(random);
    }
    return wrong;
  });
}

Verdict strikes(const Case& one, const Engine& engine, const Motion&) {
  Random random(one.seed, one.index + 71);
  std::string wrong;
  const Precision precision = engine.kind == Engine::Kind::World ? Precision::Float : Precision::Double;
  for (int i = 0; i < 3 && wrong.empty(); ++i)
    wrong = blown(random, Realtime{.substeps = one.substeps, .precision = precision});
  if (wrong.empty()) return {};
  return Objection{.law = "strikes",
                   .judge = "strikes",
                   .what = wrong,
                   .right = "an impact on a corner has the restitution and friction of its surfaces"};
}

}  // namespace plumb::harness::hunt
