#include "engine/world/scene/scene_forces.h"

#include <cmath>
#include <variant>

#include "engine/forces/compile.h"
#include "engine/math/trigonometry.h"
#include "engine/world/forces/law_bodies.h"
#include "engine/world/state/lock.h"

namespace plumb {
namespace {

/// Phase per step, rad, above which a spring is stiff. The explicit midpoint method is unstable from 2 on; at
/// this value its energy oscillates by 2 %.
constexpr double kStiffTurn = 0.3;

Scene without_springs_and_drag(const Scene& scene) {
  Scene out = scene;
  std::erase_if(out.forces, [](const ForceLaw& law) {
    return std::holds_alternative<SpringForce>(law) || std::holds_alternative<LinearDrag>(law) ||
           std::holds_alternative<QuadraticDrag>(law);
  });
  return out;
}

// Returns the length s of the velocity at the middle of a step by the implicit midpoint method:
// a s^2 + b s = |u|, where u is that velocity without drag. Written without a difference of near numbers.
double slowed(Vec2d u, double half, double linear, double quadratic, double mass) {
  const double a = half * quadratic / mass, b = 1 + half * linear / mass,
               speed = std::sqrt(length_squared(u));
  return 2 * speed / (b + std::sqrt(b * b + 4 * a * speed));
}

// Returns the velocity of which drag is z / dt times over a step, from `start` under an acceleration that
// changes the velocity by `gain` in half a step. The velocity then decays by 1 / (1 + z + z^2 / 2), which is
// exp(-z) to second order, and for large z stops: the implicit midpoint method would reverse it.
template <class Value>
Value dragged(Value start, Value gain, double z) {
  return (1 / (1 + z + 0.5 * z * z)) * ((1 + 0.5 * z) * start + (1 + z) * gain);
}

}  // namespace

template <class Real>
SceneForces<Real>::SceneForces(const Scene& scene, const SceneParts& parts)
    : laws_(without_springs_and_drag(scene)),
      drags_(scene.bodies.size()),
      ids_(parts.bodies),
      poses_(scene.bodies.size()),
      twists_(scene.bodies.size()),
      wrenches_(scene.bodies.size()) {
  const LawCompiler<double> compiler(scene);
  std::vector<char> pulled(scene.bodies.size(), 0);
  for (const ForceLaw& law : scene.forces) {
    if (const auto* linear = std::get_if<LinearDrag>(&law)) {
      const std::size_t body = compiler.compile(*linear).body;
      drags_[body].linear += linear->coefficient, drags_[body].angular += linear->angular_coefficient;
      pulled[body] = 1;
    }
    if (const auto* quadratic = std::get_if<QuadraticDrag>(&law)) {
      const std::size_t body = compiler.compile(*quadratic).body;
      drags_[body].quadratic += quadratic->coefficient;
      pulled[body] = 1;
    }
    const auto* spring = std::get_if<SpringForce>(&law);
    if (spring == nullptr) continue;
    springs_.push_back({compiler.compile(*spring)});
    for (const int end : {springs_.back().law.a, springs_.back().law.b})
      if (end != kFixedFrame) pulled[static_cast<std::size_t>(end)] = 1;
  }
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const bool dynamic = scene.bodies[body].type == BodyType::Dynamic;
    gravity_.push_back(dynamic ? scene.bodies[body].gravity_scale * scene.gravity : Vec2d{});
    if (laws_.acts_on(body) || pulled[body] != 0) acted_on_.push_back(body);
  }
}

template <class Real>
void SceneForces<Real>::place(const BasicWorld<Real>& world) {
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    poses_[body] = {state.position, rotation_of(state.angle)};
    twists_[body] = {state.velocity, state.angular_velocity};
    wrenches_[body] = {};
  }
}

/// Advances velocities to the middle of the step under the forces in `wrenches_` and drag; positions by
/// `place_share`.
template <class Real>
void SceneForces<Real>::advance(const BasicWorld<Real>& world, double dt) {
  const double half = 0.5 * dt;
  for (const std::size_t body : acted_on_) {
    const BodyState state = world.state(ids_[body]);
    const double mass = world.mass(ids_[body]), inertia = world.inertia(ids_[body]);
    Twist<double>& twist = twists_[body];
    const double ahead = place_share(world.data(), static_cast<int>(ids_[body].index), dt) * dt;
    poses_[body] = {state.position + ahead * state.velocity,
                    rotation_of(state.angle + ahead * state.angular_velocity)};
    Drag& drag = drags_[body];
    if (mass > 0) {
      const Vec2d gain = half * (gravity_[body] + (1 / mass) * wrenches_[body].force);
      const double speed = slowed(twist.velocity + gain, half, drag.linear, drag.quadratic, mass);
      drag.now = drag.linear + drag.quadratic * speed;
      twist.velocity = dragged(twist.velocity, gain, dt * drag.now / mass);
    }
    if (inertia > 0) {
      const double gain = half / inertia * wrenches_[body].torque;
      twist.angular_velocity = dragged(twist.angular_velocity, gain, dt * drag.angular / inertia);
    }
    wrenches_[body] = {};
  }
}

