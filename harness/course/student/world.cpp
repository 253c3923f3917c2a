#include "harness/course/student/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace plumb::course {
namespace {

constexpr int kSweeps = 40;
constexpr double kPushShare = 0.5;
constexpr double kSlop = 0.001;  // m that resting bodies stay in each other, so that they still touch
constexpr std::pair<const char*, const char*> kScaled[] = {
    {"gravity_upwards", "gravity*-1"},
    {"gravity_twice", "gravity*2"},
    {"rest_length_ignored", "rest length of a spring*0"},
    {"spring_pushes", "stiffness of a spring*-1"}};
constexpr std::string_view kOneSweep = ", one sweep";
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
    double share = 0.5;
    if (is("disc_as_ring")) share = 1;
    if (is("disc_as_sphere")) share = 0.4;
    if (is("disc_as_box")) share = 2.0 / 3;
    if (is("disc_by_diameter")) share = 2;
    return (is("inertia_without_mass") ? 1 : body.mass) * r * r * share * times("inertia of a disc");
  }
  const Box& box = std::get<Box>(shape.geometry);
  const double w = is("square_of_its_height") ? box.height : box.width;
  const double h = is("thin_box_as_square") ? w : box.height;
  const double mass = is("inertia_without_mass") ? 1 : body.mass;
  if (is("second_moment_of_area")) return mass * w * h * h * h / 12;
  if (is("second_moment_about_height")) return mass * h * w * w * w / 12;
  if (is("second_moment_without_mass")) return w * h * h * h / 12;
  if (is("polar_moment_of_area")) return w * h * (w * w + h * h) / 12;
  if (is("one_side_only")) return body.mass * w * w / 12;
  if (is("other_side_only")) return body.mass * h * h / 12;
  if (is("mass_for_inertia")) return body.mass;
  if (is("inertia_of_one")) return 1;
  if (is("square_of_sum")) return body.mass * (w + h) * (w + h) / 12;
  if (is("box_by_area")) return body.mass * w * h / 12;
  return mass * (w * w + h * h) / 12 * (is("inertia_sixth") ? 2 : 1) * times("inertia of a box");
}

StudentWorld::StudentWorld(const Scene& scene, double dt, std::string mistake, reference::Scheme scheme)
    : scene_(scene), dt_(dt), mistake_(std::move(mistake)), scheme_(scheme) {
  for (const auto& [name, scaled] : kScaled)
    if (is(name)) mistake_ = scaled;
  if (const std::size_t star = mistake_.find('*'); star != std::string::npos) {
    quantity_ = mistake_.substr(0, star);
    factor_ = std::stod(mistake_.substr(star + 1));
  }
  if (mistake_.ends_with(kOneSweep)) {
    once_ = true;
    mistake_.resize(mistake_.size() - kOneSweep.size());
  }
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
    if (is("first_angle_ignored")) rigid.angle = 0;
    if (const auto* box = std::get_if<Box>(&body.shapes.at(0).geometry); box && is("corner_for_centre"))
      rigid.position += Vec2d{box->width / 2, box->height / 2};
    if (const auto* box = std::get_if<Box>(&body.shapes.at(0).geometry); box && is("upper_corner_for_centre"))
      rigid.position += Vec2d{box->width / 2, -box->height / 2};
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
  return is("answers_before_the_step") && steps_ > 0 ? before_step_ : truly();
}

std::vector<BodyState> StudentWorld::truly() const {
  std::vector<BodyState> out;
  for (std::size_t i = 0; i + 1 < bodies_.size(); ++i) {
    const Rigid& b = bodies_[i];
    out.push_back({b.position, shown(b.angle), b.velocity, b.spin});
  }
  return out;
}

double StudentWorld::shown(double angle) const {
  if (is("wrapped")) return std::remainder(angle, 2 * std::numbers::pi);
  return angle * (is("angle_in_degrees") ? kDegrees : 1);
}

double StudentWorld::times(std::string_view quantity) const { return quantity_ == quantity ? factor_ : 1; }

double StudentWorld::radius(const Rigid& body) const {
  return times("radius") * std::get<Circle>(body.body->shapes[0].geometry).radius;
}

