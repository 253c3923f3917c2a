#include <algorithm>
#include <memory>

#include "extremes/parts/hanging.h"
#include "scenarios/truth/rod_chain.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::extremes {
namespace {

using scenarios::truth::RodChain;
using scenarios::truth::Trajectory;

// Solves Lagrange's equations in absolute angles, on first use.
Motion lagrange(int links) {
  struct Solution {
    RodChain chain;
    Trajectory path{Trajectory::State(2 * chain.count(), 0),
                    [this](const Trajectory::State& y, Trajectory::State& rate) { chain.rates(y, rate); },
                    1.0L / 480};
  };
  return [solution = std::shared_ptr<Solution>(new Solution{.chain = RodChain(links, 1, kGravity)})](
             double t, std::span<BodyState> out) {
    std::ranges::transform(solution->chain.motions(solution->path.at(t)), out.begin(),
                           scenarios::truth::rounded);
  };
}

Trial build(double links) {
  const int count = static_cast<int>(links);
  Trial trial{.scene = rod_chain("chain_falling", count, {1, 0}), .stretches = evenly(60, 60)};
  trial.exact = lagrange(count);
  const double energy = kGravity * links * links / 2;  // from level to straight down
  trial.judge = [=](const Scene& scene) { return closed_and_lossless(scene, links, energy); };
  return trial;
}

const Register r{
    {.name = "chain_falling",
     .title = "a chain of rods of 1 m, fixed at one end, is released from the horizontal, for 1 s",
     .axis = "links",
     .values = {1, 3, 10, 30, 100, 300, 1000},
     .rule = "sum of the joint gaps at most 1 % of the chain's length, energy error at most 5 % of the "
             "potential energy that the chain can release",
     .build = build}};

}  // namespace
}  // namespace plumb::extremes
