#include <algorithm>
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/precise/impact_laws/impact_law.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/simulation/simulation.h"

// Laws of impact that a scene chooses: `ContactRules::impact` and what goes with it.
namespace plumb {
namespace {

constexpr double kMass = 2, kWidth = 0.8, kHeight = 0.4, kAngle = 0.6;

Scene over_a_floor(Body body, double friction, double restitution) {
  Scene scene;
  scene.name = "impact";
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {{.geometry = Box{100, 1}}};
  scene.bodies = {floor, std::move(body)};
  for (Body& each : scene.bodies) {
    for (Shape& shape : each.shapes) {
      shape.friction = friction;
      shape.restitution = restitution;
    }
  }
  return scene;
}

/// The arm from the centre of the slanting box to its lowest corner.
Vec2d lowest() {
  const double c = std::cos(kAngle), s = std::sin(kAngle);
  return {-c * kWidth / 2 + s * kHeight / 2, -s * kWidth / 2 - c * kHeight / 2};
}

/// A slanting box whose lowest corner is about to touch the floor.
Scene slanting(Vec2d velocity, double spin, double friction, double restitution) {
  Body box{.name = "box",
           .position = {0, -lowest().y},
           .angle = kAngle,
           .velocity = velocity,
           .angular_velocity = spin,
           .mass = kMass};
  box.shapes = {{.geometry = Box{kWidth, kHeight}}};
  Scene scene = over_a_floor(box, friction, restitution);
  scene.gravity = {0, 0};
  return scene;
}

BodyState after(const Scene& scene) {
  Simulation simulation = compile(scene, Precise{.tolerance = 1e-10, .max_dt = 1e-3});
  simulation.step();
  return simulation.state(1);
}

TEST(ImpactRules, ACornerIsThrownAsTheChosenLawSays) {
  const Vec2d arm = lowest(), velocity{-0.7, -2};
  const double spin = 0.5, inertia = kMass * (kWidth * kWidth + kHeight * kHeight) / 12;
  for (const ImpactRule rule : {ImpactRule::Poisson, ImpactRule::Stronge}) {
    Scene scene = slanting(velocity, spin, 0.3, 0.6);
    scene.contact_rules.impact = rule;
    scene.contact_rules.friction_after_stop = 0.5;
    const precise::ImpactPoint point{velocity.y + arm.x * spin, velocity.x - arm.y * spin,
                                     1 / kMass + arm.x * arm.x / inertia, -arm.x * arm.y / inertia,
                                     1 / kMass + arm.y * arm.y / inertia};
    const precise::ImpactCoefficients c{0.6, 0.3, 0.15, 0};
    const precise::ContactImpulse impulse =
        rule == ImpactRule::Poisson ? poisson_impulse(point, c) : stronge_impulse(point, c);
    const BodyState found = after(scene);
    EXPECT_NEAR(found.velocity.x, velocity.x + impulse.tangential / kMass, 1e-12);
    EXPECT_NEAR(found.velocity.y, velocity.y + impulse.normal / kMass, 1e-12);
    EXPECT_NEAR(found.angular_velocity,
                spin + (arm.x * impulse.normal - arm.y * impulse.tangential) / inertia, 1e-11);
  }
}

TEST(ImpactRules, ABoxThatFallsFlatStaysLevel) {
  Body box{.name = "box", .position = {0, 0.2}, .velocity = {0, -3}};
  box.shapes = {{.geometry = Box{kWidth, kHeight}}};
  for (const ImpactRule rule : {ImpactRule::Newton, ImpactRule::Poisson, ImpactRule::Stronge}) {
    Scene scene = over_a_floor(box, 0.4, 0.5);
    scene.gravity = {0, 0};
    scene.contact_rules.impact = rule;
    const BodyState found = after(scene);
    EXPECT_NEAR(found.velocity.y, 1.5, 1e-12);
    EXPECT_NEAR(found.angular_velocity, 0, 1e-12);
  }
}

TEST(ImpactRules, FasterImpactsBounceLess) {
  // A disc that falls from h hits at sqrt(2 g h); at 16 times the yield speed half the restitution is left.
  Body disc{.name = "disc", .position = {0, 0.5}, .velocity = {0, -8}};
  disc.shapes = {{.geometry = Circle{0.5}}};
  for (const ImpactRule rule : {ImpactRule::Newton, ImpactRule::Stronge}) {
    Scene scene = over_a_floor(disc, 0, 0.9);
    scene.gravity = {0, 0};
    scene.contact_rules.impact = rule;
    scene.contact_rules.yield_speed = 0.5;
    EXPECT_NEAR(after(scene).velocity.y, 0.45 * 8, 1e-12);
  }
}

TEST(ImpactRules, ASuperballReturnsItsSpin) {
  // Garwin, Am. J. Phys. 37 (1969) 88, for a disc: the slip v + w r turns round, the energy stays.
  Body disc{.name = "disc", .position = {0, 0.5}, .velocity = {2, -3}, .angular_velocity = 1};
  disc.shapes = {{.geometry = Circle{0.5}}};
  Scene scene = over_a_floor(disc, 10, 1);
  scene.gravity = {0, 0};
  scene.contact_rules.impact = ImpactRule::Stronge;
  scene.contact_rules.tangential_restitution = 1;
  const BodyState found = after(scene);
  EXPECT_NEAR(found.velocity.x + 0.5 * found.angular_velocity, -(2 + 0.5), 1e-12);
  EXPECT_NEAR(found.velocity.y, 3, 1e-12);
  const auto energy = [](Vec2d v, double w) { return (dot(v, v) + 0.125 * w * w) / 2; };
  EXPECT_NEAR(energy(found.velocity, found.angular_velocity), energy({2, -3}, 1), 1e-12);
}

TEST(ImpactRules, JointsPassImpulsesOn) {
  // Two boxes welded into one are thrown as one.
  Body left{.name = "left", .position = {-0.2, 0.5}, .velocity = {1, -2}}, right = left;
  right.name = "right";
  right.position = {0.2, 0.5};
  left.shapes = right.shapes = {{.geometry = Box{0.4, 0.4}}};
  Body whole = left;
  whole.position = {0, 0.5};
  whole.mass = 2;
  whole.shapes = {{.geometry = Box{0.8, 0.4}}};
  const double angle = 0.3, c = std::cos(angle), s = std::sin(angle);
  const double height = 0.4 * s + 0.2 * c;
  for (Body* body : {&left, &right, &whole}) body->angle = angle;
  left.position = {-0.2 * c, height - 0.2 * s};
  right.position = {0.2 * c, height + 0.2 * s};
  whole.position = {0, height};
  Scene one = over_a_floor(whole, 0.3, 0.5);
  one.gravity = {0, 0};
  one.contact_rules.impact = ImpactRule::Stronge;
  Scene two = one;
  for (Body* body : {&left, &right}) body->shapes[0].friction = 0.3, body->shapes[0].restitution = 0.5;
  two.bodies = {one.bodies[0], left, right};
  WeldJoint weld;
  weld.name = "weld";
  weld.body_a = "left";
  weld.body_b = "right";
  weld.anchor_a = {0.2, 0};
  weld.anchor_b = {-0.2, 0};
  two.joints = {weld};
  const BodyState a = after(one), b = after(two);
  EXPECT_NEAR(b.angular_velocity, a.angular_velocity, 1e-9);
  // The left half moves as that point of the whole, which has turned a little since.
  const Vec2d arm{-0.2 * std::cos(a.angle), -0.2 * std::sin(a.angle)};
  EXPECT_NEAR(b.velocity.x, a.velocity.x - a.angular_velocity * arm.y, 1e-9);
  EXPECT_NEAR(b.velocity.y, a.velocity.y + a.angular_velocity * arm.x, 1e-9);
}

TEST(ImpactRules, StrongeNeverGainsEnergyInALongTumble) {
  for (const double friction : {0.2, 0.8}) {
    Scene scene = slanting({3, 0}, 9, friction, 0.9);
    scene.bodies[1].position.y = 2;
    scene.gravity = {0, -9.81};
    scene.contact_rules.impact = ImpactRule::Stronge;
    scene.contact_rules.tangential_restitution = 0.3;
    const double inertia = kMass * (kWidth * kWidth + kHeight * kHeight) / 12;
    Simulation simulation = compile(scene, Precise{.tolerance = 1e-9, .max_dt = 0.01});
    double last = 1e300;
    for (int i = 0; i < 400; ++i) {
      simulation.step();
      const BodyState s = simulation.state(1);
      const double energy = kMass * dot(s.velocity, s.velocity) / 2 +
                            inertia * s.angular_velocity * s.angular_velocity / 2 +
                            kMass * 9.81 * s.position.y;
      ASSERT_LE(energy, last + 1e-6) << i;
      last = energy;
    }
    EXPECT_GT(simulation.statistics().impacts, 5);
    EXPECT_LT(last, 0.5 * (kMass * 9.81 * 2));
  }
}

TEST(ImpactRules, EnginesWithoutTheLawSaySo) {
  Scene scene = slanting({0, -1}, 0, 0.3, 0.5);
  EXPECT_EQ(unsupported(scene, Realtime{}), "");
  scene.contact_rules.impact = ImpactRule::Poisson;
  EXPECT_THAT(unsupported(scene, Realtime{}), testing::HasSubstr("contact_rules has impact 'poisson'"));
  EXPECT_EQ(unsupported(scene, Precise{}), "");
  scene.contact_rules.simultaneous = Simultaneous::Together;
  EXPECT_THAT(unsupported(scene, Precise{}), testing::HasSubstr("together"));
  scene.contact_rules = {.yield_speed = 1};
  EXPECT_THAT(unsupported(scene, Realtime{}), testing::HasSubstr("yield_speed"));
  EXPECT_EQ(unsupported(scene, Precise{}), "");
  scene.contact_rules = {.tangential_restitution = 0.5};
  EXPECT_THAT(unsupported(scene, Precise{}), testing::HasSubstr("use impact"));
}

TEST(ImpactRules, AreReadAsWritten) {
  Scene scene = slanting({0, -1}, 0, 0.3, 0.5);
  scene.contact_rules.impact = ImpactRule::Stronge;
  scene.contact_rules.yield_speed = 1.5;
  scene.contact_rules.tangential_restitution = 0.25;
  scene.contact_rules.friction_after_stop = 0.75;
  EXPECT_EQ(scene_from_json(to_json(scene)), scene);
  EXPECT_EQ(to_json(slanting({0, -1}, 0, 0.3, 0.5)).find("impact\":\"n"), std::string::npos)
      << "scenes with Newton's law are written, and hashed, as before";
}

}  // namespace
}  // namespace plumb