/// Finds the stiff springs from the motion at the start of the step, and their forces by the implicit
/// midpoint method. The tension at the middle of the step is taken at l + dt/2 l' - dt^2/4 w T. It equals
/// that at l + dt/2 l' divided by 1 + dt^2/4 k w + dt/2 c w. w is the inverse mass of both ends along the
/// line (Hairer, Lubich, Wanner, Geometric Numerical Integration, VI.1). The direction, too, is that at the
/// middle, even if the line only rotates.
template <class Real>
void SceneForces<Real>::stiffen(const BasicWorld<Real>& world, double dt) {
  struct End {
    Vec2d point{}, velocity{}, arm{};
    double ahead = 0;  // s, time at which its position is taken
    double inverse_mass = 0, inverse_inertia = 0;
  };
  const auto end_of = [&](int body, Vec2d anchor) -> End {
    if (body == kFixedFrame) return {.point = anchor};
    const Vec2d arm = poses_[body].rotation * anchor;
    End end{.point = poses_[body].position + arm,
            .velocity = twists_[body].velocity + cross(twists_[body].angular_velocity, arm),
            .arm = arm,
            .ahead = place_share(world.data(), static_cast<int>(ids_[body].index), dt) * dt};
    if (world.type(ids_[body]) != BodyType::Dynamic) return end;
    const double mass = world.mass(ids_[body]), inertia = world.inertia(ids_[body]);
    end.inverse_mass = mass > 0 ? 1 / mass : 0;
    end.inverse_inertia = inertia > 0 ? 1 / inertia : 0;
    return end;
  };
  for (Spring& spring : springs_) {
    const double k = spring.law.stiffness, c = spring.law.damping;
    const End a = end_of(spring.law.a, spring.law.anchor_a), b = end_of(spring.law.b, spring.law.anchor_b);
    const Vec2d way = b.point - a.point, speed = b.velocity - a.velocity;
    const double length = std::sqrt(length_squared(way));
    spring.stiff = false;
    if (length == 0) continue;
    const Vec2d axis = (1 / length) * way;
    const double lever_a = cross(a.arm, axis), lever_b = cross(b.arm, axis);
    const double w = a.inverse_mass + b.inverse_mass + lever_a * lever_a * a.inverse_inertia +
                     lever_b * lever_b * b.inverse_inertia;
    spring.stiff = (k * dt + c) * dt * w > kStiffTurn * kStiffTurn;
    if (!spring.stiff) continue;
    const double rate = dot(axis, speed);
    const Vec2d shift = b.ahead * b.velocity - a.ahead * a.velocity;
    const double along = dot(axis, shift);
    const double tension = (k * (length + along - spring.law.rest_length) + c * rate) /
                           (1 + 0.25 * dt * dt * k * w + 0.5 * dt * c * w);
    const Vec2d middle = way + shift - along * axis;
    const Vec2d pull = tension / std::sqrt(length_squared(middle)) * middle;
    spring.on_a = {pull, cross(a.arm, pull)};
    spring.on_b = {-pull, -cross(b.arm, pull)};
  }
}

template <class Real>
void SceneForces<Real>::add_springs(bool stiff) {
  const Pose<double> fixed_pose{};
  const Twist<double> no_motion{};
  for (const Spring& spring : springs_) {
    if (spring.stiff && !stiff) continue;
    const SpringForceLaw<double>& law = spring.law;
    const bool has_a = law.a != kFixedFrame, has_b = law.b != kFixedFrame;
    auto [on_a, on_b] =
        spring.stiff ? std::pair(spring.on_a, spring.on_b)
                     : law.wrenches(has_a ? poses_[law.a] : fixed_pose, has_a ? twists_[law.a] : no_motion,
                                    has_b ? poses_[law.b] : fixed_pose, has_b ? twists_[law.b] : no_motion);
    if (has_a) wrenches_[law.a] += on_a;
    if (has_b) wrenches_[law.b] += on_b;
  }
}

/// Adds drag at the velocities in `twists_`.
template <class Real>
void SceneForces<Real>::add_drag() {
  for (const std::size_t body : acted_on_) {
    const Drag& drag = drags_[body];
    wrenches_[body].force -= drag.now * twists_[body].velocity;
    wrenches_[body].torque -= drag.angular * twists_[body].angular_velocity;
  }
}

template <class Real>
void SceneForces<Real>::apply(BasicWorld<Real>& world, double dt) {
  if (empty()) return;
  const double start = world.time(), end = start + dt;
  place(world);
  stiffen(world, dt);
  laws_.add(start, start + 0.5 * dt, poses_.data(), twists_.data(), wrenches_.data());
  add_springs(false);
  advance(world, dt);
  laws_.add(start, end, poses_.data(), twists_.data(), wrenches_.data());
  add_springs(true);
  add_drag();
  push(world);
}

template <class Real>
void SceneForces<Real>::apply_at_start(BasicWorld<Real>& world, double dt) {
  if (empty()) return;
  place(world);
  for (Spring& spring : springs_) spring.stiff = false;
  laws_.add(world.time(), world.time() + dt, poses_.data(), twists_.data(), wrenches_.data());
  add_springs(true);
  for (const std::size_t body : acted_on_) {
    Drag& drag = drags_[body];
    drag.now = drag.linear + drag.quadratic * std::sqrt(length_squared(twists_[body].velocity));
  }
  add_drag();
  push(world);
}

/// Hands the wrenches to the world; a force that is not finite quarantines its body.
template <class Real>
void SceneForces<Real>::push(BasicWorld<Real>& world) {
  for (const std::size_t body : acted_on_) {
    if (world.type(ids_[body]) != BodyType::Dynamic) continue;
    if (!is_sound(wrenches_[body])) {
      quarantine_pushed(settled(world), static_cast<int>(ids_[body].index), wrenches_[body]);
      continue;
    }
    world.apply_force(ids_[body], wrenches_[body].force);
    world.apply_torque(ids_[body], wrenches_[body].torque);
  }
}

template class SceneForces<float>;
template class SceneForces<double>;

}  // namespace plumb
