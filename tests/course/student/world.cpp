#include "tests/course/student/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::course {
namespace {

constexpr int kSweeps = 40;
constexpr double kPushShare = 0.5;
constexpr double kSlop = 0.001;  // m that resting bodies stay in each other, so that they still touch
constexpr double kDegrees = 180 / std::numbers::pi;

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

Vec2d Rigid::to_world(Vec2d local) const {
  return Rotation<double>{std::cos(angle), std::sin(angle)} * local;
}

double StudentWorld::inertia(const Body& body) const {
  if (body.inertia) return *body.inertia;
  const Shape& shape = body.shapes.at(0);
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    const double r = circle->radius;
    return body.mass * r * r * (is("disc_as_ring") ? 1 : 0.5);
  }
  const Box& box = std::get<Box>(shape.geometry);
  const double w = box.width, h = is("thin_box_as_square") ? w : box.height;
  if (is("one_side_only")) return body.mass * w * w / 12;
  if (is("mass_for_inertia")) return body.mass;
  return body.mass * (w * w + h * h) / (is("inertia_sixth") ? 6 : 12);
}

StudentWorld::StudentWorld(const Scene& scene, double dt, std::string mistake)
    : scene_(scene), dt_(dt), mistake_(std::move(mistake)) {
  // Sweeps mend what a single answer gets wrong: these are made by who has none yet.
  for (const char* name :
       {"one_body_only", "inverse_mass_forgotten", "masses_in_place_of_inverses", "masses_swapped",
        "masses_ignored", "effective_mass_forgotten", "normal_not_unit", "whole_velocity",
        "r_cross_n_flipped", "no_rotation", "effective_mass_without_rotation", "both_corners_take_all",
        "impulse_backwards", "each_turned", "sinks", "turned_every_step"})
    once_ = once_ || is(name);
  for (const Body& body : scene_.bodies) {
    Rigid rigid{.position = body.position, .velocity = body.velocity, .force = {}, .angle = body.angle};
    rigid.spin = body.angular_velocity;
    rigid.body = &body;
    if (body.type == BodyType::Dynamic) {
      rigid.inverse_mass = 1 / body.mass;
      if (!body.fixed_rotation || is("fixed_rotation_ignored")) rigid.inverse_inertia = 1 / inertia(body);
    } else if (is("static_has_mass")) {
      rigid.inverse_mass = 1 / body.mass;
    }
    bodies_.push_back(rigid);
  }
  bodies_.push_back({});
  if (is("starts_at_rest"))
    for (Rigid& rigid : bodies_) rigid.velocity = {};
}

std::vector<BodyState> StudentWorld::states() const {
  std::vector<BodyState> out;
  for (std::size_t i = 0; i + 1 < bodies_.size(); ++i) {
    const Rigid& b = bodies_[i];
    out.push_back({b.position, b.angle * (is("angle_in_degrees") ? kDegrees : 1), b.velocity, b.spin});
  }
  return out;
}

void StudentWorld::apply(const ForceLaw& law, bool first, bool last) {
  const auto names = ends_of(law);
  const auto index = find_body(scene_, names[1] == kWorld ? names[0] : names[1]);
  Rigid& b = bodies_[index.value_or(bodies_.size() - 1)];
  const auto add = [&](Vec2d force) {
    if (is("last_force_only")) b.force = {};
    if (is("first_force_lost") && first && !last) return;
    b.force += force;
  };
  const auto acts = [&](double start, double duration) {
    if (is("push_never_ends")) return time() >= start - dt_ / 2;
    return time() >= start - 1e-9 && time() < start + duration - 1e-9;
  };
  if (const auto* push = std::get_if<PointForce>(&law)) {
    if (!acts(push->start, push->duration)) return;
    add(push->force);
    Vec2d arm = is("point_not_turned") ? push->point : b.to_world(push->point);
    if (is("lever_from_origin")) arm += b.position;
    if (is("point_ignored")) arm = {};
    b.torque += cross(arm, push->force) * (is("torque_backwards") ? -1 : 1);
  } else if (const auto* torque = std::get_if<Torque>(&law)) {
    if (acts(torque->start, torque->duration)) b.torque += torque->torque;
  } else if (const auto* drag = std::get_if<LinearDrag>(&law)) {
    const double share = is("drag_not_divided") ? 1 / b.inverse_mass : 1;
    add((is("drag_pushes") ? share : -share) * drag->coefficient * b.velocity);
  } else if (const auto* spring = std::get_if<SpringForce>(&law)) {
    const Vec2d way = b.position - spring->anchor_a;
    const double rest = is("rest_length_ignored") ? 0 : spring->rest_length;
    const double tension = spring->stiffness * (length(way) - rest) * (is("spring_pushes") ? -1 : 1);
    add(-tension / length(way) * way);
  }
}

