#include "harness/hunt/calls.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/snapshot/body_hash.h"
#include "harness/hunt/shapes_of_world.h"

namespace plumb::harness::hunt {
namespace {

// Relative tolerance of numbers that a world stores in floats: ten roundings.
constexpr double kRounding = 2e-6;
// Overlap, as a fraction of a shape's size, from which a new shape must wake a sleeping body. Below it the
// two may count as touching, or not.
constexpr double kOverlap = 0.02;

bool near(double a, double b, double scale = 0) {
  return std::abs(a - b) <= kRounding * (std::abs(a) + std::abs(b) + scale) + 1e-30;
}
bool near(Vec2d a, Vec2d b, double scale = 0) {
  return length(a - b) <= kRounding * (length(a) + length(b) + scale) + 1e-30;
}

/// Makes one of the calls, each a member of its own, and checks what it answers for.
template <class Real, class Target>
class Caller {
 public:
  Caller(Random& random, const BasicWorld<Real>& world, Target& target)
      : random_(random), world_(world), target_(target) {}

  std::string make() {
    using Make = std::string (Caller::*)();
    static constexpr Make kOfBodies[] = {
        &Caller::set_velocity, &Caller::set_spin,  &Caller::set_position, &Caller::impulse,
        &Caller::turn,         &Caller::force,     &Caller::weightless,   &Caller::damping,
        &Caller::locks,        &Caller::mass,      &Caller::densities,    &Caller::type,
        &Caller::sleep,        &Caller::may_sleep, &Caller::enable,       &Caller::continuous,
        &Caller::towards,      &Caller::name,      &Caller::destroy,      &Caller::add_shape};
    static constexpr Make kOfShapes[] = {&Caller::material, &Caller::filter, &Caller::density,
                                         &Caller::sensor,   &Caller::flags,  &Caller::destroy_shape};
    static constexpr Make kOfJoints[] = {&Caller::change, &Caller::loads, &Caller::loads, &Caller::rejoin,
                                         &Caller::destroy_joint};
    static constexpr Make kOfWorld[] = {&Caller::gravity,  &Caller::settings, &Caller::create,
                                        &Caller::create,   &Caller::ghost,    &Caller::thresholds,
                                        &Caller::add_joint};
    bodies_ = world_.bodies();
    Make call = pick(kOfWorld);
    if (!bodies_.empty() && random_.chance(0.85)) {
      body_ = random_.pick(bodies_);
      // Sleepers are what a call may fail to wake.
      for (int tries = 0; tries < 4 && (world_.awake(body_) || world_.type(body_) != BodyType::Dynamic);
           ++tries)
        body_ = random_.pick(bodies_);
      call = pick(kOfBodies);
      const std::vector<ShapeId> shapes = world_.shapes(body_);
      const std::vector<JointId> joints = world_.joints(body_);
      if (!joints.empty() && random_.chance(0.3))
        joint_ = random_.pick(joints), call = pick(kOfJoints);
      else if (!shapes.empty() && random_.chance(0.3))
        shape_ = random_.pick(shapes), call = pick(kOfShapes);
    }
    try {
      return (this->*call)();
    } catch (const Error&) {
      return {};  // out of range, or of no such body
    }
  }

 private:
  template <std::size_t kCount, class T>
  T pick(const T (&of)[kCount]) {
    return of[random_.whole(0, static_cast<int>(kCount) - 1)];
  }
  double number(double most) { return random_.chance(0.25) ? 0 : random_.within(-most, most); }
  Vec2d vector(double most) { return {number(most), number(most)}; }
  double size() const {
    const Aabb<double> box = world_.box(body_);
    const double out = 0.5 * length(box.upper - box.lower);
    return out > 0 ? out : 1;
  }
  bool dynamic() const { return world_.type(body_) == BodyType::Dynamic; }
  // Returns true for a body that calls can wake.
  bool simulated() const { return dynamic() && world_.enabled(body_); }

  std::string not_woken(const char* call) const {
    if (simulated() && !world_.awake(body_))
      return fmt::format("{} leaves '{}' asleep", call, world_.name(body_));
    return {};
  }
  std::string answers(const char* call, bool right) const {
    return right ? std::string() : fmt::format("{} is not what is then answered", call);
  }

