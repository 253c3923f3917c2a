#pragma once

#include <span>

#include "engine/precise/dynamics/flight.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/parts.h"
#include "engine/precise/events/contacts.h"
#include "engine/precise/integration/smooth.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The laws of motion of one scene, with contact modes that are taken over from a run of another scene of the
/// same structure. As long as these modes are frozen, the laws are smooth functions of time and state.
struct Neighbour {
  Neighbour(const Scene& scene, const Precise& precise)
      : parts(divide(scene)),
        flight(scene, parts),
        equations(scene, parts, flight, false, precise.tolerance),
        smooth(scene, parts, precise, equations),
        contacts(scene, parts, flight, equations, smooth),
        start(smooth.state()) {}
  Neighbour(const Neighbour&) = delete;
  Neighbour& operator=(const Neighbour&) = delete;

  void set_window(double time) { equations.set_window(time, time); }

  /// Closes the joints of a state and of its velocities, as at the start of a run.
  void close_joints(double time, Compensated& y) {
    equations.strike_hinges(time, y);
    equations.project(time, y);
  }

  Parts parts;
  Flight flight;
  EquationsOfMotion equations;
  EventFreeIntegrator smooth;  // of the contacts; makes no steps
  Contacts contacts;
  Compensated start;  // the state of the integrated bodies at the start, joints not closed
};

}  // namespace plumb::precise
