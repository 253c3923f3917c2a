#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "harness/reality/drops.h"
#include "harness/reality/parallel.h"

namespace plumb::harness::reality {

/// Poses of a drop at its times; empty if the run did not finish.
using Poses = std::optional<std::array<MeasuredPose, kTimes.size()>>;

/// Frames after the start that are nearest to the times after the first touch. Engines are read at these
/// frames, so that no pose has to be interpolated between their steps.
std::array<int, kTimes.size()> frames_of(const DropStart& start, const Scene& scene,
                                         std::span<const double> values);

inline MeasuredPose pose_of(const BodyState& state) { return {state.position, state.angle}; }

/// Returns the exact motion under a law, to a tolerance.
Poses solve(const DropStart& start, const DropLaw& law, std::span<const double> values, double tolerance);

/// Derivatives of a pose with respect to the law's parameters; empty if one does not exist.
using PoseDerivatives = std::optional<std::vector<MeasuredPose>>;

/// The exact motion with its derivatives, by time.
struct DerivedPoses {
  Poses poses;
  std::array<PoseDerivatives, kTimes.size()> by;
};
DerivedPoses solve_derived(const DropStart& start, const DropLaw& law, std::span<const double> values,
                           double tolerance);

/// Returns the measured poses; each is later than the computed time by the fitted delay.
Poses measured(const DropStart& start, const DropLaw& law, std::span<const double> values);
/// Returns the rates of the measured poses, 1/s: their derivatives by the delay.
Poses measured_rates(const DropStart& start, const DropLaw& law, std::span<const double> values);

/// Weight of a squared angle relative to squared positions in `pose_distance`, m^2: inertia over mass of a
/// uniform square of 60 mm.
inline constexpr double kAngleWeight = 0.06 * 0.06 / 6;
/// Returns the difference of two poses in the norm of the kinetic energy, m.
double pose_distance(const MeasuredPose& a, const MeasuredPose& b);

/// Returns `of` for all drops, computed on two threads.
template <class Of>
auto for_each(std::span<const DropStart* const> drops, const Of& of) {
  return in_parallel(drops.size(), [&](std::size_t i) { return of(*drops[i]); });
}

}  // namespace plumb::harness::reality
