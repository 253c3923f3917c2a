#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

/// Runs of a scene, and how far apart their ends are.
namespace plumb::properties {

enum class Engine { Precise, World, DoubleWorld };
inline constexpr Engine kEngines[] = {Engine::Precise, Engine::World, Engine::DoubleWorld};
std::string name_of(Engine engine);

using States = std::vector<BodyState>;

struct Steps {
  double dt = 1.0 / 64;
  int count = 48;
  bool continuous = true;  ///< a World's continuous collision
};

/// The states after the steps, in the scene's order. Throws Error as the engine does.
States run(Engine engine, const Scene& scene, const Steps& steps = {});

/// The largest difference of any number of any body, in SI units.
double difference(const States& a, const States& b);

/// A thousand roundings of this engine, of the numbers that scenes have (10 m, 10 m/s); of Precise its
/// tolerance a second.
double disturbance(Engine engine);

/// Returns how far runs end from the undisturbed one when every number that moves is disturbed by up to `by`,
/// and all steps of what rounds in steps by a tenth of it: the bound for what is only rounded otherwise.
/// It is large if the motion comes to a fork within that distance, and one of the disturbances, `first` and
/// the `count` - 1 after it, takes the other way.
double sensitivity(Engine engine, const Scene& scene, const States& end, double by, const Steps& steps = {},
                   unsigned first = 1, unsigned count = 6);

}  // namespace plumb::properties
