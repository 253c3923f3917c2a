#include "scenarios/truth/flight.h"

// Free fall and throws: in a vacuum all masses fall alike, thrown or spinning (Galileo).
namespace plumb::scenarios::free_fall {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  Problem problem{.scene = scene_of("free_fall", variant), .duration = 10};
  if (variant == "drag") {
    problem.scene.bodies = {piece("linear", {0, 0}, untouchable(Circle{0.25}), 2),
                            thrown(piece("thrown", {3, 1}, untouchable(Box{0.5, 0.25}), 0.5), {20, 25}, 2),
                            piece("quadratic", {-3, 0}, untouchable(Circle{0.5}))};
    problem.scene.forces = {LinearDrag{"linear", 0.5}, LinearDrag{"thrown", 0.25},
                            QuadraticDrag{"quadratic", 0.02}};
    // Relative 1e-13 of the longest fall and the largest speed; both are smooth at steps of 1/60 s.
    problem.precise = {1e-13 * 250, 1e-12, 1e-13 * 36, 1e-12};
  } else {
    problem.scene.bodies = {piece("feather", {0, 0}, untouchable(Circle{0.1}), 0.001),
                            thrown(piece("ball", {2, 1}, untouchable(Circle{0.25})), {12, 30}),
                            thrown(piece("wheel", {-2, 3}, untouchable(Circle{0.5}), 5), {-4.5, 8}, 7),
                            thrown(piece("plank", {-6, 0.5}, untouchable(Box{2, 0.25}), 20), {}, -2.5),
                            thrown(piece("anvil", {5, 0}, untouchable(Box{0.8, 0.5}), 1000), {1.5, -3})};
    problem.conserved = {.energy = true, .momentum_x = true};
    // Relative 1e-13 of the fall g T^2/2, of the speed g T and of the rotation.
    problem.precise = {1e-13 * 490, 1e-13 * 70, 1e-13 * 98, 1e-13 * 7, 1e-13, 1e-13};
    problem.second_order = {0, 0, 0, 0, 0, 0};  // velocity Verlet is exact
  }
  problem.truth = flight_truth(problem.scene);
  return problem;
}

const Register r{{.name = "free_fall",
                  .summary = "bodies dropped and thrown, in a vacuum and through air",
                  .variants = {"vacuum", "drag"},
                  .build = build}};

}  // namespace
}  // namespace plumb::scenarios::free_fall
