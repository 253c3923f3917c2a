#include "scenarios/truth/colliding_discs.h"

namespace plumb::scenarios::truth {
namespace {

Body disc(std::string name, double mass, double radius, Vec2d position, Vec2d velocity, double restitution) {
  return thrown(piece(std::move(name), position, solid(Circle{radius}, 0, restitution), mass), velocity);
}

/// Returns a light disc that hits one `ratio` times heavier, and a heavy one that hits a light one. The two
/// pairs do not interact.
std::vector<Body> discs_head_on(double ratio) {
  return {
      disc("light", 1, 0.5, {-2.53, 3}, {2.25, 0}, 1), disc("heavy_target", ratio, 0.5, {0, 3}, {0, 0}, 1),
      disc("heavy", ratio, 0.5, {-2.53, -3}, {1.75, 0}, 1), disc("light_target", 1, 0.5, {0, -3}, {0, 0}, 1)};
}

/// Returns unequal discs that meet off-centre.
std::vector<Body> discs_off_centre(double restitution) {
  return {disc("cue", 1, 0.5, {-3, 6.3}, {3, 0}, restitution),
          disc("object", 1, 0.5, {0, 6}, {0, 0}, restitution),
          disc("small", 0.5, 0.25, {-2.04, 0}, {2.5, 0.4}, restitution),
          disc("large", 4, 1, {1.5, 0.2}, {-0.5, 0.1}, restitution),
          disc("falling", 2, 0.4, {0.2, -3}, {0.3, -2}, restitution),
          disc("rising", 3, 0.6, {-0.1, -7}, {0.1, 1.2}, restitution)};
}

/// Returns a pair that meets head-on, both moving, and one that meets off-centre.
std::vector<Body> discs_inelastic(double restitution) {
  return {disc("chaser", 1, 0.5, {-3.01, 2}, {3.5, 0}, restitution),
          disc("chased", 2, 0.25, {0, 2}, {0.5, 0}, restitution),
          disc("small", 0.5, 0.25, {-2.04, -2}, {2.5, 0.4}, restitution),
          disc("large", 4, 1, {1.5, -1.8}, {-0.5, 0.1}, restitution)};
}

/// Returns Newton's cradle with gaps: equal discs in line swap their velocities, one pair after another.
std::vector<Body> discs_in_line() {
  std::vector<Body> row = {disc("disc0", 1, 0.25, {-2, 0.5}, {2, 0}, 1)};
  for (const double gap : {0.83, 0.077, 0.111, 0.053}) {
    const Vec2d next = row.back().position + Vec2d{0.5 + gap, 0};
    row.push_back(disc("disc" + std::to_string(row.size()), 1, 0.25, next, {0, 0}, 1));
  }
  return row;
}

}  // namespace

std::vector<Body> colliding_discs(std::string_view variant) {
  if (variant.starts_with("head_on"))
    return discs_head_on(choose(
        variant, {{"head_on_1", 1}, {"head_on_10", 10}, {"head_on_1000", 1000}, {"head_on_1e6", 1e6}}));
  if (variant == "cradle") return discs_in_line();
  if (variant == "oblique") return discs_off_centre(1);
  return discs_inelastic(choose(variant, {{"restitution_0", 0}, {"restitution_half", 0.5}}));
}

}  // namespace plumb::scenarios::truth
