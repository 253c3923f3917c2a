#include "engine/world/solvers/error_feedback.h"

#include <algorithm>

#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"

namespace plumb {
namespace {

// Adds a row that closes its residual at `speed`, if any of its bodies can move.
template <class Real>
void add_row(WorldData<Real>& w, FeedbackRow<Real> row) {
  const SolverBody<Real>&a = w.motion[row.body_a], &b = w.motion[row.body_b];
  const unsigned locks = locks_of(w, row.body_a, row.body_b);
  row.row.linear_a = free_of_a(row.row.linear_a, locks),
  row.row.linear_b = free_of_b(row.row.linear_b, locks);
  const JointRow<Real>& j = row.row;
  const Real mobility =
      a.inverse_mass * length_squared(j.linear_a) + a.inverse_inertia * j.angular_a * j.angular_a +
      b.inverse_mass * length_squared(j.linear_b) + b.inverse_inertia * j.angular_b * j.angular_b;
  if (!(mobility > 0)) return;
  row.mass = 1 / (mobility + row.compliance);
  w.scratch.solver.feedback_rows.push_back(row);
}

// Adds the rows of all joints: rigid ones, and limits that are violated. Springs and motors have no error.
template <class Real>
void add_joints(WorldData<Real>& w, Real rate) {
  const SolverBodies<Real> bodies = w.solver_bodies();
  std::vector<JointSolverRow<Real>>& rows = w.scratch.solver.joint_rows;
  for (int joint = 0; joint < w.joint_set.slots(); ++joint) {
    if (!w.joint_set.contains(joint) || !w.joint_set.active(joint)) continue;
    const auto [body_a, body_b] = w.joint_set.bodies(joint);
    rows.clear();
    w.joint_set.solver_rows(joint, bodies, rows);
    for (const JointSolverRow<Real>& row : rows) {
      const bool limit = row.role == RowRole::Limit && row.row.residual < 0;
      if (!limit && row.role != RowRole::Rigid) continue;
      add_row(w, {.body_a = body_a,
                  .body_b = body_b,
                  .row = row.row,
                  .target_speed = -rate * row.row.residual,
                  .min_impulse = limit ? Real(0) : -row.max_impulse,
                  .max_impulse = row.max_impulse});
    }
  }
}

// Adds the points that overlap by more than the slop, unless locked axes block them: their push would act
// along what is free, by as much as the rounding of the normal lets it. Driven ones yield.
template <class Real>
void add_contacts(WorldData<Real>& w, Real rate) {
  constexpr Real kSlop = Real(tuning::kSlop / tuning::kDepenetrationSpeed);
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const ContactPair<Real> pair(w.motion.data(), c);
    for (int i = 0; i < c.count; ++i) {
      const Real overlap = -pair.separation(i) - kSlop * c.depenetration_speed;
      if (!(overlap > 0) || !(c.mass[i] > 0)) continue;
      add_row(w,
              {.body_a = c.body_a,
               .body_b = c.body_b,
               .row = {-c.normal, c.normal, -c.arm_a[i], c.arm_b[i], 0},
               .target_speed = std::min(rate * overlap, c.depenetration_speed),
               .compliance = driver_compliance(pair.a, pair.b, c, ContactRow::Normal) +
                             (is_driven(c) && c.mass[i] > 0 ? Real(kDrivenCompliance) / c.mass[i] : Real(0)),
               .min_impulse = 0});
    }
  });
}

}  // namespace

template <class Real>
void feed_back_errors(WorldData<Real>& w, Real rate) {
  std::vector<FeedbackRow<Real>>& rows = w.scratch.solver.feedback_rows;
  rows.clear();
  if (w.joint_set.active_count() > 0) add_joints(w, rate);
  add_contacts(w, rate);
  if (rows.empty()) return;
  std::vector<BodyVelocity<Real>>& added = w.scratch.solver.feedback;
  added.assign(w.bodies.size(), {});
  for (int iteration = 0; iteration < w.settings.iterations; ++iteration) {
    for (FeedbackRow<Real>& row : rows) {
      BodyVelocity<Real>&a = added[row.body_a], &b = added[row.body_b];
      const JointRow<Real>& j = row.row;
      const Real along = dot(j.linear_a, a.velocity) + j.angular_a * a.angular_velocity +
                         dot(j.linear_b, b.velocity) + j.angular_b * b.angular_velocity;
      const Real before = row.impulse;
      row.impulse = std::clamp(before + row.mass * (row.target_speed - along - row.compliance * before),
                               row.min_impulse, row.max_impulse);
      const Real d = row.impulse - before;
      const SolverBody<Real>&of_a = w.motion[row.body_a], &of_b = w.motion[row.body_b];
      a.velocity += (d * of_a.inverse_mass) * j.linear_a, b.velocity += (d * of_b.inverse_mass) * j.linear_b;
      a.angular_velocity += d * of_a.inverse_inertia * j.angular_a;
      b.angular_velocity += d * of_b.inverse_inertia * j.angular_b;
    }
  }
  for (const VelocityIncrement<Real>& increment : w.scratch.solver.velocity_increments) {
    w.motion[increment.body].velocity += added[increment.body].velocity;
    w.motion[increment.body].angular_velocity += added[increment.body].angular_velocity;
  }
}

template void feed_back_errors(WorldData<float>&, float);
template void feed_back_errors(WorldData<double>&, double);

}  // namespace plumb
