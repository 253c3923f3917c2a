#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/precise/impact_laws/impact_law.h"
#include "harness/reality/data.h"
#include "harness/reality/fit.h"
#include "harness/reality/sample.h"
#include "reference/backend.h"

namespace plumb::harness::reality {

/// Inertia over mass of a uniform ellipse of 70 mm x 50 mm, m^2: (a^2 + b^2) / 4. It weighs the errors of all
/// laws in the same way, whatever inertia a law is fitted with.
inline constexpr double kUniformEllipse = (0.035 * 0.035 + 0.025 * 0.025) / 4;

/// A law of impact with its parameters. The first is always the inertia over the mass, m^2.
struct EllipseLaw {
  std::string name, text;
  std::vector<Parameter> parameters;
  bool of_this_floor = false;  ///< a parameter depends on the position on this one floor
  std::function<precise::ContactImpulse(const precise::ImpactPoint&, const MeasuredImpact&,
                                        std::span<const double>)>
      impulse;
};

/// The laws that are compared.
const std::vector<EllipseLaw>& ellipse_laws();

/// Result for one law. Errors are of the velocity after the impact: the difference from the measured one in
/// the norm of the kinetic energy (inertia of a uniform ellipse), divided by the measured one's.
struct EllipseFinding {
  std::string name, text;
  bool of_this_floor = false;
  std::vector<Parameter> parameters;
  std::vector<double> values;    ///< fitted on the training half
  std::vector<Estimate> fitted;  ///< the same with the intervals of fits to bootstrap samples of that half
  Estimate validated;            ///< median error by cross-validation within the training half
  Estimate train;                ///< median error on the training half
  Estimate median, ninetieth;    ///< on the test half
  std::vector<double> errors{};  ///< on the test half, sorted
};

/// Median and 90th percentile.
struct Quantiles {
  Estimate median, ninetieth;
};

/// An engine at a step. Its impacts are those of a disc at the place of the measured contact. Errors are
/// those of the velocity after the impact, as above.
struct EllipseEngine {
  std::string engine, law;
  double dt = 0;          ///< s; 0: to a tolerance
  std::string why_not{};  ///< reason if it was not run
  int failed = 0;         ///< impacts that it did not finish
  Quantiles numerical;    ///< against the same law solved to a tolerance
  Quantiles of_the_law;   ///< exact motion under the law against the measurement
  Quantiles measured;     ///< against the measurement
  Quantiles share;        ///< numerical over the law's
};

struct EllipseFindings {
  int impacts = 0, doubted = 0;      ///< number of measured impacts; of those left out as doubtful
  std::vector<EllipseFinding> laws;  ///< in the order of `ellipse_laws`
  EllipseFinding bound;              ///< for the best impulse at the contact, with the best inertia
  std::size_t best = 0, best_of_all_floors = 0;  ///< index of the law with the least `validated`
  std::vector<EllipseEngine> engines;            ///< under the first law
};

/// Fits every law to one half of the impacts and tests it on the other half; tests the engines on the other
/// half too.
EllipseFindings examine_ellipse(std::span<const MeasuredImpact> impacts, std::uint64_t seed,
                                std::span<const reference::Backend* const> engines = {});

/// Runs engines under a law with its fitted values: inertia over mass, friction, restitution.
std::vector<EllipseEngine> examine_ellipse_engines(std::span<const MeasuredImpact* const> test,
                                                   const EllipseFinding& law,
                                                   std::span<const reference::Backend* const> engines,
                                                   std::uint64_t seed);

}  // namespace plumb::harness::reality
