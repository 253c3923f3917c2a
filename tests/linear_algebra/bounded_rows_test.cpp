#include "engine/linear_algebra/bounded_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

// Truth are the conditions of the problem itself, evaluated from the impulses: with
//     w = J (v + M^-1 J^T x) + C x - target
// a row has w = 0 between its bounds, w >= 0 at the lower one, and w <= 0 at the upper one.
namespace plumb {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double in(double a, double b) { return a + (b - a) * (double(engine_() >> 11) * 0x1p-53); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

struct Problem {
  BoundedRows system;
  std::vector<BoundedBody> start;
  std::vector<double> target;  // of the rows: solving may change theirs
};

// A chain of bodies, up to three rows between neighbours: joints, limits, brakes and springs.
void draw(Draw& of, int bodies, double ratio, Problem& out) {
  for (int i = 0; i <= bodies; ++i) {
    const double mass = std::pow(ratio, of.in(0, 1));
    BoundedBody body{.inverse_mass = {1 / mass, 1 / mass}, .inverse_inertia = of.in(1, 12) / mass};
    if (i == 0) body = {};
    body.velocity = {of.in(-1, 1), of.in(-1, 1)}, body.spin = of.in(-1, 1);
    out.system.bodies.push_back(body);
  }
  out.start.assign(out.system.bodies.begin(), out.system.bodies.end());
  std::vector<std::pair<int, int>> blocks;
  std::vector<int> sizes;
  for (int i = 0; i < bodies; ++i) {
    blocks.emplace_back(i, i + 1), sizes.push_back(1 + of.below(3));
    for (int k = 0; k < sizes.back(); ++k) {
      BoundedRow row{.a = i, .b = i + 1, .block = i};
      const Vec2d n{k == 1 ? 0.0 : 1.0, k == 1 ? 1.0 : 0.0};
      if (k < 2) row.linear_a = -n, row.linear_b = n;
      row.angular_a = k < 2 ? of.in(-0.5, 0.5) : -1, row.angular_b = k < 2 ? of.in(-0.5, 0.5) : 1;
      row.target = of.one_in(2) ? 0 : of.in(-1, 1);
      row.lower = -kUnbounded, row.upper = kUnbounded;
      switch (of.below(4)) {
        case 0:
          row.lower = 0;  // a limit
          break;
        case 1:
          row.lower = -0.1, row.upper = 0.1;  // a brake
          break;
        case 2:
          row.compliance = of.in(0, 1);  // a spring
          break;
        default:
          break;
      }
      out.system.rows.push_back(row);
    }
  }
  // Springs between bodies that are no neighbours: any loop can be closed.
  for (int i = of.below(3); i > 0 && bodies > 1; --i) {
    const int a = 1 + of.below(bodies - 1), b = a + 1 + of.below(bodies - a);
    BoundedRow row{.a = a, .b = b, .block = static_cast<int>(blocks.size())};
    row.linear_a = {-0.8, 0.6}, row.linear_b = {0.8, -0.6};
    row.compliance = of.in(0.1, 1), row.target = of.in(-1, 1);
    row.lower = -kUnbounded, row.upper = kUnbounded;
    out.system.rows.push_back(row);
    blocks.emplace_back(a, b), sizes.push_back(1);
  }
  out.system.order(blocks, sizes);
}

void note_wanted(Problem& it) {
  it.target.clear();
  for (const BoundedRow& row : it.system.rows) it.target.push_back(row.target);
}

// Chains of up to 8 bodies, a quarter of up to 30, of equal masses or up to 100 times apart.
void draw(Draw& of, Problem& out) {
  draw(of, 1 + of.below(of.one_in(4) ? 30 : 8), of.one_in(2) ? 1 : 100, out);
  note_wanted(out);
}

double along(const BoundedRow& row, const std::vector<BoundedBody>& bodies) {
  const BoundedBody &a = bodies[row.a], &b = bodies[row.b];
  return dot(row.linear_a, a.velocity) + row.angular_a * a.spin + dot(row.linear_b, b.velocity) +
         row.angular_b * b.spin;
}

double mobility(const BoundedRow& row, const std::vector<BoundedBody>& bodies) {
  double sum = 0;
  const auto add = [&](const BoundedBody& body, Vec2d n, double turn) {
    sum += body.inverse_mass.x * n.x * n.x + body.inverse_mass.y * n.y * n.y +
           body.inverse_inertia * turn * turn;
  };
  add(bodies[row.a], row.linear_a, row.angular_a), add(bodies[row.b], row.linear_b, row.angular_b);
  return sum;
}

// Returns whether the impulses meet the conditions, and the velocities are those that they cause.
bool is_solved(const Problem& it, double tolerance) {
  bool solved = true;
  std::vector<BoundedBody> moved = it.start;
  for (const BoundedRow& row : it.system.rows) {
    const auto push = [&](int body, Vec2d n, double turn) {
      BoundedBody& b = moved[body];
      b.velocity.x += b.inverse_mass.x * n.x * row.impulse;
      b.velocity.y += b.inverse_mass.y * n.y * row.impulse;
      b.spin += b.inverse_inertia * turn * row.impulse;
    };
    push(row.a, row.linear_a, row.angular_a), push(row.b, row.linear_b, row.angular_b);
  }
  double largest = 0;  // of the energies that rows want, as speeds of bodies of 1 kg
  for (std::size_t i = 0; i < it.target.size(); ++i) {
    const BoundedRow& row = it.system.rows[i];
    if (const double m = mobility(row, it.start); m > 0)
      largest =
          std::max(largest, std::max(std::abs(along(row, it.start)), std::abs(it.target[i])) / std::sqrt(m));
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const BoundedBody& body = it.system.bodies[i];
    solved = solved && length(body.velocity - moved[i].velocity) < 1e-9 &&
             std::abs(body.spin - moved[i].spin) < 1e-9;
  }
  for (std::size_t i = 0; i < it.target.size(); ++i) {
    const BoundedRow& row = it.system.rows[i];
    const double own = mobility(row, it.start);
    if (!(own > 0)) continue;
    const double w = (along(row, moved) + row.compliance * row.impulse - it.target[i]) / std::sqrt(own);
    const double off = tolerance * largest, impulse_off = tolerance * largest / std::sqrt(own);
    solved = solved && row.impulse >= row.lower - impulse_off && row.impulse <= row.upper + impulse_off;
    if (row.impulse > row.lower + impulse_off) solved = solved && w <= off;
    if (row.impulse < row.upper - impulse_off) solved = solved && w >= -off;
  }
  return solved;
}

// All rows are solved to ten times the violation of an inequality that is tolerated.
TEST(BoundedRows, SolvesChainsOfJointsLimitsBrakesAndSprings) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw of(seed);
    Problem it;
    draw(of, it);
    it.system.solve();
    EXPECT_TRUE(is_solved(it, 1e-8)) << "seed " << seed;
  }
}

