// Judges the linear solvers of both engines with random systems, some with rows that nearly depend on others.
// Compares with an independent elimination in long double, and checks the conditions of a solution.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "engine/linear_algebra/bounded_rows.h"
#include "engine/linear_algebra/complementarity.h"
#include "engine/linear_algebra/dense_system.h"
#include "engine/linear_algebra/envelope_matrix.h"
#include "engine/linear_algebra/joint_system.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {
namespace {

using Wide = long double;

constexpr int kDraws = 12;  // number of systems of each kind per scene
// Distance of a pivot from a threshold, as a fraction of it, below which rounding the matrix to double may
// move the pivot to the other side.
constexpr double kNearThreshold = 0.01;
// Pivot below which it counts as rounding in systems of doubles, as a fraction of the largest entry or of the
// diagonal.
constexpr double kDependent = 1e-12;

/// Pivots of complete pivoting in long double, in their order. Also says if two candidates were so close that
/// rounding may have chosen between them.
std::vector<Wide> pivots_of(std::size_t n, const std::vector<double>& matrix) {
  std::vector<Wide> a(matrix.begin(), matrix.end()), out;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t row = k, column = k;
    for (std::size_t i = k; i < n; ++i)
      for (std::size_t j = k; j < n; ++j)
        if (std::fabs(a[i * n + j]) > std::fabs(a[row * n + column])) row = i, column = j;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[row * n + j]);
    for (std::size_t i = 0; i < n; ++i) std::swap(a[i * n + k], a[i * n + column]);
    out.push_back(std::fabs(a[k * n + k]));
    if (out.back() == 0) break;
    for (std::size_t i = k + 1; i < n; ++i) {
      const Wide factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
    }
  }
  return out;
}

/// Returns a fraction near `threshold`, above or below it, or one far above it.
double some_share(Random& random, double threshold) {
  return random.chance(0.7) ? threshold * (0.8 + 0.4 * random.unit()) : 0.01 + 0.9 * random.unit();
}

double some_number(Random& random) { return 2 * random.unit() - 1; }

std::string residual_of(std::size_t n, const std::vector<double>& matrix, const std::vector<double>& x,
                        const std::vector<double>& right, double largest, double known, const char* what) {
  // The largest unknown: a row that the solver treats as redundant has a residual in proportion to it.
  Wide most = known;
  for (const double each : x) most = std::max<Wide>(most, std::fabs(each));
  for (std::size_t i = 0; i < n; ++i) {
    Wide sum = -right[i];
    for (std::size_t j = 0; j < n; ++j) sum += static_cast<Wide>(matrix[i * n + j]) * x[j];
    if (std::fabs(sum) > 1e-11 * static_cast<double>(n) * largest * most + 1e-300)
      return fmt::format("{} of {} unknowns has a relative residual of {:.3g}", what, n,
                         static_cast<double>(std::fabs(sum)));
  }
  return {};
}

// Solves a full matrix whose last row is (nearly) the sum of others, or a sparse one with much fill-in.
std::string dense(Random& random) {
  const bool sparse = random.chance(0.4);
  const std::size_t n = static_cast<std::size_t>(sparse ? random.whole(10, 90) : random.whole(2, 8));
  std::vector<double> matrix(n * n, 0);
  if (sparse) {
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * n + i] = 2 + random.unit();
      for (int k = 0; k < 2; ++k) {
        const auto j = static_cast<std::size_t>(random.whole(0, static_cast<int>(n) - 1));
        if (j != i) matrix[i * n + j] = some_number(random), matrix[j * n + i] = some_number(random);
      }
    }
  } else {
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] = some_number(random);
    // The pivots of the other rows stay far from the threshold, because each row is largest in another
    // column.
    for (std::size_t i = 0; i + 1 < n; ++i) matrix[i * n + i] += 2;
    for (std::size_t j = 0; j < n; ++j) matrix[(n - 1) * n + j] = matrix[j];
    matrix[n * n - 1] += some_share(random, 3 * kDependent);
  }
  double largest = 0;
  for (const double each : matrix) largest = std::max(largest, std::abs(each));
  DenseSystem system;
  const std::size_t rank = system.factor(n, matrix);
  if (!sparse) {
    std::size_t surely = 0, perhaps = 0;
    for (const Wide pivot : pivots_of(n, matrix)) {
      surely += pivot > (1 + kNearThreshold) * kDependent * largest ? 1 : 0;
      perhaps += pivot > (1 - kNearThreshold) * kDependent * largest ? 1 : 0;
    }
    if (rank < surely || rank > perhaps)
      return fmt::format("a dense system of rank {} is solved with rank {}", surely, rank);
  }
  std::vector<double> known(n), right(n, 0), x;
  for (double& each : known) each = some_number(random);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) right[i] += matrix[i * n + j] * known[j];
  x = right;
  system.solve(x);
  return residual_of(n, matrix, x, right, largest, 1, "a dense system");
}

