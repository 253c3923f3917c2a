#pragma once

#include <string_view>
#include <vector>

#include "harness/course/course.h"

namespace plumb::course {

/// A mistake that the learner's engine (student/student.h) can make, so that its motion can be computed.
struct Predictable {
  const char* planted;   ///< for `make_student`
  const char* name;      ///< several may share one
  const char* chapters;  ///< digits of the chapters whose checks it may spoil
  const char* says;
};

/// Returns every mistake whose motion can be computed.
std::vector<Predictable> predictable_mistakes();

/// Names a mistake by its motion. Runs `check` on the learner's engine, once without a mistake and once with
/// each that its chapter knows, by the method that `lab` declares. A mistake fits if the check's readings and
/// the paths of all bodies are those of the engine under test, `runs`. If exactly one fits, `finding` gets
/// its name. If several do, all are described and none is named; if none does, a name that `finding` has is
/// taken back if its motion can be computed, for it has been refuted. Does nothing for methods that the
/// learner's engine does not have.
void name_by_motion(const Check& check, int chapter, const Lab& lab, const std::vector<Recorded>& runs,
                    Finding& finding);

}  // namespace plumb::course
