#include <cmath>

#include "scenarios/truth/parts.h"

// A block slides on a cart, which rolls without resistance, until both have one speed, m v0/(m + M); the
// slip decays at mu g (1 + m/M). Source: Coulomb, Newton.
namespace plumb::scenarios::block_on_cart {
namespace {
using namespace truth;

constexpr double kFriction = 0.3, kBlock = 1, kCart = 3, kSpeed = 2;  // kg, m/s

Problem build(std::string_view, int) {
  Problem problem{.scene = scene_of("block_on_cart"), .duration = 1.5};
  problem.scene.bodies = {
      ground(0),
      {.name = "cart", .position = {0, 0.1}, .mass = kCart, .shapes = {solid(Box{2, 0.2}, kFriction)}},
      {.name = "block",
       .position = {-0.5, 0.325},
       .velocity = {kSpeed, 0},
       .mass = kBlock,
       .shapes = {solid(Box{0.5, 0.25}, kFriction)}}};
  const Real rub = Real(kFriction) * kGravity, drag = rub * kBlock / kCart, end = kSpeed / (rub + drag);
  problem.truth = follow_in_contact(problem.scene, "the slip decays at mu g (1 + m/M); momentum is kept",
                                    [=](Real t, Moving moving) {
                                      moving[0] = coast_until(moving[0], end, t, {{drag, 0}});
                                      moving[1] = coast_until(moving[1], end, t, {{-rub, 0}});
                                    });
  problem.conserved = {.momentum_x = true};
  problem.precise = within(1e-10);
  return problem;
}

const Register r{{.name = "block_on_cart", .summary = "a block slides on a free cart", .build = build}};

}  // namespace
}  // namespace plumb::scenarios::block_on_cart
