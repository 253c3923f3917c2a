#include <algorithm>
#include <cmath>

#include "extremes/parts/ramp.h"

namespace plumb::extremes {
namespace {

// Rolls with acceleration (2/3) g sin if mu >= tan/3, else slips with g (sin - mu cos) (Coulomb).
Trial build(double friction) {
  const double roll = kGravity * std::sin(kSlope) * 2 / 3;
  const double slip = kGravity * (std::sin(kSlope) - friction * std::cos(kSlope));
  return on_a_slope("ramp_disc", Circle{0.5}, 0.5, friction, std::max(roll, slip));
}

const Register r{{.name = "ramp_disc",
                  .title = "a disc of 1 m is released on a slope of 30 degrees, for 1 s",
                  .axis = "friction coefficient",
                  .values = {0, 1e-6, 1e-3, 0.1, 0.5, 1, 10, 1e3, 1e6},
                  .usual = 0.5,
                  .rule = "position error at most 0.12 m (5 % of the slide without friction), overlap with "
                          "the slope at most 1 cm",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
