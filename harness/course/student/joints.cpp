#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <type_traits>
#include <utility>

#include "harness/course/student/world.h"

// Holds joints: by impulses, and by correcting positions.
namespace plumb::course {
namespace {

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

StudentWorld::Ends StudentWorld::ends(const Joint& joint, Row row) const {
  const auto [first, second] = ends_[static_cast<std::size_t>(&joint - scene_.joints.data())];
  return std::visit(
      [&, first = first, second = second](const auto& j) -> Ends {
        Ends out{first, second, {}, {}, {}, {}, {}};
        if constexpr (requires { j.anchor_a; }) {
          const Rigid &a = bodies_[out.a], &b = bodies_[out.b];
          Vec2d anchor_b = is("one_anchor_for_both") ? j.anchor_a : j.anchor_b;
          Vec2d anchor_a = is("second_anchor_for_both") ? j.anchor_b : j.anchor_a;
          const bool stick = std::is_same_v<std::decay_t<decltype(j)>, DistanceJoint>;
          if (is("stick_anchors_ignored") && stick) {
            anchor_b = {};
            if (a.body != nullptr) anchor_a = {};
          }
          const bool neither = is("anchor_not_turned"), both = turned_hash_ == Name("a joint's anchors").hash;
          const auto to_world = [&](std::string_view which, const Rigid& body, Vec2d anchor) {
            if (both) return turned("a joint's anchors", body, anchor);
            return which == "first" ? turned("a joint's first anchor", body, anchor)
                                    : turned("a joint's second anchor", body, anchor);
          };
          const Rigid& turns_a = is("first_anchor_turned_by_the_second") ? b : a;
          const Rigid& turns_b = is("second_anchor_turned_by_the_first") ? a : b;
          out.arm_a =
              neither || is("first_anchor_not_turned") ? anchor_a : to_world("first", turns_a, anchor_a);
          out.arm_b =
              neither || is("second_anchor_not_turned") ? anchor_b : to_world("second", turns_b, anchor_b);
          if (is("joint_arms_of_before") && !kept_arms_.empty())
            std::tie(out.arm_a, out.arm_b) =
                kept_arms_[static_cast<std::size_t>(&joint - scene_.joints.data())];
          out.raw_a = anchor_a;
          out.raw_b = anchor_b;
          const auto r =
              edit_(Quantity::Arm, row, kInGap, std::array{out.arm_a, out.arm_b}, {out.raw_a, out.raw_b});
          out.gap = b.position + r[1] - a.position - r[0];
        }
        return out;
      },
      joint);
}

// Keeps the arms of all joints as they are now, for the mistake that uses them after the bodies have moved.
void StudentWorld::keep_arms() {
  kept_arms_.clear();
  if (!is("joint_arms_of_before")) return;
  std::vector<std::pair<Vec2d, Vec2d>> now;
  for (const Joint& joint : scene_.joints) {
    const Ends e = ends(joint, kCorrectionRow);
    now.emplace_back(e.arm_a, e.arm_b);
  }
  kept_arms_ = std::move(now);
}

// Keeps arms and directions of all joints for the mistake that uses them in later steps.
void StudentWorld::keep_held() {
  if (stale_.when == Stale::kNever || (stale_.when == Stale::kFirstStep && !held_.empty())) return;
  const Stale stale = std::exchange(stale_, {});
  std::vector<Held> now;
  for (const Joint& joint : scene_.joints) {
    const Ends e = ends(joint, kJointRow);
    const double gap = length(e.gap);
    now.push_back({e.arm_a, e.arm_b, gap > 0 ? 1 / gap * e.gap : Vec2d{1, 0}});
  }
  stale_ = stale;
  held_ = held_next_.empty() || stale.when == Stale::kFirstStep ? now : held_next_;
  held_next_ = now;
}

// Returns a joint's arms and direction, or those of an earlier step that the mistake uses in their place.
StudentWorld::Held StudentWorld::held(const Joint& joint, Row row, const Held& now) const {
  if (stale_.when == Stale::kNever || (stale_.rows & row) == 0) return now;
  const Held& old = held_[static_cast<std::size_t>(&joint - scene_.joints.data())];
  return {(stale_.parts & Stale::kFirstArm) != 0 ? old.arm_a : now.arm_a,
          (stale_.parts & Stale::kSecondArm) != 0 ? old.arm_b : now.arm_b,
          (stale_.parts & Stale::kDirection) != 0 ? old.along : now.along};
}

bool StudentWorld::joined(std::size_t a, std::size_t b) const {
  if (is("joined_bodies_collide")) return false;
  const auto is_pair = [&](const auto& ends) {
    return (ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a);
  };
  if (ends_.empty()) return false;
  if (is("last_joined_pair_only")) return is_pair(ends_.back());
  if (is("first_joined_pair_only")) return is_pair(ends_.front());
  if (is("joined_in_one_order"))
    return std::any_of(ends_.begin(), ends_.end(),
                       [&](const auto& ends) { return ends[0] == a && ends[1] == b; });
  return std::any_of(ends_.begin(), ends_.end(), is_pair);
}

// A stick as one row along it, a hinge as two, x and y, one after the other.
void StudentWorld::solve(const Joint& joint) {
  Ends e = ends(joint, kJointRow);
  if (is("lever_forgotten")) e.arm_a = e.arm_b = {};
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  const bool stick = std::holds_alternative<DistanceJoint>(joint);
  const double gap = length(e.gap);
  Vec2d along = is("stick_not_unit") ? e.gap : 1 / gap * e.gap;
  if (is("stick_along_centres")) {
    const Vec2d centres = b.position - a.position;
    along = 1 / length(centres) * centres;
  }
  const Held used = held(joint, kJointRow, {e.arm_a, e.arm_b, along});
  e.arm_a = used.arm_a;
  e.arm_b = used.arm_b;
  along = used.along;
  const bool one_row = stick || is("hinge_as_stick");
  if (one_row && !stick && gap < 1e-12) return;
  for (const Vec2d n : {one_row ? along : Vec2d{1, 0}, Vec2d{0, 1}}) {
    const double error = dot(e.gap, n) - (stick ? std::get<DistanceJoint>(joint).length : 0);
    double fed = is("no_position_correction") ? 0 : manner_.fed * error / dt_;
    if (scales("share of a joint's error without dt")) fed = factor_ * error;
    const double parting = speed_apart(kJointRow, a, b, {e.arm_a, e.arm_b}, {e.raw_a, e.raw_b}, n);
    const double speed = parting + fed;
    const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
    const Vec2d mass_a = is("joint_mass_of_the_second_arm") ? e.arm_b : e.arm_a;
    const Vec2d mass_b = is("joint_mass_of_the_first_arm") ? e.arm_a : e.arm_b;
    double k = edited_mass(kJointRow, a, b, {mass_a, mass_b}, {e.raw_a, e.raw_b}, n);
    if (is("joint_masses_in_place_of_inverses"))
      k = (a.inverse_mass > 0 ? 1 / a.inverse_mass : 0) + (b.inverse_mass > 0 ? 1 / b.inverse_mass : 0);
    if (stick && is("stick_only_pulls") && (speed < 0 || gap < std::get<DistanceJoint>(joint).length)) break;
    if (stick && is("stick_only_pushes") && (speed > 0 || gap > std::get<DistanceJoint>(joint).length)) break;
    if (stick && is("stick_impulse_only_pulls") && speed < 0) break;
    if (stick && is("stick_impulse_only_pushes") && speed > 0) break;
    if (n.x == 0 && is("hinge_along_x_only") && !stick) break;
    if (n.y == 0 && is("hinge_along_y_only") && !stick) continue;
    if (is("joint_same_direction")) {
      const Vec2d push = -speed / k * n;
      a.velocity += a.inverse_mass * push;
      a.spin += a.inverse_inertia * cross(e.arm_a, push);
      b.velocity += b.inverse_mass * push;
      b.spin += b.inverse_inertia * cross(e.arm_b, push);
    } else if (is("stick_masses_ignored")) {
      a.velocity += speed / 2 * n;
      b.velocity -= speed / 2 * n;
    } else if (is("stick_one_body_only")) {
      b.velocity -= speed * n;
    } else if (is("stick_other_body_only")) {
      if (a.inverse_mass > 0) a.velocity += speed * n;
    } else if (is("stick_pulls_the_second_only")) {
      b.velocity -= b.inverse_mass * speed / k * n;
      b.spin -= b.inverse_inertia * sb * speed / k;
    } else if (is("stick_pulls_the_first_only")) {
      a.velocity += a.inverse_mass * speed / k * n;
      a.spin += a.inverse_inertia * sa * speed / k;
    } else if ((is("joint_pulls_the_first_if_it_moves") && a.inverse_mass > 0) ||
               (is("joint_pulls_the_second_if_it_moves") && b.inverse_mass > 0)) {
      const bool first = is("joint_pulls_the_first_if_it_moves");
      const double push = -speed / k;
      Rigid& pulled = first ? a : b;
      pulled.velocity += (first ? -push : push) * pulled.inverse_mass * n;
      pulled.spin += (first ? -push : push) * pulled.inverse_inertia * (first ? sa : sb);
    } else if (is("joint_never_spins")) {
      a.velocity += a.inverse_mass * speed / k * n;
      b.velocity -= b.inverse_mass * speed / k * n;
    } else if (is("joint_spins_the_first_only") || is("joint_spins_the_second_only")) {
      const bool first = is("joint_spins_the_first_only");
      apply_impulse(e.a, e.b, first ? e.arm_a : Vec2d{}, first ? Vec2d{} : e.arm_b, -speed / k * n);
    } else if (is("joint_arms_swapped") || is("joint_first_arm_for_both") ||
               is("joint_second_arm_for_both")) {
      apply_impulse(e.a, e.b, is("joint_first_arm_for_both") ? e.arm_a : e.arm_b,
                    is("joint_second_arm_for_both") ? e.arm_b : e.arm_a, -speed / k * n);
    } else {
      change(kJointRow, a, b, {e.arm_a, e.arm_b}, {e.raw_a, e.raw_b},
             mixed("impulse of a joint", -times("impulse of a joint") * speed / k * n));
    }
    if (one_row) break;
  }
  if (is("hinge_shares_spin") && !stick && a.inverse_inertia > 0 && b.inverse_inertia > 0)
    a.spin = b.spin = (a.spin + b.spin) / 2;
}

void StudentWorld::correct(const Joint& joint) {
  if (!manner_.by_rows || std::holds_alternative<DistanceJoint>(joint)) return correct_along(joint, {1, 1});
  correct_along(joint, {1, 0});
  correct_along(joint, {0, 1});
}

// Closes a hinge's gap along one of the two axes, or along the gap itself for an axis of (1, 1).
void StudentWorld::correct_along(const Joint& joint, Vec2d axis) {
  Ends e = ends(joint, kCorrectionRow);
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  Vec2d error{axis.x * e.gap.x, axis.y * e.gap.y};
  if (const auto* stick = std::get_if<DistanceJoint>(&joint))
    error *= 1 - times("length of a stick") * stick->length / length(e.gap);
  const bool stick = std::holds_alternative<DistanceJoint>(joint), too_long = dot(error, e.gap) > 0;
  if (!stick && is("hinge_correction_along_x_only")) error.y = 0;
  if (!stick && is("hinge_correction_along_y_only")) error.x = 0;
  if ((stick && is("hinges_corrected_only")) || (!stick && is("sticks_corrected_only"))) return;
  const double size = length(error);
  if (size == 0) return;
  const bool never_shortens = is("stick_only_pushes") || is("stick_correction_only_pushes"),
             never_lengthens = is("stick_only_pulls") || is("stick_correction_only_pulls");
  if (stick && (too_long ? never_shortens : never_lengthens)) return;
  if (stick && !too_long && is("stick_correction_sign_lost")) error = -error;
  const Vec2d own = 1 / size * error;
  const Held used = held(joint, kCorrectionRow, {e.arm_a, e.arm_b, stick && !too_long ? -own : own});
  e.arm_a = used.arm_a;
  e.arm_b = used.arm_b;
  const Vec2d n = mixed("error of a joint", !stick ? own : too_long ? used.along : -used.along);
  const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
  const double k = edited_mass(kCorrectionRow, a, b, {e.arm_a, e.arm_b}, {e.raw_a, e.raw_b}, n);
  const double share = manner_.by_positions ? 1 : manner_.joint_share;
  const double push = times("correction of a joint") * share * size / k;
  const double turn = is("correction_turns_backwards") ? -push : is("correction_never_turns") ? 0 : push;
  const double turn_a = is("correction_turns_the_first_backwards") ? -turn : turn;
  const double turn_b = is("correction_turns_the_second_backwards") ? -turn : turn;
  if (is("correction_moves_both_alike") && a.inverse_mass > 0 && b.inverse_mass > 0) {
    const Vec2d half = push * k / 2 * n;
    a.position += half;
    b.position -= half;
    return;
  }
  if (is("correction_by_the_first_mass") || is("correction_by_the_second_mass")) {
    const double mass = is("correction_by_the_first_mass") ? a.inverse_mass : b.inverse_mass;
    a.position += mass * push * n;
    a.angle += a.inverse_inertia * sa * turn;
    b.position -= mass * push * n;
    b.angle -= b.inverse_inertia * sb * turn;
    return;
  }
  const auto arms =
      edit_(Quantity::Arm, kCorrectionRow, kInChange, std::array{e.arm_a, e.arm_b}, {e.raw_a, e.raw_b});
  const auto [mass, inertia] = eases(kCorrectionRow, kInChange, a, b);
  if (!is("correction_of_the_second_end_only")) {
    a.position += mass[0] * push * n;
    a.angle += inertia[0] * cross(arms[0], n) * turn_a;
  }
  if (is("correction_of_the_first_end_only")) return;
  b.position -= mass[1] * push * n;
  b.angle -= inertia[1] * cross(arms[1], n) * turn_b;
}

}  // namespace plumb::course
