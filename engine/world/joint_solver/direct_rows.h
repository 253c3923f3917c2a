#pragma once

#include <memory_resource>
#include <vector>

#include "engine/linear_algebra/block_order.h"
#include "engine/linear_algebra/envelope_matrix.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// A constraint row of the direct solver.
template <class Real>
struct DirectRow {
  int a = 0, b = 0;                   ///< bodies
  Vec2<Real> linear_a{}, linear_b{};  ///< J
  Real angular_a = 0, angular_b = 0;
  Real bias = 0;             ///< m/s: target J v + bias = 0
  Real* impulse = nullptr;   ///< the impulse that is kept between substeps
  bool unilateral = false;   ///< impulse >= 0
  bool active = true;        ///< takes part; a unilateral row that would have to pull does not
  bool violated = false;     ///< set by `solve_impulses`: it would pull, or is inactive but must push
  Real removed_impulse = 0;  ///< removed by `solve_impulses`, because the row is no longer active
  int block = 0;             ///< index of its constraint
  float softening = 0;  ///< compliance, as a fraction of its mobility, to what its impulse exceeds `load`
  Real load = 0;        ///< N s
};

/// The rows of a few connected constraints, solved together: J M^-1 J^T x = -(J v + bias), sparsely. It
/// replaces the many iterations that sequential impulses need for a heavy load on light bodies, far above the
/// ground. Unilateral rows that would have to pull are excluded, by block principal pivoting (Judice and
/// Pires, Computers and Operations Research 21, 1994). While bodies rest, the two passes of a substep, with
/// and without depenetration, have different active rows. Each therefore keeps its active rows and their
/// factorisation for its next substep.
template <class Real>
class DirectRows {
 public:
  explicit DirectRows(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : rows(memory),
        rows_in_order_(memory),
        position_(memory),
        first_columns_(memory),
        order_(memory),
        body_blocks_(memory),
        block_first_(memory),
        x_(memory),
        residual_(memory),
        matrix_(memory),
        diagonal_(memory),
        biased_(memory),
        unbiased_(memory) {}

  std::pmr::vector<DirectRow<Real>> rows;  ///< filled by the caller, rows of one constraint side by side

  /// Orders the rows (reverse Cuthill-McKee, 1969). Returns the cost of factorising them, in multiplications.
  double order(const SolverBody<Real>* motion);
  /// Computes J M^-1 J^T for the present masses and Jacobians, and discards all factorisations.
  void assemble(const SolverBody<Real>* motion);
  /// Solves for the missing impulses of the pass with depenetration (`use_bias`) or of the pass without it.
  /// Returns false, having changed nothing but `active`, if a few pivoting steps found no feasible set of
  /// active rows, or if the rows are infeasible.
  bool solve_impulses(SolverBody<Real>* motion, bool use_bias);
  /// Returns true if the rows in `solve_impulses` were infeasible, such as those of a body pushed out of two
  /// walls at once. Its result is then invalid.
  bool is_infeasible() const { return infeasible_; }
  /// Applies the result of `solve_impulses`.
  void apply(SolverBody<Real>* motion);

 private:
  /// A factorisation of the active rows of one pass.
  struct Factors {
    explicit Factors(std::pmr::memory_resource* memory) : matrix(memory), active(memory) {}
    EnvelopeMatrix matrix;
    std::pmr::vector<char> active;  // by row
    bool valid = false;
  };

  void factorise(Factors& factors, int from);
  int exchange_violated(Factors& factors);
  double solve_active(const SolverBody<Real>* motion, const EnvelopeMatrix& matrix);
  double velocity_error(const SolverBody<Real>* motion, int position) const;
  double velocity_response(int position) const;
  void remove_inactive(SolverBody<Real>* motion);
  void restore_removed(SolverBody<Real>* motion);
  void set_regularisation(const SolverBody<Real>* motion);

  std::pmr::vector<int> rows_in_order_;  // position -> row
  std::pmr::vector<int> position_;       // row -> position
  std::pmr::vector<int> first_columns_;
  BlockOrder order_;
  std::pmr::vector<std::pair<int, int>> body_blocks_;  // body, block
  std::pmr::vector<int> block_first_;
  std::pmr::vector<double> x_, residual_;
  EnvelopeMatrix matrix_;              // J M^-1 J^T of all rows
  std::pmr::vector<double> diagonal_;  // of it
  Factors biased_, unbiased_;
  double regularisation_ = 0;  // fraction of the diagonal
  bool infeasible_ = false;
};

}  // namespace plumb
