#pragma once

#include <cmath>
#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

/// Parts that scenarios share: bodies, bounds, and truths of scenes in which some bodies do not move.
namespace plumb::scenarios::truth {

inline constexpr double kGravity = 9.81;  ///< m/s^2

/// Returns an empty scene called "name/variant" (or "name"), with gravity downwards.
Scene scene_of(std::string_view name, std::string_view variant = "", double gravity = kGravity);

/// Returns an empty scene called "name[size]", with gravity downwards.
Scene scene_of(std::string_view name, int size, double gravity = kGravity);

Shape solid(const Geometry& geometry, double friction = 0, double restitution = 0);

/// Returns a dynamic body at rest.
Body piece(std::string name, Vec2d position, const Shape& shape, double mass = 1);

/// Returns a hinge of two bodies' anchors, named after both.
RevoluteJoint hinge(std::string_view a, Vec2d anchor_a, std::string_view b, Vec2d anchor_b);

/// Appends 0, 1, 2, ... in their order to the names of bodies that share one.
void name_apart(Scene& scene);

/// Returns the body with the given velocities, m/s and rad/s.
Body thrown(Body body, Vec2d velocity, double angular_velocity = 0);

/// Returns a static body.
Body fixed(std::string name, Vec2d position, const Shape& shape, double angle = 0);

/// Returns static ground, 40 m wide, whose top is y = 0.
Body ground(double friction = 0, double restitution = 0);

/// Returns ground that falls towards +x at `tilt` rad; its top goes through the origin.
Body ramp(double tilt, double friction = 0, double restitution = 0);

/// Returns the body at rest on that ramp, its flat side or its disc `height` m below its centre.
Body on_ramp(double tilt, Body body, double height);

/// Value of each variant.
struct Choice {
  std::string_view variant;
  double value;
};

/// Returns the value of `variant`, which must be among `choices`.
double choose(std::string_view variant, std::initializer_list<Choice> choices);

/// Returns the bound `digits` for every quantity, in its SI unit; for scenes of about a metre and a second.
Bounds within(double digits);

/// Returns the bounds of a motion that second-order methods compute exactly up to rounding.
inline Bounds exact_but_for_rounding() { return within(0); }

/// Motions of the dynamic bodies, in the scene's order.
using Moving = std::span<Motion>;

/// Sets the motions of the dynamic bodies at `time`; on entry they have the initial motions.
using Path = std::function<void(Real time, Moving moving)>;

/// Returns the truth of a scene whose static bodies do not move and whose kinematic ones keep their
/// velocities.
Truth follow(const Scene& scene, std::string source, Path path, std::vector<double> impacts = {});

/// Does the same for a scene with persistent contacts, which push and rub between impacts.
Truth follow_in_contact(const Scene& scene, std::string source, Path path, std::vector<double> impacts = {});

/// Returns the truth as one that is integrated.
Truth integrated(Truth truth);

/// Returns the truth of free bodies with a single impact, `at` a time. Each velocity then jumps by its part
/// of `jumps`, in the order of the dynamic bodies.
Truth one_impact(const Scene& scene, std::string source, Real at, std::vector<Acceleration> jumps);

/// Returns the truth of bodies in equilibrium, which stay at rest.
Truth equilibrium(const Scene& scene, std::string source);

/// Returns the motion under an acceleration that ends at `end`, s.
inline Motion coast_until(const Motion& from, Real end, Real time, const Acceleration& acceleration) {
  return coast(coast(from, std::fmin(time, end), acceleration), std::fmax(time - end, Real(0)));
}

}  // namespace plumb::scenarios::truth
