#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include "engine/scene/error.h"
#include "engine/scene/scene.h"

/// Scenes for the tests of the format.
namespace plumb::test {

/// A valid scene with one of everything and no field at its default.
Scene full_scene();

/// A valid scene whose numbers have random bits, as far as the format allows.
Scene random_scene(std::mt19937_64& random);

/// Any finite double, all bit patterns being equally likely.
double random_bits(std::mt19937_64& random);

/// The error that `run` throws; fails the test and throws on where it throws none.
Error error_of(const std::function<void()>& run);

/// Returns true if two scenes are the same in every bit: negative zeros count.
bool same_bits(const Scene& a, const Scene& b);

}  // namespace plumb::test
