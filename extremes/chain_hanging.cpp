#include "extremes/parts/hanging.h"

namespace plumb::extremes {
namespace {

Trial build(double links) {
  return hanging(rod_chain("chain_hanging", static_cast<int>(links), {0, -1}), links, 1);
}

const Register r{
    {.name = "chain_hanging",
     .title = "a chain of rods of 1 m hangs at rest for 1 s",
     .axis = "links",
     .values = {1, 10, 30, 100, 300, 1000, 3000, 10'000},
     .rule = "sum of the joint gaps, and displacement of each body, at most 1 % of the chain's length",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
