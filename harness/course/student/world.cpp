#include "harness/course/student/world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace plumb::course {
namespace {

constexpr std::pair<const char*, const char*> kScaled[] = {
    {"correction_adds_energy", "share of an overlap in the bounce*0.2"},
    {"gravity_upwards", "gravity*-1"},
    {"gravity_twice", "gravity*2"},
    {"rest_length_ignored", "rest length of a spring*0"},
    {"spring_pushes", "stiffness of a spring*-1"}};
constexpr double kDegrees = 180 / std::numbers::pi;

// Returns the vector whose dot product with another is its "x", "-x", "y", "-y" or "0".
Vec2d axis_of(const std::string& text) {
  const double sign = text.starts_with('-') ? -1 : 1;
  return {text.ends_with('x') ? sign : 0, text.ends_with('y') ? sign : 0};
}

// Returns the sign that "|x|" or "-|y|" always has; 0 for "x", "-y" or "0".
int sign_of(const std::string& text) {
  if (!text.ends_with('|')) return 0;
  return text.starts_with('-') ? -1 : 1;
}

// Returns the text without the bars of an absolute value.
std::string without_bars(std::string text) {
  std::erase(text, '|');
  return text;
}

std::array<std::size_t, 2> indices(const Scene& scene, const Joint& joint) {
  const std::size_t world = scene.bodies.size();
  return std::visit(
      [&](const auto& j) -> std::array<std::size_t, 2> {
        return {find_body(scene, j.body_a).value_or(world), find_body(scene, j.body_b).value_or(world)};
      },
      joint);
}

}  // namespace

Rotation<double> Rigid::rotation() const { return {std::cos(turns * angle), std::sin(turns * angle)}; }

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
    if (is("inertia_inverted")) return 1 / (body.mass * r * r * share);
    if (is("inertia_floored")) return std::floor(body.mass * r * r / 2);
    const bool no_mass = is("inertia_without_mass") || is("inertia_of_discs_without_mass");
    return (no_mass ? 1 : body.mass) * r * r * share * times("inertia of a disc");
  }
  const Box& box = std::get<Box>(shape.geometry);
  const double w = is("square_of_its_height") ? box.height : box.width;
  const double h = is("thin_box_as_square") ? w : box.height;
  const bool no_mass = is("inertia_without_mass") || is("inertia_of_boxes_without_mass");
  const double mass = no_mass ? 1 : body.mass;
  if (is("second_moment_of_area")) return mass * w * h * h * h / 12;
  if (is("second_moment_about_height")) return mass * h * w * w * w / 12;
  if (is("second_moment_without_mass")) return w * h * h * h / 12;
  if (is("polar_moment_of_area")) return w * h * (w * w + h * h) / 12;
  if (is("one_side_only")) return body.mass * w * w / 12;
  if (is("other_side_only")) return body.mass * h * h / 12;
  if (is("mass_for_inertia")) return body.mass;
  if (is("inertia_inverted")) return 12 / (body.mass * (w * w + h * h));
  if (is("inertia_of_one")) return 1;
  if (is("inertia_floored")) return std::floor(body.mass * (w * w + h * h) / 12);
  if (is("square_of_sum")) return body.mass * (w + h) * (w + h) / 12;
  if (is("box_by_area")) return body.mass * w * h / 12;
  return mass * (w * w + h * h) / 12 * (is("inertia_sixth") ? 2 : 1) * times("inertia of a box");
}

// Returns a body's mass, or the value that the mistake uses instead.
double StudentWorld::mass(const Body& body) const {
  const auto* circle = std::get_if<Circle>(&body.shapes.at(0).geometry);
  const Box sides = circle != nullptr ? Box{2 * circle->radius, 2 * circle->radius}
                                      : std::get<Box>(body.shapes.at(0).geometry);
  const double fills = circle != nullptr ? std::numbers::pi / 4 : 1;  // of its bounding box
  if (is("mass_from_area")) return fills * sides.width * sides.height;
  if (is("mass_from_density")) return body.mass * fills * sides.width * sides.height;
  if (is("mass_from_radius") && circle != nullptr) return circle->radius;
  if (is("mass_from_square") && circle != nullptr) return circle->radius * circle->radius;
  return is("mass_of_one") ? 1 : body.mass;
}

