#include "engine/precise/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/driver/snapshot.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Tolerance of the companion, as a fraction of the run's: the companion's error is then a tenth, so the
/// difference is the run's error to 10 %. Below kLeastTolerance rounding would dominate both, so the
/// companion's tolerance is ten times the run's and the difference an upper estimate.
constexpr double kFiner = 0.1, kCoarser = 10, kLeastTolerance = 1e-11;

Precise companion_of(Precise precise) {
  precise.estimate_error = false;
  precise.tolerance *= precise.tolerance > kLeastTolerance ? kFiner : kCoarser;
  return precise;
}

Precise alone(Precise precise) {
  precise.estimate_error = false;
  return precise;
}

}  // namespace

ErrorEstimatingDriver::ErrorEstimatingDriver(const Precise& precise, std::size_t bodies, const Make& main,
                                             const Make& companion)
    : main_(main(alone(precise))),
      companion_(companion(companion_of(precise))),
      states_(bodies),
      companion_states_(bodies) {
  error_.known = true;
}

void ErrorEstimatingDriver::step() {
  main_->step();
  companion_->step();
  main_->read(states_);
  companion_->read(companion_states_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const BodyState &a = states_[i], &b = companion_states_[i];
    error_.position = std::max(error_.position, length(a.position - b.position));
    error_.angle = std::max(error_.angle, std::abs(a.angle - b.angle));
    error_.velocity = std::max(error_.velocity, length(a.velocity - b.velocity));
  }
}

void ErrorEstimatingDriver::write(std::size_t body, const BodyState& state) {
  main_->write(body, state);
  companion_->write(body, state);
}

Statistics ErrorEstimatingDriver::statistics() const {
  Statistics all = main_->statistics();
  all.error = error_;
  return all;
}

std::vector<std::byte> ErrorEstimatingDriver::save() const {
  const std::vector<std::byte> main = main_->save(), companion = companion_->save();
  SnapshotWriter out;
  for (const double largest : {error_.position, error_.angle, error_.velocity}) out.put(largest);
  out.put(main), out.put(companion);
  return out.bytes();
}

void ErrorEstimatingDriver::restore(std::span<const std::byte> snapshot) {
  const std::vector<std::byte> before = save();
  try {
    restore_parts(snapshot);
  } catch (const Error&) {
    restore_parts(before);
    throw;
  }
}

void ErrorEstimatingDriver::restore_parts(std::span<const std::byte> snapshot) {
  SnapshotReader in(snapshot);
  ErrorEstimate error{.known = true};
  for (double* largest : {&error.position, &error.angle, &error.velocity}) *largest = in.get<double>();
  const auto main = in.get<std::vector<std::byte>>(), companion = in.get<std::vector<std::byte>>();
  in.expect_end();
  main_->restore(main);
  companion_->restore(companion);
  error_ = error;
}

}  // namespace plumb::precise