  /// Places and velocities of three material points of a body: a change of mass leaves them as they are.
  struct MaterialPoints {
    std::vector<Vec2d> local, place, velocity;
    double spin = 0, fastest = 0;
  };
  MaterialPoints motion() const {
    MaterialPoints out;
    const double s = size();
    for (const Vec2d local : {Vec2d{0, 0}, Vec2d{s, 0}, Vec2d{0, s}}) {
      out.local.push_back(local);
      out.place.push_back(world_.world_point(body_, local));
      out.velocity.push_back(world_.velocity_at(body_, out.place.back()));
      out.fastest = std::max(out.fastest, length(out.velocity.back()));
    }
    out.spin = world_.angular_velocity(body_);
    out.fastest = std::max(out.fastest, s * std::abs(out.spin));
    return out;
  }
  std::string moves_otherwise(const char* call, const MaterialPoints& before) const {
    if (!dynamic()) return {};
    const MaterialPoints now = motion();
    // A centre of mass away from the body shows the rounding of its place.
    const double far = length(world_.centre(body_) - world_.position(body_)) + size();
    for (std::size_t i = 0; i < before.place.size(); ++i) {
      const Vec2d place = world_.world_point(body_, before.local[i]);
      if (length(place - before.place[i]) > kRounding * (far + 0.01 * length(place)))
        return fmt::format("{} moves '{}' by {:.3g} m", call, world_.name(body_),
                           length(place - before.place[i]));
      const Vec2d velocity = world_.velocity_at(body_, before.place[i]);
      const double bound = kRounding * (before.fastest + far * std::abs(before.spin)) * 4 + 1e-36;
      if (length(velocity - before.velocity[i]) > bound)
        return fmt::format("{} changes the velocity of a point of '{}' by {:.3g} m/s", call,
                           world_.name(body_), length(velocity - before.velocity[i]));
    }
    return {};
  }
  /// Returns an objection if joints of the body have moved off their anchors, or what it holds.
  std::string mass_is_wrong(const char* call, const MaterialPoints& before) {
    if (std::string wrong = moves_otherwise(call, before); !wrong.empty()) return wrong;
    return not_woken(call);
  }

  /// Hashes of single bodies, as recordings have them after a step, of those awake; none while changes of
  /// mass wait for the next step or call.
  std::vector<BodyHash> single_hashes() const {
    std::vector<BodyHash> out;
    if (world_.data().unsettled.empty()) hash_awake_bodies(world_.data(), out);
    return out;
  }
  /// Returns an objection if the call left the hash of the (awake) body unchanged, or changed another's.
  std::string hash_is_wrong(const char* call, const std::vector<BodyHash>& before) const {
    for (const BodyHash& now : single_hashes())
      for (const BodyHash& then : before)
        if (now.body == then.body && (now.hash == then.hash) == (now.body == body_.index))
          return fmt::format("{} {} the hash of a body", call, now.hash == then.hash ? "leaves" : "changes");
    return {};
  }

