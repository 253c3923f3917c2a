#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "engine/world/contact_solver/contact_impact.h"
#include "engine/world/contact_solver/locked_axes.h"
#include "tests/world/support.h"

// Impacts that friction jams (Painleve): bodies with one freedom, and others with little more. With K the
// mobility of the contact along normal and tangent, truth is what holds of any impact against a body at rest:
// the impulse P lies in the cone of friction, its work P . (u + K P / 2) is not positive, the approach ends,
// and the rebound is at most e times the approach.
namespace plumb {
namespace {

template <class Real>
class JammingImpacts : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(JammingImpacts, Precisions);

const Solver kSolvers[] = {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses, Solver::Jakobsen,
                           Solver::Xpbd};

// Rows may be off what is locked by a thousandth of a radian, which lets an impulse be a thousand times the
// load: twice that many roundings, of the world's numbers, or of the law that is solved in double.
template <class Real>
double rounding() {
  return std::max(2000 * static_cast<double>(std::numeric_limits<Real>::epsilon()), 3e-8);
}

class Dice {
 public:
  explicit Dice(unsigned seed) : dice_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(dice_()) * 0x1p-32;
  }
  int one_of(int count) { return static_cast<int>(dice_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937 dice_;
};

// A bead on an upright rail falls onto a slope whose normal is (sin angle, cos angle): it slides as far as
// friction lets it. Newton's law throws it back with e v unless the cone of friction contains the horizontal.
TYPED_TEST(JammingImpacts, ABeadOnARailReboundsUnlessTheConeOfFrictionHoldsIt) {
  constexpr double kSpeed = 4, kRestitution = 0.5;
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct, Solver::SequentialImpulses}) {
    for (const double angle : {0.5, 0.9, 1.1}) {
      const double jams = 1 / std::tan(angle);
      for (const double friction : {0.0, 0.9 * jams, 1.1 * jams, 3.0 * jams}) {
        BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = solver});
        const Material material{.friction = friction, .restitution = kRestitution};
        world.create_body({.type = BodyType::Static, .angle = -angle},
                          ShapeDefinition{.geometry = Box{6, 1}, .material = material});
        const BodyId bead = world.create_body(
            {.position = {0, 2.7}, .velocity = {0, -kSpeed}, .lock_x = true, .lock_rotation = true},
            ShapeDefinition{.geometry = Circle{0.3}, .material = material});
        double fastest = -kSpeed;
        for (int step = 0; step < 60; ++step) {
          world.step();
          fastest = std::max(fastest, world.velocity(bead).y);
        }
        EXPECT_NEAR(fastest, friction < jams ? kRestitution * kSpeed : 0, kSpeed * rounding<TypeParam>())
            << static_cast<int>(solver) << " " << angle << " " << friction;
      }
    }
  }
}

enum Freedom { kAlongY, kAlongX, kTurning, kAlongYAndTurning, kFree };

struct Throw {
  Freedom freedom = kFree;
  Solver solver = Solver::SoftSteps;
};

// Throws a body against one at rest. Returns by which fraction its kinetic energy has grown at most.
template <class Real>
double largest_gain(Throw how, unsigned seed, int& struck) {
  Dice dice(seed);
  const Material material{.friction = dice.between(0, 3), .restitution = dice.between(0, 1)};
  BasicWorld<Real> world({.gravity = {0, 0}, .sleeping = false, .solver = how.solver});
  BodyDefinition obstacle{.type = BodyType::Static, .angle = dice.between(0, 6.2)};
  ShapeDefinition shape{.material = material};
  if (dice.one_of(2) == 0) {
    shape.geometry = Box{3, 0.3};
  } else {
    shape.geometry = Box{1, 1};
  }
  world.create_body(obstacle, shape);
  const bool turns = how.freedom == kTurning, only_x = how.freedom == kAlongX;
  BodyDefinition body{.angle = dice.between(0, 6.2)};
  const double to = dice.between(0, 6.2);
  if (turns) {
    body.position = dice.between(1, 3) * Vec2d{std::cos(to), std::sin(to)};
  } else {
    const Vec2d along = how.freedom == kFree ? Vec2d{std::cos(to), std::sin(to)}
                        : only_x             ? Vec2d{1, 0}
                                             : Vec2d{0, 1};
    body.position = -2.8 * along + dice.between(-1.6, 1.6) * Vec2d{along.y, -along.x};
    body.velocity = dice.between(0.5, 8) * along;
  }
  body.lock_x = turns || how.freedom == kAlongY || how.freedom == kAlongYAndTurning;
  body.lock_y = turns || only_x;
  body.lock_rotation = only_x || how.freedom == kAlongY;
  if (!body.lock_rotation) body.angular_velocity = dice.between(-8, 8);
  switch (dice.one_of(turns || how.freedom == kFree ? 2 : 4)) {
    case 0:
      shape.geometry = Box{turns ? 2.0 : 1.2, 0.1};
      break;
    case 1:
      shape.geometry = Capsule{{-0.6, 0}, {0.6, 0}, 0.05};
      break;
    case 2:
      shape.geometry = Circle{0.3};
      break;
    default:
      shape.geometry = Polygon{{{-0.3, -0.2}, {0.3, -0.2}, {0.1, 0.3}}, 0.05};
  }
  const BodyId thrown = world.create_body(body, shape);
  const auto energy = [&] {
    const Vec2d v = world.velocity(thrown);
    const double spin = world.angular_velocity(thrown);
    return 0.5 * world.mass(thrown) * dot(v, v) +
           (body.lock_rotation ? 0 : 0.5 * world.inertia(thrown) * spin * spin);
  };
  const double before = energy();
  double largest = 0;
  for (int step = 0; step < 60; ++step) {
    world.step();
    if (step == 0 && energy() != before) return 0;  // laid into the obstacle: it is pushed out
    largest = std::max(largest, energy());
  }
  if (energy() != before) ++struck;
  return largest / before - 1;
}