StudentWorld::StudentWorld(const Scene& scene, double dt, std::string mistake, reference::Scheme scheme,
                           const Manner& manner)
    : scene_(scene), dt_(dt), mistake_(std::move(mistake)), scheme_(scheme), manner_(manner) {
  for (const auto& [name, scaled] : kScaled)
    if (mistake_ == name) mistake_ = scaled;
  for (const char axis : {'x', 'y'}) {
    const std::string only = std::string(" in ") + axis + " only";
    if (!mistake_.ends_with(only)) continue;
    mistake_.resize(mistake_.size() - only.size());
    mistaken_in_x_ = axis == 'x';
    right_ = std::make_unique<StudentWorld>(scene_, dt_, "", scheme_, manner_);
  }
  read_mistake(mistake_);
  for (const Joint& joint : scene_.joints) ends_.push_back(indices(scene_, joint));
  // Iterations repair errors of a single solve, so engines without iterations make these mistakes, unless
  // requested otherwise.
  for (const char* name :
       {"one_body_only", "inverse_mass_forgotten", "masses_in_place_of_inverses",
        "masses_in_place_of_inverses_of_moving", "masses_swapped", "masses_swapped_of_moving",
        "masses_ignored", "effective_mass_forgotten", "normal_not_unit", "whole_velocity",
        "r_cross_n_flipped", "no_rotation", "effective_mass_without_rotation", "both_corners_take_all",
        "impulse_backwards", "each_turned", "sinks", "turned_every_step"})
    manner_.once = manner_.once || (mistake_ == name && manner_.sweeps == Manner{}.sweeps);
  if (is("contacts_once")) manner_.once = true;
  for (const Body& body : scene_.bodies) {
    Rigid rigid{.position = body.position, .velocity = body.velocity, .force = {}, .angle = body.angle};
    rigid.velocity = rigid.before = mixed("first velocity", body.velocity);
    rigid.position = mixed("first position", body.position);
    rigid.spin = body.angular_velocity;
    rigid.body = &body;
    rigid.turns = times("angle of a point");
    if (is("first_angle_ignored")) rigid.angle = 0;
    if (const auto* box = std::get_if<Box>(&body.shapes.at(0).geometry); box && is("corner_for_centre"))
      rigid.position += Vec2d{box->width / 2, box->height / 2};
    if (const auto* box = std::get_if<Box>(&body.shapes.at(0).geometry); box && is("upper_corner_for_centre"))
      rigid.position += Vec2d{box->width / 2, -box->height / 2};
    if (body.type == BodyType::Dynamic) {
      rigid.inverse_mass = is("inverse_mass_floored") ? std::floor(1 / body.mass) : 1 / mass(body);
      const bool may_turn = !body.fixed_rotation || is("fixed_rotation_ignored");
      if (manner_.turns && may_turn) rigid.inverse_inertia = 1 / inertia(body);
    } else if (is("static_has_inertia")) {
      rigid.inverse_inertia = 1 / inertia(body);
    } else if (is("static_has_mass")) {
      rigid.inverse_mass = 1 / body.mass;
    }
    bodies_.push_back(rigid);
  }
  bodies_.push_back({});
  if (is("length_of_start") || is("length_of_centres_at_start"))
    for (Joint& joint : scene_.joints)
      if (auto* stick = std::get_if<DistanceJoint>(&joint)) {
        const Ends e = ends(joint, kJointRow);
        const Vec2d centres = bodies_[e.b].position - bodies_[e.a].position;
        const Vec2d way = is("length_of_start") ? e.gap : centres;
        stick->length = std::hypot(way.x, way.y);
      }
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

void StudentWorld::read_mistake(const std::string& mistake) {
  mistake_hash_ = Name::of(mistake);
  if (const std::size_t star = mistake.find('*'); star != std::string::npos) {
    scaled_hash_ = Name::of(std::string_view(mistake).substr(0, star));
    factor_ = std::stod(mistake.substr(star + 1));
  }
  if (const auto edit = Edit::read(mistake)) edit_ = *edit;
  if (int when = 0; std::sscanf(mistake.c_str(), "stale:%u:%d:%u", &stale_.parts, &when, &stale_.rows) == 3)
    stale_.when = static_cast<Stale::When>(when);
  const auto split = [&](char sign, std::uint64_t& what, std::uint64_t& how) {
    const std::size_t place = mistake.find(sign);
    if (place == std::string::npos) return;
    what = Name::of(std::string_view(mistake).substr(0, place));
    how = Name::of(std::string_view(mistake).substr(place + 1));
  };
  split('~', turned_hash_, turned_how_);
  split('>', acting_hash_, acting_how_);
  split('#', others_hash_, others_whose_);
  const std::size_t at = mistake.find('@'), comma = mistake.find(',');
  if (at == std::string::npos || comma == std::string::npos) return;
  mixed_hash_ = Name::of(std::string_view(mistake).substr(0, at));
  const std::string x = mistake.substr(at + 1, comma - at - 1), y = mistake.substr(comma + 1);
  sign_of_ = {sign_of(x), sign_of(y)};
  axes_ = {axis_of(without_bars(x)), axis_of(without_bars(y))};
}

Vec2d StudentWorld::mixed(Name quantity, Vec2d v) const {
  if (quantity.hash != mixed_hash_) return v;
  const auto part = [&](std::size_t i) {
    const double own = dot(axes_[i], v);
    return sign_of_[i] == 0 ? own : sign_of_[i] * std::abs(own);
  };
  return {part(0), part(1)};
}

double StudentWorld::radius(const Rigid& body) const {
  return times("radius") * std::get<Circle>(body.body->shapes[0].geometry).radius;
}

Box StudentWorld::box(const Rigid& body) const {
  Box out = std::get<Box>(body.body->shapes[0].geometry);
  out.width *= times("size of a box") * times("width of a box");
  out.height *= times("size of a box") * times("height of a box");
  if (is("width_and_height_swapped")) std::swap(out.width, out.height);
  if (is("width_for_both")) out.height = out.width;
  if (is("height_for_both")) out.width = out.height;
  if (is("half_sizes_floored")) out = {2 * std::floor(out.width / 2), 2 * std::floor(out.height / 2)};
  return out;
}

void StudentWorld::step() {
  if (is("answers_before_the_step")) before_step_ = truly();
  if (is("first_step_twice") && steps_ == 0) advance();
  advance();
  ++steps_;
}

// Takes a step. A mistake in one component only leaves the other component as a right step gives it.
void StudentWorld::advance() {
  if (right_ == nullptr) return take_step();
  right_->bodies_ = bodies_;
  right_->steps_ = steps_;
  right_->take_step();
  take_step();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Rigid& mistaken = bodies_[i];
    const Rigid& right = right_->bodies_[i];
    for (Vec2d Rigid::*const part : {&Rigid::position, &Rigid::velocity, &Rigid::force, &Rigid::before})
      mistaken.*part = mistaken_in_x_ ? Vec2d{(mistaken.*part).x, (right.*part).y}
                                      : Vec2d{(right.*part).x, (mistaken.*part).y};
  }
}

