#pragma once

#include <memory>
#include <string>

#include "engine/scene/scene.h"
#include "engine/simulation/accuracy.h"
#include "engine/simulation/driver.h"
#include "engine/simulation/simulation.h"

namespace plumb {

/// The driver of `Precise`, for a valid scene that it supports. What it does, body by body:
/// - free flight under constant forces is a polynomial and is evaluated, not integrated: exact to rounding;
/// - all else is integrated with step control: explicitly (DOP853), implicitly while the motion is stiff
/// (Radau
///   IIA), or as `Precise::method` says; joints are held by their accelerations and, after each step, by a
///   projection of positions and velocities onto the constraints;
/// - circles' impacts are located in time and resolved there: Newton's restitution, Coulomb's friction.
/// Steps end where forces are switched and at impacts, not on the grid of max_dt: what is read there comes
/// from the step's polynomial.
///
/// `Precise::tolerance` bounds the error that a step adds: each is redone until its estimate is below a
/// thousandth of the tolerance, in units of the scene's length (positions), speed (velocities; a body's own
/// where that is more) and one radian. Errors of a whole run are then about the tolerance or less where the
/// motion does not amplify them. Joints that start open by more than the tolerance are an error; what
/// `write` has opened is closed at once.
std::unique_ptr<Driver> make_precise_driver(const Scene& scene, const Precise& precise,
                                            CompileOptions options);

/// Empty, or why `Precise` cannot run `scene` (a valid one).
std::string precise_unsupported(const Scene& scene);

/// Empty, or why `scene`, which Precise supports, is not for its symplectic method: forces that depend on
/// velocities, shapes that may touch.
std::string symplectic_unsupported(const Scene& scene);

}  // namespace plumb
