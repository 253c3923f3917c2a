#include <algorithm>
#include <cmath>

#include "extremes/parts/ramp.h"

namespace plumb::extremes {
namespace {

// Slides iff tan(slope) > mu, with acceleration g (sin - mu cos) (Coulomb).
Trial build(double friction) {
  const double slide = kGravity * (std::sin(kSlope) - friction * std::cos(kSlope));
  return on_a_slope("ramp_box", Box{1, 0.5}, 0.25, friction, std::max(0.0, slide));
}

const Register r{{.name = "ramp_box",
                  .title = "a box of 1 m x 0.5 m is released on a slope of 30 degrees, for 1 s",
                  .axis = "friction coefficient",
                  .values = {0, 1e-6, 1e-3, 0.1, 0.5, 1, 10, 1e3, 1e6},
                  .usual = 0.5,
                  .rule = "position error at most 0.12 m (5 % of the slide without friction), overlap with "
                          "the slope at most 1 cm",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
