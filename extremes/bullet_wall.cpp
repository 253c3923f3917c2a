#include "extremes/parts/bullet.h"

namespace plumb::extremes {
namespace {

Trial build(double thickness) { return shot("bullet_wall", {Circle{0.01}, 0, 0.01}, 1e6, thickness); }

const Register r{{.name = "bullet_wall",
                  .title = "a disc of 2 cm is shot at a wall at 1e6 m/s with restitution 1",
                  .axis = "thickness of the wall",
                  .unit = "m",
                  .values = {1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1},
                  .usual = 1,
                  .rule = "it never passes the middle of the wall, keeps its velocity before the impact (1 "
                          "%), and returns with the same speed (5 %)",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