void StudentWorld::gather_forces() {
  for (Rigid& b : bodies_) {
    if (!is("force_not_cleared")) b.force = {};
    b.torque = 0;
  }
  for (std::size_t i = 0; i < scene_.forces.size(); ++i)
    apply(scene_.forces[i], i == 0, i + 1 == scene_.forces.size());
}

void StudentWorld::accelerate() {
  Vec2d g = scene_.gravity;
  if (is("no_gravity")) g = {};
  if (is("gravity_upwards")) g = -g;
  if (is("gravity_hard_coded")) g = {0, -9.81};
  if (is("gravity_only_down")) g.x = 0;
  if (is("gravity_twice")) g *= 2;
  if (is("gravity_of_9_8")) g = {0, -9.8};
  double dt = dt_;
  if (is("dt_twice")) dt *= dt_;
  if (is("dt_missing")) dt = 1;
  if (is("milliseconds")) dt *= 1000;
  if (is("per_frame")) dt = 1.0 / 60;
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    Vec2d fall = g;
    if (is("gravity_divided_by_mass")) fall *= b.inverse_mass;
    if (is("weight_not_divided")) fall *= 1 / b.inverse_mass;
    const double inverse = is("mass_not_divided") ? 1 : b.inverse_mass;
    b.velocity += dt * (fall + inverse * b.force);
    if (is("damping")) b.velocity *= 0.99;
    b.spin += dt * b.inverse_inertia * b.torque;
  }
}

void StudentWorld::move() {
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    b.position += (is("velocity_without_dt") ? 1 : dt_) * b.velocity;
    if (is("half_a_step_twice")) b.position += dt_ * dt_ / 2 * scene_.gravity;
    b.angle += dt_ * b.spin * (is("spin_in_degrees") ? kDegrees : 1);
  }
}

double StudentWorld::restitution(const Touch& touch) const {
  const double a = bodies_[touch.a].body->shapes[0].restitution,
               b = bodies_[touch.b].body->shapes[0].restitution;
  const double e = std::max(a, b);
  if (is("restitution_squared")) return e * e;
  if (is("restitution_average")) return (a + b) / 2;
  if (is("restitution_product")) return a * b;
  if (is("always_elastic")) return 1;
  return is("restitution_zero") ? 0 : e;
}

void StudentWorld::prepare(Touch& touch) const {
  const Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const Vec2d v = b.velocity_at(touch.point - b.position) - a.velocity_at(touch.point - a.position);
  const double closing = dot(v, touch.normal);
  const double slow = 2 * length(scene_.gravity) * dt_;
  if (closing < -slow || (is("never_rests") && closing < 0)) touch.bounce = -restitution(touch) * closing;
  if (is("correction_adds_energy")) touch.bounce += 0.2 * touch.depth / dt_;
}

void StudentWorld::apply_impulse(std::size_t a, std::size_t b, Vec2d arm_a, Vec2d arm_b, Vec2d impulse) {
  Rigid &first = bodies_[a], &second = bodies_[b];
  first.velocity -= first.inverse_mass * impulse;
  first.spin -= first.inverse_inertia * cross(arm_a, impulse);
  second.velocity += second.inverse_mass * impulse;
  second.spin += second.inverse_inertia * cross(arm_b, impulse);
}

