#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "tests/bad_input/fields.h"

/// Checks the properties of an error about bad input.
namespace plumb::bad_input {

/// The value is refused by a typed error that names the thing, its member and the value.
struct Refusal {
  std::string subject, path, value;
};

inline void expect_names(const Error& error, const Refusal& wanted) {
  EXPECT_EQ(error.kind(), Error::Kind::Value) << error.what();
  EXPECT_EQ(error.subject(), wanted.subject) << error.what();
  EXPECT_EQ(last_name(error.field()), last_name(wanted.path)) << error.what();
  EXPECT_NE(error.value().find(wanted.value), std::string::npos) << wanted.value << " in " << error.what();
  EXPECT_FALSE(error.problem().empty());
}

template <class Real>
bool is_finite(const BasicWorld<Real>& world) {
  for (const BodyId body : world.bodies()) {
    const BodyState state = world.state(body);
    for (const double value : {state.position.x, state.position.y, state.angle, state.velocity.x,
                               state.velocity.y, state.angular_velocity}) {
      if (!std::isfinite(value)) return false;
    }
  }
  return true;
}

/// Whatever was accepted: steps end with finite states or say that they could not.
template <class Real>
void expect_finite_steps(BasicWorld<Real>& world, int steps = 3) {
  try {
    for (int i = 0; i < steps; ++i) {
      world.step();
      ASSERT_TRUE(is_finite(world)) << "after step " << i;
    }
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Run) << error.what();
  }
}

/// Calls `run`, which has to be refused by a world that stays as it was, bit by bit.
template <class Real, class Run>
void expect_refused(BasicWorld<Real>& world, const Refusal& wanted, Run&& run) {
  const std::vector<std::byte> before = save(world);
  try {
    run();
    ADD_FAILURE() << "was accepted";
  } catch (const Error& error) {
    expect_names(error, wanted);
  } catch (const std::exception& other) {
    ADD_FAILURE() << "not a typed error: " << other.what();
  }
  EXPECT_TRUE(save(world) == before) << "something has changed";
}

/// Looks rules up by key, and knows which were never needed.
class Rules {
 public:
  explicit Rules(std::map<std::string, Rule> rules) : rules_(std::move(rules)) {}
  /// A field without a rule is a failure: somebody has to say what values it may have.
  Rule of(const std::string& key) {
    used_.insert(key);
    const auto found = rules_.find(key);
    if (found == rules_.end()) ADD_FAILURE() << key << " has no rule: what values may it have?";
    return found == rules_.end() ? Rule{} : found->second;
  }
  void expect_all_used() const {
    for (const auto& [key, rule] : rules_) EXPECT_TRUE(used_.count(key)) << key << " was not met";
  }

 private:
  std::map<std::string, Rule> rules_;
  std::set<std::string> used_;
};

}  // namespace plumb::bad_input
