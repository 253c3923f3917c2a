#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/precise/precise.h"
#include "engine/scene/error.h"
#include "tests/precise/contact_scenes.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

namespace plumb {
namespace {

using truth::Real;

Scene weightless(const std::string& name) { return {.name = name, .gravity = {0, 0}}; }

void set_material(Scene& scene, double restitution, double friction) {
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) {
      shape.restitution = restitution;
      shape.friction = friction;
    }
  }
}

TEST(PreciseImpact, HeadOnAtAnyMassRatioAndRestitution) {
  for (const double ratio : {1.0, 10.0, 1e3, 1e6}) {
    for (const double e : {0.0, 0.5, 1.0}) {
      Scene scene = weightless("head_on");
      scene.bodies = {ball("a", {0, 0}, {3, 0}, ratio), ball("b", {2.37, 0}, {-1, 0})};
      set_material(scene, e, 0.3);
      const auto driver = make_precise_driver(scene, {}, {});
      const auto s = advance(*driver, 2, 60);
      EXPECT_EQ(driver->statistics().impacts, 1);
      // Newton: v_b' - v_a' = e (v_a - v_b), momentum kept.
      const Real ma = ratio, mb = 1, v = (3 * ma - mb) / (ma + mb), u = 4 * static_cast<Real>(e);
      const Real va = v - mb / (ma + mb) * u, vb = v + ma / (ma + mb) * u;
      EXPECT_NEAR(s[0].velocity.x, static_cast<double>(va), 3e-15) << ratio << " " << e;
      EXPECT_NEAR(s[1].velocity.x, static_cast<double>(vb), 3e-15) << ratio << " " << e;
      const Real hit = (2.37L - 1) / 4;
      EXPECT_NEAR(s[0].position.x, static_cast<double>(3 * hit + va * (1 - hit)), 2e-15);
      EXPECT_NEAR(s[1].position.x, static_cast<double>(2.37L - hit + vb * (1 - hit)), 4e-15);
      EXPECT_NEAR(s[0].velocity.x * ratio + s[1].velocity.x, 3 * ratio - 1, 1e-15 * ratio * 3 + 1e-15);
    }
  }
}

TEST(PreciseImpact, ObliqueWithTheNormalAtTheTimeOfContact) {
  // Frictionless discs: only the velocities along the normal change.
  Scene scene = weightless("oblique");
  scene.bodies = {ball("a", {0, 0}, {2, 0.3}, 2), ball("b", {3, 0.6}, {-1, 0.1}, 3)};
  for (const double max_dt : {1.0 / 60, 0.5, 3.0}) {
    const int steps = static_cast<int>(std::lround(3 / max_dt));
    const auto s = run(scene, steps, {.max_dt = max_dt});
    const Real dx = 3, dy = 0.6, dvx = -3, dvy = 0.1L - 0.3L;
    const Real a = dvx * dvx + dvy * dvy, b = dx * dvx + dy * dvy, c = dx * dx + dy * dy - 1;
    const Real t = (-b - std::sqrt(b * b - a * c)) / a;
    const Real nx = dx + dvx * t, ny = dy + dvy * t;                   // of length 1, the sum of the radii
    const Real j = 2 * (dvx * nx + dvy * ny) / (1 / 2.0L + 1 / 3.0L);  // along n, on a
    const Real vax = 2 + j * nx / 2, vay = 0.3L + j * ny / 2, vbx = -1 - j * nx / 3, vby = 0.1L - j * ny / 3;
    EXPECT_NEAR(s[0].velocity.x, static_cast<double>(vax), 4e-15);
    EXPECT_NEAR(s[0].velocity.y, static_cast<double>(vay), 4e-15);
    EXPECT_NEAR(s[1].velocity.x, static_cast<double>(vbx), 4e-15);
    EXPECT_NEAR(s[1].velocity.y, static_cast<double>(vby), 4e-15);
    EXPECT_NEAR(s[0].position.x, static_cast<double>(2 * t + vax * (3 - t)), 2e-14);
    EXPECT_NEAR(s[1].position.y, static_cast<double>(0.6L + 0.1L * t + vby * (3 - t)), 2e-14);
  }
}

