// Checks what must hold of any scenario: a new file is covered without an edit here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "engine/scene/json.h"
#include "engine/scene/validate.h"
#include "harness/penetration.h"
#include "scenarios/scenario.h"
#include "tests/scenarios/physics.h"

namespace plumb::scenarios {

void PrintTo(const Instance& instance, std::ostream* out) { *out << instance.label(); }

namespace testing {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

std::vector<Instance> every_instance() {
  std::vector<Instance> instances;
  for (const Scenario& scenario : all())
    for (const Instance& instance : select(scenario.name)) instances.push_back(instance);
  return instances;
}

class EveryScenario : public ::testing::TestWithParam<Instance> {
 protected:
  std::vector<BodyState> exact(double time) const {
    std::vector<BodyState> states(problem.scene.bodies.size());
    problem.truth.exact(time, states);
    return states;
  }

  /// Times that are on no grid, `margin` or more away from the ends and from impacts.
  std::vector<double> samples(double margin) const {
    std::vector<double> times;
    for (int k = 0; k < 17; ++k) {
      const double time = problem.duration * (k + 0.37) / 17;
      const bool clear = std::ranges::none_of(
          problem.truth.impacts, [&](double impact) { return std::fabs(time - impact) <= margin; });
      if (clear && time > margin) times.push_back(time);
    }
    return times;
  }

