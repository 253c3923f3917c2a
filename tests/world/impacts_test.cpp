#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "engine/world/add_scene.h"
#include "tests/world/golden.h"
#include "tests/world/support.h"
#include "tests/world/threadings.h"
#include "tests/world/vector_widths.h"

// Impacts of discs: oblique ones, and those that are handed on. Truth is the closed form of two bodies
// (Newton's law along the line of centres), and that energy and momentum are kept or lost, never gained.
namespace plumb {
namespace {

constexpr double kRadius = 0.028575;  // m, of a pool ball

// A number from 0 to 1 that is the same everywhere.
double random(std::mt19937& from) { return static_cast<double>(from() % 10000) / 9999; }

BodyId add_disc(World& world, Vec2d position, Vec2d velocity, double radius, Material material) {
  return add_body(world, position, {.geometry = Circle{radius}, .material = material}, velocity);
}

struct Totals {
  double energy = 0;  // J
  Vec2d momentum{};   // kg m/s
};

Totals totals(const World& world) {
  Totals sum;
  for (const BodyId body : world.bodies()) {
    if (world.type(body) != BodyType::Dynamic) continue;
    const double spin = world.angular_velocity(body);
    sum.energy += 0.5 * world.mass(body) * length_squared(world.velocity(body)) +
                  0.5 * world.inertia(body) * spin * spin;
    sum.momentum += world.mass(body) * world.velocity(body);
  }
  return sum;
}

// A rack of `count` discs with `gap` between them, and a cue ball on its way to it.
void build_rack(World& world, std::mt19937& from, int count, double gap, Material material) {
  const double apart = 2 * kRadius + gap, speed = 1 + 9 * random(from);
  for (int row = 0, made = 0; made < count; ++row) {
    for (int i = 0; i <= row && made < count; ++i, ++made)
      add_disc(world, {row * apart * std::sqrt(0.75), (i - 0.5 * row) * apart}, {}, kRadius, material);
  }
  const double aside = 3 * (random(from) - 0.5) * kRadius, angle = 0.6 * (random(from) - 0.5);
  add_disc(world, {-0.3 - 0.1 * random(from), aside - 0.3 * std::tan(angle)},
           {speed * std::cos(angle), speed * std::sin(angle)}, kRadius, material);
}

// A break has some 100 impacts, each of which rounds the velocities of two discs to 2^-24 of themselves.
constexpr double kRounding = 100 * 2 * 0x1p-24;

TEST(Impacts, RacksGainNoEnergy) {
  std::mt19937 from(1);
  for (int i = 0; i < 120; ++i) {
    const double restitution = i % 3 == 0 ? 1 : 0.5 + 0.5 * random(from), friction = i % 2 == 0 ? 0 : 0.6;
    const double gap = i % 5 < 3 ? 0 : i % 5 == 3 ? 1e-4 : -1e-5;
    World world({.gravity = {0, 0}, .sleeping = false});
    build_rack(world, from, 3 + static_cast<int>(from() % 13), gap, {friction, restitution});
    const Totals before = totals(world);
    Totals last = before;
    for (int step = 0; step < 60; ++step) {
      world.step();
      const Totals now = totals(world);
      EXPECT_LE(now.energy, last.energy + kRounding * before.energy) << i << " " << step;
      last = now;
    }
    EXPECT_LT(last.energy, before.energy * (1 + kRounding)) << i;
    const bool keeps_it = restitution == 1 && friction == 0;
    EXPECT_GT(last.energy, keeps_it ? before.energy * (1 - kRounding) : 0) << i;
    EXPECT_LT(length_squared(last.momentum - before.momentum),
              kRounding * kRounding * length_squared(before.momentum))
        << i;
  }
}

// Impacts that are handed on move bodies back to where they met.
TEST(Impacts, LockedDiscsOfARackStayOnTheirLines) {
  std::mt19937 from(2);
  for (int i = 0; i < 40; ++i) {
    World world({.gravity = {0, 0}, .sleeping = false});
    build_rack(world, from, 6, 0, {0.6, 0.9});
    const std::vector<BodyId> discs = world.bodies();
    const BodyId in_x = discs[i % 6], in_y = discs[(i + 3) % 6];
    world.set_locks(in_x, true, false, false), world.set_locks(in_y, false, true, false);
    const double x = world.position(in_x).x, y = world.position(in_y).y;
    for (int step = 0; step < 60; ++step) {
      world.step();
      ASSERT_EQ(world.position(in_x).x, x) << i << " " << step;
      ASSERT_EQ(world.position(in_y).y, y) << i << " " << step;
    }
  }
}

// Two equal smooth discs; the target is thrown along the line of centres at contact, from the one that comes
// at v along x with its centre b beside it: sin(a) = b / 2 R, u = (1 + e)/2 v cos(a).
TEST(Impacts, ObliqueOnesThrowAlongTheLineOfCentres) {
  std::mt19937 from(2);
  for (int i = 0; i < 400; ++i) {
    const double radius = i % 2 == 0 ? 0.5 : kRadius, restitution = i % 4 < 2 ? 1 : 0.3;
    const double speed = std::pow(40, random(from)), beside = 1.96 * radius * random(from);
    const double away = 2 * radius + 0.3 + random(from);
    World world({.gravity = {0, 0}, .sleeping = false});
    const Material material{0, restitution};
    const BodyId cue = add_disc(world, {-away, beside}, {speed, 0}, radius, material);
    const BodyId target = add_disc(world, {0, 0}, {}, radius, material);
    run(world, 3 + static_cast<int>(70 * away / speed));
    const double sine = beside / (2 * radius), cosine = std::sqrt(1 - sine * sine);
    const double thrown = 0.5 * (1 + restitution) * speed * cosine;
    const Vec2d exact{thrown * cosine, -thrown * sine};
    // The line of centres is that of positions which continuous collision finds to 0.1 % of the radius:
    // turned by up to 0.001 tan(a).
    const double bound = speed * (2e-6 + 1e-3 * sine / cosine);
    EXPECT_LT(std::sqrt(length_squared(world.velocity(target) - exact)), bound) << i << " at " << speed;
    EXPECT_LT(std::sqrt(length_squared(world.velocity(cue) - (Vec2d{speed, 0} - exact))), bound) << i;
  }
}

TEST(Impacts, DiscsThatPassEachOtherDoNotTouch) {
  std::mt19937 from(3);
  for (int i = 0; i < 200; ++i) {
    const double radius = i % 2 == 0 ? 0.5 : kRadius, speed = std::pow(100, random(from));
    World world({.gravity = {0, 0}, .sleeping = false});
    add_disc(world, {-1.5 - random(from), radius * (2.001 + 0.3 * random(from))}, {speed, 0}, radius, {0, 1});
    const BodyId target = add_disc(world, {0, 0}, {}, radius, {0, 1});
    run(world, 3 + static_cast<int>(200 / speed));
    EXPECT_EQ(world.velocity(target), Vec2d{}) << i << " at " << speed;
  }
}

// A strong force presses a ball against the ground faster than a bounce starts; it stays.
TEST(Impacts, APressIsNone) {
  World world(without_sleep());
  add_ground(world);
  const BodyId ball = add_disc(world, {0, 0.5}, {}, 0.5, {0, 0.8});
  for (int i = 0; i < 120; ++i) {
    world.apply_force(ball, {0, -100 * kGravity * world.mass(ball)});
    world.step();
    // Let through in a substep it would be a h^2 = 17 mm deep; the contact's spring yields by 2 mm.
    EXPECT_NEAR(world.position(ball).y, 0.5, 5e-3) << i;
  }
  EXPECT_NEAR(world.velocity(ball).y, 0, 1e-3);
}

// A carriage on a guide is stopped by the ground in one substep, and a ball that comes after it meets it in a
// later one: it is at rest then, and the ball leaves at e times its speed. What stopped the carriage is as an
// impulse still there when the next substep begins, and must not throw it at the ball.
TEST(Impacts, AStopIsNoThrowAtTheNext) {
  constexpr double kSpeed = 6, kBounce = 0.8;
  for (int i = 8; i <= 40; ++i) {
    World world(weightless());
    const BodyId ground = add_ground(world);
    const double below = 0.004 * i, above = 0.002 * i;  // m; a substep is 0.025 m
    const BodyId carriage = add_body(world, {0, 0.5 + below}, {.geometry = Box{1, 1}}, {0, -kSpeed});
    world.create_joint(
        ground, carriage,
        {.kind = PrismaticDefinition{.anchor_a = {0, 0.5 + below}, .axis = {0, 1}}, .collide = true});
    const BodyId ball = add_body(
        world, {0, 1.2 + below + above},
        {.geometry = Circle{0.2}, .density = 1e-5, .material = {.restitution = kBounce}}, {0, -kSpeed});
    run(world, 12);
    EXPECT_NEAR(world.velocity(ball).y, kBounce * kSpeed, 1e-5 * kSpeed) << below << " " << above;
    EXPECT_NEAR(world.velocity(carriage).y, 0, 1e-5 * kSpeed) << below << " " << above;
  }
}

// Sequential impacts of pairs: the speed runs through the row, whether its balls touch or not.
TEST(Impacts, ACradleHandsTheSpeedOn) {
  for (const double gap : {0.0, 1e-4, 0.01, 0.3}) {
    World world({.gravity = {0, 0}, .sleeping = false});
    std::vector<BodyId> balls;
    for (int i = 0; i < 10; ++i) balls.push_back(add_disc(world, {i * (1 + gap), 0}, {}, 0.5, {0, 1}));
    const BodyId first = add_disc(world, {-2, 0}, {5, 0}, 0.5, {0, 1});
    run(world, 120);
    EXPECT_NEAR(world.velocity(balls.back()).x, 5, 5 * kRounding) << gap;
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(world.velocity(balls[i]).x, 0, 5 * kRounding) << gap << " " << i;
    EXPECT_NEAR(world.velocity(first).x, 0, 5 * kRounding) << gap;
  }
}

// Balls that touch, each smaller than the one before: rounding of their places makes some of them part at
// 1e-23 m/s. Whether a struck ball lies on the next is decided before the solver and after it, and both must
// agree: else neither the solver nor continuous collision has the impact, and the first ball stays in front
// of the row.
TEST(Impacts, ARowOfTouchingBallsIsStruckWhateverItsRounding) {
  constexpr double kShrinks = 0.8, kSpeed = 3.2;
  Scene scene{.name = "a row of balls", .gravity = {0, 0}};
  double radius = 0.216, mass = 0.023451863495341663, expected = kSpeed;
  for (const double x : {0.0, 0.95526, 1.2663, 1.515132, 1.7141975999999999}) {
    const bool first = scene.bodies.empty();
    scene.bodies.push_back({.name = "ball " + std::to_string(scene.bodies.size()),
                            .position = {x, 0},
                            .velocity = {first ? kSpeed : 0, 0},
                            .mass = mass,
                            .shapes = {{.geometry = Circle{radius}, .restitution = 1}}});
    if (!first) expected *= 2 / (1 + kShrinks * kShrinks);
    radius *= kShrinks, mass *= kShrinks * kShrinks;
  }
  BasicWorld<double> world(world_definition(scene));
  const SceneParts parts = add_scene(world, scene);
  for (int i = 0; i < 60; ++i) world.step(1.0 / 60, 4);
  EXPECT_NEAR(world.velocity(parts.bodies.back()).x, expected, 0.01 * expected);
}

// A ball that is gone again within the step of its impact has touched: told once, in that step, as it is that
// it ceased to.
TEST(Impacts, ThatLastNoStepAreReported) {
  for (const double restitution : {0.0, 0.6, 1.0}) {
    for (const double speed : {3.0, 20.0, 90.0}) {
      for (const bool hits : {false, true}) {
        World world({.gravity = {0, 0}, .sleeping = false});
        const Material material{0, restitution};
        add_disc(world, {0, 0}, {}, 0.5, material);
        add_body(world, {-4.03, 0.6}, {.geometry = Circle{0.5}, .material = material, .hit_events = hits},
                 {speed, 0});
        int begun = 0, ended = 0, struck = 0;
        for (int i = 0; i < 240; ++i) {
          world.step();
          const Events& events = world.events();
          struck += static_cast<int>(events.hits.size());
          begun += static_cast<int>(events.begin.size()), ended += static_cast<int>(events.end.size());
          if (!events.hits.empty() || (restitution > 0 && !events.begin.empty())) {
            EXPECT_EQ(events.begin.size(), 1u);
            EXPECT_GT(world.velocity(world.bodies()[0]).x, 0);
          }
          // Along the line of centres: 0.8 of the speed, with 0.6 of two radii beside it.
          for (const HitEvent& hit : events.hits) EXPECT_NEAR(hit.speed, 0.8 * speed, 2e-3 * speed);
        }
        EXPECT_EQ(begun, 1) << restitution << " " << speed;
        EXPECT_EQ(ended, 1) << restitution << " " << speed;
        EXPECT_EQ(struck, hits ? 1 : 0) << restitution << " " << speed;
      }
    }
  }
}

// Impacts that come at once are resolved at once: a rack that is hit in the middle parts evenly.
TEST(Impacts, AnEvenBreakIsEven) {
  World world({.gravity = {0, 0}, .sleeping = false});
  std::vector<BodyId> row[5];
  for (int r = 0; r < 5; ++r) {
    for (int i = 0; i <= r; ++i)
      row[r].push_back(add_disc(world, {2 * kRadius * r * std::sqrt(0.75), 2 * kRadius * (i - 0.5 * r)}, {},
                                kRadius, {0, 0.95}));
  }
  add_disc(world, {-0.4, 0}, {8, 0}, kRadius, {0, 0.95});
  run(world, 6);
  for (int r = 0; r < 5; ++r) {
    for (int i = 0; i <= r; ++i) {
      const Vec2d one = world.velocity(row[r][i]), other = world.velocity(row[r][r - i]);
      // Sweeps of a round end at 1e-6 of the speed; ten rounds and what follows multiply that.
      EXPECT_NEAR(one.x, other.x, 8 * 1e-4) << r << " " << i;
      EXPECT_NEAR(one.y, -other.y, 8 * 1e-4) << r << " " << i;
    }
  }
}

void expect_golden_racks(World& world) {
  std::mt19937 from(4);
  add_body(world, {0, -3}, {.geometry = Box{6, 0.5}, .density = 5, .material = {0.4, 0.7}});
  for (int i = 0; i < 4; ++i) build_rack(world, from, 15, 1e-5 * i, {0.3, 0.9});
  run(world, 300);
  test::expect_golden("racks_and_a_board", world.hash());
}

TEST(Impacts, HaveOneHashEverywhere) {
  test::at_each_vector_width([](VectorWidth) {
    World world({.gravity = {0, -1}, .sleeping = false});
    expect_golden_racks(world);
  });
}

TEST(Impacts, HaveOneHashEverywhereForEachNumberOfThreads) {
  test::at_each_threading<float>([](const auto& set) {
    World world({.gravity = {0, -1}, .sleeping = false});
    set(world);
    expect_golden_racks(world);
  });
}

// Rods that turn like gears, within reach of each other and never touching: 1.7e4 radians a step, of which a
// search follows two iterations each. 2000 searches of all their way would take 4 s, and take 0.06 s. They
// may stop on their way, and lose no speed by that.
TEST(Impacts, GearsThatSpinFastAreSearchedForSoLong) {
  constexpr int kRods = 1000;
  World world({.gravity = {0, 0}, .sleeping = false});
  std::vector<BodyId> rods;
  for (int i = 0; i < kRods; ++i) {
    BodyDefinition rod;
    rod.position = {1.5 * i, 0};
    rod.angle = i % 2 == 0 ? 0 : 0.5 * std::numbers::pi;
    rod.angular_velocity = i % 2 == 0 ? 1e6 : -1e6;
    rods.push_back(world.create_body(rod, ShapeDefinition{.geometry = Box{2, 0.02}}));
  }
  const std::clock_t begin = std::clock();
  world.step();
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 1);
  for (int i = 0; i < kRods; ++i) {
    EXPECT_EQ(world.position(rods[i]), (Vec2d{1.5 * i, 0})) << i;
    EXPECT_NEAR(std::abs(world.angular_velocity(rods[i])), 1e6, 1) << i;
  }
}

// Twenty discs and boxes without friction and losses in a closed box. Impacts at their times keep energy to
// the rounding of a velocity at each, some 20 of a body in ten seconds: 4 x 20 roundings of its energy.
template <class Real>
double energy_kept_by_a_gas(unsigned seed) {
  std::mt19937 from(seed);
  const auto any = [&](double low, double high) { return low + (high - low) * random(from); };
  const Material elastic{.friction = 0, .restitution = 1};
  BasicWorld<Real> world(weightless());
  const BodyId walls = world.create_body({.type = BodyType::Static});
  for (const Vec2d at : {Vec2d{0, -5.5}, Vec2d{0, 5.5}})
    world.create_shape(walls, {.geometry = Box{12, 1}, .position = at, .material = elastic});
  for (const Vec2d at : {Vec2d{-5.5, 0}, Vec2d{5.5, 0}})
    world.create_shape(walls, {.geometry = Box{1, 12}, .position = at, .material = elastic});
  std::vector<BodyId> bodies;
  for (int i = 0; i < 20; ++i) {
    BodyDefinition body{.position = {-4.0 + 2 * (i % 5), -4.0 + 2 * (i / 5)}, .angle = any(0, 6)};
    body.velocity = {any(-10, 10), any(-10, 10)}, body.angular_velocity = any(-4, 4);
    ShapeDefinition shape{.material = elastic};
    if (from() % 2 == 0) {
      shape.geometry = Circle{any(0.3, 0.7)};
    } else {
      shape.geometry = Box{any(0.5, 1.5), any(0.3, 0.8)};
    }
    bodies.push_back(world.create_body(body, shape));
  }
  const auto energy = [&] {
    double sum = 0;
    for (const BodyId body : bodies) {
      const double spin = world.angular_velocity(body);
      sum += 0.5 * world.mass(body) * length_squared(world.velocity(body)) +
             0.5 * world.inertia(body) * spin * spin;
    }
    return sum;
  };
  const double before = energy();
  run(world, 600);
  return energy() / before;
}

// In the last three, discs pass each other closely before one of them meets a wall.
TEST(Impacts, OfAGasKeepItsEnergy) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 25u, 44u, 111u}) {
    EXPECT_NEAR(energy_kept_by_a_gas<float>(seed), 1, 80 * 0x1p-23) << seed;
    EXPECT_NEAR(energy_kept_by_a_gas<double>(seed), 1, 1e-7) << seed;
  }
}