TEST(PreciseImpact, FallingBallsMeetOnCurvedWays) {
  // One falls, one is thrown up under it: the relative motion is even, they meet at t = (h - 1)/v.
  Scene scene{.name = "meet"};
  scene.bodies = {ball("low", {0, 0}, {0, 8}), ball("high", {0, 5})};
  const auto s = run(scene, 60);
  const Real t = 4.0L / 8, g = 9.81L;
  EXPECT_NEAR(s[0].velocity.y, static_cast<double>(-g), 2e-15 * 10);  // they swap
  EXPECT_NEAR(s[1].velocity.y, static_cast<double>(8 - g), 2e-15 * 10);
  const Real y = 8 * t - g / 2 * t * t;
  EXPECT_NEAR(s[0].position.y, static_cast<double>(y - g * t * (1 - t) - g / 2 * (1 - t) * (1 - t)), 5e-15);
}

TEST(PreciseImpact, ThrownAgainstAStillDiscUnderGravity) {
  // Dropped by 2 m onto the top of a fixed disc, elastic: it comes back after 2 sqrt(2 h / g).
  Scene scene{.name = "bounce", .gravity = {0, -10}};
  Body ground = ball("ground", {0, -1});
  ground.type = BodyType::Static;
  scene.bodies = {ground, ball("ball", {0, 2})};
  const double once = std::sqrt(2 * 2 / 10.0);
  const auto driver = make_precise_driver(scene, {.max_dt = once / 7.5}, {});
  const auto s = advance(*driver, 2, 15 * 10);
  EXPECT_EQ(driver->statistics().impacts, 10);
  EXPECT_NEAR(s[1].position.y, 2, 1e-13);
  EXPECT_NEAR(s[1].velocity.y, 0, 1e-12);
  EXPECT_EQ(s[0], initial_state(ground));
}

TEST(PreciseImpact, CradleWithGaps) {
  Scene scene = weightless("cradle");
  for (int i = 0; i < 5; ++i) {
    scene.bodies.push_back(ball("ball" + std::to_string(i), {1.125 * i, 0}, {i == 0 ? 2.0 : 0.0, 0}));
  }
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 5, 60);
  EXPECT_EQ(driver->statistics().impacts, 4);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s[i].velocity.x, i == 4 ? 2 : 0, 1e-15) << i;
}

TEST(PreciseImpact, TouchingCradleIsASequenceOfPairs) {
  Scene scene = weightless("cradle");
  for (int i = 0; i < 5; ++i) {
    scene.bodies.push_back(ball("ball" + std::to_string(i), {1.0 * i - (i < 2 ? 1.0 : 0.0), 0}));
  }
  scene.bodies[0].velocity = scene.bodies[1].velocity = {3, 0};  // two in, two out
  const auto s = run(scene, 60);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s[i].velocity.x, i >= 3 ? 3 : 0, 1e-14) << i;
}

TEST(PreciseImpact, GalileanCannon) {
  // A heavy ball with a light one just behind it hits a wall: the light one leaves at (3 M - m)/(M + m) v.
  Scene scene = weightless("cannon");
  Body wall = ball("wall", {-2, 0});
  wall.type = BodyType::Static;
  scene.bodies = {wall, ball("heavy", {0, 0}, {-1, 0}, 9), ball("light", {1.001, 0}, {-1, 0}, 1)};
  EXPECT_NEAR(run(scene, 120)[2].velocity.x, 2.6, 3e-15);
}

TEST(PreciseImpact, PlasticImpactStaysQuiet) {
  Scene scene = weightless("plastic");
  scene.bodies = {ball("a", {0, 0}, {1.3, 0.7}, 0.3), ball("b", {2, 1.5}, {-0.7, -0.9}, 0.7)};
  set_material(scene, 0, 0);
  const auto driver = make_precise_driver(scene, {}, {});
  const auto s = advance(*driver, 2, 6000);
  EXPECT_EQ(driver->statistics().impacts, 1);
  EXPECT_NEAR(0.3 * s[0].velocity.x + 0.7 * s[1].velocity.x, 0.3 * 1.3 - 0.7 * 0.7, 1e-15);
}

