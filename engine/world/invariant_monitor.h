#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/scene/error.h"
#include "engine/world/world.h"

namespace plumb {

/// Bounds of an `InvariantMonitor`, as fractions of the world's own sizes and energies.
struct MonitorBounds {
  /// Error of a joint's rigid rows in position, relative to the distance from its anchor to the centre of the
  /// farther body. A taut chain of 25 links under 100 times their mass opens by 0.07 % at most; 1 % can be
  /// seen.
  double joint_gap = 0.01;
  /// Overlap of two shapes, relative to the extent of the smaller one. A heap of 100 rows rests with 0.2 %; 2
  /// % can be seen.
  double overlap = 0.02;
  /// Energy gained without a drive, relative to the largest kinetic energy so far. If a step of 1/60 s
  /// resolves a mechanism (w h < 0.4, w its fastest frequency), its energy fluctuates by at most the fraction
  /// (w h)^2/4 (Hairer, Lubich and Wanner, Geometric Numerical Integration, ch. I.5).
  double energy = 0.04;
  /// Consecutive steps for which a bound must be exceeded: an impact may open a joint for some steps.
  int lasting = 30;
};

/// Checks after each step of a world that joints are closed, that shapes do not overlap, and that energy has
/// not grown without a drive. Violations that exist at the start, or that calls between steps cause, are not
/// counted. The monitor keeps copies of the bodies' states, and makes a step about a tenth more expensive.
/// Energy is balanced over each step: the change of kinetic energy minus the work of gravity and of applied
/// forces. Motors with a speed, springs of joints, moving kinematic bodies, conveyors and mouse joints may do
/// work, so energy is not checked in steps with these.
template <class Real>
class InvariantMonitor {
 public:
  /// Monitors a world, which must outlive the monitor. Throws Error (Value) for a bound that is negative or
  /// NaN.
  explicit InvariantMonitor(const BasicWorld<Real>& world, const MonitorBounds& bounds = {});

  /// Records the state before a step: call it after the forces of the step were applied.
  void begin_step();

  /// Returns the first bound that was exceeded for `lasting` consecutive steps: `Error` (Run) names the body
  /// or the joint's bodies, the value and the bound. Throws Error (Unsupported) if `begin_step` was not
  /// called before.
  std::optional<Error> end_step();

  /// Accepts the current state as a new start: call it after bodies were moved, or a snapshot was restored.
  void reset();

 private:
  struct State {
    Vec2d position{}, velocity{}, force{};
    double angle = 0, angular_velocity = 0, torque = 0, mass = 0, inertia = 0;
    Vec2d weight{};  // N
    bool is_dynamic = false;
  };
  /// A joint or contact that exceeds its bound.
  struct Violation {
    std::uint64_t key = 0;
    double size = 0;
    int steps = 0;
  };
  bool is_persistent(std::vector<Violation>& now, const std::vector<Violation>& before, std::uint64_t key,
                     double size, double bound) const;
  std::optional<Error> check_energy();
  std::optional<Error> check_joints();
  std::optional<Error> check_overlaps();
  bool is_driven() const;
  double gap_scale(int joint) const;

  const BasicWorld<Real>* world_;
  MonitorBounds bounds_;
  std::vector<State> before_;  // by body
  std::vector<Violation> gaps_, overlaps_, previous_;
  bool in_step_ = false;           // begun, and not ended
  double energy_gain_ = 0;         // J, above the lowest balance since the start
  double max_kinetic_energy_ = 0;  // J, the largest kinetic energy so far
  int energy_violation_steps_ = 0;
};

extern template class InvariantMonitor<float>;
extern template class InvariantMonitor<double>;

}  // namespace plumb
