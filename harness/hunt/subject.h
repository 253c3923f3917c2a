#pragma once

#include <span>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/outline.h"

/// Facts about a case that several judges need.
namespace plumb::harness::hunt {

/// Returns the largest distance of each body's points from its centre of mass, m. For a body without shapes
/// this is the distance of its farthest anchor.
std::vector<double> extents(const Scene& scene);

/// Returns the smallest extent of a dynamic body, m; 1 if there is none.
double typical_size(const Scene& scene);

/// Returns the largest extent of a dynamic body, m; 1 if there is none.
double largest_size(const Scene& scene);

/// Returns true if a joint keeps two bodies from colliding.
bool joined(const Scene& scene, std::size_t a, std::size_t b);

/// Groups bodies that joints connect, directly or through other dynamic bodies: returns for each the lowest
/// index of its group. Static and kinematic bodies, and bodies without joints, have their own index.
std::vector<std::size_t> joint_groups(const Scene& scene);

/// Returns true if a body moves whatever stands in its way.
bool is_moving_kinematic(const Body& body);

/// Returns true if the scene does not bound the work on its bodies: it has moving kinematic bodies, surface
/// speeds, time-dependent forces, or actions during the run.
bool driven(const Case& one);

/// Returns an upper bound of the energy from drives, J: the work of motors with a speed up to `time`, and the
/// initial energy of springs and of motors that follow a pose.
double stored(const Scene& scene, double time);

/// Finds overlaps of shapes of two bodies that may touch: of which at least one is dynamic, that no joint or
/// filter keeps from colliding. The scene must outlive it.
class OverlapTest {
 public:
  explicit OverlapTest(const Scene& scene);

  /// Returns true if two shapes overlap in these states by more than `fraction` of the smaller extent.
  bool exceeds(std::span<const BodyState> states, double fraction);

 private:
  struct Part {
    std::size_t body;
    const Shape* shape;
    Outline outline;
    double extent;  // m
  };
  bool may_collide(const Part& a, const Part& b) const;

  const Scene& scene_;
  std::vector<Part> parts_{};
  std::vector<Outline> now_{};  // of the parts in the present states
};

/// Returns true if no two shapes that may touch penetrate at the start by more than a hundredth of the
/// smaller extent.
bool starts_apart(const Scene& scene);

/// Returns true if all joints and limits are satisfied at the start, within 1 % of the smallest body and 0.01
/// rad.
bool starts_closed(const Scene& scene);

}  // namespace plumb::harness::hunt