TEST(PreciseImpact, SlowImpactsDoNotBounceBelowTheThreshold) {
  Scene scene = weightless("slow");
  scene.contact_rules.restitution_threshold = 1;
  scene.bodies = {ball("a", {0, 0}, {0.9, 0}), ball("b", {1.2, 0})};
  EXPECT_NEAR(run(scene, 60)[0].velocity.x, 0.45, 1e-15);
  scene.bodies[0].velocity.x = 1.1;
  EXPECT_NEAR(run(scene, 60)[0].velocity.x, 0, 1e-15);
}

TEST(PreciseImpact, CombinesCoefficientsByTheScenesRules) {
  Scene scene = weightless("rules");
  scene.bodies = {ball("a", {0, 0}, {1, 0}), ball("b", {1.2, 0})};
  scene.bodies[0].shapes[0].restitution = 0.5;
  scene.bodies[1].shapes[0].restitution = 0.25;
  for (const auto& [rule, e] :
       {std::pair{Combine::Maximum, 0.5}, {Combine::Product, 0.125}, {Combine::Minimum, 0.25}}) {
    scene.contact_rules.restitution = rule;
    const auto s = run(scene, 60);
    EXPECT_NEAR(s[1].velocity.x - s[0].velocity.x, e, 1e-15);
  }
}

TEST(PreciseImpact, FrictionSticksAndSlides) {
  // A disc (I = m r^2/2) lands on a still one with slip u: J_t = -m u/3, at most mu (1 + e) m |v_n|.
  // The same when the disc is integrated, as for a drag too small to matter.
  for (const auto& [mu, drag] : {std::pair{0.9, 0.0}, {0.1, 0.0}, {0.9, 1e-20}, {0.1, 1e-20}}) {
    Scene scene = weightless("friction");
    scene.forces = {LinearDrag{"disc", drag}};
    Body ground = ball("ground", {0, -1});
    ground.type = BodyType::Static;
    Body disc = ball("disc", {-0.3, 0.5}, {1.2, -2}, 2);  // centred above the ground disc when they meet
    scene.bodies = {ground, disc};
    set_material(scene, 0.5, mu);
    const auto s = run(scene, 30);
    const double t = 0.25, v_n = 2, u = 1.2, m = 2, r = 0.5, inertia = m * r * r / 2;
    EXPECT_NEAR(-0.3 + u * t, 0, 1e-15);
    const double most = mu * 1.5 * m * v_n, rub = std::min(m * u / 3, most);
    EXPECT_NEAR(s[1].velocity.x, u - rub / m, 1e-14) << mu;
    EXPECT_NEAR(s[1].velocity.y, 0.5 * v_n, 1e-14) << mu;
    EXPECT_NEAR(s[1].angular_velocity, -r * rub / inertia, 1e-13) << mu;
    EXPECT_EQ(mu > 0.5, rub < most);
  }
}

TEST(PreciseImpact, FrictionBetweenTwoSpinningDiscs) {
  // Equal discs, no slip left: angular momentum about the point of contact is kept for each disc alone.
  Scene scene = weightless("spinning");
  scene.bodies = {ball("a", {0, 0}, {1, 0}), ball("b", {1.25, 0}, {-1, 0})};
  scene.bodies[0].angular_velocity = 6;
  set_material(scene, 1, 10);
  const auto s = run(scene, 60);
  const double slip_a = s[0].velocity.y + 0.5 * s[0].angular_velocity;
  const double slip_b = s[1].velocity.y - 0.5 * s[1].angular_velocity;
  // The pivots compare it with Coulomb's bound mu J_n = 10 * 2: within eight roundings of that, 3.6e-14.
  EXPECT_NEAR(slip_a, slip_b, 3e-14);
  EXPECT_NEAR(s[0].velocity.y, -s[1].velocity.y, 1e-15);
  EXPECT_NEAR(s[0].angular_velocity - 6, s[1].angular_velocity, 1e-14);
  EXPECT_NEAR(s[0].velocity.x, -1, 1e-15);
  EXPECT_NEAR(s[1].velocity.y, 0.5, 1e-14);  // J_t = slip / (2/m + 2 r^2/I) = 3/6
}

