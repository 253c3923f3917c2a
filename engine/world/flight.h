#pragma once

#include "engine/collide/time_of_impact.h"
#include "engine/math/trigonometry.h"
#include "engine/world/definitions.h"

namespace plumb {

/// Describes how a body moves from some place within the step to its end: on a parabola where nothing but
/// constant forces acts on it, else straight, and turning evenly.
struct Flight {
  int body = -1;
  bool covered = false;   ///< see FastBody
  bool expected = false;  ///< likewise
  bool changed = false;   ///< it is not any more as the solver had it
  bool yields = true;     ///< may be thrown back where it first touches something
  bool shown = false;     ///< all of its way is stored in the tree
  bool stands = false;    ///< it has been stopped for the rest of the step
  bool squeezed = false;  ///< between what pushes it along and something else
  int impacts = 0;        ///< in this step
  int version = 0;        ///< of what follows
  int carrier = -1;       ///< the kinematic body that it is pushed along by for the rest of the step

  Vec2d first{};         ///< m, where the step started
  double from = 0;       ///< fraction of the step
  Vec2d start{}, way{};  ///< m, of the centre of mass at `from`, and on to the step's end
  Vec2d curve{};         ///< m, by how much more, in proportion to the square of the time; none with an arm
  Rotation<double> rotation;  ///< at `from`
  double turn = 0;            ///< rad, until the step's end
  double turned_before = 0;   ///< rad, from the step's start to `from`
  /// m, from the centre of mass to the point of the body whose way is straight, in the body's frame: what
  /// turns about a hinge, or is pushed along by what turns, goes round in an arc.
  Vec2d arm{};

  Vec2d velocity{}, gain{};     ///< m/s, at `from`, and what it gains in a whole step
  double angular_velocity = 0;  ///< rad/s

  /// The share of what is left at `from` that is over at a fraction of the step.
  double share(double fraction) const { return from < 1 ? (fraction - from) / (1 - from) : 1; }
  Vec2d start_at(double fraction) const {
    return arm == Vec2d{} ? centre_at(fraction) : straight_at(fraction) - rotation_at(fraction) * arm;
  }
  /// Where the point at `arm` is.
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

  /// The rest of the way from a fraction on, of the point at `arm`, seen from `origin`.
  Sweep<double> sweep(double fraction, Vec2d origin) const {
    const double s = share(fraction), left = 1 - s;
    const Vec2d there = straight_at(fraction);
    if (arm != Vec2d{}) return {there - origin, straight_at(1) - there, rotation_at(fraction), left * turn};
    return {there - origin, left * (way + (2 * s) * curve), rotation_at(fraction), left * turn,
            (left * left) * curve};
  }
  /// Goes on from a fraction of the step with new velocities; `dt` is the step, s.
  void go_on(double fraction, Vec2d new_velocity, double new_spin, double dt) {
    begin_anew(fraction);
    const double left = (1 - fraction) * dt;
    velocity = new_velocity, angular_velocity = new_spin;
    way = left * velocity, curve = (0.5 * left * (1 - fraction)) * gain, turn = left * new_spin;
    arm = {}, stands = false, carrier = -1;
    ++impacts;
  }
  /// Stays where it is at a fraction of the step.
  void stop(double fraction) {
    velocity = velocity_at(fraction);
    begin_anew(fraction);
    gain = way = curve = arm = {}, turn = 0;
    stands = true;
  }
  /// Goes on from a fraction of the step as if it were a part of what pushes it along, but for what is
  /// locked.
  void go_along(const Flight& pusher, double fraction, BodyLocks locks) {
    velocity = velocity_at(fraction);
    begin_anew(fraction);
    gain = curve = {};
    const Vec2d there = pusher.straight_at(fraction);
    turn = (1 - pusher.share(fraction)) * pusher.turn;
    arm = rotation.inverse() * (there - start);
    const Rotation<double> r = rotation_of(turn);
    way = pusher.straight_at(1) - r * (there - start) - start;
    if (locks.x || locks.y || locks.rotation) arm = {};  // and goes straight
    if (locks.x) way.x = 0;
    if (locks.y) way.y = 0;
    if (locks.rotation) turn = 0;
    stands = false;
    carrier = pusher.body;
  }

 private:
  // Of a flight without an arm.
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

/// What a flight is to meet next, as it was found.
struct Meeting {
  double fraction = 1;  ///< of the step; 1: nothing
  int flight = 0;       ///< its place
  int version = 0;      ///< of its way then
  int shape = -1, other = -1;
  int other_version = 0;  ///< of the other one's way, 0 when that is as the solver had it
};

}  // namespace plumb
