#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "engine/simulation/simulation.h"
#include "engine/world/add_scene.h"
#include "tests/world/solver_scenes.h"

// Springs of joints: what their frequency is that of, and that stiff ones are merely stiff.
namespace plumb {
namespace {

constexpr double kPi = 3.14159265358979323846;

int cases(int usual) {
  const char* times = std::getenv("PLUMB_PROPERTY_CASES");
  return times == nullptr ? usual : usual * std::atoi(times);
}

// A joint with a spring, alone, started away from rest; the coordinate that its spring pulls to 0.
struct Case {
  const char* name;
  std::function<std::function<double()>(DoubleWorld&, Spring)> make;
  double ratio = 1;  ///< of its frequency to the one asked for
};

// Springs of points are as stiff as the effective mass averaged over directions, 1/K along the bar and across
// it: with these in a ratio of R a bar that moves across swings sqrt((1 + R) / 2) times as fast as asked for.
double across(double ratio) { return std::sqrt((1 + ratio) / 2); }
constexpr double kInertiaOfBar = (2 * 2 + 0.3 * 0.3) / 12;  // m^2, times the mass

BodyId add_bar(DoubleWorld& world, Vec2d position, double density = 1) {
  return world.create_body({.position = position, .may_sleep = false},
                           {.geometry = Box{2, 0.3}, .density = density, .filter = {.group = -1}});
}

const Case kCases[] = {
    {"a hinge at the end of a bar",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId bar = add_bar(w, {1, 0});
       const JointId joint = w.create_joint(
           test::add_hook(w), bar,
           {.kind = RevoluteDefinition{.anchor_b = {-1, 0}, .spring = s, .target_angle = -0.05}});
       return [&w, joint] { return w.read(joint).angle + 0.05; };
     }},
    {"a hinge between two bars in the air",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId a = add_bar(w, {-1, 0}), b = add_bar(w, {1, 0}, 5);
       const JointId joint =
           w.create_joint(a, b,
                          {.kind = RevoluteDefinition{
                               .anchor_a = {1, 0}, .anchor_b = {-1, 0}, .spring = s, .target_angle = -0.02}});
       return [&w, joint] { return w.read(joint).angle + 0.02; };
     }},
    {"a weld that gives way in its angle",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId bar = add_bar(w, {1, 0});
       w.create_joint(
           test::add_hook(w), bar,
           {.kind = WeldDefinition{.anchor_b = {-1, 0}, .reference_angle = -0.05, .angular_spring = s}});
       return [&w, bar] { return w.angle(bar) + 0.05; };
     }},
    {"a weld that gives way at its point",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId a = add_bar(w, {-1, 0}), b = add_bar(w, {1, 0.05}, 3);
       w.create_joint(a, b,
                      {.kind = WeldDefinition{.anchor_a = {1, 0}, .anchor_b = {-1, 0}, .linear_spring = s}});
       return [&w, a, b] { return w.local_point(a, w.world_point(b, {-1, 0})).y; };
     },
     // Of 0.6 and 1.8 kg, which turn together, their centres 2 m apart.
     across(1 + 4 / (kInertiaOfBar * (0.6 + 1.8) * (1 / 0.6 + 1 / 1.8)))},
    {"a slider between two bars in the air",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId a = add_bar(w, {0, 0}), b = add_bar(w, {0.3, 1}, 2);
       const JointId joint = w.create_joint(
           a, b,
           {.kind = PrismaticDefinition{
                .anchor_a = {0.2, 0.5}, .anchor_b = {-0.1, -0.5}, .spring = s, .target_translation = -0.05}});
       return [&w, joint] { return w.read(joint).translation + 0.05; };
     }},
    {"a wheel that is held beside its centre",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId bar = add_bar(w, {0.6, 0.02});
       const JointId joint = w.create_joint(test::add_hook(w), bar,
                                            {.kind = WheelDefinition{.anchor_b = {-0.6, 0}, .spring = s}});
       return [&w, joint] { return w.read(joint).translation; };
     }},
    {"a mouse that holds a bar at its end",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId bar = add_bar(w, {1, 0.02});
       w.create_joint(
           test::add_hook(w), bar,
           {.kind = MouseDefinition{.anchor_b = {-1, 0}, .target = {0, 0}, .spring = s, .max_force = 1e9}});
       return [&w, bar] { return w.world_point(bar, {-1, 0}).y; };
     },
     across(1 + 1 / kInertiaOfBar)},
    {"a motor that drives a bar's angle",
     [](DoubleWorld& w, Spring s) -> std::function<double()> {
       const BodyId bar = add_bar(w, {0, 0});
       w.create_joint(test::add_hook(w), bar,
                      {.kind = MotorDefinition{
                           .target_angle = -0.05, .max_force = 1e9, .max_torque = 1e9, .spring = s}});
       return [&w, bar] { return w.angle(bar) + 0.05; };
     }},
};