  const Problem problem = GetParam().build();
};

TEST_P(EveryScenario, IsAValidSceneThatSurvivesJson) {
  EXPECT_NO_THROW(validate(problem.scene));
  EXPECT_EQ(scene_from_json(to_json(problem.scene)), problem.scene);
  EXPECT_EQ(problem.scene.name, GetParam().label());
  EXPECT_FALSE(GetParam().scenario->summary.empty());
  EXPECT_GT(problem.duration, 0);
}

TEST_P(EveryScenario, BuildsTheSameProblemAgain) { EXPECT_EQ(GetParam().build().scene, problem.scene); }

TEST_P(EveryScenario, NamesItsTruth) {
  EXPECT_FALSE(problem.truth.source.empty());
  ASSERT_TRUE(problem.truth.exact);
  EXPECT_TRUE(std::ranges::is_sorted(problem.truth.impacts));
  for (const double time : problem.truth.impacts) {
    EXPECT_GT(time, 0);
    EXPECT_LT(time, problem.duration);
  }
}

TEST_P(EveryScenario, StatesNoNegativeBound) {
  for (const Bounds& b : {problem.precise, problem.second_order})
    for (const double bound : {b.position, b.angle, b.velocity, b.angular_velocity, b.energy, b.momentum,
                               b.angular_momentum, b.joint_gap, b.penetration})
      EXPECT_TRUE(std::isnan(bound) || bound >= 0) << bound;
}

TEST_P(EveryScenario, StartsWhereTheSceneDoes) {
  const auto states = exact(0);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState start = initial_state(problem.scene.bodies[i]), &state = states[i];
    const double place = 4 * kEpsilon * (norm(start.position) + 1),
                 speed = 4 * kEpsilon * (norm(start.velocity) + 1);
    EXPECT_LE(norm(state.position - start.position), place) << problem.scene.bodies[i].name;
    EXPECT_LE(norm(state.velocity - start.velocity), speed) << problem.scene.bodies[i].name;
    EXPECT_DOUBLE_EQ(state.angle, start.angle) << problem.scene.bodies[i].name;
    EXPECT_DOUBLE_EQ(state.angular_velocity, start.angular_velocity) << problem.scene.bodies[i].name;
  }
}

TEST_P(EveryScenario, GivesTheSameAnswerInAnyOrder) {
  const double t = problem.duration;
  const auto late = exact(t), early = exact(0.31 * t);
  EXPECT_EQ(exact(t), late);
  EXPECT_EQ(exact(0.31 * t), early);
}

/// A value of the exact motion and what should be its rate.
struct Pair {
  std::function<double(const BodyState&)> value;
  std::function<double(std::size_t, const BodyState&, double time)> rate;
  const char* name;
};

/// Central differences of the fourth order; what they leave out is judged from twice the step.
void expect_derivatives(const std::function<std::vector<BodyState>(double)>& exact, double time, double delta,
                        std::span<const Pair> pairs) {
  std::array<std::vector<BodyState>, 9> around;
  for (int k = -4; k <= 4; ++k) around[k + 4] = exact(time + k * delta);
  for (std::size_t i = 0; i < around[4].size(); ++i) {
    for (const auto& [value, rate, name] : pairs) {
      const auto at = [&](int k) { return value(around[k + 4][i]); };
      const auto difference = [&](int k) {
        return (8 * (at(k) - at(-k)) - (at(2 * k) - at(-2 * k))) / (12 * k * delta);
      };
      // The values are rounded, and so are the times at which they are taken.
      const double expected = rate(i, around[4][i], time);
      const double rounding = 4 * kEpsilon * (1 + std::fabs(at(0)) + std::fabs(time * expected)) / delta;
      const double truncation = std::fabs(difference(2) - difference(1)) / 5;
      EXPECT_NEAR(difference(1), expected, rounding + truncation)
          << name << " of body " << i << " at " << time;
    }
  }
}

TEST_P(EveryScenario, VelocityIsTheRateOfPosition) {
  const double delta = 1e-4 * std::min(1.0, problem.duration);
  const std::array pairs = {
      Pair{[](const BodyState& s) { return s.position.x; },
           [](std::size_t, const BodyState& s, double) { return s.velocity.x; }, "x"},
      Pair{[](const BodyState& s) { return s.position.y; },
           [](std::size_t, const BodyState& s, double) { return s.velocity.y; }, "y"},
      Pair{[](const BodyState& s) { return s.angle; },
           [](std::size_t, const BodyState& s, double) { return s.angular_velocity; }, "angle"}};
  for (const double time : samples(5 * delta))
    expect_derivatives([&](double t) { return exact(t); }, time, delta, pairs);
}

TEST_P(EveryScenario, AccelerationIsWhatTheForcesGive) {
  if (!problem.scene.joints.empty()) GTEST_SKIP() << "joint forces are the truth's own affair";
  if (problem.truth.contacts_last) GTEST_SKIP() << "contacts push as well";
  const double delta = 1e-4 * std::min(1.0, problem.duration);
  const Scene& scene = problem.scene;
  const std::array pairs = {Pair{[](const BodyState& s) { return s.velocity.x; },
                                 [&](std::size_t i, const BodyState&, double t) {
                                   return acceleration(scene, i, exact(t), t).linear.x;
                                 },
                                 "vx"},
                            Pair{[](const BodyState& s) { return s.velocity.y; },
                                 [&](std::size_t i, const BodyState&, double t) {
                                   return acceleration(scene, i, exact(t), t).linear.y;
                                 },
                                 "vy"},
                            Pair{[](const BodyState& s) { return s.angular_velocity; },
                                 [&](std::size_t i, const BodyState&, double t) {
                                   return acceleration(scene, i, exact(t), t).angular;
                                 },
                                 "w"}};
  for (const double time : samples(5 * delta))
    expect_derivatives([&](double t) { return exact(t); }, time, delta, pairs);
}

TEST_P(EveryScenario, KeepsWhatItSaysIsConserved) {
  std::vector<Totals> run = {totals(problem.scene, exact(0))};
  for (const double time : samples(0)) run.push_back(totals(problem.scene, exact(time)));
  const auto expect_kept = [&](bool conserved, Total Totals::*total, const char* name) {
    if (!conserved) return;
    // Each rounded term is off by an epsilon or two of its own size.
    double scale = 0;
    for (const Totals& now : run) scale = std::max(scale, (now.*total).scale);
    for (const Totals& now : run)
      EXPECT_NEAR((now.*total).value, (run[0].*total).value, 3 * kEpsilon * scale) << name;
  };
  expect_kept(problem.conserved.energy, &Totals::energy, "energy");
  expect_kept(problem.conserved.momentum_x, &Totals::momentum_x, "momentum along x");
  expect_kept(problem.conserved.momentum_y, &Totals::momentum_y, "momentum along y");
  expect_kept(problem.conserved.angular_momentum, &Totals::angular_momentum, "angular momentum");
}

TEST(Conserved, LeavesNothingOutInTheFirstFourScenarios) {
  for (const char* name : {"elastic_collision", "free_fall", "off_centre_torque", "pendulum_chain"}) {
    for (const Instance& instance : select(name)) {
      const Problem problem = instance.build();
      const auto at = [&](double time) {
        std::vector<BodyState> states(problem.scene.bodies.size());
        problem.truth.exact(time, states);
        return totals(problem.scene, states);
      };
      const Totals start = at(0), later = at(0.9 * problem.duration);
      const auto expect_change = [&](bool conserved, Total Totals::*total, const char* quantity) {
        if (conserved) return;
        const double change = std::fabs((later.*total).value - (start.*total).value);
        EXPECT_GT(change, 1e-3 * (later.*total).scale) << quantity << " in " << instance.label();
      };
      expect_change(problem.conserved.energy, &Totals::energy, "energy");
      expect_change(problem.conserved.momentum_x, &Totals::momentum_x, "momentum along x");
      expect_change(problem.conserved.momentum_y, &Totals::momentum_y, "momentum along y");
      expect_change(problem.conserved.angular_momentum, &Totals::angular_momentum, "angular momentum");
    }
  }
}

/// Returns place and velocity of `anchor` of a joint's body.
BodyState anchor_of(const Scene& scene, std::span<const BodyState> states, std::string_view body,
                    Vec2d anchor) {
  const auto index = find_body(scene, body);
  if (!index) return {.position = anchor};
  const BodyState& s = states[*index];
  const Vec2d arm = turned(s.angle, anchor);
  return {.position = s.position + arm, .velocity = s.velocity + cross(s.angular_velocity, arm)};
}

/// Returns what each kind of joint says of its anchors.
struct ExpectClosed {
  const Scene& scene;
  std::span<const BodyState> start, states;
  double time;

