#include "extremes/parts/hanging.h"

namespace plumb::extremes {
namespace {

constexpr int kLinks = 10;

Trial build(double ratio) {
  Trial trial{.scene = rod_chain("mass_ratio_swing", kLinks, {1, 0}, ratio), .stretches = evenly(180, 180)};
  // From level to straight down the links' centres fall by 1/2, 3/2, ... m, and the tip by 10 m.
  const double energy = kGravity * (kLinks * kLinks / 2.0 + kLinks * ratio);
  trial.judge = [energy](const Scene& scene) { return closed_and_lossless(scene, kLinks, energy); };
  return trial;
}

const Register r{{.name = "mass_ratio_swing",
                  .title = "ten links of 1 kg with a heavy tip are released from the horizontal, for 3 s",
                  .axis = "mass ratio",
                  .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
                  .rule = "sum of the joint gaps at most 1 % of the chain's length, energy error at most 5 % "
                          "of the energy of the swing",
                  .patience = 3,
                  .build = build}};

}  // namespace
}  // namespace plumb::extremes
