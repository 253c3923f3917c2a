#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/precise/dynamics/feature_shape.h"

namespace plumb::precise {
namespace {

using Kind = Feature::Kind;

struct Pair {
  const FeatureShape &a, &b;
  const Pose<double>&pose_a, &pose_b;

  Gap gap(const Feature& f) const { return gap_of(f, a, pose_a, b, pose_b); }
};

/// Returns the pair of corners with the least gap. Beyond the ends of their edges, rounded shapes touch with
/// their corners. The lines of these edges may be equally close up to rounding, but are not used.
Feature closest_corners(const Pair& pair) {
  Feature best{Kind::Corners, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < pair.a.count(); ++i) {
    for (int j = 0; j < pair.b.count(); ++j) {
      const double gap = pair.gap({Kind::Corners, i, j}).value;
      if (gap >= least) continue;
      least = gap;
      best = {Kind::Corners, i, j};
    }
  }
  return best;
}

/// Finds the contacts of an edge with the other shape's corners that lie at most `tolerance` above it. They
/// are one corner or, along an edge of the other, the two ends of the common part.
std::vector<Feature> on_edge(const Pair& pair, Kind kind, int edge, double lowest, double tolerance) {
  const bool of_a = kind == Kind::CornerOfB;
  const FeatureShape& corner_shape = of_a ? pair.b : pair.a;
  const FeatureShape& edge_shape = of_a ? pair.a : pair.b;
  struct At {
    int corner;
    double along;
  };
  std::vector<At> low;
  double length = 0;
  for (int k = 0; k < corner_shape.count(); ++k) {
    const Gap gap = pair.gap(feature(kind, edge, k));
    length = gap.length;
    if (gap.value <= lowest + tolerance) low.push_back({k, gap.along});
  }
  const auto inside = [&](double along) { return along >= -tolerance && along <= length + tolerance; };
  if (low.size() != 2) {
    if (low.empty() || !inside(low[0].along)) return {};
    return {feature(kind, edge, low[0].corner)};
  }
  if (low[0].along > low[1].along) std::swap(low[0], low[1]);
  if (low[0].along > length + tolerance || low[1].along < -tolerance) return {};
  // The edges run in opposite directions: the other's starts at this one's end.
  const int first = low[0].corner, second = low[1].corner, other_edge = second;
  const Kind other_kind = of_a ? Kind::CornerOfA : Kind::CornerOfB;
  const Feature left =
      inside(low[0].along) ? feature(kind, edge, first) : feature(other_kind, other_edge, edge);
  const Feature right = inside(low[1].along) ? feature(kind, edge, second)
                                             : feature(other_kind, other_edge, edge_shape.next(edge));
  const double shared = std::min(low[1].along, length) - std::max(low[0].along, 0.0);
  if (shared <= tolerance) return {left};
  return {left, right};
}

}  // namespace

std::vector<Feature> touching_features(const FeatureShape& a, const Pose<double>& pose_a,
                                       const Twist<double>& twist_a, const FeatureShape& b,
                                       const Pose<double>& pose_b, const Twist<double>& twist_b,
                                       double tolerance) {
  const Pair pair{a, b, pose_a, pose_b};
  const Separation best = separation(a, pose_a, b, pose_b);
  std::vector<Feature> found;
  double fastest = -std::numeric_limits<double>::infinity();
  const auto offer = [&](const std::vector<Feature>& features) {
    if (features.empty()) return;
    double opening = std::numeric_limits<double>::infinity();
    for (const Feature& f : features) {
      const Row<double> n = rows_of(f, a, pose_a, twist_a, b, pose_b, twist_b).normal;
      opening =
          std::min(opening, dot(n.linear_a, twist_a.velocity) + n.angular_a * twist_a.angular_velocity +
                                dot(n.linear_b, twist_b.velocity) + n.angular_b * twist_b.angular_velocity);
    }
    // Directions whose gaps open equally fast, to rounding, count as equal: the one with more points wins.
    const double alike = 1e-9 * std::max(std::abs(opening), std::abs(fastest));
    const bool better = found.empty() || opening > fastest + alike ||
                        (opening > fastest - alike && features.size() > found.size());
    if (!better) return;
    found = features;
    fastest = opening;
  };
  for (int of = 0; of < 2; ++of) {
    const FeatureShape& edge_shape = of == 0 ? a : b;
    const Kind kind = of == 0 ? Kind::CornerOfB : Kind::CornerOfA;
    for (int edge = 0; edge < edge_shape.edges(); ++edge) {
      double lowest = std::numeric_limits<double>::infinity();
      const int corners = of == 0 ? b.count() : a.count();
      for (int k = 0; k < corners; ++k) lowest = std::min(lowest, pair.gap(feature(kind, edge, k)).value);
      if (lowest < best.distance - tolerance) continue;
      offer(on_edge(pair, kind, edge, lowest, tolerance));
    }
  }
  if (found.empty()) found = {a.radius + b.radius > 0 ? closest_corners(pair) : best.feature};
  return found;
}

}  // namespace plumb::precise
