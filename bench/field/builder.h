#pragma once

#include <cstdint>
#include <ctime>
#include <span>
#include <vector>

#include "bench/field/field_world.h"

namespace plumb::field {

struct BodyRecord {
  BodyHandle handle;
  BodyDefinition definition;
  std::vector<ShapeDefinition> shapes;
  MassProperties mass;
  bool alive = true;
};

struct JointRecord {
  int a = 0, b = 0;  ///< indices of bodies
  RevoluteDefinition definition;
  bool alive = true;
};

/// Bodies and joints of the world as requested, independent of the engine, for measuring quality.
struct Inventory {
  std::vector<BodyRecord> bodies;
  std::vector<JointRecord> joints;

  Counts counts() const;  ///< `touching` stays 0
};

/// Returns the seconds of `clock` since an arbitrary start.
double seconds_of(clockid_t clock);

/// Time and memory that an engine has used so far.
struct Cost {
  double seconds = 0;
  std::int64_t allocations = 0;
  std::int64_t bytes = 0;  ///< allocated and not yet released
};

/// Builds a scene in a world. Records the bodies and joints built, and the cost of the engine's own calls;
/// the cost contains nothing else.
class Builder {
 public:
  explicit Builder(FieldWorld& world, clockid_t clock = CLOCK_MONOTONIC) : world_(world), clock_(clock) {}

  /// Returns the body's index in the inventory.
  int create_body(const BodyDefinition& body, std::span<const ShapeDefinition> shapes);
  int create_body(const BodyDefinition& body, const ShapeDefinition& shape);
  int create_body(const BodyDefinition& body, const std::vector<ShapeDefinition>& shapes);
  void destroy_body(int body);
  void create_revolute(int a, int b, const RevoluteDefinition& joint);
  void set_velocity(int body, Vec2d velocity, double spin);
  void step(int count = 1);

  /// Returns the states of every body ever created; destroyed ones have zeros.
  std::vector<BodyState> states() const;
  const Inventory& inventory() const { return inventory_; }
  const Cost& cost() const { return cost_; }

 private:
  template <class Call>
  auto metered(const Call& call);

  FieldWorld& world_;
  clockid_t clock_;
  Inventory inventory_;
  Cost cost_;
};

}  // namespace plumb::field
