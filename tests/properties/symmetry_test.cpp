// Checks what physics does not depend on: the frame, the units, the order and names of things, and the pieces
// into which time is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "engine/scene/error.h"
#include "tests/properties/check.h"
#include "tests/properties/runs.h"

namespace plumb::properties {
namespace {

constexpr std::array<bool, kTies> kEveryTie{false, true, true, true, true, true, true, true, true, true};
constexpr std::array<bool, kTies> kInternalTies{false, true, true, true, true, true, true, true};

/// Everything that a scene may have, and less of it.
const Recipe kFlight{.ties = {false, false, false, false, false, false, true, true, true}, .contacts = false};
const Recipe kMechanism{.ties = kEveryTie, .gravity = true, .contacts = false};
const Recipe kBilliard{.ties = kInternalTies};
const Recipe kPile{.ties = kEveryTie, .gravity = true, .walls = true};

struct Case {
  const char* name;
  const Recipe& recipe;
};
const Case kCases[] = {
    {"flight", kFlight}, {"mechanism", kMechanism}, {"billiard", kBilliard}, {"pile", kPile}};

/// Changes a scene's view, and a state's to the same one.
struct View {
  std::function<Scene(const Scene&)> scene;
  std::function<BodyState(const BodyState&)> state;
};

/// Times a disturbance that a run without a fork makes of it in its time, at most.
constexpr double kFork = 100;

/// Ends that are `apart` are so by no more than disturbances of `by` make of it. Twice: the disturbed runs
/// may go to the one side, and what is seen to the other. A fork that six of them do not show, 60 more do.
void expect_near(Engine engine, const Scene& scene, const States& end, double apart, double by,
                 const Steps& steps = {}) {
  constexpr unsigned kFew = 6, kMany = 60;
  double bound = 2 * sensitivity(engine, scene, end, by, steps, 1, kFew);
  if (apart > bound && bound <= kFork * by)
    bound = std::max(bound, 2 * sensitivity(engine, scene, end, by, steps, 1 + kFew, kMany));
  RC_PRE(bound <= kFork * by);  // else the motion comes to a fork
  RC_LOG() << name_of(engine) << ": " << apart << " apart, " << bound << " allowed\n";
  RC_ASSERT(apart <= bound);
}

/// The run of the changed scene ends where the change of the run's end is, but for what a disturbance of a
/// thousand roundings does to it; `rounding` is how much coarser numbers are in the changed view.
void expect_same(Engine engine, const Scene& scene, const View& view, double rounding = 1,
                 const Steps& steps = {}) {
  const States end = run(engine, scene, steps), seen = run(engine, view.scene(scene), steps);
  States moved = end;
  for (BodyState& state : moved) state = view.state(state);
  expect_near(engine, scene, end, difference(moved, seen), rounding * disturbance(engine), steps);
}

class Symmetry : public testing::TestWithParam<std::tuple<Engine, Case>> {
 protected:
  Engine engine() const { return std::get<0>(GetParam()); }
  const Recipe& recipe() const { return std::get<1>(GetParam()).recipe; }
  std::size_t most() const { return engine() == Engine::Precise ? 4 : 8; }
  void check(const std::function<void(const Scene&)>& property, int cases = 20) const {
    check(recipe(), property, cases);
  }
  void check(const Recipe& sample, const std::function<void(const Scene&)>& property, int cases = 20) const {
    check_property(recipes(sample, most()), engine() == Engine::Precise ? cases / 4 : cases,
                   [&](const Recipe& made) { property(scene_of(made)); });
  }
};

std::string case_name(const testing::TestParamInfo<std::tuple<Engine, Case>>& one) {
  return name_of(std::get<0>(one.param)) + "_" + std::get<1>(one.param).name;
}

INSTANTIATE_TEST_SUITE_P(All, Symmetry,
                         testing::Combine(testing::ValuesIn(kEngines), testing::ValuesIn(kCases)), case_name);

TEST_P(Symmetry, Mirror) {
  check([&](const Scene& scene) {
    expect_same(engine(), scene,
                {[](const Scene& s) { return mirrored(s); }, [](const BodyState& s) { return mirrored(s); }});
  });
}

TEST_P(Symmetry, RightAngle) {
  check([&](const Scene& scene) {
    expect_same(engine(), scene,
                {[](const Scene& s) { return turned(s); }, [](const BodyState& s) { return turned(s); }});
  });
}

TEST_P(Symmetry, Shift) {
  check([&](const Scene& scene) {
    const double by = std::exp2(*rc::gen::inRange(0, 11));
    const Vec2d way{by, -by};
    expect_same(engine(), scene,
                {[&](const Scene& s) { return shifted(s, way); },
                 [&](BodyState s) {
                   s.position += way;
                   return s;
                 }},
                std::max(1.0, by / 10));
  });
}

TEST_P(Symmetry, OrderOfNames) {
  check([&](const Scene& scene) {
    std::vector<std::size_t> order(scene.bodies.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(*rc::gen::arbitrary<unsigned>()));
    Scene other = scene;
    for (std::size_t i = 0; i < order.size(); ++i) other.bodies[i] = scene.bodies[order[i]];
    const States end = run(engine(), scene), seen = run(engine(), other);
    States back(end.size());
    for (std::size_t i = 0; i < order.size(); ++i) back[order[i]] = seen[i];
    expect_near(engine(), scene, end, difference(end, back), disturbance(engine()));
  });
}

/// Units that are powers of two change no digit of any number; of mass, of four: roots of it are taken.
TEST_P(Symmetry, UnitsOfLengthAndMass) {
  check([&](const Scene& scene) {
    const double length = std::exp2(*about(12)), mass = std::exp2(2 * *about(6));
    States end = run(engine(), scene);
    const States seen = run(engine(), scaled(scene, length, 1, mass));
    for (BodyState& state : end) state = scaled(state, length, 1);
    RC_LOG() << "length " << length << ", mass " << mass << ": " << difference(end, seen) << " apart\n";
    RC_ASSERT(end == seen);
  });
}

/// Deep overlaps are pushed out by so many extents a second: attraction, which makes them, is left out with
/// contacts. So are joints in a World: gaps that contacts have pulled open are closed by so many arms a
/// second.
TEST_P(Symmetry, UnitsOfTime) {
  Recipe without = recipe();
  without.ties[kPull] = without.ties[kPull] && !without.contacts;
  const bool is_world = engine() == Engine::World || engine() == Engine::DoubleWorld;
  if (is_world && without.contacts)
    for (const Ties tie : {kRevolute, kRod, kWeld, kSoftRod, kSlider, kPinned}) without.ties[tie] = false;
  check(without, [&](const Scene& scene) {
    const double time = std::exp2(*about(8));
    const Steps steps;
    States end = run(engine(), scene, steps);
    const States seen = run(engine(), scaled(scene, 1, time, 1), {steps.dt * time, steps.count});
    for (BodyState& state : end) state = scaled(state, 1, time);
    RC_LOG() << "time " << time << ": " << difference(end, seen) << " apart\n";
    RC_ASSERT(end == seen);
  });
}

class InertialFrames : public Symmetry {};
INSTANTIATE_TEST_SUITE_P(All, InertialFrames,
                         testing::Combine(testing::ValuesIn(kEngines),
                                          testing::Values(Case{"billiard", kBilliard})),
                         case_name);

TEST_P(InertialFrames, Boost) {
  // Forces on a body act in substeps while something is near, in a World, and how near depends on the frame.
  Recipe sample = recipe();
  if (engine() == Engine::World || engine() == Engine::DoubleWorld)
    sample.ties[kSpring] = sample.ties[kPull] = false;
  check(sample, [&](const Scene& scene) {
    const double speed = std::exp2(*rc::gen::inRange(0, 6));
    // Continuous collision asks how fast bodies are in the world's frame.
    const Steps steps{.continuous = false};
    const Vec2d by{speed, -0.5 * speed};
    expect_same(engine(), scene,
                {[&](const Scene& s) { return boosted(s, by); },
                 [&](BodyState s) {
                   s.position += (steps.dt * steps.count) * by;
                   s.velocity += by;
                   return s;
                 }},
                1 + speed / 5, steps);
  });
}

}  // namespace
}  // namespace plumb::properties
