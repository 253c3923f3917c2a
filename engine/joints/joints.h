#pragma once

#include <span>
#include <variant>
#include <vector>

#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// A revolute joint between bodies by index. Two rows: x and y of (anchor b - anchor a).
struct Revolute {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2d anchor_a{}, anchor_b{};
  static constexpr int kRows = 2;
  void rows(const Pose<double>& pose_a, const Pose<double>& pose_b, const Twist<double>& twist_a,
            const Twist<double>& twist_b, Row<double>* out) const;
};

/// A distance joint. One row: |anchor b - anchor a| - length.
struct Distance {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2d anchor_a{}, anchor_b{};
  double length = 0;
  static constexpr int kRows = 1;
  void rows(const Pose<double>& pose_a, const Pose<double>& pose_b, const Twist<double>& twist_a,
            const Twist<double>& twist_b, Row<double>* out) const;
};

/// The revolute joints and rods of a scene, one array per kind; rows are numbered revolute joints first.
struct Joints {
  std::vector<Revolute> revolute;
  std::vector<Distance> distance;

  std::size_t row_count() const { return 2 * revolute.size() + distance.size(); }

  /// Computes every joint's rows at the given poses and twists (indexed by body). `out` has `row_count()`
  /// elements.
  void rows(std::span<const Pose<double>> poses, std::span<const Twist<double>> twists,
            std::span<Row<double>> out) const;
};

/// Compiles the scene's revolute joints and rods (not springs and ropes) with names resolved to body indices.
/// The scene is valid.
Joints compile_joints(const Scene& scene);

}  // namespace plumb