  void operator()(const RevoluteJoint& j) const {
    const auto [d, u, place, speed] = between(j);
    EXPECT_LE(norm(d), place) << j.name << " at " << time;
    EXPECT_LE(norm(u), speed) << j.name << " at " << time;
  }
  void operator()(const DistanceJoint& j) const {
    const auto [d, u, place, speed] = between(j);
    if (j.spring) return;
    if (j.range) {
      EXPECT_LE(norm(d), j.range->upper + place) << j.name << " at " << time;
      EXPECT_GE(norm(d), j.range->lower - place) << j.name << " at " << time;
      return;
    }
    EXPECT_NEAR(norm(d), j.length, place) << j.name << " at " << time;
    EXPECT_NEAR(dot(d, u), 0, speed * j.length) << j.name << " at " << time;
  }
  void operator()(const WeldJoint& j) const {
    const auto [d, u, place, speed] = between(j);
    if (!j.linear_spring) {
      EXPECT_LE(norm(d), place) << j.name << " at " << time;
    }
    if (!j.angular_spring) {
      EXPECT_NEAR(turn(j), j.reference_angle, 8 * kEpsilon) << j.name << " at " << time;
    }
  }
  void operator()(const PrismaticJoint& j) const {
    const auto [d, u, place, speed] = between(j);
    const auto a = find_body(scene, j.body_a);
    const Vec2d axis = turned(a ? states[*a].angle : 0, 1 / norm(j.axis) * j.axis);
    EXPECT_NEAR(cross(axis, d), 0, place) << j.name << " at " << time;
    EXPECT_NEAR(turn(j), j.reference_angle, 8 * kEpsilon) << j.name << " at " << time;
    if (!j.limits) return;
    EXPECT_LE(dot(axis, d), j.limits->upper + place) << j.name << " at " << time;
    EXPECT_GE(dot(axis, d), j.limits->lower - place) << j.name << " at " << time;
  }
  void operator()(const GearJoint& j) const {
    const double a = states[*find_body(scene, j.body_a)].angle, b = states[*find_body(scene, j.body_b)].angle;
    EXPECT_NEAR(b, j.ratio * a + j.phase, 8 * kEpsilon * (1 + std::fabs(b))) << j.name << " at " << time;
  }
  void operator()(const PulleyJoint& j) const {
    const double length = rope(j, states);
    EXPECT_NEAR(length, j.length.value_or(rope(j, start)), 8 * kEpsilon * length) << j.name << " at " << time;
  }
  void operator()(const auto& j) const { ADD_FAILURE() << "no test knows what " << j.name << " holds"; }

