#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Compares an engine's motion and figures with those of a mistake.
namespace plumb::course {

/// Compares the first `runs` runs: those of the check itself, without its experiments for engines that fail.
/// Each run is compared up to and including the first state in which a body of `seen` has left the range
/// around the origin in which paths are compared; positions are clamped to this range. So an engine that
/// throws a body away is far from one that keeps it, and the distances for one `seen` obey the triangle
/// inequality.
double distance(const std::vector<Recorded>& seen, const std::vector<Recorded>& a,
                const std::vector<Recorded>& b, std::size_t runs);

/// Accumulates the distance from `seen` while runs are under way.
class Distance {
 public:
  Distance(const std::vector<Recorded>& seen, std::size_t runs) : seen_(seen), runs_(runs) {}

  /// Adds a state, given by the numbers of run and state, and returns the distance so far.
  double add(std::size_t run, std::size_t state, std::span<const BodyState> states);

 private:
  const std::vector<Recorded>& seen_;
  std::size_t runs_, run_ = 0;
  double sum_ = 0;
  bool ended_ = false;  ///< a body of the current run has left the range in which paths are compared
};

/// Returns true if each reading equals that of the mistake, within the tolerance for figures of mistakes.
bool same_readings(const Finding& seen, const Finding& predicted);

/// Returns true if each reading equals that of the mistake, within a hundredth of its distance from the
/// correct one or a tenth of the reading's own tolerance.
bool same_figures(const Finding& seen, const Finding& predicted);

/// Returns true if a static body has a velocity or moves.
bool static_moves(const std::vector<Recorded>& runs);

/// Returns true if position corrections are wrong, whatever other mistakes there are: steps move bodies
/// farther than any overlap that a mistake predicts, for an engine that removes the fraction `share` of an
/// overlap per step. False for scenes with joints, which are corrected as well.
bool pushes_farther(const std::vector<Recorded>& seen, const std::vector<Recorded>& predicted, double share);

/// Returns true if the mistake predicts a wrong reading, but the engine's is nearer to the correct one.
bool refutes(const Finding& seen, const Finding& predicted);

bool finite(const Finding& finding);

}  // namespace plumb::course
