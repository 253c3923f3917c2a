#include <optional>

#include "bindings/c/handle.h"
#include "engine/joints/definitions.h"

using namespace plumb::c;

namespace {

std::optional<plumb::Spring> optional(const plumb_spring& s) {
  if (!s.on) return std::nullopt;
  return plumb::Spring{s.hertz, s.damping_ratio};
}
std::optional<plumb::Range> optional(const plumb_range& r) {
  if (!r.on) return std::nullopt;
  return plumb::Range{r.lower, r.upper};
}
std::optional<plumb::Motor> optional(const plumb_motor& m) {
  if (!m.on) return std::nullopt;
  return plumb::Motor{m.speed, m.max_force};
}
plumb_spring out_of(const std::optional<plumb::Spring>& s) {
  return s ? plumb_spring{true, s->hertz, s->damping_ratio} : plumb_spring{};
}
plumb_range out_of(const std::optional<plumb::Range>& r) {
  return r ? plumb_range{true, r->lower, r->upper} : plumb_range{};
}
plumb_motor out_of(const std::optional<plumb::Motor>& m) {
  return m ? plumb_motor{true, m->speed, m->max_force} : plumb_motor{};
}

/// Returns the spring of a kind that is never without one: switched off it has no stiffness, which the
/// engine refuses by name.
plumb::Spring needed(const plumb_spring& s) {
  return s.on ? plumb::Spring{s.hertz, s.damping_ratio} : plumb::Spring{0, 0};
}

plumb::JointKind kind_of(const plumb_joint_definition& d) {
  const plumb::Vec2d a = in(d.anchor_a), b = in(d.anchor_b);
  switch (in<int>(d.kind, 11, "joint", "kind")) {
    case PLUMB_DISTANCE:
      return plumb::DistanceDefinition{
          a, b, d.length, optional(d.spring), optional(d.limits), optional(d.motor)};
    case PLUMB_REVOLUTE:
      return plumb::RevoluteDefinition{
          a, b, d.reference_angle, optional(d.limits), optional(d.motor), optional(d.spring), d.target_angle};
    case PLUMB_PRISMATIC:
      return plumb::PrismaticDefinition{a,
                                        b,
                                        in(d.axis),
                                        d.reference_angle,
                                        optional(d.limits),
                                        optional(d.motor),
                                        optional(d.spring),
                                        d.target_translation};
    case PLUMB_WELD:
      return plumb::WeldDefinition{a, b, d.reference_angle, optional(d.linear_spring),
                                   optional(d.angular_spring)};
    case PLUMB_WHEEL:
      return plumb::WheelDefinition{
          a, b, in(d.axis), optional(d.spring), optional(d.limits), optional(d.motor)};
    case PLUMB_MOTOR:
      return plumb::MotorDefinition{in(d.target_position), d.target_angle, d.max_force, d.max_torque,
                                    needed(d.spring)};
    case PLUMB_MOUSE:
      return plumb::MouseDefinition{b, in(d.target_position), needed(d.spring), d.max_force};
    case PLUMB_GEAR:
      return plumb::GearDefinition{d.ratio, d.phase};
    case PLUMB_PULLEY: {
      plumb::PulleyDefinition pulley{in(d.ground_a), in(d.ground_b), a, b, d.ratio, {}};
      if (!(d.length < 0)) pulley.length = d.length;
      return pulley;
    }
    case PLUMB_RATCHET:
      return plumb::RatchetDefinition{d.tooth, d.phase};
    default:
      return plumb::FrictionDefinition{a, b, d.max_force, d.max_torque};
  }
}

/// Fills the members of a kind.
struct Fill {
  plumb_joint_definition& d;