  std::string set_velocity() {
    const Vec2d wanted = vector(3 * size());
    const std::vector<BodyHash> single = single_hashes();
    const Vec2d before = world_.velocity(body_);
    const std::uint64_t hash = world_.hash();
    target_.set_velocity(body_, wanted);
    const BodyLocks locks = world_.locks(body_);
    if (locks.x || locks.y || world_.type(body_) == BodyType::Static) return {};
    if (!near(world_.velocity(body_), wanted)) return answers("set_velocity", false);
    if (!near(before, wanted) && world_.hash() == hash) return "hash is the same for other velocities";
    if (!near(before, wanted))
      if (std::string wrong = hash_is_wrong("set_velocity", single); !wrong.empty()) return wrong;
    return near(before, wanted) ? std::string() : not_woken("set_velocity");
  }
  std::string set_spin() {
    const double wanted = number(5), before = world_.angular_velocity(body_);
    const std::vector<BodyHash> single = single_hashes();
    const std::uint64_t hash = world_.hash();
    target_.set_angular_velocity(body_, wanted);
    if (world_.locks(body_).rotation || world_.type(body_) == BodyType::Static) return {};
    if (!near(world_.angular_velocity(body_), wanted)) return answers("set_angular_velocity", false);
    if (!near(before, wanted) && world_.hash() == hash)
      return "hash is the same for other angular velocities";
    if (!near(before, wanted))
      if (std::string wrong = hash_is_wrong("set_angular_velocity", single); !wrong.empty()) return wrong;
    return near(before, wanted) ? std::string() : not_woken("set_angular_velocity");
  }
  std::string set_position() {
    const double angle = random_.chance(0.5) ? world_.angle(body_) : random_.within(-4, 4);
    const Vec2d to = world_.position(body_) + vector(0.5 * size());
    const Vec2d velocity = world_.velocity(body_);
    const double before = world_.angle(body_);
    std::vector<double> readings;
    for (const JointId joint : world_.joints(body_)) readings.push_back(world_.read(joint).angle);
    target_.set_position(body_, to, angle);
    if (!near(world_.position(body_), to, size()) || !near(world_.angle(body_), angle, 1))
      return answers("set_position", false);
    if (dynamic() &&
        !near(world_.velocity(body_), velocity, size() * std::abs(world_.angular_velocity(body_))))
      return fmt::format("set_position changes a velocity of {:.6g}, {:.6g} to {:.6g}, {:.6g} m/s",
                         velocity.x, velocity.y, world_.velocity(body_).x, world_.velocity(body_).y);
    if (std::string wrong = turned_by(angle - before, readings); !wrong.empty()) return wrong;
    if (std::string wrong = sleepers_inside(); !wrong.empty()) return wrong;
    return not_woken("set_position");
  }
  /// Returns an objection unless the angles of the body's hinges, which count turns, followed its turn.
  std::string turned_by(double turn, const std::vector<double>& before) const {
    const std::vector<JointId> joints = world_.joints(body_);
    for (std::size_t i = 0; i < joints.size() && i < before.size(); ++i) {
      const auto [a, b] = world_.bodies(joints[i]);
      if (!std::holds_alternative<RevoluteDefinition>(world_.kind(joints[i])) || a == b) continue;
      const double right = before[i] + (b == body_ ? turn : -turn), now = world_.read(joints[i]).angle;
      // Turns of half a circle and more may be counted either way, and so may the angle of a joint that has
      // not been stepped since it was made.
      const bool either = std::abs(turn) > 3 || (std::abs(before[i]) < 3.15 && std::abs(right) > 3.1);
      if (!either && std::abs(now - right) > 1e-3 * (1 + 1e-3 * std::abs(right)))
        return fmt::format("a hinge of '{}' reads {:.6g} rad after a turn that should leave {:.6g}",
                           world_.name(body_), now, right);
    }
    return {};
  }
  std::string impulse() {
    const MaterialPoints before = motion();
    const Vec2d velocity = world_.velocity(body_), centre = world_.centre(body_);
    const double mass = world_.mass(body_), inertia = world_.inertia(body_);
    const Vec2d change = vector(size()), arm = random_.chance(0.3) ? Vec2d{} : vector(size());
    target_.apply_impulse(body_, mass * change, centre + arm);
    const BodyLocks locks = world_.locks(body_);
    if (!simulated() || locks.x || locks.y || locks.rotation || !(inertia > 0)) return {};
    const double turn = cross(arm, mass * change) / inertia;
    const double scale = length(velocity) + length(change);
    if (!near(world_.velocity(body_), velocity + change, scale) ||
        !near(world_.angular_velocity(body_), before.spin + turn,
              std::abs(turn) + std::abs(before.spin) +
                  mass / inertia * length(change) * (length(arm) + 1e-1 * kRounding * length(centre))))
      return "an impulse changes a velocity by another than J/m, r x J/I";
    return change != Vec2d{} ? not_woken("apply_impulse") : std::string();
  }
  std::string turn() {
    const double inertia = world_.inertia(body_), before = world_.angular_velocity(body_), by = number(3);
    target_.apply_angular_impulse(body_, inertia * by);
    if (!simulated() || world_.locks(body_).rotation || !(inertia > 0)) return {};
    if (!near(world_.angular_velocity(body_), before + by, std::abs(before) + std::abs(by)))
      return "an angular impulse changes a velocity by another than L/I";
    return by != 0 ? not_woken("apply_angular_impulse") : std::string();
  }
  std::string force() {
    const Vec2d push = world_.mass(body_) * vector(20);
    const double twist = world_.inertia(body_) * number(20);
    switch (random_.whole(0, 2)) {
      case 0:
        target_.apply_force(body_, push);
        break;
      case 1:
        target_.apply_force(body_, push, world_.centre(body_) + vector(size()));
        break;
      default:
        target_.apply_torque(body_, twist);
        return twist != 0 ? not_woken("apply_torque") : std::string();
    }
    return push != Vec2d{} ? not_woken("apply_force") : std::string();
  }
  std::string weightless() {
    const double wanted = random_.pick({1.0, 1.0, 0.0, 0.5, 2.0, -1.0}), before = world_.gravity_scale(body_);
    target_.set_gravity_scale(body_, wanted);
    if (!near(world_.gravity_scale(body_), wanted)) return answers("set_gravity_scale", false);
    return before != wanted ? not_woken("set_gravity_scale") : std::string();
  }
  std::string damping() {
    const double linear = random_.pick({0.0, 0.0, 0.1, 1.0}), angular = random_.pick({0.0, 0.0, 0.3});
    const bool other = linear != 0 && world_.linear_damping(body_) == 0;
    target_.set_damping(body_, linear, angular);
    if (!near(world_.linear_damping(body_), linear) || !near(world_.angular_damping(body_), angular))
      return answers("set_damping", false);
    return other ? not_woken("set_damping") : std::string();
  }
  std::string locks() {
    const BodyLocks wanted{random_.chance(0.2), random_.chance(0.2), random_.chance(0.2)};
    const BodyLocks before = world_.locks(body_);
    target_.set_locks(body_, wanted.x, wanted.y, wanted.rotation);
    if (!(world_.locks(body_) == wanted)) return answers("set_locks", false);
    return before != wanted ? not_woken("set_locks") : std::string();
  }
  std::string mass() {
    const MaterialPoints before = motion();
    const double mass = random_.within(0.5, 2) * std::max(world_.mass(body_), 1e-6);
    const MassProperties wanted{mass, random_.chance(0.3) ? Vec2d{} : vector(0.5 * size()),
                                mass * size() * size() * random_.within(0.1, 1)};
    target_.set_mass(body_, wanted);
    if (!dynamic()) return {};
    if (!near(world_.mass(body_), wanted.mass) ||
        (!world_.locks(body_).rotation && !near(world_.inertia(body_), wanted.inertia)) ||
        !near(world_.centre(body_), world_.world_point(body_, wanted.centre), size()))
      return answers("set_mass", false);
    return mass_is_wrong("set_mass", before);
  }
  std::string densities() {
    const MaterialPoints before = motion();
    target_.use_densities(body_);
    if (std::string wrong = mass_by_shapes(); !wrong.empty()) return wrong;
    return mass_is_wrong("use_densities", before);
  }
  /// Returns an objection if mass, centre and inertia are not those of the shapes' outlines.
  std::string mass_by_shapes() {
    if (!dynamic()) return {};
    double mass = 0, about_origin = 0;
    Vec2d moment{};
    for (const ShapeId shape : world_.shapes(body_)) {
      if (world_.valid(world_.chain(shape))) return {};
      const AreaMoments of = moments_of(outline_in_body(world_, shape));
      const double weight = world_.density(shape) * of.area;
      mass += weight;
      moment += weight * of.centroid;
      about_origin += world_.density(shape) * of.second + weight * dot(of.centroid, of.centroid);
    }
    if (!(mass > 1e-6)) return {};  // the world has a rule of its own for bodies without mass
    const Vec2d centre = (1 / mass) * moment;
    const double inertia = about_origin - mass * dot(centre, centre);
    // Outlines are polygons of 360 corners.
    const auto off = [](double a, double b) { return std::abs(a - b) > 2e-3 * std::abs(b); };
    if (off(world_.mass(body_), mass))
      return fmt::format("'{}' has {:.6g} kg, not the {:.6g} of its shapes", world_.name(body_),
                         world_.mass(body_), mass);
    if (length(world_.centre(body_) - world_.world_point(body_, centre)) > 2e-3 * size())
      return fmt::format("the centre of '{}' is not that of its shapes", world_.name(body_));
    if (!world_.locks(body_).rotation && off(world_.inertia(body_), inertia) && inertia > 1e-6 * about_origin)
      return fmt::format("'{}' has {:.6g} kg m^2, not the {:.6g} of its shapes", world_.name(body_),
                         world_.inertia(body_), inertia);
    return {};
  }
  std::string type() {
    const BodyType wanted = random_.pick(
        {BodyType::Dynamic, BodyType::Dynamic, BodyType::Dynamic, BodyType::Kinematic, BodyType::Static});
    const BodyType before = world_.type(body_);
    target_.set_type(body_, wanted);
    if (world_.type(body_) != wanted) return answers("set_type", false);
    return before != wanted ? not_woken("set_type") : std::string();
  }
  std::string sleep() {
    const bool wanted = random_.chance(0.3);
    target_.set_awake(body_, wanted);
    return wanted ? not_woken("set_awake") : std::string();
  }
  std::string may_sleep() {
    const bool wanted = random_.chance(0.7);
    target_.set_may_sleep(body_, wanted);
    if (world_.may_sleep(body_) != wanted) return answers("set_may_sleep", false);
    return wanted ? std::string() : not_woken("set_may_sleep");
  }
  std::string enable() {
    const bool wanted = random_.chance(0.8);
    target_.set_enabled(body_, wanted);
    return answers("set_enabled", world_.enabled(body_) == wanted || world_.quarantined(body_));
  }
  std::string continuous() {
    const bool wanted = random_.chance(0.7);
    target_.set_continuous(body_, wanted);
    return answers("set_continuous", world_.continuous(body_) == wanted);
  }
  std::string towards() {
    const Vec2d to = world_.position(body_) + vector(0.3 * size());
    const double angle = world_.angle(body_) + number(0.5), dt = random_.pick({1.0 / 60, 0.01, 0.1});
    const Vec2d local = world_.local_point(body_, world_.centre(body_));
    target_.move_towards(body_, to, angle, dt);
    const BodyLocks locks = world_.locks(body_);
    if (world_.type(body_) == BodyType::Static || locks.x || locks.y || locks.rotation) return {};
    const Rotation<double> turn = rotation_of(angle);
    const Vec2d arrives = world_.centre(body_) + dt * world_.velocity(body_), wanted = to + turn * local;
    if (length(arrives - wanted) >
            10 * kRounding * (size() + length(local)) + kRounding * 0.01 * length(to) ||
        !near(world_.angle(body_) + dt * world_.angular_velocity(body_), angle, 1))
      return "move_towards leads somewhere else";
    return {};
  }
  std::string name() {
    const std::uint64_t data = static_cast<std::uint64_t>(random_.whole(0, 5));
    target_.set_user_data(body_, data);
    return answers("set_user_data", world_.user_data(body_) == data);
  }
  std::string destroy() {
    if (random_.chance(0.7)) return {};
    const int before = world_.counts().bodies;
    target_.destroy(body_);
    return answers("destroy", !world_.valid(body_) && world_.counts().bodies == before - 1);
  }

