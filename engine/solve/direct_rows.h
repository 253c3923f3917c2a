#pragma once

#include <memory_resource>
#include <vector>

#include "engine/solve/block_order.h"
#include "engine/solve/body_motion.h"
#include "engine/solve/envelope_matrix.h"

namespace plumb {

/// One row of a constraint, as the direct solver sees it.
template <class Real>
struct DirectRow {
  int a = 0, b = 0;                   ///< bodies
  Vec2<Real> linear_a{}, linear_b{};  ///< J
  Real angular_a = 0, angular_b = 0;
  Real bias = 0;            ///< m/s: J v + bias = 0 is asked for
  Real gap = 0;             ///< m or rad: what `correct` makes 0
  Real* impulse = nullptr;  ///< what is kept of it from substep to substep
  bool one_sided = false;   ///< impulse >= 0
  bool active = true;       ///< takes part: a one-sided row that would have to pull does not
  int block = 0;            ///< the constraint that it belongs to
};

/// The rows of a few constraints that hang together, solved all at once: J M^-1 J^T x = -(J v + bias), by a
/// sparse factorisation that is made once a step and used in all its substeps. What sequential impulses need
/// many sweeps for (a heavy load on light things, a long way from the load to the ground) is right at once.
/// Rows that would have to pull are left out, and the factorisation is made anew without them.
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

  /// Orders the rows (Cuthill and McKee, 1969, reversed) and says what factorising them would cost, in
  /// multiplications.
  double order(const BodyMotion<Real>* motion);
  /// Factorises for the bodies' masses and the rows' Jacobians as they are.
  void factorise(const BodyMotion<Real>* motion);
  /// Finds the impulses that are missing; false, and no more than pulls are taken out, when no set of
  /// pressing rows was found in a few tries, or the rows contradict each other. `push_speed`, m/s: what rows
  /// push with out of overlaps.
  bool find(BodyMotion<Real>* motion, double push_speed);
  /// Whether `find` met rows that cannot hold together, as those of a body that is pushed out of two walls at
  /// once: what it found is no answer.
  bool contradicted() const { return contradicted_; }
  /// What `find` or `correct` found for a row.
  double found(int row) const { return x_[static_cast<std::size_t>(place_[row])]; }
  /// Finds impulses that move bodies instead of giving them a velocity, such that all gaps close; false when
  /// the rows contradict each other.
  bool correct();
  /// Applies what `find` found.
  void apply(BodyMotion<Real>* motion);
  /// Moves and turns bodies by what `correct` found: one Newton step to where the rows hold.
  void move(BodyMotion<Real>* motion, Rotation<Real>* rotation) const;

 private:
  bool contradicts(double asked, double push_speed) const;
  void note_masses(const BodyMotion<Real>* motion);

  std::pmr::vector<int> sequence_;  // place -> row
  std::pmr::vector<int> place_;     // row -> place
  std::pmr::vector<int> first_;
  BlockOrder order_;
  std::pmr::vector<std::pair<int, int>> ends_;  // body, block
  std::pmr::vector<int> block_first_;
  std::pmr::vector<double> x_;
  EnvelopeMatrix matrix_;
  double apart_ = 1;  // how much farther apart than usual the least and the most are that rows do
  bool contradicted_ = false;
};

}  // namespace plumb
