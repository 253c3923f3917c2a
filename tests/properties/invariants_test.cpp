// Checks what motion keeps: momentum if nothing pushes from outside, energy if nothing drives, its way back,
// and its bits however time is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/simulation/simulation.h"
#include "engine/world/scene/scene_forces.h"
#include "engine/world/snapshot.h"
#include "tests/properties/check.h"
#include "tests/properties/runs.h"

namespace plumb::properties {
namespace {

/// Of all bodies that are not static.
struct Sums {
  double mass = 0;
  Vec2d momentum{}, moment{};  ///< kg m/s; kg m, of the positions
  double angular = 0;          ///< kg m^2/s, about the origin
  double energy = 0;           ///< J, of motion and weight
  double size = 0;             ///< kg m/s: what roundings are relative to
};

Sums sums_of(const Scene& scene, const States& states) {
  Sums sums;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.type == BodyType::Static) continue;
    const BodyState& s = states[i];
    const double inertia = inertia_of(body), speed = std::sqrt(length_squared(s.velocity));
    sums.mass += body.mass;
    sums.momentum += body.mass * s.velocity;
    sums.moment += body.mass * s.position;
    sums.angular += body.mass * cross(s.position, s.velocity) + inertia * s.angular_velocity;
    sums.energy += 0.5 * (body.mass * speed * speed + inertia * s.angular_velocity * s.angular_velocity) -
                   body.mass * dot(scene.gravity, s.position);
    sums.size += body.mass * (1 + speed) * (1 + std::sqrt(length_squared(s.position))) +
                 inertia * (1 + std::abs(s.angular_velocity));
  }
  return sums;
}

/// The scene as it is at `states`, on its way (`sign` 1) or back (-1).
Scene going_on(Scene scene, const States& states, double sign) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    Body& body = scene.bodies[i];
    body.position = states[i].position, body.angle = states[i].angle;
    body.velocity = sign * states[i].velocity, body.angular_velocity = sign * states[i].angular_velocity;
  }
  return scene;
}

States start_of(const Scene& scene) {
  States states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  return states;
}

class Invariants : public testing::TestWithParam<Engine> {
 protected:
  Engine engine() const { return GetParam(); }
  void check(const Recipe& sample, const std::function<void(const Scene&)>& property, int cases = 30) const {
    const bool precise = engine() == Engine::Precise;
    check_property(recipes(sample, precise ? 4 : 8), precise ? cases / 4 : cases,
                   [&](const Recipe& made) { property(scene_of(made)); });
  }
};

INSTANTIATE_TEST_SUITE_P(All, Invariants, testing::ValuesIn(kEngines),
                         [](const auto& one) { return name_of(one.param); });

TEST_P(Invariants, MomentumOfWhatIsLeftAlone) {
  const auto keeps = [&](const Scene& scene, bool angular) {
    const Steps steps;
    const Sums before = sums_of(scene, start_of(scene)), after = sums_of(scene, run(engine(), scene, steps));
    const double bound = disturbance(engine()) * std::max(before.size, after.size);
    const Vec2d pushed = after.momentum - before.momentum;
    const Vec2d strayed = after.moment - before.moment - (steps.dt * steps.count) * before.momentum;
    RC_LOG() << "momentum " << pushed.x << " " << pushed.y << ", centre " << strayed.x << " " << strayed.y
             << ", angular momentum " << after.angular - before.angular << ", allowed " << bound << "\n";
    RC_ASSERT(std::abs(pushed.x) <= bound);
    RC_ASSERT(std::abs(pushed.y) <= bound);
    // A World's impulses act along the lines of the step's start, which bodies leave by as much as they move
    // in a step, and its continuous collision takes fast bodies back along their way: there neither is kept.
    if (engine() == Engine::World || engine() == Engine::DoubleWorld) return;
    RC_ASSERT(std::abs(strayed.x) <= bound);
    RC_ASSERT(std::abs(strayed.y) <= bound);
    if (angular) RC_ASSERT(std::abs(after.angular - before.angular) <= bound);
  };
  Recipe tied;
  for (const int tie : {kRevolute, kRod, kWeld, kSoftRod, kSlider, kSpring, kPull})
    tied.ties[static_cast<std::size_t>(tie)] = true;
  check(tied, [&](const Scene& scene) { keeps(scene, true); });
}