void StudentWorld::take_step() {
  keep_arms();
  keep_held();
  gather_forces();
  const bool moves_first = is("explicit_euler") || scheme_ == reference::Scheme::ExplicitEuler;
  if (moves_first) move();
  const bool after_move = manner_.after_move || is("moves_before_contacts");
  const bool forces_last = is("forces_after_solving") || is("contacts_before_forces");
  if (!forces_last) accelerate();
  if (forces_last && !manner_.by_positions) {
    if (after_move && !moves_first) move();
    answer_touches(is("forces_after_solving"));
    accelerate();
    if (is("contacts_before_forces")) answer_joints();
    if (!after_move && !moves_first) move();
  } else if (manner_.by_positions && !scene_.joints.empty()) {
    move_and_project(!moves_first);
    answer_touches(false);
  } else {
    if (after_move && !moves_first) move();
    answer_touches(true);
    if (!after_move && !moves_first) move();
  }
  if (!manner_.joints_first) push_out();
  close_joints();
  if (manner_.joints_first) push_out();
}

// Closes the joints' errors by positions, unless the engine or the mistake does without.
void StudentWorld::close_joints() {
  if (is("no_position_correction") || manner_.by_positions || manner_.fed > 0) return;
  if (scales("share of a joint's error without dt")) return;
  correct_all(manner_.corrections > 0 ? manner_.corrections : std::max(1, sweeps() / 4));
}

