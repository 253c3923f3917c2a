#pragma once

#include <nlohmann/json.hpp>

namespace plumb::test {

/// Returns true if `value` is valid under `schema`, a part of the JSON Schema (2020-12) `root`. Throws
/// std::invalid_argument for a keyword or pattern that it does not know: no rule is passed over in silence.
bool valid(const nlohmann::json& root, const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace plumb::test
