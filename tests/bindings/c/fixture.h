#pragma once

#include <gtest/gtest.h>

#include "bindings/c/include/plumb/plumb.h"

namespace plumb::tests {

inline constexpr double kDt = 1.0 / 60;  // s

/// Tests of the C interface, with a world of the default settings.
class C : public ::testing::Test {
 protected:
  C() { plumb_clear_error(); }
  ~C() override { plumb_world_destroy(world); }
  C(const C&) = delete;
  C& operator=(const C&) = delete;

  plumb_body box(plumb_body_type type, plumb_vec2 position, double width, double height) {
    plumb_body_definition body = plumb_default_body();
    body.type = type;
    body.position = position;
    plumb_shape_definition shape = plumb_default_shape();
    shape.geometry = plumb_box(width, height);
    shape.hit_events = true;
    return plumb_body_create(world, &body, &shape, 1);
  }

  plumb_world* world = plumb_world_create(nullptr);
};

}  // namespace plumb::tests
