#include "engine/world/continuous/joined_stops.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/world/ablation/ablation.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Returns twice the work of forces, without those of contacts and joints, on a body in the step, J. A body
// that is not awake moves freely, with the mean of its velocities.
template <class Real>
double twice_work_on(const WorldData<Real>& w, int body, double dt) {
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  const SolverBody<Real>& motion = w.motion[body];
  const BodyRecord<Real>& record = w.bodies[body];
  const auto work = [&](Vec2<Real> gain, Real spin_gain) {
    return 2 * static_cast<double>(record.mass * dot(gain, motion.delta_position) +
                                   record.inertia * spin_gain * motion.delta_angle);
  };
  const auto awake_index_of = [&](int each) { return w.bodies[each].awake_index; };
  const auto found = std::lower_bound(increments.begin(), increments.end(), awake_index_of(body),
                                      [&](const VelocityIncrement<Real>& increment, int index) {
                                        return awake_index_of(increment.body) < index;
                                      });
  if (found != increments.end() && found->body == body) return work(found->velocity, found->spin) / w.last_h;
  const Real inverse = static_cast<Real>(1 / dt);
  return 2 *
         work(motion.velocity - inverse * motion.delta_position,
              motion.angular_velocity - inverse * motion.delta_angle) /
         dt;
}

// Quantity of its anchors that a joint fixes.
enum class AnchorConstraint { No, Length, Place };

// A rod fixes a length, however its ends rotate; other joints fix a point, or a line, in the frame of a.
template <class Definition>
constexpr AnchorConstraint anchor_constraint_of(const Definition&) {
  if constexpr (std::is_same_v<Definition, DistanceDefinition>) return AnchorConstraint::Length;
  if constexpr (std::is_same_v<Definition, PulleyDefinition>) return AnchorConstraint::No;
  return requires(Definition d) { d.anchor_a; }
  ? AnchorConstraint::Place : AnchorConstraint::No;
}

}  // namespace

template <class Real>
void remove_remaining_work(WorldData<Real>& w, const std::vector<int>& indices, double fraction, double dt) {
  if (!enabled(Switch::RemainingWork)) return;
  double work = 0, twice_energy = 0;
  for (const int index : indices) {
    const int body = w.scratch.continuous.swept_bodies[index].body;
    if (w.scratch.continuous.swept_bodies[index].impacts > 0) return;  // its velocity is that after an impact
    const BodyRecord<Real>& record = w.bodies[body];
    const SolverBody<Real>& motion = w.motion[body];
    work += twice_work_on(w, body, dt);
    twice_energy += static_cast<double>(record.mass * length_squared(motion.velocity) +
                                        record.inertia * motion.angular_velocity * motion.angular_velocity);
  }
  const double allowed = twice_energy - (1 - fraction) * work;
  if (!(work > 0 && allowed >= 0)) return;
  const Real scale = static_cast<Real>(std::sqrt(allowed / twice_energy));
  for (const int index : indices) {
    SolverBody<Real>& motion = w.motion[w.scratch.continuous.swept_bodies[index].body];
    motion.velocity *= scale, motion.angular_velocity *= scale;
  }
}

template <class Real>
void find_joint_corrections(WorldData<Real>& w, const std::vector<int>& indices, double fraction) {
  std::vector<SweptBody>& swept_bodies = w.scratch.continuous.swept_bodies;
  for (std::size_t next = 0; next < indices.size(); ++next) {
    SweptBody& swept = swept_bodies[indices[next]];
    swept.joint_correction = {};
    if (!enabled(Switch::JoinedStops) || next == 0 || swept.changed || swept.arm != Vec2d{}) continue;
    for_each_edge(w.joints, w.bodies[swept.body].first_joint, [&](int edge, const JointRecord& joint) {
      const bool is_a = (edge & 1) == 0;
      const int other_index = w.scratch.continuous.swept_index_of[is_a ? joint.body_b : joint.body_a];
      const auto placed = indices.begin() + static_cast<std::ptrdiff_t>(next);
      if (!joint.active || swept.joint_correction != Vec2d{} ||
          std::find(indices.begin(), placed, other_index) == placed)
        return;
      const SweptBody& other = swept_bodies[other_index];
      Vec2d arm = w.bodies[swept.body].centre.template as<double>(),
            other_arm = w.bodies[other.body].centre.template as<double>();
      const AnchorConstraint constraint = std::visit(
          [&](const auto& kind) {
            if constexpr (requires { kind.anchor_a; }) {
              arm = (is_a ? kind.anchor_a : kind.anchor_b) - arm;
              other_arm = (is_a ? kind.anchor_b : kind.anchor_a) - other_arm;
            }
            return anchor_constraint_of(kind);
          },
          w.joint_set.definition(joint.slot));
      const auto anchor_offset = [&](double at) {
        return swept.position_at(at) + swept.rotation_at(at) * arm - other.position_at(at) -
               other.rotation_at(at) * other_arm;
      };
      const Vec2d offset = anchor_offset(fraction);
      Vec2d target_offset = offset;
      if (constraint == AnchorConstraint::Length) {
        const double length_at_stop = length(offset);
        const double target_length =
            (1 - fraction) * length(anchor_offset(0)) + fraction * length(anchor_offset(1));
        if (length_at_stop > 0) target_offset = (target_length / length_at_stop) * offset;
      } else if (constraint == AnchorConstraint::Place) {
        const SweptBody& frame = is_a ? swept : other;
        const auto seen_from_a = [&](double at) {
          return frame.rotation_at(at).inverse() * anchor_offset(at);
        };
        target_offset =
            frame.rotation_at(fraction) * ((1 - fraction) * seen_from_a(0) + fraction * seen_from_a(1));
      } else {
        return;
      }
      swept.joint_correction = other.joint_correction + target_offset - offset;
      const BodyLocks locks = w.bodies[swept.body].locks();
      if (locks.x) swept.joint_correction.x = 0;
      if (locks.y) swept.joint_correction.y = 0;
    });
  }
}

#define PLUMB_FOR(Real)                                                                           \
  template void remove_remaining_work(WorldData<Real>&, const std::vector<int>&, double, double); \
  template void find_joint_corrections(WorldData<Real>&, const std::vector<int>&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
