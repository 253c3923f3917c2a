#include "engine/driver/accuracy.h"

#include <cmath>
#include <string>

#include "engine/core/loop_scheduler.h"
#include "engine/core/text.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

void require_positive(double value, const char* driver, const char* field, const char* unit) {
  if (value >= kSmallest && value <= kLargest) return;
  throw Error(Error::Kind::Value, driver, field, shortest(value),
              std::string("must be a positive number") + unit + ", from 1e-100 to 1e100");
}

/// s: limits of a world's step (`World::step`). Checked here as well, so that a run is refused before it
/// starts.
constexpr double kShortestStep = 1e-12, kLongestStep = 1e12;

/// Smallest tolerance of Precise: a step's error is limited to a thousandth of it, which is below rounding
/// for tolerances below 1e-15.
constexpr double kLeastTolerance = 1e-12;

/// A world's limit.
constexpr int kMost = 1000;

void require_at_least_one(int value, const char* field, int most = kMost) {
  if (value >= 1 && value <= most) return;
  throw Error(Error::Kind::Value, "realtime", field, std::to_string(value),
              "must be a number from 1 to " + std::to_string(most));
}

void require_known(int value, int last, const char* field, const char* driver = "realtime") {
  if (value >= 0 && value <= last) return;
  throw Error(Error::Kind::Value, driver, field, std::to_string(value), "is not one of the known kinds");
}

}  // namespace

std::string_view name_of(Precision precision) { return precision == Precision::Float ? "float" : "double"; }

std::string_view name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::VelocityVerlet:
      return "velocity_verlet";
    case Integrator::SemiImplicitEuler:
      return "semi_implicit_euler";
    case Integrator::ExplicitEuler:
      return "explicit_euler";
  }
  return "unknown";
}

std::string_view name_of(OnViolation on_violation) {
  switch (on_violation) {
    case OnViolation::Ignore:
      return "ignore";
    case OnViolation::Report:
      return "report";
    case OnViolation::Stop:
      return "stop";
  }
  return "unknown";
}

std::string_view name_of(MotionMethod method) {
  switch (method) {
    case MotionMethod::Automatic:
      return "automatic";
    case MotionMethod::Explicit:
      return "explicit";
    case MotionMethod::Implicit:
      return "implicit";
    case MotionMethod::Symplectic:
      return "symplectic";
  }
  return "unknown";
}

void validate(const Accuracy& accuracy) {
  if (const auto* precise = std::get_if<Precise>(&accuracy)) {
    if (!(precise->tolerance >= kLeastTolerance && precise->tolerance <= kLargest))
      throw Error(Error::Kind::Value, "precise", "tolerance", shortest(precise->tolerance),
                  "must be a number from 1e-12 to 1e100: further down a step's error cannot be told from "
                  "rounding");
    require_positive(precise->max_dt, "precise", "max_dt", " of seconds");
    require_known(static_cast<int>(precise->method), static_cast<int>(MotionMethod::Symplectic), "method",
                  "precise");
    return;
  }
  const Realtime& realtime = std::get<Realtime>(accuracy);
  if (!(realtime.dt >= kShortestStep && realtime.dt <= kLongestStep))
    throw Error(Error::Kind::Value, "realtime", "dt", shortest(realtime.dt),
                "must be a positive number of seconds, from 1e-12 to 1e12");
  require_at_least_one(realtime.substeps, "substeps");
  require_at_least_one(realtime.iterations, "iterations");
  require_at_least_one(realtime.threads, "threads", LoopScheduler::kMaxThreads);
  require_known(static_cast<int>(realtime.precision), static_cast<int>(Precision::Double), "precision");
  require_known(static_cast<int>(realtime.integrator), static_cast<int>(Integrator::ExplicitEuler),
                "integrator");
  require_known(static_cast<int>(realtime.solver), static_cast<int>(Solver::Direct), "solver");
  require_known(static_cast<int>(realtime.on_violation), static_cast<int>(OnViolation::Stop), "on_violation");
}

}  // namespace plumb
