#include "harness/hunt/run_mode.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "engine/world/queries.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "engine/world/svg_draw.h"

namespace plumb::harness::hunt {
namespace {

/// Mixes words into a hash by FNV-1a, and folds the upper half into the lower one, because products only
/// carry bits upwards.
class Mixer {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001B3u;
    value_ ^= value_ >> 32;
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(Vec2d v) { add(v.x), add(v.y); }
  template <class Tag>
  void add(Handle<Tag> handle) {
    add(std::uint64_t{handle.index} << 32 | handle.generation);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

template <class Real>
void add_body(Mixer& mixer, const BasicWorld<Real>& world, BodyId body) {
  const BodyState state = world.state(body);
  mixer.add(body), mixer.add(state.position), mixer.add(state.angle), mixer.add(state.velocity);
  mixer.add(state.angular_velocity);
  mixer.add(std::uint64_t{world.awake(body)} << 1 | std::uint64_t{world.enabled(body)});
  for (const ContactReading& contact : world.contacts(body)) {
    mixer.add(contact.shape_a), mixer.add(contact.shape_b), mixer.add(contact.normal);
    for (int i = 0; i < contact.count; ++i)
      mixer.add(contact.points[i]), mixer.add(contact.separations[i]), mixer.add(contact.impulses[i]);
  }
  for (const JointId joint : world.joints(body)) {
    const JointReading reading = world.read(joint);
    for (const double value : {reading.force, reading.torque, reading.linear_error, reading.angular_error,
                               reading.angle, reading.translation, reading.length})
      mixer.add(value);
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kBad[] = {kNan, std::numeric_limits<double>::infinity(), -1.1e12, 1.1e12};

/// A call that must be refused.
struct Call {
  std::string name;
  std::function<void()> make;
  Error::Kind kind = Error::Kind::Value;
};

template <class Real>
void add_calls_with(double bad, BasicWorld<Real>& world, std::vector<Call>& calls) {
  const auto call = [&](const char* name, std::function<void()> make) {
    calls.push_back({fmt::format("{}({})", name, bad), std::move(make)});
  };
  call("set_gravity", [&world, bad] { world.set_gravity({bad, 0}); });
  call("create_body: position", [&world, bad] {
    world.create_body({.position = {0, bad}}, ShapeDefinition{});
  });
  call("create_body: velocity", [&world, bad] {
    world.create_body({.velocity = {bad, 0}}, ShapeDefinition{});
  });
  const std::vector<BodyId> bodies = world.bodies();
  if (bodies.empty()) return;
  const BodyId body = bodies[bodies.size() / 2];
  call("set_position: x", [&world, body, bad] { world.set_position(body, {bad, 0}, 0); });
  call("set_position: y", [&world, body, bad] { world.set_position(body, {0, bad}, 0); });
  call("set_position: angle", [&world, body, bad] { world.set_position(body, {0, 0}, bad); });
  call("set_velocity", [&world, body, bad] { world.set_velocity(body, {0, bad}); });
  call("set_angular_velocity", [&world, body, bad] { world.set_angular_velocity(body, bad); });
  call("apply_force", [&world, body, bad] { world.apply_force(body, {bad, 0}); });
  call("apply_force: point", [&world, body, bad] { world.apply_force(body, {1, 0}, {bad, 0}); });
  call("apply_torque", [&world, body, bad] { world.apply_torque(body, bad); });
  call("apply_impulse", [&world, body, bad] { world.apply_impulse(body, {0, bad}); });
  call("apply_impulse: point", [&world, body, bad] { world.apply_impulse(body, {1, 0}, {0, bad}); });
  call("apply_angular_impulse", [&world, body, bad] { world.apply_angular_impulse(body, bad); });
  call("set_gravity_scale", [&world, body, bad] { world.set_gravity_scale(body, bad); });
  call("set_damping", [&world, body, bad] { world.set_damping(body, bad, 0); });
  call("set_mass: centre", [&world, body, bad] { world.set_mass(body, {.centre = {bad, 0}}); });
  call("move_towards", [&world, body, bad] { world.move_towards(body, {bad, 0}, 0, 0.01); });
  call("create_shape: radius", [&world, body, bad] { world.create_shape(body, {.geometry = Circle{bad}}); });
  call("create_shape: density", [&world, body, bad] { world.create_shape(body, {.density = bad}); });
  if (std::isfinite(bad)) return;
  call("create_joint: anchor", [&world, body, other = bodies.front(), bad] {
    world.create_joint(other, body, {.kind = RevoluteDefinition{.anchor_a = {bad, 0}}});
  });
}

template <class Real>
std::vector<Call> calls_to_refuse(BasicWorld<Real>& world) {
  std::vector<Call> out;
  for (const double bad : kBad) add_calls_with(bad, world, out);
  for (const double bad : {kNan, -1.0, 0.0})
    out.push_back({fmt::format("step({})", bad), [&world, bad] { world.step(bad, 4); }});
  out.push_back({"step: 0 substeps", [&world] { world.step(0.01, 0); }});
  out.push_back({"set_iterations(0)", [&world] { world.set_iterations(0); }});
  out.push_back({"set_threads(0)", [&world] { world.set_threads(0); }});
  out.push_back({"set_threads(65)", [&world] { world.set_threads(65); }});
  const auto by_name = [&](const char* name, std::function<void()> make) {
    out.push_back({name, std::move(make), Error::Kind::Name});
  };
  by_name("destroy(no body)", [&world] { world.destroy(BodyId{}); });
  by_name("set_velocity(no body)", [&world] { world.set_velocity(BodyId{}, {1, 0}); });
  by_name("read(no joint)", [&world] { world.read(JointId{}); });
  by_name("set_filter(no shape)", [&world] { world.set_filter(ShapeId{}, Filter{}); });
  const std::vector<BodyId> bodies = world.bodies();
  if (bodies.empty()) return out;
  const BodyId body = bodies.front();
  out.push_back({"create_body: negative damping", [&world] { world.create_body({.linear_damping = -1}); }});
  out.push_back({"set_damping(-1)", [&world, body] { world.set_damping(body, 0, -1); }});
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 0.0}) {
    out.push_back(
        {fmt::format("set_mass({})", bad), [&world, body, bad] { world.set_mass(body, {.mass = bad}); }});
    out.push_back({fmt::format("set_mass: inertia({})", bad),
                   [&world, body, bad] { world.set_mass(body, {.inertia = bad}); }});
  }
  out.push_back({"set_mass(-1)", [&world, body] { world.set_mass(body, {.mass = -1}); }});
  out.push_back({"move_towards in no time", [&world, body] { world.move_towards(body, {0, 0}, 0, 0); }});
  out.push_back({"create_shape: negative radius",
                 [&world, body] { world.create_shape(body, {.geometry = Circle{-1}}); }});
  if (const std::vector<ShapeId> shapes = world.shapes(body); !shapes.empty()) {
    const ShapeId shape = shapes.front();
    out.push_back(
        {"set_material: friction < 0", [&world, shape] { world.set_material(shape, {.friction = -1}); }});
    out.push_back({"set_material: restitution > 1",
                   [&world, shape] { world.set_material(shape, {.restitution = 1.1}); }});
    out.push_back({"set_density(-1)", [&world, shape] { world.set_density(shape, -1); }});
  }
  return out;
}

constexpr double kLargest = 1e12;

/// Returns a body in the simulation that is faster than the limits; empty if there is none. Positions are
/// left to the caller: the world rejects some beyond 1e12, but does not check where bodies move to.
template <class Real>
std::string beyond(const BasicWorld<Real>& world) {
  for (const BodyId body : world.bodies()) {
    const BodyState s = world.state(body);
    for (const double value : {s.velocity.x, s.velocity.y, s.angular_velocity, 0 * s.position.x,
                               0 * s.position.y, 0 * s.angle})  // not a number unless finite
      if (!(std::abs(value) <= kLargest) && !world.quarantined(body))
        return fmt::format("body '{}' continues with {:.6g}", world.name(body), value);
  }
  return {};
}

/// Returns errors in the reports of quarantined bodies, and in their release.
template <class Real>
std::string release_all(BasicWorld<Real>& world) {
  for (const QuarantineEvent& event : world.events().quarantined)
    if (!world.quarantined(event.body)) return "a body is reported as quarantined but is not";
  for (const QuarantineEvent& event : world.quarantined()) {
    if (event.name != world.name(event.body))
      return "a quarantined body is reported under the name of another";
    world.set_position(event.body, {0, 0}, 0);
    world.set_velocity(event.body, {0, 0}), world.set_angular_velocity(event.body, 0);
    world.release(event.body);
    if (world.quarantined(event.body)) return "a body that is released stays quarantined";
  }
  return {};
}

}  // namespace

template <class Real>
Digest digest_of(const BasicWorld<Real>& world) {
  Mixer mixer;
  for (const BodyId body : world.bodies()) add_body(mixer, world, body);
  Mixer happened;
  const Events& events = world.events();
  for (const auto* list : {&events.begin, &events.end})
    for (const TouchEvent& event : *list) happened.add(event.shape_a), happened.add(event.shape_b);
  for (const auto* list : {&events.sensor_begin, &events.sensor_end})
    for (const SensorEvent& event : *list) happened.add(event.sensor), happened.add(event.visitor);
  for (const JointEvent& event : events.broken) happened.add(event.joint);
  return {full_hash(world), mixer.value(), happened.value()};
}

WorldDefinition contrary(const WorldDefinition& of) {
  WorldDefinition out;
  out.gravity = {of.gravity.y + 1, 2 - of.gravity.x};
  out.combine_friction = of.combine_friction == Combine::Maximum ? Combine::Minimum : Combine::Maximum;
  out.combine_restitution = of.combine_restitution == Combine::Minimum ? Combine::Maximum : Combine::Minimum;
  out.sleeping = !of.sleeping, out.continuous = !of.continuous;
  out.solver = of.solver == Solver::Xpbd ? Solver::Jakobsen : Solver::Xpbd;
  out.integrator = of.integrator == Integrator::SemiImplicitEuler ? Integrator::VelocityVerlet
                                                                  : Integrator::SemiImplicitEuler;
  out.iterations = of.iterations + 1;
  out.direct_islands = !of.direct_islands, out.quarantine = !of.quarantine;
  return out;
}

template <class Real>
void populate(BasicWorld<Real>& world) {
  world.create_body({.type = BodyType::Static}, {.geometry = Box{10, 1}});
  const BodyId a = world.create_body({.position = {0, 1}, .velocity = {3, 0}}, {.geometry = Box{1, 1}});
  const BodyId b = world.create_body({.position = {0.4, 1.9}}, {.geometry = Circle{0.4}});
  world.create_joint(a, b, {.kind = RevoluteDefinition{.anchor_a = {0.4, 0.9}}});
  for (int i = 0; i < 3; ++i) {
    world.apply_force(b, {1, 2});
    world.step(1.0 / 50, 3);
  }
  world.apply_force(a, {1, 1});
}

template <class Real>
void read_everything(const BasicWorld<Real>& world) {
  const std::vector<BodyId> bodies = world.bodies();
  std::vector<ContactReading> contacts(64);
  world.contacts(contacts);
  std::vector<BodyId> moved(bodies.size());
  world.moved(moved);
  for (const BodyId body : bodies) {
    const Aabb<double> box = world.box(body);
    for (const ShapeId shape : world.shapes(body)) {
      const ShapeDefinition definition = world.definition(shape);
      if (definition.sensor) world.overlapping(shape);
      contains(world, shape, world.centre(body));
    }
    for (const JointId joint : world.joints(body)) world.definition(joint);
    const Vec2d size = box.upper - box.lower, from = box.lower - 0.5 * size;
    ray_cast_closest(world, from, 2.0 * size);
    std::vector<ShapeId> found;
    overlap_box(world, box, {}, found);
    nearest(world, from, 2 * (size.x + size.y) + 1);
  }
  SvgDraw picture;
  draw(world, picture, {.contacts = true, .normals = true, .impulses = true, .boxes = true});
  save(world);
  world.hash();
  world.quarantined();
}

template <class Real>
void label(BasicWorld<Real>& world) {
  std::uint64_t data = 7;
  for (const BodyId body : world.bodies()) {
    world.set_name(body, fmt::format("another name {}", data));
    world.set_user_data(body, data++);
    for (const ShapeId shape : world.shapes(body)) {
      world.set_user_data(shape, data++);
      world.set_hit_events(shape, true);
    }
    for (const JointId joint : world.joints(body)) world.set_user_data(joint, data++);
  }
}

template <class Real>
std::string not_refused(BasicWorld<Real>& world) {
  const std::uint64_t before = full_hash(world);
  for (const Call& call : calls_to_refuse(world)) {
    bool refused = false;
    try {
      call.make();
    } catch (const Error& error) {
      refused = error.kind() == call.kind;
    }
    if (!refused) return fmt::format("{} is not rejected", call.name);
    if (full_hash(world) != before) return fmt::format("{} is rejected but changes the world", call.name);
  }
  return {};
}

template <class Real>
std::string overrun(BasicWorld<Real>& world, double dt, int substeps) {
  const std::vector<BodyId> bodies = world.bodies();
  const auto dynamic = std::find_if(bodies.rbegin(), bodies.rend(),
                                    [&](BodyId body) { return world.type(body) == BodyType::Dynamic; });
  if (dynamic == bodies.rend()) return {};
  const double mass = world.mass(*dynamic);
  world.set_velocity(*dynamic, {0.99999 * kLargest, 0});
  world.apply_force(*dynamic, {std::min(0.9 * kLargest, 4e7 * mass / dt), 0});
  world.step(dt, substeps);
  if (std::string wrong = beyond(world); !wrong.empty()) return wrong;
  if (std::string wrong = release_all(world); !wrong.empty()) return wrong;
  // A body that moves beyond the largest coordinates of a world.
  const BodyId runaway = world.create_body(
      {.position = {0.9999 * kLargest, 0}, .velocity = {0.1 * kLargest, 0}}, {.geometry = Circle{1}});
  for (int i = 0; i < 3; ++i) world.step(dt, substeps);
  const double place = world.position(runaway).x;
  if (!(std::abs(place) <= kLargest)) return fmt::format("a body continues at {:.6g} m", place);
  return {};
}

#define PLUMB_INSTANTIATE(Real)                           \
  template Digest digest_of(const BasicWorld<Real>&);     \
  template void populate(BasicWorld<Real>&);              \
  template void read_everything(const BasicWorld<Real>&); \
  template void label(BasicWorld<Real>&);                 \
  template std::string not_refused(BasicWorld<Real>&);    \
  template std::string overrun(BasicWorld<Real>&, double, int);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb::harness::hunt