// The state of a random heap after each step, with hit events or without.
std::vector<std::uint64_t> hashes_of_a_heap(unsigned seed, bool hit_events) {
  std::mt19937 from(seed);
  const auto any = [&](double low, double high) { return low + (high - low) * random(from); };
  const Material material{.friction = any(0, 1), .restitution = seed % 2 == 0 ? 0 : any(0, 1)};
  DoubleWorld world;
  world.create_body({.type = BodyType::Static},
                    ShapeDefinition{.geometry = Box{30, 2}, .position = {0, -1}, .material = material});
  for (int i = 0; i < 25; ++i) {
    const double size = any(0.2, 0.5);
    const ShapeGeometry kinds[] = {Circle{size}, Box{size, size / 2},
                                   Capsule{{-size, 0}, {size, 0}, size / 3},
                                   Polygon{{{-size, -0.002}, {0, 0.002}, {size, -0.002}}}};
    BodyDefinition body{.position = {any(-5, 5), any(0.5, 8.5)}, .angle = any(0, 6)};
    body.velocity = {any(-10, 10), any(-30, 0)}, body.angular_velocity = any(-10, 10);
    const ShapeGeometry& geometry = seed % 3 == 0 ? kinds[0] : kinds[from() % 4];
    world.create_body(body,
                      ShapeDefinition{.geometry = geometry, .material = material, .hit_events = hit_events});
  }
  std::vector<std::uint64_t> hashes;
  for (int i = 0; i < 150; ++i) {
    world.step();
    hashes.push_back(world.hash());
  }
  return hashes;
}