int StudentWorld::sweeps() const { return is("too_few_iterations") ? 1 : manner_.sweeps; }

// Writes the values that an iteration changes. If it changes none, further iterations would have no effect.
void StudentWorld::write_sweep_state(const std::vector<Touch>& found, std::vector<double>& out) const {
  out.clear();
  for (const Rigid& b : bodies_) out.insert(out.end(), {b.velocity.x, b.velocity.y, b.spin});
  for (const Touch& t : found) out.insert(out.end(), {t.bounce, t.sum, t.sum_across, t.last});
}

// Finds contacts, and iterates over them and, if joints are held by velocities, over joints.
void StudentWorld::answer_touches(bool with_joints) {
  std::vector<Touch> found = touches();
  if (is("first_contact_only") && found.size() > 1) found.resize(1);
  if (is("last_contact_only") && found.size() > 1) found.erase(found.begin(), found.end() - 1);
  pair_sums_.clear();
  for (Rigid& body : bodies_) body.sum = 0;
  for (Touch& touch : found) {
    prepare(touch);
    bodies_[touch.a].touched = bodies_[touch.b].touched = true;
  }
  std::erase_if(found, [&](const Touch& touch) { return opens(touch); });
  start_with_last_sums(found);
  const bool any_joints = with_joints && !scene_.joints.empty();
  if (found.empty()) last_found_.clear();
  if (found.empty() && !any_joints) return;
  std::vector<double> before, after;
  write_sweep_state(found, before);
  for (int sweep = 0; sweep < sweeps(); ++sweep) {
    for (const Joint& joint : scene_.joints)
      if (with_joints && holds(joint)) solve(joint);
    if (sweep == 0 || !manner_.once) answer_all(found);
    write_sweep_state(found, after);
    if (sweep > 0 && before == after) break;
    before.swap(after);
  }
  touched_ = touched_ || !found.empty();
  last_found_ = std::move(found);
}

// Returns true for a contact that the mistake leaves out of all iterations, because its bodies do not close
// before the first.
bool StudentWorld::opens(const Touch& touch) const {
  const double closing = dot(relative_velocity(touch), touch.normal);
  return (is("opening_contacts_left_out") && closing >= 0) ||
         (is("parting_contacts_left_out") && closing > 0);
}

// Iterates over joints alone.
void StudentWorld::answer_joints() {
  for (int sweep = 0; sweep < sweeps(); ++sweep)
    for (const Joint& joint : scene_.joints)
      if (holds(joint)) solve(joint);
}

// Moves bodies, closes the joints by positions, and uses displacements over the step as velocities.
void StudentWorld::move_and_project(bool moves) {
  const std::vector<Rigid> before = bodies_;
  if (moves) move();
  correct_all(std::max(1, sweeps() / 2));
  if (is("velocities_not_recomputed")) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Rigid& b = bodies_[i];
    if (b.body == nullptr || b.body->type != BodyType::Dynamic) continue;
    b.velocity = 1 / dt_ * (b.position - before[i].position);
    if (!is("spins_not_recomputed")) b.spin = (b.angle - before[i].angle) / dt_;
  }
}

void StudentWorld::correct_all(int sweeps) {
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const Joint& joint : scene_.joints)
      if (holds(joint)) correct(joint);
}

// Returns false for a joint that the mistake leaves out.
bool StudentWorld::holds(const Joint& joint) const {
  if (is("joint_ignored")) return false;
  if (is("last_joint_left_out")) return &joint != &scene_.joints.back();
  if (is("first_joint_left_out")) return &joint != &scene_.joints.front();
  if (is("first_joint_only")) return &joint == &scene_.joints.front();
  return !is("last_joint_only") || &joint == &scene_.joints.back();
}

}  // namespace plumb::course