Box StudentWorld::box(const Rigid& body) const {
  Box out = std::get<Box>(body.body->shapes[0].geometry);
  out.width *= times("size of a box");
  out.height *= times("size of a box");
  if (is("width_and_height_swapped")) std::swap(out.width, out.height);
  return out;
}

void StudentWorld::apply(const ForceLaw& law, bool first, bool last) {
  const auto names = ends_of(law);
  const auto index = find_body(scene_, names[1] == kWorld ? names[0] : names[1]);
  Rigid& b = bodies_[index.value_or(bodies_.size() - 1)];
  const auto add = [&](Vec2d force) {
    if (is("last_force_only")) b.force = {};
    if (is("first_force_lost") && first && !last) return;
    if (is("last_force_lost") && last && !first) return;
    if (is("first_force_only") && !first) return;
    if (is("force_once") && steps_ > 0) return;
    b.force += force;
  };
  const auto acts = [&](double start, double duration) {
    if (is("push_never_ends")) return time() >= start - dt_ / 2;
    if (is("push_always")) return true;
    if (is("push_starts_at_once")) return time() < start + duration - 1e-9;
    if (is("push_ends_at_duration")) return time() >= start - 1e-9 && time() < duration - 1e-9;
    if (is("push_in_steps")) {
      const double n = static_cast<double>(steps_);
      return n >= start && n < start + duration;
    }
    if (is("push_from_zero")) return time() < duration - 1e-9;
    return time() >= start - 1e-9 && time() < start + duration - 1e-9;
  };
  if (const auto* push = std::get_if<PointForce>(&law)) {
    if (!acts(push->start, push->duration)) return;
    add(times("force") * push->force +
        (is("weight_with_every_force") ? 1 / b.inverse_mass : 0) * scene_.gravity);
    Vec2d arm = is("point_not_turned") ? push->point : b.to_world(push->point);
    if (is("lever_from_origin")) arm += b.position;
    if (is("point_ignored")) arm = {};
    if (is("point_turned_backwards"))
      arm = Rotation<double>{std::cos(b.angle), -std::sin(b.angle)} * push->point;
    arm *= times("arm of a force");
    double turns = cross(arm, push->force);
    if (is("dot_for_cross")) turns = dot(arm, push->force);
    if (is("only_rx_fy")) turns = arm.x * push->force.y;
    if (is("only_ry_fx")) turns = -arm.y * push->force.x;
    if (is("sum_for_cross")) turns = arm.x * push->force.y + arm.y * push->force.x;
    if (is("length_for_cross")) turns = length(arm) * length(push->force);
    b.torque += turns * (is("torque_backwards") ? -1 : 1);
  } else if (const auto* torque = std::get_if<Torque>(&law)) {
    if (acts(torque->start, torque->duration)) b.torque += times("torque") * torque->torque;
  } else if (const auto* drag = std::get_if<LinearDrag>(&law)) {
    const double share = is("drag_not_divided") ? 1 / b.inverse_mass : 1;
    const double speed = length(b.velocity), c = (is("drag_pushes") ? share : -share) * drag->coefficient;
    if (is("drag_constant") && speed > 0) return add(c / speed * b.velocity);
    if (is("drag_quadratic")) return add(c * speed * b.velocity);
    if (is("drag_divided_twice")) return add(c * b.inverse_mass * b.velocity);
    if (is("drag_along_x_only")) return add({c * b.velocity.x, 0});
    add(times("drag") * c * b.velocity);
  } else if (const auto* spring = std::get_if<SpringForce>(&law)) {
    const Vec2d way = b.position - spring->anchor_a;
    const double rest = spring->rest_length * times("rest length of a spring"), stretch = length(way) - rest;
    double tension = spring->stiffness * stretch * times("stiffness of a spring");
    if (is("spring_only_pulls")) tension = std::max(tension, 0.0);
    if (is("spring_only_pushes")) tension = std::min(tension, 0.0);
    if (is("spring_by_sign")) tension = std::copysign(spring->stiffness, stretch);
    if (is("spring_by_square")) tension = std::copysign(spring->stiffness * stretch * stretch, stretch);
    if (is("spring_not_unit")) tension *= length(way);
    if (is("spring_mass_not_divided")) tension /= b.inverse_mass;
    if (is("spring_divided_by_mass_twice")) tension *= b.inverse_mass;
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
  g *= times("gravity");
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
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    Vec2d fall = is("gravity_off_while_touching") && b.touched ? Vec2d{} : g;
    b.touched = false;
    if (is("gravity_divided_by_mass")) fall *= b.inverse_mass;
    if (is("weight_not_divided")) fall *= 1 / b.inverse_mass;
    double inverse = is("mass_not_divided") ? 1 : b.inverse_mass;
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
    if (quantity_ == "speed below which bodies stop" && length(b.velocity) < factor_) b.velocity = {};
    const double torque_dt = is("torque_without_dt") ? 1 : is("torque_dt_twice") ? dt * dt : dt;
    b.spin += torque_dt * b.inverse_inertia * b.torque;
    if (is("spin_damping")) b.spin *= 0.99;
  }
}

