#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>

#include "engine/scene/error.h"
#include "tests/properties/scenes.h"

namespace plumb::properties {

/// Holds `property` (which throws by RC_ASSERT) against `cases` recipes, the same ones each time, and shrinks
/// what breaks it. PLUMB_PROPERTY_CASES multiplies the number of cases; PLUMB_PROPERTY_SEED makes others. An
/// engine that says that it cannot run a scene has not broken anything.
template <class Property>
void check_property(const rc::Gen<Recipe>& recipes, int cases, Property property) {
  const auto number = [](const char* name, unsigned long fallback) {
    const char* text = std::getenv(name);
    return text == nullptr ? fallback : std::strtoul(text, nullptr, 10);
  };
  rc::detail::TestParams params;
  params.seed = number("PLUMB_PROPERTY_SEED", 1);
  params.maxSuccess = std::max(2, cases) * static_cast<int>(number("PLUMB_PROPERTY_CASES", 1));
  const auto testable = [&] {
    const Recipe recipe = *recipes;
    try {
      property(recipe);
    } catch (const Error& error) {
      RC_DISCARD(error.what());
    }
  };
  rc::detail::TestMetadata metadata;
  const auto result = rc::detail::checkTestable(testable, metadata, params);
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream out;
  rc::detail::printResultMessage(result, out);
  ADD_FAILURE() << out.str();
}

}  // namespace plumb::properties
