#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/course/student/world.h"

// Holds joints: by impulses along their rows, and by moving their ends.
namespace plumb::course {
namespace {

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

StudentWorld::Ends StudentWorld::ends(const Joint& joint) const {
  return std::visit(
      [&](const auto& j) -> Ends {
        Ends out{find_body(scene_, j.body_a).value_or(bodies_.size() - 1),
                 find_body(scene_, j.body_b).value_or(bodies_.size() - 1),
                 {},
                 {},
                 {}};
        if constexpr (requires { j.anchor_a; }) {
          const Rigid &a = bodies_[out.a], &b = bodies_[out.b];
          const Vec2d anchor_b = is("one_anchor_for_both") ? j.anchor_a : j.anchor_b;
          const Vec2d anchor_a = is("second_anchor_for_both") ? j.anchor_b : j.anchor_a;
          const auto turned = [this](const Rigid& body, Vec2d anchor) {
            if (is("anchor_not_turned")) return anchor;
            if (is("anchor_turned_backwards"))
              return Rotation<double>{std::cos(body.angle), -std::sin(body.angle)} * anchor;
            return body.to_world(anchor);
          };
          out.arm_a = turned(a, is("anchors_swapped") ? j.anchor_b : anchor_a);
          out.arm_b = turned(b, is("anchors_swapped") ? j.anchor_a : anchor_b);
          out.gap = b.position + out.arm_b - a.position - out.arm_a;
        }
        return out;
      },
      joint);
}

// A stick as one row along it, a hinge as two, x and y, one after the other.
void StudentWorld::solve(const Joint& joint, std::size_t index) {
  Ends e = ends(joint);
  if (is("lever_forgotten")) e.arm_a = e.arm_b = {};
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  const bool stick = std::holds_alternative<DistanceJoint>(joint);
  const double gap = length(e.gap);
  const auto velocity_at = [this](const Rigid& body, Vec2d arm) {
    if (is("joint_spin_not_in_velocity")) return body.velocity;
    if (is("joint_point_velocity_flipped")) return body.velocity - cross(body.spin, arm);
    return body.velocity_at(arm);
  };
  if (is("arm_of_impulse_not_turned"))
    std::visit(
        [&](const auto& j) {
          if constexpr (requires { j.anchor_a; }) e.arm_a = j.anchor_a, e.arm_b = j.anchor_b;
        },
        joint);
  for (const Vec2d n : {stick ? 1 / gap * e.gap : Vec2d{1, 0}, Vec2d{0, 1}}) {
    const double speed = dot(velocity_at(b, e.arm_b) - velocity_at(a, e.arm_a), n);
    const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
    double k = a.inverse_mass + b.inverse_mass;
    if (!is("joint_without_rotation")) k += a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
    if (is("joint_masses_in_place_of_inverses"))
      k = (a.inverse_mass > 0 ? 1 / a.inverse_mass : 0) + (b.inverse_mass > 0 ? 1 / b.inverse_mass : 0);
    if (is("joint_effective_mass_forgotten")) k = 1;
    if (stick && is("stick_only_pulls") && (speed < 0 || gap < std::get<DistanceJoint>(joint).length)) break;
    if (stick && is("stick_only_pushes") && (speed > 0 || gap > std::get<DistanceJoint>(joint).length)) break;
    if (n.x == 0 && is("hinge_along_x_only") && !stick) break;
    if (n.y == 0 && is("hinge_along_y_only") && !stick) continue;
    double j = -times("impulse of a joint") * speed / k;
    if (is("joint_only_pulls") || is("joint_row_only_pulls")) j = std::min(j, 0.0);
    if (is("joint_only_pushes") || is("joint_row_only_pushes")) j = std::max(j, 0.0);
    if (is("joint_sum_only_pulls") || is("joint_sum_only_pushes")) {
      double& sum = stick || n.y == 0 ? joint_sums_[index].x : joint_sums_[index].y;
      const double whole = is("joint_sum_only_pulls") ? std::min(sum + j, 0.0) : std::max(sum + j, 0.0);
      j = whole - std::exchange(sum, whole);
    }
    Vec2d arm_a = e.arm_a, arm_b = e.arm_b;
    if (is("joint_spins_the_first_only") || is("joint_never_spins")) arm_b = {};
    if (is("joint_spins_the_second_only") || is("joint_never_spins")) arm_a = {};
    if (is("joint_arms_swapped") || is("joint_second_arm_for_both")) arm_a = e.arm_b;
    if (is("joint_arms_swapped") || is("joint_first_arm_for_both")) arm_b = e.arm_a;
    if (is("joint_spins_backwards")) arm_a = -arm_a, arm_b = -arm_b;
    if (is("joint_spins_the_first_backwards")) arm_a = -arm_a;
    if (is("joint_spins_the_second_backwards")) arm_b = -arm_b;
    double share_a = a.inverse_mass, share_b = b.inverse_mass;
    if (is("joint_masses_swapped") && share_a > 0 && share_b > 0) std::swap(share_a, share_b);
    if (is("joint_inverse_mass_forgotten")) share_a = share_a > 0, share_b = share_b > 0;
    if (is("stick_masses_ignored")) {
      a.velocity += speed / 2 * n;
      b.velocity -= speed / 2 * n;
    } else if (is("stick_one_body_only")) {
      b.velocity -= speed * n;
    } else if (is("stick_other_body_only")) {
      if (a.inverse_mass > 0) a.velocity += speed * n;
    } else {
      if (!is("stick_pulls_the_second_only")) {
        a.velocity -= (is("joint_same_direction_for_both") ? -1 : 1) * share_a * j * n;
        a.spin -= a.inverse_inertia * cross(arm_a, n) * j;
      }
      if (!is("stick_pulls_the_first_only")) {
        b.velocity += share_b * j * n;
        b.spin += b.inverse_inertia * cross(arm_b, n) * j;
      }
    }
    if (stick) break;
  }
}

// Moves the ends of a joint together by `share` of its error.
void StudentWorld::correct(const Joint& joint, std::size_t index, double share) {
  Ends e = ends(joint);
  if (by_positions_ && is("lever_forgotten")) e.arm_a = e.arm_b = {};
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  Vec2d error = e.gap;
  if (by_positions_ && is("lever_forgotten")) error = b.position - a.position;
  if (const auto* stick = std::get_if<DistanceJoint>(&joint))
    error *= 1 - times("length of a stick") *
                     (is("length_of_the_start") ? first_lengths_[index] : stick->length) / length(e.gap);
  else if (is("hinge_along_x_only"))
    error.y = 0;
  else if (is("hinge_along_y_only"))
    error.x = 0;
  const bool stick = std::holds_alternative<DistanceJoint>(joint), too_long = dot(error, e.gap) > 0;
  if (is("joint_row_only_pulls") || is("joint_row_only_pushes")) {
    const bool pulls = is("joint_row_only_pulls");
    if (stick && too_long != pulls) return;
    if (!stick)
      error = pulls ? Vec2d{std::max(error.x, 0.0), std::max(error.y, 0.0)}
                    : Vec2d{std::min(error.x, 0.0), std::min(error.y, 0.0)};
  }
  const double size = length(error);
  if (size == 0) return;
  if (stick && (too_long ? is("stick_only_pushes") : is("stick_only_pulls"))) return;
  const Vec2d n = 1 / size * error;
  const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
  double k = a.inverse_mass + b.inverse_mass;
  const bool turns = !is("correction_never_turns") && !(by_positions_ && is("joint_never_spins"));
  if (!is("correction_without_rotation") && !(by_positions_ && is("joint_without_rotation")))
    k += a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
  double push = times("correction of a joint") * share * size / k;
  double share_a = a.inverse_mass, share_b = b.inverse_mass;
  if (by_positions_) {  // makes the mistakes of impulses here
    push *= times("impulse of a joint");
    if (is("stick_masses_ignored"))
      push *= k, share_a = share_b = 0.5;
    else if (is("stick_one_body_only"))
      push *= k, share_a = 0, share_b = 1;
    else if (is("stick_other_body_only"))
      push *= k, share_a = share_a > 0, share_b = 0;
    else if (is("stick_pulls_the_second_only"))
      share_a = 0;
    else if (is("stick_pulls_the_first_only"))
      share_b = 0;
  }
  if (is("correction_masses_ignored") && share_a > 0 && share_b > 0) push *= k, share_a = share_b = 0.5;
  if (is("correction_masses_swapped") && share_a > 0 && share_b > 0) std::swap(share_a, share_b);
  const double turn = is("correction_turns_backwards") ? -push : turns ? push : 0;
  if (!is("correction_of_the_second_end_only")) {
    a.position += share_a * push * n;
    if (share_a > 0) a.angle += a.inverse_inertia * sa * turn;
  }
  if (is("correction_of_the_first_end_only")) return;
  b.position -= share_b * push * n;
  if (share_b > 0) b.angle -= b.inverse_inertia * sb * turn;
}

}  // namespace plumb::course
