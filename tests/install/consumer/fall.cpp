// A ball that falls for a second, in a project of its own.
#include <cmath>
#include <cstdio>

#include <plumb/simulation.h>

#if !defined(FORMER_HEADERS) && __has_include("engine/simulation/simulation.h")
#error "the checkout's own folders are on the path"
#endif

int main() {
  plumb::Scene scene;
  scene.bodies.push_back({.name = "ball", .position = {0, 10}, .shapes = {{.geometry = plumb::Circle{0.5}}}});

  plumb::Simulation world = plumb::compile(scene);
  world.step(60);

  const double height = world.state(0).position.y;
  std::printf("after %.3f s the ball is at %.6f m\n", world.time(), height);
  // y = y0 - g t^2 / 2, exact in this integrator but for rounding: 60 x 4 substeps of numbers below 16.
  return std::abs(height - (10 - 9.81 / 2)) < 1e-12 ? 0 : 1;
}
