#include "harness/cost.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace plumb::harness {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

// Interpolates linearly between the neighbours; `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (place - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

std::vector<double> sorted(const std::vector<CostSample>& samples, double CostSample::*member) {
  std::vector<double> values;
  for (const CostSample& sample : samples) values.push_back(sample.*member);
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

CostSample measure_cost(const Case& scene_case, const reference::Backend& backend,
                        const reference::StepSettings& settings, double expected_ns_per_step,
                        const CostBudget& budget) {
  CostSample sample;
  sample.steps = step_count(scene_case.problem.duration, settings.dt);
  const double allowed = budget.at_most_ns / std::max(expected_ns_per_step, 1e-3);
  if (allowed < sample.steps) sample.steps = std::max(1, static_cast<int>(allowed));
  const Clock::time_point start = Clock::now();
  double spent = 0;
  long steps = 0;
  bool warm = false;
  do {
    const Clock::time_point setup = Clock::now();
    const auto simulator = backend.create(scene_case.problem.scene, settings);
    const double setup_ns = since(setup);
    if (!warm || setup_ns < sample.setup_ns) sample.setup_ns = setup_ns;
    const double run = simulator->advance(sample.steps);
    // Leave out the first short run, which includes cold caches and page faults.
    const bool counts = warm || run >= budget.at_least_ns;
    spent += counts ? run : 0;
    steps += counts ? sample.steps : 0;
    warm = true;
  } while (steps == 0 || (spent < budget.at_least_ns && since(start) < budget.at_most_ns));
  sample.ns_per_step = spent / static_cast<double>(steps);
  return sample;
}

Cost summarise(const std::vector<CostSample>& samples, double dt) {
  const std::vector<double> steps = sorted(samples, &CostSample::ns_per_step);
  Cost cost;
  cost.ns_per_step = quantile(steps, 0.5);
  cost.ns_per_step_low = quantile(steps, 0.25);
  cost.ns_per_step_high = quantile(steps, 0.75);
  cost.ns_per_simulated_second = cost.ns_per_step / dt;
  cost.setup_ns = quantile(sorted(samples, &CostSample::setup_ns), 0.5);
  cost.repetitions = static_cast<int>(samples.size());
  cost.steps = samples.front().steps;
  for (const CostSample& sample : samples) cost.each_ns_per_step.push_back(sample.ns_per_step);
  return cost;
}

bool clearly_differ(const Cost& a, const Cost& b) {
  return a.ns_per_step_high < b.ns_per_step_low || b.ns_per_step_high < a.ns_per_step_low;
}

bool is_noisy(const Cost& cost) {
  return cost.ns_per_step_high - cost.ns_per_step_low > 0.25 * cost.ns_per_step;
}

}  // namespace plumb::harness
