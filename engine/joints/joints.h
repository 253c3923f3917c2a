#pragma once

#include <span>
#include <variant>
#include <vector>

#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// A revolute joint between bodies by index. Two rows: x and y of (anchor b - anchor a).
template <class Real>
struct Revolute {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2<Real> anchor_a{}, anchor_b{};
  static constexpr int kRows = 2;
  void rows(const Pose<Real>& pose_a, const Pose<Real>& pose_b, const Twist<Real>& twist_a,
            const Twist<Real>& twist_b, Row<Real>* out) const;
};

/// A distance joint. One row: |anchor b - anchor a| - length.
template <class Real>
struct Distance {
  int a = kFixedFrame, b = kFixedFrame;
  Vec2<Real> anchor_a{}, anchor_b{};
  Real length = 0;
  static constexpr int kRows = 1;
  void rows(const Pose<Real>& pose_a, const Pose<Real>& pose_b, const Twist<Real>& twist_a,
            const Twist<Real>& twist_b, Row<Real>* out) const;
};

/// The revolute joints and rods of a scene, one array per kind; rows are numbered revolute joints first.
template <class Real>
struct Joints {
  std::vector<Revolute<Real>> revolute;
  std::vector<Distance<Real>> distance;

  std::size_t row_count() const { return 2 * revolute.size() + distance.size(); }

  /// Computes every joint's rows at the given poses and twists (indexed by body). `out` has `row_count()`
  /// elements.
  void rows(std::span<const Pose<Real>> poses, std::span<const Twist<Real>> twists,
            std::span<Row<Real>> out) const;
};

/// Compiles the scene's revolute joints and rods (not springs and ropes) with names resolved to body indices.
/// The scene is valid.
template <class Real>
Joints<Real> compile_joints(const Scene& scene);

}  // namespace plumb
