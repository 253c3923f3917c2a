#include <algorithm>
#include <cmath>

#include "harness/course/student/world.h"

// Makes the mistakes of loops over pairs, and of bounds that are compared before shapes.
namespace plumb::course {

// Returns true for a pair at which a loop over the second bodies ends, though it should go on with the next.
bool StudentWorld::ends_the_loop(std::size_t a, std::size_t b) const {
  if (is("static_pair_ends_the_loop")) return bodies_[a].inverse_mass + bodies_[b].inverse_mass == 0;
  return is("joined_pair_ends_the_loop") && joined(a, b);
}

// Returns half of the extents of a body's bounds along x and y.
Vec2d StudentWorld::bounds(const Rigid& body) const {
  const Shape& shape = body.body->shapes[0];
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) return {circle->radius, circle->radius};
  const Box& box = std::get<Box>(shape.geometry);
  const Vec2d half{box.width / 2, box.height / 2};
  const double c = std::cos(body.angle), s = std::sin(body.angle);
  if (is("bounds_not_turned")) return half;
  if (is("bounds_of_first_angle"))
    return {std::abs(half.x * std::cos(body.body->angle)) + std::abs(half.y * std::sin(body.body->angle)),
            std::abs(half.x * std::sin(body.body->angle)) + std::abs(half.y * std::cos(body.body->angle))};
  if (is("bounds_sign_lost")) return {half.x * c + half.y * s, half.x * s + half.y * c};
  if (is("bounds_of_one_corner"))
    return {std::abs(half.x * c - half.y * s), std::abs(half.x * s + half.y * c)};
  const double r = is("bounds_by_longer_side")    ? std::max(half.x, half.y)
                   : is("bounds_by_shorter_side") ? std::min(half.x, half.y)
                   : is("bounds_by_width")        ? half.x
                                                  : half.y;
  return {r, r};
}

// Returns true if two bodies are not compared, because their wrong bounds do not overlap.
bool StudentWorld::bounds_apart(std::size_t a, std::size_t b) const {
  const Rigid &first = bodies_[a], &second = bodies_[b];
  const Vec2d way = second.position - first.position, reach = bounds(first) + bounds(second);
  if (is("bounds_by_longer_side") || is("bounds_by_shorter_side") || is("bounds_by_width") ||
      is("bounds_by_height"))
    return dot(way, way) > reach.x * reach.x;
  return std::abs(way.x) > reach.x || std::abs(way.y) > reach.y;
}

}  // namespace plumb::course
