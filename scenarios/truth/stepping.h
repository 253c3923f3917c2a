#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "scenarios/scenario.h"
#include "scenarios/truth/motion.h"

/// Discrete truths: exact-arithmetic results of time-stepping schemes, their truncation error included.
namespace plumb::scenarios::truth {

using Discrete = decltype(Truth::discrete);

/// Returns the closed form after n steps of h (t = n h) for constant accelerations, one per body. Velocity
/// Verlet: x0 + v0 t + a t^2/2, exactly the motion. Semi-implicit Euler: + a h^2 n(n + 1)/2, too far by a h
/// t/2; explicit Euler: + a h^2 n(n - 1)/2, too short by the same. v = v0 + a t in all three.
Discrete discrete_constant(std::vector<Motion> start, std::vector<Acceleration> accelerations);

/// Returns the acceleration of a body, which depends only on its own motion and the time. `time` is the start
/// of a step.
using Law = std::function<Acceleration(std::size_t body, double time, const Motion& motion)>;

/// Returns both Euler schemes by recurrence, with the law evaluated at the start of each step: v' = v + h
/// a(x, v), then x' = x + h v' (semi-implicit) or x' = x + h v (explicit). Other schemes are unknown, because
/// they may evaluate the law anywhere in the step. `usable` may refuse step sizes.
Discrete discrete_euler(
    std::vector<Motion> start, Law law,
    std::function<bool(double substep)> usable = [](double) { return true; });

}  // namespace plumb::scenarios::truth