  ShapeDefinition shape_of(double s) {
    ShapeDefinition out;
    switch (random_.whole(0, 3)) {
      case 0:
        out.geometry = Circle{0.5 * s};
        break;
      case 1:
        out.geometry = Box{s, s * random_.within(0.3, 1)};
        break;
      case 2:
        out.geometry = Capsule{{-0.4 * s, 0}, {0.4 * s, 0}, 0.2 * s};
        break;
      default:
        out.geometry = Polygon{{{-0.5 * s, -0.3 * s}, {0.5 * s, -0.3 * s}, {0, 0.6 * s}},
                               random_.chance(0.5) ? 0 : 0.1 * s};
    }
    if (random_.chance(0.3)) out.sensor = true;
    if (random_.chance(0.3)) out.hit_events = true;
    if (random_.chance(0.2)) out.density = random_.pick({0.0, 3.0});
    if (random_.chance(0.2)) out.filter.category = std::uint64_t{1} << random_.whole(0, 63);
    return out;
  }
  std::string add_shape() {
    const MaterialPoints before = motion();
    ShapeDefinition definition = shape_of(size() * random_.within(0.2, 1));
    definition.position = vector(0.7 * size());
    const std::size_t count = world_.shapes(body_).size();
    target_.create_shape(body_, definition);
    if (world_.shapes(body_).size() != count + 1) return answers("create_shape", false);
    if (std::string wrong = sleepers_inside(); !wrong.empty()) return wrong;
    return moves_otherwise("create_shape", before);
  }