// Hz, by the first and the fifth time that the coordinate falls through 0.
double seen_frequency(const Case& c, Solver solver, double hertz) {
  DoubleWorld world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
  const auto at = c.make(world, {hertz, 0});
  double last = at(), first = 0, time = 0;
  int falls = 0;
  while (falls < 5 && time < 10 / hertz) {
    world.step(1.0 / 480, 4);
    time += 1.0 / 480;
    const double now = at();
    if (last > 0 && now <= 0) {
      const double crossing = time - now / (now - last) / 480;
      if (++falls == 1) first = crossing;
      if (falls == 5) return 4 / (crossing - first);
    }
    last = now;
  }
  return 0;
}

TEST(Springs, SwingAtTheirFrequencyWhateverTheirBodiesAndArms) {
  for (const Solver solver : {Solver::SoftSteps, Solver::SequentialImpulses, Solver::Xpbd})
    for (const Case& c : kCases) EXPECT_NEAR(seen_frequency(c, solver, 2) / c.ratio, 2, 0.01) << c.name;
}

// A substep of h adds h w / 2 to the damping ratio, so that 1 does not pass.
TEST(Springs, OfDampingRatioOneDoNotPassTheirRest) {
  for (const Case& c : kCases) {
    DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
    const auto at = c.make(world, {2, 1});
    const double start = at();
    double lowest = start;
    for (int i = 0; i < 960; ++i) world.step(1.0 / 480, 4), lowest = std::min(lowest, at());
    EXPECT_GT(lowest, -2e-3 * start) << c.name;
    EXPECT_LT(std::abs(at()), 1e-3 * start) << c.name;
  }
}

// A spring beside rigid rows of its joint, from slow ones to those far beyond the substeps' rate, undamped
// ones too: a joint that lets go of its load before the spring is solved makes stiff springs explode.
TEST(Springs, AloneNeverSwingWiderThanTheyBegan) {
  for (const Case& c : kCases) {
    for (const double hertz : {5.0, 30.0, 100.0, 160.0, 240.0, 320.0, 1e3, 1e5}) {
      for (const double damping : {0.0, 0.1, 0.3, 1.0, 5.0}) {
        for (const bool falls : {false, true}) {
          DoubleWorld world({.gravity = {0, falls ? -10.0 : 0.0}, .sleeping = false});
          const auto at = c.make(world, {hertz, damping});
          const double start = at();
          for (int i = 0; i < 240; ++i) {
            world.step(1.0 / 60, 4);
            // A falling body passes its rest by as much again; slow springs give way by g / omega^2.
            const double omega = 2 * kPi * hertz, sag = falls ? 4 * 10 / (omega * omega) + 1e-3 : 0;
            ASSERT_LT(std::abs(at()), 1.02 * start + sag)
                << c.name << ' ' << hertz << ' ' << damping << ' ' << falls << ' ' << i;
          }
        }
      }
    }
  }
}

// A weight on a light bar: its inertia about its centre is a small part of that about the hinge. A hinge that
// lets go of a part of its load after the spring is solved then turns the body by many times what the spring
// does.
TEST(Springs, OfHingesAreStableWithInertiasThatAreSmallAboutTheCentre) {
  for (const double share : {1.0, 1e-2, 1e-4, 1e-6}) {
    for (const double hertz : {5.0, 100.0, 320.0, 1e5}) {
      for (const double damping : {0.0, 0.7}) {
        DoubleWorld world({.gravity = {0, 0}, .sleeping = false});
        const BodyId bar = world.create_body({.position = {1, 0}, .angular_velocity = 1, .may_sleep = false},
                                             {.geometry = Box{2, 0.3}, .filter = {.group = -1}});
        world.set_mass(bar, {.mass = 1, .inertia = share / 3});
        world.create_joint(
            test::add_hook(world), bar,
            {.kind = RevoluteDefinition{.anchor_b = {-1, 0}, .spring = Spring{hertz, damping}}});
        world.set_velocity(bar, {0, 1});
        for (int i = 0; i < 240; ++i) {
          world.step(1.0 / 60, 4);
          ASSERT_LT(std::abs(world.angular_velocity(bar)), 1.1)
              << share << ' ' << hertz << ' ' << damping << ' ' << i;
        }
      }
    }
  }
}

