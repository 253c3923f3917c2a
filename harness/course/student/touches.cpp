#include <algorithm>
#include <cmath>

#include "harness/course/student/world.h"

// Finds contacts: circles and circles, circles and boxes, corners in boxes.
namespace plumb::course {
namespace {

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

void StudentWorld::touch_circles(std::size_t a, std::size_t b, std::vector<Touch>& out) const {
  const double ra = radius(another("radius", bodies_[a])), rb = radius(another("radius", bodies_[b]));
  const Vec2d way = bodies_[b].position - bodies_[a].position;
  const double by_sum = std::abs(way.x) + std::abs(way.y),
               by_largest = std::max(std::abs(way.x), std::abs(way.y));
  double d = is("square_for_distance") ? dot(way, way) : length(way);
  if (is("distance_by_sum")) d = by_sum;
  if (is("distance_by_largest")) d = by_largest;
  // The overlap is computed from r1 + r2, or from the mistake's wrong sum.
  constexpr std::string_view kInDepth = "_in_depth";
  const bool in_depth = mistake_.ends_with(kInDepth);
  const std::string_view name =
      std::string_view(mistake_).substr(0, mistake_.size() - (in_depth ? kInDepth.size() : 0));
  const auto wrong = [&](std::string_view reach) { return name == reach; };
  double reach = ra + rb;
  if (wrong("diameters")) reach *= 2;
  if (wrong("one_radius")) reach = ra;
  if (wrong("other_radius")) reach = rb;
  if (wrong("larger_radius_alone")) reach = std::max(ra, rb);
  if (wrong("smaller_radius_alone")) reach = std::min(ra, rb);
  if (wrong("larger_radius")) reach = 2 * std::max(ra, rb);
  if (wrong("smaller_radius")) reach = 2 * std::min(ra, rb);
  if (wrong("sum_of_squared_radii")) reach = std::hypot(ra, rb);
  if (wrong("mean_of_radii")) reach = (ra + rb) / 2;
  if (wrong("first_radius_twice")) reach = 2 * ra;
  if (wrong("second_radius_twice")) reach = 2 * rb;
  if (is("no_detection")) reach = 0;
  const double compared = is("square_of_distance")            ? d * d
                          : is("distance_by_sum_in_test")     ? by_sum
                          : is("distance_by_largest_in_test") ? by_largest
                                                              : d;
  const bool apart = manner_.circles_touch_at_0 ? compared > reach : compared >= reach;
  const bool squares_touch = is("circles_as_squares") && std::abs(way.x) < reach && std::abs(way.y) < reach;
  if (d <= 0 || (!squares_touch && apart != is("overlap_test_reversed"))) return;
  Vec2d n = 1 / d * way, rim = way;
  if (is("normal_not_unit")) n = way;
  if (is("normal_over_square")) n = 1 / (d * d) * way;
  // The point of the contact is on the line of centres, or follows a wrong normal.
  constexpr std::string_view kWithPoint = "_with_point";
  const bool with_point = mistake_.ends_with(kWithPoint);
  const std::string_view axis =
      std::string_view(mistake_).substr(0, mistake_.size() - (with_point ? kWithPoint.size() : 0));
  const Vec2d along_x{std::copysign(1.0, way.x), 0}, along_y{0, std::copysign(1.0, way.y)};
  if (axis == "normal_along_x") n = along_x;
  if (axis == "normal_along_y") n = along_y;
  if (axis == "normal_along_longer_axis") n = std::abs(way.x) > std::abs(way.y) ? along_x : along_y;
  if (axis == "normal_along_shorter_axis") n = std::abs(way.x) > std::abs(way.y) ? along_y : along_x;
  if (with_point) rim = d * n;
  if (is("normal_along_velocity") || is("normal_along_approach")) {
    const Vec2d v = bodies_[a].velocity - bodies_[b].velocity;
    const bool turns = is("normal_along_velocity") || dot(v, n) > 0;
    if (length(v) > 0 && turns) n = 1 / length(v) * v;
    if (is("normal_along_approach")) rim = d * n;
  }
  if (is("tangent")) n = {-n.y, n.x};
  if (is("normal_components_swapped")) n = {n.y, n.x};
  if (is("y_of_normal_flipped")) n.y = -n.y;
  if (wrong("normal_flipped")) n = -n;
  n = mixed("normal of two circles", n);
  Vec2d point = bodies_[a].position + ra / d * rim;
  if (is("contact_point_at_first_centre")) point = bodies_[a].position;
  if (is("contact_point_at_second_centre")) point = bodies_[b].position;
  out.push_back({a, b, point, n, is("normal_flipped") ? 0 : (in_depth ? reach : ra + rb) - d});
}

void StudentWorld::touch_circle_box(std::size_t circle, std::size_t box, std::vector<Touch>& out) const {
  const Rigid &c = bodies_[circle], &b = bodies_[box];
  const double r = radius(another("radius", c));
  const Box size = this->box(b);
  const double angle = b.turns * (is("box_taken_upright")          ? 0
                                  : is("box_turned_backwards")     ? -b.angle
                                  : is("a box~by the first angle") ? b.body->angle
                                                                   : b.angle);
  const Rotation<double> q{std::cos(angle), std::sin(angle)};
  const bool backwards = is("centre_turned_backwards");
  const Vec2d local = (backwards ? q : q.inverse()) * (c.position - b.position);
  Vec2d nearest{std::clamp(local.x, -size.width / 2, size.width / 2),
                std::clamp(local.y, -size.height / 2, size.height / 2)};
  if (is("clamp_above_only"))
    nearest = {std::min(local.x, size.width / 2), std::min(local.y, size.height / 2)};
  if (is("clamp_below_only"))
    nearest = {std::max(local.x, -size.width / 2), std::max(local.y, -size.height / 2)};
  if (is("clamp_of_x_only")) nearest.y = local.y;
  if (is("clamp_of_y_only")) nearest.x = local.x;
  if (is("clamp_of_x_above_only")) nearest.x = std::min(local.x, size.width / 2);
  if (is("clamp_of_x_below_only")) nearest.x = std::max(local.x, -size.width / 2);
  if (is("clamp_of_y_above_only")) nearest.y = std::min(local.y, size.height / 2);
  if (is("clamp_of_y_below_only")) nearest.y = std::max(local.y, -size.height / 2);
  if (is("clamp_exchanged")) nearest = {size.width / 2, size.height / 2};
  if (is("clamp_exchanged_below")) nearest = {-size.width / 2, -size.height / 2};
  Vec2d way = is("point_of_box_not_turned") ? b.position + nearest - c.position : q * (nearest - local);
  if (backwards) way = b.position + q * nearest - c.position;
  double d = is("square_for_distance_at_box") ? dot(way, way) : length(way);
  if (is("distance_of_centres_at_box")) d = length(b.position - c.position);
  if (is("distance_by_sum_at_box")) d = std::abs(way.x) + std::abs(way.y);
  if (d == 0 && manner_.deep) {
    const double in_x = size.width / 2 - std::abs(local.x), in_y = size.height / 2 - std::abs(local.y);
    const Vec2d out_of =
        in_x < in_y ? Vec2d{std::copysign(1.0, local.x), 0} : Vec2d{0, std::copysign(1.0, local.y)};
    out.push_back({circle, box, c.position, q * -out_of, r + std::min(in_x, in_y)});
    return;
  }
  const Vec2d in{size.width / 2 + r - std::abs(local.x), size.height / 2 + r - std::abs(local.y)};
  if (is("circle_as_square_at_box") && d > 0 && in.x > 0 && in.y > 0) {
    const Vec2d n =
        in.x < in.y ? Vec2d{std::copysign(1.0, -local.x), 0} : Vec2d{0, std::copysign(1.0, -local.y)};
    out.push_back({circle, box, c.position + way, q * n, std::min(in.x, in.y)});
    return;
  }
  if (d <= 0 || d > r || (d == r && !manner_.circles_touch_at_0)) return;
  const Vec2d at = b.position;
  if ((is("wall_missing") && at.x > 1) || (is("left_wall_missing") && at.x < -1)) return;
  if ((is("upper_wall_missing") && at.y > 1) || (is("lower_wall_missing") && at.y < -1)) return;
  Vec2d n = 1 / d * (is("side_of_box_not_turned") ? nearest - local : way);
  if (is("wall_normal_not_unit")) n = way;
  if (is("wall_normal_flipped")) n = -n;
  const Vec2d to_centre = b.position - c.position;
  if (is("wall_normal_from_centre")) n = 1 / length(to_centre) * to_centre;
  if (is("wall_normal_longer_axis"))
    n = std::abs(to_centre.x) > std::abs(to_centre.y) ? Vec2d{std::copysign(1.0, to_centre.x), 0}
                                                      : Vec2d{0, std::copysign(1.0, to_centre.y)};
  if (is("wall_normal_up")) n = {0, -1};
  if (is("wall_normal_along_velocity") && dot(c.velocity, n) > 0) n = 1 / length(c.velocity) * c.velocity;
  n = -mixed("normal of a wall", -n);
  Vec2d point = c.position + way;
  constexpr Name kPoint("the point where a circle touches a box");
  if (turned_hash_ == kPoint.hash) point = b.position + turned(kPoint, b, nearest);
  if (is("circle_at_box_point_from_origin")) point = q * nearest;
  if (is("circle_at_box_point_at_box")) point = b.position;
  if (is("circle_at_box_point_at_circle")) point = c.position;
  if (is("circle_at_box_point_on_circle_beyond")) point = c.position - r * n;
  out.push_back({circle, box, point, n, r - d});
}

// The corners of a box that lie in another box.
void StudentWorld::touch_corners(std::size_t box, std::size_t corners, std::vector<Touch>& out) const {
  const Rigid &b = bodies_[box], &c = bodies_[corners];
  const auto before = static_cast<std::ptrdiff_t>(out.size());
  const Box size = this->box(b), other = this->box(c);
  const Vec2d along = side(b, {1, 0}), across = side(b, {0, 1});
  for (const Vec2d sign : corner_signs()) {
    const Vec2d corner = c.position + this->corner(c, {sign.x * other.width / 2, sign.y * other.height / 2});
    const Vec2d way = corner - b.position, local{dot(along, way), dot(across, way)};
    const double in_x = size.width / 2 - std::abs(local.x), in_y = size.height / 2 - std::abs(local.y);
    if (in_x < 0 || in_y < 0 || (in_x * in_y == 0 && !manner_.boxes_touch_at_0)) continue;
    const Vec2d n = (in_x < in_y) != is("largest_overlap") ? Vec2d{std::copysign(1.0, local.x), 0}
                                                           : Vec2d{0, std::copysign(1.0, local.y)};
    Vec2d normal = n.x * along + n.y * across;
    if (is("normal_of_the_first_face_only") && corners < box) normal = -normal;
    if (const Vec2d line = c.position - b.position; is("normal_between_centres"))
      normal = 1 / length(line) * line;
    if (is("box_normal_not_turned")) normal = n;
    const Vec2d point = is("contact_between_centres") ? 0.5 * (b.position + c.position) : corner;
    out.push_back({box, corners, point, normal, std::min(in_x, in_y)});
    if (is("one_corner")) return;
  }
  if (is("other_corner") && std::ssize(out) > before + 1) out.erase(out.begin() + before, out.end() - 1);
}

// Returns true for a pair that the mistake never considers.
bool StudentWorld::left_out(std::size_t a, std::size_t b) const {
  const std::size_t last = bodies_.size() - 2;
  const bool both_move = bodies_[a].inverse_mass > 0 && bodies_[b].inverse_mass > 0;
  if (scales("size of the cells in which circles are compared")) {
    const auto cell = [&](std::size_t i) {
      const Vec2d at = 1 / factor_ * bodies_[i].position;
      return Vec2d{std::floor(at.x), std::floor(at.y)};
    };
    const bool circles =
        bodies_[a].body->shapes[0].geometry.index() == 0 && bodies_[b].body->shapes[0].geometry.index() == 0;
    return circles && cell(a) != cell(b);
  }
  if (is("last_body_left_out")) return b == last;
  if (is("first_body_left_out")) return a == 0;
  if (is("neighbours_only")) return b != a + 1;
  if (is("first_against_others_only")) return a != 0;
  if (is("moving_pairs_left_out")) return both_move;
  if (is("pairs_of_a_static_first_left_out")) return bodies_[a].inverse_mass == 0;
  if (is("pairs_of_a_static_second_left_out")) return bodies_[b].inverse_mass == 0;
  if (mistake_.starts_with("bounds_")) return bounds_apart(a, b);
  return is("static_pairs_left_out") && !both_move;
}

template <class Touches>
void StudentWorld::each_pair(const Touches& touches) const {
  std::vector<bool> has_partner(bodies_.size());
  for (std::size_t a = 0; a + 1 < bodies_.size(); ++a) {
    for (std::size_t b = a + 1; b + 1 < bodies_.size(); ++b) {
      if (ends_the_loop(a, b)) break;
      if (bodies_[a].inverse_mass + bodies_[b].inverse_mass == 0 || joined(a, b) || left_out(a, b)) continue;
      if (is("one_partner_for_each") && (has_partner[a] || has_partner[b])) continue;
      const auto taken = [&](std::size_t i) { return bodies_[i].inverse_mass > 0 && has_partner[i]; };
      if (is("one_partner_for_each_moving") && (taken(a) || taken(b))) continue;
      if (is("one_contact_of_the_first") && taken(a)) continue;
      if (is("one_contact_of_the_second") && taken(b)) continue;
      if (!touches(a, b)) continue;
      has_partner[a] = has_partner[b] = true;
      if (is("first_partner_only")) break;
    }
  }
}

std::vector<Touch> StudentWorld::touches() const {
  std::vector<Touch> out;
  each_pair([&](std::size_t a, std::size_t b) {
    const std::size_t before = out.size();
    touch(a, b, out);
    return out.size() > before;
  });
  return out;
}

void StudentWorld::push_out() {
  if (is("sinks") || is("turned_every_step") || is("ignores_slow")) return;
  if (!manner_.in_turn) return push_out(touches());
  std::vector<Touch> of_pair;
  each_pair([&](std::size_t a, std::size_t b) {
    of_pair.clear();
    touch(a, b, of_pair);
    push_out(of_pair);
    return !of_pair.empty();
  });
}

void StudentWorld::touch(std::size_t a, std::size_t b, std::vector<Touch>& out) const {
  const bool round_a = bodies_[a].body->shapes[0].geometry.index() == 0;
  const bool round_b = bodies_[b].body->shapes[0].geometry.index() == 0;
  const std::size_t before = out.size();
  if (round_a && round_b) touch_circles(a, b, out);
  if (round_a && !round_b && !is("falls_through")) touch_circle_box(a, b, out);
  if (!round_a && round_b) touch_circle_box(b, a, out);
  const bool flips = round_a ? is("normal_flipped_if_circle_first") : is("normal_flipped_if_box_first");
  if (round_a != round_b && flips)
    for (std::size_t i = before; i < out.size(); ++i) out[i].normal = -out[i].normal;
  if (round_a || round_b || is("falls_through_boxes")) return;
  if (manner_.clips)
    touch_boxes(a, b, out);
  else
    touch_corners(b, a, out), touch_corners(a, b, out);
}

}  // namespace plumb::course
