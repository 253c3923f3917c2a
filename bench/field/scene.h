#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/field/builder.h"

namespace plumb::field {

/// A body whose height is watched: the top of a pile.
struct Top {
  int body = 0;
  double ground = 0;  ///< m, height of what the pile stands on
};

/// Where bodies have to stay: those whose frames lie outside have escaped.
struct Region {
  Vec2d low{}, high{};  ///< m
};

/// What a scene knows of itself once it stands.
struct Built {
  /// Called before each step with its number, from 0; empty where nothing happens between steps.
  std::function<void(Builder&, int step)> before_step{};
  std::vector<Top> tops{};
  std::optional<Region> region{};
};

/// A scene that engines are measured by.
struct Scene {
  std::string name;
  std::string summary;
  int steps = 500;        ///< measured
  int quick_steps = 60;   ///< measured with --quick
  int warm_up = 1;        ///< steps before the clock starts
  Vec2d gravity{0, -10};  ///< m/s^2
  bool continuous = true;
  bool on_request = false;  ///< takes long: run only where it is named
  Built (*build)(Builder& world, bool quick) = nullptr;
};

/// All, in the order in which they are run.
const std::vector<Scene>& scenes();

}  // namespace plumb::field
