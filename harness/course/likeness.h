#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "harness/course/finding.h"
#include "harness/course/lab.h"

/// Compares an engine's motion and figures with those of a mistake.
namespace plumb::course {

/// Compares the first `runs` runs: what a check needs apart from experiments with an engine that fails it.
double distance(const std::vector<Recorded>& a, const std::vector<Recorded>& b, std::size_t runs);

/// Adds up the same distance while runs are under way.
class Distance {
 public:
  Distance(const std::vector<Recorded>& from, std::size_t runs) : from_(from), runs_(runs) {}

  /// Adds a state of a run, both by number, and returns the distance until then.
  double add(std::size_t run, std::size_t state, std::span<const BodyState> states);

 private:
  const std::vector<Recorded>& from_;
  std::size_t runs_, run_ = 0;
  double sum_ = 0;
  bool ended_ = false;  ///< the path of the present run leads too far away
};

/// Returns true if a path of `a` leads too far away to be compared, sooner than that of `b`.
bool ends_sooner(const std::vector<Recorded>& a, const std::vector<Recorded>& b, std::size_t runs);

/// Returns true if each reading is that of the mistake, within the tolerance that figures of mistakes have.
bool same_readings(const Finding& seen, const Finding& predicted);

/// Returns true if each reading is that of the mistake, within a hundredth of its distance from the right one
/// or a tenth of the reading's own tolerance.
bool same_figures(const Finding& seen, const Finding& predicted);

/// Returns true if a static body has a velocity or leaves its place.
bool static_moves(const std::vector<Recorded>& runs);

/// Returns true if steps move bodies farther than any overlap that a mistake predicts, by an engine that
/// removes `share` of an overlap in each: corrections of positions are then wrong, whatever else is. False
/// for scenes with joints, which are corrected as well.
bool pushes_farther(const std::vector<Recorded>& seen, const std::vector<Recorded>& predicted, double share);

/// Returns true if a wrong reading is predicted, and what was seen is nearer to the right one.
bool refutes(const Finding& seen, const Finding& predicted);

bool finite(const Finding& finding);

}  // namespace plumb::course