TYPED_TEST(JammingImpacts, OfABodyWithOneFreedomGainNoEnergyWithAnySolver) {
  for (const Solver solver : kSolvers) {
    for (const Freedom freedom : {kAlongY, kAlongX, kTurning}) {
      int struck = 0;
      for (unsigned seed = 0; seed < 800; ++seed) {
        // Position-based projection turns overlap into motion, which turning bodies get.
        if (solver == Solver::Jakobsen && freedom == kTurning) continue;
        EXPECT_LE(largest_gain<TypeParam>({freedom, solver}, seed, struck), rounding<TypeParam>())
            << static_cast<int>(solver) << " " << freedom << " " << seed;
      }
      if (solver != Solver::Jakobsen || freedom != kTurning) {
        EXPECT_GT(struck, 80) << freedom;
      }
    }
  }
}

TYPED_TEST(JammingImpacts, OfRodsGainNoEnergy) {
  for (const Solver solver : {Solver::SoftSteps, Solver::Direct}) {
    for (const Freedom freedom : {kAlongYAndTurning, kFree}) {
      int struck = 0;
      for (unsigned seed = 0; seed < 800; ++seed)
        EXPECT_LE(largest_gain<TypeParam>({freedom, solver}, seed, struck), rounding<TypeParam>())
            << static_cast<int>(solver) << " " << freedom << " " << seed;
      EXPECT_GT(struck, 300) << freedom;
    }
  }
}

// A contact at one point, with the rows that the engine gives it.
template <class Real>
struct Struck {
  SolverBody<Real> a, b;
  ContactConstraint<Real> c;
  double k[2][2] = {}, rate[2] = {};  // along normal and tangent

  double doubled_energy() const {
    double sum = 0;
    for (const SolverBody<Real>* body : {&a, &b}) {
      const Vec2d v = body->velocity.template as<double>();
      const double spin = static_cast<double>(body->angular_velocity);
      if (body->inverse_mass > 0) sum += dot(v, v) / static_cast<double>(body->inverse_mass);
      if (body->inverse_inertia > 0) sum += spin * spin / static_cast<double>(body->inverse_inertia);
    }
    return sum;
  }
};

// Computes the mobility and the rates from the rows. Not inlined, so that these have been rounded to `Real`.
template <class Real>
[[gnu::noinline]] void measure(Struck<Real>& s) {
  const Vec2<Real> n = s.c.normal, t{n.y, -n.x};
  const double arms[2][2] = {{double(s.c.arm_a[0]), double(s.c.arm_b[0])},
                             {double(s.c.arm_tangent_a), double(s.c.arm_tangent_b)}};
  const Vec2d rows[2] = {n.template as<double>(), t.template as<double>()};
  for (int i = 0; i < 2; ++i) {
    s.rate[i] = dot(rows[i], s.b.velocity.template as<double>() - s.a.velocity.template as<double>()) +
                arms[i][1] * double(s.b.angular_velocity) - arms[i][0] * double(s.a.angular_velocity);
    for (int j = 0; j < 2; ++j) {
      s.k[i][j] = linear_response(s.a, s.b, s.c.locks, rows[i], rows[j], i == j) +
                  double(s.a.inverse_inertia) * arms[i][0] * arms[j][0] +
                  double(s.b.inverse_inertia) * arms[i][1] * arms[j][1];
    }
  }
}

