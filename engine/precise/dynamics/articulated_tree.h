#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"
#include "engine/precise/dynamics/motion.h"

namespace plumb::precise {

/// Bodies that hang, hinge by hinge, on static bodies under gravity alone: a tree in minimal coordinates. The
/// state is the angles of all links, then their angular velocities. Accelerations are those of the
/// articulated-body method (Featherstone 1983), which eliminates from the tips to the root.
///
/// With a the acceleration of a link's own hinge (relative to free fall), the force there is L a + b. With c
/// the vector from that hinge to the centre of mass, e that to a child's hinge, x^ = (-x_y, x_x):
///   J = I + m c^2 + sum e^ . L_k e^,      U = m c^ + sum L_k e^,      q_k = w^2 L_k e - b_k,
///   W = w^2 m c + sum q_k,                T = sum e^ . q_k,           (dw/dt) = (T - U . a) / J,
///   L = m + sum L_k - U U^T / J,          b = U T / J - W.
class ArticulatedTree final : public Flow {
 public:
  /// Is empty if anything else acts on the bodies, if shapes may touch, or if not `enabled`.
  ArticulatedTree(const Scene& scene, const ScenePartition& partition, EquationsOfMotion& equations,
                  bool enabled);

  bool empty() const { return links_.empty(); }
  /// Returns an even number: each half is padded with zeros.
  std::size_t dimension() const { return 2 * width_; }
  std::size_t width() const { return width_; }  ///< of a half
  std::size_t size() const { return links_.size(); }
  std::size_t slot(std::size_t link) const { return links_[link].slot; }

  /// Returns the part of the state `y` of all coordinates that holds the angles and angular velocities.
  std::span<const double> angles_of(std::span<const double> y);
  /// Adds `change(i)` to each; `forward_kinematics` must follow.
  template <class Change>
  void add_to_angles(const Change& change, Compensated& y) const {
    for (std::size_t link = 0; link < links_.size(); ++link) {
      const std::size_t first = EquationsOfMotion::kPerBody * links_[link].slot;
      y.add(first + 2, change(link));
      y.add(first + 5, change(width_ + link));
    }
  }

  /// Computes the other coordinates from the angles.
  void forward_kinematics(double time, Compensated& y);

  void rate(double time, std::span<const double> state, std::span<double> out) override;

 private:
  struct Link {
    int parent = -1;  // a link before it, or none
    std::size_t slot = 0;
    int body = 0, parent_body = kFixedFrame;  // the link's body, and the body it hangs on
    Vec2d anchor{}, parent_anchor{};          // of its hinge, in the frames of both
    bool can_rotate = true;
    double mass = 0, inertia = 0;  // inertia about its hinge, I + m c^2
    Vec2d moment{}, hinge{};       // m c, in its own frame; e of its own hinge, in its parent's
  };
  struct Sums {
    double xx = 0, xy = 0, yy = 0, j = 0;  // L and J
    Vec2d u{}, w{};
    double t = 0, spin = 0;  // T; w^2
    Vec2d e{};               // of its own hinge
  };
  bool find_links(const Scene& scene, const ScenePartition& partition);
  void eliminate();

  EquationsOfMotion& equations_;
  Vec2d gravity_;
  std::size_t width_ = 0;
  std::vector<Link> links_;  // parents first
  std::vector<Sums> sums_;
  std::vector<double> cosines_, sines_, state_;
  std::vector<Vec2d> acceleration_;  // of the hinges
};

}  // namespace plumb::precise
