#include "extremes/parts/bullet.h"

namespace plumb::extremes {
namespace {

Trial build(double speed) { return two_shots("bullet_pair", {Circle{0.01}, 0, 0.01}, speed); }

const Register r{{.name = "bullet_pair",
                  .title = "two discs of 2 cm are shot at each other with restitution 1",
                  .axis = "speed of each",
                  .unit = "m/s",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8},
                  .usual = 10,
                  .rule = "neither passes the other; each keeps its velocity before the impact (1 %), and "
                          "returns with the same speed (5 %)",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
