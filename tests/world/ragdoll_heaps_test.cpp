#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/math/trigonometry.h"
#include "tests/world/mechanisms.h"
#include "tests/world/support.h"

// Ragdolls of 15 parts, all of which collide, that fall on each other in a bin. Links get caught in each
// other. Nothing drives them: they may not hang where they are, while their weight speeds them up.
namespace plumb {
namespace {

using test::Draw;

class RagdollHeap {
 public:
  RagdollHeap(std::uint64_t seed, int ragdolls, bool direct_islands)
      : world_({.sleeping = false, .direct_islands = direct_islands}) {
    const auto fixed = [&](Vec2d at, double width, double height) {
      world_.create_body({.type = BodyType::Static, .position = at}, {.geometry = Box{width, height}});
    };
    fixed({0, -1}, 60, 2), fixed({-2.5, 8}, 1, 18), fixed({2.5, 8}, 1, 18);
    Draw draw(seed);
    for (int i = 0; i < ragdolls; ++i) {
      const double x = draw.in(-0.3, 0.3), angle = draw.in(0, 2 * std::numbers::pi);
      add({x, 1.6 + 2.4 * i}, angle);
    }
  }

  World& world() { return world_; }
  const std::vector<BodyId>& parts() const { return parts_; }

  // Returns the widest gap of a joint, m.
  double widest_gap() const {
    double widest = 0;
    for (const Hinge& hinge : hinges_) {
      const Vec2d gap =
          world_.world_point(hinge.b, hinge.anchor_b) - world_.world_point(hinge.a, hinge.anchor_a);
      widest = std::max(widest, std::sqrt(length_squared(gap)));
    }
    return widest;
  }

 private:
  struct Frame {
    Vec2d at;
    double angle;
    Vec2d point(Vec2d local) const { return at + rotation_of(angle) * local; }
  };
  BodyId part(const Frame& frame, Vec2d at, double width, double height) {
    parts_.push_back(
        world_.create_body({.position = frame.point(at), .angle = frame.angle},
                           {.geometry = Box{width, height}, .density = 100, .material = {.friction = 0.6}}));
    return parts_.back();
  }
  void hinge(const Frame& frame, BodyId a, BodyId b, Vec2d at, double lower, double upper) {
    const Vec2d point = frame.point(at);
    hinges_.push_back({a, b, world_.local_point(a, point), world_.local_point(b, point)});
    world_.create_joint(a, b,
                        {.kind = RevoluteDefinition{.anchor_a = hinges_.back().anchor_a,
                                                    .anchor_b = hinges_.back().anchor_b,
                                                    .limits = Range{lower, upper}}});
  }
  void add(Vec2d at, double angle) {
    const Frame frame{at, angle};
    const BodyId hips = part(frame, {0, 0}, 0.36, 0.25), torso = part(frame, {0, 0.4}, 0.4, 0.5),
                 head = part(frame, {0, 0.82}, 0.26, 0.28);
    hinge(frame, hips, torso, {0, 0.15}, -0.5, 0.5), hinge(frame, torso, head, {0, 0.66}, -0.6, 0.6);
    for (const double side : {-1.0, 1.0}) {
      const BodyId arm = part(frame, {side * 0.38, 0.58}, 0.36, 0.13),
                   forearm = part(frame, {side * 0.72, 0.58}, 0.32, 0.11),
                   hand = part(frame, {side * 0.94, 0.58}, 0.12, 0.1),
                   thigh = part(frame, {side * 0.11, -0.32}, 0.17, 0.45),
                   shin = part(frame, {side * 0.11, -0.75}, 0.14, 0.42),
                   foot = part(frame, {side * 0.16, -0.99}, 0.26, 0.08);
      hinge(frame, torso, arm, {side * 0.2, 0.58}, -1.5, 1.5);
      hinge(frame, arm, forearm, {side * 0.56, 0.58}, side > 0 ? -0.1 : -2.2, side > 0 ? 2.2 : 0.1);
      hinge(frame, forearm, hand, {side * 0.88, 0.58}, -0.5, 0.5);
      hinge(frame, hips, thigh, {side * 0.11, -0.1}, -1.3, 1.3);
      hinge(frame, thigh, shin, {side * 0.11, -0.54}, -2.2, 0.1);
      hinge(frame, shin, foot, {side * 0.11, -0.96}, -0.5, 0.5);
    }
  }

  struct Hinge {
    BodyId a, b;
    Vec2d anchor_a, anchor_b;
  };

  World world_;
  std::vector<BodyId> parts_;
  std::vector<Hinge> hinges_;
};

// Returns the kinetic energy, J, of the parts that move in a step by less than a fifth of their speed times
// the step: the mean of a second.
double energy_of_halted_parts(RagdollHeap& heap) {
  World& world = heap.world();
  double sum = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<Vec2d> before, velocities;
    for (const BodyId part : heap.parts())
      before.push_back(world.position(part)), velocities.push_back(world.velocity(part));
    world.step();
    for (std::size_t k = 0; k < before.size(); ++k) {
      const BodyId part = heap.parts()[k];
      const double way = std::sqrt(length_squared(world.position(part) - before[k]));
      if (60 * way < 0.2 * std::sqrt(length_squared(velocities[k])))
        sum += 0.5 * world.mass(part) * length_squared(velocities[k]);
    }
  }
  return sum / 60;
}

// A link that is caught may be pulled at by its joint without moving; 60 J are those of 10 kg after 0.6 m.
TEST(RagdollHeaps, DoNotHangInTheAirWhileTheirWeightSpeedsThemUp) {
  struct Case {
    int ragdolls;
    bool direct_islands;
  };
  for (const auto& [ragdolls, direct_islands] : {Case{6, true}, Case{3, false}}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      RagdollHeap heap(seed, ragdolls, direct_islands);
      run(heap.world(), 300);
      EXPECT_LT(energy_of_halted_parts(heap), 60)
          << ragdolls << " ragdolls, seed " << seed << (direct_islands ? "" : ", without direct islands");
    }
  }
}

// Returns the mean over the heaps of `seeds` of the widest gap in the fifth second, m.
double mean_widest_gap(int ragdolls, bool direct_islands, std::uint64_t seeds) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    RagdollHeap heap(seed, ragdolls, direct_islands);
    run(heap.world(), 240);
    double widest = 0;
    for (int i = 0; i < 60; ++i) heap.world().step(), widest = std::max(widest, heap.widest_gap());
    sum += widest;
  }
  return sum / static_cast<double>(seeds);
}

// The thinnest part is 8 cm thick: nothing stays between two parts whose joint is open by less than half.
TEST(RagdollHeaps, KeepTheirJointsClosed) { EXPECT_LT(mean_widest_gap(6, true, 8), 0.04); }

TEST(RagdollHeaps, ThatAreSolvedByIterationsLetNothingStayInTheirJoints) {
  EXPECT_LT(mean_widest_gap(6, false, 8), 0.08);
}

}  // namespace
}  // namespace plumb
