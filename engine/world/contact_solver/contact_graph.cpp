#include "engine/world/contact_solver/contact_graph.h"

#include <algorithm>
#include <cassert>

namespace plumb {
namespace {

// Returns true if a dynamic body of the constraint already has one in this colour.
bool is_taken(const BitSet& bodies, int a, bool is_dynamic_a, int b, bool is_dynamic_b) {
  return (is_dynamic_a && bodies.test(a)) || (is_dynamic_b && bodies.test(b));
}

}  // namespace

template <class Real>
auto ContactGraph<Real>::add(const ContactConstraint<Real>& constraint, bool is_dynamic_a, bool is_dynamic_b)
    -> Place {
  const int a = constraint.body_a, b = constraint.body_b;
  assert(a >= 0 && b >= 0 && a != b && (is_dynamic_a || is_dynamic_b));
  const bool both = is_dynamic_a && is_dynamic_b;
  int chosen = kOverflow;
  // Contacts with static or kinematic bodies try their own colours first and then, from the back, the others.
  for (int i = 0; i < (both ? kDynamicColours : kColours); ++i) {
    const int c = both ? i : kColours - 1 - i;
    if (is_taken(bodies_[c], a, is_dynamic_a, b, is_dynamic_b)) continue;
    chosen = c;
    break;
  }
  // Allocate first, so that a failure changes nothing.
  if (chosen != kOverflow)
    bodies_[chosen].reserve(std::max(is_dynamic_a ? a + 1 : 0, is_dynamic_b ? b + 1 : 0));
  colours_[chosen].push_back(constraint);
  if (chosen != kOverflow) {
    if (is_dynamic_a) bodies_[chosen].set(a);
    if (is_dynamic_b) bodies_[chosen].set(b);
  }
  if (colours_[chosen].size() == 1) update_used();
  return {chosen, static_cast<int>(colours_[chosen].size()) - 1};
}

template <class Real>
int ContactGraph<Real>::remove(Place place, bool is_dynamic_a, bool is_dynamic_b) {
  std::vector<ContactConstraint<Real>>& colour = colours_[place.colour];
  assert(place.index >= 0 && place.index < static_cast<int>(colour.size()));
  const ContactConstraint<Real>& gone = colour[place.index];
  assert(place.colour == kOverflow || ((!is_dynamic_a || bodies_[place.colour].test(gone.body_a)) &&
                                       (!is_dynamic_b || bodies_[place.colour].test(gone.body_b))));
  if (place.colour != kOverflow) {
    if (is_dynamic_a) bodies_[place.colour].reset(gone.body_a);
    if (is_dynamic_b) bodies_[place.colour].reset(gone.body_b);
  }
  const bool last = place.index + 1 == static_cast<int>(colour.size());
  if (!last) colour[place.index] = colour.back();
  colour.pop_back();
  if (colour.empty()) update_used();
  return last ? -1 : colour[place.index].contact;
}

template <class Real>
void ContactGraph<Real>::update_used() {
  used_count_ = 0;
  for (int i = 0; i <= kColours; ++i) {
    if (!colours_[order(i)].empty()) used_[used_count_++] = order(i);
  }
}

template <class Real>
std::size_t ContactGraph<Real>::size() const {
  std::size_t count = 0;
  for (const auto& colour : colours_) count += colour.size();
  return count;
}

template class ContactGraph<float>;
template class ContactGraph<double>;

}  // namespace plumb
