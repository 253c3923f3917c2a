#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "reference/backend.h"
#include "scenarios/scenario.h"

/// Engines and scenarios with known mistakes, to test the harness by.
namespace plumb::harness::fakes {

/// State that a fake engine gives after `step` steps of dt.
using Motion = std::function<void(long step, double dt, std::span<BodyState> out)>;

class FakeSimulator final : public reference::Simulator {
 public:
  FakeSimulator(const Scene& scene, Motion motion, double dt) : motion_(std::move(motion)), dt_(dt) {
    for (const Body& body : scene.bodies) states_.push_back(initial_state(body));
  }
  double advance(int steps) override {
    step_ += steps;
    motion_(step_, dt_, states_);
    return 1000.0 * steps;
  }
  double time() const override { return static_cast<double>(step_) * dt_; }
  void read(std::span<BodyState> out) const override {
    std::copy(states_.begin(), states_.end(), out.begin());
  }

 private:
  Motion motion_;
  double dt_;
  long step_ = 0;
  std::vector<BodyState> states_;
};

class FakeBackend : public reference::Backend {
 public:
  FakeBackend(std::string name, Motion motion, reference::Method method = {})
      : name_(std::move(name)), motion_(std::move(motion)), method_(method) {}

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return "a fake"; }
  reference::Identity identity() const override { return identity_; }
  reference::Method method(const reference::StepSettings& settings) const override {
    reference::Method method = method_;
    method.substep = settings.dt / substeps_;
    return method;
  }
  std::string unsupported(const Scene&, const reference::StepSettings&) const override {
    return unsupported_;
  }
  reference::Settings effective_settings(const Scene&, const reference::StepSettings&) const override {
    return {{"fake", "yes"}};
  }
  std::unique_ptr<reference::Simulator> create(const Scene& scene,
                                               const reference::StepSettings& settings) const override {
    return std::make_unique<FakeSimulator>(scene, motion_, settings.dt);
  }

  reference::Identity identity_{.version = "1.2", .precision = "double", .available = true, .reason = ""};
  std::string unsupported_;
  int substeps_ = 1;

 private:
  std::string name_;
  Motion motion_;
  reference::Method method_;
};

constexpr double kDoubleEpsilon = 2.220446049250313e-16;

inline reference::Method method(reference::Scheme scheme, int order, double epsilon = kDoubleEpsilon) {
  return {.scheme = scheme, .order = order, .substep = 1.0 / 60, .epsilon = epsilon};
}

/// The truth as an engine's motion.
inline Motion exactly(const scenarios::Problem& problem) {
  return [exact = problem.truth.exact](long step, double dt, std::span<BodyState> out) {
    exact(static_cast<double>(step) * dt, out);
  };
}

/// A ball thrown at (3, 4) m/s that turns at 2 rad/s: x0 + v0 t + g t^2/2.
inline scenarios::Problem thrown() {
  scenarios::Problem problem;
  problem.scene.name = "thrown";
  problem.scene.bodies = {{.name = "ball",
                           .position = {1, 2},
                           .velocity = {3, 4},
                           .angular_velocity = 2,
                           .mass = 2,
                           .inertia = 0.5,
                           .shapes = {{.geometry = Circle{0.5}}}}};
  problem.duration = 2;
  problem.conserved = {.energy = true, .momentum_x = true};
  problem.truth.source = "Galileo";
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    out[0] = {{1 + 3 * t, 2 + 4 * t - 9.81 * t * t / 2}, 2 * t, {3, 4 - 9.81 * t}, 2};
  };
  return problem;
}

/// A family of one problem.
inline scenarios::Scenario family(std::function<scenarios::Problem()> build, std::string name = "fake") {
  scenarios::Scenario scenario;
  scenario.name = std::move(name);
  scenario.build = [build = std::move(build)](std::string_view, int) { return build(); };
  return scenario;
}

}  // namespace plumb::harness::fakes
