#pragma once

#include <cstddef>
#include <vector>

#include "engine/geometry/convex.h"
#include "engine/joints/row.h"
#include "engine/math/pose.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// A shape for contacts: the convex hull of its corners (counter-clockwise, in the body's frame), rounded by
/// a radius. One corner is a disc, two are a capsule; edge i leads from corner i to the next.
struct FeatureShape {
  std::size_t body = 0;
  std::vector<Corner<double>> corners;
  double radius = 0;  ///< m
  double extent = 0;  ///< m, of the farthest corner from the body's centre of mass
  double friction = 0, restitution = 0;
  Filter filter{};
  /// Data of a chain segment: its back, edge 1, touches nothing. Contacts at ends where the chain continues
  /// belong to the whole chain (`allows_contact`).
  struct ChainLink {
    bool front_only = false;
    bool continues[2] = {};  ///< by corner: the chain continues
    Vec2d next_normal{};     ///< of the next segment if the chain turns away from its front there, else 0
  };
  ChainLink link{};

  int count() const { return static_cast<int>(corners.size()); }
  int edges() const { return corners.size() > 1 ? count() : 0; }
  int next(int corner) const { return corner + 1 < count() ? corner + 1 : 0; }
  int previous(int corner) const { return corner > 0 ? corner - 1 : count() - 1; }
  double edge_length(int edge) const;
};

/// Returns one shape, or one per segment of a chain. `scene_extent` (m) is the distance from the origin to
/// the farthest point of the scene: corners of polygons that stand out by less than 1e-9 of it are left out.
std::vector<FeatureShape> feature_shapes_of(std::size_t body, const Shape& shape, double scene_extent = 0);

/// Parts of two shapes that touch, or are closest.
struct Feature {
  enum class Kind : int {
    Corners,    ///< corner `a` and corner `b`, at least one of them rounded
    CornerOfB,  ///< corner `b` on edge `a`
    CornerOfA,  ///< corner `a` on edge `b`
  };
  Kind kind = Kind::Corners;
  int a = 0, b = 0;
  friend bool operator==(const Feature&, const Feature&) = default;
};

/// Gap and frame of a feature at given poses.
struct Gap {
  double value = 0;   ///< m, negative for an overlap
  Vec2d normal{};     ///< unit, from a to b
  Vec2d point{};      ///< m, on b's surface (on a's, for a corner of a)
  double along = 0;   ///< m, of the corner along the edge from its start
  double length = 0;  ///< m, of the edge; 0 without one
};
Gap gap_of(const Feature& feature, const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
           const Pose<double>& pose_b);

/// Returns true if a feature with this gap may push, given the rules for chains. Chains push from the front
/// only. At a vertex that bends to the back they push along the normals between those of its two segments,
/// and the contact belongs to the first segment. Gaps below `tolerance` (m) count as touching; a much deeper
/// overlap came from the back.
bool allows_contact(const Feature& feature, const Gap& gap, const FeatureShape& a, const Pose<double>& pose_a,
                    const FeatureShape& b, const Pose<double>& pose_b, double tolerance);

/// Returns the feature of an edge and a corner.
Feature feature(Feature::Kind kind, int edge, int corner);

/// Rates and accelerations of gap and slip as rows of the bodies' motions. `normal`: gap' = J v, gap'' = J a
/// + bias. `tangent`: slip = J v, slip' = J a + bias, the velocity of b relative to a at the point of contact
/// along the normal turned a quarter counter-clockwise.
struct ContactRows {
  Row<double> normal, tangent;
};
ContactRows rows_of(const Feature& feature, const FeatureShape& a, const Pose<double>& pose_a,
                    const Twist<double>& twist_a, const FeatureShape& b, const Pose<double>& pose_b,
                    const Twist<double>& twist_b);

/// A direction along which two shapes are separated by at least `distance` (negative: the least overlap of
/// all directions), and its feature. Of all edge normals and the closest corners it is the one of greatest
/// separation.
struct Separation {
  double distance = 0;
  Feature feature{};
  Vec2d normal{};
};
Separation separation(const FeatureShape& a, const Pose<double>& pose_a, const FeatureShape& b,
                      const Pose<double>& pose_b);

/// Returns the one or two features at which shapes with a separation of at most `tolerance` touch; two if
/// an edge lies on an edge. If several edges' normals separate the shapes equally well, to within
/// `tolerance`, takes the one whose gap opens fastest, which is the first one if all velocities are zero.
std::vector<Feature> touching_features(const FeatureShape& a, const Pose<double>& pose_a,
                                       const Twist<double>& twist_a, const FeatureShape& b,
                                       const Pose<double>& pose_b, const Twist<double>& twist_b,
                                       double tolerance);

/// Distances (m) of a feature from the transitions to other features: zero at the transition.
struct FeatureLimits {
  static constexpr int kMaxCount = 4;
  int count = 0;
  double value[kMaxCount] = {};
  bool is_corner_gap[kMaxCount] = {};  ///< true: the gap between another corner and the edge; false: the
                                       ///< range of the corner or of the normal

  void add(double distance, bool gap) { value[count] = distance, is_corner_gap[count] = gap, ++count; }
};
FeatureLimits feature_limits_of(const Feature& feature, const FeatureShape& a, const Pose<double>& pose_a,
                                const FeatureShape& b, const Pose<double>& pose_b);

}  // namespace plumb::precise
