#pragma once

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

/// Returns the largest change of velocity, m/s, of two balls that pass a static box without touching it: one
/// falls past its end, one flies over it.
double turn_at_platform(const Lab& lab);

}  // namespace plumb::course
