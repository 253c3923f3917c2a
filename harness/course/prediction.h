#pragma once

#include <string>
#include <vector>

#include "harness/course/course.h"

namespace plumb::course {

/// A mistake that the learner's engine (student/student.h) can make, so that its motion can be computed.
struct Predictable {
  std::string planted;   ///< for `make_student`
  std::string name;      ///< several may have the same name
  std::string chapters;  ///< digits of the chapters whose checks it may affect
  std::string says;
  bool generated = false;  ///< one of a family: all that fit equally well are described
  bool exactly = false;    ///< named only if it gives exactly the tested engine's paths
};

/// Returns every mistake whose motion can be computed.
std::vector<Predictable> predictable_mistakes();

/// A quantity that the learner's engine can multiply by any factor, so that the factor can be fitted to the
/// motion.
struct Scaled {
  const char* quantity;
  const char* name;
  const char* chapters;
  const char* says;  ///< description, with {} for the factor
};

/// Returns the quantities whose factor is fitted if no other mistake gives the motion.
std::vector<Scaled> scaled_quantities();

/// Names mistakes by their motion, in the failed checks of a chapter. Runs each such check on the learner's
/// engine, without a mistake and with each mistake known for the chapter, by the method that `lab` declares.
/// A mistake fits a check if the readings and the paths of all bodies equal those of the engine under test. A
/// mistake is refuted if it fails other checks of the chapter than the tested engine does.
/// If one mistake remains, it names the check's failure. If several remain, all are described and none is
/// named. If none remains, a name given by figures is withdrawn, provided that the learner's engine can make
/// that mistake, because its motion differs. A mistake named by an earlier check, or as `named` (may be
/// empty) in an earlier chapter, is preferred wherever it fits; another name is withdrawn if that mistake
/// would fail the check as well.
/// A mistake that would change the paths of a check of this chapter, or of one of `before`, in which the
/// tested engine moves exactly as a correct one, is described and not named. Does nothing for methods that
/// the learner's engine does not have.
void name_by_motion(const Lab& lab, std::vector<Outcome>& chapter, const std::vector<Outcome>& before = {},
                    const std::string& named = "");

}  // namespace plumb::course
