#include "engine/world/state/query_shape.h"

#include <cmath>

#include "engine/geometry/convex_hull.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

bool is_valid_size(double v) { return v >= kSmallestNumber && v <= kLargestNumber; }
bool is_valid_position(Vec2d v) { return std::abs(v.x) <= kLargestNumber && std::abs(v.y) <= kLargestNumber; }

// Returns true for geometry that needs no validation, which would allocate names for messages.
struct IsSound {
  bool operator()(const Circle& circle) const { return is_valid_size(circle.radius); }
  bool operator()(const Box& box) const { return is_valid_size(box.width) && is_valid_size(box.height); }
  bool operator()(const Capsule& capsule) const {
    return is_valid_position(capsule.start) && is_valid_position(capsule.end) &&
           is_valid_size(capsule.radius);
  }
  bool operator()(const Polygon&) const { return false; }
  bool operator()(const Segment& segment) const {
    return is_valid_position(segment.start) && is_valid_position(segment.end) &&
           is_valid_size(std::sqrt(length_squared(segment.end - segment.start)));
  }
};

}  // namespace

QueryShape QueryShape::box(double half_width, double half_height) {
  QueryShape shape;
  shape.add({-half_width, -half_height});
  if (half_width > 0) shape.add({half_width, -half_height});
  if (half_height > 0) shape.add({half_width, half_height});
  if (half_width > 0 && half_height > 0) shape.add({-half_width, half_height});
  shape.set_normals();
  return shape;
}

QueryShape::QueryShape(const ShapeGeometry& geometry) {
  if (!std::visit(IsSound{}, geometry)) validate(ShapeDefinition{.geometry = geometry});
  if (const auto* circle = std::get_if<Circle>(&geometry)) {
    add({});
    radius_ = circle->radius;
  } else if (const auto* box_like = std::get_if<Box>(&geometry)) {
    *this = box(box_like->width / 2, box_like->height / 2);
  } else if (const auto* capsule = std::get_if<Capsule>(&geometry)) {
    add(capsule->start);
    if (!(capsule->end == capsule->start)) add(capsule->end);
    radius_ = capsule->radius;
  } else if (const auto* segment = std::get_if<Segment>(&geometry)) {
    add(segment->start), add(segment->end);
  } else {
    const Polygon& polygon = std::get<Polygon>(geometry);
    for (const Corner<double>& corner : convex_hull(polygon.points)) add(corner.point);
    radius_ = polygon.radius;
  }
  set_normals();
}

Vec2d QueryShape::middle() const {
  Vec2d sum{};
  for (int i = 0; i < count_; ++i) sum += corners_[i].point;
  return (1.0 / count_) * sum;
}

void QueryShape::set_normals() {
  for (int i = 0; i < count_ && count_ > 1; ++i) {
    const Vec2d edge = corners_[i + 1 < count_ ? i + 1 : 0].point - corners_[i].point;
    const double length = std::sqrt(length_squared(edge));
    corners_[i].normal = {edge.y / length, -edge.x / length};
  }
}

}  // namespace plumb
