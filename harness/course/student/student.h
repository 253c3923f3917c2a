#pragma once

#include <memory>
#include <string>

#include "reference/backend.h"

namespace plumb::course {

/// How an engine works, apart from mistakes: right engines differ in it.
struct Manner {
  int sweeps = 40;    ///< over joints and contacts, a step
  bool once = false;  ///< contacts are answered once a step
  bool after_move =
      false;  ///< contacts are found and answered after bodies have moved, and pushed fully apart
  bool by_positions =
      false;           ///< joints are closed by positions, and velocities are displacements over the step
  double share = 0.5;  ///< of an overlap that a step removes by positions
  bool deep = false;   ///< a circle whose centre is in a box is pushed out at the nearest side
  double fed = 0;      ///< share of a joint's error that velocities close in a step, in place of positions
};

/// A learner's engine, as the course builds it: circles and boxes, sequential impulses, hinges and sticks. It
/// makes the one mistake that is asked for ("" for none); world.cpp has their names. `scheme` is
/// semi-implicit Euler, explicit Euler or velocity Verlet.
std::unique_ptr<reference::Backend> make_student(
    std::string mistake, reference::Scheme scheme = reference::Scheme::SemiImplicitEuler, Manner manner = {});

}  // namespace plumb::course
