#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "harness/course/student/world.h"

// Applies forces, and moves bodies.
namespace plumb::course {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

constexpr double kForEver = std::numeric_limits<double>::infinity();

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

void StudentWorld::apply(const ForceLaw& law, bool first, bool last) {
  const auto names = ends_of(law);
  const auto index = find_body(scene_, names[1] == kWorld ? names[0] : names[1]);
  const auto acts_on = [&](std::size_t own) {
    const bool drags = std::holds_alternative<LinearDrag>(law),
               pushes = std::holds_alternative<PointForce>(law);
    if ((drags && is("drag_on_the_first_body")) || (pushes && is("force_on_the_first_body")))
      return std::size_t{0};
    if ((drags && is("drag_on_the_last_body")) || (pushes && is("force_on_the_last_body")))
      return bodies_.size() - 2;
    return own;
  };
  Rigid& b = bodies_[acts_on(index.value_or(bodies_.size() - 1))];
  const auto add_to = [&](Name law_name, Rigid& body, Vec2d force) {
    if (is("last_force_only")) body.force = {};
    if (is("first_force_lost") && first && !last) return;
    if (is("last_force_lost") && last && !first) return;
    if (is("first_force_only") && !first) return;
    if (is("force_once") && steps_ > 0) return;
    act(law_name, body, force);
  };
  const auto acts = [&](double start, double duration) {
    if (std::isinf(duration)) {
      if (is("endless_never_acts")) return false;
      if (is("endless_for_one_step")) duration = dt_;
      if (is("endless_for_one_second")) duration = 1;
    }
    if (is("push_never_ends")) return time() >= start - dt_ / 2;
    if (is("push_always")) return true;
    if (is("push_starts_at_once")) return time() < start + duration - 1e-9;
    if (is("push_ends_at_duration")) return time() >= start - 1e-9 && time() < duration - 1e-9;
    if (is("push_in_steps")) {
      const double n = static_cast<double>(steps_);
      return n >= start && n < start + duration;
    }
    if (is("push_for_one_step")) return time() >= start - 1e-9 && time() < start + dt_ - 1e-9;
    if (is("push_a_step_late")) return time() >= start + dt_ / 2 && time() < start + duration - 1e-9;
    if (is("push_outside_its_time")) return time() < start - 1e-9 || time() >= start + duration - 1e-9;
    if (is("push_from_zero")) return time() < duration - 1e-9;
    return time() >= start - 1e-9 && time() < start + duration - 1e-9;
  };
  if (const auto* push = std::get_if<PointForce>(&law)) {
    if (!acts(push->start, push->duration)) return;
    const bool of_body = push->frame == Frame::Body ? !is("force_never_turned") : is("force_always_turned");
    const Vec2d given = of_body ? b.rotation() * push->force : push->force;
    add_to("force", b,
           mixed("force", times("force") * given) +
               (is("weight_with_every_force") ? 1 / b.inverse_mass : 0) * scene_.gravity);
    Vec2d arm = is("point_not_turned") ? push->point : turned("a force's point", b, push->point);
    if (is("lever_from_origin")) arm += b.position;
    if (is("point_taken_for_world")) arm = push->point - b.position;
    if (is("point_ignored")) arm = {};
    if (is("point_turned_backwards"))
      arm = Rotation<double>{std::cos(b.angle), -std::sin(b.angle)} * push->point;
    arm *= times("arm of a force");
    double turns = cross(arm, given);
    if (is("dot_for_cross")) turns = dot(arm, given);
    if (is("only_rx_fy")) turns = arm.x * given.y;
    if (is("only_ry_fx")) turns = -arm.y * given.x;
    if (is("sum_for_cross")) turns = arm.x * given.y + arm.y * given.x;
    if (is("length_for_cross")) turns = length(arm) * length(given);
    b.torque += turns * (is("torque_backwards") ? -1 : 1);
  } else if (const auto* torque = std::get_if<Torque>(&law)) {
    if (is("torque_time_ignored") || acts(torque->start, torque->duration))
      b.torque += times("torque") * torque->torque;
  } else if (const auto* drag = std::get_if<LinearDrag>(&law)) {
    const double share = is("drag_not_divided") ? 1 / b.inverse_mass : 1;
    const double speed = length(b.velocity), c = (is("drag_pushes") ? share : -share) * drag->coefficient;
    const auto add = [&](Vec2d force) { add_to("drag", b, force); };
    if (is("drag_slows_spin")) b.torque += c * b.spin;
    if (is("drag_constant") && speed > 0) return add(c / speed * b.velocity);
    if (is("drag_quadratic")) return add(c * speed * b.velocity);
    const Vec2d v = b.velocity;
    if (is("drag_quadratic_by_component")) return add({c * std::abs(v.x) * v.x, c * std::abs(v.y) * v.y});
    if (is("drag_constant_by_component"))
      return add({v.x == 0 ? 0 : std::copysign(c, c * v.x), v.y == 0 ? 0 : std::copysign(c, c * v.y)});
    if (is("drag_dt_twice")) return add(c * dt_ * b.velocity);
    if (is("drag_divided_twice")) return add(c * b.inverse_mass * b.velocity);
    if (is("drag_by_position")) return add(c * b.position);
    if (is("drag_by_first_velocity")) return add(c * b.body->velocity);
    if (is("drag_along_x_only")) return add({c * b.velocity.x, 0});
    if (is("drag_along_x_always")) return add({c * speed, 0});
    if (is("drag_along_y_always")) return add({0, c * speed});
    add(mixed("drag", times("drag") * c * b.velocity));
  } else if (const auto* spring = std::get_if<SpringForce>(&law)) {
    Rigid& a = bodies_[find_body(scene_, names[0]).value_or(bodies_.size() - 1)];
    Rigid& end = bodies_[find_body(scene_, names[1]).value_or(bodies_.size() - 1)];
    Vec2d arm_a = turned("a spring's anchors", a, spring->anchor_a),
          arm_b = turned("a spring's anchors", end, spring->anchor_b);
    const auto ignored = [&](const Rigid& body) {
      return is("spring_anchors_ignored") || (is("spring_anchor_of_world_ignored") && body.body == nullptr);
    };
    if (ignored(a)) arm_a = {};
    if (ignored(end)) arm_b = {};
    if (is("spring_one_anchor_for_both")) arm_b = turned("a spring's anchors", end, spring->anchor_a);
    if (is("spring_second_anchor_for_both")) arm_a = turned("a spring's anchors", a, spring->anchor_b);
    if (is("spring_anchors_not_turned")) arm_a = spring->anchor_a, arm_b = spring->anchor_b;
    const Vec2d way = end.position + arm_b - a.position - arm_a;
    const auto first_place = [&](const Rigid& body, Vec2d anchor) {
      if (body.body == nullptr) return anchor;
      const double angle = body.body->angle;
      return body.body->position + Rotation<double>{std::cos(angle), std::sin(angle)} * anchor;
    };
    double rest = spring->rest_length * times("rest length of a spring");
    if (is("rest_length_of_start"))
      rest = length(first_place(end, spring->anchor_b) - first_place(a, spring->anchor_a));
    const double stretch = (is("length_squared") ? dot(way, way) : length(way)) - rest;
    double tension = spring->stiffness * stretch * times("stiffness of a spring");
    if (is("spring_always_pulls")) tension = std::abs(tension);
    if (is("spring_always_pushes")) tension = -std::abs(tension);
    if (is("spring_by_strain")) tension /= rest != 0 ? rest : 1;
    if (is("spring_by_strain_of_now")) tension /= length(way);
    if (is("spring_times_rest_length")) tension *= rest;
    if (is("spring_dt_twice")) tension *= dt_;
    if (is("spring_only_pulls")) tension = std::max(tension, 0.0);
    if (is("spring_only_pushes")) tension = std::min(tension, 0.0);
    if (is("spring_by_sign")) tension = std::copysign(spring->stiffness, stretch);
    if (is("spring_by_square")) tension = std::copysign(spring->stiffness * stretch * stretch, stretch);
    if (is("spring_not_unit")) tension *= length(way);
    const auto point_velocity = [&](const Rigid& body, Vec2d arm) {
      const double share = is("spring_velocity_flipped") ? -1 : times("w x r");
      return body.velocity + share * mixed("w x r", cross(body.spin, arm));
    };
    double over = length(way);  // divides the way to give the spring's direction
    if (is("spring_way_for_direction")) over = 1;
    if (is("spring_over_rest_length")) over = rest != 0 ? rest : 1;
    if (is("spring_over_square")) over = dot(way, way);
    const bool exchanged = is("spring_rate_arms_swapped");
    const Vec2d along = mixed("direction of a spring", 1 / over * way),
                v_a = point_velocity(a, exchanged || is("spring_rate_second_arm") ? arm_b : arm_a),
                v_b = point_velocity(end, exchanged || is("spring_rate_first_arm") ? arm_a : arm_b);
    Vec2d parting = v_b - v_a;
    if (is("spring_damps_the_first_only")) parting = -v_a;
    if (is("spring_damps_the_second_only")) parting = v_b;
    if (is("spring_damps_the_sum")) parting = v_a + v_b;
    double rate = dot(mixed("velocity in a spring", parting), along);
    if (is("damping_by_speed")) rate = length(parting);
    if (is("spring_rate_of_centres")) rate = dot(end.velocity - a.velocity, along);
    if (is("damping_without_sign")) rate = std::abs(rate);
    tension += times("damping of a spring") * spring->damping * rate;
    const auto pull = [&](Rigid& body, Vec2d arm, Vec2d force) {
      if (body.inverse_mass == 0) return;
      if (is("spring_mass_not_divided")) force *= 1 / body.inverse_mass;
      if (is("spring_divided_by_mass_twice")) force *= body.inverse_mass;
      add_to("spring", body, force);
      const double turns = is("spring_never_turns") ? 0 : is("spring_turns_backwards") ? -1 : 1;
      if (is("spring_turns_the_first_only") && &body != &a) return;
      if (is("spring_turns_the_second_only") && &body != &end) return;
      body.torque += turns * cross(arm, force);
    };
    const bool swapped = is("spring_torque_arms_swapped");
    const Vec2d turns_a = swapped || is("spring_torque_second_arm") ? arm_b : arm_a,
                turns_b = swapped || is("spring_torque_first_arm") ? arm_a : arm_b;
    Vec2d force = tension * along;
    if (is("spring_damps_the_whole_velocity")) force += spring->damping * (parting - rate * along);
    if (is("spring_by_component")) force += spring->stiffness * (way - Vec2d{rest, rest} - stretch * along);
    if (!is("spring_pulls_the_second_only")) pull(a, turns_a, is("spring_same_direction") ? -force : force);
    if (!is("spring_pulls_the_first_only"))
      pull(end, turns_b, is("spring_pulls_both_as_the_first") ? force : -force);
  }
}

void StudentWorld::gather_forces() {
  for (Rigid& b : bodies_) {
    const bool kept = is("force_not_cleared") || is("force_and_torque_not_cleared") ||
                      (is("force_of_the_first_not_cleared") && &b == &bodies_.front()) ||
                      (is("force_of_others_not_cleared") && &b != &bodies_.front());
    if (!kept) b.force = {};
    if (!is("torque_not_cleared") && !is("force_and_torque_not_cleared")) b.torque = 0;
  }
  const auto rests = [&](const ForceLaw& law) {
    const auto* push = std::get_if<PointForce>(&law);
    return push != nullptr && (time() < push->start - 1e-9 || time() >= push->start + push->duration - 1e-9);
  };
  const auto has_no_time = [&](const ForceLaw& law) {
    const auto* push = std::get_if<PointForce>(&law);
    const auto* torque = std::get_if<Torque>(&law);
    return std::isinf(push != nullptr ? push->duration : torque != nullptr ? torque->duration : kForEver);
  };
  for (std::size_t i = 0; i < scene_.forces.size(); ++i) {
    if (is("untimed_never_acts") && has_no_time(scene_.forces[i])) continue;
    const bool comes =
        rests(scene_.forces[i]) && time() < std::get<PointForce>(scene_.forces[i]).start - 1e-9;
    const bool over = rests(scene_.forces[i]) && !comes;
    if (is("inactive_force_ends_the_loop") && (comes || over)) break;
    if ((is("force_to_come_ends_the_loop") && comes) || (is("force_over_ends_the_loop") && over)) break;
    apply(scene_.forces[i], i == 0, i + 1 == scene_.forces.size());
  }
}

void StudentWorld::accelerate() {
  Vec2d g = scene_.gravity;
  if (is("no_gravity")) g = {};
  g = mixed("gravity", times("gravity") * g);
  if (is("gravity_of_10")) g = {0, -10};
  if (is("gravity_of_9_80665")) g = {0, -9.80665};
  if (is("gravity_components_swapped")) g = {g.y, g.x};
  if (is("gravity_x_into_y")) g.y += g.x;
  if (is("gravity_y_into_x")) g.x += g.y;
  if (is("gravity_lost_on_contact") && touched_) g = {};
  if (is("gravity_hard_coded")) g = {0, -9.81};
  if (is("gravity_only_down")) g.x = 0;
  if (is("gravity_of_9_8")) g = {0, -9.8};
  double dt = dt_;
  if (is("dt_twice")) dt *= dt_;
  if (is("dt_missing")) dt = 1;
  if (is("milliseconds")) dt *= 1000;
  if (is("per_frame")) dt = 1.0 / 60;
  if (is("time_for_dt")) dt = time();
  if (is("next_time_for_dt")) dt = time() + dt_;
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    Vec2d fall = is("gravity_off_while_touching") && b.touched ? Vec2d{} : g;
    b.touched = false;
    if (is("gravity_divided_by_mass")) fall *= b.inverse_mass;
    if (is("weight_not_divided")) fall *= 1 / b.inverse_mass;
    if (is("gravity_off_while_pushed") && b.force != Vec2d{}) fall = {};
    if (acting_hash_ == Name("gravity").hash) act("gravity", b, 1 / b.inverse_mass * std::exchange(fall, {}));
    double inverse = is("mass_not_divided") ? 1 : another("mass in F/m", b).inverse_mass;
    if (is("mass_multiplied")) inverse = 1 / b.inverse_mass;
    if (is("mass_divided_twice")) inverse *= inverse;
    if (is("root_of_mass")) inverse = std::sqrt(inverse);
    double force_dt = dt;
    if (is("force_without_dt")) force_dt = 1;
    if (is("force_per_frame")) force_dt = 1.0 / 60;
    if (is("force_dt_twice")) force_dt = dt_ * dt_;
    const Vec2d gain = dt * fall + force_dt * inverse * b.force;
    if (is("constant_speed")) b.velocity = b.body->velocity;
    b.velocity += gain;
    if (is("damping")) b.velocity *= 0.99;
    if (is("speeding_up")) b.velocity *= 1.0005;
    if (scales("speed below which bodies stop") && length(b.velocity) < factor_) b.velocity = {};
    const double torque_dt = is("torque_without_dt") ? 1 : is("torque_dt_twice") ? dt * dt : dt;
    b.spin_before = b.spin;
    b.spin += torque_dt * b.inverse_inertia * b.torque;
    if (is("spin_damping")) b.spin *= 0.99;
  }
}