  std::string material() {
    const Material wanted{.friction = random_.pick({0.6, 0.6, 0.0, 1.0}),
                          .restitution = random_.pick({0.0, 0.0, 0.5}),
                          .rolling_resistance = random_.pick({0.0, 0.0, 0.1}),
                          .surface_speed = random_.pick({0.0, 0.0, 1.0})};
    target_.set_material(shape_, wanted);
    const Material now = world_.material(shape_);
    if (!near(now.friction, wanted.friction) || !near(now.restitution, wanted.restitution) ||
        !near(now.rolling_resistance, wanted.rolling_resistance) ||
        !near(now.surface_speed, wanted.surface_speed))
      return answers("set_material", false);
    return {};
  }
  std::string filter() {
    Filter wanted;
    if (random_.chance(0.5)) wanted.category = std::uint64_t{1} << random_.whole(0, 63);
    if (random_.chance(0.4)) wanted.mask = ~(std::uint64_t{1} << random_.whole(0, 63));
    if (random_.chance(0.2)) wanted.group = random_.whole(-2, 2);
    target_.set_filter(shape_, wanted);
    return answers("set_filter", world_.filter(shape_) == wanted);
  }
  std::string density() {
    const MaterialPoints before = motion();
    const double wanted = random_.pick({1.0, 1.0, 0.5, 4.0});
    target_.set_density(shape_, wanted);
    if (!near(world_.density(shape_), wanted)) return answers("set_density", false);
    return moves_otherwise("set_density", before);
  }
  std::string sensor() {
    const MaterialPoints before = motion();
    const bool wanted = random_.chance(0.4);
    target_.set_sensor(shape_, wanted);
    if (world_.sensor(shape_) != wanted) return answers("set_sensor", false);
    return moves_otherwise("set_sensor", before);
  }
  std::string flags() {
    const bool hits = random_.chance(0.6), solves = random_.chance(0.5);
    target_.set_hit_events(shape_, hits), target_.set_pre_solve(shape_, solves);
    return answers("set_hit_events or set_pre_solve",
                   world_.hit_events(shape_) == hits && world_.pre_solve(shape_) == solves);
  }
  std::string destroy_shape() {
    if (random_.chance(0.5)) return {};
    const MaterialPoints before = motion();
    target_.destroy(shape_);
    if (world_.valid(shape_)) return answers("destroy", false);
    return moves_otherwise("destroy of a shape", before);
  }