TEST_P(Invariants, EnergyDoesNotGrowWhereNothingDrives) {
  Recipe sample{.gravity = true, .walls = true};
  for (const int tie : {kRevolute, kRod, kWeld, kSlider, kDrag, kPinned})
    sample.ties[static_cast<std::size_t>(tie)] = true;
  check(sample, [&](const Scene& scene) {
    // Nothing is lower than this, so that what weight can still give counts as well.
    const auto above_floor = [&](const Sums& sums) { return sums.energy + 9.81 * 2 * sums.mass; };
    const double before = above_floor(sums_of(scene, start_of(scene)));
    double most = before;
    for (const int count : {4, 16, 48, 96})
      most = std::max(most, above_floor(sums_of(scene, run(engine(), scene, {1.0 / 64, count}))));
    RC_LOG() << before << " J, then " << most << " J\n";
    RC_ASSERT(most <= before * (1 + (engine() == Engine::Precise ? 1e-7 : 0.02)));
  });
}

/// Pieces of time, and a run that goes on from bytes, give the bits of the run that was left alone.
TEST_P(Invariants, TimeMayBeCut) {
  Recipe sample{.gravity = true, .walls = true};
  sample.ties.fill(true);
  const auto same = [](auto make, int first, int second) {
    auto whole = make(), cut = make(), restored = make();
    whole(first + second);
    cut(first), restored(1);
    const std::vector<std::byte> bytes = cut.bytes();
    restored.take(bytes);
    cut(second), restored(second);
    RC_ASSERT(cut.hash() == whole.hash());
    RC_ASSERT(restored.hash() == whole.hash());
  };
  check(sample, [&](const Scene& scene) {
    const int first = *rc::gen::inRange(0, 40), second = *rc::gen::inRange(0, 40);
    if (engine() == Engine::Precise) {
      struct Run {
        Simulation simulation;
        void operator()(int count) { simulation.step(count); }
        std::vector<std::byte> bytes() const { return simulation.save(); }
        void take(const std::vector<std::byte>& bytes) { simulation.restore(bytes); }
        std::uint64_t hash() const { return simulation.hash(); }
      };
      same([&] { return Run{compile(scene, Precise{.tolerance = 1e-8})}; }, first, second);
      return;
    }
    const auto worlds = [&]<class Real>(Real) {
      struct Run {
        BasicWorld<Real> world;
        SceneParts parts;
        SceneForces<Real> forces;
        explicit Run(const Scene& s)
            : world(world_definition(s)), parts(add_scene(world, s)), forces(s, parts) {}
        void operator()(int count) {
          for (int i = 0; i < count; ++i) forces.apply(world, 1.0 / 60), world.step();
        }
        std::vector<std::byte> bytes() const { return save(world); }
        void take(const std::vector<std::byte>& bytes) { restore(world, bytes); }
        std::uint64_t hash() const { return world.hash(); }
      };
      same([&] { return Run(scene); }, first, second);
    };
    engine() == Engine::World ? worlds(1.0F) : worlds(1.0);
  });
}

/// Motion by forces alone comes back the way that it went.
TEST(PreciseInvariants, SmoothMotionGoesBackAsItCame) {
  Recipe sample{.gravity = true, .contacts = false};
  for (const int tie : {kRevolute, kRod, kWeld, kSlider, kSpring, kPull, kPinned})
    sample.ties[static_cast<std::size_t>(tie)] = true;
  check_property(recipes(sample, 5), 15, [&](const Recipe& made) {
    // Joints take velocities that they do not allow away at once: from there on all is smooth.
    const Scene made_up = scene_of(made);
    const Scene scene = going_on(made_up, run(Engine::Precise, made_up, {1.0 / 64, 1}), 1);
    const Steps steps{1.0 / 64, 32};
    const States end = run(Engine::Precise, scene, steps);
    const States start = start_of(scene);
    const Scene back = going_on(scene, end, -1);
    States home = run(Engine::Precise, back, steps);
    for (BodyState& state : home)
      state.velocity = -state.velocity, state.angular_velocity = -state.angular_velocity;
    const double bound = sensitivity(Engine::Precise, back, run(Engine::Precise, back, steps),
                                     disturbance(Engine::Precise), steps);
    RC_LOG() << difference(home, start) << " apart, " << bound << " allowed\n";
    RC_ASSERT(difference(home, start) <= bound);
  });
}

}  // namespace
}  // namespace plumb::properties
