#include "engine/world/forces/elastic_step.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

/// Largest number of rows of a spring: along its line, across it, and one for the lever arm at each end.
constexpr int kRows = 4;

/// Largest number of Newton steps from one starting point. Nine in ten need at most 10.
constexpr int kIterations = 20;
/// Shortest fraction of a Newton step that is tried: 2^-8.
constexpr int kHalvings = 8;
/// Residual below which Newton's method ends after one more step, as a fraction of the motion.
constexpr double kConverged = 1e-12;
/// The same, for accepting the result after the last iteration.
constexpr double kAccepted = 1e-9;
/// Rounding error of a spring's direction, as a fraction of the coordinates of its ends.
constexpr double kRounding = 1e-15;
/// Smallest energy change in a step that is corrected, as a fraction of the energy: far above rounding; in
/// 1e6 steps such changes add up to 1 %.
constexpr double kMinEnergyError = 1e-8;
/// Largest fraction by which a motion that loses energy is moved away from the reference motion.
constexpr double kMaxExtrapolation = 0.5;
/// Number of halvings in the search for the smallest fraction: to 1e-9.
constexpr int kBisections = 30;

double square(double x) { return x * x; }

/// Returns the elastic energy that a spring gains between two lengths, divided by half its stiffness, m^2.
double stretched(const ElasticStep::Spring& spring, double start, double end) {
  if (!spring.pulls_only) return (end - start) * (end + start - 2 * spring.rest_length);
  return square(std::max(end - spring.rest_length, 0.0)) - square(std::max(start - spring.rest_length, 0.0));
}

Vec2d across(Vec2d axis) { return {-axis.y, axis.x}; }

/// Returns sin(x) / x.
double sinc(double x) { return std::abs(x) < 1e-2 ? 1 - x * x / 6 * (1 - x * x / 20) : rotation_of(x).s / x; }

/// Returns 1 / x, and 0 for x = 0, because an inverse mass of 0 means that the body does not move.
double inverse_of(double x) { return x > 0 ? 1 / x : 0; }

double length_of(Vec2d v) { return std::sqrt(length_squared(v)); }

/// Returns the unit vector along a line; an arbitrary one for length 0.
Vec2d axis_of(Vec2d line) {
  const double length = length_of(line);
  return length > 0 ? (1 / length) * line : Vec2d{1, 0};
}

/// Returns the row of a force that pulls `a` along `direction` and `b` in the opposite direction.
BoundedRow pull_row(int a, Vec2d arm_a, int b, Vec2d arm_b, Vec2d direction) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  return {.a = a,
          .b = b,
          .linear_a = direction,
          .linear_b = -direction,
          .angular_a = cross(arm_a, direction),
          .angular_b = -cross(arm_b, direction),
          .lower = -kUnbounded,
          .upper = kUnbounded};
}

}  // namespace

void ElasticStep::clear() { bodies_.clear(), springs_.clear(), free_.clear(), system_.bodies.clear(); }

int ElasticStep::add_body(const Body& body) {
  bodies_.push_back(body), free_.push_back({});
  system_.bodies.push_back({.inverse_mass = body.inverse_mass, .inverse_inertia = body.inverse_inertia});
  return static_cast<int>(bodies_.size()) - 1;
}

/// Computes two sums over springs: dt c / m for each body, and M times the square of the motion's rounding
/// error.
void ElasticStep::compute_scales(double dt) {
  damping_.assign(bodies_.size(), 0);
  rounding_ = 0;
  for (const Spring& spring : springs_) {
    double places = spring.rest_length, mobility = 0;
    for (const auto& [body, arm] : {std::pair(spring.a, spring.arm_a), std::pair(spring.b, spring.arm_b)}) {
      const Body& b = bodies_[body];
      const double own =
          std::max(b.inverse_mass.x, b.inverse_mass.y) + length_squared(arm) * b.inverse_inertia;
      damping_[body] += dt * spring.damping * own;
      places += length_of(b.position) + length_of(arm);
      mobility += own;
    }
    rounding_ += mobility * square(0.5 * dt * dt * spring.stiffness * kRounding * places);
  }
}

Vec2d ElasticStep::line_before(const Spring& spring) const {
  return (bodies_[spring.b].position + spring.arm_b) - (bodies_[spring.a].position + spring.arm_a);
}

Vec2d ElasticStep::line_after(const Spring& spring) const {
  const Motion &a = moved_[spring.a], &b = moved_[spring.b];
  return (bodies_[spring.b].position + b.displacement + rotation_of(b.rotation) * spring.arm_b) -
         (bodies_[spring.a].position + a.displacement + rotation_of(a.rotation) * spring.arm_a);
}

