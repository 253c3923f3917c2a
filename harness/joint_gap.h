#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness {

/// Measures the violation of each joint's rigid constraints, in m.
class JointGaps {
 public:
  explicit JointGaps(const Scene& scene);

  std::size_t size() const { return joints_.size(); }
  /// Returns the gap. Revolute and rigid weld: the distance between the anchors. Rod: the difference between
  /// that distance and the length; rope: the distance outside its range. Prismatic and wheel: the distance of
  /// b's anchor from the axis, and from its part within the limits. Pulley: the error of the rope's length.
  /// Others have no rigid constraint: 0.
  double gap(std::size_t joint, std::span<const BodyState> states) const;

  /// Returns the change of the gap per radian of body a's rotation, apart from that due to the motion of its
  /// anchor, m. If a has the axis, this is the distance between the anchors; otherwise 0.
  double lever(std::size_t joint, std::span<const BodyState> states) const;

  /// A joint's end: a body (none: the fixed frame) and the anchor's distance from its centre of mass, m.
  struct End {
    std::optional<std::size_t> body;
    Vec2d anchor{};
    double gain = 1;  ///< of end b: change of the gap per metre of its anchor's error
  };
  const End& end_a(std::size_t joint) const { return joints_[joint].a; }
  const End& end_b(std::size_t joint) const { return joints_[joint].b; }

 private:
  struct Entry {
    Joint joint;
    End a, b;
    double rope = 0;  // of a pulley, m
  };
  std::vector<Entry> joints_;
};

}  // namespace plumb::harness
