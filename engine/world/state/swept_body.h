#pragma once

#include "engine/collision/distance/time_of_impact.h"
#include "engine/math/trigonometry.h"
#include "engine/world/definitions.h"

namespace plumb {

/// Motion of a body from some time within the step to its end. The path is a parabola if only constant forces
/// act, otherwise straight; the rotation is uniform.
struct SweptBody {
  int body = -1;
  bool covered = false;   ///< see FastBody
  bool expected = false;  ///< see FastBody
  bool changed = false;   ///< no longer the solver's result
  bool yields = true;     ///< may rebound at an impact
  bool shown = false;     ///< true while the whole swept AABB is in the tree
  bool stands = false;    ///< stopped for the rest of the step
  bool squeezed = false;  ///< stopped between the body that pushes it and another one
  int impacts = 0;        ///< impacts with rebound in this step
  int lifts = 0;          ///< times it was lifted off a surface that it rests on
  int version = 0;        ///< counts changes of the trajectory
  int carrier = -1;       ///< kinematic body that pushes it along for the rest of the step

  Vec2d first{};              ///< m, centre of mass at the step's start
  double from = 0;            ///< fraction of the step
  Vec2d start{}, way{};       ///< m, centre of mass at `from`, and displacement until the step's end
  Vec2d curve{};              ///< m, quadratic part of the displacement; 0 if there is an arm
  Rotation<double> rotation;  ///< at `from`
  double turn = 0;            ///< rad, rotation until the step's end
  double turned_before = 0;   ///< rad, from the step's start to `from`
  /// m, from the centre of mass to the body's point that moves straight, in the body's frame. Bodies that
  /// rotate about a hinge, or are pushed by a rotating body, move on an arc about that point.
  Vec2d arm{};

  Vec2d shift{};                ///< m, displacement that closes the joints where the body stops
  Vec2d velocity{}, gain{};     ///< m/s, at `from`, and its gain in a whole step
  double angular_velocity = 0;  ///< rad/s

  /// Returns the elapsed fraction of the time from `from` to the step's end.
  double share(double fraction) const { return from < 1 ? (fraction - from) / (1 - from) : 1; }
  Vec2d start_at(double fraction) const {
    return arm == Vec2d{} ? centre_at(fraction) : straight_at(fraction) - rotation_at(fraction) * arm;
  }
  /// Returns the position of the point at `arm`, m.
  Vec2d straight_at(double fraction) const {
    if (arm == Vec2d{}) return centre_at(fraction);
    const Vec2d there = start + rotation * arm;
    return there + share(fraction) * (start + way + rotation_at(1) * arm - there);
  }
  Rotation<double> rotation_at(double fraction) const {
    const double angle = share(fraction) * turn;
    if (angle == 0) return rotation;
    const Rotation<double> r = rotation_of(angle);
    return {rotation.c * r.c - rotation.s * r.s, rotation.s * r.c + rotation.c * r.s};
  }
  Vec2d velocity_at(double fraction) const { return velocity + (fraction - from) * gain; }

  /// Returns the remaining motion of the point at `arm`, relative to `origin`.
  Sweep<double> sweep(double fraction, Vec2d origin) const {
    const double s = share(fraction), left = 1 - s;
    const Vec2d there = straight_at(fraction);
    if (arm != Vec2d{}) return {there - origin, straight_at(1) - there, rotation_at(fraction), left * turn};
    return {there - origin, left * (way + (2 * s) * curve), rotation_at(fraction), left * turn,
            (left * left) * curve};
  }
  /// Continues from a fraction of the step with new velocities, after an impact; `dt` is the step, s.
  void go_on(double fraction, Vec2d new_velocity, double new_spin, double dt) {
    begin_anew(fraction);
    const double left = (1 - fraction) * dt;
    velocity = new_velocity, angular_velocity = new_spin;
    way = left * velocity, curve = (0.5 * left * (1 - fraction)) * gain, turn = left * new_spin;
    arm = {}, stands = false, carrier = -1;
    ++impacts;
  }
  /// Continues from a fraction of the step with unchanged velocities, but displaced by `by` (m) at the step's
  /// end.
  void go_on_lifted(double fraction, Vec2d by) {
    const double s = share(fraction), left = 1 - s, rest = left * turn;
    const Vec2d rest_way = left * (way + (2 * s) * curve), rest_curve = (left * left) * curve;
    velocity = velocity_at(fraction);
    begin_anew(fraction);
    way = rest_way + by, curve = rest_curve, turn = rest;
    stands = false;
    ++lifts;
  }
  /// Stops at a fraction of the step.
  void stop(double fraction) {
    velocity = velocity_at(fraction);
    begin_anew(fraction);
    gain = way = curve = arm = {}, turn = 0;
    stands = true;
  }
  /// Continues from a fraction of the step as a rigid part of `pusher`, except along locked axes.
  void go_along(const SweptBody& pusher, double fraction, BodyLocks locks) {
    velocity = velocity_at(fraction);
    begin_anew(fraction);
    gain = curve = {};
    const Vec2d there = pusher.straight_at(fraction);
    turn = (1 - pusher.share(fraction)) * pusher.turn;
    arm = rotation.inverse() * (there - start);
    const Rotation<double> r = rotation_of(turn);
    way = pusher.straight_at(1) - r * (there - start) - start;
    if (locks.x || locks.y || locks.rotation) arm = {};  // moves straight then
    if (locks.x) way.x = 0;
    if (locks.y) way.y = 0;
    if (locks.rotation) turn = 0;
    stands = false;
    carrier = pusher.body;
  }

 private:
  // Returns the position, m, of a body without an arm.
  Vec2d centre_at(double fraction) const {
    const double s = share(fraction);
    return start + s * (way + s * curve);
  }
  void begin_anew(double fraction) {
    const Vec2d place = start_at(fraction);
    const Rotation<double> facing = rotation_at(fraction);
    turned_before += share(fraction) * turn;
    start = place, rotation = facing, from = fraction;
    changed = true;
    ++version;
  }
};

/// Next time-of-impact event of a swept body.
struct ToiEvent {
  double fraction = 1;  ///< of the step; 1: no impact
  int flight = 0;       ///< its index
  int version = 0;      ///< version of the swept body when the event was found
  int shape = -1, other = -1;
  int other_version = 0;  ///< version of the other body's flight then; 0 for the solver's motion
};

}  // namespace plumb
