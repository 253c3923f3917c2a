#pragma once

#include <vector>

#include "engine/math/bit_set.h"
#include "engine/solve/contact_constraint.h"

namespace plumb {

/// The contact constraints of awake bodies, sorted into colours: no two of a colour share a dynamic body, so
/// that they may be solved in any order, side by side. Contacts with a body that does not give way have
/// colours of their own at the end: what is solved last holds best, and the ground should. The colouring is
/// greedy and persistent (a constraint keeps its colour); what finds none (contacts of a body that has many,
/// a drum or a wrecking ball, which holds the others) goes to the overflow right before those of the ground,
/// which is solved in order.
template <class Real>
class ContactGraph {
 public:
  static constexpr int kDynamicColours = 20, kColours = 24, kOverflow = 24;

  struct Place {
    int colour = -1, index = -1;
  };

  /// Takes `constraint` in. `gives_way_a/b`: whether that body is dynamic.
  Place add(const ContactConstraint<Real>& constraint, bool gives_way_a, bool gives_way_b);

  /// Takes the constraint out; the last of its colour moves to `place`, if there is one: its record is
  /// returned, else -1.
  int remove(Place place, bool gives_way_a, bool gives_way_b);

  ContactConstraint<Real>& at(Place place) { return colours_[place.colour][place.index]; }
  const ContactConstraint<Real>& at(Place place) const { return colours_[place.colour][place.index]; }

  /// `visit(constraint)` for all, in the order that they are solved in.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (int i = 0; i < used_count_; ++i) {
      for (ContactConstraint<Real>& constraint : colours_[used_[i]]) visit(constraint);
    }
  }

  std::vector<ContactConstraint<Real>>& colour(int c) { return colours_[c]; }
  const std::vector<ContactConstraint<Real>>& colour(int c) const { return colours_[c]; }
  static constexpr int order(int nth) {
    return nth < kDynamicColours ? nth : (nth == kDynamicColours ? kOverflow : nth - 1);
  }

  std::size_t size() const;
  bool empty() const { return used_count_ == 0; }

  /// To be called after constraints were put into the colours' lists directly: finds again which bodies each
  /// colour has, and which colours are in use. `gives_way(body)`: whether it is dynamic. False when two of a
  /// colour share a dynamic body.
  template <class GivesWay>
  bool find_bodies(GivesWay&& gives_way) {
    bool sound = true;
    for (int c = 0; c < kColours; ++c) {
      bodies_[c].clear();
      for (const ContactConstraint<Real>& constraint : colours_[c]) {
        for (const int body : {constraint.body_a, constraint.body_b}) {
          if (!gives_way(body)) continue;
          sound = sound && !bodies_[c].test(body);
          bodies_[c].set(body);
        }
      }
    }
    find_used();
    return sound;
  }

 private:
  void find_used();

  int used_[kColours + 1] = {};  // colours that are not empty, in their order
  int used_count_ = 0;
  std::vector<ContactConstraint<Real>> colours_[kColours + 1];
  BitSet bodies_[kColours];
};

}  // namespace plumb
