#include "harness/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::harness {
namespace {

double circle_against_circle(const PlacedShape& a, const PlacedShape& b) {
  return a.half_width + b.half_width - length(b.centre - a.centre);
}

double box_against_circle(const PlacedShape& box, const PlacedShape& circle) {
  const Vec2d to = circle.centre - box.centre;
  const double x = std::abs(dot(to, box.axis)) - box.half_width;
  const double y = std::abs(dot(to, perpendicular(box.axis))) - box.half_height;
  if (x <= 0 && y <= 0) return circle.half_width - std::max(x, y);  // the centre lies inside
  return circle.half_width - std::hypot(std::max(x, 0.0), std::max(y, 0.0));
}

double box_against_box(const PlacedShape& a, const PlacedShape& b) {
  const Vec2d to = b.centre - a.centre;
  double least = std::numeric_limits<double>::infinity();
  for (const Vec2d axis : {a.axis, perpendicular(a.axis), b.axis, perpendicular(b.axis)})
    least = std::min(least, half_extent(a, axis) + half_extent(b, axis) - std::abs(dot(to, axis)));
  return least;
}

}  // namespace

double half_extent(const PlacedShape& shape, Vec2d direction) {
  if (shape.is_circle) return shape.half_width;
  return shape.half_width * std::abs(dot(shape.axis, direction)) +
         shape.half_height * std::abs(dot(perpendicular(shape.axis), direction));
}

double overlap(const PlacedShape& a, const PlacedShape& b) {
  if (a.is_circle && b.is_circle) return circle_against_circle(a, b);
  if (a.is_circle) return box_against_circle(b, a);
  if (b.is_circle) return box_against_circle(a, b);
  return box_against_box(a, b);
}

}  // namespace plumb::harness