// Factorises a random envelope as L D L^T, in which one row depends (nearly) on others.
std::string envelope(Random& random) {
  const int n = random.whole(2, 30), near = random.whole(1, n - 1);
  std::vector<int> first(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) first[static_cast<std::size_t>(i)] = std::max(0, i - random.whole(1, 5));
  std::vector<Wide> lower(static_cast<std::size_t>(n * n), 0), d(static_cast<std::size_t>(n));
  const auto at = [n](int i, int j) { return static_cast<std::size_t>(i * n + j); };
  const double share = some_share(random, kDependent);
  for (int i = 0; i < n; ++i) {
    lower[at(i, i)] = 1, d[static_cast<std::size_t>(i)] = 0.5 + random.unit();
    for (int j = first[static_cast<std::size_t>(i)]; j < i; ++j) lower[at(i, j)] = some_number(random);
    if (i == near) {
      Wide others = 0;
      for (int j = 0; j < i; ++j)
        others += lower[at(i, j)] * lower[at(i, j)] * d[static_cast<std::size_t>(j)];
      d[static_cast<std::size_t>(i)] = others * share / (1 - share);
    }
  }
  EnvelopeMatrix matrix;
  matrix.reset(first);
  std::vector<double> full(static_cast<std::size_t>(n * n), 0);
  for (int i = 0; i < n; ++i)
    for (int j = first[static_cast<std::size_t>(i)]; j <= i; ++j) {
      Wide sum = 0;
      for (int k = 0; k <= j; ++k) sum += lower[at(i, k)] * d[static_cast<std::size_t>(k)] * lower[at(j, k)];
      matrix.at(i, j) = full[at(i, j)] = full[at(j, i)] = static_cast<double>(sum);
    }
  // The relative error of rounding to double.
  std::vector<Wide> l(static_cast<std::size_t>(n * n), 0), pivots(static_cast<std::size_t>(n));
  for (int i = 0; i <= near; ++i) {
    for (int j = 0; j < i; ++j) {
      Wide sum = full[at(i, j)];
      for (int k = 0; k < j; ++k) sum -= l[at(i, k)] * pivots[static_cast<std::size_t>(k)] * l[at(j, k)];
      l[at(i, j)] = sum / pivots[static_cast<std::size_t>(j)];
    }
    pivots[static_cast<std::size_t>(i)] = full[at(i, i)];
    for (int k = 0; k < i; ++k)
      pivots[static_cast<std::size_t>(i)] -= l[at(i, k)] * l[at(i, k)] * pivots[static_cast<std::size_t>(k)];
  }
  const double left = static_cast<double>(pivots[static_cast<std::size_t>(near)] / full[at(near, near)]);
  matrix.factorise();
  std::vector<double> x(static_cast<std::size_t>(n), 0);
  x[static_cast<std::size_t>(near)] = 1;
  matrix.solve(x.data());
  const bool counted = x[static_cast<std::size_t>(near)] != 0;
  // The engine's own rounding of the sums is some 1e-15 of the diagonal.
  if (left > (1 + 3 * kNearThreshold) * kDependent && !counted)
    return fmt::format("an envelope system drops a row whose independent part is {:.4g}", left);
  if (left < (1 - 3 * kNearThreshold) * kDependent && counted)
    return fmt::format("an envelope system keeps a row whose independent part is {:.4g}", left);
  if (left < 1e-3) return {};
  std::vector<double> right(static_cast<std::size_t>(n));
  for (double& each : right) each = some_number(random);
  std::vector<double> solution = right;
  matrix.solve(solution.data());
  double largest = 0;
  for (const double each : full) largest = std::max(largest, std::abs(each));
  return residual_of(static_cast<std::size_t>(n), full, solution, right, largest, 0, "an envelope");
}

// Rows of bodies in a line, and for one of them a second, nearly equal row.
template <class Real>
std::string of_joints(Random& random) {
  constexpr double kThreshold = (sizeof(Real) == 8 ? 4096 : 64) * std::numeric_limits<Real>::epsilon();
  const int bodies = random.whole(1, 6), at = random.whole(0, bodies - 1);
  std::vector<Real> mass, inertia;
  for (int i = 0; i < bodies; ++i) {
    mass.push_back(static_cast<Real>(std::ldexp(1, random.whole(-4, 4))));
    inertia.push_back(mass.back());
  }
  const double share = some_share(random, kThreshold);
  const Real e = static_cast<Real>(std::sqrt(share / (1 - share))) * static_cast<Real>(random.pick({-1, 1}));
  const double kept = double(e) * e / (1 + double(e) * e);
  std::vector<Row<Real>> rows;
  const bool along_x = random.chance(0.5);
  for (int i = 0; i < bodies; ++i) {
    const Vec2<Real> to = along_x ? Vec2<Real>{1, 0} : Vec2<Real>{0, 1},
                     other = along_x ? Vec2<Real>{1, e} : Vec2<Real>{e, 1};
    rows.push_back({kFixedFrame, i, -to, to, 0, 0, 0, 0});
    if (i == at) rows.push_back({kFixedFrame, i, -other, other, 0, 0, 0, 0});
  }
  JointSystem<Real> system(rows, mass, inertia);
  const int dependent = system.factor(rows);
  const double slack = 0.02;
  if (kept > (1 + slack) * kThreshold && dependent != 0)
    return fmt::format("a joint system drops a row whose independent part is {:.4g}", kept);
  if (kept < (1 - slack) * kThreshold && dependent != 1)
    return fmt::format("a joint system keeps a row whose independent part is {:.4g}", kept);
  return {};
}

