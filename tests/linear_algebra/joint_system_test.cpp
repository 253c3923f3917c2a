#include "engine/linear_algebra/joint_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace plumb {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Joints of two rows each between pairs of bodies, with arbitrary Jacobians.
struct Problem {
  std::vector<Row<double>> rows;
  std::vector<double> inverse_mass, inverse_inertia;
};

Problem random_problem(const Pairs& pairs, int bodies, unsigned seed, int rows_each = 2) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  Problem problem;
  for (int i = 0; i < bodies; ++i) {
    problem.inverse_mass.push_back(uniform(0.5, 2));
    problem.inverse_inertia.push_back(uniform(0.5, 2));
  }
  for (const auto& [a, b] : pairs) {
    for (int i = 0; i < rows_each; ++i) {
      // Like a revolute joint's rows, so that the two of a joint never depend on each other.
      const Vec2d axis = i == 0 ? Vec2d{1, 0} : Vec2d{0, 1};
      problem.rows.push_back({a, b, -axis, axis, uniform(-1, 1), uniform(-1, 1), 0, 0});
    }
  }
  return problem;
}

using Matrix = std::vector<std::vector<long double>>;

/// J as a dense matrix with three columns a body.
Matrix dense_jacobian(const Problem& problem) {
  Matrix j(problem.rows.size(), std::vector<long double>(3 * problem.inverse_mass.size()));
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const Row<double>& row = problem.rows[i];
    const auto put = [&](int body, Vec2d linear, double angular) {
      if (body == kFixedFrame) return;
      j[i][3 * body] = linear.x;
      j[i][3 * body + 1] = linear.y;
      j[i][3 * body + 2] = angular;
    };
    put(row.a, row.linear_a, row.angular_a);
    put(row.b, row.linear_b, row.angular_b);
  }
  return j;
}

Matrix dense_system(const Problem& problem) {
  const Matrix j = dense_jacobian(problem);
  Matrix a(j.size(), std::vector<long double>(j.size()));
  for (std::size_t r = 0; r < j.size(); ++r) {
    for (std::size_t c = 0; c < j.size(); ++c) {
      for (std::size_t k = 0; k < j[r].size(); ++k) {
        const double weight = k % 3 == 2 ? problem.inverse_inertia[k / 3] : problem.inverse_mass[k / 3];
        a[r][c] += j[r][k] * weight * j[c][k];
      }
    }
  }
  return a;
}

/// Gaussian elimination with partial pivoting.
std::vector<long double> solve_dense(Matrix a, std::vector<long double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[best][k])) best = i;
    }
    std::swap(a[k], a[best]);
    std::swap(b[k], b[best]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const long double factor = a[i][k] / a[k][k];
      for (std::size_t c = k; c < n; ++c) a[i][c] -= factor * a[k][c];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t c = k + 1; c < n; ++c) b[k] -= a[k][c] * b[c];
    b[k] /= a[k][k];
  }
  return b;
}

std::vector<double> some_right_side(std::size_t n) {
  std::vector<double> b(n);
  for (std::size_t i = 0; i < n; ++i) b[i] = 1.0 + 0.25 * static_cast<double>(i % 7);
  return b;
}

JointSystem<double> system_of(const Problem& problem) {
  return {problem.rows, problem.inverse_mass, problem.inverse_inertia};
}

/// Largest difference from the dense solution, relative to the largest multiplier.
double error_against_dense(const Problem& problem) {
  JointSystem<double> system = system_of(problem);
  EXPECT_EQ(system.factor(problem.rows), 0);
  std::vector<double> x = some_right_side(problem.rows.size());
  const std::vector<long double> truth = solve_dense(dense_system(problem), {x.begin(), x.end()});
  system.solve(x);
  long double error = 0, scale = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, std::abs(x[i] - truth[i]));
    scale = std::max(scale, std::abs(truth[i]));
  }
  return static_cast<double>(error / scale);
}

Pairs chain(int links) {
  Pairs pairs;
  for (int i = 0; i < links; ++i) pairs.push_back({i - 1, i});
  return pairs;
}

