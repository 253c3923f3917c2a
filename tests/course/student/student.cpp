#include "tests/course/student/student.h"

#include <chrono>
#include <limits>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/features.h"
#include "reference/support/settings.h"
#include "tests/course/student/world.h"

namespace plumb::course {
namespace {

using namespace plumb::reference;

class StudentSimulator final : public Simulator {
 public:
  StudentSimulator(const Scene& scene, double dt, const std::string& mistake) : world_(scene, dt, mistake) {}

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps; ++i) world_.step();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }
  double time() const override { return world_.time(); }
  void read(std::span<BodyState> out) const override {
    const std::vector<BodyState> states = world_.states();
    std::copy(states.begin(), states.end(), out.begin());
  }

 private:
  StudentWorld world_;
};

class Student final : public Backend {
 public:
  explicit Student(std::string mistake) : mistake_(std::move(mistake)) {}

  std::string_view name() const override { return "student"; }
  std::string_view summary() const override { return "an engine as the course builds it"; }
  Identity identity() const override { return {.version = "1", .precision = "double"}; }
  Method method(const StepSettings& settings) const override {
    check_steps(name(), settings, Stepping::Fixed);
    return {.scheme = Scheme::SemiImplicitEuler,
            .order = 1,
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
    return std::make_unique<StudentSimulator>(scene, settings.dt, mistake_);
  }

 private:
  std::string mistake_;
};

}  // namespace

std::unique_ptr<Backend> make_student(std::string mistake) {
  return std::make_unique<Student>(std::move(mistake));
}

}  // namespace plumb::course