// Events tell of the motion: asking for them changes no bit of it.
TEST(Impacts, MoveTheSameWhetherTheyAreReportedOrNot) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    EXPECT_EQ(hashes_of_a_heap(seed, true), hashes_of_a_heap(seed, false)) << seed;
}

// A heap of bouncing boxes and discs has no more energy, kinetic and potential, than it began with.
TEST(Impacts, BouncingHeapsGainNoEnergy) {
  for (const double restitution : {0.5, 1.0}) {
    World world(without_sleep());
    add_ground(world, {.restitution = restitution});
    for (int i = 0; i < 30; ++i) {
      const Vec2d at{1.1 * (i % 5) + 0.1 * (i % 3), 1 + 1.1 * (i / 5)};
      const Material material{0.3, restitution};
      if (i % 2 == 0) {
        add_disc(world, at, {}, 0.5, material);
      } else {
        add_body(world, at, {.geometry = Box{1, 0.8}, .material = material});
      }
    }
    const auto energy = [&] {
      double sum = totals(world).energy;
      for (const BodyId body : world.bodies()) {
        if (world.type(body) == BodyType::Dynamic)
          sum += world.mass(body) * kGravity * world.position(body).y;
      }
      return sum;
    };
    const double before = energy();
    double most = before;
    for (int i = 0; i < 600; ++i) world.step(), most = std::max(most, energy());
    EXPECT_LT(most, before * 1.01) << restitution;
  }
}

}  // namespace
}  // namespace plumb
