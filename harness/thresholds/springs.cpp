#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// The stiffest spring that an engine integrates, as its natural frequency times the step. A method that is
// stable for omega h up to some number, with h its substep, loses the motion beyond it. Source: Hairer,
// Lubich, Wanner, Geometric Numerical Integration, I.1 and VI; the stability polynomial of the classical
// Runge-Kutta method on the imaginary axis.
namespace plumb::harness::thresholds {
namespace {

// Limit of the amplitude, in units of the initial one. At omega h = 2 (1 - e) a symplectic method's amplitude
// is bounded by 1/sqrt(2 e), which is 100 for e = 5e-5; beyond 2 it grows by sqrt(8 e) per step.
// Runge-Kutta's amplitude grows by 7.1 e per step beyond 2 sqrt(2) (1 + e): 4 / resolution steps with e =
// resolution / 2 give a factor of exp(14.2) = 1.5e6.
constexpr double kBurst = 1000;
// Initial amplitude, m: small, so that no engine's clamp on the displacement of a step hides the growth.
constexpr double kStart = 1e-3;
constexpr double kRestLength = 1, kPulled = 0.2;  // m

int steps_for(double resolution) { return static_cast<int>(4 / resolution); }

Trial on_a_force(double frequency_times_step, double resolution) {
  Trial trial{.scene = {.name = "spring_force", .gravity = {0, 0}},
              .duration = steps_for(resolution) * kStep};
  const double omega = frequency_times_step / kStep;
  trial.scene.bodies = {{.name = "ball",
                         .position = {kStart, 0},
                         .shapes = {{.geometry = Circle{0.1}, .filter = {.mask = 0}}}}};
  trial.scene.forces = {
      SpringForce{.body_a = std::string(kWorld), .body_b = "ball", .stiffness = omega * omega}};
  trial.broke = [](double time, std::span<const BodyState> states) {
    const double swing = std::sqrt(length_squared(states[0].position)) / kStart;
    return swing < kBurst
               ? std::string()
               : fmt::format("amplitude {:.2g} times the expected one after {:.2g} s", swing, time);
  };
  return trial;
}

Trial on_a_joint(double frequency_times_step, double resolution) {
  Trial trial{.scene = {.name = "spring_joint", .gravity = {0, 0}},
              .duration = steps_for(resolution) * kStep};
  const double hertz = frequency_times_step / kStep / (2 * std::numbers::pi);
  trial.scene.bodies = {{.name = "ball",
                         .position = {kRestLength + kPulled, 0},
                         .shapes = {{.geometry = Circle{0.1}, .filter = {.mask = 0}}}}};
  trial.scene.joints = {DistanceJoint{.name = "spring",
                                      .body_a = std::string(kWorld),
                                      .body_b = "ball",
                                      .length = kRestLength,
                                      .spring = Spring{.hertz = hertz, .damping_ratio = 0}}};
  trial.broke = [](double time, std::span<const BodyState> states) {
    const double swing = std::abs(std::sqrt(length_squared(states[0].position)) - kRestLength) / kPulled;
    return swing < 2 ? std::string()
                     : fmt::format("amplitude {:.2g} times the expected one after {:.2g} s", swing, time);
  };
  return trial;
}

// Returns the limit of omega h, with h the substep in which forces are evaluated; nullopt if every spring is
// stable.
std::optional<double> limit_of(const reference::Method& method) {
  if (method.follows_springs) return {};
  switch (method.scheme) {
    case reference::Scheme::ExplicitEuler:
      return 0.0;
    case reference::Scheme::SemiImplicitEuler:
    case reference::Scheme::VelocityVerlet:
      return 2 * kStep / method.substep;
    case reference::Scheme::RungeKutta4:
      return 2 * std::numbers::sqrt2 * kStep / method.substep;
    case reference::Scheme::SoftStep:  // springs too stiff for a step use the implicit midpoint method
    case reference::Scheme::Adaptive:
      break;
  }
  return {};
}

}  // namespace

Threshold spring_force() {
  return {
      .name = "spring_force",
      .title = "stiffest spring of a force law",
      .quantity = "largest angular frequency times step (1/60 s) of a mass on a spring",
      .source =
          "stability of the engine's method: omega h = 2 for symplectic Euler and Verlet, 2 sqrt(2) for "
          "Runge-Kutta, none with step control or implicit springs",
      .judged = "the amplitude exceeds the expected one a thousandfold within 4000 steps (for three digits)",
      .range = {.low = 0.1, .high = 50, .logarithmic = true},
      .exact = limit_of,
      .build = on_a_force};
}

Threshold spring_joint() {
  return {.name = "spring_joint",
          .title = "stiffest spring of a joint",
          .quantity = "largest angular frequency times step (1/60 s) of a mass on an undamped spring joint",
          .source = "no limit: an implicit spring is stable at any stiffness",
          .judged = "the amplitude exceeds twice the expected one within 4000 steps (for three digits)",
          .range = {.low = 0.1, .high = 50, .logarithmic = true},
          .exact = no_exact_value,
          .build = on_a_joint};
}

}  // namespace plumb::harness::thresholds
