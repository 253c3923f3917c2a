#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "engine/geometry/aabb.h"
#include "engine/world/past_poses.h"
#include "engine/world/world.h"

namespace plumb {

/// Meaning of a drawn item; the implementation of DebugDraw chooses the colours.
enum class DrawRole {
  Static,     ///< shapes of static bodies
  Kinematic,  ///< shapes of kinematic bodies
  Awake,      ///< shapes of awake dynamic bodies
  Asleep,     ///< shapes of sleeping bodies
  Sensor,     ///< shapes of sensors
  Contact,    ///< points where shapes touch
  Normal,     ///< contact normals, from shape a to shape b
  Impulse,    ///< normal impulses of contacts
  Box,        ///< tight AABBs of shapes
  Centre,     ///< centres of mass, with the body's axes
  JointLine,  ///< anchors, and the lines between them
  Name,       ///< names of bodies
  // For programs that draw over the world:
  Highlight,  ///< highlighted shapes
  Force,      ///< arrows of forces
  Aim,        ///< target of a motion
  Trail,      ///< path of an earlier motion
  Velocity,   ///< arrows of velocities
};

/// Interface to draw to: a window, a picture, a test. All lengths in m, in the world's frame, y up. Its
/// functions may read the world that is drawn; calls that would change it throw Error (Unsupported).
class DebugDraw {
 public:
  virtual ~DebugDraw() = default;
  /// Draws a convex polygon, counter-clockwise, rounded by `radius`.
  virtual void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) = 0;
  /// Draws a circle; `axis` is the direction of the body's x axis.
  virtual void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) = 0;
  virtual void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) = 0;
  virtual void segment(Vec2d start, Vec2d end, DrawRole role) = 0;
  virtual void point(Vec2d point, DrawRole role) = 0;
  virtual void text(Vec2d point, std::string_view text, DrawRole role) = 0;
};

/// Draws a spring between two points: a zigzag, as wide as an eighth of its length.
void draw_spring(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role);

/// Draws a rope from `end_a` over two pulleys, fixed in the world, to `end_b`. The radius of a pulley is a
/// tenth of the distance between the pulleys, or of the shorter end of the rope if both pulleys are at one
/// point.
void draw_pulleys(DebugDraw& out, Vec2d end_a, Vec2d ground_a, Vec2d ground_b, Vec2d end_b, DrawRole role);

/// Selects the items to draw.
struct DrawOptions {
  bool shapes = true;
  bool joints = true;
  bool contacts = false;  ///< points
  bool normals = false;
  bool impulses = false;
  bool boxes = false;
  bool centres = false;
  bool names = false;
  double normal_length = 0.2;            ///< m
  double impulse_length = 0.1;           ///< m per N s
  std::optional<Aabb<double>> bounds{};  ///< m; if given, omits everything that is certain to be outside
};

/// Draws the world as it is after the last step: shapes in the order of their bodies' indices, then the rest.
template <class Real>
void draw(const BasicWorld<Real>& world, DebugDraw& out, const DrawOptions& options = {});

/// Draws the world interpolated between the poses `before` (`fraction` 0) and the current ones (1). `before`
/// must outlive the call: functions of `out` may keep other poses in it, but not destroy it.
template <class Real>
void draw(const BasicWorld<Real>& world, const PastPoses<Real>& before, double fraction, DebugDraw& out,
          const DrawOptions& options = {});

}  // namespace plumb
