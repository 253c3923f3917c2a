#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/result.h"

/// Rows written by hand, whose fronts and shares can be seen.
namespace plumb::harness::sweep {

inline Result row(std::string engine, double error, double cost, double dt = 1.0 / 64,
                  std::string label = "scene") {
  Result out;
  out.scenario = label;
  out.label = std::move(label);
  out.engine = std::move(engine);
  out.dt = dt;
  out.asked.dt = dt;
  out.duration = 1;
  out.metrics.position_error = error;
  Cost measured;
  measured.ns_per_step = measured.ns_per_step_low = measured.ns_per_step_high = cost * dt;
  measured.ns_per_simulated_second = cost;
  measured.repetitions = 1;
  measured.each_ns_per_step = {cost * dt};
  out.cost = measured;
  return out;
}

}  // namespace plumb::harness::sweep