// Weights that hang from each other on springs, one below the other: each spring is as long as its load says.
TEST(Springs, RestWhereTheirLoadSays) {
  constexpr int kWeights = 4;
  for (const double hertz : {1.0, 4.0, 15.0, 30.0, 58.0, 100.0, 1e3, 1e5}) {
    for (const double damping : {0.3, 1.0, 10.0}) {
      if (hertz < 4 && damping != 1) continue;  // takes minutes
      DoubleWorld world({.sleeping = false});
      std::vector<BodyId> weights;
      BodyId above = test::add_hook(world);
      for (int i = 0; i < kWeights; ++i) {
        const BodyId weight = test::add_mass(world, {0, -1.0 - i}, 2, 1);
        world.create_joint(above, weight,
                           {.kind = PrismaticDefinition{
                                .anchor_b = {0, 1}, .axis = {0, 1}, .spring = Spring{hertz, damping}}});
        weights.push_back(above = weight);
      }
      for (int i = 0; i < 1800; ++i) world.step();
      double place = 0;
      const double omega = 2 * kPi * hertz;
      for (int i = 0; i < kWeights; ++i) {
        const double mobility = i == 0 ? 0.5 : 1.0, load = 2 * kGravity * (kWeights - i);
        place -= 1 + load * mobility / (omega * omega);
        const double sag = place + i + 1;
        EXPECT_NEAR(world.position(weights[i]).y, place, 0.01 * std::abs(sag) + 1e-6)
            << hertz << " " << damping;
        EXPECT_LT(std::abs(world.velocity(weights[i]).y), 1e-3) << hertz << " " << damping;
      }
    }
  }
}

// Boards on soft welds: stiffer springs sag less, and never do anything else.
TEST(Springs, OfWeldsAreMerelyStiff) {
  for (const double hertz : {10.0, 60.0, 80.0, 100.0, 200.0, 1e4}) {
    for (const int boards : {2, 6}) {
      World world({.sleeping = false});
      BodyId last = world.create_body({.type = BodyType::Static});
      for (int i = 0; i < boards; ++i) {
        const BodyId board =
            world.create_body({.position = {i + 0.5, 0}}, {.geometry = Box{1, 0.2}, .filter = {.group = -1}});
        world.create_joint(last, board,
                           {.kind = WeldDefinition{.anchor_a = {i > 0 ? 0.5 : 0.0, 0},
                                                   .anchor_b = {-0.5, 0},
                                                   .linear_spring = Spring{hertz, 0.7},
                                                   .angular_spring = Spring{hertz, 0.7}}});
        last = board;
      }
      for (int i = 0; i < 3000; ++i) {  // at 80 Hz six boards swing for 40 s
        world.step();
        ASSERT_LT(std::sqrt(length_squared(world.velocity(last))), 3.0 * boards) << hertz << " " << boards;
      }
      // Six boards droop, and swing for long: at 60 Hz they have 4 % of their speed left with small substeps.
      if (hertz <= 60 && boards == 6) continue;
      EXPECT_LT(std::sqrt(length_squared(world.velocity(last))), 1e-4) << hertz << " " << boards;
      if (hertz >= 60) {
        EXPECT_LT(std::abs(world.position(last).y), boards == 2 ? 4.5e-3 : 0.27) << hertz;
      }
    }
  }
}

