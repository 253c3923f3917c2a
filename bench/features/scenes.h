#pragma once

#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

/// Scenes in which a feature is used by a few bodies beside many that have no use for it.
namespace plumb::bench {

/// Something that a scene may use: a name, and the two bodies or so that do.
struct Feature {
  std::string_view name;
  std::string_view what;
  void (*add)(Scene& scene);
  /// Gives a body what the feature goes by where it can have no effect, if there is such a thing.
  void (*declare)(Body& body) = nullptr;
};

const std::vector<Feature>& features();

/// Bodies without shapes that fall freely: they use no feature. `declared` (may be null) is declared on each.
void add_rest(Scene& scene, const Feature* declared);

}  // namespace plumb::bench