  void anchors(const auto& k) const { d.anchor_a = out(k.anchor_a), d.anchor_b = out(k.anchor_b); }
  void operator()(const plumb::DistanceDefinition& k) const {
    anchors(k);
    d.length = k.length;
    d.spring = out_of(k.spring), d.limits = out_of(k.range), d.motor = out_of(k.motor);
  }
  void operator()(const plumb::RevoluteDefinition& k) const {
    anchors(k);
    d.reference_angle = k.reference_angle, d.target_angle = k.target_angle;
    d.spring = out_of(k.spring), d.limits = out_of(k.limits), d.motor = out_of(k.motor);
  }
  void operator()(const plumb::PrismaticDefinition& k) const {
    anchors(k);
    d.axis = out(k.axis);
    d.reference_angle = k.reference_angle, d.target_translation = k.target_translation;
    d.spring = out_of(k.spring), d.limits = out_of(k.limits), d.motor = out_of(k.motor);
  }
  void operator()(const plumb::WeldDefinition& k) const {
    anchors(k);
    d.reference_angle = k.reference_angle;
    d.linear_spring = out_of(k.linear_spring), d.angular_spring = out_of(k.angular_spring);
  }
  void operator()(const plumb::WheelDefinition& k) const {
    anchors(k);
    d.axis = out(k.axis);
    d.spring = out_of(k.spring), d.limits = out_of(k.limits), d.motor = out_of(k.motor);
  }
  void operator()(const plumb::MotorDefinition& k) const {
    d.target_position = out(k.target_position), d.target_angle = k.target_angle;
    d.max_force = k.max_force, d.max_torque = k.max_torque;
    d.spring = {true, k.spring.hertz, k.spring.damping_ratio};
  }
  void operator()(const plumb::MouseDefinition& k) const {
    d.anchor_b = out(k.anchor_b), d.target_position = out(k.target);
    d.max_force = k.max_force;
    d.spring = {true, k.spring.hertz, k.spring.damping_ratio};
  }
  void operator()(const plumb::GearDefinition& k) const { d.ratio = k.ratio, d.phase = k.phase; }
  void operator()(const plumb::PulleyDefinition& k) const {
    anchors(k);
    d.ground_a = out(k.ground_a), d.ground_b = out(k.ground_b);
    d.ratio = k.ratio, d.length = k.length.value_or(-1);
  }
  void operator()(const plumb::RatchetDefinition& k) const { d.tooth = k.tooth, d.phase = k.phase; }
  void operator()(const plumb::FrictionDefinition& k) const {
    anchors(k);
    d.max_force = k.max_force, d.max_torque = k.max_torque;
  }
};

}  // namespace

plumb_joint plumb_joint_create(plumb_world* world, plumb_body a, plumb_body b,
                               const plumb_joint_definition* definition) {
  return checked_or(kNoJoint, [&] {
    const plumb_joint_definition& d = require(definition, "joint definition");
    const plumb::JointDefinition joint{kind_of(d),  d.collide,      d.break_force,  d.break_torque,
                                       d.user_data, d.report_force, d.report_torque};
    return change(world, [&](auto& w) { return out(w.create_joint(in(a), in(b), joint)); });
  });
}
plumb_status plumb_joint_destroy(plumb_world* world, plumb_joint joint) {
  return change_checked(world, [&](auto& w) { w.destroy(in(joint)); });
}
bool plumb_joint_valid(const plumb_world* world, plumb_joint joint) {
  return read_or(false, world, [&](const auto& w) { return w.valid(in(joint)); });
}
plumb_joint_definition plumb_joint_get_definition(const plumb_world* world, plumb_joint joint) {
  return read_or(plumb_joint_definition{}, world, [&](const auto& w) {
    const plumb::JointDefinition from = w.definition(in(joint));
    plumb_joint_definition d = plumb_default_joint(static_cast<plumb_joint_kind>(from.kind.index()));
    d.collide = from.collide;
    d.break_force = from.break_force, d.break_torque = from.break_torque;
    d.user_data = from.user_data;
    d.report_force = from.report_force, d.report_torque = from.report_torque;
    std::visit(Fill{d}, from.kind);
    return d;
  });
}
plumb_status plumb_joint_change(plumb_world* world, plumb_joint joint,
                                const plumb_joint_definition* definition) {
  return checked([&] {
    const plumb::JointKind kind = kind_of(require(definition, "joint definition"));
    change(world, [&](auto& w) { w.change(in(joint), kind); });
  });
}
plumb_joint_reading plumb_joint_read(const plumb_world* world, plumb_joint joint) {
  return read_or(plumb_joint_reading{}, world, [&](const auto& w) {
    const plumb::JointReading r = w.read(in(joint));
    return plumb_joint_reading{r.force, r.torque,      r.linear_error, r.angular_error,
                               r.angle, r.translation, r.length};
  });
}
plumb_joint_constants plumb_joint_stiffness(const plumb_world* world, plumb_joint joint) {
  return read_or(plumb_joint_constants{}, world, [&](const auto& w) {
    const plumb::JointStiffness s = w.stiffness(in(joint));
    return plumb_joint_constants{s.linear, s.angular, s.linear_damping, s.angular_damping};
  });
}
uint64_t plumb_joint_user_data(const plumb_world* world, plumb_joint joint) {
  return read_or<uint64_t>(0, world, [&](const auto& w) { return w.user_data(in(joint)); });
}
plumb_status plumb_joint_set_user_data(plumb_world* world, plumb_joint joint, uint64_t data) {
  return change_checked(world, [&](auto& w) { w.set_user_data(in(joint), data); });
}
plumb_status plumb_joint_set_load_events(plumb_world* world, plumb_joint joint, double force, double torque) {
  return change_checked(world, [&](auto& w) { w.set_load_events(in(joint), force, torque); });
}
plumb_status plumb_joint_bodies(const plumb_world* world, plumb_joint joint, plumb_body* a, plumb_body* b) {
  return read_checked(world, [&](const auto& w) {
    const auto [first, second] = w.bodies(in(joint));
    require(a, "a") = out(first), require(b, "b") = out(second);
  });
}
