#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness {

/// Measures how far each joint is from what it holds rigidly, in m.
class JointGaps {
 public:
  explicit JointGaps(const Scene& scene);

  std::size_t size() const { return joints_.size(); }
  /// Revolute and rigid weld: the distance of the anchors. Rod: how far their distance is from its length;
  /// rope: how far outside its range. Prismatic and wheel: how far the anchors are apart across the axis.
  /// Pulley: how far the rope is from its length. Others hold nothing rigidly: 0.
  double gap(std::size_t joint, std::span<const BodyState> states) const;

  /// A joint's end: a body (none: the fixed frame) and the anchor's distance from its centre of mass, m.
  struct End {
    std::optional<std::size_t> body;
    Vec2d anchor{};
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
