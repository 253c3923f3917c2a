#pragma once

#include "engine/collide/time_of_impact.h"
#include "engine/math/trigonometry.h"

namespace plumb {

/// How a body moves from some place within the step to its end. Its way is straight, and turns evenly; the
/// velocity and the time of an impact are those of its true motion, with constant acceleration, that keeps
/// its energy.
struct Flight {
  int body = -1;
  bool covered = false;   ///< see FastBody
  bool changed = false;   ///< it is not any more as the solver had it
  bool yields = true;     ///< may be thrown back where it first touches something
  bool known = false;     ///< what its true motion is
  bool shown = false;     ///< all of its way is stored in the tree
  bool stands = false;    ///< it has been stopped for the rest of the step
  bool squeezed = false;  ///< between what pushes it along and something else
  int impacts = 0;        ///< in this step
  int version = 0;        ///< of what follows
  int carrier = -1;       ///< the kinematic body that it is pushed along by for the rest of the step

  Vec2d first{};              ///< m, where the step started
  double from = 0;            ///< fraction of the step
  Vec2d start{}, way{};       ///< m, of the centre of mass at `from`, and on to the step's end
  Rotation<double> rotation;  ///< at `from`
  double turn = 0;            ///< rad, until the step's end
  double turned_before = 0;   ///< rad, from the step's start to `from`
  /// m, from the centre of mass to the point of the body whose way is straight, in the body's frame: what
  /// turns about a hinge, or is pushed along by what turns, goes round in an arc.
  Vec2d arm{};

  double time = 0;                               ///< s, from the step's start
  Vec2d position{}, velocity{}, acceleration{};  ///< m, m/s, m/s^2 at `time`
  double angular_velocity = 0;                   ///< rad/s

  /// The share of what is left at `from` that is over at a fraction of the step.
  double share(double fraction) const { return from < 1 ? (fraction - from) / (1 - from) : 1; }
  Vec2d start_at(double fraction) const {
    if (arm == Vec2d{}) return start + share(fraction) * way;
    return straight_at(fraction) - rotation_at(fraction) * arm;
  }
  /// Where the point at `arm` is.
  Vec2d straight_at(double fraction) const {
    if (arm == Vec2d{}) return start + share(fraction) * way;
    const Vec2d there = start + rotation * arm;
    return there + share(fraction) * (start + way + rotation_at(1) * arm - there);
  }
  Rotation<double> rotation_at(double fraction) const {
    const double angle = share(fraction) * turn;
    if (angle == 0) return rotation;
    const Rotation<double> r = rotation_of(angle);
    return {rotation.c * r.c - rotation.s * r.s, rotation.s * r.c + rotation.c * r.s};
  }
  Vec2d position_at(double t) const {
    return position + (t - time) * (velocity + (0.5 * (t - time)) * acceleration);
  }
  Vec2d velocity_at(double t) const { return velocity + (t - time) * acceleration; }

  /// The rest of the way from a fraction on, of the point at `arm`, seen from `origin`.
  Sweep<double> sweep(double fraction, Vec2d origin) const {
    const double left = 1 - share(fraction);
    if (arm == Vec2d{}) return {start_at(fraction) - origin, left * way, rotation_at(fraction), left * turn};
    const Vec2d there = straight_at(fraction);
    return {there - origin, straight_at(1) - there, rotation_at(fraction), left * turn};
  }
  /// Goes on from a fraction of the step, that is time t, with new velocities; `dt` is the step, s.
  void go_on(double fraction, double t, Vec2d new_velocity, double new_spin, double dt) {
    const Vec2d place = start_at(fraction);
    const Rotation<double> facing = rotation_at(fraction);
    turned_before += share(fraction) * turn;
    position = position_at(t), velocity = new_velocity, angular_velocity = new_spin, time = t;
    way = position_at(dt) - place, turn = (dt - t) * new_spin;
    start = place, rotation = facing, from = fraction, arm = {};
    changed = true, stands = false, carrier = -1;
    ++version, ++impacts;
  }
  /// Stays where it is at a fraction of the step; `t` as above.
  void stop(double fraction, double t) {
    halt(fraction, t);
    way = {}, turn = 0, arm = {};
    stands = true;
  }
  /// Goes on from a fraction of the step, that is time t, as if it were a part of what pushes it along.
  void go_along(const Flight& pusher, double fraction, double t) {
    halt(fraction, t);
    const Vec2d there = pusher.straight_at(fraction);
    turn = (1 - pusher.share(fraction)) * pusher.turn;
    arm = rotation.inverse() * (there - start);
    const Rotation<double> r = rotation_of(turn);
    way = pusher.straight_at(1) - r * (there - start) - start;
    stands = false;
    carrier = pusher.body;
  }

 private:
  void halt(double fraction, double t) {
    const Vec2d place = start_at(fraction);
    const Rotation<double> facing = rotation_at(fraction);
    turned_before += share(fraction) * turn;
    velocity = velocity_at(t), acceleration = {}, time = t, position = place;
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
