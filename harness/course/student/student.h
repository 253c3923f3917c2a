#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::course {

/// A learner's engine, as the course builds it: circles and boxes, sequential impulses, hinges and sticks. It
/// makes the one mistake that is asked for ("" for none); world.cpp has their names. `scheme` is
/// semi-implicit Euler, explicit Euler or velocity Verlet.
std::unique_ptr<reference::Backend> make_student(
    std::string mistake, reference::Scheme scheme = reference::Scheme::SemiImplicitEuler);

}  // namespace plumb::course
