#pragma once

#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "engine/linear_algebra/block_order.h"
#include "engine/linear_algebra/envelope_matrix.h"
#include "engine/math/vec2.h"

namespace plumb {

/// Velocity and inverse masses of a body, all in double.
struct BoundedBody {
  Vec2d inverse_mass{};        ///< 1/kg, along x and y: 0 along a locked axis
  double inverse_inertia = 0;  ///< 1/(kg m^2)
  Vec2d velocity{};            ///< m/s
  double spin = 0;             ///< rad/s

  bool is_dynamic() const { return inverse_mass.x + inverse_mass.y + inverse_inertia > 0; }
};

/// One scalar constraint with a bounded impulse x. J v + compliance x is `target` while x is between its
/// bounds, at least that at the lower bound, and at most that at the upper one.
struct BoundedRow {
  enum State : std::int8_t { kFree, kLower, kUpper };

  int a = 0, b = 0;              ///< bodies of the system
  Vec2d linear_a{}, linear_b{};  ///< J
  double angular_a = 0, angular_b = 0;
  /// m/s, target velocity; after solving, of infeasible rows, the one that they reached
  double target = 0;
  double compliance = 0;        ///< 1/kg
  double lower = 0, upper = 0;  ///< N s
  double softening = 0;         ///< fraction of its own mobility that is added to the compliance
  double gap = 0;               ///< m or rad: closed by `correct`
  /// N s. Before solving, a guess: if redundant rows leave several solutions, the one nearest to the guess is
  /// found (for 0, the one that shares loads evenly). After solving, the solution.
  double impulse = 0;
  int block = 0;
  State state = kFree;  ///< initial state; after solving, the final one
};

/// Returns true if a row's impulse is bounded on one side alone, as that of a contact or of a limit is.
inline bool is_one_sided(const BoundedRow& row) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  return row.lower > -kUnbounded && row.upper == kUnbounded;
}

