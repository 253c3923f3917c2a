#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/simulation/precise_outline.h"

namespace plumb::precise {

/// How a body moves, with its acceleration.
struct Motion {
  BodyState state{};
  Vec2d acceleration{};             ///< m/s^2
  double angular_acceleration = 0;  ///< rad/s^2
};

/// Who is moved how: what `Precise` derives from the scene before anything is allocated.
struct Parts {
  std::vector<std::size_t> flying;  ///< bodies on polynomials: static, kinematic, under constant forces alone
  std::vector<std::size_t> integrated;  ///< dynamic bodies with joints, with shapes that may touch, or with
                                        ///< forces that depend on the motion
  bool ballistic = false;  ///< contacts apart, nothing but constant forces acts on the integrated bodies
  std::vector<Outline> outlines;  ///< of shapes that have a partner to touch
  std::vector<std::pair<std::size_t, std::size_t>>
      apart;                     ///< bodies, first < second, whose joint keeps them from touching; sorted
  std::vector<double> switches;  ///< s, > 0: when forces are switched, ascending
};

Parts divide(const Scene& scene);

/// The scene with the laws alone that act on one of `bodies`, which ascend.
Scene with_laws_on(const Scene& scene, const std::vector<std::size_t>& bodies);

/// Whether the pair's shapes may touch as far as body types, filters and joints go.
bool may_meet(const Scene& scene, const Parts& parts, std::size_t body_a, const Filter& a, std::size_t body_b,
              const Filter& b);

/// The scene's own scales that errors are measured against.
struct Scales {
  double length = 1;  ///< m: the largest extent of an integrated body, joint or lever
  double speed = 1;   ///< m/s: what the scene's accelerations give over that length
};

Scales scales_of(const Scene& scene, const Parts& parts);

}  // namespace plumb::precise
