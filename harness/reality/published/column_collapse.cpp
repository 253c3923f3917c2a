#include <algorithm>

#include "harness/reality/published/published_law.h"

// Releases a column against a wall, and measures run-out over width. Sources: aluminium rods, Nguyen et al.
// 2015 (arXiv 1512.05180), 3.25 a^0.96 up to a = 1.5, 3.80 a^0.73 beyond; discs, Staron and Hinch, J. Fluid
// Mech. 545 (2005) 1, 2.5 a up to a = 2, 3.25 a^0.7 beyond. The band contains both, with 15 % on either side.
namespace plumb::harness::reality {
namespace {
constexpr int kAcross = 12;                         // rods
constexpr double kRadius = 0.05, kFriction = 0.45;  // m
/// Shift of a rod to the side at a start, m: a thousandth of its diameter, less than the gaps between rods.
constexpr double kShift = 1e-4;

double run_out(std::span<const Sample> samples) {
  Sample rods(samples.back().begin() + 2, samples.back().end());
  const auto left = [](const BodyState& a, const BodyState& b) { return a.position.x < b.position.x; };
  std::sort(rods.begin(), rods.end(), left);
  double front = 0;  // m, front of the deposit, without rods that rolled away (five diameters ahead)
  for (const BodyState& rod : rods)
    if (rod.position.x > front && rod.position.x < front + 10 * kRadius) front = rod.position.x;
  return (front + kRadius) / (2 * kAcross * kRadius) - 1;
}

PublishedLaw collapse(int a, double low, double high) {
  const std::string name = "column_collapse[" + std::to_string(a) + "]";
  const auto scene_with = [&](const std::function<double()>& shift) {
    Scene scene{.name = name};
    scene.bodies = {fixed_box("floor", {0, -0.5}, {80, 1}, kFriction)};
    scene.bodies.push_back(fixed_box("wall", {-0.5, 4}, {1, 10}, kFriction));
    for (int i = 0; i < kAcross * kAcross * a; ++i) {  // radii differ by up to 10 %: no crystal forms
      const double across = 2 * (i % kAcross) + 1 + (i / kAcross) % 2, up = 2 * (i / kAcross) + 1;
      Body rod{.name = "rod" + std::to_string(i),
               .position = {kRadius * across + kShift * shift(), kRadius * up}};
      rod.shapes = {{.geometry = Circle{kRadius * (1 - 0.001 * (i * 7919 % 101))}, .friction = kFriction}};
      scene.bodies.push_back(rod);
    }
    return scene;
  };
  const char* source = "Nguyen et al. 2015; Staron and Hinch 2005";
  return {name, "run-out over width", source, low, high, starts_of(scene_with), 4, 1.0 / 120, run_out};
}
}  // namespace

std::vector<PublishedLaw> column_collapse() { return {collapse(1, 2.1, 3.8), collapse(3, 5.9, 9.8)}; }
}  // namespace plumb::harness::reality
