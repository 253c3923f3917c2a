#pragma once

#include "harness/course/lab.h"

/// Short scenes of chapters 4 and 5 that other scenes leave open: corners and ends of turned boxes, springs
/// and sticks at points off the centre, and torques that begin and end.
namespace plumb::course {

/// A ball that is thrown at a static box.
struct Rebound {
  double back = 0;  ///< m/s, towards where it came from
  double deep = 0;  ///< m, deepest that it overlaps the box on its way
};

/// Throws a ball at 2 m/s at the corner of a square that is turned by 45 degrees, from its left.
Rebound off_a_corner(const Lab& lab);

/// Throws a ball at 2 m/s at the end of a thin rod, 2 m high, that is turned by 1.5 rad, along the rod.
Rebound off_a_rods_end(const Lab& lab);

struct Spin {
  double is = 0, due = 0;  ///< rad/s
};

/// Pulls a turned box by a damped spring at a point off its centre. Both are equal if the engine refuses
/// springs. Throws `NotYet` if it refuses boxes.
Spin by_a_spring(const Lab& lab);

/// Pushes a turned box by a force that turns with it. Both are equal if the engine refuses the scene.
Spin by_a_force_of_the_box(const Lab& lab);

/// Turns a box by a torque from 0.2 s to 0.4 s.
Spin by_a_torque_for_a_time(const Lab& lab);

/// Turns a box on which drag acts: drag is a force at its centre, so that its spin stays.
Spin under_drag(const Lab& lab);

/// Returns the farthest, m, that two balls on a stick sink in a floor that is the last body.
double sinks_of_joined_balls(const Lab& lab);

struct Stretch {
  double change = 0;  ///< m, largest change of length
  double speed = 0;   ///< m/s, fastest that the ends part or close, by their velocities
};

/// Throws a ball in the air that a stick joins to the end of a rod.
Stretch stick_at_a_rods_end(const Lab& lab);

struct Tilt {
  double is = 0, due = 0;  ///< rad
  double tolerance = 0;    ///< rad: the way of two and a half steps
};

/// Puts a plank on a pillar, with its centre beyond the pillar's right (`side` 1) or left (-1) end: it tips
/// about that end. The pillar is the first body or the last one.
Tilt tips_over_an_end(const Lab& lab, double side, bool pillar_first);

/// Returns vx, m/s, of a ball at rest that the end of a rod hits which turns at 2 rad/s, and what it should
/// be.
Spin hit_by_a_turning_rod(const Lab& lab);

}  // namespace plumb::course
