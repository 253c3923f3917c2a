#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/geometry/aabb.h"

#if defined(__SSE2__) && !defined(PLUMB_SCALAR)
#include <emmintrin.h>
#define PLUMB_TREE_SSE2
#endif

namespace plumb {

/// A node of DynamicTree: all that a traversal reads, 32 bytes in float.
template <class Real>
struct TreeNode {
  Aabb<Real> box{};
  std::uint32_t category = 0;  ///< inner: all categories below
  std::int32_t link = 0;       ///< inner: the pair of its children; leaf: ~proxy
  std::int32_t tag = 0;        ///< inner: 1 when its box may be too large; leaf: the user's number
  std::int32_t parent = -1;    ///< slot of the node above; -1 at the root

  bool is_leaf() const { return link < 0; }
  int proxy() const { return ~link; }
  bool marked() const { return !is_leaf() && tag != 0; }
};

/// Siblings lie together, so that a traversal reads one cache line (in float) for both.
template <class Real>
struct alignas(sizeof(Real) == 4 ? 64 : 32) TreePair {
  TreeNode<Real> children[2];
};

static_assert(sizeof(TreeNode<float>) == 32 && sizeof(TreePair<float>) == 64);
static_assert(sizeof(TreeNode<double>) == 48 && sizeof(TreePair<double>) == 96);

/// Selects the nodes that a query for overlapping boxes enters.
template <class Real>
class OverlapTest {
 public:
  OverlapTest(const Aabb<Real>& box, std::uint32_t mask) : box_(box), mask_(mask) {}

  // Compares without branches: the results can hardly be predicted.
  bool operator()(const TreeNode<Real>& node) const {
    const Aabb<Real>& other = node.box;
    return static_cast<int>(other.lower.x <= box_.upper.x) & static_cast<int>(other.lower.y <= box_.upper.y) &
           static_cast<int>(other.upper.x >= box_.lower.x) & static_cast<int>(other.upper.y >= box_.lower.y) &
           static_cast<int>((node.category & mask_) != 0);
  }

 private:
  Aabb<Real> box_;
  std::uint32_t mask_;
};

#ifdef PLUMB_TREE_SSE2
/// SSE version with one comparison: with the upper sides negated, a node's box must not exceed this one's in
/// any of (lower x, lower y, -upper x, -upper y).
template <>
class OverlapTest<float> {
 public:
  OverlapTest(const Aabb<float>& box, std::uint32_t mask)
      : limits_(_mm_setr_ps(box.upper.x, box.upper.y, -box.lower.x, -box.lower.y)),
        signs_(_mm_setr_ps(0.0f, 0.0f, -0.0f, -0.0f)),
        mask_(mask) {}

  bool operator()(const TreeNode<float>& node) const {
    const __m128 sides = _mm_xor_ps(_mm_load_ps(&node.box.lower.x), signs_);
    return (_mm_movemask_ps(_mm_cmple_ps(sides, limits_)) == 15) & ((node.category & mask_) != 0);
  }

 private:
  __m128 limits_, signs_;
  std::uint32_t mask_;
};
#endif

/// Slab test of a swept box against nodes (Kay and Kajiya 1986), the nodes grown by half the swept box.
/// Conservative in rounding: with unit roundoff u = epsilon/2, the distances to a slab have errors below 2u
/// of themselves and u of the half extent, the fractions below 5u of themselves; both are widened by more.
template <class Real>
class SweepTest {
 public:
  static constexpr Real kMiss = std::numeric_limits<Real>::infinity();

  SweepTest(Vec2<Real> origin, Vec2<Real> translation, Vec2<Real> half_extent, std::uint32_t mask)
      : x_(origin.x, translation.x, half_extent.x), y_(origin.y, translation.y, half_extent.y), mask_(mask) {}

  /// Returns a close lower bound of the fraction of the translation at which the node is hit, or kMiss.
  Real operator()(const TreeNode<Real>& node) const {
    Real enter = 0, leave = kMiss;
    x_.clip(node.box.lower.x, node.box.upper.x, enter, leave);
    y_.clip(node.box.lower.y, node.box.upper.y, enter, leave);
    enter *= 1 - kSlack;
    return (node.category & mask_) != 0 && leave >= 0 && enter <= leave * (1 + kSlack) ? enter : kMiss;
  }

 private:
  static constexpr Real kSlack = 4 * std::numeric_limits<Real>::epsilon();

  // One axis. A component of the translation whose reciprocal would overflow counts as zero.
  struct Slab {
    Slab(Real origin_, Real translation, Real half_extent)
        : origin(origin_),
          half(half_extent * (1 + 2 * std::numeric_limits<Real>::epsilon())),
          moves(std::abs(translation) >= std::numeric_limits<Real>::min()),
          inverse(moves ? 1 / translation : 0) {}

    void clip(Real lower, Real upper, Real& enter, Real& leave) const {
      const Real to_lower = (lower - origin) - half, to_upper = (upper - origin) + half;
      if (moves) {
        const Real a = to_lower * inverse, b = to_upper * inverse;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      } else if (to_lower > 0 || to_upper < 0) {
        leave = -1;
      }
    }

    Real origin, half;
    bool moves;
    Real inverse;
  };

  Slab x_, y_;
  std::uint32_t mask_;
};

/// Squared distances from a point to nodes.
template <class Real>
class DistanceTest {
 public:
  static constexpr Real kMiss = std::numeric_limits<Real>::infinity();

  DistanceTest(Vec2<Real> point, std::uint32_t mask) : point_(point), mask_(mask) {}

  Real operator()(const TreeNode<Real>& node) const {
    if ((node.category & mask_) == 0) return kMiss;
    const Vec2<Real> lower = node.box.lower - point_, upper = point_ - node.box.upper;
    return length_squared(
        Vec2<Real>{std::max({lower.x, upper.x, Real{0}}), std::max({lower.y, upper.y, Real{0}})});
  }

  /// Returns an upper bound of the squares computed for nodes within `distance`: the sum of two rounded
  /// squares of rounded differences is off by less than 5u of itself, or by underflow.
  static Real limit(Real distance) {
    return distance * distance * (1 + 4 * std::numeric_limits<Real>::epsilon()) +
           std::numeric_limits<Real>::min();
  }

 private:
  Vec2<Real> point_;
  std::uint32_t mask_;
};

}  // namespace plumb
