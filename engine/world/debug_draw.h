#pragma once

#include <span>
#include <string_view>

#include "engine/world/past_poses.h"
#include "engine/world/world.h"

namespace plumb {

/// What something drawn stands for; who draws chooses the colours.
enum class DrawRole {
  Static,     ///< shapes of static bodies
  Kinematic,  ///< of kinematic ones
  Awake,      ///< of dynamic bodies that move
  Asleep,     ///< of bodies that sleep
  Sensor,     ///< shapes that only report
  Contact,    ///< points where shapes touch
  Normal,     ///< of contacts, from the one shape to the other
  Impulse,    ///< that holds a contact
  Box,        ///< around shapes, as the broad phase has them
  Centre,     ///< of mass, with the body's axes
  JointLine,  ///< anchors, and what is between them
  Name,       ///< of bodies
  // What a program draws over the world:
  Highlight,  ///< shapes that stand out just now
  Force,      ///< arrows of forces
  Aim,        ///< where something would go
  Trail,      ///< where something has been
};

/// Somewhere to draw: a window, a picture, a test. All lengths in m, in the world's frame, y up.
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;
  /// A convex polygon, counter-clockwise, rounded by `radius`.
  virtual void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) = 0;
  /// With the direction in which the body's x axis points.
  virtual void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) = 0;
  virtual void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) = 0;
  virtual void segment(Vec2d start, Vec2d end, DrawRole role) = 0;
  virtual void point(Vec2d point, DrawRole role) = 0;
  virtual void text(Vec2d point, std::string_view text, DrawRole role) = 0;
};

/// What is drawn.
struct DrawOptions {
  bool shapes = true;
  bool joints = true;
  bool contacts = false;  ///< points
  bool normals = false;
  bool impulses = false;
  bool boxes = false;
  bool centres = false;
  bool names = false;
  double normal_length = 0.2;   ///< m
  double impulse_length = 0.1;  ///< m for 1 N s
};

/// Draws the world as it is after the last step: shapes in the order of their bodies' places, then the rest.
template <class Real>
void draw(const BasicWorld<Real>& world, DebugDraw& out, const DrawOptions& options = {});

/// Likewise, but `fraction` (0..1) of the way from where bodies were to where they are.
template <class Real>
void draw(const BasicWorld<Real>& world, const PastPoses<Real>& before, double fraction, DebugDraw& out,
          const DrawOptions& options = {});

}  // namespace plumb
