#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double boxes) {
  return resting(tower("stack_height", static_cast<int>(boxes), 1), 1, kDt, steps_for(5, kDt));
}

const Register r{{.name = "stack_height",
                  .title = "a tower of boxes of 1 m stands for 5 s",
                  .axis = "boxes",
                  .values = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000},
                  .rule = "no box sinks by more than 1 % of its side or moves by more than 5 %",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
