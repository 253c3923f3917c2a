#pragma once

#include <cstdint>

/// Switches that leave out one special mechanism of a step, for measuring what each one is for. Only a
/// developer build has them (CMake option PLUMB_ABLATION): it reads the names of the mechanisms to leave out
/// from the environment variable PLUMB_ABLATE, once. Elsewhere `enabled` is a constant, and costs nothing.
/// bench/ablation.py measures all of them; docs/decisions/ablation.md has the results.
namespace plumb {

enum class Switch {
  // islands/, joint_solver/
  SlenderIslands,
  DirectIslands,
  FlyingStacks,
  JointedIslands,
  HingeTrees,
  LinkInertia,
  TreeEnergy,
  DividedSubsteps,
  KeptImpulses,
  RigidGroups,
  DriverBudget,
  YieldingContacts,
  MassLimits,
  ShiftWork,
  PenetrationCorrections,
  HandingOver,
  BalancedBreaks,
  JointGaps,
  CarriedImpulses,
  AngularLimits,
  ContactGains,
  // contact_solver/, solvers/, integration/
  LoadEstimates,
  SubstepGrowth,
  ImpulseMemory,
  KinematicRamps,
  DiscNormals,
  KeptClosed,
  TurningContacts,
  // step/, state/
  RidingContacts,
  LastingContacts,
  SegmentsAhead,
  TurnedManifolds,
  InternalEdges,
  ImpactsInFlight,
  Landings,
  SimultaneousImpacts,
  SeparatingFaces,
  OpenJoints,
  SelfOverlapPass,
  SharedSearches,
  // continuous/
  CommonMotion,
  Lifts,
  JoinedStops,
  RemainingWork,
  LongSearches,
  SweptBounds,
  Count
};

#ifdef PLUMB_ABLATION
inline constexpr bool kAblation = true;
static_assert(static_cast<int>(Switch::Count) <= 64);

/// Returns the set of mechanisms that PLUMB_ABLATE names, as bits. Ends the program if it names an unknown
/// one.
std::uint64_t ablated_mechanisms();

inline bool enabled(Switch mechanism) {
  static const std::uint64_t ablated = ablated_mechanisms();
  return (ablated >> static_cast<int>(mechanism) & 1) == 0;
}
#else
/// True in builds whose environment may leave out mechanisms.
inline constexpr bool kAblation = false;
/// Returns false if a mechanism is to be left out.
constexpr bool enabled(Switch) { return true; }
#endif

}  // namespace plumb
