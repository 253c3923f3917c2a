#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <tuple>
#include <variant>

#include "engine/scene/joint_fields.h"
#include "engine/scene/names.h"
#include "engine/scene/scene.h"

/// Names and allowed values of each field of a scene (those of joints are in joint_fields.h). This is the
/// only list: reading, writing, validation and finding a number by its name use it. `visit(name, member,
/// rule)` is called for each field in the order of the scene format; "type" is not among them.
namespace plumb {

/// Rule of the name of the thing itself.
struct NameRule {
  bool required = true;  ///< the name must also be unique; false: it may be empty
};

/// Rule of the name of a body that a joint or a law acts on.
struct BodyRule {
  bool or_world = true;
  bool required = true;
};

/// Rule of the name of a joint with a motor.
struct MotorRule {
  static constexpr bool required = true;
};

/// Rule of a formula, or of two.
struct FormulaRule {
  std::span<const std::string_view> variables;
  bool required = false;
  bool or_none = false;  ///< empty for none
};

/// Rule of a member of an enumeration.
struct ChoiceRule {
  std::span<const std::string_view> names;
  bool first_is_none = false;  ///< JSON leaves out the first choice
  static constexpr bool required = false;
};

/// Rule of a whole number.
struct WholeRule {
  double lowest = 0, highest = 0;
  static constexpr bool required = false;
};

/// Rule of a list of parts.
struct ListRule {
  bool empty_is_none = false;  ///< JSON leaves out an empty list
  static constexpr bool required = false;
};

// ---- Geometries

template <Is<Circle> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("radius", g.radius, FieldRule{Limits::Positive, "m", true});
}

template <Is<Box> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("width", g.width, FieldRule{Limits::Positive, "m", true});
  visit("height", g.height, FieldRule{Limits::Positive, "m", true});
}

template <Is<Capsule> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("start", g.start, FieldRule{Limits::Any, "m", true});
  visit("end", g.end, FieldRule{Limits::Any, "m", true});
  visit("radius", g.radius, FieldRule{Limits::Positive, "m", true});
}

template <Is<Polygon> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("points", g.points, FieldRule{Limits::Any, "m", true});
  visit("radius", g.radius, FieldRule{Limits::NonNegative, "m"});
}

template <Is<Segment> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("start", g.start, FieldRule{Limits::Any, "m", true});
  visit("end", g.end, FieldRule{Limits::Any, "m", true});
}

template <Is<Chain> G, class Visit>
void own_fields(G& g, Visit&& visit) {
  visit("points", g.points, FieldRule{Limits::Any, "m", true});
  visit("closed", g.closed, FieldRule{});
}

// ---- Shapes and bodies

template <Is<Filter> F, class Visit>
void inner_fields(F& f, const FieldRule&, Visit&& visit) {
  using Group = std::numeric_limits<decltype(f.group)>;
  visit("category", f.category, FieldRule{});
  visit("mask", f.mask, FieldRule{});
  visit("group", f.group, WholeRule{Group::min(), Group::max()});
}

template <Is<Shape> S, class Visit>
void own_fields(S& s, Visit&& visit) {
  std::visit([&](auto& geometry) { own_fields(geometry, visit); }, s.geometry);
  visit("position", s.position, FieldRule{Limits::Any, "m"});
  visit("angle", s.angle, FieldRule{Limits::Any, "rad"});
  visit("friction", s.friction, FieldRule{Limits::NonNegative, ""});
  visit("restitution", s.restitution, FieldRule{Limits::ZeroToOne, ""});
  visit("rolling_resistance", s.rolling_resistance, FieldRule{Limits::NonNegative, ""});
  visit("surface_speed", s.surface_speed, FieldRule{Limits::Any, "m/s"});
  visit("density", s.density, FieldRule{Limits::NonNegative, "kg/m^2"});
  visit("filter", s.filter, FieldRule{});
}

template <Is<PrescribedMotion> M, class Visit>
void inner_fields(M& m, const FieldRule&, Visit&& visit) {
  constexpr FormulaRule kPath{.variables = kTimeVariable, .or_none = true};
  visit("x", m.x, kPath);
  visit("y", m.y, kPath);
  visit("angle", m.angle, kPath);
}

template <Is<Body> B, class Visit>
void own_fields(B& b, Visit&& visit) {
  const bool dynamic = b.type == BodyType::Dynamic;
  visit("type", b.type, ChoiceRule{kBodyTypeNames});
  visit("position", b.position, FieldRule{Limits::Any, "m"});
  visit("angle", b.angle, FieldRule{Limits::Any, "rad"});
  visit("velocity", b.velocity, FieldRule{Limits::Any, "m/s"});
  visit("angular_velocity", b.angular_velocity, FieldRule{Limits::Any, "rad/s"});
  visit("mass", b.mass, FieldRule{dynamic ? Limits::Positive : Limits::NonNegative, "kg"});
  visit("inertia", b.inertia, FieldRule{Limits::Positive, "kg m^2"});
  visit("fixed_rotation", b.fixed_rotation, FieldRule{});
  visit("lock_x", b.lock_x, FieldRule{});
  visit("lock_y", b.lock_y, FieldRule{});
  visit("gravity_scale", b.gravity_scale, FieldRule{Limits::Any, ""});
  visit("linear_damping", b.linear_damping, FieldRule{Limits::NonNegative, "1/s"});
  visit("angular_damping", b.angular_damping, FieldRule{Limits::NonNegative, "1/s"});
  visit("motion", b.motion, FieldRule{});
  visit("shapes", b.shapes, ListRule{});
}

