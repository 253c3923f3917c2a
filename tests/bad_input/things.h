#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "engine/world/world.h"

/// A world with one of everything that calls ask for.
namespace plumb::bad_input {

inline void expect_finite(Vec2d v) { EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y)); }

template <class Real>
struct Things {
  BasicWorld<Real> world;
  BodyId ground, lift, box, ball;
  ShapeId shape, sensor;
  ChainId chain;
  JointId joint;

  Things() {
    ground = world.create_body({.type = BodyType::Static},
                               ShapeDefinition{.geometry = Box{20, 1}, .position = {0, -0.5}});
    lift = world.create_body({.type = BodyType::Kinematic, .position = {-4, 1}},
                             ShapeDefinition{.geometry = Box{1, 0.2}});
    box = world.create_body({.name = "box", .position = {0, 1}, .velocity = {1, 0}});
    shape = world.create_shape(box, {.geometry = Box{1, 1}});
    ball = world.create_body({.position = {2, 2}}, ShapeDefinition{.geometry = Circle{0.5}});
    sensor = world.create_shape(ground, {.geometry = Circle{1}, .position = {4, 0}, .sensor = true});
    chain = world.create_chain(ground, {.points = {{5, 0}, {6, 1}, {7, 0}}});
    joint = world.create_joint(ground, ball,
                               {.kind = RevoluteDefinition{.anchor_a = {2, 3}, .anchor_b = {0, 1}}});
    for (int i = 0; i < 5; ++i) world.step();
  }
};

}  // namespace plumb::bad_input
