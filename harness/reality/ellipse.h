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

namespace plumb::harness::reality {

/// A law of impact with its parameters. The first is always the inertia over the mass, m^2.
struct EllipseLaw {
  std::string name, text;
  std::vector<Parameter> parameters;
  bool of_this_floor = false;  ///< has a parameter of the place, which says nothing of another floor
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
  double validated = 0;          ///< median error by cross-validation within the training half
  double train = 0;              ///< median error on the training half
  Estimate median, ninetieth;    ///< on the test half
  std::vector<double> errors{};  ///< on the test half, sorted
};

struct EllipseFindings {
  int impacts = 0, doubted = 0;                  ///< measured; of these left out
  std::vector<EllipseFinding> laws;              ///< in the order of `ellipse_laws`
  EllipseFinding bound;                          ///< the best impulse at the contact, with the best inertia
  std::size_t best = 0, best_of_all_floors = 0;  ///< laws with the least `validated`
};

/// Fits every law on one half of the impacts and tests it on the other.
EllipseFindings examine_ellipse(std::span<const MeasuredImpact> impacts, std::uint64_t seed);

}  // namespace plumb::harness::reality