  std::string change() {
    JointKind wanted = world_.kind(joint_);
    // A member at a time goes back to its usual value; a motor or a spring comes and goes.
    std::visit(
        [&](auto& kind) {
          const std::remove_reference_t<decltype(kind)> usual{};
          if constexpr (requires { kind.motor.reset(); }) {
            if (random_.chance(0.5)) kind.motor = usual.motor;
          }
          if constexpr (requires { kind.spring.reset(); }) {
            if (random_.chance(0.3)) kind.spring = usual.spring;
          }
          if constexpr (requires { kind.limits.reset(); }) {
            if (random_.chance(0.3)) kind.limits = usual.limits;
          }
          if constexpr (requires { kind.motor->speed; }) {
            if (kind.motor) kind.motor->speed = number(3);
          }
          // Keeps its anchors, and the angle that it counts from.
          if constexpr (!requires { kind.reference_angle; }) {
            if (random_.chance(0.15)) kind = usual;
          }
        },
        wanted);
    target_.change(joint_, wanted);
    return answers("change", world_.kind(joint_).index() == wanted.index());
  }
  std::string loads() {
    const JointReading reading = world_.read(joint_);
    // Near what it bears, so that a little more or less decides.
    const double force = random_.chance(0.2) ? 0 : reading.force * random_.within(0.85, 1.02),
                 torque = random_.chance(0.6) ? 0 : reading.torque * random_.within(0.85, 1.02);
    target_.set_load_events(joint_, force, torque);
    const JointDefinition now = world_.definition(joint_);
    return answers("set_load_events", near(now.report_force, force) && near(now.report_torque, torque));
  }
  // Makes a joint anew that breaks near what it bears.
  std::string rejoin() {
    const JointReading reading = world_.read(joint_);
    const auto [a, b] = world_.bodies(joint_);
    JointDefinition definition = world_.definition(joint_);
    definition.break_force = random_.chance(0.3) ? 0 : reading.force * random_.within(0.85, 1.05);
    definition.break_torque = random_.chance(0.5) ? 0 : reading.torque * random_.within(0.85, 1.05);
    target_.destroy(joint_);
    joint_ = target_.create_joint(a, b, definition);
    const JointDefinition now = world_.definition(joint_);
    return answers("create_joint", near(now.break_force, definition.break_force) &&
                                       near(now.break_torque, definition.break_torque));
  }
  std::string destroy_joint() {
    if (random_.chance(0.7)) return {};
    target_.destroy(joint_);
    return answers("destroy", !world_.valid(joint_));
  }

