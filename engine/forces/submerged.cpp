#include "engine/forces/submerged.h"

#include <algorithm>
#include <cmath>

#include "engine/forces/outline.h"
#include "engine/math/arc_tangent.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Integrals of 1, x and y over the area.
struct Moments {
  double area = 0, x = 0, y = 0;
};

// Integrates -y dx, -x y dx and -y^2/2 dx along the part below y = 0 of the line from p to q.
void add_line(Moments& sum, Vec2d p, Vec2d q) {
  if (p.y >= 0 && q.y >= 0) return;
  if (p.y > 0) p = {p.x + (q.x - p.x) * (p.y / (p.y - q.y)), 0};
  if (q.y > 0) q = {q.x + (p.x - q.x) * (q.y / (q.y - p.y)), 0};
  const double dx = q.x - p.x;
  sum.area -= dx * (p.y + q.y) / 2;
  sum.x -= dx * (2 * p.x * p.y + p.x * q.y + q.x * p.y + 2 * q.x * q.y) / 6;
  sum.y -= dx * (p.y * p.y + p.y * q.y + q.y * q.y) / 6;
}

// Does the same along an arc that lies entirely below. Angles are measured from straight down: x = cx + r
// sin, y = cy - r cos.
void add_wet_arc(Moments& sum, Vec2d centre, double r, double from, double to) {
  const Rotation<double> a = rotation_of(from), b = rotation_of(to);
  const double sine = b.s - a.s;                                          // of cos
  const double cosine2 = 0.5 * ((to - from) + (b.s * b.c - a.s * a.c));   // of cos^2
  const double cosine3 = sine - (b.s * b.s * b.s - a.s * a.s * a.s) / 3;  // of cos^3
  const double sine_cosine = 0.5 * (b.s * b.s - a.s * a.s);               // of sin cos
  const double sine_cosine2 = (a.c * a.c * a.c - b.c * b.c * b.c) / 3;    // of sin cos^2
  const double cy = centre.y;
  const double area = -r * cy * sine + r * r * cosine2;
  sum.area += area;
  sum.x += centre.x * area - r * r * cy * sine_cosine + r * r * r * sine_cosine2;
  sum.y -= 0.5 * (cy * cy * r * sine - 2 * cy * r * r * cosine2 + r * r * r * cosine3);
}

void add_arc(Moments& sum, const OutlineArc& arc) {
  const double r = arc.radius, cy = arc.centre.y;
  if (cy >= r) return;
  // The part at angles from -wet to wet is below the surface.
  const double wet = cy <= -r ? kPi : arc_tangent(std::sqrt((r - cy) * (r + cy)), cy);
  const double from = arc_tangent(arc.from.x, -arc.from.y);
  // Rounding may turn half a turn into minus half a turn.
  double sweep = arc_tangent(cross(arc.from, arc.to), dot(arc.from, arc.to));
  if (sweep < 0) sweep = dot(arc.from, arc.to) < 0 ? sweep + 2 * kPi : 0;
  for (int turn = 0; turn < 2; ++turn) {
    const double start = std::max(from, 2 * kPi * turn - wet);
    const double end = std::min(from + sweep, 2 * kPi * turn + wet);
    if (start < end) add_wet_arc(sum, arc.centre, r, start, end);
  }
}

}  // namespace

Submerged submerged_part(const Convex<double>& shape) {
  double top = shape.corners[0].point.y, bottom = top;
  for (int i = 1; i < shape.count; ++i) {
    top = std::max(top, shape.corners[i].point.y);
    bottom = std::min(bottom, shape.corners[i].point.y);
  }
  if (bottom - shape.radius >= 0) return {};
  // If the shape is entirely below the surface, integrate from its own top: a large depth would cost digits.
  const double shift = std::min(top + shape.radius, 0.0);
  const Vec2d origin{shape.corners[0].point.x, shift};
  Moments sum;
  visit_outline(
      shape, [&](Vec2d start, Vec2d end, Vec2d) { add_line(sum, start - origin, end - origin); },
      [&](OutlineArc arc) {
        arc.centre -= origin;
        add_arc(sum, arc);
      });
  if (!(sum.area > 0)) return {};
  return {sum.area, origin + (1 / sum.area) * Vec2d{sum.x, sum.y}};
}

}  // namespace plumb
