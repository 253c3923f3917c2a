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
  Real bias = 0;            ///< m/s: target J v + bias = 0
  Real* impulse = nullptr;  ///< the impulse that is kept between substeps
  bool one_sided = false;   ///< impulse >= 0
  bool active = true;       ///< takes part; a one-sided row that would have to pull does not
  bool wrong = false;       ///< set by `find`: it would pull, or is inactive but violated
  Real taken = 0;           ///< impulse that `find` has removed, because the row is no longer active
  int block = 0;            ///< index of its constraint
};

/// The rows of a few connected constraints, solved together: J M^-1 J^T x = -(J v + bias), sparsely. It
/// replaces the many iterations that sequential impulses need for a heavy load on light bodies, far above the
/// ground. Rows that would have to pull are excluded, by block principal pivoting (Judice and Pires,
/// Computers and Operations Research 21, 1994). While bodies rest, the two passes of a substep, with and
/// without depenetration, have different active rows. Each therefore keeps its active rows and their
/// factorisation for its next substep.
template <class Real>
class DirectRows {
 public:
  explicit DirectRows(std::pmr::memory_resource* room = std::pmr::get_default_resource())
      : rows(room),
        sequence_(room),
        place_(room),
        first_(room),
        order_(room),
        ends_(room),
        block_first_(room),
        x_(room),
        rest_(room),
        all_(room),
        diagonal_(room),
        push_(room),
        relax_(room) {}

  std::pmr::vector<DirectRow<Real>> rows;  ///< filled by the caller, rows of one constraint side by side

  /// Orders the rows (reverse Cuthill-McKee, 1969). Returns the cost of factorising them, in multiplications.
  double order(const SolverBody<Real>* motion);
  /// Computes J M^-1 J^T for the present masses and Jacobians, and forgets all factorisations.
  void assemble(const SolverBody<Real>* motion);
  /// Solves for the missing impulses of the pass with depenetration (`push`) or of the pass without it.
  /// Returns false, having changed nothing but `active`, if a few attempts found no valid set of pressing
  /// rows, or if the rows contradict each other.
  bool find(SolverBody<Real>* motion, bool push);
  /// Returns true if the rows in `find` were infeasible, such as those of a body pushed out of two walls at
  /// once. Its result is then invalid.
  bool contradicted() const { return contradicted_; }
  /// Applies the result of `find`.
  void apply(SolverBody<Real>* motion);

 private:
  /// A factorisation of the rows that press in one pass.
  struct Factors {
    explicit Factors(std::pmr::memory_resource* room) : matrix(room), active(room) {}
    EnvelopeMatrix matrix;
    std::pmr::vector<char> active;  // by row
    bool made = false;
  };

  void factorise(Factors& factors, int from);
  int change_sides(Factors& factors);
  double solve(const SolverBody<Real>* motion, const EnvelopeMatrix& matrix);
  double rate_of(const SolverBody<Real>* motion, const DirectRow<Real>& row) const;
  double response_of(int place) const;
  void take_back(SolverBody<Real>* motion);
  void give_back(SolverBody<Real>* motion);
  void note_masses(const SolverBody<Real>* motion);

  std::pmr::vector<int> sequence_;  // place -> row
  std::pmr::vector<int> place_;     // row -> place
  std::pmr::vector<int> first_;
  BlockOrder order_;
  std::pmr::vector<std::pair<int, int>> ends_;  // body, block
  std::pmr::vector<int> block_first_;
  std::pmr::vector<double> x_, rest_;
  EnvelopeMatrix all_;                 // J M^-1 J^T of all rows
  std::pmr::vector<double> diagonal_;  // of it
  Factors push_, relax_;
  double sharing_ = 0;  // regularisation
  bool contradicted_ = false;
};

}  // namespace plumb
