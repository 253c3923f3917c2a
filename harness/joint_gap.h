#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace plumb::harness {

/// Measures how far the anchors of each joint are from where the joint wants them.
class JointGaps {
 public:
  explicit JointGaps(const Scene& scene);

  std::size_t size() const { return joints_.size(); }
  /// Revolute: the distance of the anchors, m. Distance joint: how far their distance is from its length, m.
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
    End a, b;
    double length = 0;  // 0: revolute
  };
  std::vector<Entry> joints_;
};

}  // namespace plumb::harness
