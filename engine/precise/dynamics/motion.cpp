#include "engine/precise/dynamics/motion.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <variant>

#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/clock.h"

namespace plumb::precise {
namespace {

std::vector<std::string> joint_names_by_row(const Scene& scene, const GeneralJoints& others) {
  std::vector<std::string> names;
  for (const Joint& joint : scene.joints) {
    if (const auto* revolute = std::get_if<RevoluteJoint>(&joint))
      names.insert(names.end(), 2, revolute->name);
  }
  for (const Joint& joint : scene.joints) {
    if (const auto* rod = std::get_if<DistanceJoint>(&joint); rod && !rod->spring && !rod->range)
      names.push_back(rod->name);
  }
  names.insert(names.end(), others.row_names().begin(), others.row_names().end());
  return names;
}

/// Computes the rows with all bodies at the origin: only the body indices of the rows matter.
std::vector<Row<double>> pattern(const Joints& joints, const GeneralJoints& others, std::size_t bodies) {
  std::vector<Row<double>> rows(joints.row_count() + others.row_count());
  const std::vector<Pose<double>> poses(bodies);
  const std::vector<double> angles(bodies);
  const std::vector<Twist<double>> twists(bodies);
  joints.rows(poses, twists, rows);
  others.rows({poses, angles, twists}, std::span(rows).subspan(joints.row_count()));
  return rows;
}

struct InverseMasses {
  std::vector<double> mass, inertia;
};

InverseMasses inverse_masses(const Scene& scene) {
  InverseMasses inverse{std::vector<double>(scene.bodies.size(), 0.0),
                        std::vector<double>(scene.bodies.size(), 0.0)};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    inverse.mass[i] = 1 / body.mass;
    const double inertia = inertia_of(body);
    inverse.inertia[i] = inertia > 0 ? 1 / inertia : 0;
  }
  return inverse;
}

/// Returns true if the masses of joined bodies differ by a factor of more than a hundred.
bool has_wide_mass_ratio(std::span<const Row<double>> rows, std::span<const double> inverse_mass) {
  double lightest = 0, heaviest = std::numeric_limits<double>::infinity();
  for (const Row<double>& row : rows) {
    for (const int body : {row.a, row.b}) {
      if (body == kFixedFrame || inverse_mass[body] == 0) continue;
      lightest = std::max(lightest, inverse_mass[body]);
      heaviest = std::min(heaviest, inverse_mass[body]);
    }
  }
  return lightest > 100 * heaviest;
}

/// Returns the hinges if they are the only joints. Excludes wide mass ratios, which need iterative
/// refinement; only rows have it.
HingeSystem hinge_system(const JointSystem<double>& system, const Joints& joints, const GeneralJoints& others,
                         const std::vector<double>& inverse_mass, const std::vector<double>& inverse_inertia,
                         bool wide_mass_ratio, const Scene& scene) {
  // Excludes prescribed bodies: rows use their acceleration, while hinge lines assume that they are fixed.
  const bool moved = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                 [](const Body& body) { return !body.motion.empty(); });
  const bool plain = joints.distance.empty() && others.row_count() == 0 && !wide_mass_ratio && !moved;
  return {plain ? system.hinges() : std::vector<HingePlace>{}, joints.revolute, inverse_mass,
          inverse_inertia};
}

std::vector<double> only(const std::vector<double>& values, const std::vector<std::size_t>& bodies) {
  std::vector<double> some(values.size(), 0.0);
  for (const std::size_t i : bodies) some[i] = values[i];
  return some;
}

/// Returns true if the formula selects what it computes by more than the time, its first variable.
bool has_pieces_of_motion(const Formula& formula, std::size_t variables) {
  bool moves = false;
  for (std::size_t i = 1; i < variables; ++i) moves = moves || formula.uses(i);
  return moves && formula.has_decisions();
}

}  // namespace