// Adds contacts of two points between any of the bodies: each has four rays n + mu t, n - mu t, whose
// impulses are not negative, and of which one depends on the others.
void add_contacts(Draw& of, int count, Problem& out) {
  const int bodies = static_cast<int>(out.start.size());
  std::vector<std::pair<int, int>> blocks;
  std::vector<int> sizes;
  for (const BoundedRow& row : out.system.rows) {
    if (row.block < static_cast<int>(blocks.size())) {
      ++sizes[row.block];
      continue;
    }
    blocks.emplace_back(row.a, row.b), sizes.push_back(1);
  }
  for (int i = 0; i < count; ++i) {
    const int a = of.below(bodies), b = (a + 1 + of.below(bodies - 1)) % bodies;
    const double turn = of.in(-3, 3), friction = of.in(0.1, 1);
    const Vec2d n{std::cos(turn), std::sin(turn)}, t{n.y, -n.x};
    const double arm_a = of.in(-0.5, 0.5), arm_b = of.in(-0.5, 0.5), side_a = of.in(-0.5, 0.5),
                 side_b = of.in(-0.5, 0.5);
    for (const double point : {-0.3, 0.3}) {
      for (const double slope : {friction, -friction}) {
        BoundedRow row{.a = a, .b = b, .block = static_cast<int>(blocks.size())};
        row.linear_b = n + slope * t, row.linear_a = -row.linear_b;
        row.angular_a = -(arm_a + point + slope * side_a), row.angular_b = arm_b + point + slope * side_b;
        row.lower = 0, row.upper = kUnbounded;
        out.system.rows.push_back(row);
      }
    }
    blocks.emplace_back(a, b), sizes.push_back(4);
  }
  out.system.order(blocks, sizes);
}

