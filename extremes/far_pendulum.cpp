#include "extremes/parts/scenes.h"
#include "extremes/parts/swing.h"

namespace plumb::extremes {
namespace {

Trial build(double distance) { return swinging_rod("far_pendulum", 1, {distance, distance}, kDt); }

const Register r{
    {.name = "far_pendulum",
     .title = "a rod of 1 m swings at 60 degrees for two periods, far from the origin along x and y",
     .axis = "distance from the origin",
     .unit = "m",
     .values = {0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
     .usual = 0,
     .rule = "joint gap at most 1 % of the rod's length, energy error at most 5 % of the energy of the "
             "swing, position error at most 10 % of the rod's length",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
