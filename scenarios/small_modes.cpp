#include "scenarios/truth/bob_chain.h"
#include "scenarios/truth/parts.h"
#include "scenarios/truth/set_up.h"

// The slowest swing of N equal bobs on a massless thread: w^2 = (g/L) x, x the smallest zero of the Laguerre
// polynomial L_N (0.586, 0.416, 0.138 for N = 2, 3, 10), in the shape L_i(x) from below. Source: D.
// Bernoulli, 1733. The truth solves the full equations of Lagrange.
namespace plumb::scenarios::small_modes {
namespace {
using namespace truth;

constexpr double kSwing = 0.01;  // m, of the lowest bob

Problem build(std::string_view, int count) {
  const double x = smallest_laguerre_zero(count);
  BobChain chain{.masses = std::vector<double>(count, 0.5), .angles = {}};
  for (int i = count; i > 0; --i)  // from the top: displacement of a rod's end relative to its start
    chain.angles.push_back(
        set_up::arc_sine(kSwing * (laguerre(i - 1, x) - (i == count ? 0 : laguerre(i, x)))));
  Problem problem{.scene = chain.scene(scene_of("small_modes", count)), .duration = 2};
  problem.truth = chain.truth(problem.scene);
  problem.conserved = {.energy = true};
  problem.precise = within(1e-9);
  problem.precise.energy = 1e-5;  // the energy of the swing is 1e-4 of the potential energy
  return problem;
}

const Register r{{.name = "small_modes",
                  .summary = "the slowest swing of N bobs on a thread",
                  .sizes = {2, 3, 10},
                  .scales = true,
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::small_modes