// Rows that depend on each other share their load by a compliance of 1e-7. It leaves errors of 1e-7 of the
// impulses, which where bodies are wedged are many times what the velocities need. Of 20,000 such heaps 4 are
// not solved to 1e-5.
TEST(BoundedRows, SolvesHeapsOfJointedBodiesWithFriction) {
  int many = 0, unsolved = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draw of(seed);
    Problem it;
    const int bodies = 2 + of.below(8);
    draw(of, bodies, of.one_in(2) ? 1 : 100, it);
    // All may come to rest on the first body.
    for (BoundedRow& row : it.system.rows) row.target = 0;
    it.system.bodies[0].velocity = it.start[0].velocity = {}, it.system.bodies[0].spin = it.start[0].spin = 0;
    add_contacts(of, 1 + of.below(bodies + 2), it);
    note_wanted(it);
    it.system.solve();
    ++many, unsolved += is_solved(it, 1e-5) ? 0 : 1;
  }
  EXPECT_LE(1000 * unsolved, many);
}

double energy(std::span<const BoundedBody> bodies) {
  double sum = 0;
  for (const BoundedBody& body : bodies)
    if (body.is_dynamic())
      sum += 0.5 * (length_squared(body.velocity) / body.inverse_mass.x +
                    body.spin * body.spin / body.inverse_inertia);
  return sum;
}

// Rows that want no velocity take energy, also where masses are so far apart that impulses are inexact.
TEST(BoundedRows, GainNoEnergyWhateverTheMasses) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draw of(seed);
    Problem it;
    const int bodies = 2 + of.below(8);
    draw(of, bodies, std::pow(10, of.in(0, 12)), it);
    for (BoundedRow& row : it.system.rows) row.target = 0;
    it.system.bodies[0].velocity = it.start[0].velocity = {}, it.system.bodies[0].spin = it.start[0].spin = 0;
    add_contacts(of, 1 + of.below(bodies + 2), it);
    note_wanted(it);
    it.system.solve();
    EXPECT_LE(energy(it.system.bodies), energy(it.start) * (1 + 1e-9)) << "seed " << seed;
  }
}

// Bounds that follow other impulses, as friction's do, change between two solutions: brakes become weaker,
// stronger, or hold nothing.
TEST(BoundedRows, SolvesAgainAfterBoundsHaveChanged) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Draw of(seed);
    Problem it;
    draw(of, it);
    it.system.solve();
    for (int i = 0; i < 3; ++i) {
      for (BoundedRow& row : it.system.rows)
        if (std::isfinite(row.upper)) row.upper = of.one_in(3) ? 0 : of.in(0, 1), row.lower = -row.upper;
      it.system.solve_again();
      EXPECT_TRUE(is_solved(it, 1e-8)) << "seed " << seed << ", change " << i;
    }
  }
}

// Heaps that a moving body presses: no impulses reach all targets. Bounds change between solutions, as
// friction's do, and some exclude 0, as those of a row that must give an earlier impulse back: impulses that
// are scaled so that they gain no energy are then beyond their bounds, from which the next descent starts.
TEST(BoundedRows, StayFiniteWhereTheyContradictEachOtherAndTheirBoundsExclude0) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Draw of(seed);
    Problem it;
    const int bodies = 2 + of.below(8);
    draw(of, bodies, of.one_in(2) ? 1 : 100, it);
    add_contacts(of, 1 + of.below(bodies + 2), it);
    for (BoundedRow& row : it.system.rows) row.target = 0;
    it.system.bodies[bodies].inverse_mass = {}, it.system.bodies[bodies].inverse_inertia = 0;
    it.system.solve();
    for (int again = 0; again < 3; ++again) {
      for (BoundedRow& row : it.system.rows)
        if (std::isfinite(row.upper)) row.upper = of.in(-0.1, 0.1), row.lower = row.upper - of.in(0, 0.2);
      it.system.solve_again();
      for (const BoundedRow& row : it.system.rows)
        ASSERT_TRUE(std::isfinite(row.impulse)) << "seed " << seed << ", solution " << again;
    }
  }
}

// A single row has x = (target - J v) / (J M^-1 J^T).
TEST(BoundedRows, SolvesOneRowInClosedForm) {
  BoundedRows system;
  system.bodies = {{}, {.inverse_mass = {0.5, 0.5}, .inverse_inertia = 3, .velocity = {1, 2}, .spin = -1}};
  system.rows.push_back({.a = 0,
                         .b = 1,
                         .linear_a = {-0.6, -0.8},
                         .linear_b = {0.6, 0.8},
                         .angular_b = 0.5,
                         .target = 0.25,
                         .lower = -kUnbounded,
                         .upper = kUnbounded});
  const std::pair<int, int> block{0, 1};
  const int size = 1;
  system.order({&block, 1}, {&size, 1});
  system.solve();
  EXPECT_NEAR(system.rows[0].impulse, (0.25 - (0.6 + 1.6 - 0.5)) / (0.5 + 3 * 0.25), 1e-15);
}