/// Returns the effective damping of a spring over the step, N s/m. With dt c / m = z in sum, the fraction of
/// a velocity that remains is 1 / (1 + z + z^2 / 2): exp(-z) to second order, and almost nothing for large z.
/// The coefficient c itself, applied to the mean velocity, would reverse the velocity.
double ElasticStep::damping_of(const Spring& spring) const {
  const double z = damping_[spring.a] + damping_[spring.b];
  return spring.damping * (4 + 2 * z) / (4 + 2 * z + z * z);
}

/// Returns a spring's mean forces for the motion in `moved_`.
ElasticStep::Line ElasticStep::line_of(const Spring& spring, double dt) const {
  const Vec2d start = line_before(spring), end = line_after(spring), mean = 0.5 * (start + end);
  const double mean_length = length_of(mean), lengths = length_of(start) + length_of(end);
  const double rest_ratio = lengths > 0 ? 2 * spring.rest_length / lengths : 0;
  const double damping = damping_of(spring);
  const auto mean_arm = [&](int body, Vec2d arm) {
    const double half = 0.5 * moved_[body].rotation;
    return sinc(half) * (rotation_of(half) * arm);
  };
  Line line{.arm_a = mean_arm(spring.a, spring.arm_a),
            .arm_b = mean_arm(spring.b, spring.arm_b),
            .axis = axis_of(mean)};
  double pull = spring.stiffness * (1 - rest_ratio);
  if (spring.pulls_only && std::min(length_of(start), length_of(end)) < spring.rest_length) {
    if (std::max(length_of(start), length_of(end)) <= spring.rest_length) return line;
    pull = spring.stiffness * stretched(spring, length_of(start), length_of(end)) /
           (length_squared(end) - length_squared(start));
  }
  line.pull = pull * mean + (damping / dt * dot(line.axis, end - start)) * line.axis;
  line.across = std::max(pull, 0.0);
  line.along = line.across + 2 * damping / dt;
  if (lengths > 0) line.along += spring.stiffness * rest_ratio * 2 * mean_length / lengths;
  return line;
}

/// Computes the springs' wrenches for the motion in `moved_`. Writes the residual, free + dt^2/2 M^-1 F -
/// moved, into the bodies of the system. Returns the sum of its squares times M, kg m^2.
double ElasticStep::evaluate(double dt) {
  wrenches_.assign(bodies_.size(), {});
  lines_.clear();
  for (const Spring& spring : springs_) {
    const Line& line = lines_.emplace_back(line_of(spring, dt));
    wrenches_[spring.a] += {line.pull, cross(line.arm_a, line.pull)};
    wrenches_[spring.b] += {-line.pull, -cross(line.arm_b, line.pull)};
  }
  double sum = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BoundedBody& body = system_.bodies[i];
    const Motion after = moved_by(static_cast<int>(i), dt);
    body.velocity = after.displacement - moved_[i].displacement;
    body.spin = after.rotation - moved_[i].rotation;
    sum += energy_of(static_cast<int>(i), {body.velocity, body.spin});
  }
  return sum;
}

/// Returns the motion of a body under its wrench.
ElasticStep::Motion ElasticStep::moved_by(int body, double dt) const {
  const Body& b = bodies_[body];
  const Wrench<double>& w = wrenches_[body];
  const double fraction = 0.5 * dt * dt;
  return {
      free_[body].displacement + fraction * Vec2d{b.inverse_mass.x * w.force.x, b.inverse_mass.y * w.force.y},
      free_[body].rotation + fraction * b.inverse_inertia * w.torque};
}

/// Returns M motion^2 of a body, kg m^2.
double ElasticStep::energy_of(int body, const Motion& motion) const {
  const Body& b = bodies_[body];
  return inverse_of(b.inverse_mass.x) * square(motion.displacement.x) +
         inverse_of(b.inverse_mass.y) * square(motion.displacement.y) +
         inverse_of(b.inverse_inertia) * square(motion.rotation);
}