  std::string gravity() {
    const Vec2d before = world_.gravity(), wanted = random_.chance(0.5)   ? Vec2d{0, -9.81}
                                                    : random_.chance(0.5) ? Vec2d{0, 0}
                                                                          : vector(10);
    target_.set_gravity(wanted);
    return answers("set_gravity", near(world_.gravity(), wanted) || near(before, wanted));
  }
  std::string settings() {
    switch (random_.whole(0, 3)) {
      case 0:
        target_.set_sleeping(random_.chance(0.8));
        break;
      case 1:
        target_.set_continuous(random_.chance(0.7));
        break;
      case 2:
        target_.set_direct_islands(random_.chance(0.6));
        break;
      default:
        target_.set_iterations(random_.pick({10, 10, 4}));
    }
    return {};
  }
  std::string thresholds() {
    const Thresholds wanted{random_.pick({-1.0, 0.5}), random_.pick({-1.0, -1.0, 0.3}),
                            random_.pick({-1.0, -1.0, 0.02})};
    target_.set_thresholds(wanted);
    return answers("set_thresholds", world_.thresholds() == wanted);
  }
  std::string create() {
    BodyDefinition definition;
    double s = 1;
    if (!bodies_.empty()) {
      body_ = random_.pick(bodies_);
      s = size() * random_.within(0.3, 1);
      definition.position = world_.centre(body_) + vector(2 * size());
    }
    definition.type =
        random_.pick({BodyType::Dynamic, BodyType::Dynamic, BodyType::Static, BodyType::Kinematic});
    definition.angle = number(3);
    definition.velocity = vector(2);
    if (random_.chance(0.3)) definition.gravity_scale = 0;
    ShapeDefinition shape = shape_of(s);
    const int before = world_.counts().bodies;
    body_ = target_.create_body(definition, shape);
    if (world_.counts().bodies != before + 1 || !world_.valid(body_)) return answers("create_body", false);
    if (std::string wrong = mass_by_shapes(); !wrong.empty()) return wrong;
    return sleepers_inside();
  }
  // Creates a body without shapes, or one with several, one of them far away.
  std::string ghost() {
    BodyDefinition definition{.position = vector(5), .angle = number(3), .angular_velocity = number(4)};
    std::vector<ShapeDefinition> shapes;
    const int count = random_.pick({0, 2, 3});
    for (int i = 0; i < count; ++i) {
      shapes.push_back(shape_of(random_.within(0.2, 1)));
      shapes.back().position = vector(1), shapes.back().angle = number(3);
    }
    body_ = target_.create_body(definition, shapes);
    return mass_by_shapes();
  }
  std::string add_joint() {
    if (bodies_.size() < 2) return {};
    const BodyId a = random_.pick(bodies_), b = random_.pick(bodies_);
    if (a == b) return {};
    const Vec2d at = world_.centre(b);
    JointDefinition definition;
    const Vec2d on_a = world_.local_point(a, at), on_b = world_.local_point(b, at);
    // Whole turns are no part of a pose.
    const double full = world_.angle(b) - world_.angle(a),
                 angle = random_.chance(0.5) ? full : std::remainder(full, 6.283185307179586);
    switch (random_.whole(0, 3)) {
      case 0:
        definition.kind = RevoluteDefinition{.anchor_a = on_a, .anchor_b = on_b, .reference_angle = angle};
        break;
      case 1:
        definition.kind = WeldDefinition{.anchor_a = on_a, .anchor_b = on_b, .reference_angle = angle};
        break;
      case 2:
        definition.kind = PrismaticDefinition{.anchor_a = on_a, .anchor_b = on_b, .reference_angle = angle};
        break;
      default:
        definition.kind = DistanceDefinition{.anchor_a = world_.local_point(a, world_.centre(a)),
                                             .anchor_b = on_b,
                                             .length = std::max(0.01, length(at - world_.centre(a)))};
    }
    const JointId made = target_.create_joint(a, b, definition);
    if ((std::holds_alternative<RevoluteDefinition>(definition.kind) ||
         std::holds_alternative<WeldDefinition>(definition.kind)) &&
        std::abs(world_.read(made).angle) > 0.01)
      return fmt::format("a joint that is made at its angle reads {:.4g} rad", world_.read(made).angle);
    return answers("create_joint", world_.bodies(made) == std::pair(a, b));
  }

