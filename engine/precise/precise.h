#pragma once

#include <memory>
#include <string>

#include "engine/driver/accuracy.h"
#include "engine/driver/driver.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Makes the driver of `Precise`, for a valid scene that it supports. Free flight under constant forces is a
/// polynomial and is evaluated, not integrated: exact to rounding. Everything else is integrated with
/// step-size control: explicitly (DOP853), implicitly while the motion is stiff (Radau IIA), or as
/// `Precise::method` says. Joints are held by their accelerations and, after each step, by a projection of
/// positions and velocities onto the constraints. Impacts are located in time and resolved there: Newton's
/// restitution, Coulomb's friction. Steps end where forces are switched and at impacts, not on the grid of
/// max_dt: states in between are read from the step's polynomial.
/// `Precise::tolerance` bounds the error of each step: a step is redone until its estimate is below a
/// thousandth of the tolerance. Units are the scene's length (positions), its speed or the body's own if
/// larger (velocities), and one radian. The error of a whole run is then about the tolerance or less, unless
/// the motion amplifies errors. Joints that are open at the start by more than the tolerance are an error;
/// joints that `write` opens are closed at once.
std::unique_ptr<Driver> make_precise_driver(const Scene& scene, const Precise& precise,
                                            CompileOptions options);

/// Returns an empty string, or the reason why `Precise` cannot run `scene` (a valid one).
std::string precise_unsupported(const Scene& scene);

/// Returns an empty string, or the reason why the symplectic method cannot run `scene`, which Precise
/// supports: forces that depend on velocities, shapes that may touch.
std::string symplectic_unsupported(const Scene& scene);

}  // namespace plumb
