#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double ratio) {
  Scene scene = tower("mass_ratio_stack", 2, 1);
  scene.bodies[1].mass = ratio;
  return resting(scene, 1, kDt, steps_for(5, kDt));
}

const Register r{{.name = "mass_ratio_stack",
                  .title = "a heavy box rests on a light one for 5 s",
                  .axis = "mass ratio",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
                  .rule = "no box sinks by more than 1 % of its side or moves by more than 5 %",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