TEST(PreciseImpact, KinematicDiscsPush) {
  Scene scene = weightless("push");
  Body bat = ball("bat", {0, 0}, {2, 0});
  bat.type = BodyType::Kinematic;
  scene.bodies = {bat, ball("ball", {2, 0}, {-1, 0})};
  const auto s = run(scene, 60);
  EXPECT_NEAR(s[1].velocity.x, 5, 1e-14);
  EXPECT_EQ(s[0].velocity.x, 2);
}

TEST(PreciseImpact, FiltersAndJointsKeepDiscsApart) {
  Scene scene = weightless("ghosts");
  scene.bodies = {ball("a", {0, 0}, {2, 0}), ball("b", {1.5, 0})};
  for (Body& body : scene.bodies) body.shapes[0].filter.group = -1;
  EXPECT_EQ(run(scene, 60)[1].velocity.x, 0);

  Scene joined = weightless("joined");
  joined.bodies = {ball("a", {0, 0}, {0, 1}), ball("b", {0.7, 0}, {0, -1})};
  joined.joints = {DistanceJoint{"rod", "a", "b", {}, {}, 0.7, false}};
  EXPECT_EQ(make_precise_driver(joined, {}, {})->plan().stages.back().active, false);
}

TEST(PreciseImpact, NothingTunnels) {
  Scene scene = weightless("bullet");
  Body wall = ball("wall", {50, 0}, {}, 1, 0.01);
  wall.type = BodyType::Static;
  scene.bodies = {wall, ball("bullet", {0, 0}, {1e5, 0}, 1, 0.01)};
  EXPECT_NEAR(run(scene, 1)[1].velocity.x, -1e5, 1e-8);
}

TEST(PreciseImpact, GrazesEndWithoutImpulse) {
  Scene scene = weightless("graze");
  scene.bodies = {ball("a", {0, 0}, {1, 0}), ball("b", {3, 1})};
  const auto s = run(scene, 360);
  EXPECT_NEAR(s[0].velocity.x, 1, 1e-12);
  // A gap g that is rounding leaves a closing speed of v sqrt(2 g/r), r = 1 the distance of the centres. They
  // meet within 32 roundings of the farthest coordinate, 3.66: g = 2.6e-14, so 2.3e-7.
  EXPECT_NEAR(s[1].velocity.y, 0, 3e-7);
}

TEST(PreciseImpact, UnderDragTheImpactIsLocatedOnTheWay) {
  // x = v0 (1 - e^(-k t))/k reaches d at speed v0 - k d, and goes back from there.
  Scene scene = weightless("drag");
  Body wall = ball("wall", {3, 0});
  wall.type = BodyType::Static;
  scene.bodies = {wall, ball("ball", {0, 0}, {4, 0})};
  scene.forces = {LinearDrag{"ball", 0.5}};
  for (const double max_dt : {1.0 / 60, 1.0}) {
    const auto s = run(scene, static_cast<int>(std::lround(2 / max_dt)), {.max_dt = max_dt});
    const Real k = 0.5L, hit = -std::log(1 - k * 2 / 4) / k, v = 4 - k * 2, left = 2 - hit;
    EXPECT_NEAR(s[1].velocity.x, static_cast<double>(-v * std::exp(-k * left)), 2e-12) << max_dt;
    EXPECT_NEAR(s[1].position.x, static_cast<double>(2 - v * (1 - std::exp(-k * left)) / k), 2e-12) << max_dt;
  }
}

/// A bob that hangs at rest from the world by a string of length 1, and a ball that comes in.
Scene bob_and_ball(Vec2d from, Vec2d velocity) {
  Scene scene = weightless("bob");
  scene.bodies = {ball("bob", {0, -1}), ball("ball", from, velocity)};
  scene.joints = {DistanceJoint{"string", std::string(kWorld), "bob", {}, {}, 1, false}};
  return scene;
}