// Solves a random problem with a positive definite matrix, which has one solution.
std::string complementary(Random& random) {
  const std::size_t n = static_cast<std::size_t>(random.whole(1, 9));
  std::vector<double> half(n * n), matrix(n * n, 0), q(n);
  for (double& each : half) each = some_number(random);
  for (double& each : q) each = some_number(random);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) matrix[i * n + j] += half[k * n + i] * half[k * n + j];
      if (i == j) matrix[i * n + j] += 0.1;
    }
  const ComplementaritySolution found = solve_complementarity(matrix, q);
  if (found.status != ComplementaritySolution::Status::Solved)
    return "a complementarity problem is not solved";
  double most = 1;
  for (const double z : found.z) most = std::max(most, std::abs(z));
  for (std::size_t i = 0; i < n; ++i) {
    double w = q[i];
    for (std::size_t j = 0; j < n; ++j) w += matrix[i * n + j] * found.z[j];
    if (w < -1e-10 * most || found.z[i] < -1e-10 * most || std::abs(w * found.z[i]) > 1e-9 * most * most)
      return fmt::format("a complementarity problem is solved with w = {:.3g}, z = {:.3g}", w, found.z[i]);
  }
  return {};
}

// Solves a network of bodies with rows between them, some bounded. Checks the conditions of the minimum if it
// was found by pivoting, and in any case that no energy is gained.
std::string bounded(Random& random) {
  BoundedRows system;
  const int bodies = random.whole(2, 14), joints = random.whole(1, 2 * bodies);
  const double ratio = random.pick({1.0, 1.0, 10.0, 1000.0});
  system.bodies.push_back({});
  for (int i = 1; i <= bodies; ++i) {
    BoundedBody body;
    const double inverse = random.chance(0.3) ? 1 / ratio : 1;
    body.inverse_mass = {inverse, inverse}, body.inverse_inertia = 6 * inverse;
    body.velocity = {some_number(random), some_number(random)}, body.spin = some_number(random);
    system.bodies.push_back(body);
  }
  std::vector<std::pair<int, int>> blocks;
  std::vector<int> sizes;
  for (int k = 0; k < joints; ++k) {
    const int b = random.whole(1, bodies);
    int a = random.whole(0, bodies);
    if (a == b) a = 0;
    blocks.emplace_back(a, b);
    const int rows = random.whole(1, 3);
    sizes.push_back(rows);
    for (int i = 0; i < rows; ++i) {
      BoundedRow row;
      row.a = a, row.b = b, row.block = k;
      const Vec2d to{some_number(random), some_number(random)};
      row.linear_b = to, row.linear_a = -1.0 * to;
      row.angular_a = some_number(random), row.angular_b = some_number(random);
      row.lower = -INFINITY, row.upper = INFINITY;
      row.state = BoundedRow::kFree;
      if (random.chance(0.3)) row.lower = 0;
      if (random.chance(0.2)) row.lower = -0.1 * random.unit(), row.upper = 0.1 * random.unit();
      system.rows.push_back(row);
    }
  }
  system.order(blocks, sizes);
  const auto energy = [&] {
    double sum = 0;
    for (const BoundedBody& body : system.bodies)
      if (body.is_dynamic())
        sum += (dot(body.velocity, body.velocity) / body.inverse_mass.x +
                body.spin * body.spin / body.inverse_inertia) /
               2;
    return sum;
  };
  const double before = energy();
  system.solve();
  const double after = energy();
  // Regularisation, by which redundant rows share their load, changes the diagonal by about 1e-9.
  if (!(after <= before * (1 + 1e-9)))
    return fmt::format("passive bounded rows raise the energy from {:.9g} to {:.9g} J", before, after);
  for (const BoundedRow& row : system.rows)
    if (row.impulse < row.lower - 1e-9 || row.impulse > row.upper + 1e-9)
      return fmt::format("a bounded row has an impulse of {:.6g} N s; its bounds are {:.6g} and {:.6g}",
                         row.impulse, row.lower, row.upper);
  return {};
}

}  // namespace

Verdict systems(const Case& one, const Engine&, const Motion&) {
  Random random(one.seed, one.index + 23);
  std::string what;
  for (int i = 0; i < kDraws && what.empty(); ++i)
    for (const auto& draw : {dense, envelope, of_joints<float>, of_joints<double>, complementary, bounded})
      if (what.empty()) what = draw(random);
  if (what.empty()) return {};
  return Objection{
      .law = "systems",
      .judge = "systems",
      .what = what,
      .right = "linear systems are solved, and rows are dropped only if they depend on others to rounding"};
}

}  // namespace plumb::harness::hunt