/// Makes a row for each restoring part of the derivative. A row with stiffness k has the impulse x that
/// solves J step + x / (dt^2/4 k) = 0.
void ElasticStep::make_rows(double dt) {
  system_.rows.clear();
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Spring& spring = springs_[i];
    const Line& line = lines_[i];
    const auto add = [&](BoundedRow row, double stiffness) {
      if (!(stiffness > 0)) return;
      row.compliance = 1 / (0.25 * dt * dt * stiffness);
      row.block = static_cast<int>(i);
      system_.rows.push_back(row);
    };
    const auto row = [&](Vec2d direction) {
      return pull_row(spring.a, line.arm_a, spring.b, line.arm_b, direction);
    };
    add(row(line.axis), line.along);
    add(row(across(line.axis)), line.across);
    BoundedRow lever = row({});
    lever.angular_a = 1, lever.angular_b = 0;
    add(lever, dot(line.arm_a, line.pull));
    lever.angular_a = 0, lever.angular_b = 1;
    add(lever, -dot(line.arm_b, line.pull));
  }
}

/// Reorders the elimination if the pairs of connected bodies differ from the last step's.
void ElasticStep::order() {
  connected_.clear();
  for (const Spring& spring : springs_) connected_.emplace_back(spring.a, spring.b);
  if (connected_ == ordered_) return;
  sizes_.assign(springs_.size(), kRows);
  system_.order(connected_, sizes_);
  ordered_ = connected_;
}

/// Finds the Newton step from the motion in `moved_`.
void ElasticStep::compute_newton_step(double dt) {
  make_rows(dt);
  system_.solve();
  step_.clear();
  for (const BoundedBody& body : system_.bodies) step_.push_back({body.velocity, body.spin});
}

/// Improves the motion in `moved_` by Newton steps, each shortened until the residual shrinks. Returns the
/// last residual.
double ElasticStep::newton(double dt) {
  double residual = evaluate(dt);
  for (int iteration = 0; iteration < kIterations && std::isfinite(residual) && residual > bound(kConverged);
       ++iteration) {
    const double before = residual;
    compute_newton_step(dt);
    last_ = moved_;
    double part = 1;
    for (int halving = 0; halving <= kHalvings; ++halving, part *= 0.5) {
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        moved_[i] = {last_[i].displacement + part * step_[i].displacement,
                     last_[i].rotation + part * step_[i].rotation};
      residual = evaluate(dt);
      if (residual < before) break;
    }
    if (residual < before) continue;
    moved_ = last_;
    return evaluate(dt);
  }
  return residual;
}

/// Returns the residual at which the motion is accurate to a given fraction. It is computed from M times the
/// squares of the free motion and of the motion in `moved_`, plus rounding.
double ElasticStep::bound(double fraction) const {
  double sum = 0;
  for (int body = 0; body < static_cast<int>(bodies_.size()); ++body)
    sum += energy_of(body, moved_[body]) + energy_of(body, free_[body]);
  return square(fraction) * sum + rounding_;
}

/// Adds the change of the wrenches by one more Newton step. Without it, the wrenches of a very stiff spring
/// would have an error of k times the rounding of the motion.
void ElasticStep::refine(double dt) {
  compute_newton_step(dt);
  for (const BoundedRow& row : system_.rows) {
    const double mean = 2 / (dt * dt) * row.impulse;
    wrenches_[row.a] += mean * Wrench<double>{row.linear_a, row.angular_a};
    wrenches_[row.b] += mean * Wrench<double>{row.linear_b, row.angular_b};
  }
}

void ElasticStep::solve(double dt) {
  compute_scales(dt);
  order();
  double smallest_residual = std::numeric_limits<double>::infinity();
  // A start from rest makes the first Newton step the linearly implicit one. If there are several solutions,
  // it leads to the one that shorter time steps would find.
  for (const double start : {0.0, 1.0, 0.5}) {
    moved_.clear();
    for (const Motion& free : free_) moved_.push_back({start * free.displacement, start * free.rotation});
    const double residual = newton(dt);
    if (std::isfinite(residual) && residual <= bound(kAccepted)) return refine(dt);
    if (residual < smallest_residual) smallest_residual = residual, best_ = moved_;
  }
  if (!std::isfinite(smallest_residual)) return;  // the wrenches are not finite either: the caller reports it
  moved_ = best_;
  evaluate(dt);
  conserve_energy(dt);
}

int ElasticStep::group_of(const Spring& spring) const {
  return group_of_[system_.bodies[spring.a].is_dynamic() ? spring.a : spring.b];
}

