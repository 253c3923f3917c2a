#include <array>
#include <vector>

#include "engine/precise/integration/integrator.h"

// Saves and restores the motion.
namespace plumb::precise {

void EventFreeIntegrator::save(double sampled, SnapshotWriter& out) {
  // A flight may be read at a time before its last step, if the impact was slightly later than first located.
  // The difference is a step of its own on the same parabola.
  const bool within = sampled < time_ && sampled != start_ && y_.size() > 0;
  const bool goes_by_it = equations_.has_loops() && start_ < time_ && y_.size() > 0;
  const bool with_polynomial = (within || goes_by_it) && method_ != MotionMethod::Symplectic;
  if (with_polynomial) polynomial();
  const auto put = [&](std::span<const double> numbers) {
    for (const double number : numbers) out.put(number);
  };
  put(std::array{start_, time_, proposed_step_, control_.previous(), implicit_.last_step(),
                 rank_at_start_.min_pivot_ratio, previous_pivot_ratio_, equations_.switches().after(),
                 equations_.switches().end()});
  for (const std::int64_t number :
       {rejected_, implicit_steps_, singularity_steps_, std::int64_t{rank_at_start_.dependent},
        std::int64_t{signs_of_stiffness_}, std::int64_t{nonstiff_steps_}, std::int64_t{stiff_},
        std::int64_t{last_implicit_}, std::int64_t{near_singularity_}, std::int64_t{jumped_},
        std::int64_t{rate_known_}, std::int64_t{with_polynomial ? last().polynomial.degree() : 0}}) {
    out.put(number);
  }
  for (const Compensated* y : {&y0_, &y_}) put(y->value()), put(y->carry());
  if (rate_known_) put(current().method.last_rate()), out.put(current().method.last_power());
  if (implicit_.last_step() > 0) put(implicit_.memory());
  if (!with_polynomial) return;
  const StepPolynomial& path = last().polynomial;
  put(path.nodes());
  for (int k = 1; k <= path.degree(); ++k) put(path.term(k));
}

void EventFreeIntegrator::restore(SnapshotReader& in) {
  const auto get = [&](std::span<double> numbers) {
    for (double& number : numbers) number = in.get<double>();
  };
  const auto integer = [&] { return in.get<std::int64_t>(); };
  double previous = 0, last_step = 0, after_switch = 0, next_switch = 0;
  for (double* number :
       {&start_, &time_, &proposed_step_, &previous, &last_step, &rank_at_start_.min_pivot_ratio,
        &previous_pivot_ratio_, &after_switch, &next_switch})
    *number = in.get<double>();
  control_.reset(previous);
  rejected_ = integer();
  implicit_steps_ = integer();
  singularity_steps_ = integer();
  rank_at_start_.dependent = static_cast<int>(integer());
  signs_of_stiffness_ = static_cast<int>(integer());
  nonstiff_steps_ = static_cast<int>(integer());
  stiff_ = integer() != 0;
  last_implicit_ = integer() != 0;
  near_singularity_ = integer() != 0;
  jumped_ = integer() != 0;
  rate_known_ = integer() != 0;
  const std::int64_t degree = integer();
  in.expect(degree >= 0 && degree <= StepPolynomial::kMaxTerms);
  std::vector<double> value(y_.size());
  for (Compensated* y : {&y0_, &y_}) {
    get(value);
    for (std::size_t i = 0; i < value.size(); ++i) y->set(i, value[i], in.get<double>());
  }
  if (rate_known_) get(current().method.last_rate()), current().method.set_last_power(in.get<double>());
  implicit_.forget();
  if (last_step > 0) {
    std::vector<double> memory(implicit_.memory().size());
    get(memory);
    implicit_.set_memory(last_step, memory);
  }
  polynomial_known_ = degree > 0;
  std::vector<double> nodes(static_cast<std::size_t>(degree));
  get(nodes);
  StepPolynomial& path = last().polynomial;
  path.set_nodes(nodes);
  for (int k = 1; k <= path.degree(); ++k) get(path.term(k));
  equations_.set_window(start_, start_);
  equations_.restore_switches(after_switch, next_switch);
  equations_.release_dependent();
  if (!near_singularity_) return;
  equations_.min_pivot_ratio_at(time_, y_.value());
  equations_.freeze_dependent();
}

}  // namespace plumb::precise
