#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {

/// Ground that a support leaves for a structure.
struct Site {
  enum class Kind { Air, Floor, Enclosure } kind = Kind::Air;
  double width = 0;   ///< m, of the floor or the inside; its middle is x = 0, its ground y = 0
  double height = 0;  ///< m, of the inside
  double wall = 0;    ///< m, thickness of an enclosure's walls
  double friction = 0.6;
  bool level = true;   ///< a floor that is flat and at rest
  bool moves = false;  ///< the ground moves or has a surface speed
};

/// A case that is being composed.
class Draft {
 public:
  Draft(std::uint64_t seed, std::uint64_t index) : random(seed, index) { out.seed = seed, out.index = index; }

  Random random;
  Case out;
  Site site;
  double size = 1;         ///< m, of the bodies being built
  double friction = 0.6;   ///< of the bodies being built, unless an idiom draws its own
  double restitution = 0;  ///< as friction
  double density = 1;      ///< kg/m^2
  std::string idiom;       ///< idiom of the next bodies; part of their names

  Body& body(int index) { return out.scene.bodies[static_cast<std::size_t>(index)]; }
  const std::string& name(int index) const;  ///< of a body; "world" for -1

  /// Adds a body with the draft's materials. Dynamic ones weigh `density` times their area.
  int add(const Geometry& geometry, Vec2d at, double angle = 0, BodyType type = BodyType::Dynamic);
  int box(Vec2d at, double width, double height, double angle = 0, BodyType type = BodyType::Dynamic);
  int disc(Vec2d at, double radius, BodyType type = BodyType::Dynamic);
  /// Adds a disc, a box, a capsule, a polygon or a rounded one, of about `size` m.
  int any(Vec2d at, double size, double angle = 0);
  Geometry any_geometry(double size);
  /// Recomputes the body's mass after shapes were added, and moves its origin to its centre of mass.
  void weigh(int index);

  /// Transforms a point of the world to a body's frame; -1: the fixed frame.
  Vec2d local(int index, Vec2d point) const;

  /// Adds a joint between two bodies at a point of the world; -1: the fixed frame. Its angle there is 0.
  RevoluteJoint& revolute(int a, int b, Vec2d at);
  WeldJoint& weld(int a, int b, Vec2d at);
  PrismaticJoint& prismatic(int a, int b, Vec2d at, Vec2d axis);
  WheelJoint& wheel(int a, int b, Vec2d at, Vec2d axis);
  DistanceJoint& rod(int a, int b, Vec2d on_a, Vec2d on_b);
  template <class Kind>
  Kind& join(int a, int b) {
    Kind joint{};
    joint.name = idiom + ".j" + std::to_string(out.scene.joints.size());
    joint.body_a = name(a), joint.body_b = name(b);
    out.scene.joints.push_back(joint);
    return std::get<Kind>(out.scene.joints.back());
  }

  /// Disables collisions among the bodies from `first` on.
  void pass_each_other(int first);
  /// Adds a common rotation about a point to the velocities of the bodies from `first` on.
  void whirl(int first, Vec2d about, double rate);
  int count() const { return static_cast<int>(out.scene.bodies.size()); }

  Expectation& expect(const std::string& name, int index, Quantity quantity);

 private:
  double relative_angle(int a, int b) const;
};

/// Returns the unit vector of an angle, with the same bits everywhere.
Vec2d direction(double angle);

/// A common structure, support or disturbance. One file in idioms/, registered nowhere else.
struct Idiom {
  enum class Role { Support, Structure, Disturbance };
  std::string name;
  std::string title;  ///< "four blades on a hub"
  Role role = Role::Structure;
  double weight = 1;                                 ///< relative frequency
  bool air = true, floor = true, enclosure = false;  ///< sites that a structure may be built on
  bool level = false;                                ///< only floors that are flat and at rest
  std::function<bool(const Draft&)> fits{};  ///< of a disturbance: where it applies; empty: everywhere
  std::function<void(Draft&)> build{};
};

/// Returns every idiom, sorted by name.
const std::vector<Idiom>& idioms();

/// Throws `Error` (Name) that suggests the nearest name.
const Idiom& find_idiom(std::string_view name);

/// Adds an idiom: `static const Register r{{.name = ..., .build = ...}};`
struct Register {
  explicit Register(Idiom idiom);
};

/// Draws case `index` of a hunt; `wanted` names the structures to choose from, empty: all. The same arguments
/// give the same case on every machine.
Case compose(std::uint64_t seed, std::uint64_t index, const std::vector<const Idiom*>& wanted = {});

}  // namespace plumb::harness::hunt
