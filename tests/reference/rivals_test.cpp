// Holds each rival's motion of a scene against closed forms and against what its scheme must give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "reference/backend.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;
using ::testing::HasSubstr;

constexpr double kGravity = 9.81;

class Rivals : public ::testing::TestWithParam<const char*> {
 protected:
  const Backend& engine() const { return find_backend(GetParam()); }
  double epsilon() const { return epsilon_of(engine()); }
  std::vector<BodyState> after(const Scene& scene, double duration, double dt, int substeps = 1) const {
    return run(engine(), scene, duration, steps_of(dt, substeps));
  }
};

TEST_P(Rivals, FreeFallIsThatOfSemiImplicitEuler) {
  // v_n = v0 - g t and y_n = y0 + v0 t - g t (t + h) / 2: too far by g h t / 2 = 0.0204 m.
  const double h = 1.0 / 240, t = 1;
  const auto states =
      after(falling({moving(disc("a", {0, 5}), {3, 2}), disc("b", {10, 5}, 1, 1000)}), t, 4 * h, 4);
  const double drop = kGravity * t * (t + h) / 2;
  // 240 roundings by up to eps / 2 of values up to 9.81, of which a sixth adds up.
  const double tolerance = 240 * 9.81 * epsilon() / 12;
  EXPECT_NEAR(states[0].position.x, 3, tolerance);
  EXPECT_NEAR(states[0].position.y, 5 + 2 * t - drop, tolerance);
  EXPECT_NEAR(states[0].velocity.y, 2 - kGravity * t, tolerance);
  EXPECT_NEAR(states[1].position.y, 5 - drop, tolerance);
}

TEST_P(Rivals, ForcesActForTheirShareOfAStep) {
  // From 0.505 to 0.598 s with steps of 0.02 s: the impulse is F dt whatever the grid.
  Scene scene = weightless({disc("a", {}, 0.5, 2)});
  scene.bodies[0].inertia = 0.5;
  scene.forces = {
      PointForce{.body = "a", .force = {4, -6}, .point = {0, 0.25}, .start = 0.505, .duration = 0.093},
      Torque{.body = "a", .torque = 3, .start = 0.505, .duration = 0.093}};
  const BodyState state = after(scene, 1, 0.02)[0];
  EXPECT_NEAR(state.velocity.x, 4 * 0.093 / 2, epsilon());
  EXPECT_NEAR(state.velocity.y, -6 * 0.093 / 2, epsilon());
  // The arm turns while the force acts: from -4 * 0.25 N m by less than 1 % (6 * 0.25 * 0.08 rad).
  EXPECT_NEAR(state.angular_velocity, (3 - 4 * 0.25) * 0.093 / 0.5, 0.01 * 0.4);
}

TEST_P(Rivals, DragIsThatOfTheStepsStart) {
  // v_{n+1} = v_n (1 - c h / m).
  Scene scene = weightless({moving(disc("a", {}), {10, 0})});
  scene.forces = {LinearDrag{.body = "a", .coefficient = 0.5}};
  EXPECT_NEAR(after(scene, 1, 0.01)[0].velocity.x, 10 * std::pow(1 - 0.5 * 0.01, 100), 100 * epsilon());
}

TEST_P(Rivals, InertiaIsTheScenes) {
  Scene scene = weightless({disc("a", {}), disc("b", {5, 0}), box("c", {10, 0}, 2, 0.1, 3)});
  scene.bodies[0].inertia = 0.7;
  for (const char* name : {"a", "b", "c"}) scene.forces.push_back(Torque{.body = name, .torque = 2});
  const auto states = after(scene, 0.5, 0.01);
  EXPECT_NEAR(states[0].angular_velocity, 2 * 0.5 / 0.7, 20 * epsilon());
  EXPECT_NEAR(states[1].angular_velocity, 2 * 0.5 / 0.125, 200 * epsilon());
  EXPECT_NEAR(states[2].angular_velocity, 2 * 0.5 / (3 * (4 + 0.01) / 12), 20 * epsilon());
}

TEST_P(Rivals, AFixedRotationStaysFixed) {
  Scene scene = weightless({disc("a", {}), moving(disc("b", {3, 0.4}), {-4, 0})});
  scene.bodies[0].fixed_rotation = true;
  scene.bodies[0].angle = 0.3;
  scene.forces = {PointForce{.body = "a", .force = {1, 0}, .point = {0, 0.5}}};
  const BodyState state = after(scene, 1, 0.01)[0];
  EXPECT_EQ(state.angular_velocity, 0);
  EXPECT_NEAR(state.angle, 0.3, 0.3 * epsilon());
  EXPECT_LT(state.velocity.x, 0);  // b has hit it
}