TEST(PreciseImpact, JointsTakePartInImpacts) {
  // From the side the bob takes all of the ball's velocity.
  auto s = run(bob_and_ball({-1.5, -1}, {2, 0}), 14);
  EXPECT_NEAR(s[1].velocity.x, 2, 1e-13);  // not there yet
  s = run(bob_and_ball({-1.5, -1}, {2, 0}), 18);
  EXPECT_NEAR(s[1].velocity.x, 0, 1e-12);
  EXPECT_NEAR(std::sqrt(length_squared(s[0].velocity)), 2, 1e-12);
  // Along the string it is as heavy as the world.
  s = run(bob_and_ball({0, -2.5}, {0, 2}), 30);
  EXPECT_NEAR(s[1].velocity.y, -2, 1e-12);
  EXPECT_NEAR(s[0].velocity.y, 0, 1e-12);
  // At 45 degrees: J = 2 v / (1/m + n_x^2/M), of which the bob keeps the x component.
  const double h = std::sqrt(0.5);
  s = run(bob_and_ball({-1.5 * h, -1 - 1.5 * h}, {2 * h, 2 * h}), 16);
  const double impulse = 2 * 2 / (1 + 0.5);
  EXPECT_NEAR(s[1].velocity.x, (2 - impulse) * h, 1e-12);
  EXPECT_NEAR(std::sqrt(length_squared(s[0].velocity)), impulse * h, 1e-12);
}

TEST(PreciseImpact, RodOnAHingeIsStruckAtItsEnd) {
  // I = m L^2/3 about the hinge: J = 2 v / (1/m + L^2/I) with the disc at the rod's end.
  Scene scene = weightless("rod");
  Body rod{
      .name = "rod", .position = {0, -1}, .angle = -kPi / 2, .mass = 3, .inertia = 1};  // L = 2: m L^2/12
  rod.shapes = {{.geometry = Circle{0.25}, .position = {1, 0}, .friction = 0, .restitution = 1}};
  scene.bodies = {rod, ball("ball", {-1, -2}, {3, 0}, 1, 0.25)};
  scene.joints = {RevoluteJoint{"hinge", std::string(kWorld), "rod", {}, {-1, 0}, false}};
  const auto s = run(scene, 15);
  const double impulse = 2 * 3 / (1 + 4 / 4.0);
  EXPECT_NEAR(s[1].velocity.x, 3 - impulse, 1e-12);
  EXPECT_NEAR(s[0].angular_velocity, impulse * 2 / 4, 1e-12);
}

TEST(PreciseImpact, DiscOffTheCentreOfASpinningBody) {
  // The disc at arm 1 turns at 2 rad/s into a still one that it meets when |(cos q, sin q) - c| = r + r.
  Scene scene = weightless("offset");
  Body arm{.name = "arm", .angular_velocity = 2, .mass = 1, .inertia = 0.5};
  arm.shapes = {{.geometry = Circle{0.25}, .position = {1, 0}, .friction = 0, .restitution = 1}};
  Body post = ball("post", {0, 1}, {}, 1, 0.25);
  post.type = BodyType::Static;
  scene.bodies = {arm, post};
  for (const double max_dt : {1.0 / 60, 1.0}) {
    const auto s = run(scene, static_cast<int>(std::lround(1 / max_dt)), {.max_dt = max_dt});
    const Real q = std::acos(-1.0L) / 2 - 2 * std::asin(0.25L), hit = q / 2;  // chord 0.5 = 2 sin(angle/2)
    const Real cx = std::cos(q), cy = std::sin(q), nx = -cx / 0.5L, ny = (1 - cy) / 0.5L;
    const Real lever = cx * ny - cy * nx, speed = 2 * lever;
    const Real impulse = 2 * speed / (1 + lever * lever / 0.5L);
    const Real w = 2 - impulse * lever / 0.5L;
    EXPECT_NEAR(s[0].angular_velocity, static_cast<double>(w), 1e-14) << max_dt;
    EXPECT_NEAR(s[0].angle, static_cast<double>(q + w * (1 - hit)), 1e-14) << max_dt;
    EXPECT_NEAR(s[0].velocity.x, static_cast<double>(-impulse * nx), 1e-14) << max_dt;
    EXPECT_NEAR(s[0].position.y, static_cast<double>(-impulse * ny * (1 - hit)), 1e-14) << max_dt;
  }
}