/// Finds the groups of bodies that stiff springs connect, and their energy and mean free motion.
void ElasticStep::find_groups(double dt) {
  group_of_.resize(bodies_.size());
  std::iota(group_of_.begin(), group_of_.end(), 0);
  const auto root = [&](int body) {
    while (group_of_[body] != body) body = group_of_[body] = group_of_[group_of_[body]];
    return body;
  };
  for (const auto& [a, b] : connected_)
    if (system_.bodies[a].is_dynamic() && system_.bodies[b].is_dynamic()) group_of_[root(a)] = root(b);
  for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) group_of_[body] = root(body);
  groups_.assign(bodies_.size(), {});
  for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) {
    Group& group = groups_[group_of_[body]];
    const Vec2d mass{inverse_of(bodies_[body].inverse_mass.x), inverse_of(bodies_[body].inverse_mass.y)};
    group.mass += mass;
    group.moment += Vec2d{mass.x * free_[body].displacement.x, mass.y * free_[body].displacement.y};
    group.size += energy_of(body, free_[body]);
  }
  for (const Spring& spring : springs_) {
    Group& group = groups_[group_of(spring)];
    group.anchored =
        group.anchored || !system_.bodies[spring.a].is_dynamic() || !system_.bodies[spring.b].is_dynamic();
    group.size +=
        0.5 * dt * dt * 0.5 * spring.stiffness * square(length_of(line_before(spring)) - spring.rest_length);
  }
}

/// Computes the energy change of each group by the motion in `moved_`: the work of the wrenches that lead to
/// it, the elastic energy, and the loss in dampers.
void ElasticStep::compute_gains(double dt) {
  for (Group& group : groups_) group.gain = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const Vec2d by_wrench = moved_[i].displacement - free_[i].displacement;
    groups_[group_of_[i]].gain +=
        inverse_of(body.inverse_mass.x) * by_wrench.x * moved_[i].displacement.x +
        inverse_of(body.inverse_mass.y) * by_wrench.y * moved_[i].displacement.y +
        inverse_of(body.inverse_inertia) * (moved_[i].rotation - free_[i].rotation) * moved_[i].rotation;
  }
  for (const Spring& spring : springs_) {
    const Vec2d before = line_before(spring), after = line_after(spring);
    const double start = length_of(before), end = length_of(after);
    const double elastic = 0.5 * spring.stiffness * stretched(spring, start, end);
    const double damped = damping_of(spring) / dt * square(dot(axis_of(before + after), after - before));
    groups_[group_of(spring)].gain += 0.5 * dt * dt * (elastic + damped);
  }
}

/// Corrects the motion of groups so that they conserve energy. The motion is moved towards a reference motion
/// that conserves energy, or away from it if energy was lost, by the smallest sufficient fraction. The
/// reference is the motion of the group's centre of mass or, if the group is held, no motion.
void ElasticStep::conserve_energy(double dt) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) moved_[i] = moved_by(static_cast<int>(i), dt);
  best_ = moved_;
  find_groups(dt);
  compute_gains(dt);
  for (Group& group : groups_) {
    group.needs_correction = std::abs(group.gain) > kMinEnergyError * group.size;
    group.min_fraction = group.fraction = group.gain > 0 ? 0 : -kMaxExtrapolation;
    group.max_fraction = group.gain > 0 ? 1 : 0;
  }
  blend(dt);
  for (Group& group : groups_)
    group.needs_correction = group.needs_correction && (group.max_fraction > 0 || group.gain > 0);
  for (int halving = 0; halving < kBisections; ++halving) {
    for (Group& group : groups_) group.fraction = 0.5 * (group.min_fraction + group.max_fraction);
    blend(dt);
    for (Group& group : groups_)
      (group.gain > kMinEnergyError * group.size ? group.min_fraction : group.max_fraction) = group.fraction;
  }
  for (Group& group : groups_) group.fraction = group.max_fraction;
  blend(dt);
  const double fraction = 2 / (dt * dt);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!groups_[group_of_[i]].needs_correction) continue;
    const Body& body = bodies_[i];
    const Vec2d displacement = fraction * (moved_[i].displacement - free_[i].displacement);
    wrenches_[i] = {
        {inverse_of(body.inverse_mass.x) * displacement.x, inverse_of(body.inverse_mass.y) * displacement.y},
        inverse_of(body.inverse_inertia) * fraction * (moved_[i].rotation - free_[i].rotation)};
  }
}

/// Sets the motion in `moved_` to that in `best_`, moved towards the reference by the groups' fractions, and
/// computes the energy gains.
void ElasticStep::blend(double dt) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Group& group = groups_[group_of_[i]];
    const Vec2d centre = group.anchored ? Vec2d{}
                                        : Vec2d{group.mass.x > 0 ? group.moment.x / group.mass.x : 0,
                                                group.mass.y > 0 ? group.moment.y / group.mass.y : 0};
    moved_[i] = {best_[i].displacement + group.fraction * (centre - best_[i].displacement),
                 (1 - group.fraction) * best_[i].rotation};
  }
  compute_gains(dt);
}

}  // namespace plumb
