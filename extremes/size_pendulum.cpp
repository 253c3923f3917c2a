#include "extremes/parts/scenes.h"
#include "extremes/parts/swing.h"

namespace plumb::extremes {
namespace {

Trial build(double size) { return swinging_rod("size_pendulum", size, {}, kDt * std::sqrt(size)); }

const Register r{{.name = "size_pendulum",
                  .title = "a rod swings at 60 degrees for two periods; mass scales with the square of the "
                           "size and dt with its square root (g is constant)",
                  .axis = "size",
                  .unit = "m",
                  .values = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1, 1e2, 1e3, 1e4, 1e5, 1e6},
                  .rule = "joint gap at most 1 % of the rod's length, energy error at most 5 % of the energy "
                          "of the swing, position error at most 10 % of the rod's length",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