TEST(PreciseImpact, ManyDiscsKeepEnergyAndMomentum) {
  Scene scene = weightless("gas");
  for (int i = 0; i < 49; ++i) {
    const double x = 1.3 * (i % 7), y = 1.3 * (i / 7);
    scene.bodies.push_back(
        ball("ball" + std::to_string(i), {x, y}, {3 - x + 0.1 * y, 3 - 0.8 * y + 0.3 * x}, 1 + i % 3));
  }
  const auto driver = make_precise_driver(scene, {}, {});
  const auto sums = [&](const std::vector<BodyState>& states) {
    double energy = 0;
    Vec2d momentum{};
    for (int i = 0; i < 49; ++i) {
      energy += (1 + i % 3) * length_squared(states[i].velocity);
      momentum += (1.0 + i % 3) * states[i].velocity;
    }
    return std::pair{energy, momentum};
  };
  std::vector<BodyState> states(49);
  driver->read(states);
  const auto [energy, momentum] = sums(states);
  const auto [energy_after, momentum_after] = sums(advance(*driver, 49, 180));
  EXPECT_GT(driver->statistics().impacts, 30);
  EXPECT_NEAR(energy_after / energy, 1, 1e-13);
  EXPECT_NEAR(momentum_after.x, momentum.x, 1e-12);
  EXPECT_NEAR(momentum_after.y, momentum.y, 1e-12);
}

TEST(PreciseImpact, PilingUpBecomesRest) {
  for (const double restitution : {0.5, 0.0}) {
    Scene scene{.name = "rest"};
    Body ground = ball("ground", {0, 0});
    ground.type = BodyType::Static;
    scene.bodies = {ground, ball("ball", {0, 1.2})};
    set_material(scene, restitution, 0);
    EXPECT_NEAR(run(scene, 120)[1].position.y, 1, 1e-14) << restitution;
  }
}

TEST(PreciseUnsupported, BoxesAloneAreFine) {
  Scene scene{.name = "box"};
  scene.bodies = {{.name = "crate"}};
  scene.bodies[0].shapes = {{.geometry = Box{1, 1}}};
  EXPECT_EQ(precise_unsupported(scene), "");
  EXPECT_EQ(precise_unsupported(rods(5)), "");
}

/// The impact of a point with effective masses: normal and tangential rates before, and how an impulse along
/// each changes them (`nn`, `nt`, `tt`, 1/kg).
struct PointImpact {
  Real closing = 0, slip = 0, nn = 0, nt = 0, tt = 0;

  /// Returns the work (J) of Newton's restitution with Coulomb's friction: that of the one impulse in the
  /// friction cone whose slip afterwards it opposes.
  Real work(Real e, Real mu) const {
    const Real wanted = -(1 + e) * closing;
    const Real sticking = (-slip * nn - nt * wanted) / (nn * tt - nt * nt),
               held = (wanted - nt * sticking) / nn;
    if (std::abs(sticking) <= mu * held) return work_of(held, sticking);
    for (const Real side : {1.0L, -1.0L}) {
      const Real normal = wanted / (nn + side * mu * nt), tangential = side * mu * normal;
      if (normal > 0 && side * (slip + nt * normal + tt * tangential) <= 0)
        return work_of(normal, tangential);
    }
    return 0;
  }
  Real work_of(Real normal, Real tangential) const {
    return normal * (closing + (nn * normal + nt * tangential) / 2) +
           tangential * (slip + (nt * normal + tt * tangential) / 2);
  }
};