/// The rows of all constraints of a mechanism (joints, limits, motors, springs, contacts and friction) as one
/// linear complementarity problem with bounds,
///     w = J (v + M^-1 J^T x) + C x - target,   lower <= x <= upper,   w = 0 between,
/// which states the minimum of the kinetic energy relative to the target velocities. Solved first by block
/// principal pivoting (Judice and Pires, Computers and Operations Research 21, 1994): all infeasible
/// rows are exchanged at once. If a few pivots do not suffice, by gradient projection with subspace
/// minimisation (More and Toraldo, SIAM Journal on Optimization 1, 1991). Each step lowers the energy.
/// Projected Gauss-Seidel identifies the rows at their bounds, and the others are solved together within
/// their bounds. The free rows are factorised sparsely, with a little compliance if they depend on each
/// other, so that redundant rows share their load.
class BoundedRows {
 public:
  explicit BoundedRows(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  std::pmr::vector<BoundedBody> bodies;  ///< filled by the caller
  /// Filled by the caller. Rows of one block (constraints between the same two bodies) are contiguous, and
  /// blocks ascend; a block may be empty.
  std::pmr::vector<BoundedRow> rows;

  /// Orders the blocks, given the two bodies of each. Returns the cost of factorising `sizes` rows of each
  /// block, in multiplications.
  double order(std::span<const std::pair<int, int>> blocks, std::span<const int> sizes);

  /// Solves for the impulses and applies them to the bodies' velocities. Errors are tolerated relative to the
  /// row with the largest energy v^2 / mobility, J, or to `energy` if that is more.
  void solve(double energy = 0);

  /// Returns the energy to which errors of the last solution are relative, J.
  double energy_scale() const { return energy_scale_; }

  /// Solves again for the velocities that `solve` was given, after bounds have changed and nothing else.
  void solve_again();

  /// Effort of all solutions and corrections so far, in multiplications (estimated for passes over the rows).
  /// Once it has reached `effort_limit`, descents make a few steps only, and end with passes of projected
  /// Gauss-Seidel: the impulses gain no energy, but are not the solution. The caller resets both.
  double effort = 0, effort_limit = std::numeric_limits<double>::infinity();
  bool is_exhausted() const { return effort >= effort_limit; }

  /// Returns true if a speed along a row is more than the fraction `fraction` of the speed of the row with
  /// the largest energy.
  bool is_significant(int row, double speed, double fraction) const;

  /// Returns the impulse that a row would have after the last solution if it alone were free of its bounds.
  double unbounded_impulse(int row) const;

  /// Changes the bodies' velocities by an impulse along a row.
  void apply_impulse(const BoundedRow& row, double impulse);

  /// Returns the velocity of a row, m/s.
  double row_velocity(const BoundedRow& row) const;

  /// Returns the fraction, 0 to 1, by which to scale these impulses so that they leave the bodies the least
  /// energy, given their velocities; scaled impulses also cost `cost`, J, times half the square of the
  /// fraction. Changes the velocities.
  double best_load_fraction(std::span<const double> impulses, double cost = 0);

  /// Finds impulses that move bodies by `displacements`, instead of changing their velocities, such that the
  /// gaps of the free rows close. Each row is softened by `softening` of its mobility (Levenberg-Marquardt).
  /// Bodies move by at most 1 / (2 sqrt(softening)) of the gaps, so gaps that could be closed only by wide
  /// motions stay open. A row that is not free and has a positive upper bound is open by its gap; if the
  /// displacements would close more than that gap, it becomes free.
  void correct(double softening);
  struct Displacement {
    Vec2d translation{};  ///< m
    double rotation = 0;  ///< rad
  };
  std::pmr::vector<Displacement> displacements;  ///< by body, set by `correct`

 private:
  // Maximum number of block pivots. Of the systems that pivoting solves, nine in ten need no more.
  static constexpr int kMaxPivots = 4;
  // Tolerated violation of a row's inequality, relative to the row with the largest energy v^2 / mobility
  // (speeds of linear and of angular rows have different units). A violation beyond kClearViolation, a
  // hundred times the regularisation, counts before iterative refinement too: refining
  // rows that are exchanged anyway would be useless.
  static constexpr double kTolerance = 1e-9, kClearViolation = 1e-5;
  // Residual, on the same scale, below which a row is not refined.
  static constexpr double kResidualTolerance = 1e-11;
  // Regularisation of rows that depend on each other: this fraction of each row's mobility is added to it, so
  // that the rows share their load. Iterative refinement removes the error that this causes in other rows.
  // The value is that of the rounding of positions in float: rows that differ only by rounding must not block
  // the motion that they allow. (A parallelogram in float that was flat in the middle of a substep lost 40 %
  // of its speed at 1e-10, and 0.4 % at 1e-7.)
  static constexpr double kRegularisation = 1e-7;
  // Steps of iterative refinement, which remove the error of the regularisation.
  static constexpr int kRefinements = 2;

  void count_passes(int passes);
  void count_solution();
  void compute_mobility();
  void compute_energy_scale();
  void index_blocks();
  void assemble();
  void factorise();
  bool remove_from_factors();
  void copy_free_rows(int from);
  void solve_free();
  void solve_displacements();
  bool refine();
  void apply_all();
  double residual(int row) const;
  int count_violations(double slack);
  bool pivot();
  void set_fixed();
  bool solve_small();
  void solve_from_start();
  void start_from(std::span<const double> impulses);
  void prevent_energy_gain(bool exact);
  bool is_infeasible() const;
  void relax_infeasible_rows();
  void solve_impulses();
  void descend();
  void gauss_seidel(int iterations);
  void minimise_free();
  void step_from(double fraction);
  double free_coupling(int place, int other) const;
  double best_step_fraction();
  bool minimise_on_face();
  struct Work {
    double linear = 0, quadratic = 0;  // J
  };
  Work work() const;
  double energy() const;
  void scale_impulses();
  void prepare_guess();

  BlockOrder order_;
  EnvelopeMatrix full_matrix_, free_matrix_;  // of all rows in elimination order; of the free ones
  std::pmr::vector<BoundedBody> start_;       // the bodies as given
  std::pmr::vector<double> mobility_;         // J M^-1 J^T + compliance, by row
  std::pmr::vector<int> block_first_;         // by block: index of its first row
  // Free rows in elimination order, which free_matrix_ has. Some may have been removed from its factors.
  std::pmr::vector<int> free_;
  std::pmr::vector<int> free_positions_;   // the same as places in `rows_in_order_`, used by `factorise`
  std::pmr::vector<int> block_positions_;  // by block: its first row's place in the elimination order
  std::pmr::vector<int> rows_in_order_;    // rows in elimination order
  std::pmr::vector<int> free_before_;      // by place in that order: number of free rows before it
  std::pmr::vector<int> first_columns_;
  std::pmr::vector<double> x_, guess_, best_;
  // Of a free row: where a step on a face began, and at which fraction of the step it reaches a bound.
  struct FaceStart {
    double impulse = 0, residual = 0;  // N s, m/s
    double reach = 0;
  };
  // A free row that reaches its bound within a step: its place in free_, the fraction of the step, its share
  // of the step, N s, and by how much a step of the rows that still move lowers its residual, m/s.
  struct Stop {
    int place = 0;
    double reach = 0, step = 0, change = 0;
  };
  std::pmr::vector<FaceStart> from_;
  std::pmr::vector<Stop> stops_;
  std::pmr::vector<double> targets_;          // by row, while infeasible rows are relaxed
  std::pmr::vector<std::int8_t> next_state_;  // 0, or 1 + the state to change to
  double energy_scale_ = 0;      // J, the largest v^2 / mobility of a row, or what the caller gave:
  double min_energy_scale_ = 0;  // J
  bool assembled_ = false;       // full_matrix_ holds the present rows
  bool factorised_ = false;      // free_matrix_ holds the factors of the rows in free_
  bool regularised_ = false;     // free rows depend on each other: they are regularised
  bool guess_set_ = false;       // guess_ is set (`prepare_guess`)
  bool descended_ = false;       // the last solution was found by descent
};

inline double BoundedRows::row_velocity(const BoundedRow& row) const {
  const BoundedBody &a = bodies[row.a], &b = bodies[row.b];
  return dot(row.linear_a, a.velocity) + row.angular_a * a.spin + dot(row.linear_b, b.velocity) +
         row.angular_b * b.spin;
}

inline void BoundedRows::apply_impulse(const BoundedRow& row, double impulse) {
  if (impulse == 0) return;
  const auto add = [&](BoundedBody& body, Vec2d linear, double angular) {
    body.velocity.x += body.inverse_mass.x * linear.x * impulse;
    body.velocity.y += body.inverse_mass.y * linear.y * impulse;
    body.spin += body.inverse_inertia * angular * impulse;
  };
  add(bodies[row.a], row.linear_a, row.angular_a);
  add(bodies[row.b], row.linear_b, row.angular_b);
}

// Returns the residual of a row at the present velocities.
inline double BoundedRows::residual(int i) const {
  const BoundedRow& row = rows[i];
  const double missing = row.target - row_velocity(row) - row.compliance * row.impulse;
  return missing - row.softening * mobility_[i] * row.impulse;
}

}  // namespace plumb