Pairs tree(int bodies) {
  Pairs pairs{{kFixedFrame, 0}};
  for (int i = 1; i < bodies; ++i) pairs.push_back({(i - 1) / 2, i});
  return pairs;
}

Pairs star(int arms) {
  Pairs pairs;
  for (int i = 1; i <= arms; ++i) pairs.push_back({0, i});
  return pairs;
}

Pairs ring(int bodies) {
  Pairs pairs;
  for (int i = 0; i < bodies; ++i) pairs.push_back({i, (i + 1) % bodies});
  return pairs;
}

TEST(JointSystem, Chain) {
  for (const int n : {1, 2, 5, 40})
    EXPECT_LT(error_against_dense(random_problem(chain(n), n, 1)), 1e-13) << n;
}

TEST(JointSystem, Tree) { EXPECT_LT(error_against_dense(random_problem(tree(40), 40, 2)), 1e-13); }

TEST(JointSystem, Star) { EXPECT_LT(error_against_dense(random_problem(star(20), 21, 3)), 1e-13); }

TEST(JointSystem, Ring) { EXPECT_LT(error_against_dense(random_problem(ring(12), 12, 4)), 1e-12); }

TEST(JointSystem, RandomGraphs) {
  std::mt19937 random(5);
  for (unsigned seed = 0; seed < 50; ++seed) {
    const int bodies = 4 + static_cast<int>(random() % 30);
    Pairs pairs;
    for (int i = 0; i < bodies; ++i) {  // at most one row a body: never more rows than freedoms
      const int a = static_cast<int>(random() % (bodies + 1)) - 1;
      const int b = static_cast<int>(random() % bodies);
      if (a != b) pairs.push_back({a, b});
    }
    const Problem problem = random_problem(pairs, bodies, seed, 1);
    EXPECT_LT(error_against_dense(problem), 1e-11) << "seed " << seed;
  }
}

TEST(JointSystem, TreeInFloat) {
  const Problem exact = random_problem(tree(20), 20, 8);
  std::vector<Row<float>> rows;
  for (const Row<double>& r : exact.rows) {
    rows.push_back({r.a, r.b, r.linear_a.as<float>(), r.linear_b.as<float>(), static_cast<float>(r.angular_a),
                    static_cast<float>(r.angular_b), 0, 0});
  }
  const std::vector<float> mass(exact.inverse_mass.begin(), exact.inverse_mass.end());
  const std::vector<float> inertia(exact.inverse_inertia.begin(), exact.inverse_inertia.end());
  JointSystem<float> system(rows, mass, inertia);
  EXPECT_EQ(system.factor(rows), 0);
  const std::vector<double> b = some_right_side(rows.size());
  std::vector<float> x(b.begin(), b.end());
  system.solve(x);
  const std::vector<long double> truth = solve_dense(dense_system(exact), {b.begin(), b.end()});
  long double error = 0, scale = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error = std::max(error, std::abs(x[i] - truth[i]));
    scale = std::max(scale, std::abs(truth[i]));
  }
  EXPECT_LT(error, 5e-6L * scale);
}

TEST(JointSystem, CostIsLinearForChainsAndTrees) {
  // A chain of joints with two rows: one entry inside each joint's block, four towards the next one.
  for (const int n : {10, 100, 1000, 10000}) {
    EXPECT_EQ(system_of(random_problem(chain(n), n, 6)).nonzeros(), static_cast<std::size_t>(5 * n - 4)) << n;
    // A binary tree couples each joint with at most its parent and its sibling.
    EXPECT_LE(system_of(random_problem(tree(n), n, 6)).nonzeros(), static_cast<std::size_t>(9 * n)) << n;
  }
}

TEST(JointSystem, OrderOfTheSceneDoesNotMatterForFill) {
  Pairs pairs = chain(1000);
  std::mt19937 random(9);
  for (std::size_t i = pairs.size() - 1; i > 0; --i) std::swap(pairs[i], pairs[random() % (i + 1)]);
  EXPECT_EQ(system_of(random_problem(pairs, 1000, 7)).nonzeros(), 4996u);
}