EquationsOfMotion::EquationsOfMotion(const Scene& scene, const ScenePartition& partition,
                                     const BallisticMotion& ballistic, bool every_stage, double tolerance)
    : bodies_(partition.integrated),
      slot_(scene.bodies.size(), -1),
      ballistic_(ballistic),
      gravity_(scene.gravity),
      forces_(with_laws_on(scene, partition.integrated)),
      joints_(compile_joints(scene)),
      general_joints_(scene),
      joint_of_row_(joint_names_by_row(scene, general_joints_)),
      joint_ends_(ends_of_joints(scene)),
      rows_(pattern(joints_, general_joints_, scene.bodies.size())),
      inverse_mass_(inverse_masses(scene).mass),
      inverse_inertia_(inverse_masses(scene).inertia),
      joint_inverse_mass_(only(inverse_mass_, partition.integrated)),
      joint_inverse_inertia_(only(inverse_inertia_, partition.integrated)),
      poses_(scene.bodies.size()),
      angles_(scene.bodies.size()),
      twists_(scene.bodies.size()),
      accelerations_(scene.bodies.size()),
      wrenches_(scene.bodies.size()),
      system_(rows_, joint_inverse_mass_, joint_inverse_inertia_),
      hinges_(hinge_system(system_, joints_, general_joints_, joint_inverse_mass_, joint_inverse_inertia_,
                           has_wide_mass_ratio(rows_, joint_inverse_mass_), scene)),
      right_side_(rows_.size()),
      multipliers_(rows_.size()),
      has_forces_(!forces_.empty() || general_joints_.has_springs() ||
                  !general_joints_.limits_and_motors().empty() || every_stage),
      has_joints_(!rows_.empty() || every_stage),
      has_loops_(find_loops()),
      wide_mass_ratio_(has_wide_mass_ratio(rows_, joint_inverse_mass_)),
      switches_(scene),
      length_(scales_of(scene, partition).length),
      speed_(scales_of(scene, partition).speed),
      tolerance_(tolerance) {
  forces_.for_each_formula(0, poses_.data(), twists_.data(),
                           [&](const Formula& formula, std::span<const double> now) {
                             if (has_pieces_of_motion(formula, now.size()))
                               formulas_with_pieces_.push_back({&formula, now.size()});
                           });
  for (const Body& body : scene.bodies) names_.push_back(body.name);
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Body& body = scene.bodies[bodies_[slot]];
    if (!body.motion.empty()) prescribed_.push_back({bodies_[slot], slot, PrescribedPath(body)});
  }
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) slot_[bodies_[slot]] = static_cast<int>(slot);
  for (const ForceLaw& law : with_laws_on(scene, bodies_).forces) {
    for (const std::string_view name : ends_of(law)) {
      if (const auto body = find_body(scene, name); body && ballistic_.contains(*body))
        ballistic_bodies_.push_back(*body);
    }
  }
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          for (const std::string& name : {j.body_a, j.body_b}) {
            if (const auto body = find_body(scene, name); body && ballistic_.contains(*body))
              ballistic_bodies_.push_back(*body);
          }
        },
        joint);
  }
  std::sort(ballistic_bodies_.begin(), ballistic_bodies_.end());
  ballistic_bodies_.erase(std::unique(ballistic_bodies_.begin(), ballistic_bodies_.end()),
                          ballistic_bodies_.end());
}

BodyState EquationsOfMotion::state(std::span<const double> y, std::size_t slot) {
  assert(kPerBody * (slot + 1) <= y.size());
  const double* p = y.data() + kPerBody * slot;
  return {{p[0], p[1]}, p[2], {p[3], p[4]}, p[5]};
}

void EquationsOfMotion::set_state(Compensated& y, std::size_t slot, const BodyState& state) {
  assert(kPerBody * (slot + 1) <= y.size());
  const double values[kPerBody] = {state.position.x, state.position.y, state.angle,
                                   state.velocity.x, state.velocity.y, state.angular_velocity};
  for (std::size_t i = 0; i < kPerBody; ++i) y.set(kPerBody * slot + i, values[i]);
}

void EquationsOfMotion::append_formula_variables(double time, std::span<const double> y,
                                                 std::vector<double>& variables) {
  update_poses(time, y);
  forces_.for_each_formula(formula_time(time), poses_.data(), twists_.data(),
                           [&](const Formula& formula, std::span<const double> now) {
                             if (has_pieces_of_motion(formula, now.size()))
                               variables.insert(variables.end(), now.begin(), now.end());
                           });
}

void EquationsOfMotion::set_window(double start, double end) {
  window_start_ = start, window_end_ = end;
  set_next_switch(switches_.next(end));
}

void EquationsOfMotion::restore_switches(double after, double end) {
  if (!(after < end)) return;
  switches_.restore(after, end);
  set_next_switch(end);
}

bool EquationsOfMotion::prescribed_velocity_jumps(double time) const {
  constexpr double kRounding = 1e-12;
  return std::any_of(prescribed_.begin(), prescribed_.end(), [&](const Prescribed& one) {
    const BodyState before = one.path.at(std::nextafter(time, 0)).state, after = one.path.at(time).state;
    const double jump = std::sqrt(length_squared(after.velocity - before.velocity)) +
                        length_ * std::abs(after.angular_velocity - before.angular_velocity);
    return jump > kRounding * (speed_ + std::sqrt(length_squared(before.velocity)));
  });
}

