#include "harness/thresholds/find.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "engine/scene/error.h"

// Searches on engines whose critical friction is known: they hold a box at `kCritical` and more, and below it
// do something worse.
namespace plumb::harness::thresholds {
namespace {

constexpr double kCritical = 0.4;

using Below = std::function<void(std::span<BodyState> states)>;

/// A simulator in which nothing moves, or `below` happens a second on.
class StickySimulator final : public reference::Simulator {
 public:
  StickySimulator(const Scene& scene, double dt, Below below) : dt_(dt), below_(std::move(below)) {
    for (const Body& body : scene.bodies) states_.push_back(initial_state(body));
    holds_ = scene.bodies[0].shapes[0].friction >= kCritical;
  }
  double advance(int steps) override {
    step_ += steps;
    if (!holds_ && time() > 1.5) below_(states_);
    return 0;
  }
  double time() const override { return static_cast<double>(step_) * dt_; }
  void read(std::span<BodyState> out) const override { std::ranges::copy(states_, out.begin()); }

 private:
  double dt_;
  Below below_;
  long step_ = 0;
  bool holds_ = false;
  std::vector<BodyState> states_;
};

class StickyBackend final : public reference::Backend {
 public:
  explicit StickyBackend(Below below) : below_(std::move(below)) {}
  std::string_view name() const override { return "sticky"; }
  std::string_view summary() const override { return "a fake"; }
  reference::Identity identity() const override { return {.version = "1", .precision = "double"}; }
  reference::Method method(const reference::StepSettings&) const override { return {}; }
  std::string unsupported(const Scene&, const reference::StepSettings&) const override { return refusal; }
  reference::Settings effective_settings(const Scene&, const reference::StepSettings&) const override {
    return {{"fake", "yes"}};
  }
  std::unique_ptr<reference::Simulator> create(const Scene& scene,
                                               const reference::StepSettings& settings) const override {
    return std::make_unique<StickySimulator>(scene, settings.dt, below_);
  }
  std::string refusal;

 private:
  Below below_;
};

void slide(std::span<BodyState> states) { states[1].position.x -= 0.1; }

Finding found_with(const Below& below, double seconds_a_run = 10) {
  const StickyBackend backend(below);
  return find_one({&find("ramp_friction"), &backend}, {.seconds_a_run = seconds_a_run});
}

TEST(Find, FindsAnEnginesOwnValue) {
  const Finding finding = found_with(slide);
  EXPECT_EQ(finding.outcome, Finding::Outcome::Found) << finding.reason;
  ASSERT_TRUE(finding.found);
  EXPECT_NEAR(*finding.found, kCritical, 0.5e-3 * kCritical);
  ASSERT_TRUE(finding.exact);
  EXPECT_NEAR(*finding.exact, 0.36397, 1e-5);
  EXPECT_NEAR(*finding.relative_difference(), 0.4 / 0.36397 - 1, 1e-3);
  EXPECT_NE(finding.reason.find("slides"), std::string::npos) << finding.reason;
  EXPECT_EQ(finding.settings[0].first, "fake");
}

// Whatever way a run ends badly, it is a break with its reason.
TEST(Find, NamesWhatBreaks) {
  const std::pair<Below, const char*> ways[] = {
      {[](auto states) { states[1].angle = std::numeric_limits<double>::quiet_NaN(); }, "not finite"},
      {[](auto) { throw Error(Error::Kind::Run, "a solver", "", "", "gave up"); }, "gave up"},
      {[](auto) { std::abort(); }, "SIGABRT"}};
  for (const auto& [below, words] : ways) {
    const Finding finding = found_with(below);
    EXPECT_EQ(finding.outcome, Finding::Outcome::Found);
    EXPECT_NEAR(finding.found.value_or(0), kCritical, 0.5e-3 * kCritical);
    EXPECT_NE(finding.reason.find(words), std::string::npos) << finding.reason;
  }
}

TEST(Find, AHangIsABreak) {
  const Finding finding = found_with([](auto) { sleep(1000); }, 0.2);
  EXPECT_EQ(finding.outcome, Finding::Outcome::Found);
  EXPECT_NEAR(finding.found.value_or(0), kCritical, 0.5e-3 * kCritical);
  EXPECT_NE(finding.reason.find("no end within"), std::string::npos) << finding.reason;
}

TEST(Find, ARefusalIsSaid) {
  StickyBackend backend(slide);
  backend.refusal = "has no boxes";
  const Finding finding = find_one({&find("ramp_friction"), &backend}, {});
  EXPECT_EQ(finding.outcome, Finding::Outcome::Refused);
  EXPECT_EQ(finding.reason, "has no boxes");
  EXPECT_EQ(finding.runs, 0);
}

TEST(Find, SearchesSideBySideGiveTheSame) {
  const StickyBackend backend(slide);
  const Request requests[] = {{&find("ramp_friction"), &backend}, {&find("steep_ramp_friction"), &backend}};
  int ended = 0;
  find_all(requests, {.jobs = 2}, [&](std::size_t i, const std::optional<Finding>& finding) {
    ++ended;
    ASSERT_TRUE(finding);
    const Finding alone = find_one(requests[i], {});
    EXPECT_EQ(finding->found, alone.found);
    EXPECT_EQ(finding->outcome, alone.outcome);
  });
  EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace plumb::harness::thresholds
