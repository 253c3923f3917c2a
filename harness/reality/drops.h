#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/reality/data.h"
#include "harness/reality/fit.h"
#include "harness/reality/sample.h"
#include "reference/backend.h"

namespace plumb::harness::reality {

/// Times after the first impact at which motions are compared, s.
inline constexpr std::array<double, 4> kTimes{0.02, 0.06, 0.1, 0.2};

/// A drop as it is computed: from the frame before its first contact with the floor.
struct DropStart {
  int number = 0;
  BodyState state{};
  std::vector<MeasuredPose> frames{};  ///< measured, from the start on
};

/// Returns the drops whose motion before the first impact is known from four frames or more. The state at the
/// start is taken from the parabola through these frames, because single frames are noisier.
std::vector<DropStart> starts_of(std::span<const MeasuredDrop> drops);

/// A number of a drop's scene (engine/scene/number.h) that is proportional to a parameter.
struct ScaledNumber {
  std::string name;
  double scale = 1;
};

/// Law of the drops: the contact rules and coefficients of a scene from fitted values. The first two
/// parameters are half the square's side and the delay of the measurement.
struct DropLaw {
  std::string name, text;
  std::vector<Parameter> parameters;
  std::function<void(Scene&, std::span<const double>)> apply;
  std::vector<std::vector<ScaledNumber>> numbers{};  ///< by parameter: numbers of the scene that it sets
};
const std::vector<DropLaw>& drop_laws();

/// Returns the scene of a drop: a square of uniform density over a floor at y = 0.
Scene scene_of(const DropStart& start, const DropLaw& law, std::span<const double> values);

/// Differences of two motions at each of `kTimes`, with their intervals.
struct Differences {
  std::array<Estimate, kTimes.size()> position;         ///< m, median
  std::array<Estimate, kTimes.size()> ninetieth;        ///< m, 90th percentile
  std::array<Estimate, kTimes.size()> angle;            ///< rad, median
  std::array<Estimate, kTimes.size()> angle_ninetieth;  ///< rad, 90th percentile
};

/// A law solved to a tolerance, compared with the measurement.
struct DropFinding {
  std::string name, text;
  std::vector<Parameter> parameters;
  std::vector<double> values;
  std::vector<Estimate> fitted;  ///< the values with the intervals of fits to bootstrap samples
  Differences model;             ///< exact motion under the law, against the measured one
};

/// An engine at a step, under the first law that it has.
struct EngineFinding {
  std::string engine, law;
  double dt = 0;          ///< s; 0: to a tolerance
  std::string why_not{};  ///< reason if it was not run
  int failed = 0;         ///< drops that it did not finish
  Differences numerical;  ///< against the same law solved to a tolerance
  Differences measured;   ///< against the measurement
  Differences share;      ///< `numerical` over the law's error, without unit
};

struct DropFindings {
  int drops = 0, left_out = 0;  ///< number of all drops; of those with too few frames before the impact
  int tested = 0;
  std::vector<DropFinding> laws;
  std::vector<EngineFinding> engines;
};

/// Fits every law on one half of the drops, tests it on the other, and runs the engines on the latter.
DropFindings examine_drops(std::span<const MeasuredDrop> drops,
                           std::span<const reference::Backend* const> engines, std::uint64_t seed);

}  // namespace plumb::harness::reality
