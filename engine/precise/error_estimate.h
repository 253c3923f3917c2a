#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "engine/driver/accuracy.h"
#include "engine/driver/driver.h"

namespace plumb::precise {

/// Runs `Precise` twice, the second time at another tolerance: the difference of both runs estimates the
/// error of the first, including its amplification by the motion.
class ErrorEstimatingDriver final : public Driver {
 public:
  using Make = std::function<std::unique_ptr<Driver>(const Precise&)>;
  /// `main` and `companion` create the two drivers of the scene, which has `bodies` bodies. Of the companion,
  /// only the states are read.
  ErrorEstimatingDriver(const Precise& precise, std::size_t bodies, const Make& main, const Make& companion);

  void step() override;
  double time() const override { return main_->time(); }
  void read(std::span<BodyState> out) const override { main_->read(out); }
  void write(std::size_t body, const BodyState& state) override;
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> snapshot) override;
  Reactions reactions() override { return main_->reactions(); }
  std::vector<BodyState> sensitivities(std::size_t parameter) override {
    return main_->sensitivities(parameter);
  }
  const Plan& plan() const override { return main_->plan(); }
  void profile(bool on) override { main_->profile(on); }
  Statistics statistics() const override;

 private:
  void restore_parts(std::span<const std::byte> snapshot);

  std::unique_ptr<Driver> main_, companion_;
  std::vector<BodyState> states_, companion_states_;
  ErrorEstimate error_{};
};

}  // namespace plumb::precise