TEST(PreciseImpact, NoImpactGainsEnergyWhereNewtonsLawWithFrictionWould) {
  // T. R. Kane, Stanford Mechanics Alumni Club Newsletter 6, 1984: with friction and restitution, Newton's
  // law may give a falling rod more energy than it had. Impulses are then scaled down to those that keep it.
  int gains = 0, losses = 0;
  for (int i = 0; i < 400; ++i) {
    const double angle = 0.15 + 0.003 * i, e = 0.5 + 0.05 * (i % 11), mu = 0.2 + 0.1 * (i % 7);
    const Vec2d velocity{-6.0 + 0.5 * (i % 25), -3};
    Scene scene = weightless("rod");
    scene.bodies = {ground(mu, e), block("rod", {0, 2}, 2, 0.02, mu, e)};
    scene.bodies[1].mass = 1, scene.bodies[1].inertia = 1.0 / 3;
    scene.bodies[1].angle = angle, scene.bodies[1].velocity = velocity;
    const auto driver = make_precise_driver(scene, {}, {});
    while (driver->statistics().impacts == 0 && driver->time() < 2) driver->step();
    ASSERT_EQ(driver->statistics().impacts, 1) << i;
    std::vector<BodyState> s(2);
    driver->read(s);
    // The lower corner, from the centre: it is the first to meet the ground, as the rod does not turn before.
    const Real x = -std::cos(static_cast<Real>(angle)) + 0.01L * std::sin(static_cast<Real>(angle)),
               y = -std::sin(static_cast<Real>(angle)) - 0.01L * std::cos(static_cast<Real>(angle)),
               inertia = 1 / 3.0L;
    const PointImpact impact{velocity.y, velocity.x, 1 + x * x / inertia, -x * y / inertia,
                             1 + y * y / inertia};
    const Real work = impact.work(e, mu), before = (velocity.x * velocity.x + velocity.y * velocity.y) / 2.0L;
    const Real after =
        (length_squared(s[1].velocity) + inertia * s[1].angular_velocity * s[1].angular_velocity) / 2;
    EXPECT_NEAR(static_cast<double>(after), static_cast<double>(before + std::min(work, Real(0))), 1e-11)
        << i;
    (work > 0 ? gains : losses) += 1;
  }
  EXPECT_GT(gains, 20);
  EXPECT_GT(losses, 20);
}

// The corner of the next box is level with the face on which the disc rolls: within the rounding of a gap it
// is met before that face ends, along a normal that leans by its share of the radius. That is no impact.
TEST(PreciseImpact, ADiscThatRollsOverSeamsOfAFloorKeepsItsSpeed) {
  for (const double width : {1.0, 0.37}) {
    for (const double friction : {0.0, 0.5}) {
      for (const double e : {0.0, 0.5, 1.0}) {
        Scene scene{.name = "seams", .gravity = {0, -9.81}};
        const int tiles = static_cast<int>(9 / width);
        for (int i = 0; i < tiles; ++i) {
          scene.bodies.push_back(block("tile" + std::to_string(i), {i * width, -0.5}, width, 1, friction, e));
          scene.bodies.back().type = BodyType::Static;
        }
        scene.bodies.push_back(disc("disc", {0.1, 0.3}, {2, 0}, 0.3, friction, e));
        scene.bodies.back().angular_velocity = friction > 0 ? -2 / 0.3 : 0;
        const auto s = run(scene, 240);
        EXPECT_NEAR(s[tiles].position.x, 8.1, 1e-9) << width << ' ' << friction << ' ' << e;
        EXPECT_NEAR(s[tiles].position.y, 0.3, 1e-12) << width << ' ' << friction << ' ' << e;
        EXPECT_NEAR(s[tiles].velocity.x, 2, 1e-9) << width << ' ' << friction << ' ' << e;
      }
    }
  }
}

// A box strikes the corner of a tile twice, a tenth of a second apart. The time of the first blow is refined
// after its step was cut there; a state that is read before it, and after that step began, is still known.
TEST(PreciseImpact, StatesBeforeABlowAreKnownWhenItsTimeIsRefined) {
  Scene scene{.name = "beside a tile", .gravity = {0, -9.81}};
  scene.bodies = {
      {.name = "tile", .type = BodyType::Static, .position = {0, -0.5}, .shapes = {{.geometry = Box{1, 1}}}},
      {.name = "box",
       .position = {0, 2.638},
       .angle = 63.22185307179586,
       .velocity = {-0.528, -16},
       .angular_velocity = 6.08,
       .mass = 2.13255,
       .shapes = {{.geometry = Box{1.5, 1.4217}, .angle = -62.83185307179586}}}};
  set_material(scene, 0.8, 0);
  for (const double rate : {60.0, 59.5, 61.0, 240.0}) {
    const auto driver = make_precise_driver(scene, {.max_dt = 1 / rate}, {});
    for (int i = 0; i < 2.3 * rate; ++i) {
      driver->step();
      std::vector<BodyState> states(2);
      driver->read(states);
      ASSERT_TRUE(std::isfinite(states[1].position.x)) << rate << " " << i;
      if (i > 2.15 * rate) {
        EXPECT_NEAR(states[1].velocity.x, -12.046426, 1e-5) << rate << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace plumb