// ---- Force laws and drives

/// Visits the fields of a force that acts for a limited time.
template <class L, class Visit>
void time_fields(L& l, Visit&& visit) {
  constexpr double kForEver = std::numeric_limits<double>::infinity();
  visit("start", l.start, FieldRule{Limits::NonNegative, "s"});
  visit("duration", l.duration, FieldRule{Limits::NonNegative, "s", false, kForEver});
}

template <Is<LinearDrag> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("coefficient", l.coefficient, FieldRule{Limits::NonNegative, "N s/m", true});
  visit("angular_coefficient", l.angular_coefficient, FieldRule{Limits::NonNegative, "N m s"});
}

template <Is<QuadraticDrag> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("coefficient", l.coefficient, FieldRule{Limits::NonNegative, "N s^2/m^2", true});
}

template <Is<PointForce> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("force", l.force, FieldRule{Limits::Any, "N", true});
  visit("point", l.point, FieldRule{Limits::Any, "m"});
  visit("frame", l.frame, ChoiceRule{kFrameNames});
  time_fields(l, visit);
}

template <Is<Torque> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("torque", l.torque, FieldRule{Limits::Any, "N m", true});
  time_fields(l, visit);
}

template <Is<SpringForce> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("rest_length", l.rest_length, FieldRule{Limits::NonNegative, "m"});
  visit("stiffness", l.stiffness, FieldRule{Limits::NonNegative, "N/m", true});
  visit("damping", l.damping, FieldRule{Limits::NonNegative, "N s/m"});
}

template <Is<AttractionForce> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("centre_body", l.centre_body, BodyRule{.required = false});
  visit("centre", l.centre, FieldRule{Limits::Any, "m"});
  visit("strength", l.strength, FieldRule{Limits::Any, "m^(1 + exponent)/s^2", true});
  visit("exponent", l.exponent, WholeRule{-kLargestExponent, kLargestExponent});
}

template <Is<SinusoidalForce> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("amplitude", l.amplitude, FieldRule{Limits::Any, "N", true});
  visit("point", l.point, FieldRule{Limits::Any, "m"});
  visit("angular_frequency", l.angular_frequency, FieldRule{Limits::NonNegative, "rad/s", true});
  visit("phase", l.phase, FieldRule{Limits::Any, "rad"});
}

template <Is<FormulaForce> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("force", std::tie(l.x, l.y), FormulaRule{kForceVariables});
  visit("torque", l.torque, FormulaRule{kForceVariables});
  visit("point", l.point, FieldRule{Limits::Any, "m"});
}

template <Is<FormulaSpring> L, class Visit>
void own_fields(L& l, Visit&& visit) {
  visit("tension", l.tension, FormulaRule{kSpringVariables, true});
}

template <Is<Drive> D, class Visit>
void own_fields(D& d, Visit&& visit) {
  visit("joint", d.joint, MotorRule{});
  visit("speed", d.speed, FormulaRule{kTimeVariable, true});
}

// ---- The scene

template <Is<ContactRules> C, class Visit>
void inner_fields(C& c, const FieldRule&, Visit&& visit) {
  // Options that were added later are left out where they have no effect, so that older scenes keep their
  // hashes.
  visit("friction", c.friction, ChoiceRule{kCombineNames});
  visit("restitution", c.restitution, ChoiceRule{kCombineNames});
  visit("restitution_threshold", c.restitution_threshold, FieldRule{Limits::NonNegative, "m/s"});
  visit("simultaneous", c.simultaneous, ChoiceRule{kSimultaneousNames, true});
  visit("impact", c.impact, ChoiceRule{kImpactNames, true});
  visit("yield_speed", c.yield_speed, FieldRule{Limits::NonNegative, "m/s", false, 0});
  visit("tangential_restitution", c.tangential_restitution, FieldRule{Limits::ZeroToOne, "", false, 0});
  visit("friction_after_stop", c.friction_after_stop, FieldRule{Limits::ZeroToOne, "", false, 1});
  visit("friction_while_sliding", c.friction_while_sliding, FieldRule{Limits::ZeroToOne, "", false, 1});
}

template <Is<Scene> S, class Visit>
void own_fields(S& s, Visit&& visit) {
  visit("gravity", s.gravity, FieldRule{Limits::Any, "m/s^2"});
  visit("contact_rules", s.contact_rules, FieldRule{});
  visit("bodies", s.bodies, ListRule{});
  visit("joints", s.joints, ListRule{});
  visit("forces", s.forces, ListRule{});
  visit("drives", s.drives, ListRule{true});
}

/// Visits all fields of the scene, of one of its parts, or of a part of any kind.
template <class Part, class Visit>
void all_fields(Part& p, Visit&& visit) {
  if constexpr (requires { p.index(); }) {
    std::visit([&](auto& kind) { all_fields(kind, visit); }, p);
  } else {
    if constexpr (requires { p.name; }) visit("name", p.name, NameRule{!Is<Part, Scene>});
    if constexpr (requires { p.body; }) visit("body", p.body, BodyRule{.or_world = false});
    if constexpr (requires { p.body_a; }) {
      visit("body_a", p.body_a, BodyRule{});
      visit("body_b", p.body_b, BodyRule{});
    }
    anchor_fields(p, visit);
    own_fields(p, visit);
    if constexpr (requires { p.collide; }) last_fields(p, visit);
  }
}

}  // namespace plumb