 private:
  struct Between {
    Vec2d d, u;
    double place, speed;  // allowed for rounding
  };
  Between between(const auto& j) const {
    const BodyState a = anchor_of(scene, states, j.body_a, j.anchor_a);
    const BodyState b = anchor_of(scene, states, j.body_b, j.anchor_b);
    return {b.position - a.position, b.velocity - a.velocity, 4 * kEpsilon * (norm(a.position) + 1),
            8 * kEpsilon * (norm(a.velocity) + 1)};
  }
  double turn(const auto& j) const {
    const auto a = find_body(scene, j.body_a), b = find_body(scene, j.body_b);
    return (b ? states[*b].angle : 0) - (a ? states[*a].angle : 0);
  }
  double rope(const PulleyJoint& j, std::span<const BodyState> at) const {
    return norm(anchor_of(scene, at, j.body_a, j.anchor_a).position - j.ground_a) +
           j.ratio * norm(anchor_of(scene, at, j.body_b, j.anchor_b).position - j.ground_b);
  }
};

TEST_P(EveryScenario, KeepsItsJointsTogether) {
  const auto start = exact(0);
  for (const double time : samples(0)) {
    const auto states = exact(time);
    for (const Joint& joint : problem.scene.joints)
      std::visit(ExpectClosed{problem.scene, start, states, time}, joint);
  }
}

/// Returns true if a joint has a motor or a spring.
bool stores_energy(const Joint& joint) {
  return std::visit(
      [](const auto& j) {
        bool stores = false;
        if constexpr (requires { j.motor; }) stores = stores || j.motor.has_value();
        if constexpr (requires { j.spring.has_value(); }) stores = stores || j.spring.has_value();
        if constexpr (requires { j.angular_spring; })
          stores = stores || j.angular_spring.has_value() || j.linear_spring.has_value();
        return stores;
      },
      joint);
}

/// Of two discs: how far they are apart and how fast they close.
struct Approach {
  double gap = 0, closing = 0;
};

Approach approach(const Scene& scene, std::span<const BodyState> states, std::size_t i, std::size_t j) {
  const Vec2d d = states[j].position - states[i].position, u = states[j].velocity - states[i].velocity;
  const auto radius = [&](std::size_t k) {
    return std::get<Circle>(scene.bodies[k].shapes[0].geometry).radius;
  };
  return {norm(d) - radius(i) - radius(j), -dot(d, u) / norm(d)};
}

bool only_discs(const Scene& scene) {
  return std::ranges::all_of(scene.bodies, [](const Body& body) {
    return body.shapes.size() == 1 && std::holds_alternative<Circle>(body.shapes[0].geometry);
  });
}

TEST_P(EveryScenario, DiscsTouchAtImpactsAndNeverOverlap) {
  const Scene& scene = problem.scene;
  if (!has_contacts(scene) || !only_discs(scene)) GTEST_SKIP() << "for discs that collide";
  constexpr double kMoment = 1e-9;
  const std::size_t n = scene.bodies.size();
  for (const double time : problem.truth.impacts) {
    int touching = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        const Approach before = approach(scene, exact(time - kMoment), i, j);
        const Approach after = approach(scene, exact(time + kMoment), i, j);
        const bool bounced = std::fabs(before.closing - after.closing) > 1e-6;
        if (!bounced || std::fabs(before.gap) > 1e-7) continue;
        ++touching;
        EXPECT_NEAR(approach(scene, exact(time), i, j).gap, 0, 1e-14) << time;
        EXPECT_GT(before.closing, 0) << time;
        // Newton's law of restitution; the normal turns a little within the moment.
        const double restitution = scene.bodies[i].shapes[0].restitution;
        EXPECT_NEAR(after.closing, -restitution * before.closing, 1e-7) << time;
      }
    }
    EXPECT_EQ(touching, 1) << time;
  }
  for (int k = 0; k <= 400; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        EXPECT_GE(approach(scene, exact(problem.duration * k / 400), i, j).gap, -1e-14);
}

TEST_P(EveryScenario, NeverOverlaps) {
  harness::PenetrationMeter meter(problem.scene);
  if (!meter.possible()) GTEST_SKIP() << "nothing touches";
  // Coordinates of tens of metres are rounded where shapes meet.
  for (const double time : samples(0)) EXPECT_LE(meter.deepest(exact(time)), 200 * kEpsilon) << time;
}

TEST_P(EveryScenario, LosesEnergyToNothingButFrictionAndImpacts) {
  const Scene& scene = problem.scene;
  const bool driven =
      std::ranges::any_of(scene.bodies, [](const Body& b) { return b.type == BodyType::Kinematic; }) ||
      std::ranges::any_of(scene.forces,
                          [](const ForceLaw& law) {
                            return !std::holds_alternative<SpringForce>(law) &&
                                   !std::holds_alternative<AttractionForce>(law);
                          }) ||
      std::ranges::any_of(scene.joints, [](const Joint& joint) { return stores_energy(joint); });
  if (driven) GTEST_SKIP() << "something drives it";
  Totals before = totals(scene, exact(0));
  for (const double time : samples(0)) {
    const Totals now = totals(scene, exact(time));
    EXPECT_LE(now.energy.value, before.energy.value + 3 * kEpsilon * (now.energy.scale + before.energy.scale))
        << time;
    before = now;
  }
}