TEST(JointSystem, RingHasLittleFill) {
  // Closing a chain adds one block a joint at most: 4 entries.
  EXPECT_LE(system_of(random_problem(ring(1000), 1000, 7)).nonzeros(), 9000u);
}

TEST(JointSystem, SolvesTwiceWithTheSameBits) {
  const Problem problem = random_problem(ring(8), 8, 10);
  JointSystem<double> system = system_of(problem);
  system.factor(problem.rows);
  std::vector<double> first = some_right_side(problem.rows.size()), second = first;
  system.solve(first);
  system.factor(problem.rows);
  system.solve(second);
  EXPECT_EQ(first, second);
}

TEST(JointSystem, RepeatedJointIsDependent) {
  Problem problem = random_problem(chain(3), 3, 11);
  const std::vector<Row<double>> once = problem.rows;
  const Problem single = problem;
  problem.rows.insert(problem.rows.end(), once.begin(), once.begin() + 2);  // the first joint again
  JointSystem<double> system = system_of(problem);
  EXPECT_EQ(system.factor(problem.rows), 2);

  // J^T x is what the single joints give; the doubled rows share the load of which one part is zero.
  std::vector<double> b = some_right_side(once.size());
  std::vector<double> x = b;
  x.insert(x.end(), b.begin(), b.begin() + 2);
  system.solve(x);
  const std::vector<long double> truth = solve_dense(dense_system(single), {b.begin(), b.end()});
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double doubled = i < 2 ? x[once.size() + i] : 0;
    EXPECT_NEAR(x[i] + doubled, static_cast<double>(truth[i]), 1e-12);
    EXPECT_TRUE(i >= 2 || x[i] == 0 || doubled == 0);
  }
}

TEST(JointSystem, RowsBetweenThingsThatDoNotMoveAreDependent) {
  Problem problem = random_problem({{kFixedFrame, 0}, {0, 1}, {1, 2}}, 3, 12);
  problem.inverse_mass[0] = problem.inverse_inertia[0] = 0;
  JointSystem<double> system = system_of(problem);
  EXPECT_EQ(system.factor(problem.rows), 2);
  std::vector<double> x = some_right_side(problem.rows.size());
  system.solve(x);
  EXPECT_EQ(x[0], 0);
  EXPECT_EQ(x[1], 0);
}

TEST(JointSystem, RefinementGivesHeavyTipsTheirDigitsBack) {
  // Ten light point masses on a line and a heavy one at the tip. The tension in every link is the weight
  // below it, in closed form: lambda_k = g (sum of the masses from k on).
  const int n = 11;
  const double heavy = 1e6;
  std::vector<Row<double>> rows;
  std::vector<double> inverse_mass(n, 1.0), inverse_inertia(n, 0.0);
  inverse_mass[n - 1] = 1 / heavy;
  for (int i = 0; i < n; ++i) rows.push_back({i - 1, i, {0, 1}, {0, -1}, 0, 0, 0, 0});
  JointSystem<double> system(rows, inverse_mass, inverse_inertia);
  EXPECT_EQ(system.factor(rows), 0);
  const double g = 9.81;
  std::vector<double> x(n, 0.0);
  x[0] = g;  // A lambda = -J g: only the link to the fixed frame feels gravity's acceleration
  const std::vector<double> right_side = x;
  system.solve(x);
  system.refine(rows, right_side, x);
  for (int i = 0; i < n; ++i) {
    const double below = heavy + (n - 1 - i);
    EXPECT_NEAR(x[i] / (g * below), 1, 1e-14) << i;
  }
}

TEST(JointSystem, Empty) {
  JointSystem<double> system({}, {}, {});
  EXPECT_EQ(system.factor({}), 0);
  system.solve({});
  EXPECT_EQ(system.nonzeros(), 0u);
}

}  // namespace
}  // namespace plumb
