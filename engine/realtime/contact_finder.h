#pragma once

#include <vector>

#include "engine/realtime/contact.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Which pairs of a scene's shapes may touch at all: filters, bodies that cannot move, jointed pairs.
class PairRules {
 public:
  explicit PairRules(const Scene& scene);

  /// Shapes are numbered body by body.
  bool may_touch(int shape, int other) const;

  const Shape& shape(int index) const { return shapes_[index]; }
  int body_of(int shape) const { return body_of_[shape]; }
  int shape_count() const { return static_cast<int>(shapes_.size()); }
  bool dynamic(int body) const { return dynamic_[body] != 0; }
  double friction(int shape, int other) const;
  double restitution(int shape, int other) const;

 private:
  ContactRules rules_;
  std::vector<Shape> shapes_;
  std::vector<int> body_of_;
  std::vector<char> dynamic_;      // by body
  std::vector<PairKey> excluded_;  // pairs of bodies, sorted
};

/// Keeps the contacts of all pairs that are near each other, in the order of their shapes.
template <class Real>
class ContactFinder {
 public:
  ContactFinder(const Scene& scene, const Bodies<Real>& bodies);

  /// The pairs that may come near within `dt`. Returns whether contacts were added or dropped.
  bool find_pairs(const Bodies<Real>& bodies, Real dt, std::vector<Contact<Real>>& contacts);

  /// Finds the points of all contacts, for the coming `dt`.
  void find_points(const Bodies<Real>& bodies, Real dt, std::vector<Contact<Real>>& contacts) const;

  /// `body` moves otherwise than expected for the next `dt`: appends the contacts that this brings. Returns
  /// whether there are any.
  bool extend(int body, const Bodies<Real>& bodies, Real dt, std::vector<Contact<Real>>& contacts);

  /// Looks at `body` anew at the next search, whatever it is.
  void touch(int body) { touched_.push_back(body); }

  std::span<const SolidShape<Real>> shapes() const { return shapes_; }
  /// Returns the shapes' AABBs, from which the next search starts; empty before the first search.
  std::vector<Aabb<Real>> boxes() const;
  void put_boxes(std::span<const Aabb<Real>> boxes);

  /// A contact without points.
  Contact<Real> make_contact(PairKey pair, const Bodies<Real>& bodies) const;

 private:
  void place(int shape, const Bodies<Real>& bodies, Real dt);
  Real reach_of(const Contact<Real>& contact, const Bodies<Real>& bodies, Real dt) const;

  PairRules rules_;
  std::vector<SolidShape<Real>> shapes_;
  std::vector<int> first_shape_;  // of body i: first_shape_[i] .. first_shape_[i + 1]
  std::vector<char> moves_;       // by body
  BroadPhase<Real> broad_;
  std::vector<int> touched_;
  std::vector<PairKey> found_;
  std::vector<Contact<Real>> merged_;
};

}  // namespace plumb
