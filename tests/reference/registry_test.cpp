#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/scene/error.h"
#include "reference/backend.h"
#include "reference/support/unavailable.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using ::testing::HasSubstr;

/// The error that `act` must throw.
template <class Act>
Error error_of(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {Error::Kind::Io, "", "", "", ""};
}

std::vector<const Backend*> available() {
  std::vector<const Backend*> out;
  for (const Backend* backend : backends()) {
    if (backend->identity().available) out.push_back(backend);
  }
  return out;
}

TEST(Registry, ListsPlumbFirstThenByName) {
  std::vector<std::string> names;
  for (const Backend* backend : backends()) names.emplace_back(backend->name());
  const std::vector<std::string> expected{"plumb",  "plumb-float",   "plumb-precise",    "ballistic", "box2d",
                                          "bullet", "bullet-double", "bullet-multibody", "mujoco"};
  EXPECT_EQ(names, expected);
}

TEST(Registry, EveryEngineOfTheBuildIsAvailable) {
  for (const Backend* backend : backends()) {
    const Identity identity = backend->identity();
    EXPECT_TRUE(identity.available) << backend->name() << ": " << identity.reason;
    EXPECT_FALSE(identity.version.empty()) << backend->name();
    EXPECT_FALSE(backend->summary().empty()) << backend->name();
    EXPECT_THAT(identity.precision, ::testing::AnyOf("float", "double")) << backend->name();
  }
  EXPECT_EQ(find_backend("box2d").identity().version.substr(0, 4), "2.4.");
  EXPECT_EQ(find_backend("bullet").identity().version, find_backend("bullet-double").identity().version);
  EXPECT_EQ(find_backend("bullet").identity().precision, "float");
  EXPECT_EQ(find_backend("bullet-double").identity().precision, "double");
}

TEST(Registry, UnknownNameSuggestsTheNearest) {
  const Error error = error_of([] { find_backend("bulet"); });
  EXPECT_EQ(error.kind(), Error::Kind::Name);
  EXPECT_THAT(error.what(), HasSubstr("did you mean 'bullet'?"));
}

TEST(Registry, AnEngineThatIsMissingSaysWhy) {
  const auto missing = make_unavailable("some_engine", "install some-engine");
  EXPECT_EQ(missing->name(), "some-engine");
  EXPECT_FALSE(missing->identity().available);
  EXPECT_EQ(missing->identity().reason, "install some-engine");
  EXPECT_EQ(missing->unsupported({}, {}), "install some-engine");
  EXPECT_THROW(missing->create({}, {}), Error);
}

TEST(Settings, BadStepsAreTypedErrors) {
  for (const Backend* backend : available()) {
    for (const double dt : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      const Error error = error_of([&] { backend->method({.dt = dt}); });
      EXPECT_EQ(error.kind(), Error::Kind::Value) << backend->name();
      EXPECT_EQ(error.field(), "dt") << backend->name();
      EXPECT_THAT(error.subject(), HasSubstr(backend->name()));
    }
    const bool adaptive = backend->method({}).scheme == Scheme::Adaptive;
    const Error substeps = error_of([&] { backend->method({.substeps = 0}); });
    EXPECT_EQ(substeps.kind(), adaptive ? Error::Kind::Unsupported : Error::Kind::Value) << backend->name();
    EXPECT_EQ(substeps.field(), "substeps");
    const Error tolerance = error_of([&] { backend->method({.tolerance = -1.0}); });
    EXPECT_EQ(tolerance.kind(), adaptive ? Error::Kind::Value : Error::Kind::Unsupported) << backend->name();
    EXPECT_EQ(tolerance.field(), "tolerance");
  }
}

TEST(Settings, UnknownOptionSuggestsTheNearest) {
  for (const Backend* backend : available()) {
    const Error error = error_of([&] { backend->method({.options = {{"iteratoins", "4"}}}); });
    EXPECT_EQ(error.kind(), Error::Kind::Name) << backend->name();
    EXPECT_EQ(error.value(), "iteratoins") << backend->name();
  }
  const Error near = error_of([] { find_backend("bullet").method({.options = {{"iteratoins", "4"}}}); });
  EXPECT_THAT(near.what(), HasSubstr("did you mean 'iterations'?"));
}

TEST(Settings, BadOptionValuesAreTypedErrors) {
  const auto rejects = [](const char* engine, const char* option, const char* value) {
    const Error error = error_of([&] {
      const Backend& backend = find_backend(engine);
      backend.effective_settings(testing::head_on(), {.options = {{option, value}}});
    });
    EXPECT_EQ(error.kind(), Error::Kind::Value) << engine << " " << option << "=" << value;
    EXPECT_EQ(error.field(), option) << error.what();
    EXPECT_THAT(error.value(), HasSubstr(value));
  };
  for (const char* value : {"", "x", "4x", "-1", "1e3", "99999999999999999999"}) {
    rejects("box2d", "velocity_iterations", value);
    rejects("bullet", "iterations", value);
    rejects("bullet-double", "iterations", value);  // across the process protocol
    rejects("plumb", "iterations", value);
  }
  for (const char* value : {"nan", "inf", "-0.1", "0.2 "}) rejects("bullet", "joint_erp", value);
  rejects("box2d", "continuous", "yes");
  rejects("plumb", "integrator", "verlet");
}

