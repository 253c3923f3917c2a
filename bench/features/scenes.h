#pragma once

#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

/// Scenes in which a few bodies use a feature, next to many that do not.
namespace plumb::bench {

/// A feature that a scene may use: a name, and a function that adds the few bodies that use it.
struct Feature {
  std::string_view name;
  std::string_view what;
  void (*add)(Scene& scene);
  /// Gives a body the properties of the feature in a way that has no effect; null if that is impossible.
  void (*declare)(Body& body) = nullptr;
};

const std::vector<Feature>& features();

/// Adds bodies without shapes that fall freely and use no feature. `declared` (may be null) is declared on
/// each of them.
void add_rest(Scene& scene, const Feature* declared);

}  // namespace plumb::bench
