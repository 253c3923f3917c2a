#include "extremes/parts/bullet.h"

namespace plumb::extremes {
namespace {

Trial build(double speed) { return shot("bullet_circle", {Circle{0.01}, 0, 0.01}, speed, 1e-3); }

const Register r{{.name = "bullet_circle",
                  .title = "a disc of 2 cm is shot at a wall of 1 mm with restitution 1",
                  .axis = "speed",
                  .unit = "m/s",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8},
                  .usual = 10,
                  .rule = "it never passes the middle of the wall, keeps its velocity before the impact (1 "
                          "%), and returns with the same speed (5 %)",
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