void StudentWorld::answer_all(std::vector<Touch>& found) {
  if (!is("both_corners_take_all")) {
    for (Touch& touch : found) answer(touch);
    return;
  }
  const std::vector<Rigid> before = bodies_;
  std::vector<Rigid> after = bodies_;
  for (Touch& touch : found) {
    answer(touch);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      after[i].velocity += bodies_[i].velocity - before[i].velocity;
      after[i].spin += bodies_[i].spin - before[i].spin;
    }
    bodies_ = before;
  }
  bodies_ = after;
}

void StudentWorld::answer(Touch& touch) {
  Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const Vec2d n = touch.normal, arm_a = touch.point - a.position, arm_b = touch.point - b.position;
  const double closing = dot(b.velocity_at(arm_b) - a.velocity_at(arm_a), n);
  if (is("ignores_slow") && closing > -4 * length(scene_.gravity) * dt_) return;
  if (is("both_turned") && closing < 0) {
    a.velocity = -a.velocity;
    return;
  }
  if (is("turned_every_step")) {
    a.velocity -= (1 + restitution(touch)) * dot(a.velocity, n) * n;
    return;
  }
  if (is("each_turned") && closing < 0) {
    a.velocity -= 2 * dot(a.velocity, n) * n;
    b.velocity -= 2 * dot(b.velocity, n) * n;
    return;
  }
  double spin_a = cross(arm_a, n), spin_b = cross(arm_b, n);
  const bool heavy_only = is("effective_mass_without_rotation") || is("no_rotation");
  double k = a.inverse_mass + b.inverse_mass;
  if (!heavy_only) k += a.inverse_inertia * spin_a * spin_a + b.inverse_inertia * spin_b * spin_b;
  if (is("masses_in_place_of_inverses")) k = 1 / a.inverse_mass + 1 / b.inverse_mass;
  if (is("effective_mass_forgotten")) k = 1;
  if (is("masses_ignored")) k = (a.inverse_mass > 0) + (b.inverse_mass > 0);
  double j = (touch.bounce - closing) / k;
  const double sum = is("no_test_of_parting") ? touch.sum + j : std::max(0.0, touch.sum + j);
  j = sum - std::exchange(touch.sum, sum);
  double share_a = a.inverse_mass, share_b = b.inverse_mass;
  if (is("inverse_mass_forgotten") || is("masses_ignored")) {
    share_a = share_a > 0;
    share_b = share_b > 0;
  }
  if (is("masses_swapped")) std::swap(share_a, share_b);
  if (is("one_body_only")) share_b = 0;
  if (is("no_rotation")) spin_a = spin_b = 0;
  if (is("r_cross_n_flipped")) spin_a = -spin_a, spin_b = -spin_b;
  Vec2d push = j * n;
  if (is("impulse_backwards")) push = -push;
  if (is("whole_velocity") && j > 0)
    push = length(a.velocity - b.velocity) / k * 2.0 / length(a.velocity - b.velocity) *
           (a.velocity - b.velocity);
  a.velocity -= share_a * push;
  b.velocity += share_b * push;
  a.spin -= a.inverse_inertia * spin_a * j;
  b.spin += b.inverse_inertia * spin_b * j;
  rub(touch);
}

// Friction: along the tangent, at most mu times the sum of the impulses along the normal.
void StudentWorld::rub(Touch& touch) {
  const Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const double mu = std::sqrt(a.body->shapes[0].friction * b.body->shapes[0].friction);
  if (mu == 0 || is("friction_ignored")) return;
  const Vec2d t{-touch.normal.y, touch.normal.x}, arm_a = touch.point - a.position,
                                                  arm_b = touch.point - b.position;
  const double spin_a = cross(arm_a, t), spin_b = cross(arm_b, t);
  const double k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * spin_a * spin_a +
                   b.inverse_inertia * spin_b * spin_b;
  const double sliding = dot(b.velocity_at(arm_b) - a.velocity_at(arm_a), t);
  const double most = is("friction_unlimited") ? 1e9 : mu * touch.sum;
  const double sum = std::clamp(touch.sum_across - sliding / k, -most, most);
  const double j = sum - std::exchange(touch.sum_across, sum);
  apply_impulse(touch.a, touch.b, arm_a, arm_b, j * t);
}

