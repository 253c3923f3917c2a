#pragma once

#include "engine/collide/time_of_impact.h"
#include "engine/math/trigonometry.h"

namespace plumb {

/// How a body moves from some place within the step to its end: on a parabola where nothing but constant
/// forces acts on it, else straight, and turning evenly.
struct Flight {
  int body = -1;
  bool covered = false;   ///< see FastBody
  bool expected = false;  ///< likewise
  bool changed = false;   ///< it is not any more as the solver had it
  bool yields = true;     ///< may be thrown back where it first touches something
  int impacts = 0;        ///< in this step
  int version = 0;        ///< of what follows

  Vec2d first{};              ///< m, where the step started
  double from = 0;            ///< fraction of the step
  Vec2d start{}, way{};       ///< m, of the centre of mass at `from`, and the way on to the step's end
  Vec2d curve{};              ///< m, by how much more, in proportion to the square of the time
  Rotation<double> rotation;  ///< at `from`
  double turn = 0;            ///< rad, until the step's end
  double turned_before = 0;   ///< rad, from the step's start to `from`

  Vec2d velocity{}, gain{};     ///< m/s, at `from`, and what it gains in a whole step
  double angular_velocity = 0;  ///< rad/s

  /// The share of what is left at `from` that is over at a fraction of the step.
  double share(double fraction) const { return from < 1 ? (fraction - from) / (1 - from) : 1; }
  Vec2d start_at(double fraction) const {
    const double s = share(fraction);
    return start + s * (way + s * curve);
  }
  Vec2d end() const { return start + (way + curve); }
  Rotation<double> rotation_at(double fraction) const {
    const double angle = share(fraction) * turn;
    if (angle == 0) return rotation;
    const Rotation<double> r = rotation_of(angle);
    return {rotation.c * r.c - rotation.s * r.s, rotation.s * r.c + rotation.c * r.s};
  }
  Vec2d velocity_at(double fraction) const { return velocity + (fraction - from) * gain; }

  /// The rest of the way from a fraction on, seen from `origin`.
  Sweep<double> sweep(double fraction, Vec2d origin) const {
    const double s = share(fraction), left = 1 - s;
    return {start_at(fraction) - origin, left * (way + (2 * s) * curve), rotation_at(fraction), left * turn,
            (left * left) * curve};
  }
  /// Goes on from a fraction of the step with new velocities; `dt` is the step, s.
  void go_on(double fraction, Vec2d new_velocity, double new_spin, double dt) {
    turn_to(fraction);
    const double left = (1 - fraction) * dt;
    velocity = new_velocity, angular_velocity = new_spin;
    way = left * velocity, curve = (0.5 * left * (1 - fraction)) * gain, turn = left * new_spin;
    ++impacts;
  }
  /// Stays where it is at a fraction of the step.
  void stop(double fraction) {
    velocity = velocity_at(fraction);
    turn_to(fraction);
    gain = way = curve = {}, turn = 0;
  }

 private:
  // Begins anew at a fraction of the step.
  void turn_to(double fraction) {
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
