#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/course/lab.h"

/// Building blocks of the checks' scenes. Friction is 0 unless a check sets it.
namespace plumb::course {

/// Diagnosis of `pushed_too_far`.
inline constexpr const char* kPushedTooFar =
    "A step moves the two apart by more than they overlap, so that the next step finds no contact and their "
    "velocities never change. Is the depth right? Remove a share of it, and leave the last half millimetre.";

struct Ball {
  std::string name = "ball";
  Vec2d position{}, velocity{};
  double mass = 1;
  double radius = 0.4;  ///< not 0.5: with a sum of 1 m, an unnormalised normal is correct by chance
  double restitution = 1;
};

Body make(const Ball& ball);

struct Crate {
  std::string name = "box";
  Vec2d position{}, velocity{};
  double angle = 0, angular_velocity = 0;
  double mass = 1;
  double width = 1, height = 1;
  double restitution = 1;
  double friction = 0;
};

Body make(const Crate& crate);

/// Returns `body` as a static body.
Body fixed(Body body);

Scene scene_of(std::string name, Vec2d gravity, std::vector<Body> bodies);

/// Returns the force `force` on the body's point `point` from `start` for `duration`.
PointForce push(const std::string& body, Vec2d force, Vec2d point = {});

/// Returns the least gain of downward speed in a step, divided by g dt, over the steps in which a ball of
/// radius r is above the floor at 0 before and after the step. It is 1 for any method.
double least_gain_above(const Lab& lab, const Trace& trace, double r, double g);

/// Returns the largest change of velocity, m/s, of three balls that pass a static box without touching it:
/// one falls past its end, one past its corner, and one flies over it.
double turn_at_platform(const Lab& lab);

/// Returns a wall that the ball has passed, right and left first; empty if the ball is in the room.
std::string wall_passed(const BodyState& s, double half_width, double half_height);

/// Returns true if the velocity along the axis on which the ball leaves the room is constant from the last
/// state before the wall: the wall has then not acted. Walls stop the centre at `x` and `y`. A ball of radius
/// `r` that may jump over a wall within a step does not count.
bool leaves_straight(const Trace& trace, double x, double y, double r);

/// Throws a ball in each direction, far from the only box of its scene. If it turns round, walls are
/// hard-coded; returns a description of the first.
std::optional<std::string> wall_of_no_scene(const Lab& lab);

inline constexpr double kSlow = 0.02, kFast = 50;  // m/s

/// A ball that is thrown without gravity.
struct Fling {
  double way = 0, due = 0;  ///< m
  double speed = 0;         ///< m/s, the largest component after the first step
  bool held = false;        ///< the ball stays in place, or stops at once
  bool limited = false;     ///< the velocity is cut in the first step, and constant from then on
};

/// Throws a ball at `speed`, mostly along x.
Fling fling(const Lab& lab, double speed, double duration);

inline constexpr const char* kSlowIsHeld =
    "A ball of 0.02 m/s stays in place: slow bodies move as fast ones do. Leave out what sets small "
    "velocities to 0, "
    "or skips the move of slow bodies.";

/// Returns the description of a largest speed.
std::string limit_text(double speed);

}  // namespace plumb::course
