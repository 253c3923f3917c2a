#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double distance) {
  return resting(tower("far_stack", 5, 1, {distance, distance}), 1, kDt, steps_for(5, kDt));
}

const Register r{
    {.name = "far_stack",
     .title = "five boxes of 1 m stand on each other for 5 s, far from the origin along x and y",
     .axis = "distance from the origin",
     .unit = "m",
     .values = {0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
     .usual = 0,
     .rule =
         "no box sinks by more than 1 % of its side or moves by more than 5 % (a double has 1e-7 m at 1e9 m)",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