void StudentWorld::move() {
  for (Rigid& b : bodies_) {
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    if (is("moves_by_first_velocity")) {
      b.position += dt_ * b.body->velocity;
    } else {
      const double dt = is("velocity_without_dt") ? 1 : is("velocity_with_dt_twice") ? dt_ * dt_ : dt_;
      const Vec2d v =
          scheme_ == reference::Scheme::VelocityVerlet ? 0.5 * (b.velocity + b.before) : b.velocity;
      b.position += times("velocity in the position's change") * dt * v;
    }
    b.before = b.velocity;
    if (is("half_a_step_twice")) b.position += dt_ * dt_ / 2 * scene_.gravity;
    b.angle += dt_ * b.spin * times("spin in the angle's change") *
               (is("spin_in_degrees")        ? kDegrees
                : is("spin_read_as_degrees") ? 1 / kDegrees
                                             : 1);
  }
}

double StudentWorld::restitution(const Touch& touch) const {
  const double a = bodies_[touch.a].body->shapes[0].restitution,
               b = bodies_[touch.b].body->shapes[0].restitution;
  const double e = std::max(a, b) * times("restitution");
  if (is("restitution_root")) return std::sqrt(e);
  if (is("restitution_of_one_less")) return 1 - e;
  if (is("restitution_minimum")) return std::min(a, b);
  if (is("restitution_mean")) return std::sqrt(a * b);
  if (is("restitution_sum")) return a + b;
  if (is("restitution_of_the_first")) return a;
  if (is("restitution_of_the_second")) return b;
  if (is("restitution_squared")) return e * e;
  if (is("restitution_average")) return (a + b) / 2;
  if (is("restitution_product")) return a * b;
  if (is("always_elastic")) return 1;
  return is("restitution_zero") ? 0 : e;
}

// The velocity of b's point relative to that of a.
Vec2d StudentWorld::relative_velocity(const Touch& touch) const {
  const auto at_point = [&](const Rigid& body) {
    const Vec2d arm = touch.point - (is("contact_arm_from_origin") ? Vec2d{} : body.position);
    if (is("spin_not_in_velocity")) return body.velocity;
    if (is("point_velocity_flipped")) return body.velocity - cross(body.spin, arm);
    return body.velocity_at(arm);
  };
  const Vec2d a = at_point(bodies_[touch.a]), b = at_point(bodies_[touch.b]);
  const bool both = bodies_[touch.a].inverse_mass > 0 && bodies_[touch.b].inverse_mass > 0;
  if (is("velocity_of_the_first_only") && both) return -a;
  if (is("velocity_of_the_second_only") && both) return b;
  if (is("velocities_added")) return a + b;
  return b - a;
}