TEST_P(Rivals, AnglesCountWholeTurns) {
  // From beyond half a turn, both ways, at 10 rad/s and, in steps of 0.42 rad, at 100 rad/s.
  for (const double w : {10.0, -10.0, 100.0, -100.0}) {
    Scene scene = weightless({moving(box("a", {}, 1, 0.2), {}, w)});
    scene.bodies[0].angle = 4;
    const auto simulator = engine().create(scene, steps_of(1.0 / 60, 4));
    BodyState state;
    for (int second = 1; second <= 3; ++second) {
      simulator->advance(60);
      simulator->read({&state, 1});
      // 720 additions to an angle of up to 304 rad, each rounded by up to eps / 2 of it, and an eighth of
      // that adds up.
      EXPECT_NEAR(state.angle, 4 + w * second, 720 * 304 * epsilon() / 16) << w;
      EXPECT_NEAR(state.angular_velocity, w, 1000 * epsilon());
    }
  }
}

TEST_P(Rivals, StaticStaysAndKinematicMovesAsItIsTold) {
  Scene scene = falling({of_type(box("ground", {0, -0.5}, 20, 1), BodyType::Static),
                         of_type(moving(box("lift", {-5, 3}, 1, 1), {0.5, -0.25}, 2), BodyType::Kinematic),
                         disc("ball", {3, 0.5})});
  scene.bodies[0].angle = 0;
  scene.bodies[1].angle = -1;
  const auto states = after(scene, 2, 1.0 / 60, 2);
  EXPECT_EQ(states[0], initial_state(scene.bodies[0]));
  // The pose is added up 240 times in Box2D; Bullet differences it for the velocity: eps |x| / h.
  const double tolerance = 240 * 5 * epsilon() / 4;
  EXPECT_NEAR(states[1].position.x, -4, tolerance);
  EXPECT_NEAR(states[1].position.y, 2.5, tolerance);
  EXPECT_NEAR(states[1].angle, 3, tolerance);
  EXPECT_NEAR(states[1].velocity.x, 0.5, 5 * epsilon() * 120 * 4);
  EXPECT_NEAR(states[1].velocity.y, -0.25, 5 * epsilon() * 120 * 4);
  EXPECT_NEAR(states[1].angular_velocity, 2, 5 * epsilon() * 120 * 40);
  EXPECT_NEAR(states[2].position.y, 0.5, 0.006);  // Box2D's slop is 5 mm
}

TEST_P(Rivals, AKinematicBodyPushes) {
  Scene scene =
      weightless({of_type(moving(disc("ram", {}), {1, 0}), BodyType::Kinematic), disc("ball", {1.5, 0})});
  const auto states = after(scene, 2, 0.01);
  EXPECT_NEAR(states[0].position.x, 2, 1e-5);
  EXPECT_NEAR(states[1].velocity.x, 1, 1e-4);  // inelastic: it is taken along
  EXPECT_NEAR(states[1].position.x, 3, 0.02);
}

TEST_P(Rivals, RestitutionIsCombinedByTheScenesRule) {
  // Equal masses: the relative velocity after is -e times that before, the mean stays.
  for (const Combine rule :
       {Combine::GeometricMean, Combine::Product, Combine::Maximum, Combine::Minimum, Combine::Average}) {
    Scene scene = head_on();
    scene.contact_rules.restitution = rule;
    const double e = combine(rule, 0.2, 0.8);
    const auto states = after(scene, 2, 0.01);
    EXPECT_NEAR(states[1].velocity.x - states[0].velocity.x, e, 2 * epsilon()) << static_cast<int>(rule);
    EXPECT_NEAR(states[1].velocity.x + states[0].velocity.x, 1, 2 * epsilon()) << static_cast<int>(rule);
  }
}

TEST_P(Rivals, BelowTheThresholdNothingBounces) {
  Scene scene = head_on();
  scene.contact_rules.restitution_threshold = 1.1;
  auto states = after(scene, 2, 0.01);
  EXPECT_NEAR(states[1].velocity.x - states[0].velocity.x, 0, 2 * epsilon());
  scene.contact_rules.restitution_threshold = 0.9;
  states = after(scene, 2, 0.01);
  EXPECT_NEAR(states[1].velocity.x - states[0].velocity.x, 0.8, 2 * epsilon());
  // The slowest impacts bounce where the scene has no threshold.
  scene.contact_rules.restitution_threshold = 0;
  scene.bodies[0].velocity = {0.01, 0};
  scene.bodies[0].position = {-0.005, 0};
  states = after(scene, 2, 0.01);
  EXPECT_NEAR(states[1].velocity.x - states[0].velocity.x, 0.008, 2 * epsilon());
}

TEST_P(Rivals, ABallBouncesOffTheGroundAsHighAsItMust) {
  // Dropped by 1.5 m, e = 1: at 1 s it is on its way up. First order in h = 1/960.
  Scene scene = falling({of_type(box("ground", {0, -0.5}, 20, 1), BodyType::Static), disc("ball", {0, 2})});
  scene.bodies[1].shapes[0].restitution = 1;
  const double impact = std::sqrt(2 * 1.5 / kGravity), speed = kGravity * impact, rest = 1 - impact;
  const BodyState ball = after(scene, 1, 1.0 / 60, 16)[1];
  // The impact is seen up to a step late and its speed is off by g h: v h + (v h + g h t) in height.
  const double h = 1.0 / 960, tolerance = 2 * speed * h + kGravity * h;
  EXPECT_NEAR(ball.position.y, 0.5 + speed * rest - kGravity * rest * rest / 2, tolerance);
  EXPECT_NEAR(ball.velocity.y, speed - kGravity * rest, 2 * kGravity * h);
}

