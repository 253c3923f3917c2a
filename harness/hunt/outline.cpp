#include "harness/hunt/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/scene/geometry.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Cores {
  std::vector<Outline>& out;

  void operator()(const Circle& c) const { out.push_back({{{0, 0}}, c.radius}); }
  void operator()(const Box& b) const {
    const double x = b.width / 2, y = b.height / 2;
    out.push_back({{{-x, -y}, {x, -y}, {x, y}, {-x, y}}, 0});
  }
  void operator()(const Capsule& c) const { out.push_back({{c.start, c.end}, c.radius}); }
  void operator()(const Polygon& p) const { out.push_back({convex_corners(p.points), p.radius}); }
  void operator()(const Segment& s) const { out.push_back({{s.start, s.end}, 0}); }
  void operator()(const Chain& c) const {
    for (std::size_t i = 0; i + 1 < c.points.size(); ++i) out.push_back({{c.points[i], c.points[i + 1]}, 0});
    if (c.closed) out.push_back({{c.points.back(), c.points.front()}, 0});
  }
};

double to_edge(Vec2d p, Vec2d a, Vec2d b) {
  const Vec2d along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  return length(p - (a + t * along));
}

// Returns the largest gap along the normals of a's edges; negative: the overlap.
double gap_along_normals(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double most = -kInfinity;
  for (std::size_t i = 0; i < a.size() && a.size() > 1; ++i) {
    const Vec2d along = a[(i + 1) % a.size()] - a[i];
    const double size = length(along);
    if (size == 0) continue;
    const Vec2d normal{along.y / size, -along.x / size};
    double own = -kInfinity, other = kInfinity;
    for (const Vec2d p : a) own = std::max(own, dot(normal, p - a[i]));
    for (const Vec2d p : b) other = std::min(other, dot(normal, p - a[i]));
    most = std::max(most, other - own);
  }
  return most;
}

double nearest(const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
  double least = kInfinity;
  for (const Vec2d p : a)
    for (std::size_t i = 0; i < b.size(); ++i)
      least = std::min(least, to_edge(p, b[i], b[(i + 1) % b.size()]));
  return least;
}

}  // namespace

std::vector<Outline> outlines_of(const Shape& shape) {
  std::vector<Outline> out;
  std::visit(Cores{out}, shape.geometry);
  const Rotation<double> turn = rotation_of(shape.angle);
  for (Outline& outline : out)
    for (Vec2d& p : outline.core) p = shape.position + turn * p;
  return out;
}

Outline placed(const Outline& outline, const BodyState& state) {
  const Rotation<double> turn = rotation_of(state.angle);
  Outline out{{}, outline.radius, {kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const Vec2d p : outline.core) {
    const Vec2d at = state.position + turn * p;
    out.core.push_back(at);
    out.low = {std::min(out.low.x, at.x), std::min(out.low.y, at.y)};
    out.high = {std::max(out.high.x, at.x), std::max(out.high.y, at.y)};
  }
  const Vec2d r{outline.radius, outline.radius};
  out.low -= r, out.high += r;
  return out;
}

double separation(const Outline& a, const Outline& b) {
  const double apart = std::max(gap_along_normals(a.core, b.core), gap_along_normals(b.core, a.core));
  // Points have no normals, and no normal of two collinear segments separates them. In these cases the sign
  // of the gap is rounding.
  const double rounding = 1e-13 * (length(a.high - a.low) + length(b.high - b.low) + length(a.low));
  const bool overlap = apart < -rounding && apart > -kInfinity;
  const double cores = overlap ? apart : std::min(nearest(a.core, b.core), nearest(b.core, a.core));
  return cores - a.radius - b.radius;
}

double width_of(const Outline& outline) {
  const std::vector<Vec2d>& core = outline.core;
  double least = core.size() < 3 ? 0 : kInfinity;
  for (std::size_t i = 0; i < core.size() && core.size() > 2; ++i) {
    const Vec2d along = core[(i + 1) % core.size()] - core[i];
    const double size = length(along);
    double most = 0;
    for (const Vec2d p : core) most = std::max(most, std::abs(cross(along, p - core[i])));
    if (size > 0) least = std::min(least, most / size);
  }
  return least + 2 * outline.radius;
}

AreaMoments moments_of(const Outline& outline) {
  // Directions in which the outline's farthest points are its corners, or points of its arcs.
  constexpr int kDirections = 360;
  const Vec2d origin = outline.core.front();
  std::vector<Vec2d> points;
  for (int i = 0; i < kDirections && outline.radius > 0; ++i) {
    const Rotation<double> turn = rotation_of(6.283185307179586 * i / kDirections);
    const Vec2d to{turn.c, turn.s};
    Vec2d best = outline.core.front();
    for (const Vec2d p : outline.core)
      if (dot(p, to) > dot(best, to)) best = p;
    points.push_back(best - origin + outline.radius * to);
  }
  for (std::size_t i = 0; i < outline.core.size() && outline.radius == 0; ++i)
    points.push_back(outline.core[i] - origin);
  AreaMoments out;
  double about_origin = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2d a = points[i], b = points[(i + 1) % points.size()];
    const double twice = cross(a, b);
    out.area += twice / 2;
    out.centroid += (twice / 6) * (a + b);
    about_origin += twice / 12 * (dot(a, a) + dot(a, b) + dot(b, b));
  }
  if (out.area <= 0) return {};
  out.centroid = (1 / out.area) * out.centroid;
  out.second = about_origin - out.area * dot(out.centroid, out.centroid);
  out.centroid += origin;
  return out;
}

double reach_of(const Outline& outline) {
  double most = 0;
  for (const Vec2d p : outline.core) most = std::max(most, length(p));
  return most + outline.radius;
}

}  // namespace plumb::harness::hunt