void StudentWorld::prepare(Touch& touch) const {
  const double closing = dot(relative_velocity(touch), touch.normal);
  const double slow = is("threshold_too_high") ? 3 : 2 * length(scene_.gravity) * dt_;
  if (closing < -slow || (is("never_rests") && closing < 0)) touch.bounce = -restitution(touch) * closing;
  if (is("bounce_of_whole_speed") && touch.bounce > 0)
    touch.bounce = restitution(touch) * length(relative_velocity(touch));
  if (is("bounce_sign")) touch.bounce = -touch.bounce;
  if (is("one_plus_forgotten") && touch.bounce > 0) touch.bounce += closing;
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
  const double closing = dot(relative_velocity(touch), n);
  if (is("ignores_slow") && closing > -4 * length(scene_.gravity) * dt_) return;
  if (is("both_turned") && closing < 0) {
    a.velocity = -a.velocity;
    return;
  }
  if (is("velocity_sign_lost") && closing < 0) {
    Rigid& moves = a.inverse_mass > 0 ? a : b;
    const bool upright = std::abs(n.y) > std::abs(n.x);
    double& v = upright ? moves.velocity.y : moves.velocity.x;
    v = restitution(touch) * std::abs(v);
    return;
  }
  if (is("stops_dead") && closing < 0) {
    a.velocity = b.velocity = {};
    return;
  }
  if (is("wrong_axis") && closing < 0) {
    Vec2d& v = (a.inverse_mass > 0 ? a : b).velocity;
    (std::abs(n.y) > std::abs(n.x) ? v.x : v.y) *= -restitution(touch);
    touch.bounce = closing;
    return;
  }
  if (is("whole_velocity_scaled") && closing < 0) {
    a.velocity *= -restitution(touch);
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
  if (is("first_inverse_mass_only")) k = a.inverse_mass > 0 ? a.inverse_mass : k;
  if (is("second_inverse_mass_only")) k = b.inverse_mass > 0 ? b.inverse_mass : k;
  if (is("first_inverse_mass_for_both") && a.inverse_mass > 0) k = 2 * a.inverse_mass;
  if (is("second_inverse_mass_for_both") && b.inverse_mass > 0) k = 2 * b.inverse_mass;
  if (is("first_inverse_mass_twice")) k += a.inverse_mass;
  if (is("second_inverse_mass_twice")) k += b.inverse_mass;
  if (is("lever_not_squared"))
    k += a.inverse_inertia * std::abs(spin_a) + b.inverse_inertia * std::abs(spin_b);
  else if (is("effective_mass_with_lever_only"))
    k += spin_a * spin_a + spin_b * spin_b;
  else if (!heavy_only)
    k += a.inverse_inertia * spin_a * spin_a + b.inverse_inertia * spin_b * spin_b;
  if (is("masses_in_place_of_inverses")) k = 1 / a.inverse_mass + 1 / b.inverse_mass;
  if (is("effective_mass_forgotten")) k = 1;
  if (is("masses_ignored")) k = (a.inverse_mass > 0) + (b.inverse_mass > 0);
  double j = times("impulse of a contact") * (touch.bounce - closing) / k;
  const auto new_sum = [&](double change) {
    if (is("each_push_clamped")) return touch.sum + std::max(0.0, change);
    return is("no_test_of_parting") ? touch.sum + change : std::max(0.0, touch.sum + change);
  };
  const double before = touch.sum, sum = new_sum(j);
  j = sum - before;
  double share_a = a.inverse_mass, share_b = b.inverse_mass;
  if (is("inverse_mass_forgotten") || is("masses_ignored")) {
    share_a = share_a > 0;
    share_b = share_b > 0;
  }
  if (is("masses_swapped")) std::swap(share_a, share_b);
  if (is("one_body_only")) share_b = 0;
  if (is("other_body_only")) share_a = 0;
  if (is("inverse_mass_of_the_first")) share_b = share_a > 0 && share_b > 0 ? share_a : share_b;
  if (is("inverse_mass_of_the_second")) share_a = share_a > 0 && share_b > 0 ? share_b : share_a;
  if (is("multiplied_by_mass")) {
    share_a = share_a > 0 ? 1 / share_a : 0;
    share_b = share_b > 0 ? 1 / share_b : 0;
  }
  if (is("same_direction_for_both")) share_a = -share_a;
  if (is("no_rotation")) spin_a = spin_b = 0;
  if (is("r_cross_n_flipped")) spin_a = -spin_a, spin_b = -spin_b;
  if (is("first_never_spins") || is("spin_not_changed")) spin_a = 0;
  if (is("second_never_spins") || is("spin_not_changed")) spin_b = 0;
  if (is("second_arm_for_both") || is("arms_swapped")) spin_a = cross(arm_b, n);
  if (is("first_arm_for_both") || is("arms_swapped")) spin_b = cross(arm_a, n);
  if (is("second_sees_new_velocity") || is("first_sees_new_velocity")) {
    const bool first_now = is("second_sees_new_velocity");
    const auto apply_to_first = [&](double push) {
      a.velocity -= a.inverse_mass * push * n;
      a.spin -= a.inverse_inertia * spin_a * push;
    };
    const auto apply_to_second = [&](double push) {
      b.velocity += b.inverse_mass * push * n;
      b.spin += b.inverse_inertia * spin_b * push;
    };
    first_now ? apply_to_first(j) : apply_to_second(j);
    const double again = new_sum((touch.bounce - dot(relative_velocity(touch), n)) / k) - before;
    first_now ? apply_to_second(again) : apply_to_first(again);
    touch.sum = sum;
    return rub(touch);
  }
  touch.sum = sum;
  Vec2d push = j * n;
  if (is("along_wall_changed") && j > 0 && touch.sum == j) {
    Rigid& moves = a.inverse_mass > 0 ? a : b;
    const Vec2d along{-n.y, n.x};
    moves.velocity -= (1 - restitution(touch)) * dot(moves.velocity, along) * along;
  }
  if (is("impulse_backwards")) push = -push;
  if (is("whole_velocity") && j > 0)
    push = length(a.velocity - b.velocity) / k * 2.0 / length(a.velocity - b.velocity) *
           (a.velocity - b.velocity);
  a.velocity -= share_a * push;
  b.velocity += share_b * push;
  const bool once = is("spin_by_impulse_alone");
  a.spin -= (once && a.inverse_inertia > 0 ? 1 : a.inverse_inertia) * spin_a * j;
  b.spin += (once && b.inverse_inertia > 0 ? 1 : b.inverse_inertia) * spin_b * j;
  rub(touch);
}

// Friction: along the tangent, at most mu times the sum of the impulses along the normal.
void StudentWorld::rub(Touch& touch) {
  const Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const double mu_a = a.body->shapes[0].friction, mu_b = b.body->shapes[0].friction;
  double mu = times("friction") * std::sqrt(mu_a * mu_b);
  if (is("friction_product")) mu = mu_a * mu_b;
  if (is("friction_average")) mu = (mu_a + mu_b) / 2;
  if (is("friction_sum")) mu = mu_a + mu_b;
  if (is("friction_minimum")) mu = std::min(mu_a, mu_b);
  if (is("friction_maximum")) mu = std::max(mu_a, mu_b);
  if (mu == 0 || is("friction_ignored")) return;
  const Vec2d t{-touch.normal.y, touch.normal.x}, arm_a = touch.point - a.position,
                                                  arm_b = touch.point - b.position;
  const double spin_a = cross(arm_a, t), spin_b = cross(arm_b, t);
  const double k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * spin_a * spin_a +
                   b.inverse_inertia * spin_b * spin_b;
  const double sliding = dot(b.velocity_at(arm_b) - a.velocity_at(arm_a), t);
  double most = is("friction_unlimited") ? 1e9 : mu * touch.sum;
  if (is("friction_without_normal")) most = mu;
  if (is("friction_without_mu")) most = touch.sum;
  const double against = is("friction_backwards") ? -sliding : sliding;
  const double sum = std::clamp(touch.sum_across - against / k, -most, most);
  const double j = sum - std::exchange(touch.sum_across, sum);
  apply_impulse(touch.a, touch.b, is("second_arm_for_both") || is("arms_swapped") ? arm_b : arm_a,
                is("first_arm_for_both") || is("arms_swapped") ? arm_a : arm_b, j * t);
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
    double share_a = a.inverse_mass, share_b = b.inverse_mass;
    const bool both = share_a > 0 && share_b > 0;
    if (is("correction_shares_swapped") && both) std::swap(share_a, share_b);
    if (is("correction_of_the_first_only") && both) share_b = 0;
    if (is("correction_of_the_second_only") && both) share_a = 0;
    if (is("correction_without_masses") && both) share_a = share_b = share_a + share_b;
    const double f = times("correction of an overlap");
    a.position -= f * share_a * push;
    b.position += f * share_b * push;
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
          const Vec2d anchor_b = is("one_anchor_for_both") ? j.anchor_a : j.anchor_b;
          const Vec2d anchor_a = is("second_anchor_for_both") ? j.anchor_b : j.anchor_a;
          out.arm_a = is("anchor_not_turned") ? anchor_a : a.to_world(anchor_a);
          out.arm_b = is("anchor_not_turned") ? anchor_b : b.to_world(anchor_b);
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
    double k = a.inverse_mass + b.inverse_mass;
    if (!is("joint_without_rotation")) k += a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
    if (is("joint_masses_in_place_of_inverses"))
      k = (a.inverse_mass > 0 ? 1 / a.inverse_mass : 0) + (b.inverse_mass > 0 ? 1 / b.inverse_mass : 0);
    if (stick && is("stick_only_pulls") && (speed < 0 || gap < std::get<DistanceJoint>(joint).length)) break;
    if (stick && is("stick_only_pushes") && (speed > 0 || gap > std::get<DistanceJoint>(joint).length)) break;
    if (n.x == 0 && is("hinge_along_x_only") && !stick) break;
    if (n.y == 0 && is("hinge_along_y_only") && !stick) continue;
    if (is("stick_masses_ignored")) {
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
      apply_impulse(e.a, e.b, e.arm_a, e.arm_b, -times("impulse of a joint") * speed / k * n);
    }
    if (stick) break;
  }
}

