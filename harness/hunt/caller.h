#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "engine/world/snapshot/body_hash.h"
#include "engine/world/world.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {

/// Makes one of the calls, each a member of its own, and checks the answers of the world afterwards.
template <class Real, class Target>
class Caller {
 public:
  Caller(Random& random, const BasicWorld<Real>& world, Target& target)
      : random_(random), world_(world), target_(target) {}

  std::string make();

 private:
  using Make = std::string (Caller::*)();

  // Relative tolerance of numbers that a world stores in floats: ten roundings.
  static constexpr double kRounding = 2e-6;

  static bool near(double a, double b, double scale = 0) {
    return std::abs(a - b) <= kRounding * (std::abs(a) + std::abs(b) + scale) + 1e-30;
  }
  static bool near(Vec2d a, Vec2d b, double scale = 0) {
    return length(a - b) <= kRounding * (length(a) + length(b) + scale) + 1e-30;
  }

  template <std::size_t kCount, class T>
  T pick(const T (&of)[kCount]) {
    return of[random_.whole(0, static_cast<int>(kCount) - 1)];
  }
  double number(double most) { return random_.chance(0.25) ? 0 : random_.within(-most, most); }
  Vec2d vector(double most) { return {number(most), number(most)}; }
  double size() const {
    const Aabb<double> box = world_.box(body_);
    const double out = 0.5 * length(box.upper - box.lower);
    return out > 0 ? out : 1;
  }
  bool dynamic() const { return world_.type(body_) == BodyType::Dynamic; }
  // Returns true for a body that calls can wake.
  bool simulated() const { return dynamic() && world_.enabled(body_); }

  /// Positions and velocities of three material points of a body, which a change of mass must not change.
  struct MaterialPoints {
    std::vector<Vec2d> local, place, velocity;
    double spin = 0, fastest = 0;
  };

  // Checks and parts that calls share. Each check returns an objection, or an empty text.
  std::string not_woken(const char* call) const;
  std::string answers(const char* call, bool right) const;
  MaterialPoints motion() const;
  std::string moves_otherwise(const char* call, const MaterialPoints& before) const;
  /// Returns an objection if a change of mass has moved points of the body, or has not woken it.
  std::string mass_is_wrong(const char* call, const MaterialPoints& before);
  /// Returns the hashes of awake bodies, as recordings store them after a step; none while changes of mass
  /// wait for the next step or call.
  std::vector<BodyHash> single_hashes() const;
  /// Returns an objection if the call left the hash of the (awake) body unchanged, or changed that of another
  /// body.
  std::string hash_is_wrong(const char* call, const std::vector<BodyHash>& before) const;
  /// Returns an objection if mass, centre and inertia are not those of the shapes' outlines.
  std::string mass_by_shapes();
  ShapeDefinition shape_of(double s);
  /// Returns an objection if a sleeping body overlaps a solid shape of the body that it may touch.
  std::string sleepers_inside() const;
  bool is_joined(BodyId other) const;

  // Draw one of the calls below.
  Make on_body();
  Make on_shape();
  Make on_joint();
  Make on_world();

  // In calls_on_bodies.cpp.
  std::string set_velocity();
  std::string set_spin();
  std::string set_position();
  /// Returns an objection unless the angles of the body's hinges, which count turns, followed its rotation.
  std::string turned_by(double turn, const std::vector<double>& before) const;
  std::string impulse();
  std::string turn();
  std::string force();
  std::string weightless();
  std::string damping();
  std::string locks();
  std::string mass();
  std::string densities();
  std::string type();
  std::string sleep();
  std::string may_sleep();
  std::string enable();
  std::string continuous();
  std::string towards();
  std::string name();
  std::string destroy();
  std::string add_shape();

  // In calls_on_parts.cpp: on shapes, and on joints.
  std::string material();
  std::string filter();
  std::string density();
  std::string sensor();
  std::string flags();
  std::string destroy_shape();
  std::string change();
  std::string loads();
  // Replaces a joint by one that breaks at about its present load.
  std::string rejoin();
  std::string destroy_joint();

  // In calls.cpp: on the world.
  std::string gravity();
  std::string settings();
  std::string thresholds();
  std::string create();
  // Creates a body without shapes, or one with several, one of them far away.
  std::string ghost();
  std::string add_joint();

  Random& random_;
  const BasicWorld<Real>& world_;
  Target& target_;
  std::vector<BodyId> bodies_;
  BodyId body_{};
  ShapeId shape_{};
  JointId joint_{};
};

}  // namespace plumb::harness::hunt
