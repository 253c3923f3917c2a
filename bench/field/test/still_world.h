#pragma once

#include <vector>

#include "bench/field/field_world.h"

namespace plumb::field {

/// A world in which nothing moves: bodies stay at their initial pose, so that all figures are known
/// beforehand.
class StillWorld : public FieldWorld {
 public:
  BodyHandle create_body(const BodyDefinition& body, std::span<const ShapeDefinition>,
                         const MassProperties&) override {
    states_.push_back({body.position, body.angle, body.velocity, body.spin});
    return {states_.size() - 1};
  }
  void destroy_body(BodyHandle) override {}
  void create_revolute(BodyHandle, BodyHandle, const RevoluteDefinition&) override {}
  void set_velocity(BodyHandle body, Vec2d velocity, double spin) override {
    states_[body.bits].velocity = velocity;
    states_[body.bits].spin = spin;
  }
  void step() override {}
  BodyState state(BodyHandle body) const override { return states_[body.bits]; }
  Counts counts() const override { return {}; }
  Settings settings() const override { return {}; }

 private:
  std::vector<BodyState> states_;
};

}  // namespace plumb::field
