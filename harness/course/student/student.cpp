#include "harness/course/student/student.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/features.h"
#include "harness/course/student/world.h"
#include "reference/support/settings.h"

namespace plumb::course {
namespace {

using namespace plumb::reference;

class StudentSimulator final : public Simulator {
 public:
  StudentSimulator(const Scene& scene, const StepSettings& settings, const std::string& mistake,
                   Scheme scheme, const Manner& manner)
      : substeps_(settings.substeps.value_or(1)),
        world_(scene, settings.dt / substeps_, mistake, scheme, manner) {}

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * substeps_; ++i) world_.step();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }
  double time() const override { return world_.time(); }
  void read(std::span<BodyState> out) const override {
    const std::vector<BodyState> states = world_.states();
    std::copy(states.begin(), states.end(), out.begin());
  }

 private:
  int substeps_;
  StudentWorld world_;
};

class Student final : public Backend {
 public:
  Student(std::string mistake, Scheme scheme, Manner manner)
      : mistake_(std::move(mistake)), scheme_(scheme), manner_(manner) {}

  std::string_view name() const override { return "student"; }
  std::string_view summary() const override { return "an engine as the course builds it"; }
  Identity identity() const override { return {.version = "1", .precision = "double"}; }
  Method method(const StepSettings& settings) const override {
    check_steps(name(), settings, Stepping::Fixed);
    return {.scheme = scheme_,
            .order = scheme_ == Scheme::VelocityVerlet ? 2 : 1,
            .substep = settings.dt / settings.substeps.value_or(1),
            .epsilon = std::numeric_limits<double>::epsilon()};
  }
  std::string unsupported(const Scene& scene, const StepSettings&) const override {
    return unusual_feature(scene);
  }
  Settings effective_settings(const Scene&, const StepSettings& settings) const override {
    return {{"dt", shortest(settings.dt)}};
  }
  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<StudentSimulator>(scene, settings, mistake_, scheme_, manner_);
  }

 private:
  std::string mistake_;
  Scheme scheme_;
  Manner manner_;
};

}  // namespace

std::unique_ptr<Backend> make_student(std::string mistake, reference::Scheme scheme, Manner manner) {
  return std::make_unique<Student>(std::move(mistake), scheme, manner);
}

}  // namespace plumb::course