void StudentWorld::correct(const Joint& joint) {
  const Ends e = ends(joint);
  Rigid &a = bodies_[e.a], &b = bodies_[e.b];
  Vec2d error = e.gap;
  if (const auto* stick = std::get_if<DistanceJoint>(&joint))
    error *= 1 - times("length of a stick") * stick->length / length(e.gap);
  const double size = length(error);
  if (size == 0) return;
  const bool stick = std::holds_alternative<DistanceJoint>(joint), too_long = dot(error, e.gap) > 0;
  if (stick && (too_long ? is("stick_only_pushes") : is("stick_only_pulls"))) return;
  const Vec2d n = 1 / size * error;
  const double sa = cross(e.arm_a, n), sb = cross(e.arm_b, n);
  const double k =
      a.inverse_mass + b.inverse_mass + a.inverse_inertia * sa * sa + b.inverse_inertia * sb * sb;
  const double push = times("correction of a joint") * kPushShare * size / k;
  const double turn = is("correction_turns_backwards") ? -push : is("correction_never_turns") ? 0 : push;
  if (!is("correction_of_the_second_end_only")) {
    a.position += a.inverse_mass * push * n;
    a.angle += a.inverse_inertia * sa * turn;
  }
  if (is("correction_of_the_first_end_only")) return;
  b.position -= b.inverse_mass * push * n;
  b.angle -= b.inverse_inertia * sb * turn;
}

void StudentWorld::step() {
  if (is("answers_before_the_step")) before_step_ = truly();
  if (is("first_step_twice") && steps_ == 0) advance();
  advance();
  ++steps_;
}

void StudentWorld::advance() {
  gather_forces();
  const bool moves_first = is("explicit_euler") || scheme_ == reference::Scheme::ExplicitEuler;
  if (moves_first) move();
  accelerate();
  std::vector<Touch> found = touches();
  for (Touch& touch : found) {
    prepare(touch);
    bodies_[touch.a].touched = bodies_[touch.b].touched = true;
  }
  const bool joints = !is("joint_ignored");
  for (int sweep = 0; sweep < (is("too_few_iterations") ? 1 : kSweeps); ++sweep) {
    for (const Joint& joint : scene_.joints)
      if (joints) solve(joint);
    if (sweep == 0 || !once_) answer_all(found);
  }
  touched_ = touched_ || !found.empty();
  if (!moves_first) move();
  push_out();
  if (joints && !is("no_position_correction"))
    for (int sweep = 0; sweep < (is("too_few_iterations") ? 1 : kSweeps / 4); ++sweep)
      for (const Joint& joint : scene_.joints) correct(joint);
}

}  // namespace plumb::course
