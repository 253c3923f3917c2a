#include <algorithm>

#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double dt) {
  return resting(tower("dt_stack", 5, 1), 1, dt, std::clamp(steps_for(5, dt), 100L, 50'000L));
}

const Register r{{.name = "dt_stack",
                  .title = "five boxes stand on each other for 5 s, at least 100 steps and at most 50,000",
                  .axis = "dt",
                  .unit = "s",
                  .values = {1e-6, 1e-5, 1e-4, 1e-3, 1.0 / 60, 0.05, 0.2, 1},
                  .usual = 1.0 / 60,
                  .rule = "no box sinks by more than 1 % of its side or moves by more than 5 %",
                  .patience = 3,
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