void StudentWorld::push_out() {
  if (is("correction_split_evenly")) {
    for (const Touch& touch : touches()) {
      const Vec2d push = kPushShare / 2 * std::max(0.0, touch.depth - kSlop) * touch.normal;
      bodies_[touch.a].position -= push;
      bodies_[touch.b].position += push;
    }
    return;
  }
  if (is("sinks") || is("turned_every_step") || is("ignores_slow")) return;
  for (const Touch& touch : touches()) {
    Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
    const Vec2d push =
        kPushShare * std::max(0.0, touch.depth - kSlop) / (a.inverse_mass + b.inverse_mass) * touch.normal;
    a.position -= a.inverse_mass * push;
    b.position += b.inverse_mass * push;
  }
}

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
          out.arm_a = a.to_world(j.anchor_a);
          out.arm_b = b.to_world(j.anchor_b);
          out.gap = b.position + out.arm_b - a.position - out.arm_a;
        }
        return out;
      },
      joint);
}

// A stick as one row along it, a hinge as two, x and y, one after the other.
void StudentWorld::solve(const Joint& joint) {
  Ends e = ends(joint);
  if (is("lever_forgotten")) e.arm_a = e.arm_b = {};
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  const bool stick = std::holds_alternative<DistanceJoint>(joint);
  const double gap = length(e.gap);
  for (const Vec2d n : {stick ? 1 / gap * e.gap : Vec2d{1, 0}, Vec2d{0, 1}}) {
    const double speed = dot(b.velocity_at(e.arm_b) - a.velocity_at(e.arm_a), n);
    const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
    const double k =
        a.inverse_mass + b.inverse_mass + a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
    if (is("stick_masses_ignored")) {
      a.velocity += speed / 2 * n;
      b.velocity -= speed / 2 * n;
    } else if (is("stick_one_body_only")) {
      b.velocity -= speed * n;
    } else {
      apply_impulse(e.a, e.b, e.arm_a, e.arm_b, -speed / k * n);
    }
    if (stick) break;
  }
}

void StudentWorld::correct(const Joint& joint) {
  const Ends e = ends(joint);
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  Vec2d error = e.gap;
  if (const auto* stick = std::get_if<DistanceJoint>(&joint)) error *= 1 - stick->length / length(e.gap);
  const double size = length(error);
  if (size == 0) return;
  const Vec2d n = 1 / size * error;
  const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
  const double k =
      a.inverse_mass + b.inverse_mass + a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
  const double push = kPushShare * size / k;
  a.position += a.inverse_mass * push * n;
  b.position -= b.inverse_mass * push * n;
  a.angle += a.inverse_inertia * sa * push;
  b.angle -= b.inverse_inertia * sb * push;
}

void StudentWorld::step() {
  gather_forces();
  if (is("explicit_euler")) move();
  accelerate();
  std::vector<Touch> found = touches();
  for (Touch& touch : found) prepare(touch);
  const bool joints = !is("joint_ignored");
  for (int sweep = 0; sweep < (is("too_few_iterations") ? 1 : kSweeps); ++sweep) {
    for (const Joint& joint : scene_.joints)
      if (joints) solve(joint);
    if (sweep == 0 || !once_) answer_all(found);
  }
  if (!is("explicit_euler")) move();
  push_out();
  if (joints && !is("no_position_correction"))
    for (int sweep = 0; sweep < (is("too_few_iterations") ? 1 : kSweeps / 4); ++sweep)
      for (const Joint& joint : scene_.joints) correct(joint);
  ++steps_;
}

}  // namespace plumb::course
