#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

/// Discrete truths: what a time-stepping scheme gives in exact arithmetic, its own error included.
namespace plumb::scenarios::truth {

using Discrete = decltype(Truth::discrete);

/// Constant accelerations, one a body, in closed form after n steps of h (t = n h):
/// velocity Verlet x0 + v0 t + a t^2/2, exactly the motion; semi-implicit Euler + a h^2 n(n + 1)/2, too far
/// by a h t/2; explicit Euler + a h^2 n(n - 1)/2, too little by the same. v = v0 + a t in all three.
Discrete discrete_constant(std::vector<Motion> start, std::vector<Acceleration> accelerations);

/// The acceleration of a body whose force law depends on nothing but its own motion and the time. `time` is
/// the start of a step.
using Law = std::function<Acceleration(std::size_t body, double time, const Motion& motion)>;

/// The two Euler schemes with the law evaluated at the start of each step, by recurrence:
/// v' = v + h a(x, v), then x' = x + h v' (semi-implicit) or x' = x + h v (explicit). Other schemes are not
/// known: where in the step they evaluate the law is their own choice. `usable` may refuse step sizes.
Discrete discrete_euler(
    std::vector<Motion> start, Law law,
    std::function<bool(double substep)> usable = [](double) { return true; });

}  // namespace plumb::scenarios::truth