// A body of 1 kg and 1 kg m^2 whose joint, an arm of 1 m away, is open by 0.2 m: alone it moves by 0.1 m and
// turns by 0.1 rad. A limit of its turn, open by 0.04 rad, stops that there, and it moves by the other 0.16
// m. A limit that is open by more changes nothing.
TEST(BoundedRows, CorrectsGapsWithoutOverrunningALimit) {
  for (const double open : {0.04, 0.3}) {
    BoundedRows system;
    system.bodies = {{}, {.inverse_mass = {1, 1}, .inverse_inertia = 1}};
    system.rows.push_back({.a = 0, .b = 1, .linear_b = {0, 1}, .angular_b = 1, .gap = 0.2});
    system.rows.push_back(
        {.a = 0, .b = 1, .angular_b = 1, .upper = kUnbounded, .gap = open, .state = BoundedRow::kLower});
    const std::pair<int, int> blocks[] = {{0, 1}};
    const int sizes[] = {2};
    system.order(blocks, sizes);
    system.correct(0);
    const double turn = std::min(open, 0.1);
    EXPECT_NEAR(system.displacements[1].rotation, -turn, 1e-15);
    EXPECT_NEAR(system.displacements[1].translation.y, -(0.2 - turn), 1e-15);
  }
}

// Rows that repeat each other share their load, and are held as one alone.
TEST(BoundedRows, SharesTheLoadOfRowsThatRepeatEachOther) {
  BoundedRows system;
  system.bodies = {{}, {.inverse_mass = {1, 1}, .inverse_inertia = 1, .velocity = {1, 0}}};
  for (int i = 0; i < 2; ++i)
    system.rows.push_back(
        {.a = 0, .b = 1, .linear_a = {-1, 0}, .linear_b = {1, 0}, .lower = -kUnbounded, .upper = kUnbounded});
  const std::pair<int, int> block{0, 1};
  const int size = 2;
  system.order({&block, 1}, {&size, 1});
  system.solve();
  EXPECT_NEAR(system.rows[0].impulse, -0.5, 1e-6);
  EXPECT_NEAR(system.rows[1].impulse, -0.5, 1e-6);
  EXPECT_NEAR(system.bodies[1].velocity.x, 0, 1e-11);
}

// Three bodies of 1 kg, side by side between a wall and what moves towards them at 1 m/s: no impulses keep
// all four gaps from closing. Least squares, weighted by the rows' mobilities of 1, 2, 2, 1 per kg, let the
// gaps close by 1/6, 1/3, 1/3 and 1/6 m/s. Of the impulses that give the bodies these velocities, those
// without tension press by 0 on the wall, and each next row by the momentum of the body before it more.
// Starting from the last impulses, as steps do, must not add to them.
TEST(BoundedRows, LetsRowsThatContradictEachOtherPressNoHarderThanTheMotionTakes) {
  BoundedRows system;
  const BoundedBody still{.inverse_mass = {1, 1}, .inverse_inertia = 1};
  const BoundedBody mover{.velocity = {-1, 0}};
  std::vector<std::pair<int, int>> blocks;
  for (int i = 0; i < 4; ++i) blocks.emplace_back(i, i + 1);
  const std::vector<int> sizes(4, 1);
  system.bodies = {{}, still, still, still, mover};
  for (int i = 0; i < 4; ++i)
    system.rows.push_back({.a = i,
                           .b = i + 1,
                           .linear_a = {-1, 0},
                           .linear_b = {1, 0},
                           .lower = 0,
                           .upper = kUnbounded,
                           .block = i});
  system.order(blocks, sizes);
  for (int step = 0; step < 50; ++step) {
    system.bodies = {{}, still, still, still, mover};
    for (BoundedRow& row : system.rows) row.target = 0;
    system.solve();
    const double velocities[] = {-1.0 / 6, -1.0 / 2, -5.0 / 6}, impulses[] = {0, 1.0 / 6, 2.0 / 3, 1.5};
    for (int i = 0; i < 3; ++i)
      ASSERT_NEAR(system.bodies[i + 1].velocity.x, velocities[i], 1e-5) << "step " << step;
    for (int i = 0; i < 4; ++i) ASSERT_NEAR(system.rows[i].impulse, impulses[i], 1e-5) << "step " << step;
  }
}

}  // namespace
}  // namespace plumb
