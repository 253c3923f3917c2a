#pragma once

#include <memory_resource>
#include <vector>

#include "engine/linear_algebra/block_order.h"
#include "engine/linear_algebra/envelope_matrix.h"
#include "engine/world/contact_solver/body_motion.h"

namespace plumb {

/// A constraint row of the direct solver.
template <class Real>
struct DirectRow {
  int a = 0, b = 0;                   ///< bodies
  Vec2<Real> linear_a{}, linear_b{};  ///< J
  Real angular_a = 0, angular_b = 0;
  Real bias = 0;            ///< m/s: target J v + bias = 0
  Real gap = 0;             ///< m or rad: closed by `correct`
  Real* impulse = nullptr;  ///< the impulse that is kept between substeps
  bool one_sided = false;   ///< impulse >= 0
  bool active = true;       ///< takes part; a one-sided row that would have to pull does not
  bool wrong = false;       ///< set by `find`: it would pull, or is entered though it is not active
  Real taken = 0;           ///< impulse that `find` has taken back, as the row is not active any more
  int block = 0;            ///< index of its constraint
};

/// The rows of a few connected constraints, solved together: J M^-1 J^T x = -(J v + bias). The sparse
/// factorisation is made once a step and used in all its substeps. It replaces the many iterations that
/// sequential impulses need for a heavy load on light bodies, far above the ground. Rows that would have to
/// pull are removed, and the system is factorised again without them.
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
        matrix_(room) {}

  std::pmr::vector<DirectRow<Real>> rows;  ///< filled by the caller, rows of one constraint side by side

  /// Orders the rows (reverse Cuthill-McKee, 1969). Returns the cost of factorising them, in multiplications.
  double order(const BodyMotion<Real>* motion);
  /// Factorises for the present masses and Jacobians.
  void factorise(const BodyMotion<Real>* motion);
  /// Solves for the missing impulses. Returns false, having changed nothing but `active`, if a few tries
  /// found no set of pressing rows, or if the rows contradict each other. `push_speed`, m/s: depenetration
  /// speed of the rows.
  bool find(BodyMotion<Real>* motion, double push_speed);
  /// Returns true if the rows in `find` were infeasible, such as those of a body pushed out of two walls at
  /// once. Its result is then invalid.
  bool contradicted() const { return contradicted_; }
  /// Returns the result of `find` or `correct` for a row.
  double found(int row) const { return x_[static_cast<std::size_t>(place_[row])]; }
  /// Finds impulses that close all gaps by moving bodies instead of changing velocities. Returns false if the
  /// rows contradict each other.
  bool correct();
  /// Applies the result of `find`.
  void apply(BodyMotion<Real>* motion);
  /// Moves and turns bodies by the result of `correct`: one Newton step towards closed gaps.
  void move(BodyMotion<Real>* motion, Rotation<Real>* rotation) const;

 private:
  bool contradicts(double asked, double push_speed) const;
  void factorise_again(const BodyMotion<Real>* motion);
  double rate_of(const BodyMotion<Real>* motion, const DirectRow<Real>& row) const;
  double answer_of(const BodyMotion<Real>* motion, int place) const;
  void take_back(BodyMotion<Real>* motion);
  void give_back(BodyMotion<Real>* motion);
  void note_masses(const BodyMotion<Real>* motion);

  std::pmr::vector<int> sequence_;  // place -> row
  std::pmr::vector<int> place_;     // row -> place
  std::pmr::vector<int> first_;
  BlockOrder order_;
  std::pmr::vector<std::pair<int, int>> ends_;  // body, block
  std::pmr::vector<int> block_first_;
  std::pmr::vector<double> x_;
  EnvelopeMatrix matrix_;
  double apart_ = 1;    // factor on the limits of contradiction: by mass ratio and number of one-sided rows
  double sharing_ = 0;  // regularisation in this step
  bool contradicted_ = false;
};

}  // namespace plumb
