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
  /// rope: how far outside its range. Prismatic and wheel: how far b's anchor is from the axis, and from the
  /// stretch of it that limits leave. Pulley: how far the rope is from its length. Others hold no distance:
  /// 0.
  double gap(std::size_t joint, std::span<const BodyState> states) const;

  /// How far the gap moves a radian that body a is turned, beside what its anchor moves, m: where a has the
  /// axis, from anchor to anchor; else 0.
  double lever(std::size_t joint, std::span<const BodyState> states) const;

  /// A joint's end: a body (none: the fixed frame) and the anchor's distance from its centre of mass, m.
  struct End {
    std::optional<std::size_t> body;
    Vec2d anchor{};
    double gain = 1;  ///< of b: how far the gap grows a metre that its anchor is off
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