// A heavy bar on a sprung hinge at the end of a light one, which turns about its middle: both come to rest at
// one angle, which Precise finds from the same scene.
TEST(Springs, OfHingesOnLightBodiesComeToRest) {
  for (const double hertz : {20.0, 110.0, 169.0, 1000.0}) {
    Scene scene;
    scene.gravity = {0, 0};
    scene.bodies = {{.name = "light", .mass = 1, .inertia = 0.1667},
                    {.name = "heavy",
                     .position = {2.4925062479170386, 0.14975012497024223},
                     .angle = 0.1,
                     .mass = 15,
                     .inertia = 23.3}};
    scene.joints = {RevoluteJoint{.name = "axle", .body_a = "world", .body_b = "light"},
                    RevoluteJoint{.name = "hinge",
                                  .body_a = "light",
                                  .body_b = "heavy",
                                  .anchor_a = {1, 0},
                                  .anchor_b = {-1.5, 0},
                                  .spring = Spring{hertz, 1}}};
    Simulation precise = compile(scene, Precise{.tolerance = 1e-9});
    precise.step(240);
    for (const Solver solver :
         {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses, Solver::Xpbd}) {
      WorldDefinition definition = world_definition(scene);
      definition.solver = solver;
      DoubleWorld world(definition);
      const SceneParts parts = add_scene(world, scene);
      for (int i = 0; i < 240; ++i) world.step();
      // Projections of positions do not quite keep the angular momentum: the arms change, the velocities not.
      const double near = solver == Solver::Xpbd ? 3e-3 : solver == Solver::Direct ? 1e-3 : 2e-4;
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(world.angle(parts.bodies[i]), precise.state(i).angle, near)
            << hertz << " " << name_of(solver);
    }
  }
}

template <class Real>
double kinetic_energy(const BasicWorld<Real>& world, const std::vector<BodyId>& bodies) {
  double sum = 0;
  for (const BodyId body : bodies) {
    const double spin = world.angular_velocity(body);
    sum += 0.5 * world.mass(body) * length_squared(world.velocity(body)) +
           0.5 * world.inertia(body) * spin * spin;
  }
  return sum;
}

// Any stiffness, any damping, in chains and stars that are thrown: no energy comes from springs.
template <class Real>
void throw_at_random(Solver solver, std::uint32_t seed) {
  std::mt19937 draw(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw);
  };
  BasicWorld<Real> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
  const bool star = draw() % 3 == 0;
  const int count = 2 + static_cast<int>(draw() % 9);
  std::vector<BodyId> bodies;
  const auto spring = [&] {
    return Spring{std::pow(10.0, uniform(-1, 5)), draw() % 3 == 0 ? 0 : std::pow(10.0, uniform(-2, 2))};
  };
  for (int i = 0; i < count; ++i) {
    const Vec2d at =
        star && i > 0 ? Vec2d{std::cos(6.28 * i / count), std::sin(6.28 * i / count)} : Vec2d{1.0 * i, 0};
    BodyDefinition body{
        .position = at, .velocity = {uniform(-1, 1), uniform(-1, 1)}, .angular_velocity = uniform(-1, 1)};
    bodies.push_back(world.create_body(
        body, {.geometry = Box{0.9, 0.3}, .density = uniform(0.5, 3), .filter = {.group = -1}}));
    if (i == 0) continue;
    const int to = star ? 0 : i - 1;
    const Vec2d middle = 0.5 * (at + world.position(bodies[to]));
    const Vec2d a = world.local_point(bodies[to], middle), b = world.local_point(bodies[i], middle);
    const auto join = [&](const JointKind& kind) {
      world.create_joint(bodies[to], bodies[i], {.kind = kind});
    };
    const double length = std::sqrt(length_squared(at - world.position(bodies[to])));
    switch (draw() % 7) {
      case 0:
        join(RevoluteDefinition{.anchor_a = a, .anchor_b = b, .spring = spring()});
        break;
      case 1:
        join(WeldDefinition{.anchor_a = a, .anchor_b = b, .angular_spring = spring()});
        break;
      case 2:
        join(PrismaticDefinition{.anchor_a = a, .anchor_b = b, .spring = spring()});
        break;
      case 3:
        join(WheelDefinition{.anchor_a = a, .anchor_b = b, .spring = spring()});
        break;
      case 4:
        join(WeldDefinition{.anchor_a = a, .anchor_b = b, .linear_spring = spring()});
        break;
      case 5:
        join(WeldDefinition{
            .anchor_a = a, .anchor_b = b, .linear_spring = spring(), .angular_spring = spring()});
        break;
      default:
        join(DistanceDefinition{.length = length, .spring = spring()});
    }
  }
  const double start = kinetic_energy(world, bodies);
  for (int i = 0; i < 240; ++i) {
    world.step();
    ASSERT_LT(kinetic_energy(world, bodies), 1.05 * start) << "seed " << seed << ", step " << i;
  }
}

TEST(Springs, MakeNoEnergyInWhateverIsThrown) {
  for (int seed = 1; seed <= cases(40); ++seed) {
    throw_at_random<float>(Solver::SoftSteps, static_cast<std::uint32_t>(seed));
    throw_at_random<double>(Solver::SoftSteps, static_cast<std::uint32_t>(seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace plumb
