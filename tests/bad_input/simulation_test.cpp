// Every number that a compiled scene is asked with, and every setting, with every bad value.
#include <gtest/gtest.h>

#include <climits>
#include <cmath>

#include "engine/simulation/simulation.h"
#include "tests/bad_input/refusal.h"
#include "tests/bad_input/scene_members.h"

namespace plumb {

PLUMB_MEMBERS(BodyState, position, angle, velocity, angular_velocity)

namespace bad_input {
namespace {

Scene two_balls() {
  Scene scene{.name = "two balls"};
  for (const double x : {0.0, 1.25})
    scene.bodies.push_back(
        {.name = x > 0 ? "b" : "a", .position = {x, 0}, .shapes = {{.geometry = Circle{0.5}}}});
  return scene;
}

TEST(SimulationSettings, BadOnesAreRefused) {
  Rules rules({{"Realtime.dt", {1e-12, 1e12}},
               {"Realtime.substeps", {1, 1000}},
               {"Realtime.iterations", {1, 1000}},
               {"Realtime.precision", {0, 1}},
               {"Realtime.integrator", {0, 2}},
               {"Realtime.solver", {0, 4}},
               {"Realtime.on_violation", {0, 2}},
               {"Realtime.threads", {1, 64}},
               {"Precise.tolerance", {1e-12, 1e100}},
               {"Precise.max_dt", {1e-100, 1e100}},
               {"Precise.method", {0, 3}}});
  int refused = 0;
  const auto try_all = [&](auto good, const std::string& subject) {
    std::vector<FieldPlace> places;
    visit_fields(good, {}, [&](const FieldPlace& at, auto&) { places.push_back(at); });
    for (const FieldPlace& at : places) {
      const Rule rule = rules.of(at.key);
      std::vector<double> numbers = bad_numbers();
      numbers.push_back(INT_MAX);
      for (const double bad : numbers) {
        auto spoilt = good;
        std::string text;
        visit_fields(spoilt, {}, [&]<class T>(const FieldPlace& here, T& value) {
          if (here.path != at.path || !can_hold<T>(bad)) return;
          value = static_cast<T>(bad);
          text = text_of<T>(bad);
        });
        if (text.empty()) continue;
        SCOPED_TRACE(at.path + " = " + text);
        try {
          Simulation simulation = compile(two_balls(), spoilt);
          EXPECT_TRUE(rule.accepts(bad)) << "was accepted";
        } catch (const Error& error) {
          EXPECT_FALSE(rule.accepts(bad)) << error.what();
          expect_names(error, {subject, at.path, text});
          ++refused;
        }
      }
    }
  };
  try_all(Realtime{}, "realtime");
  try_all(Precise{}, "precise");
  rules.expect_all_used();
  EXPECT_GT(refused, 80);
}

TEST(SimulationSteps, ExtremesOfSettingsEndOrAreRefused) {
  for (const double dt : {1e-100, 1e-12, 1e12, 1e100}) {
    for (const Accuracy& accuracy : {Accuracy{Realtime{.dt = dt}}, Accuracy{Precise{.max_dt = dt}}}) {
      SCOPED_TRACE(testing::Message() << accuracy.index() << " with " << dt);
      try {
        Simulation simulation = compile(two_balls(), accuracy);
        simulation.step(2);
        for (std::size_t body : {0, 1}) EXPECT_TRUE(std::isfinite(simulation.state(body).position.y));
      } catch (const Error& error) {
        // A world refuses positions beyond its range at once, and stops at a motion that leaves it.
        EXPECT_TRUE(error.kind() == Error::Kind::Run || error.kind() == Error::Kind::Value) << error.what();
      }
    }
  }
}

class SimulationCalls : public testing::TestWithParam<Accuracy> {
 protected:
  Simulation simulation_ = compile(two_balls(), GetParam());

  void expect_refused(const std::string& field, const std::string& value, const std::function<void()>& run) {
    const std::uint64_t before = simulation_.hash();
    try {
      run();
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Value) << error.what();
      EXPECT_EQ(error.field(), field) << error.what();
      EXPECT_NE(error.value().find(value), std::string::npos) << error.what();
    }
    EXPECT_EQ(simulation_.hash(), before);
  }
};

std::string setting_name(const testing::TestParamInfo<Accuracy>& one) {
  static const char* const kNames[] = {"Realtime", "RealtimeFloat", "Precise"};
  return kNames[one.index];
}

INSTANTIATE_TEST_SUITE_P(, SimulationCalls,
                         testing::Values(Accuracy{Realtime{}},
                                         Accuracy{Realtime{.precision = Precision::Float}},
                                         Accuracy{Precise{}}),
                         setting_name);

TEST_P(SimulationCalls, BadStatesAreRefused) {
  const Rule rule{-1e100, 1e100};
  const BodyState good = simulation_.state(1);
  std::vector<FieldPlace> places;
  BodyState sample;
  visit_fields(sample, {}, [&](const FieldPlace& at, auto&) { places.push_back(at); });
  for (const FieldPlace& at : places) {
    for (const double bad : bad_numbers()) {
      BodyState state = good;
      visit_fields(state, {}, [&](const FieldPlace& here, double& value) {
        if (here.path == at.path) value = bad;
      });
      SCOPED_TRACE(at.path + " = " + shortest(bad));
      if (!rule.accepts(bad)) {
        expect_refused(last_name(at.path), shortest(bad), [&] { simulation_.set_state(1, state); });
        continue;
      }
      try {
        simulation_ = compile(two_balls(), GetParam());
        simulation_.set_state(1, state);
        simulation_.step(2);
        for (std::size_t body : {0, 1}) {
          const BodyState end = simulation_.state(body);
          EXPECT_TRUE(std::isfinite(end.position.x + end.position.y + end.angle + end.velocity.x +
                                    end.velocity.y + end.angular_velocity));
        }
      } catch (const Error& error) {
        // A world refuses positions beyond its range at once, and stops at a motion that leaves it.
        EXPECT_TRUE(error.kind() == Error::Kind::Run || error.kind() == Error::Kind::Value) << error.what();
      }
      simulation_ = compile(two_balls(), GetParam());
    }
  }
}

TEST_P(SimulationCalls, BadPlacesCountsAndBytesAreRefused) {
  simulation_.step(3);
  for (const std::size_t body : {std::size_t{2}, std::size_t{1000000}, SIZE_MAX}) {
    expect_refused("body", std::to_string(body), [&] { simulation_.state(body); });
    expect_refused("body", std::to_string(body), [&] { simulation_.set_state(body, {}); });
  }
  for (const std::size_t size : {0, 1, 3, 100}) {
    std::vector<BodyState> states(size);
    expect_refused("read", std::to_string(size), [&] { simulation_.read(states); });
  }
  for (const int count : {-1, INT_MIN})
    expect_refused("count", std::to_string(count), [&] { simulation_.step(count); });
  for (const std::size_t size : {0, 1, 100, 100000})
    expect_refused(size < 32 ? "state" : "", "",  // 32: bytes of the header
                   [&] { simulation_.restore(std::vector<std::byte>(size)); });
}

}  // namespace
}  // namespace bad_input
}  // namespace plumb