void StudentWorld::move() {
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    if (scales("speed below which bodies do not move") && length(b.velocity) < factor_) continue;
    if (is("moves_by_first_velocity")) {
      b.position += dt_ * b.body->velocity;
    } else {
      const double dt = is("velocity_without_dt")      ? 1
                        : is("velocity_with_dt_twice") ? dt_ * dt_
                        : is("move_per_frame")         ? 1.0 / 60
                        : is("time_for_dt_in_moves")   ? time()
                        : is("next_time_in_moves")     ? time() + dt_
                                                       : dt_;
      const Vec2d v =
          scheme_ == reference::Scheme::VelocityVerlet ? 0.5 * (b.velocity + b.before) : b.velocity;
      b.position +=
          mixed("velocity in the position's change", times("velocity in the position's change") * dt * v);
    }
    b.before = b.velocity;
    if (is("half_a_step_twice")) b.position += dt_ * dt_ / 2 * scene_.gravity;
    const double turned = is("spin_in_degrees") ? kDegrees : is("spin_read_as_degrees") ? 1 / kDegrees : 1;
    const double spin = is("angle_by_old_spin") ? b.spin_before : b.spin;
    b.angle += dt_ * spin * times("spin in the angle's change") * turned;
  }
}

}  // namespace plumb::course
