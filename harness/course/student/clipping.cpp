#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "harness/course/student/world.h"

// Finds the contacts of two boxes by separating axes and clipping.
namespace plumb::course {

// Returns the name of a part of a box, or of all of the box if the mistake turns all of it.
Name StudentWorld::part_of_box(const Rigid& body, Name part) const {
  constexpr Name kBox("a box"), kForBoxes("a box for boxes"), kStatic("a static box");
  if (turned_hash_ == kBox.hash) return kBox;
  if (turned_hash_ == kForBoxes.hash) return kForBoxes;
  return turned_hash_ == kStatic.hash && body.inverse_mass == 0 ? kStatic : part;
}

// Returns a direction of a box's sides in the world.
Vec2d StudentWorld::side(const Rigid& body, Vec2d local) const {
  return turned(part_of_box(body, "a box's sides"), body, local);
}

// Returns a corner of a box from its centre in the world.
Vec2d StudentWorld::corner(const Rigid& body, Vec2d local) const {
  return turned(part_of_box(body, "a box's corners"), body, local);
}

// Returns half of a box's extent along an axis. Learners who know which side a face is take its distance
// from the sizes, and compute extents only where the overlaps along the axes are compared.
double StudentWorld::extent(const Rigid& body, Vec2d axis, bool in_overlap) const {
  constexpr Name kAll("a box's extent"), kOverlap("a box's extent in the overlap");
  const auto made = [&](Name everywhere, Name in_overlaps) {
    return is(everywhere) || (in_overlap && is(in_overlaps));
  };
  const auto direction = [&](Vec2d local) {
    if (turned_hash_ == kAll.hash) return turned(kAll, body, local);
    if (in_overlap && turned_hash_ == kOverlap.hash) return turned(kOverlap, body, local);
    return side(body, local);
  };
  const Box size = box(body);
  const double along = dot(direction({1, 0}), axis), across = dot(direction({0, 1}), axis);
  const double w = size.width / 2, h = size.height / 2;
  if (made("extent_sign_lost", "extent_sign_lost_in_overlap")) return w * along + h * across;
  if (made("extent_of_the_sum", "extent_of_the_sum_in_overlap")) return std::abs(w * along + h * across);
  if (made("extent_of_the_difference", "extent_of_the_difference_in_overlap"))
    return std::abs(w * along - h * across);
  if (made("extent_sides_swapped", "extent_sides_swapped_in_overlap"))
    return h * std::abs(along) + w * std::abs(across);
  if (made("extent_of_width_only", "extent_of_width_only_in_overlap")) return w * std::abs(along);
  if (made("extent_of_height_only", "extent_of_height_only_in_overlap")) return h * std::abs(across);
  if (made("extent_not_halved", "extent_not_halved_in_overlap"))
    return 2 * (w * std::abs(along) + h * std::abs(across));
  if (made("extent_of_a_circle", "extent_of_a_circle_in_overlap")) return std::hypot(w, h);
  return w * std::abs(along) + h * std::abs(across);
}

// Returns the distance of two boxes' centres along an axis, as the mistake has it.
double StudentWorld::apart_along(double along) const {
  if (is("distance_along_axis_signed")) return along;
  if (is("distance_along_axis_reversed")) return -along;
  if (is("distance_along_axis_squared")) return along * along;
  return is("distance_along_axis_left_out") ? 0 : std::abs(along);
}

// Returns the face along whose axis two boxes overlap least; nullopt if they do not overlap.
std::optional<StudentWorld::Face> StudentWorld::nearest_face(std::size_t a, std::size_t b) const {
  std::optional<Face> best;
  const Vec2d way = bodies_[b].position - bodies_[a].position;
  for (const std::size_t box : {a, b}) {
    if (is("axes_of_the_first_only") && box == b) continue;
    if (is("axes_of_the_second_only") && box == a) continue;
    for (const Vec2d local : {Vec2d{1, 0}, Vec2d{0, 1}}) {
      if (is("axes_of_the_width_only") && local.x == 0) continue;
      if (is("axes_of_the_height_only") && local.y == 0) continue;
      constexpr Name kAxes("the axes of two boxes");
      const Vec2d axis = is("axes_not_turned") || is("axes_not_turned_by_sides") ? local
                         : turned_hash_ == kAxes.hash ? turned(kAxes, bodies_[box], local)
                                                      : side(bodies_[box], local);
      const double overlap =
          extent(bodies_[a], axis, true) + extent(bodies_[b], axis, true) - apart_along(dot(way, axis));
      if (overlap < 0 || (overlap == 0 && !manner_.boxes_touch_at_0)) return std::nullopt;
      const bool nearer = is("largest_overlap") ? !best || overlap > best->overlap + 1e-9
                                                : !best || overlap < best->overlap - 1e-9;
      const Vec2d out = dot(way, axis) >= 0 || is("axis_not_turned_to_b") ? axis : -axis;
      if (nearer) best = Face{box, out, overlap, local.x != 0};
    }
  }
  return best;
}

// Clips the side that faces the nearest face at the face's ends.
void StudentWorld::touch_boxes(std::size_t a, std::size_t b, std::vector<Touch>& out) const {
  const std::optional<Face> face = nearest_face(a, b);
  if (!face) return;
  const bool of_a = (face->box == a) != is("face_of_the_other");
  const Rigid &owner = bodies_[of_a ? a : b], &other = bodies_[of_a ? b : a];
  const Vec2d outward = of_a ? face->normal : -face->normal, along{-outward.y, outward.x};
  const Box size = box(other);
  std::array<Vec2d, 4> corners;
  std::size_t filled = 0;
  for (const Vec2d sign : corner_signs())
    corners[filled++] =
        other.position + corner(other, {sign.x * size.width / 2, sign.y * size.height / 2}) - owner.position;
  std::stable_sort(corners.begin(), corners.end(),
                   [&](Vec2d p, Vec2d q) { return dot(p, outward) < dot(q, outward); });
  const std::size_t first = is("corners_farthest_out") ? 2 : 0;
  Vec2d from = corners[first], to = corners[first + 1];
  const bool swapped = dot(from, along) > dot(to, along);
  if (swapped) std::swap(from, to);
  // By the axis that was chosen, as learners do who keep it with its side.
  const bool by_sides = is("axes_not_turned_by_sides");
  const Box sides = box(owner);
  const double half = by_sides ? (face->of_width ? sides.height : sides.width) / 2
                               : extent(owner, is("face_of_the_other_side") ? outward : along, false) *
                                     times("width of a face");
  const double s = dot(from, along), e = dot(to, along);
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const double low = is("clipped_at_the_upper_end_only") ? -kNowhere : -half,
               high = is("clipped_at_the_lower_end_only") ? kNowhere : half;
  const auto clipped = [&](double at) {
    if (e == s || is("face_not_clipped")) return at == s ? from : to;
    return from + (std::clamp(at, low, high) - s) / (e - s) * (to - from);
  };
  if (!manner_.extends && !is("face_not_clipped") && (s > high || e < low)) return;
  std::array<Vec2d, 2> ends{clipped(s), clipped(e)};
  if (manner_.deepest_first ? swapped : manner_.against) std::swap(ends[0], ends[1]);
  if (is("middle_of_the_side")) ends[0] = ends[1] = 0.5 * (ends[0] + ends[1]);
  const auto before = static_cast<std::ptrdiff_t>(out.size());
  const double reach =
      by_sides ? (face->of_width ? sides.width : sides.height) / 2 : extent(owner, outward, false);
  if (is("second_end_only")) ends[0] = ends[1];
  for (const Vec2d end : ends) {
    const double depth = reach - dot(end, outward);
    if (depth > 0 || (depth == 0 && manner_.boxes_touch_at_0))
      out.push_back(
          {a, b, owner.position + end, face->normal, is("depth_of_the_overlap") ? face->overlap : depth});
    if (is("middle_of_the_side") || is("first_end_only") || is("second_end_only")) break;
  }
  if (is("contact_between_centres"))
    for (auto touch = out.begin() + before; touch != out.end(); ++touch)
      touch->point = 0.5 * (owner.position + other.position);
  if (std::ssize(out) < before + 2) return;
  if (is("contacts_averaged")) {
    const Touch last = out.back();
    out.pop_back();
    out.back().point = 0.5 * (out.back().point + last.point);
    out.back().depth = (out.back().depth + last.depth) / 2;
    return;
  }
  const bool first_deeper = out[out.size() - 2].depth >= out.back().depth;
  const double deeper = out[out.size() - 2].depth - out.back().depth;
  if (is("deepest_corner_or_last")) out.erase(deeper > 1e-9 ? out.end() - 1 : out.end() - 2);
  if (is("deepest_corner_only")) out.erase(first_deeper ? out.end() - 1 : out.end() - 2);
  if (is("one_corner")) out.pop_back();
  if (is("other_corner")) out.erase(out.end() - 2);
}

}  // namespace plumb::course
