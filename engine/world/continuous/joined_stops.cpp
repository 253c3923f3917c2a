#include "engine/world/continuous/joined_stops.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Returns twice the work of forces, without those of contacts and joints, on a body in the step, J. Solver
// bodies are in the order of `awake`; a body that is not among them flies freely, with the mean of its
// velocities.
template <class Real>
double twice_work_on(const WorldData<Real>& w, int body, double dt) {
  const std::vector<VelocityIncrement<Real>>& kicks = w.scratch.kicks;
  const BodyMotion<Real>& motion = w.motion[body];
  const BodyRecord<Real>& record = w.bodies[body];
  const auto work = [&](Vec2<Real> gain, Real spin_gain) {
    return 2 * static_cast<double>(record.mass * dot(gain, motion.moved) +
                                   record.inertia * spin_gain * motion.turned);
  };
  const auto place_of = [&](int each) { return w.bodies[each].awake_index; };
  const auto found = std::lower_bound(
      kicks.begin(), kicks.end(), place_of(body),
      [&](const VelocityIncrement<Real>& kick, int place) { return place_of(kick.body) < place; });
  if (found != kicks.end() && found->body == body) return work(found->velocity, found->spin) / w.last_h;
  const Real inverse = static_cast<Real>(1 / dt);
  return 2 *
         work(motion.velocity - inverse * motion.moved, motion.angular_velocity - inverse * motion.turned) /
         dt;
}

// Constraint of a joint between the anchors of its bodies.
enum class Hold { No, Length, Place };

// A rod fixes a length, however its ends rotate; other joints fix a point, or a line, in the frame of a.
template <class Definition>
constexpr Hold hold_of(const Definition&) {
  if constexpr (std::is_same_v<Definition, DistanceDefinition>) return Hold::Length;
  if constexpr (std::is_same_v<Definition, PulleyDefinition>) return Hold::No;
  return requires(Definition d) { d.anchor_a; }
  ? Hold::Place : Hold::No;
}

}  // namespace

template <class Real>
void take_unmoved_work(WorldData<Real>& w, const std::vector<int>& places, double fraction, double dt) {
  double work = 0, after = 0;
  for (const int place : places) {
    const int body = w.scratch.swept_bodies[place].body;
    if (w.scratch.swept_bodies[place].impacts > 0) return;  // its velocity is already that after an impact
    const BodyRecord<Real>& record = w.bodies[body];
    const BodyMotion<Real>& motion = w.motion[body];
    work += twice_work_on(w, body, dt);
    after += static_cast<double>(record.mass * length_squared(motion.velocity) +
                                 record.inertia * motion.angular_velocity * motion.angular_velocity);
  }
  const double most = after - (1 - fraction) * work;
  if (!(work > 0 && most >= 0)) return;
  const Real keep = static_cast<Real>(std::sqrt(most / after));
  for (const int place : places) {
    BodyMotion<Real>& motion = w.motion[w.scratch.swept_bodies[place].body];
    motion.velocity *= keep, motion.angular_velocity *= keep;
  }
}

template <class Real>
void find_shifts(WorldData<Real>& w, const std::vector<int>& places, double fraction) {
  std::vector<SweptBody>& flights = w.scratch.swept_bodies;
  for (std::size_t next = 0; next < places.size(); ++next) {
    SweptBody& flight = flights[places[next]];
    flight.shift = {};
    if (next == 0 || flight.changed || flight.arm != Vec2d{}) continue;
    for_each_edge(w.joints, w.bodies[flight.body].first_joint, [&](int edge, const JointRecord& joint) {
      const bool is_a = (edge & 1) == 0;
      const int other_place = w.scratch.swept_body_places[is_a ? joint.body_b : joint.body_a];
      const auto placed = places.begin() + static_cast<std::ptrdiff_t>(next);
      if (!joint.active || flight.shift != Vec2d{} ||
          std::find(places.begin(), placed, other_place) == placed)
        return;
      const SweptBody& other = flights[other_place];
      Vec2d arm = w.bodies[flight.body].centre.template as<double>(),
            other_arm = w.bodies[other.body].centre.template as<double>();
      const Hold hold = std::visit(
          [&](const auto& kind) {
            if constexpr (requires { kind.anchor_a; }) {
              arm = (is_a ? kind.anchor_a : kind.anchor_b) - arm;
              other_arm = (is_a ? kind.anchor_b : kind.anchor_a) - other_arm;
            }
            return hold_of(kind);
          },
          w.joint_set.definition(joint.slot));
      const auto between = [&](double at) {
        return flight.start_at(at) + flight.rotation_at(at) * arm - other.start_at(at) -
               other.rotation_at(at) * other_arm;
      };
      const Vec2d found = between(fraction);
      Vec2d wanted = found;
      if (hold == Hold::Length) {
        const double length_now = length(found);
        const double kept = (1 - fraction) * length(between(0)) + fraction * length(between(1));
        if (length_now > 0) wanted = (kept / length_now) * found;
      } else if (hold == Hold::Place) {
        const SweptBody& frame = is_a ? flight : other;
        const auto seen_from_a = [&](double at) { return frame.rotation_at(at).inverse() * between(at); };
        wanted = frame.rotation_at(fraction) * ((1 - fraction) * seen_from_a(0) + fraction * seen_from_a(1));
      } else {
        return;
      }
      flight.shift = other.shift + wanted - found;
      const BodyLocks locks = w.bodies[flight.body].locks();
      if (locks.x) flight.shift.x = 0;
      if (locks.y) flight.shift.y = 0;
    });
  }
}

#define PLUMB_FOR(Real)                                                                       \
  template void take_unmoved_work(WorldData<Real>&, const std::vector<int>&, double, double); \
  template void find_shifts(WorldData<Real>&, const std::vector<int>&, double);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
