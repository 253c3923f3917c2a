// Every scenario on every engine, from the registries: a new one of either is tested without an edit here.
#include <algorithm>
#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/compare.h"
#include "harness/isolated_run.h"
#include "harness/run.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::scenarios {

void PrintTo(const Instance& instance, std::ostream* out) { *out << instance.label(); }

}  // namespace plumb::scenarios

namespace plumb::harness {
namespace {

// Calls `act` with each engine that does not refuse the scene.
void for_engines_of(const Scene& scene, const std::function<void(const reference::Backend&)>& act) {
  for (const reference::Backend* backend : reference::backends())
    if (backend->unsupported(scene, {}).empty()) act(*backend);
}

std::vector<scenarios::Instance> every_instance() {
  std::vector<scenarios::Instance> out;
  for (const scenarios::Scenario& scenario : scenarios::all())
    for (const scenarios::Instance& instance : scenarios::select(scenario.name)) out.push_back(instance);
  return out;
}

// GoogleTest's names hold letters, digits and underscores alone.
std::string name_of_test(const testing::TestParamInfo<scenarios::Instance>& info) {
  std::string out;
  for (const char c : info.param.label()) {
    if (c == ']') continue;
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return out;
}

// One test a case, for all engines: they share its truth, which may take longer than their runs.
class Agreement : public testing::TestWithParam<scenarios::Instance> {};

TEST_P(Agreement, KeepsEveryBound) {
  const reference::StepSettings settings;
  const Case scene_case(GetParam(), settings.dt);
  for_engines_of(scene_case.problem.scene, [&](const reference::Backend& backend) {
    SCOPED_TRACE(backend.name());
    Result result = run_isolated(scene_case, backend, settings, nullptr, 600).result;
    ASSERT_NE(result.status, Status::Skipped) << result.reason;
    judge(result, is_default(settings));
    for (const std::string& sentence : result.unexpected) ADD_FAILURE() << sentence;
    EXPECT_FALSE(result.checks.empty());
  });
}

// Joints that every adapter translates: rigid ones that leave the bodies free to turn.
bool is_plain(const Joint& joint) {
  if (const auto* hinge = std::get_if<RevoluteJoint>(&joint))
    return !hinge->limits && !hinge->motor && !hinge->spring;
  const auto* rod = std::get_if<DistanceJoint>(&joint);
  return rod != nullptr && !rod->spring && !rod->range && !rod->motor;
}

// Returns true for scenes that every adapter translates: discs and boxes, plain joints, equal gravity.
bool is_plain(const Scene& scene) {
  for (const Body& body : scene.bodies) {
    if (body.gravity_scale != 1 || body.linear_damping != 0 || body.angular_damping != 0) return false;
    for (const Shape& shape : body.shapes)
      if (!std::holds_alternative<Circle>(shape.geometry) && !std::holds_alternative<Box>(shape.geometry))
        return false;
  }
  return scene.contact_rules.restitution_threshold == 0 &&
         std::all_of(scene.joints.begin(), scene.joints.end(), [](const Joint& j) { return is_plain(j); });
}

// An engine that came to refuse what it ran would be missed by nobody else.
TEST(Pairings, EveryScenarioRunsOnPlumbAndOnARival) {
  for (const scenarios::Instance& instance : every_instance()) {
    const Scene scene = instance.build().scene;
    int plumb = 0, rivals = 0;
    for_engines_of(scene, [&](const reference::Backend& backend) {
      ++(backend.name().starts_with("plumb") ? plumb : rivals);
    });
    const bool everywhere = is_plain(scene);
    EXPECT_GE(plumb, everywhere ? 3 : 1) << instance.label();
    // Springs in hinges and on rails: no adapter of a rival translates them.
    const bool alone = instance.scenario->name.ends_with("_springs");
    EXPECT_GE(rivals, everywhere ? 3 : alone ? 0 : 1) << instance.label();
  }
}

INSTANTIATE_TEST_SUITE_P(All, Agreement, testing::ValuesIn(every_instance()), name_of_test);

}  // namespace
}  // namespace plumb::harness