template <class Real>
Struck<Real> struck_at_random(Dice& dice) {
  Struck<Real> s;
  const int freedom = dice.one_of(5);
  const bool both_dynamic = dice.one_of(3) == 0;
  const double angle = dice.between(0, 6.28);
  s.c.count = 1, s.c.friction = static_cast<Real>(dice.between(0, 3));
  s.c.normal = {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
  const unsigned locked[] = {0, 0, kLockBX, kLockBY, kLockBX};
  s.c.locks = static_cast<std::uint8_t>(locked[freedom] | (both_dynamic && freedom > 2 ? kLockAX : 0u));
  const auto set = [&](SolverBody<Real>& body, unsigned locks, bool turns, bool moves) {
    body.inverse_mass = static_cast<Real>(moves ? dice.between(0.1, 2) : 0);
    body.inverse_inertia = static_cast<Real>(turns ? std::exp(dice.between(-3, 5)) : 0);
    if (moves)
      body.velocity = {static_cast<Real>(dice.between(-5, 5)), static_cast<Real>(dice.between(-5, 5))};
    if (turns) body.angular_velocity = static_cast<Real>(dice.between(-9, 9));
    body.velocity = free_of_a(body.velocity, locks);
  };
  if (both_dynamic) set(s.a, s.c.locks, dice.one_of(2) == 0, true);
  set(s.b, s.c.locks / kLockBX, freedom != 2 && freedom != 3, freedom != 1);
  const Vec2<Real> n = s.c.normal, t{n.y, -n.x};
  const auto arm = [&] { return static_cast<Real>(dice.between(-1, 1)); };
  s.c.arm_a[0] = arm(), s.c.arm_b[0] = arm(), s.c.arm_tangent_a = arm(), s.c.arm_tangent_b = arm();
  const auto mobility = [&](Vec2<Real> row, Real arm_a, Real arm_b) {
    return linear_response(s.a, s.b, s.c.locks, row, row, true) + s.a.inverse_inertia * arm_a * arm_a +
           s.b.inverse_inertia * arm_b * arm_b;
  };
  const Real least = least_mobility(s.a, s.b, s.c.arm_tangent_a * s.c.arm_tangent_a,
                                    s.c.arm_tangent_b * s.c.arm_tangent_b),
             k_n = mobility(n, s.c.arm_a[0], s.c.arm_b[0]),
             k_t = mobility(t, s.c.arm_tangent_a, s.c.arm_tangent_b);
  s.c.mass[0] = k_n > least ? 1 / k_n : Real(0);
  // Both rows are kept, whatever the law then makes of them.
  s.c.tangent_mass = k_t > least ? 1 / k_t : Real(0);
  measure(s);
  return s;
}

TYPED_TEST(JammingImpacts, OfAnyMobilityKeepTheLaws) {
  Dice dice(3);
  int solved = 0, jammed = 0;
  for (int i = 0; i < 60000; ++i) {
    const Struck<TypeParam> s = struck_at_random<TypeParam>(dice);
    const double restitution = dice.between(0, 1);
    if (!(s.c.mass[0] > 0) || s.rate[0] >= 0) continue;
    const double approach = -s.rate[0], target[2] = {restitution * approach, 0};
    const ImpactImpulses by = solve_impact(s.a, s.b, s.c, {true, false}, target);
    ++solved;
    if (by.jammed) ++jammed;
    const double p[2] = {by.normal[0], by.friction};
    const double change[2] = {s.k[0][0] * p[0] + s.k[0][1] * p[1], s.k[1][0] * p[0] + s.k[1][1] * p[1]};
    const double speed = approach + std::abs(s.rate[1]);
    const double work = p[0] * (s.rate[0] + change[0] / 2) + p[1] * (s.rate[1] + change[1] / 2);
    const double after = s.rate[0] + change[0];
    EXPECT_GE(p[0], 0) << i;
    EXPECT_EQ(by.normal[1], 0) << i;
    EXPECT_LE(std::abs(p[1]), double(s.c.friction) * p[0] * (1 + 1e-9)) << i;
    EXPECT_LE(work, 3e-8 * speed * p[0]) << i;
    // A point that sticks, and has less than a millionth of the mobility along the normal then, may approach
    // at what this millionth contains of the kinetic energy.
    EXPECT_GE(after, by.jammed ? -1e-3 * std::sqrt(s.k[0][0] * s.doubled_energy()) : -1e-6 * speed) << i;
    EXPECT_LE(after, restitution * approach + 1e-6 * speed) << i;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(solved, 20000);
  EXPECT_GT(jammed, 1000);
}

// A contact does not push where the normal is a thousandth of a radian or less off what is locked. The
// overlap that grows meanwhile must not do it either.
TYPED_TEST(JammingImpacts, ABodyPushedAcrossItsRailStays) {
  for (const double offset : {0.0, 1e-9, 1e-7, 1e-6}) {
    BasicWorld<TypeParam> world({.gravity = {0, 0}, .sleeping = false, .solver = Solver::SequentialImpulses});
    const BodyId bead = world.create_body({.position = {0, offset}, .lock_x = true, .lock_rotation = true},
                                          ShapeDefinition{.geometry = Circle{0.2}});
    world.create_body({.type = BodyType::Kinematic, .position = {-0.5, 0}, .velocity = {0.5, 0}},
                      ShapeDefinition{.geometry = Circle{0.2}});
    run(world, 30);  // the centres are 0.25 m apart
    EXPECT_EQ(world.velocity(bead), Vec2d{}) << offset;
  }
}

}  // namespace
}  // namespace plumb