void EquationsOfMotion::set_next_switch(double time) {
  next_switch_ = time;
  last_time_ = std::nextafter(time, -std::numeric_limits<double>::infinity());
}

void EquationsOfMotion::update_poses(double time, std::span<const double> y) {
  time_ = formula_time(time);
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const BodyState now = state(y, slot);
    const std::size_t body = bodies_[slot];
    if (std::bit_cast<std::uint64_t>(angles_[body]) != std::bit_cast<std::uint64_t>(now.angle)) {
      poses_[body].rotation = rotation_of(now.angle);
      angles_[body] = now.angle;
    }
    poses_[body].position = now.position;
    twists_[body] = {now.velocity, now.angular_velocity};
  }
  for (const std::size_t body : ballistic_bodies_) {
    const BodyState now = ballistic_.at(body, time).state;
    poses_[body] = {now.position, rotation_of(now.angle)};
    angles_[body] = now.angle;
    twists_[body] = {now.velocity, now.angular_velocity};
  }
}

/// Computes residuals, Jacobian and bias accelerations at the bodies' poses.
void EquationsOfMotion::find_rows(std::span<Row<double>> out) const {
  assert(out.size() == rows_.size());
  joints_.rows(poses_, twists_, out);
  if (general_joints_.row_count() > 0) general_joints_.rows(bodies_view(), out.subspan(joints_.row_count()));
}

void EquationsOfMotion::linearise() {
  find_rows(rows_);
  dependent_rows_ = std::max(dependent_rows_, system_.factor(rows_));
  min_pivot_ratio_ = std::min(min_pivot_ratio_, system_.min_pivot_ratio());
}

std::vector<std::string> EquationsOfMotion::redundant_joints(double time, std::span<const double> y) {
  std::vector<std::string> names;
  if (!has_joints_) return names;
  update_poses(time, y);
  linearise();
  const std::vector<char> dependent = system_.dependent();
  for (std::size_t row = 0; row < dependent.size(); ++row) {
    if (dependent[row] && (names.empty() || names.back() != joint_of_row_[row]))
      names.push_back(joint_of_row_[row]);
  }
  return names;
}

bool EquationsOfMotion::has_hinges_only() const {
  return forces_.empty() && !general_joints_.has_springs() && general_joints_.limits_and_motors().empty() &&
         joints_.distance.empty() && general_joints_.row_count() == 0;
}

/// Solves A multipliers = right_side.
void EquationsOfMotion::solve_joints() {
  std::copy(right_side_.begin(), right_side_.end(), multipliers_.begin());
  system_.solve(multipliers_);
  if (wide_mass_ratio_) system_.refine(rows_, right_side_, multipliers_);
}

/// Adds M^-1 J^T multipliers to `motion`.
void EquationsOfMotion::add_joint_response(std::span<Twist<double>> motion) const {
  const auto add = [&](int body, Vec2d linear, double angular, double multiplier) {
    if (body == kFixedFrame) return;
    motion[body].velocity += (joint_inverse_mass_[body] * multiplier) * linear;
    motion[body].angular_velocity += joint_inverse_inertia_[body] * multiplier * angular;
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    add(rows_[i].a, rows_[i].linear_a, rows_[i].angular_a, multipliers_[i]);
    add(rows_[i].b, rows_[i].linear_b, rows_[i].angular_b, multipliers_[i]);
  }
}

/// Returns J v for one row.
double EquationsOfMotion::row_speed(const Row<double>& row, std::span<const Twist<double>> motion) const {
  const auto along = [&](int body, Vec2d linear, double angular) {
    if (body == kFixedFrame) return 0.0;
    return dot(linear, motion[body].velocity) + angular * motion[body].angular_velocity;
  };
  return along(row.a, row.linear_a, row.angular_a) + along(row.b, row.linear_b, row.angular_b);
}

