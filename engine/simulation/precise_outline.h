#pragma once

#include <cstddef>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/joints/row.h"
#include "engine/math/pose.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// A shape as contacts see it: the convex hull of its corners (counter-clockwise, in the body's frame),
/// rounded by a radius. One corner is a disc, two are a capsule; edge i leads from corner i to the next.
struct Outline {
  std::size_t body = 0;
  std::vector<Corner<double>> corners;
  double radius = 0;  ///< m
  double reach = 0;   ///< m, of the farthest corner from the body's centre of mass
  double friction = 0, restitution = 0;
  Filter filter{};
  /// Of a segment of a chain: its back, edge 1, touches nothing, and where the chain goes on its ends belong
  /// to what touches the chain as a whole there (`admits`).
  struct Link {
    bool front_only = false;
    bool goes_on[2] = {};  ///< by corner
    Vec2d next_normal{};   ///< of the segment that follows; where it bends to the back, and zero else
  };
  Link link{};

  int count() const { return static_cast<int>(corners.size()); }
  int edges() const { return corners.size() > 1 ? count() : 0; }
  int next(int corner) const { return corner + 1 < count() ? corner + 1 : 0; }
  int previous(int corner) const { return corner > 0 ? corner - 1 : count() - 1; }
  double edge_length(int edge) const;
};

/// One outline; of a chain one for each segment.
std::vector<Outline> outlines_of(std::size_t body, const Shape& shape);

/// Where two outlines touch, or come closest.
struct Feature {
  enum class Kind : int {
    Corners,    ///< corner `a` and corner `b`, both rounded or one of them at least
    CornerOfB,  ///< corner `b` on edge `a`
    CornerOfA,  ///< corner `a` on edge `b`
  };
  Kind kind = Kind::Corners;
  int a = 0, b = 0;
  friend bool operator==(const Feature&, const Feature&) = default;
};

/// A feature as it lies: gap and frame.
struct Gap {
  double value = 0;   ///< m, negative for an overlap
  Vec2d normal{};     ///< unit, from a to b
  Vec2d point{};      ///< m, on b's surface (on a's, for a corner of a)
  double along = 0;   ///< m, of the corner along the edge from its start
  double length = 0;  ///< m, of the edge; 0 without one
};
Gap gap_of(const Feature& feature, const Outline& a, const Pose<double>& pose_a, const Outline& b,
           const Pose<double>& pose_b);

/// Whether a feature with this gap may push, as far as chains go: they are touched from the front, and at a
/// vertex where they bend to the back along the normals between those of the two segments; it belongs to the
/// first of them. `near`: what is no gap, m; what overlaps by much more came from the back.
bool admits(const Feature& feature, const Gap& gap, const Outline& a, const Pose<double>& pose_a,
            const Outline& b, const Pose<double>& pose_b, double near);

/// The gap's rate and second derivative, and the slip's rate and derivative, as rows of the bodies' motions:
/// `normal`: gap' = J v, gap'' = J a + bias; `tangent`: slip = J v, slip' = J a + bias, the velocity of b
/// against a at the point of contact along the normal turned a quarter counter-clockwise.
struct ContactRows {
  Row<double> normal, tangent;
};
ContactRows rows_of(const Feature& feature, const Outline& a, const Pose<double>& pose_a,
                    const Twist<double>& twist_a, const Outline& b, const Pose<double>& pose_b,
                    const Twist<double>& twist_b);

/// A direction along which two outlines are apart by at least `distance` (negative: they overlap by no more
/// than that in any direction), and the feature that gives it. Of all edge normals and the closest corners
/// the one that separates most.
struct Separation {
  double distance = 0;
  Feature feature{};
  Vec2d normal{};
};
Separation separation(const Outline& a, const Pose<double>& pose_a, const Outline& b,
                      const Pose<double>& pose_b);

/// The one or two features at which outlines touch whose separation is `near` or less; two where edges lie on
/// each other. Features of edges whose normal separates as well as any to within `near` and whose gap opens
/// fastest are taken; with `velocities` of zero the first of them.
std::vector<Feature> touching_features(const Outline& a, const Pose<double>& pose_a,
                                       const Twist<double>& twist_a, const Outline& b,
                                       const Pose<double>& pose_b, const Twist<double>& twist_b, double near);

/// How far a feature is from giving way to another one, m: zero where it does.
struct Limits {
  static constexpr int kMost = 4;
  int count = 0;
  double value[kMost] = {};
  bool comes_down[kMost] = {};  ///< another corner's gap over the edge; else the corner's or normal's range

  void add(double distance, bool gap) { value[count] = distance, comes_down[count] = gap, ++count; }
};
Limits limits_of(const Feature& feature, const Outline& a, const Pose<double>& pose_a, const Outline& b,
                 const Pose<double>& pose_b);

}  // namespace plumb::precise
