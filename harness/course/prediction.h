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
};

/// Returns every mistake whose motion can be computed.
std::vector<Predictable> predictable_mistakes();

/// A quantity that the learner's engine can use with any factor, so that the factor is found by the motion.
struct Scaled {
  const char* quantity;
  const char* name;
  const char* chapters;
  const char* says;  ///< with {} for the factor
};

/// Returns the quantities whose factor is looked for if no other mistake gives a motion.
std::vector<Scaled> scaled_quantities();

/// Names mistakes by their motion, in the failed checks of a chapter. Runs each such check on the learner's
/// engine, without a mistake and with each that the chapter knows, by the method that `lab` declares. A
/// mistake fits a check if the readings and the paths of all bodies are those of the engine under test. Among
/// several, those are refuted that fail other checks of the chapter than the engine does. If one is left, it
/// gives the check its name. If several are, all are described and none is named. If none is, a name that
/// stands for certain figures is taken back if the learner's engine can make that mistake: its motion is
/// another. A mistake that is named, by an earlier check or as `named` of an earlier chapter (or empty), is
/// preferred wherever it fits, and another name is taken back where it would fail as well. Does nothing for
/// methods that the learner's engine does not have.
void name_by_motion(const Lab& lab, std::vector<Outcome>& chapter, const std::string& named = "");

}  // namespace plumb::course