void EquationsOfMotion::free_accelerations(double time, std::span<const double> y,
                                           std::span<Twist<double>> out) {
  ++evaluations_;
  update_poses(time, y);
  if (!has_forces_) {
    for (const std::size_t body : bodies_) out[body] = {gravity_, 0};
    return set_prescribed_accelerations(time, out);
  }
  for (const std::size_t body : bodies_) wrenches_[body] = {};
  {
    const Clock clock(cost.on, cost.forces);
    forces_.add_at(formula_time(time), window_start_, window_end_, poses_.data(), twists_.data(),
                   wrenches_.data());
    if (general_joints_.has_springs()) general_joints_.add_springs(bodies_view(), wrenches_);
    if (saturated_motors_ > 0) add_motors();
  }
  power_ = 0;
  for (const std::size_t body : bodies_) {
    const Wrench<double>& w = wrenches_[body];
    out[body] = {gravity_ + inverse_mass_[body] * w.force, inverse_inertia_[body] * w.torque};
    power_ += dot(w.force, twists_[body].velocity) + w.torque * twists_[body].angular_velocity;
  }
  set_prescribed_accelerations(time, out);
}

void EquationsOfMotion::set_prescribed_accelerations(double time, std::span<Twist<double>> out) const {
  for (const Prescribed& one : prescribed_) {
    const PrescribedPath::Point now = one.path.at(formula_time(time));
    out[one.body] = {now.acceleration, now.angular_acceleration};
  }
}

void EquationsOfMotion::set_prescribed(double time, Compensated& y) const {
  for (const Prescribed& one : prescribed_) set_state(y, one.slot, one.path.at(formula_time(time)).state);
}

void EquationsOfMotion::rate(double time, std::span<const double> y, std::span<double> out) {
  free_accelerations(time, y, accelerations_);
  if (uses_hinge_system()) {
    const Clock clock(cost.on, cost.joints);
    hinges_.update(poses_);
    hinges_.add_accelerations(twists_, accelerations_);
    dependent_rows_ = std::max(dependent_rows_, hinges_.dependent());
    min_pivot_ratio_ = std::min(min_pivot_ratio_, hinges_.min_pivot_ratio());
  } else if (has_joints_) {
    accelerate_joints();
  }
  if (has_active_constraints()) add_contact_accelerations(accelerations_);
  write_rate(y, out);
}

void EquationsOfMotion::rate_with_rows(double time, std::span<const double> y, std::span<double> out) {
  free_accelerations(time, y, accelerations_);
  if (has_joints_) accelerate_joints();
  if (has_active_constraints()) add_contact_accelerations(accelerations_);
  write_rate(y, out);
}

/// Adds the accelerations by joints to those without them.
void EquationsOfMotion::accelerate_joints() {
  const Clock clock(cost.on, cost.joints);
  linearise();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    right_side_[i] = -(row_speed(rows_[i], accelerations_) + rows_[i].bias_acceleration);
  }
  solve_joints();
  add_joint_response(accelerations_);
}

void EquationsOfMotion::write_rate(std::span<const double> y, std::span<double> out) const {
  assert(y.size() == dimension() && out.size() == dimension());
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Twist<double>& acceleration = accelerations_[bodies_[slot]];
    const double* motion = y.data() + kPerBody * slot;
    double* change = out.data() + kPerBody * slot;
    for (int i = 0; i < 3; ++i) change[i] = motion[3 + i];
    change[3] = acceleration.velocity.x;
    change[4] = acceleration.velocity.y;
    change[5] = acceleration.angular_velocity;
  }
}

void EquationsOfMotion::factorise_joints(double time, std::span<const double> y) {
  if (!has_joints_) return;
  update_poses(time, y);
  linearise();
}

double EquationsOfMotion::position_correction(double time, std::span<const double> y,
                                              std::span<Twist<double>> out) {
  std::fill(out.begin(), out.end(), Twist<double>{});
  if (!has_joints_) return 0;
  update_poses(time, y);
  trial_rows_.resize(rows_.size());
  find_rows(trial_rows_);
  double largest = 0;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    right_side_[r] = -trial_rows_[r].residual;
    largest = std::max(largest, std::abs(right_side_[r]));
  }
  solve_joints();
  add_joint_response(out);
  return largest;
}

void EquationsOfMotion::velocity_correction(std::span<const double> y, std::span<Twist<double>> out) {
  std::fill(out.begin(), out.end(), Twist<double>{});
  if (!has_joints_) return;
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const BodyState now = state(y, slot);
    twists_[bodies_[slot]] = {now.velocity, now.angular_velocity};
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], twists_);
  solve_joints();
  add_joint_response(out);
}

void EquationsOfMotion::add_velocities(std::span<const Twist<double>> response, double scale,
                                       Compensated& y) const {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const Twist<double>& change = response[bodies_[slot]];
    y.add(kPerBody * slot + 3, scale * change.velocity.x);
    y.add(kPerBody * slot + 4, scale * change.velocity.y);
    y.add(kPerBody * slot + 5, scale * change.angular_velocity);
  }
}

}  // namespace plumb::precise
