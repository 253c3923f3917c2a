#include "harness/hunt/calls.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/hunt/caller.h"
#include "harness/hunt/shapes_of_world.h"

namespace plumb::harness::hunt {
namespace {

// Overlap, as a fraction of a shape's size, from which a new shape must wake a sleeping body. Below it the
// world may or may not count the two as touching.
constexpr double kOverlap = 0.02;

}  // namespace

template <class Real, class Target>
std::string Caller<Real, Target>::make() {
  bodies_ = world_.bodies();
  Make call = on_world();
  if (!bodies_.empty() && random_.chance(0.85)) {
    body_ = random_.pick(bodies_);
    // Prefers sleeping bodies, because a call may fail to wake these.
    for (int tries = 0; tries < 4 && (world_.awake(body_) || world_.type(body_) != BodyType::Dynamic);
         ++tries)
      body_ = random_.pick(bodies_);
    call = on_body();
    const std::vector<ShapeId> shapes = world_.shapes(body_);
    const std::vector<JointId> joints = world_.joints(body_);
    if (!joints.empty() && random_.chance(0.3))
      joint_ = random_.pick(joints), call = on_joint();
    else if (!shapes.empty() && random_.chance(0.3))
      shape_ = random_.pick(shapes), call = on_shape();
  }
  try {
    return (this->*call)();
  } catch (const Error&) {
    return {};  // an invalid handle
  }
}

template <class Real, class Target>
std::string Caller<Real, Target>::not_woken(const char* call) const {
  if (simulated() && !world_.awake(body_))
    return fmt::format("{} does not wake '{}'", call, world_.name(body_));
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::answers(const char* call, bool right) const {
  return right ? std::string() : fmt::format("{} is not returned by its getter", call);
}

template <class Real, class Target>
auto Caller<Real, Target>::motion() const -> MaterialPoints {
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

template <class Real, class Target>
std::string Caller<Real, Target>::moves_otherwise(const char* call, const MaterialPoints& before) const {
  if (!dynamic()) return {};
  const MaterialPoints now = motion();
  // A centre of mass far from the body's origin makes the rounding of its position visible.
  const double far = length(world_.centre(body_) - world_.position(body_)) + size();
  for (std::size_t i = 0; i < before.place.size(); ++i) {
    const Vec2d place = world_.world_point(body_, before.local[i]);
    if (length(place - before.place[i]) > kRounding * (far + 0.01 * length(place)))
      return fmt::format("{} moves '{}' by {:.3g} m", call, world_.name(body_),
                         length(place - before.place[i]));
    const Vec2d velocity = world_.velocity_at(body_, before.place[i]);
    const double bound = kRounding * (before.fastest + far * std::abs(before.spin)) * 4 + 1e-36;
    if (length(velocity - before.velocity[i]) > bound)
      return fmt::format("{} changes the velocity of a point of '{}' by {:.3g} m/s", call, world_.name(body_),
                         length(velocity - before.velocity[i]));
  }
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::mass_is_wrong(const char* call, const MaterialPoints& before) {
  if (std::string wrong = moves_otherwise(call, before); !wrong.empty()) return wrong;
  return not_woken(call);
}

template <class Real, class Target>
std::vector<BodyHash> Caller<Real, Target>::single_hashes() const {
  std::vector<BodyHash> out;
  if (world_.data().mass_changed_bodies.empty()) hash_awake_bodies(world_.data(), out);
  return out;
}

template <class Real, class Target>
std::string Caller<Real, Target>::hash_is_wrong(const char* call, const std::vector<BodyHash>& before) const {
  for (const BodyHash& now : single_hashes())
    for (const BodyHash& then : before)
      if (now.body == then.body && (now.hash == then.hash) == (now.body == body_.index))
        return fmt::format("{} {} the hash of a body", call, now.hash == then.hash ? "leaves" : "changes");
  return {};
}

template <class Real, class Target>
std::string Caller<Real, Target>::mass_by_shapes() {
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
  if (!(mass > 1e-6)) return {};  // the world treats bodies without mass in its own way
  const Vec2d centre = (1 / mass) * moment;
  const double inertia = about_origin - mass * dot(centre, centre);
  // Outlines are polygons of 360 corners.
  const auto off = [](double a, double b) { return std::abs(a - b) > 2e-3 * std::abs(b); };
  if (off(world_.mass(body_), mass))
    return fmt::format("'{}' has a mass of {:.6g} kg, not the {:.6g} kg of its shapes", world_.name(body_),
                       world_.mass(body_), mass);
  if (length(world_.centre(body_) - world_.world_point(body_, centre)) > 2e-3 * size())
    return fmt::format("the centre of mass of '{}' is not that of its shapes", world_.name(body_));
  if (!world_.locks(body_).rotation && off(world_.inertia(body_), inertia) && inertia > 1e-6 * about_origin)
    return fmt::format("'{}' has an inertia of {:.6g} kg m^2, not the {:.6g} of its shapes",
                       world_.name(body_), world_.inertia(body_), inertia);
  return {};
}

template <class Real, class Target>
ShapeDefinition Caller<Real, Target>::shape_of(double s) {
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

template <class Real, class Target>
std::string Caller<Real, Target>::sleepers_inside() const {
  // Leaves out moving bodies, because they wake others when they hit them in a step.
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
          return fmt::format("'{}' stays asleep although '{}' was placed into it", world_.name(other),
                             world_.name(body_));
      }
    }
  }
  return {};
}

template <class Real, class Target>
bool Caller<Real, Target>::is_joined(BodyId other) const {
  for (const JointId joint : world_.joints(body_)) {
    const auto [a, b] = world_.bodies(joint);
    if (a == other || b == other) return true;
  }
  return false;
}

template <class Real, class Target>
auto Caller<Real, Target>::on_world() -> Make {
  static constexpr Make kCalls[] = {&Caller::gravity, &Caller::settings,   &Caller::create,   &Caller::create,
                                    &Caller::ghost,   &Caller::thresholds, &Caller::add_joint};
  return pick(kCalls);
}

template <class Real, class Target>
std::string Caller<Real, Target>::gravity() {
  const Vec2d before = world_.gravity(), wanted = random_.chance(0.5)   ? Vec2d{0, -9.81}
                                                  : random_.chance(0.5) ? Vec2d{0, 0}
                                                                        : vector(10);
  target_.set_gravity(wanted);
  return answers("set_gravity", near(world_.gravity(), wanted) || near(before, wanted));
}

template <class Real, class Target>
std::string Caller<Real, Target>::settings() {
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

template <class Real, class Target>
std::string Caller<Real, Target>::thresholds() {
  const Thresholds wanted{random_.pick({-1.0, 0.5}), random_.pick({-1.0, -1.0, 0.3}),
                          random_.pick({-1.0, -1.0, 0.02})};
  target_.set_thresholds(wanted);
  return answers("set_thresholds", world_.thresholds() == wanted);
}

template <class Real, class Target>
std::string Caller<Real, Target>::create() {
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

template <class Real, class Target>
std::string Caller<Real, Target>::ghost() {
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

template <class Real, class Target>
std::string Caller<Real, Target>::add_joint() {
  if (bodies_.size() < 2) return {};
  const BodyId a = random_.pick(bodies_), b = random_.pick(bodies_);
  if (a == b) return {};
  const Vec2d at = world_.centre(b);
  JointDefinition definition;
  const Vec2d on_a = world_.local_point(a, at), on_b = world_.local_point(b, at);
  // A pose does not include whole turns.
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
    return fmt::format("a joint that was just created at its angle reads {:.4g} rad",
                       world_.read(made).angle);
  return answers("create_joint", world_.bodies(made) == std::pair(a, b));
}

template <class Real, class Target>
std::string make_call(Random& random, const BasicWorld<Real>& world, Target& target) {
  return Caller<Real, Target>(random, world, target).make();
}

// Instantiates the members defined in this file; other files instantiate their own.
template class Caller<float, BasicWorld<float>>;
template class Caller<double, BasicWorld<double>>;
template class Caller<float, RecordedWorld<float>>;
template class Caller<double, RecordedWorld<double>>;

template std::string make_call(Random&, const BasicWorld<float>&, BasicWorld<float>&);
template std::string make_call(Random&, const BasicWorld<double>&, BasicWorld<double>&);
template std::string make_call(Random&, const BasicWorld<float>&, RecordedWorld<float>&);
template std::string make_call(Random&, const BasicWorld<double>&, RecordedWorld<double>&);

}  // namespace plumb::harness::hunt
