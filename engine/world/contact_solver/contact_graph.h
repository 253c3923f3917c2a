#pragma once

#include <vector>

#include "engine/core/bit_set.h"
#include "engine/world/contact_solver/contact_constraint.h"

namespace plumb {

/// Constraint graph: the contact constraints of awake bodies, grouped by graph colouring. No two of a colour
/// share a dynamic body, so they may be solved in any order, or in parallel. Contacts with a static or
/// kinematic body have their own colours at the end, because the constraints solved last are satisfied best.
/// The colouring is greedy and persistent: a constraint keeps its colour. Constraints without a colour (of a
/// body with many contacts, such as a drum or a wrecking ball) go to the overflow. It is solved in order,
/// right before the contacts with static and kinematic bodies.
template <class Real>
class ContactGraph {
 public:
  static constexpr int kDynamicColours = 20, kColours = 24, kOverflow = 24;

  struct Place {
    int colour = -1, index = -1;
  };

  /// Adds `constraint`. `is_dynamic_a/b`: that body is dynamic.
  Place add(const ContactConstraint<Real>& constraint, bool is_dynamic_a, bool is_dynamic_b);

  /// Removes the constraint and moves the last of its colour to `place`, if there is one. Returns the record
  /// of the moved constraint, else -1.
  int remove(Place place, bool is_dynamic_a, bool is_dynamic_b);

  ContactConstraint<Real>& at(Place place) { return colours_[place.colour][place.index]; }
  const ContactConstraint<Real>& at(Place place) const { return colours_[place.colour][place.index]; }

  /// Calls `visit(constraint)` for all, in the solver's order.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (int i = 0; i < used_count_; ++i) {
      for (ContactConstraint<Real>& constraint : colours_[used_[i]]) visit(constraint);
    }
  }

  /// Calls `visit(constraints, has_colour)` for each colour that is not empty, and for the overflow, in the
  /// same order.
  template <class Visit>
  void for_each_colour(Visit&& visit) {
    for (int i = 0; i < used_count_; ++i) visit(colours_[used_[i]], used_[i] != kOverflow);
  }

  std::vector<ContactConstraint<Real>>& colour(int c) { return colours_[c]; }
  const std::vector<ContactConstraint<Real>>& colour(int c) const { return colours_[c]; }
  static constexpr int order(int nth) {
    return nth < kDynamicColours ? nth : (nth == kDynamicColours ? kOverflow : nth - 1);
  }

  std::size_t size() const;
  bool empty() const { return used_count_ == 0; }

  /// Rebuilds each colour's set of bodies and the list of used colours, after constraints were written to the
  /// colours' lists directly. `is_dynamic(body)`: true if it is dynamic. Returns false if two constraints of
  /// a colour share a dynamic body.
  template <class IsDynamic>
  bool rebuild_bodies(IsDynamic&& is_dynamic) {
    bool sound = true;
    for (int c = 0; c < kColours; ++c) {
      bodies_[c].clear();
      for (const ContactConstraint<Real>& constraint : colours_[c]) {
        for (const int body : {constraint.body_a, constraint.body_b}) {
          if (!is_dynamic(body)) continue;
          sound = sound && !bodies_[c].test(body);
          bodies_[c].set(body);
        }
      }
    }
    update_used();
    return sound;
  }

 private:
  void update_used();

  int used_[kColours + 1] = {};  // colours that are not empty, ascending
  int used_count_ = 0;
  std::vector<ContactConstraint<Real>> colours_[kColours + 1];
  BitSet bodies_[kColours];
};

}  // namespace plumb