TEST_P(Rivals, FrictionIsCombinedByTheScenesRule) {
  // A block slides on the ground: v = v0 - mu g t, exact in steps.
  for (const Combine rule :
       {Combine::GeometricMean, Combine::Product, Combine::Maximum, Combine::Minimum, Combine::Average}) {
    Scene scene = falling({of_type(box("ground", {0, -0.5}, 40, 1), BodyType::Static),
                           moving(box("block", {0, 0.25}, 2, 0.5), {5, 0})});
    scene.bodies[0].shapes[0].friction = 0.2;
    scene.bodies[1].shapes[0].friction = 0.8;
    scene.contact_rules.friction = rule;
    const double mu = combine(rule, 0.2, 0.8), t = 0.25;
    // The two contacts share the load within the solver's iterations.
    EXPECT_NEAR(after(scene, t, 1.0 / 240)[1].velocity.x, 5 - mu * kGravity * t, 2e-5 * kGravity * t)
        << static_cast<int>(rule);
  }
}

TEST_P(Rivals, FiltersAreTheScenes) {
  struct Case {
    Filter a, b;
    bool touch;
  };
  const std::uint32_t high = 1u << 20;  // beyond Box2D's own 16 bits
  const Case cases[] = {{{}, {}, true},
                        {{.category = 2}, {.mask = ~2u}, false},
                        {{.category = high}, {.mask = ~high}, false},
                        {{.category = high}, {.mask = high | 1u}, true},
                        {{.mask = 0}, {}, false},
                        {{.group = -3}, {.group = -3}, false},
                        {{.mask = 0, .group = 3}, {.group = 3}, true},
                        {{.group = -3}, {.group = -4}, true}};
  for (const Case& each : cases) {
    Scene scene = head_on();
    scene.bodies[0].shapes[0].filter = each.a;
    scene.bodies[1].shapes[0].filter = each.b;
    const bool touched = after(scene, 2, 0.01)[1].velocity.x != 0;
    EXPECT_EQ(touched, each.touch) << &each - cases;
    EXPECT_EQ(may_touch(each.a, each.b), each.touch);
  }
}

TEST_P(Rivals, FiltersDecideShapeByShape) {
  // Two shapes a body, apart in y: of the four pairs only the upper ones may touch.
  Scene scene = head_on();
  for (Body& body : scene.bodies) {
    body.shapes = {body.shapes[0], body.shapes[0]};
    body.shapes[0].position = {0, 2};
    body.shapes[1].position = {0, -2};
    body.shapes[1].filter.mask = 0;
  }
  scene.bodies[0].shapes[0].restitution = 0.6;  // and each pair has coefficients of its own
  const auto states = after(scene, 2, 0.01);
  // Struck 2 m above both centres: 1/m_eff = 2 (1/m + r^2/I), v = (1 + e) / (2 m (1/m + r^2/I)) for the
  // struck.
  const double inertia = inertia_of(scene.bodies[1]), per_mass = 1 + 4 / inertia;
  EXPECT_NEAR(states[1].velocity.x, 1.8 / (2 * per_mass), epsilon());
  EXPECT_NEAR(states[1].angular_velocity, -2 * 1.8 / (2 * per_mass) / inertia, epsilon());
  for (Body& body : scene.bodies) body.shapes[0].filter.mask = 0;
  EXPECT_EQ(after(scene, 2, 0.01)[1].velocity.x, 0);
}

TEST_P(Rivals, ShapesStandWhereTheirBodyHasThem) {
  // a's disc is 0.5 m ahead of its centre: b, at 1 m/s, has 0.5 m to go and then stops; the centres are in
  // line.
  Scene scene = weightless({disc("a", {}), moving(disc("b", {2, 0}), {-1, 0})});
  scene.bodies[0].shapes[0].position = {0.5, 0};
  for (Body& body : scene.bodies) body.shapes[0].restitution = 1;
  const auto states = after(scene, 1, 0.001);
  EXPECT_NEAR(states[0].velocity.x, -1, 2 * epsilon());
  EXPECT_NEAR(states[0].position.x, -0.5, 0.002);
  EXPECT_NEAR(states[1].position.x, 1.5, 0.002);
}

INSTANTIATE_TEST_SUITE_P(All, Rivals, ::testing::Values("box2d", "bullet", "bullet-double"),
                         [](const auto& each) {
                           return std::string(each.param).substr(0, 6) +
                                  (std::string(each.param).size() > 6 ? "Double" : "");
                         });

}  // namespace
}  // namespace plumb::reference
