#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/field/builder.h"

namespace plumb::field {

/// A body whose height is measured: the top of a pile.
struct Top {
  int body = 0;
  double ground = 0;  ///< m, height of the ground below the pile
};

/// Region that bodies must not leave: a body has escaped if the origin of its frame is outside.
struct Region {
  Vec2d low{}, high{};  ///< m
};

/// Data of a scene after it is built.
struct Built {
  /// Called before each step with its number, from 0; empty if nothing happens between steps.
  std::function<void(Builder&, int step)> before_step{};
  std::vector<Top> tops{};
  std::optional<Region> region{};
};

/// A scene to measure engines by.
struct Scene {
  std::string name;
  std::string summary;
  int steps = 500;        ///< measured
  int quick_steps = 60;   ///< measured with --quick
  int warm_up = 1;        ///< steps before the clock starts
  Vec2d gravity{0, -10};  ///< m/s^2
  bool continuous = true;
  bool on_request = false;  ///< takes long: run only if it is named
  Built (*build)(Builder& world, bool quick) = nullptr;
};

/// Returns all scenes, in the order in which they are run.
const std::vector<Scene>& scenes();

}  // namespace plumb::field
