#pragma once

#include <functional>
#include <memory>
#include <vector>

/// Trees of hinges in Simbody, without any header of Simbody or of the engine, because these need different
/// C++ standards.
namespace plumb::reference::simbody {

/// A body in the plane. SI units.
struct TreeLink {
  int parent = -1;      ///< an earlier link; -1: the world
  bool hinged = false;  ///< true: a hinge; false: the body is free
  double parent_anchor[2] = {0, 0}, anchor[2] = {0, 0};
  double mass = 1, inertia = 1;
  double q[3] = {0, 0, 0};  ///< the angle relative to the parent; of a free body angle, x and y
  double u[3] = {0, 0, 0};  ///< their rates
};

struct TreeState {
  double x = 0, y = 0, angle = 0, vx = 0, vy = 0, w = 0;
};

/// Force at the centre of mass and torque.
struct TreeWrench {
  double fx = 0, fy = 0, torque = 0;
};

/// Computes the wrench on each link at `time`. Angles count whole turns.
using TreeForces =
    std::function<void(double time, const std::vector<TreeState>& states, std::vector<TreeWrench>& out)>;

class Tree {
 public:
  /// Throws std::runtime_error with Simbody's message.
  Tree(std::vector<TreeLink> links, TreeForces forces, double tolerance);
  ~Tree();

  /// Integrates up to `time`. Throws std::runtime_error.
  void advance(double time);

  std::vector<TreeState> states() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace plumb::reference::simbody
