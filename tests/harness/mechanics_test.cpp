// Holds the energy and the gaps of joints that the harness measures against engines that are 2 % wrong.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "harness/bounds.h"
#include "harness/energy.h"
#include "harness/joint_gap.h"
#include "harness/run.h"
#include "tests/harness/fakes.h"

namespace plumb::harness {
namespace {

using namespace fakes;
using reference::Scheme;

constexpr double kDt = 1.0 / 60, kG = 9.81;

Result run_fake(const scenarios::Problem& problem, Motion motion, reference::Method how) {
  const scenarios::Scenario scenario = family([&] { return problem; });
  const Case scene_case({&scenario, "", 1}, kDt);
  return run(scene_case, FakeBackend("fake", std::move(motion), how), {});
}

bool passes(const Result& result, std::string_view name) {
  const Check* check = result.find_check(name);
  EXPECT_NE(check, nullptr) << name;
  return check != nullptr && check->pass;
}

// ---- Gravity scale

// The ball of `thrown`, which falls `scale` times as fast.
void fall(double scale, double t, std::span<BodyState> out) {
  out[0] = {{1 + 3 * t, 2 + 4 * t - scale * kG * t * t / 2}, 2 * t, {3, 4 - scale * kG * t}, 2};
}

scenarios::Problem thrown_with(double scale) {
  scenarios::Problem problem = thrown();
  problem.scene.bodies[0].gravity_scale = scale;
  problem.truth.exact = [scale](double t, std::span<BodyState> out) { fall(scale, t, out); };
  return problem;
}

TEST(GravityScale, IsPartOfTheEnergy) {
  const auto second = method(Scheme::VelocityVerlet, 2);
  for (const double scale : {-1.0, 0.0, 0.5, 1.0, 3.0}) {
    const scenarios::Problem problem = thrown_with(scale);
    const Result right = run_fake(problem, exactly(problem), second);
    EXPECT_LT(*right.metrics.energy_drift, 1e-13) << scale;
    EXPECT_TRUE(passes(right, "energy_drift")) << scale;
    for (const double wrong : {scale + 0.02, scale - 0.02, scale == 1 ? 0.0 : 1.0}) {
      const Result result = run_fake(
          problem,
          [wrong](long step, double dt, std::span<BodyState> out) {
            fall(wrong, static_cast<double>(step) * dt, out);
          },
          second);
      // Kinetic energy follows one gravity, potential energy the other: they part by m g (scale - wrong) (y -
      // 2).
      double drift = 0, highest = 0;
      for (int k = 0; k <= 120; ++k) {
        const double t = k * kDt;
        const double up = 4 * t - wrong * kG * t * t / 2, truly_up = 4 * t - scale * kG * t * t / 2;
        drift = std::max(drift, 2 * kG * std::abs((scale - wrong) * up));
        highest = std::max(highest, -2 * kG * scale * truly_up);
      }
      // At the start 2 (9 + 16)/2 + 0.5 4/2 = 26 J, and what lies below it.
      EXPECT_NEAR(*result.metrics.energy_drift, drift / (26 + highest), 1e-12) << scale << " " << wrong;
      EXPECT_FALSE(passes(result, "energy_drift")) << scale << " " << wrong;
    }
  }
}

// Gravity three times as strong for all is a gravity scale of three for all: the same motion, the same
// bounds.
TEST(GravityScale, IsPartOfEachBound) {
  for (const bool jointed : {false, true}) {
    for (const bool known : {false, true}) {
      for (const int order : {1, 2}) {
        scenarios::Problem strong = thrown_with(1), scaled = thrown_with(3);
        strong.scene.gravity = 3.0 * scaled.scene.gravity;
        for (scenarios::Problem* problem : {&strong, &scaled}) {
          problem->truth.exact = [](double t, std::span<BodyState> out) { fall(3, t, out); };
          if (!known) problem->truth.exact = nullptr;
          problem->conserved.angular_momentum = true;
          if (jointed)
            problem->scene.joints = {DistanceJoint{
                .name = "rope", .body_a = std::string(kWorld), .body_b = "ball", .range = Range{0, 1e3}}};
        }
        const auto bounds = [&](const scenarios::Problem& problem) {
          const TruthTable truth(problem, kDt);
          const ConservationScale scale = conservation_scale(problem.scene, truth);
          const reference::Method how =
              method(order == 1 ? Scheme::SemiImplicitEuler : Scheme::VelocityVerlet, order);
          const Tolerances all(problem, truth, how, {.dt = kDt}, scale);
          const StateBound rounding = all.rounding(60);
          std::vector<double> out = {scale.energy,        scale.momentum,       scale.angular_momentum,
                                     truth.scale().speed, truth.scale().extent, rounding.position,
                                     rounding.velocity};
          for (const auto& bound : {all.position(60, 0), all.velocity(60, 0), all.energy(60),
                                    all.momentum(60), all.angular_momentum(60), all.penetration(60)})
            out.push_back(bound.value_or(-1));
          return out;
        };
        const std::vector<double> one = bounds(strong), other = bounds(scaled);
        for (std::size_t i = 0; i < one.size(); ++i)
          EXPECT_NEAR(one[i], other[i], 1e-12 * std::abs(one[i])) << i << " " << jointed << known << order;
      }
    }
  }
}

// ---- Gaps of joints

constexpr double kTurn = std::numbers::pi / 6;
const Vec2d kAlong{std::cos(kTurn), std::sin(kTurn)}, kAcross{-std::sin(kTurn), std::cos(kTurn)};

// A rail that is turned by 30 degrees about (1, 1), and a slider whose anchor is `along` and `across` it from
// the rail's own anchor.
std::vector<BodyState> on_rail(double along, double across, double slider_angle = 0.4) {
  const Vec2d rail{1, 1}, anchor_a = 0.5 * kAlong,
                          anchor_b{0.3 * std::cos(slider_angle), 0.3 * std::sin(slider_angle)};
  return {{rail, kTurn, {}, 0},
          {rail + anchor_a + along * kAlong + across * kAcross - anchor_b, slider_angle, {}, 0}};
}

template <class Kind>
Scene railed(std::optional<Range> limits = {}) {
  Scene scene;
  scene.bodies = {{.name = "rail"}, {.name = "slider"}};
  Kind joint;
  joint.name = "slide", joint.body_a = "rail", joint.body_b = "slider";
  joint.anchor_a = {0.5, 0}, joint.anchor_b = {0.3, 0}, joint.axis = {3, 0}, joint.limits = limits;
  scene.joints = {joint};
  return scene;
}

template <class Kind>
void expect_gaps_of_axes() {
  const JointGaps free(railed<Kind>()), limited(railed<Kind>(Range{-1, 2}));
  for (const double along : {-5.0, -1.02, -0.98, 0.0, 1.98, 2.02, 7.0}) {
    for (const double across : {-0.02, 0.0, 0.02}) {
      EXPECT_NEAR(free.gap(0, on_rail(along, across)), std::abs(across), 1e-14);
      const double beyond = std::max({along - 2, -1 - along, 0.0});
      EXPECT_NEAR(limited.gap(0, on_rail(along, across)), std::hypot(across, beyond), 1e-14);
    }
  }
}

TEST(JointGap, OfAPrismaticJointIsFromTheStretchOfItsAxis) { expect_gaps_of_axes<PrismaticJoint>(); }
TEST(JointGap, OfAWheelIsFromTheStretchOfItsAxis) { expect_gaps_of_axes<WheelJoint>(); }

TEST(JointGap, OfAPulleyIsWhatItsRopeIsOff) {
  Scene scene;
  scene.bodies = {{.name = "a", .position = {0, -1}}, {.name = "b", .position = {3, -2}}};
  scene.joints = {PulleyJoint{
      .name = "rope", .body_a = "a", .body_b = "b", .ground_a = {0, 0}, .ground_b = {3, 0}, .ratio = 2}};
  const JointGaps gaps(scene);
  std::vector<BodyState> states = {{{0, -1}, 0, {}, 0}, {{3, -2}, 0, {}, 0}};
  EXPECT_NEAR(gaps.gap(0, states), 0, 1e-15);
  states[0].position.y = -1.5, states[1].position.y = -1.75;  // b takes twice the energy that a gives
  EXPECT_NEAR(gaps.gap(0, states), 0, 1e-15);
  states[1].position.y = -1.74;
  EXPECT_NEAR(gaps.gap(0, states), 0.02, 1e-15);
  EXPECT_EQ(gaps.end_b(0).gain, 2);
}

// A sleeve of 1 kg that slides down a rail in the world: s = g sin(30 degrees) t^2/2.
template <class Kind>
scenarios::Problem sliding() {
  scenarios::Problem problem;
  problem.scene.name = "sliding";
  problem.scene.bodies = {{.name = "sleeve", .mass = 1, .inertia = 1, .shapes = {{.geometry = Circle{0.1}}}}};
  Kind joint;
  joint.name = "slide", joint.body_a = std::string(kWorld), joint.body_b = "sleeve", joint.axis = kAlong;
  problem.scene.joints = {joint};
  problem.duration = 1;
  problem.precise = {.position = 1e-3, .angle = 1e-3};
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    const double a = -kG * std::sin(kTurn);
    out[0] = {a * t * t / 2 * kAlong, 0, a * t * kAlong, 0};
  };
  return problem;
}

template <class Kind>
void expect_leaving_the_rail_to_fail() {
  const scenarios::Problem problem = sliding<Kind>();
  const auto off = [&](Vec2d way) {
    return run_fake(
        problem,
        [exact = exactly(problem), way](long step, double dt, std::span<BodyState> out) {
          exact(step, dt, out);
          out[0].position += way;
        },
        method(Scheme::Adaptive, 0));
  };
  EXPECT_LT(*off({}).metrics.joint_gap, 1e-15);
  EXPECT_LT(*off(0.5 * kAlong).metrics.joint_gap, 1e-15) << "along the axis is no gap";
  EXPECT_NEAR(*off(0.02 * kAcross).metrics.joint_gap, 0.02, 1e-15);
  EXPECT_TRUE(passes(off(0.98e-3 * kAcross), "joint_gap"));
  EXPECT_FALSE(passes(off(-1.02e-3 * kAcross), "joint_gap"));
}

TEST(JointGap, AnEngineThatLetsASliderLeaveItsAxisFails) {
  expect_leaving_the_rail_to_fail<PrismaticJoint>();
  expect_leaving_the_rail_to_fail<WheelJoint>();
}

// An axis at a body that may be turned by 1e-3 rad: what sits on it 5 m away is off by 5 mm, and no wrong
// engine.
TEST(JointGap, OfALongRailMayBeWhatItsAngleMakesOfIt) {
  scenarios::Problem problem;
  problem.scene.name = "rail";
  problem.scene.gravity = {0, 0};
  problem.scene.bodies = {
      {.name = "rail", .mass = 1, .inertia = 1, .shapes = {{.geometry = Circle{0.1}}}},
      {.name = "sleeve", .position = {5, 0}, .mass = 1, .inertia = 1, .shapes = {{.geometry = Circle{0.1}}}}};
  problem.scene.joints = {PrismaticJoint{.name = "slide", .body_a = "rail", .body_b = "sleeve"}};
  problem.duration = 1;
  problem.precise = {.position = 1e-3, .angle = 1e-3};
  problem.truth.exact = [](double, std::span<BodyState> out) {
    out[0] = {};
    out[1] = {{5, 0}, 0, {}, 0};
  };
  const auto off = [&](double share) {
    return run_fake(
        problem,
        [exact = exactly(problem), share](long step, double dt, std::span<BodyState> out) {
          exact(step, dt, out);
          out[0].angle = share * 1e-3;
          out[0].position.y = share * 1e-3, out[1].position.y = -share * 1e-3;
        },
        method(Scheme::Adaptive, 0));
  };
  // The bound is 1 mm + 1 mm + 5 m 1e-3 rad = 7 mm, and that is reached.
  const Result within = off(0.98), beyond = off(1.02);
  EXPECT_NEAR(within.find_check("joint_gap")->tolerance, 7e-3, 1e-12);
  EXPECT_NEAR(*within.metrics.joint_gap, 0.98 * 7e-3, 1e-8);
  EXPECT_TRUE(passes(within, "joint_gap"));
  EXPECT_FALSE(passes(beyond, "joint_gap"));
}

}  // namespace
}  // namespace plumb::harness