  /// Returns an objection if a sleeper lies in a solid shape of the body, which may touch it.
  std::string sleepers_inside() const {
    // Leaves out bodies that move: they wake others when they meet them, in a step.
    if (!world_.enabled(body_) || world_.type(body_) != BodyType::Static) return {};
    for (const ShapeId own : world_.shapes(body_)) {
      if (world_.sensor(own) || world_.valid(world_.chain(own))) continue;
      const Outline outline = outline_in_world(world_, own);
      for (const BodyId other : bodies_) {
        if (other == body_ || !world_.valid(other) || !world_.enabled(other) ||
            world_.type(other) != BodyType::Dynamic || world_.awake(other) || is_joined(other))
          continue;
        for (const ShapeId shape : world_.shapes(other)) {
          if (world_.sensor(shape) || !may_touch(world_.filter(own), world_.filter(shape))) continue;
          const Outline sleeper = outline_in_world(world_, shape);
          const double least = std::min(width_of(outline), width_of(sleeper));
          if (separation(outline, sleeper) < -kOverlap * least)
            return fmt::format("'{}' sleeps on with '{}' put into it", world_.name(other),
                               world_.name(body_));
        }
      }
    }
    return {};
  }
  bool is_joined(BodyId other) const {
    for (const JointId joint : world_.joints(body_)) {
      const auto [a, b] = world_.bodies(joint);
      if (a == other || b == other) return true;
    }
    return false;
  }

  Random& random_;
  const BasicWorld<Real>& world_;
  Target& target_;
  std::vector<BodyId> bodies_;
  BodyId body_{};
  ShapeId shape_{};
  JointId joint_{};
};

}  // namespace

template <class Real, class Target>
std::string make_call(Random& random, const BasicWorld<Real>& world, Target& target) {
  return Caller<Real, Target>(random, world, target).make();
}

template std::string make_call(Random&, const BasicWorld<float>&, BasicWorld<float>&);
template std::string make_call(Random&, const BasicWorld<double>&, BasicWorld<double>&);
template std::string make_call(Random&, const BasicWorld<float>&, RecordedWorld<float>&);
template std::string make_call(Random&, const BasicWorld<double>&, RecordedWorld<double>&);

}  // namespace plumb::harness::hunt
