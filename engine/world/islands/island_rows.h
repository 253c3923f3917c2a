#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "engine/linear_algebra/row_coupling.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/contact_step.h"
#include "engine/world/islands/friction_cones.h"
#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

/// The rows of an island with joints. See docs/decisions/jointed-islands.md. Only jointed_islands.cpp uses
/// them.
namespace plumb {

enum class Stage { Midpoint, Correct, Relax };

inline BoundedRow::State state_of(double impulse, double lower, double upper) {
  if (impulse <= lower) return BoundedRow::kLower;
  return impulse >= upper ? BoundedRow::kUpper : BoundedRow::kFree;
}

/// Returns true if a body moves others with whatever force it takes: a kinematic one that moves.
template <class Real>
bool is_driver(const WorldData<Real>& w, const JointedLink& link) {
  return w.bodies[link.body].type == BodyType::Kinematic &&
         (link.start_velocity.x != 0 || link.start_velocity.y != 0 || link.start_spin != 0);
}

/// Computes the rows of an island at the current positions, for one stage of a substep. Joints of drivers get
/// a compliance of `driver_compliance`, relative to their mobility.
template <class Real>
class RowBuilder {
 public:
  RowBuilder(WorldData<Real>& w, JointedIsland<Real>& island, const ContactStep<Real>& step, Stage stage,
             double driver_compliance = 0)
      : w_(w),
        island_(island),
        h_(step.h),
        driver_compliance_(driver_compliance),
        midpoint_(stage == Stage::Midpoint),
        correcting_(stage == Stage::Correct) {}

  void build() {
    island_.system.rows.clear(), island_.row_sources.clear(), island_.cones.clear();
    // With friction, redundant contacts keep their distribution of the load. Joints alone share redundant
    // loads evenly.
    warm_starts_ = midpoint_ && std::any_of(island_.contacts.begin(), island_.contacts.end(),
                                            [](const ContactConstraint<Real>* c) { return c->friction > 0; });
    for (block_ = 0; block_ < static_cast<int>(island_.joints.size()); ++block_)
      add_joint(island_.joints[block_]);
    island_.first_contact_row = static_cast<int>(island_.row_sources.size());
    for (std::size_t i = 0; i < island_.contacts.size(); ++i, ++block_)
      add_contact(*island_.contacts[i], island_.last_impulses[i]);
  }

 private:
  double start_rate(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.start_velocity) + row.angular_a * a.start_spin +
           dot(row.linear_b, b.start_velocity) + row.angular_b * b.start_spin;
  }

