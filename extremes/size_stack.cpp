#include "extremes/parts/scenes.h"

namespace plumb::extremes {
namespace {

Trial build(double size) {
  const double dt = kDt * std::sqrt(size);
  return resting(tower("size_stack", 5, size), size, dt, steps_for(5, kDt));
}

const Register r{{.name = "size_stack",
                  .title = "five boxes stand on each other; mass scales with the square of the size and dt "
                           "with its square root (g is constant)",
                  .axis = "size",
                  .unit = "m",
                  .values = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1, 1e2, 1e3, 1e4, 1e5, 1e6},
                  .rule = "no box sinks by more than 1 % of its side or moves by more than 5 %",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
