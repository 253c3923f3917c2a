#pragma once

#include <rapidcheck.h>

#include <array>
#include <iosfwd>
#include <vector>

#include "engine/scene/scene.h"

/// Scenes that nobody thought of, and what they look like from elsewhere.
namespace plumb::properties {

/// A body as small whole numbers, which shrink well. `scene_of` says what they mean.
struct Thing {
  int form = 0;            ///< disc, box, triangle, capsule
  int size = 0;            ///< 0..5
  int dx = 0, dy = 0;      ///< -8..8, off the middle of its cell
  int vx = 0, vy = 0;      ///< -8..8
  int spin = 0, turn = 0;  ///< -8..8
  int mass = 0;            ///< 0..7
  int friction = 0;        ///< 0..4
  int bounce = 0;          ///< 0..4
  int tie = 0;             ///< to the thing before: one of `Ties`
};

/// Holds a thing by nothing, by a joint to the thing before, or by a force law.
enum Ties { kFree, kRevolute, kRod, kWeld, kSoftRod, kSlider, kSpring, kPull, kDrag, kPinned, kTies };

struct Recipe {
  std::vector<Thing> things{};
  std::array<bool, kTies> ties{};  ///< those that may be used; the others are left out
  bool gravity = false, walls = false, contacts = true;
  bool bouncy = false;  ///< nothing has a restitution of 0
};

Scene scene_of(const Recipe& recipe);
/// The scene as JSON: what a counterexample is printed as.
void showValue(const Recipe& recipe, std::ostream& out);

/// -range to range, the simplest of which is 0.
rc::Gen<int> about(int range);

/// Recipes of 1 to `most` things like `sample`, whose own things are of no interest.
rc::Gen<Recipe> recipes(const Recipe& sample, std::size_t most = 8);

/// Changes of view, each exact: what is computed from them differs by rounding at most.
Scene mirrored(Scene scene);                                         ///< x becomes -x
Scene turned(Scene scene);                                           ///< by a right angle
Scene shifted(Scene scene, Vec2d by);                                ///< m
Scene scaled(Scene scene, double length, double time, double mass);  ///< powers of two
Scene boosted(Scene scene, Vec2d by);                                ///< m/s, bodies that are not static

/// The same for what moves.
BodyState mirrored(const BodyState& state);
BodyState turned(const BodyState& state);
BodyState scaled(const BodyState& state, double length, double time);

}  // namespace plumb::properties