TEST(Settings, AFloatEngineRefusesAStepThatItWouldRoundAway) {
  for (const char* name : {"box2d", "bullet"}) {
    const Error error = error_of([&] { find_backend(name).method({.dt = 1e-6, .substeps = 10}); });
    EXPECT_EQ(error.kind(), Error::Kind::Value) << name;
    EXPECT_THAT(error.what(), HasSubstr("float")) << name;
  }
  EXPECT_EQ(find_backend("bullet-double").method({.dt = 1e-6, .substeps = 10}).substep, 1e-7);
}

TEST(Settings, EffectiveSettingsListEveryOptionAndWhatIsEqualised) {
  const Scene scene = testing::head_on();
  for (const Backend* backend : available()) {
    if (backend->name() == "ballistic") continue;
    std::set<std::string> names;
    // Engines without contacts are asked about a scene that they run.
    const bool touches = backend->unsupported(scene, {}).empty();
    for (const auto& [name, value] : backend->effective_settings(touches ? scene : testing::pendulum(), {})) {
      EXPECT_TRUE(names.insert(name).second) << backend->name() << " prints " << name << " twice";
      EXPECT_FALSE(value.empty()) << backend->name() << " " << name;
    }
    std::vector<std::string> due{"friction_rule", "restitution_rule", "restitution_threshold", "precision"};
    for (const Option& option : backend->options()) due.push_back(option.name);
    if (!backend->name().starts_with("plumb")) {
      for (const char* name : {"dt", "substeps", "sleeping", "linear_damping", "angular_damping", "inertia",
                               "filters", "forces", "linear_slop", "max_rotation", "continuous"}) {
        due.emplace_back(name);
      }
    }
    for (const std::string& name : due) {
      EXPECT_TRUE(names.contains(name)) << backend->name() << " does not print " << name;
    }
  }
  for (const char* name : {"polygon_radius", "max_translation", "position_iterations"}) {
    const Settings printed = find_backend("box2d").effective_settings(scene, {});
    EXPECT_TRUE(std::any_of(printed.begin(), printed.end(), [&](auto& each) { return each.first == name; }))
        << name;
  }
}

TEST(Settings, EffectiveSettingsShowWhatWasAskedFor) {
  const StepSettings settings{.dt = 0.01, .substeps = 3, .options = {{"iterations", "7"}}};
  for (const char* name : {"plumb", "bullet", "bullet-double"}) {
    const Settings printed = find_backend(name).effective_settings(testing::head_on(), settings);
    const auto value_of = [&](const std::string& key) {
      for (const auto& [each, value] : printed) {
        if (each == key) return value;
      }
      return std::string("absent");
    };
    EXPECT_EQ(value_of("dt"), "0.01") << name;
    EXPECT_EQ(value_of("substeps"), "3") << name;
    EXPECT_EQ(value_of("iterations"), "7") << name;
    EXPECT_EQ(value_of("restitution_rule"), "maximum") << name;
    EXPECT_EQ(find_backend(name).method(settings).substep, 0.01 / 3) << name;
  }
}

// Printed settings are those that run: a spring of 20 rad a step has 80 substeps of a quarter of a rad, not
// 4.
TEST(Methods, SchemesAndOrders) {
  const auto method = [](const char* name, const char* integrator) {
    return find_backend(name).method({.options = {{"integrator", integrator}}});
  };
  EXPECT_EQ(method("plumb", "velocity_verlet").scheme, Scheme::SoftStep);
  EXPECT_EQ(method("plumb", "velocity_verlet").order, 1);
  EXPECT_EQ(method("plumb", "semi_implicit_euler").scheme, Scheme::SemiImplicitEuler);
  EXPECT_EQ(method("plumb", "explicit_euler").order, 1);
  EXPECT_EQ(find_backend("plumb-precise").method({}).order, 0);
  for (const char* name : {"box2d", "bullet", "bullet-double"}) {
    EXPECT_EQ(find_backend(name).method({}).scheme, Scheme::SemiImplicitEuler) << name;
    EXPECT_EQ(find_backend(name).method({}).order, 1) << name;
  }
  // Across the process protocol options choose the method too.
  if (const Backend& multibody = find_backend("bullet-multibody"); multibody.identity().available) {
    EXPECT_EQ(method("bullet-multibody", "euler").scheme, Scheme::SemiImplicitEuler);
    EXPECT_EQ(method("bullet-multibody", "rk4").scheme, Scheme::RungeKutta4);
    EXPECT_EQ(method("bullet-multibody", "rk4").order, 4);
    EXPECT_EQ(multibody.method({.dt = 0.5, .substeps = 4, .options = {{"integrator", "rk4"}}}).substep,
              0.125);
  }
  EXPECT_EQ(testing::epsilon_of(find_backend("bullet-double")), std::numeric_limits<double>::epsilon());
  EXPECT_EQ(testing::epsilon_of(find_backend("plumb-float")), std::numeric_limits<float>::epsilon());
}

}  // namespace
}  // namespace plumb::reference