  // Returns the rate of a row's coordinate after the first solve.
  double solved_rate(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.velocity) + row.angular_a * a.spin + dot(row.linear_b, b.velocity) +
           row.angular_b * b.spin;
  }

  // Adds a row. `applied` is the impulse of the first solve, to which the second one adds. `last` is the
  // impulse that the row had before the step.
  void add(BoundedRow& row, const RowSource<Real>& source, double lower, double upper, double last) {
    const std::size_t index = island_.row_sources.size();
    if (correcting_) {
      const bool unilateral = lower == 0 && source.first < 0;
      const bool pressed = unilateral && island_.impulses[index] > 0;
      add_correction_row(row, source, unilateral ? row.gap < 0 || pressed : row.gap != 0 || rigid_, pressed,
                         unilateral ? upper : 0);
      return;
    }
    if (index >= island_.impulses.size()) island_.impulses.push_back(last);
    const double guess = island_.impulses[index], applied = midpoint_ ? 0 : guess;
    row.lower = lower - applied, row.upper = upper - applied;
    row.state = state_of(guess, lower, upper);
    row.impulse = warm_starts_ ? guess : 0;
    row.target -= row.compliance * applied;
    island_.system.rows.push_back(row);
    island_.row_sources.push_back(source);
  }

  // Adds a row for closing gaps. Springs, motors and friction correct no positions. A unilateral row that is
  // open and has no impulse may stay open, or close.
  void add_correction_row(BoundedRow row, const RowSource<Real>& source, bool active, bool pressed,
                          double upper) {
    row.state = active ? BoundedRow::kFree : BoundedRow::kLower;
    if (pressed) row.gap = std::min(row.gap, 0.0);
    row.upper = upper;
    row.compliance = 0;
    island_.system.rows.push_back(row);
    island_.row_sources.push_back(source);
  }

  // Returns the target rate of a unilateral row with `gap`: for the first solve as the mean over the
  // displacement, for the second one as the velocity at its end. The latter is never slower than the present
  // closing rate: impulses that brake before a gap has closed would have to be taken back, which would gain
  // energy.
  double target_rate(double gap, const BoundedRow& row) const {
    const double rate = -std::max(gap, 0.0) / h_;
    return midpoint_ ? 2 * rate - start_rate(row) : std::max(rate, std::min(solved_rate(row), 0.0));
  }

  // Returns true if the next row, or one after it, had an impulse in the first solve.
  bool pressed(std::size_t after = 0) const {
    return !midpoint_ && island_.impulses[island_.row_sources.size() + after] > 0;
  }

  // Returns true if a unilateral row takes no part after the motion: a gap without an impulse does not slow
  // bodies down, nor keep a blow from speeding them up.
  bool is_open(double gap, bool pressed) const { return !midpoint_ && !correcting_ && gap > 0 && !pressed; }

  void add_joint(int joint) {
    std::vector<JointSolverRow<Real>>& rows = w_.scratch.solver.joint_rows;
    rows.clear();
    w_.joint_set.solver_rows(joint, w_.solver_bodies(), rows);
    const auto [link_a, link_b] = island_.blocks[block_];
    const bool driven = driver_compliance_ > 0 && (is_driver(link_a) || is_driver(link_b));
    for (const JointSolverRow<Real>& from : rows) {
      BoundedRow row{.a = link_a, .b = link_b};
      row.linear_a = from.row.linear_a.template as<double>(),
      row.linear_b = from.row.linear_b.template as<double>();
      row.angular_a = from.row.angular_a, row.angular_b = from.row.angular_b;
      row.block = block_;
      const double most = from.max_impulse, gap = from.row.residual;
      // Gap at the start of the substep: springs pull, and limits are measured, from it.
      const double start = midpoint_ ? gap - 0.5 * h_ * mean_rate(row) : gap;
      double lower = -most;
      bool open = false;
      rigid_ = from.role == RowRole::Rigid;
      switch (from.role) {
        case RowRole::Rigid:
          row.target = midpoint_ ? -start_rate(row) : 0;
          row.gap = gap;
          break;
        case RowRole::Spring:
          row.compliance = from.compliance;
          row.target = -double(from.rate) * (midpoint_ ? start : start - h_ * mean_rate(row));
          break;
        case RowRole::Limit:
          lower = 0;
          row.target = target_rate(start, row);
          row.gap = gap;
          open = is_open(gap, pressed());
          break;
        case RowRole::Motor:
          row.target = from.speed;
          row.softening = kMotorCompliance;
          break;
      }
      if (driven) row.softening = std::max(row.softening, driver_compliance_);
      add(row, {.impulse = from.impulse, .max_impulse = from.max_impulse, .pair = from.pair}, lower,
          open ? 0 : most, *from.impulse);
    }
  }

  // Returns the mean rate at which a row's coordinate has changed in the substep, m/s.
  double mean_rate(const BoundedRow& row) const {
    const JointedLink &a = island_.links[row.a], &b = island_.links[row.b];
    return dot(row.linear_a, a.mean_velocity) + row.angular_a * a.mean_spin +
           dot(row.linear_b, b.mean_velocity) + row.angular_b * b.mean_spin;
  }

  void add_contact(ContactConstraint<Real>& c, const ContactImpulses& last) {
    const auto [link_a, link_b] = island_.blocks[block_];
    const SolverBody<Real>&a = w_.motion[c.body_a], &b = w_.motion[c.body_b];
    const Vec2d n = c.normal.template as<double>(), t{n.y, -n.x};
    const auto along = [&](Vec2d d, Real arm_a, Real arm_b) {
      BoundedRow row{.a = link_a, .b = link_b};
      row.block = block_;
      row.linear_a = -d, row.linear_b = d, row.angular_a = -double(arm_a), row.angular_b = arm_b;
      return row;
    };
    const double closed = dot(n, (b.delta_position - a.delta_position).template as<double>());
    const int first = static_cast<int>(island_.system.rows.size());
    const double friction = std::min(double(c.friction), kMaxFriction);
    const bool has_friction = friction > 0;
    BoundedRow tangent = along(t, c.arm_tangent_a, c.arm_tangent_b);
    const double sliding = midpoint_ ? start_rate(tangent) : solved_rate(tangent);
    tangent.target = midpoint_ ? 2 * double(c.surface_speed) - sliding : double(c.surface_speed);
    const double slip = std::abs(sliding - double(c.surface_speed));
    const FrictionRays rays = rays_of(last, friction);
    const bool driven =
        enabled(Switch::YieldingContacts) && !correcting_ && (is_driver(link_a) || is_driver(link_b));
    // Joints alone keep these bodies where they are to each other. Rows for their contact would contradict
    // those of the joints by the angle of which bodies turn in a step, and press with the inverse of it.
    const bool redundant = island_.links[link_a].rigid_group == island_.links[link_b].rigid_group;
    double pressure = 0;
    rigid_ = false;
    for (int i = 0; i < c.count; ++i) {
      BoundedRow row = along(n, c.arm_a[i], c.arm_b[i]);
      const double gap = double(c.separation[i]) + closed + double(c.arm_b[i]) * b.delta_angle -
                         double(c.arm_a[i]) * a.delta_angle;
      const double start = midpoint_ ? gap - 0.5 * h_ * mean_rate(row) : gap;
      row.target = target_rate(start, row);
      row.gap = std::max(gap, -double(c.depenetration_speed) * h_ / tuning::kDirectPushFraction);
      // A contact that bounces is disabled until its time of impact.
      const bool pressed = this->pressed() || (has_friction && this->pressed(1));
      const bool disabled = is_open(gap, pressed) || redundant || !(c.mass[i] > 0);
      const double most = disabled ? 0 : std::numeric_limits<double>::infinity();
      for (int k = 0; k < (has_friction ? 2 : 1); ++k) {
        const double slope = k == 0 ? friction : -friction;
        BoundedRow ray = row;
        if (correcting_) {
          // Only one of the two rays closes the gap.
          const bool active = k == 0 && !redundant && (row.gap < 0 || pressed);
          add_correction_row(ray, {.impulse = &c.normal_impulse[i]}, active, active && pressed,
                             k == 0 ? most : 0);
          continue;
        }
        ray.linear_a += slope * tangent.linear_a, ray.linear_b += slope * tangent.linear_b;
        ray.angular_a += slope * tangent.angular_a, ray.angular_b += slope * tangent.angular_b;
        ray.target += slope * tangent.target - friction * slip * (midpoint_ ? 2 : 1);
        if (driven) soften(ray, has_friction ? rays.impulse[i][k] : last.normal[i]);
        add(ray,
            {.impulse = &c.normal_impulse[i],
             .tangent = has_friction ? &c.tangent_impulse : nullptr,
             .slope = slope},
            0, most, has_friction ? rays.impulse[i][k] : last.normal[i]);
        if (disabled) island_.impulses[island_.row_sources.size() - 1] = 0;
        pressure += island_.impulses[island_.row_sources.size() - 1];
      }
    }
    const int count = static_cast<int>(island_.system.rows.size()) - first;
    if (has_friction) {
      const std::span<const BoundedBody> bodies = island_.system.bodies;
      const BoundedRow normal = along(n, c.arm_a[0], c.arm_b[0]);
      const double tangent_response = coupling(bodies, tangent, tangent),
                   normal_response = coupling(bodies, normal, normal);
      const double gain =
          normal_response > 0 ? 1 + friction * friction * tangent_response / normal_response : 1;
      const bool guided =
          !redundant && island_.links[link_a].joint_group == island_.links[link_b].joint_group;
      island_.cones.push_back({&c, block_, first, count, friction, slip, gain, 0, 0, guided});
    }
    if (c.rolling_arm > 0) {
      BoundedRow row = along({}, 1, 1);
      row.target = midpoint_ ? -start_rate(row) : 0;
      const double most = c.rolling_arm * pressure;
      add(row, {.impulse = &c.rolling_impulse, .first = first, .count = count, .factor = c.rolling_arm},
          -most, most, last.rolling);
    }
  }

  bool is_driver(int link) const { return plumb::is_driver(w_, island_.links[link]); }

  // Makes a row compliant to the part of its impulse that exceeds the load: the part of the last known
  // impulse that balances forces. `last` is the impulse before the step.
  void soften(BoundedRow& row, double last) const {
    const std::size_t index = island_.row_sources.size();
    const double known = index < island_.impulses.size() ? island_.impulses[index] : last;
    const double load = w_.joint_set.warm_start_fraction(island_.joints[0]) * known,
                 applied = midpoint_ ? 0 : known;
    const std::span<const BoundedBody> bodies = island_.system.bodies;
    row.softening = kDriverCompliance;
    row.target += kDriverCompliance * coupling(bodies, row, row) * (load - applied);
  }

  // Largest coefficient of friction that is used; its angle is 89.4 degrees. The steeper the rays of a cone
  // are, the more they depend on each other: at 1,000, normal impulses have relative errors of 0.1.
  static constexpr double kMaxFriction = 100;
  // Compliance of motors relative to their mobility, so that limits and rigid rows prevail over motors.
  static constexpr double kMotorCompliance = 1e-6;
  // The same for contacts of moving kinematic bodies, which would push with any force. A straight column
  // between a wall and such a body buckles at up to 1 / (2 sqrt(kDriverCompliance)) = 5 times its speed;
  // rigid rows threw six boxes out at 178 m/s. Bodies that are free reach 99 % of the speed in one substep.
  static constexpr double kDriverCompliance = 0.01;

  WorldData<Real>& w_;
  JointedIsland<Real>& island_;
  const double h_, driver_compliance_;
  const bool midpoint_, correcting_;
  int block_ = 0;
  bool rigid_ = false, warm_starts_ = false;
};

}  // namespace plumb
