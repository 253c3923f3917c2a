#include "extremes/parts/hanging.h"

namespace plumb::extremes {
namespace {

Trial build(double ratio) { return hanging(rod_chain("mass_ratio_tip", 10, {0, -1}, ratio), 10, 5); }

const Register r{
    {.name = "mass_ratio_tip",
     .title = "ten links of 1 kg hang at rest with a heavy tip for 5 s",
     .axis = "mass ratio",
     .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9},
     .rule = "sum of the joint gaps, and displacement of each body, at most 1 % of the chain's length",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
