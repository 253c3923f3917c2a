#include "tests/fuzz/support/world_player.h"

#include <optional>

#include "engine/scene/error.h"
#include "engine/world/rollback.h"
#include "engine/world/snapshot.h"
#include "tests/fuzz/support/joint_fit.h"
#include "tests/fuzz/support/require.h"
#include "tests/fuzz/support/world_checks.h"
#include "tests/fuzz/support/world_parts.h"

namespace plumb::fuzz {
namespace {

template <class Real>
BasicWorld<Real> draw(ByteSource& in) {
  const WorldDefinition definition = draw_world(in);
  try {
    return BasicWorld<Real>(definition);
  } catch (const Error&) {
    return BasicWorld<Real>();
  }
}

}  // namespace

template <class Real>
WorldPlayer<Real>::WorldPlayer(ByteSource& in) : in_(in), world_(draw<Real>(in)) {
  world_.on_pre_solve([](const ContactReading& contact) { return contact.normal.y > -0.9; });
}

template <class Real>
void WorldPlayer<Real>::change() {
  std::optional<std::vector<std::byte>> before;
  if (in_.extreme()) before = save(world_);
  try {
    switch (in_.below(12)) {
      case 0:
      case 1:
      case 2:
        return create();
      case 3:
      case 4:
        return add_part();
      case 5:
        return remove();
      case 6:
        return push();
      case 7:
        return change_body();
      case 8:
        return change_part();
      case 9:
        return change_world();
      case 10:
        return apply_forces();
      default:
        return expect_gone();
    }
  } catch (const Error& error) {
    const bool known = error.kind() == Error::Kind::Value || error.kind() == Error::Kind::Name;
    if (!known) fail("calls are refused for values and names alone", error.what());
    if (before && save(world_) != *before) fail("a refused call changes nothing", error.what());
  }
}

template <class Real>
void WorldPlayer<Real>::create() {
  if (world_.counts().bodies >= static_cast<int>(kMost)) return;
  const BodyDefinition body = draw_body(in_);
  std::vector<ShapeDefinition> shapes;
  const int count = 1 + in_.below(8) / 6;
  for (int i = 0; i < count; ++i) shapes.push_back(draw_shape(in_));
  bodies_.push_back(world_.create_body(body, shapes));
  for (const ShapeId shape : world_.shapes(bodies_.back())) shapes_.push_back(shape);
}

template <class Real>
void WorldPlayer<Real>::add_part() {
  switch (in_.below(8)) {
    case 0: {
      const BodyId body = some_body();
      shapes_.push_back(world_.create_shape(body, draw_shape(in_)));
      return;
    }
    case 1: {
      const BodyId body = some_body();
      chains_.push_back(world_.create_chain(body, draw_chain(in_)));
      return;
    }
    default: {
      constexpr double kNear = 3;  // m
      const BodyId a = some_body(), b = some_body();
      JointDefinition joint = draw_joint(in_);
      if (!in_.extreme()) {
        if (length_squared(world_.centre(a) - world_.centre(b)) > kNear * kNear) return;
        fit(world_, a, b, joint.kind);
      }
      joints_.push_back(world_.create_joint(a, b, joint));
    }
  }
}

template <class Real>
void WorldPlayer<Real>::remove() {
  const auto destroy = [&](const auto& all) {
    const auto id = some(all);
    world_.destroy(id);
    require(!world_.valid(id), "what is destroyed is not valid");
  };
  switch (in_.below(4)) {
    case 0:
      return destroy(bodies_);
    case 1:
      return destroy(shapes_);
    case 2:
      return destroy(chains_);
    default:
      return destroy(joints_);
  }
}

template <class Real>
void WorldPlayer<Real>::note_push(BodyId body) {
  pushes_.push_back({body, world_.mass(body), world_.inertia(body)});
}

template <class Real>
void WorldPlayer<Real>::push() {
  const BodyId body = some_body();
  // By accelerations and changes of speed: a game does not push a pebble like a car.
  const double mass = world_.mass(body), inertia = world_.inertia(body);
  note_push(body);
  switch (in_.below(9)) {
    case 0:
      return world_.apply_force(body, mass * in_.vector(300));
    case 1: {
      const Vec2d force = mass * in_.vector(300);
      return world_.apply_force(body, force, world_.world_point(body, in_.vector(0.3)));
    }
    case 2:
      return world_.apply_torque(body, inertia * in_.number(-300, 300));
    case 3:
      return world_.apply_impulse(body, mass * in_.vector(10));
    case 4: {
      const Vec2d impulse = mass * in_.vector(5);
      return world_.apply_impulse(body, impulse, world_.world_point(body, in_.vector(0.3)));
    }
    case 5:
      return world_.apply_angular_impulse(body, inertia * in_.number(-10, 10));
    case 6:
      return world_.set_velocity(body, in_.vector(40));
    case 7:
      return world_.set_angular_velocity(body, in_.number(-20, 20));
    default: {
      const Vec2d place = in_.vector(12);
      return world_.move_towards(body, place, in_.number(-3, 3), 0.1);
    }
  }
}

template <class Real>
void WorldPlayer<Real>::change_body() {
  const BodyId body = some_body();
  const int which = in_.below(9), bits = in_.byte();
  switch (which) {
    case 0: {
      const Vec2d place = in_.vector(12);
      if (!in_.extreme() && !world_.joints(body).empty()) return;
      return world_.set_position(body, place, in_.number(-7, 7));
    }
    case 1:
      return world_.set_type(body, static_cast<BodyType>(bits % 3));
    case 2:
      return world_.set_mass(body, draw_mass(in_));
    case 3:
      return world_.use_densities(body);
    case 4:
      return world_.set_gravity_scale(body, in_.number(-1, 2));
    case 5: {
      const double linear = in_.number(0, 5);
      return world_.set_damping(body, linear, in_.number(0, 5));
    }
    case 6:
      return world_.set_locks(body, bits & 1, bits & 2, bits & 4);
    case 7:
      return world_.set_awake(body, bits & 1);
    default:
      return world_.set_may_sleep(body, bits & 1);
  }
}

template <class Real>
void WorldPlayer<Real>::change_part() {
  switch (in_.below(4)) {
    case 0: {
      const ShapeId shape = some(shapes_);
      return world_.set_material(shape, draw_material(in_));
    }
    case 1: {
      const ShapeId shape = some(shapes_);
      return world_.set_filter(shape, draw_filter(in_));
    }
    default: {
      const JointId joint = some(joints_);
      JointKind kind = draw_joint_kind(in_, static_cast<int>(world_.kind(joint).index()));
      const auto [a, b] = world_.bodies(joint);
      if (!in_.extreme()) fit(world_, a, b, kind);
      return world_.change(joint, kind);
    }
  }
}

template <class Real>
void WorldPlayer<Real>::change_world() {
  const int which = in_.below(8), bits = in_.byte();
  switch (which) {
    case 0:
      return world_.set_gravity(in_.vector(20));
    case 1:
      return world_.set_sleeping(bits & 1);
    case 2:
      return world_.set_continuous(bits & 1);
    case 3:
      return world_.set_solver(static_cast<Solver>(bits % (in_.extreme() ? 8 : 5)));
    case 4:
      return world_.set_iterations(bits % 16);
    case 5:
      return world_.set_quarantine(bits & 1);
    case 6:
      return world_.release(some_body());
    default:
      return world_.set_direct_islands(bits & 1);
  }
}

template <class Real>
void WorldPlayer<Real>::expect_gone() {
  const auto refused = [&](const auto& all, auto use) {
    const auto id = some(all);
    if (world_.valid(id)) return;
    try {
      use(id);
    } catch (const Error& error) {
      require(error.kind() == Error::Kind::Name, "what is gone is refused by name");
      return;
    }
    require(false, "what is gone is refused");
  };
  refused(bodies_, [&](BodyId id) { world_.set_velocity(id, {}); });
  refused(shapes_, [&](ShapeId id) { world_.set_filter(id, {}); });
  refused(chains_, [&](ChainId id) { world_.segments(id); });
  refused(joints_, [&](JointId id) { world_.read(id); });
}

template <class Real>
double WorldPlayer<Real>::draw_dt() {
  static constexpr double kDts[] = {1.0 / 60, 1.0 / 60, 1.0 / 120, 1.0 / 30, 1.0 / 240};
  static constexpr double kExtremeDts[] = {1e-9, 1e-6, 0.1, 0.5, 1, 10, 1e4, 1e-12, 0, -1};
  const std::uint8_t which = in_.byte();
  if (in_.extreme() && which >= 128) return kExtremeDts[which % std::size(kExtremeDts)];
  return kDts[which % std::size(kDts)];
}

// The course's sweeps feed errors back whole: joints that nothing can close (a pulley whose other end is
// carried off) make them faster from step to step. docs/limits.md says so. And what is pushed like a car and
// becomes a pebble before the step flies off as it should.
template <class Real>
bool WorldPlayer<Real>::is_everyday() {
  const bool sweeps = world_.solver() == Solver::Jakobsen || world_.solver() == Solver::SequentialImpulses;
  goes_wild_ = goes_wild_ || (sweeps && world_.counts().joints > 0);
  for (const Push& push : pushes_) {
    if (!world_.valid(push.body)) continue;
    goes_wild_ = goes_wild_ || world_.mass(push.body) < push.mass || world_.inertia(push.body) < push.inertia;
  }
  pushes_.clear();
  return !in_.extreme() && !goes_wild_;
}

template <class Real>
bool WorldPlayer<Real>::step() {
  const int count = 1 + in_.below(8), substeps = 1 + in_.below(6);
  const double dt = draw_dt();
  const bool everyday = is_everyday();
  for (int i = 0; i < count; ++i) {
    const StepCheck<Real> check(world_);
    try {
      world_.step(dt, substeps);
    } catch (const Error& error) {
      if (error.kind() == Error::Kind::Value && in_.extreme()) return true;  // of dt: nothing has changed
      if (everyday) fail("an everyday world takes every step", error.what());
      return false;
    }
    check.check(world_, everyday);
    check_world(world_);
  }
  return true;
}

template <class Real>
bool WorldPlayer<Real>::repeat() {
  const std::vector<std::byte> saved = save(world_);
  const std::uint64_t hash = world_.hash();
  Rollback<Real> rollback(world_, 2);
  rollback.save();
  const std::int64_t start = world_.step_count();
  const bool everyday = is_everyday();
  const auto future = [&]() -> std::optional<std::uint64_t> {
    try {
      for (int i = 0; i < 3; ++i) world_.step();
    } catch (const Error& error) {
      if (everyday) fail("an everyday world takes every step", error.what());
      return std::nullopt;
    }
    return world_.hash();
  };
  const auto first = future();
  restore(world_, saved);
  require(world_.hash() == hash && save(world_) == saved, "restoring gives what was saved");
  require(future() == first, "a restored world goes on with the same bits");
  rollback.back_to(start);
  require(world_.hash() == hash && save(world_) == saved, "going back gives what was kept");
  require(future() == first, "a world that went back goes on with the same bits");
  return first.has_value();
}

template <class Real>
bool WorldPlayer<Real>::play() {
  bool goes_on = true;
  while (goes_on && !in_.empty()) {
    const int what = in_.below(16);
    if (what < 10) {
      change();
    } else if (what < 14) {
      goes_on = step();
    } else if (what == 14) {
      ask();
    } else {
      goes_on = repeat();
    }
  }
  return goes_on;
}

template class WorldPlayer<float>;
template class WorldPlayer<double>;

}  // namespace plumb::fuzz
