#pragma once

#include <string>
#include <vector>

#include "harness/course/course.h"

namespace plumb::course {

/// A mistake that the learner's engine (student/student.h) can make, so that its motion can be computed.
struct Predictable {
  std::string planted;   ///< for `make_student`
  std::string name;      ///< several may share one
  std::string chapters;  ///< digits of the chapters whose checks it may spoil
  std::string says;
  bool generated = false;  ///< one of a family: several that fit alike are all described
  bool exactly = false;    ///< is named only if it gives the engine's very paths
};

/// Returns every mistake whose motion can be computed.
std::vector<Predictable> predictable_mistakes();

/// A quantity that the learner's engine can multiply by any factor, so that the factor can be fitted to the
/// motion.
struct Scaled {
  const char* quantity;
  const char* name;
  const char* chapters;
  const char* says;  ///< with {} for the factor
};

/// Returns the quantities whose factor is fitted if no other mistake gives the motion.
std::vector<Scaled> scaled_quantities();

/// Names mistakes by their motion, in the failed checks of a chapter. Runs each such check on the learner's
/// engine, without a mistake and with each mistake known for the chapter, by the method that `lab` declares.
/// A mistake fits a check if the readings and the paths of all bodies equal those of the engine under test.
/// Among several, a mistake is refuted if it fails other checks of the chapter than the engine does. If one
/// is left, it names the check's failure. If several are left, all are described and none is named. If none
/// is left, a name given by figures is withdrawn if the learner's engine can make that mistake, because its
/// motion differs. A mistake named by an earlier check, or as `named` (may be empty) in an earlier chapter,
/// is preferred wherever it fits, and another name is withdrawn if that mistake would fail the check as well.
/// Does nothing for methods that the learner's engine does not have.
void name_by_motion(const Lab& lab, std::vector<Outcome>& chapter, const std::string& named = "");

}  // namespace plumb::course
