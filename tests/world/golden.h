#pragma once

#include <cstdint>
#include <string>

namespace plumb::test {

/// Fails when `hash` is not the one that golden_hashes.txt has under `name`, or when it has none.
void expect_golden(const std::string& name, std::uint64_t hash);

}  // namespace plumb::test
