#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::course {

/// A learner's engine, as the course builds it: semi-implicit Euler, circles and boxes, sequential impulses,
/// hinges and sticks. It makes the one mistake that is asked for ("" for none); student.cpp has their names.
std::unique_ptr<reference::Backend> make_student(std::string mistake);

}  // namespace plumb::course
