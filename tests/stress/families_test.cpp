#include "harness/stress/family.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "harness/stress/settings.h"

namespace plumb::harness::stress {
namespace {

constexpr double kHuge = 3e4;  // bodies: not built here

std::vector<BodyState> states_of(const Scene& scene) {
  std::vector<BodyState> out;
  for (const Body& body : scene.bodies) out.push_back(initial_state(body));
  return out;
}

// The first samples of each stretch; the time is that of the whole run.
template <class See>
void play(const Trial& trial, int most, See see) {
  long steps = 0;
  for (const Stretch& stretch : trial.stretches) {
    for (int i = 0; i < stretch.samples; ++i) {
      steps += stretch.every;
      if (i < most && !see(static_cast<double>(steps) * trial.dt)) return;
    }
  }
}

class EveryFamily : public testing::TestWithParam<Family> {};

TEST_P(EveryFamily, IsWellFormed) {
  const Family& family = GetParam();
  for (const std::string& text : {family.name, family.title, family.axis, family.rule})
    EXPECT_FALSE(text.empty());
  EXPECT_GE(family.values.size(), 5u);
  EXPECT_LE(family.values.size(), 13u);
  for (std::size_t i = 1; i < family.values.size(); ++i) EXPECT_LT(family.values[i - 1], family.values[i]);
  EXPECT_NE(std::find(family.values.begin(), family.values.end(), family.usual), family.values.end());
  for (const double value : family.values) {
    if (family.unit.empty() && value > kHuge && family.name.starts_with("bodies")) continue;
    const Trial trial = family.build(value);
    EXPECT_NO_THROW(validate(trial.scene)) << value;
    EXPECT_EQ(trial.scene.name, family.name);
    EXPECT_GT(trial.dt, 0);
    EXPECT_FALSE(trial.stretches.empty());
    for (const Stretch& stretch : trial.stretches) EXPECT_GE(stretch.samples * stretch.every, 1);
    const auto judge = trial.judge(trial.scene);
    const std::vector<BodyState> start = states_of(trial.scene);
    if (trial.exact) {
      EXPECT_TRUE(judge->see(0, start));
      EXPECT_EQ(judge->finding().verdict, Verdict::Ok) << value << ": " << judge->finding().reason;
    }
  }
}

TEST_P(EveryFamily, CallsTheExactMotionOk) {
  const Family& family = GetParam();
  for (const double value : {family.values.front(), family.usual, family.values[family.values.size() / 2]}) {
    const Trial trial = family.build(value);
    if (!trial.exact || trial.scene.bodies.size() > 1000) continue;
    const auto judge = trial.judge(trial.scene);
    std::vector<BodyState> states = states_of(trial.scene);
    play(trial, 400, [&](double time) {
      trial.exact(time, states);
      return judge->see(time, states);
    });
    const Finding finding = judge->finding();
    EXPECT_EQ(finding.verdict, Verdict::Ok) << value << ": " << finding.reason;
    EXPECT_LE(finding.figure, 0.3 * finding.bound) << value << ": " << finding.measure;
    EXPECT_TRUE(finding.reason.empty());
  }
}

TEST_P(EveryFamily, NamesWhatFliesOff) {
  const Trial trial = GetParam().build(GetParam().usual);
  const auto judge = trial.judge(trial.scene);
  std::vector<BodyState> states = states_of(trial.scene);
  play(trial, 1000, [&](double time) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (trial.scene.bodies[i].type != BodyType::Dynamic) continue;
      states[i].position += Vec2d{1e9 * static_cast<double>(i + 1), 1e9};
      states[i].velocity += Vec2d{1e12, 1e12};
      states[i].angular_velocity += 1e12;
    }
    return judge->see(time, states);
  });
  const Finding finding = judge->finding();
  EXPECT_TRUE(finding.verdict == Verdict::Explodes) << name_of(finding.verdict);
  EXPECT_FALSE(finding.reason.empty());
}

INSTANTIATE_TEST_SUITE_P(All, EveryFamily, testing::ValuesIn(all()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Families, AreFoundByName) {
  EXPECT_EQ(find_family("stack_height").name, "stack_height");
  try {
    find_family("stack_hight");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("stack_height"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(std::is_sorted(all().begin(), all().end(),
                             [](const Family& a, const Family& b) { return a.name < b.name; }));
}

TEST(Settings, AreWhatTheEnginesTake) {
  for (const reference::Backend* backend : reference::backends()) {
    if (!backend->identity().available) continue;
    const std::vector<Setting> settings = settings_of(*backend);
    EXPECT_GE(settings.size(), 2u) << backend->name();
    EXPECT_EQ(settings.front().name, "default");
    for (const Setting& setting : settings)
      EXPECT_NO_THROW(backend->method(setting.with(1.0 / 60))) << backend->name() << " " << setting.name;
  }
}

TEST(Evenly, MakesAllSteps) {
  for (const long steps : {1L, 7L, 100L, 101L, 12'345L, 10'000'000L}) {
    long sum = 0;
    int samples = 0;
    for (const Stretch& stretch : evenly(steps, 100)) {
      sum += static_cast<long>(stretch.samples) * stretch.every;
      samples += stretch.samples;
    }
    EXPECT_EQ(sum, steps);
    EXPECT_LE(samples, 201);
  }
}

}  // namespace
}  // namespace plumb::harness::stress
