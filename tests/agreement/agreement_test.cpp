// Every scenario on every engine, from the registries: a new one of either is tested without an edit here.
#include <cctype>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "harness/compare.h"
#include "harness/isolated_run.h"
#include "harness/run.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {
namespace {

struct Pairing {
  scenarios::Instance instance;
  const reference::Backend* backend;
};

// The test's name has the instance.
void PrintTo(const Pairing& pairing, std::ostream* out) { *out << pairing.backend->name(); }

// Those that the engine does not refuse.
std::vector<Pairing> pairings() {
  std::vector<Pairing> out;
  for (const scenarios::Scenario& scenario : scenarios::all()) {
    for (const scenarios::Instance& instance : scenarios::select(scenario.name)) {
      const Scene scene = instance.build().scene;
      for (const reference::Backend* backend : reference::backends())
        if (backend->unsupported(scene, {}).empty()) out.push_back({instance, backend});
    }
  }
  return out;
}

// GoogleTest's names hold letters, digits and underscores alone.
std::string name_of_test(const testing::TestParamInfo<Pairing>& info) {
  std::string name = fmt::format("{}__on__{}", info.param.instance.label(), info.param.backend->name());
  std::string out;
  for (const char c : name) {
    if (c == ']') continue;
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return out;
}

// Kept from one engine to the next: the truth may take long.
const Case& case_of(const scenarios::Instance& instance) {
  static std::unique_ptr<Case> kept;
  if (!kept || kept->label != instance.label())
    kept = std::make_unique<Case>(instance, reference::StepSettings{}.dt);
  return *kept;
}

class Agreement : public testing::TestWithParam<Pairing> {};

TEST_P(Agreement, KeepsEveryBound) {
  const Pairing& pairing = GetParam();
  const reference::StepSettings settings;
  IsolatedRun isolated = run_isolated(case_of(pairing.instance), *pairing.backend, settings, nullptr, 600);
  Result& result = isolated.result;
  ASSERT_NE(result.status, Status::Skipped) << result.reason;
  judge(result, is_default(settings));
  for (const std::string& sentence : result.unexpected) ADD_FAILURE() << sentence;
  EXPECT_FALSE(result.checks.empty());
}

// An engine that came to refuse what it ran would be missed by nobody else.
TEST(Pairings, EveryScenarioRunsOnPlumbAndOnARival) {
  std::map<std::string, int> plumb, rivals;
  for (const Pairing& pairing : pairings())
    ++(pairing.backend->name().starts_with("plumb") ? plumb : rivals)[pairing.instance.label()];
  for (const scenarios::Scenario& scenario : scenarios::all()) {
    for (const scenarios::Instance& instance : scenarios::select(scenario.name)) {
      // Pulleys: of the rivals Box2D has them.
      const bool everywhere = scenario.name != "atwood";
      EXPECT_GE(plumb[instance.label()], 3) << instance.label();
      EXPECT_GE(rivals[instance.label()], everywhere ? 3 : 1) << instance.label();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Agreement, testing::ValuesIn(pairings()), name_of_test);

}  // namespace
}  // namespace plumb::harness