/// The textbook loop, in double: forces where the step starts, then velocities and positions.
std::vector<BodyState> naive(const Scene& scene, reference::Scheme scheme, double h, long steps) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back(initial_state(body));
  for (long n = 0; n < steps; ++n) {
    const std::vector<BodyState> start = states;
    for (std::size_t i = 0; i < states.size(); ++i) {
      BodyState& s = states[i];
      // The middle of the step decides whether a force is on: rounding must not move its end.
      const Rate a = acceleration(scene, i, start, (static_cast<double>(n) + 0.5) * h);
      const BodyState before = s;
      s.velocity += h * a.linear;
      s.angular_velocity += h * a.angular;
      const double w = before.angular_velocity;
      switch (scheme) {
        case reference::Scheme::SemiImplicitEuler:
          s.position += h * s.velocity;
          s.angle += h * s.angular_velocity;
          break;
        case reference::Scheme::ExplicitEuler:
          s.position += h * before.velocity;
          s.angle += h * w;
          break;
        default:
          s.position += h / 2 * (before.velocity + s.velocity);
          s.angle += h / 2 * (w + s.angular_velocity);
      }
    }
  }
  return states;
}

TEST_P(EveryScenario, DiscreteTruthIsWhatTheTextbookLoopGives) {
  if (!problem.truth.discrete) GTEST_SKIP() << "none is known";
  const Scene& scene = problem.scene;
  std::vector<BodyState> states(scene.bodies.size());
  bool known = false;
  for (const auto scheme : {reference::Scheme::ExplicitEuler, reference::Scheme::SemiImplicitEuler,
                            reference::Scheme::VelocityVerlet}) {
    for (const double h : {1.0 / 60, 1.0 / 240}) {
      // Twice, and back again: answers do not depend on what was asked before.
      for (const double part : {0.3, 1.0, 0.5}) {
        const long steps = std::lround(part * problem.duration / h);
        if (!problem.truth.discrete(scheme, h, steps, states)) continue;
        known = true;
        const auto loop = naive(scene, scheme, h, steps);
        for (std::size_t i = 0; i < states.size(); ++i) {
          // Each step rounds twice; errors of the speed add up over the time.
          const double rounding = 2 * kEpsilon * static_cast<double>(steps), t = problem.duration;
          const double speed = norm(loop[i].velocity) + 9.81 * t,
                       spin = std::fabs(loop[i].angular_velocity) + 1;
          EXPECT_LE(norm(states[i].velocity - loop[i].velocity), rounding * speed);
          EXPECT_LE(norm(states[i].position - loop[i].position), rounding * speed * t);
          EXPECT_NEAR(states[i].angle, loop[i].angle, rounding * spin * t);
          EXPECT_NEAR(states[i].angular_velocity, loop[i].angular_velocity, rounding * spin);
        }
      }
    }
  }
  EXPECT_TRUE(known);
}

TEST_P(EveryScenario, DiscreteTruthIsOfTheOrderOfItsScheme) {
  if (!problem.truth.discrete) GTEST_SKIP() << "none is known";
  std::vector<BodyState> states(problem.scene.bodies.size());
  const auto exact_end = exact(problem.duration);
  const auto error = [&](reference::Scheme scheme, double h) {
    if (!problem.truth.discrete(scheme, h, std::lround(problem.duration / h), states)) return -1.0;
    double largest = 0;
    for (std::size_t i = 0; i < states.size(); ++i)
      largest = std::max(largest, norm(states[i].position - exact_end[i].position));
    return largest;
  };
  for (const auto scheme : {reference::Scheme::ExplicitEuler, reference::Scheme::SemiImplicitEuler}) {
    const double coarse = error(scheme, 1.0 / 1024), fine = error(scheme, 1.0 / 2048);
    if (coarse > 1e-9) {
      EXPECT_NEAR(coarse / fine, 2, 0.02);
    }
  }
  const double verlet = error(reference::Scheme::VelocityVerlet, 1.0 / 64);
  EXPECT_LE(verlet, 4 * kEpsilon * 500);
}

INSTANTIATE_TEST_SUITE_P(Every, EveryScenario, ::testing::ValuesIn(every_instance()),
                         [](const auto& instance) {
                           std::string name = instance.param.label();
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace testing
}  // namespace plumb::scenarios
