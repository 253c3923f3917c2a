#pragma once

#include "engine/collision/distance/time_of_impact.h"
#include "engine/math/trigonometry.h"
#include "engine/world/definitions.h"

namespace plumb {

/// Swept motion of a body from a fraction of the step to its end. The path is a parabola if only constant
/// forces act, otherwise straight; the rotation is uniform.
struct SweptBody {
  int body = -1;
  bool covered = false;          ///< see FastBody
  bool expected = false;         ///< see FastBody
  bool changed = false;          ///< differs from the solver's motion
  bool resolves_impacts = true;  ///< impacts set its velocity (rebound.h); false: they stop it
  bool has_swept_aabb = false;   ///< true while the whole swept AABB is in the tree
  bool stopped = false;          ///< stopped for the rest of the step
  bool squeezed = false;         ///< stopped between the body that pushes it and another one
  bool is_held = false;          ///< by joints: kinematic bodies that press on it move through it
  int impacts = 0;               ///< resolved impacts in this step
  int lifts = 0;                 ///< times it was lifted off a surface that it rests on
  int version = 0;               ///< counts changes of the trajectory
  int pushed_by = -1;            ///< kinematic body that it moves with until the step's end; -1: none
  int group = -1;                ///< swept bodies with the same one move together (common_motion.h); -1: none

  Vec2d step_start{};  ///< m, centre of mass at the step's start
  double from = 0;     ///< fraction of the step
  Vec2d start{},
      displacement{};  ///< m, centre of mass at `from`; displacement until the step's end, without `curve`
  Vec2d curve{};       ///< m, quadratic part of the displacement; 0 if there is an arm
  Rotation<double> rotation;      ///< at `from`
  double delta_angle = 0;         ///< rad, rotation until the step's end
  double delta_angle_before = 0;  ///< rad, from the step's start to `from`
  /// m, from the centre of mass to the pivot, in the body's frame. The pivot moves straight: it is the hinge
  /// or the pushing body's point about which the body moves on an arc. 0: no pivot.
  Vec2d arm{};

  Vec2d joint_correction{};            ///< m, displacement that closes the joints where the body stops
  Vec2d velocity{}, delta_velocity{};  ///< m/s, at `from`; its change in a whole step by forces
  double angular_velocity = 0;         ///< rad/s

  /// Returns the elapsed fraction of the time from `from` to the step's end.
  double elapsed_fraction(double fraction) const { return from < 1 ? (fraction - from) / (1 - from) : 1; }
  Vec2d position_at(double fraction) const {
    return arm == Vec2d{} ? centre_position_at(fraction) : pivot_at(fraction) - rotation_at(fraction) * arm;
  }
  /// Returns the position of the pivot, m.
  Vec2d pivot_at(double fraction) const {
    if (arm == Vec2d{}) return centre_position_at(fraction);
    const Vec2d pivot = start + rotation * arm;
    return pivot + elapsed_fraction(fraction) * (start + displacement + rotation_at(1) * arm - pivot);
  }
  Rotation<double> rotation_at(double fraction) const {
    const double angle = elapsed_fraction(fraction) * delta_angle;
    if (angle == 0) return rotation;
    const Rotation<double> r = rotation_of(angle);
    return {rotation.c * r.c - rotation.s * r.s, rotation.s * r.c + rotation.c * r.s};
  }
  Vec2d velocity_at(double fraction) const { return velocity + (fraction - from) * delta_velocity; }

  /// Returns the remaining motion of the pivot, relative to `origin`.
  Sweep<double> sweep(double fraction, Vec2d origin) const {
    const double s = elapsed_fraction(fraction), remaining = 1 - s;
    const Vec2d pivot = pivot_at(fraction);
    if (arm != Vec2d{})
      return {pivot - origin, pivot_at(1) - pivot, rotation_at(fraction), remaining * delta_angle};
    return {pivot - origin, remaining * (displacement + (2 * s) * curve), rotation_at(fraction),
            remaining * delta_angle, (remaining * remaining) * curve};
  }
  /// Continues from a fraction of the step with new velocities, after an impact; `dt` is the step, s.
  void continue_from(double fraction, Vec2d new_velocity, double new_spin, double dt) {
    advance_to(fraction);
    const double remaining = (1 - fraction) * dt;
    velocity = new_velocity, angular_velocity = new_spin;
    displacement = remaining * velocity, curve = (0.5 * remaining * (1 - fraction)) * delta_velocity,
    delta_angle = remaining * new_spin;
    arm = {}, stopped = false, pushed_by = -1;
    ++impacts;
  }
  /// Continues from a fraction of the step with unchanged velocities, but displaced by `by` (m) at the step's
  /// end.
  void continue_lifted(double fraction, Vec2d by) {
    const double s = elapsed_fraction(fraction), remaining = 1 - s, new_angle = remaining * delta_angle;
    const Vec2d new_displacement = remaining * (displacement + (2 * s) * curve),
                new_curve = (remaining * remaining) * curve;
    velocity = velocity_at(fraction);
    advance_to(fraction);
    displacement = new_displacement + by, curve = new_curve, delta_angle = new_angle;
    stopped = false;
    ++lifts;
  }
  /// Stops at a fraction of the step.
  void stop_at(double fraction) {
    velocity = velocity_at(fraction);
    advance_to(fraction);
    delta_velocity = displacement = curve = arm = {}, delta_angle = 0;
    stopped = true;
  }
  /// Continues from a fraction of the step as a rigid part of `pusher`, except along locked axes.
  void continue_pushed(const SweptBody& pusher, double fraction, BodyLocks locks) {
    velocity = velocity_at(fraction);
    advance_to(fraction);
    delta_velocity = curve = {};
    const Vec2d pivot = pusher.pivot_at(fraction);
    delta_angle = (1 - pusher.elapsed_fraction(fraction)) * pusher.delta_angle;
    arm = rotation.inverse() * (pivot - start);
    const Rotation<double> r = rotation_of(delta_angle);
    displacement = pusher.pivot_at(1) - r * (pivot - start) - start;
    if (locks.x || locks.y || locks.rotation) arm = {};  // moves straight then
    if (locks.x) displacement.x = 0;
    if (locks.y) displacement.y = 0;
    if (locks.rotation) delta_angle = 0;
    stopped = false;
    pushed_by = pusher.body;
  }

 private:
  // Returns the position, m, of a body without an arm.
  Vec2d centre_position_at(double fraction) const {
    const double s = elapsed_fraction(fraction);
    return start + s * (displacement + s * curve);
  }
  void advance_to(double fraction) {
    const Vec2d new_start = position_at(fraction);
    const Rotation<double> new_rotation = rotation_at(fraction);
    delta_angle_before += elapsed_fraction(fraction) * delta_angle;
    start = new_start, rotation = new_rotation, from = fraction;
    changed = true, group = -1;
    ++version;
  }
};

/// First time of impact of a swept body.
struct ToiEvent {
  double fraction = 1;  ///< of the step; 1: no impact
  int swept_body = 0;   ///< its index
  int version = 0;      ///< version of the swept body when the event was found
  int shape = -1, other = -1;
  int other_version = 0;  ///< version of the other swept body then; 0 for the solver's motion
  bool lasts = false;     ///< not searched for: the bodies stay together after an impact
};

}  // namespace plumb
