#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/flow.h"
#include "engine/simulation/precise_motion.h"

namespace plumb::precise {

/// Bodies that hang, hinge by hinge, on what stands, under gravity alone: their angles say where all is, and
/// are all that a step has to carry. The state is the angles of all links, then their angular velocities;
/// accelerations are those of the articulated-body method (Featherstone 1983), which eliminates from the tips
/// to the root.
///
/// With a the acceleration of the hinge that a link hangs on (against free fall), the force there is
/// L a + b; with c the way from that hinge to its centre of mass, e that to a child's hinge, x^ = (-x_y,
/// x_x):
///   J = I + m c^2 + sum e^ . L_k e^,      U = m c^ + sum L_k e^,      q_k = w^2 L_k e - b_k,
///   W = w^2 m c + sum q_k,                T = sum e^ . q_k,           (dw/dt) = (T - U . a) / J,
///   L = m + sum L_k - U U^T / J,          b = U T / J - W.
class HangingTree final : public Flow {
 public:
  /// Empty where anything else acts, where shapes may touch, and where it is not wanted.
  HangingTree(const Scene& scene, const Parts& parts, EquationsOfMotion& equations, bool wanted);

  bool empty() const { return links_.empty(); }
  /// Even, with zeros at the end of each half.
  std::size_t dimension() const { return 2 * width_; }
  std::size_t width() const { return width_; }  ///< of a half
  std::size_t size() const { return links_.size(); }
  std::size_t slot(std::size_t link) const { return links_[link].slot; }

  /// The angles and angular velocities in the state `y` of all coordinates.
  std::span<const double> taken_from(std::span<const double> y);
  /// Adds `change(i)` to each; `hang` is due then.
  template <class Change>
  void add(const Change& change, Compensated& y) const {
    for (std::size_t link = 0; link < links_.size(); ++link) {
      const std::size_t first = EquationsOfMotion::kPerBody * links_[link].slot;
      y.add(first + 2, change(link));
      y.add(first + 5, change(width_ + link));
    }
  }

  /// The other coordinates as the angles want them.
  void hang(double time, Compensated& y);

  void rate(double time, std::span<const double> state, std::span<double> out) override;

 private:
  struct Link {
    int parent = -1;  // a link before it, or none
    std::size_t slot = 0;
    int body = 0, holder = kFixedFrame;  // itself, and what it hangs on
    Vec2d anchor{}, holder_anchor{};     // of its hinge, in the frames of both
    bool turns = true;
    double mass = 0, inertia = 0;  // inertia about its hinge, I + m c^2
    Vec2d moment{}, hinge{};       // m c, in its own frame; e of its own hinge, in its parent's
  };
  struct Sums {
    double xx = 0, xy = 0, yy = 0, j = 0;  // L and J
    Vec2d u{}, w{};
    double t = 0, spin = 0;  // T; w^2
    Vec2d e{};               // of its own hinge
  };
  bool find_links(const Scene& scene, const Parts& parts);
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
