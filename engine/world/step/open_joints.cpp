#include "engine/world/step/open_joints.h"

#include <algorithm>
#include <variant>

#include "engine/collision/distance/ray_cast.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Gap from which a joint is open, as a fraction of the extent of its smaller body. Loads open joints by less
// than 0.01.
constexpr double kMinGap = 0.02;

// A joint's gap: from its anchor on body a to that on body b, m.
template <class Real>
struct JointGap {
  Vec2d anchor_a;
  Vec2<Real> gap;
};

// Returns true if a shape lies between the ends of a joint.
template <class Real>
bool lies_between(const WorldData<Real>& w, int shape, const JointGap<Real>& joint) {
  const int body = w.shapes[shape].body;
  const Rotation<Real> to_local = w.rotation[body].inverse();
  const Vec2<Real> a = to_local * (joint.anchor_a - w.position[body]).template as<Real>(),
                   gap = to_local * joint.gap;
  const Convex<Real> convex = w.convex(shape);
  return contains(convex, a) || contains(convex, a + gap) || ray_cast(convex, a, gap).hit;
}

// Lets the contacts of one of a joint's bodies with other dynamic bodies than its `partner` yield.
template <class Real>
void yield_contacts(WorldData<Real>& w, int body, int partner, const JointGap<Real>& joint) {
  if (!w.is_dynamic(body)) return;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    const bool is_a = (edge & 1) == 0;
    const int other = is_a ? contact.body_b : contact.body_a;
    if (other == partner || !w.is_dynamic(other)) return;
    if (contact.home == ContactHome::Graph) {
      ContactConstraint<Real>& c = constraint_of(w, contact);
      c.load_estimate[0] = c.load_estimate[1] = 0;
    }
    if (lies_between(w, is_a ? contact.shape_b : contact.shape_a, joint))
      w.disabled_pairs.insert(contact.shape_a, contact.shape_b);
  });
}

// Returns the extent of the smaller body, m; bodies without shapes have none.
template <class Real>
Real smaller_extent(const WorldData<Real>& w, int a, int b) {
  const Real extent_a = w.extents[a], extent_b = w.extents[b];
  return extent_a > 0 && extent_b > 0 ? std::min(extent_a, extent_b) : std::max(extent_a, extent_b);
}

template <class Real, class Kind>
void yield_to(WorldData<Real>& w, int a, int b, const Kind& joint) {
  const auto arm = [&](int body, Vec2d anchor) {
    return w.rotation[body] * (anchor.template as<Real>() - w.bodies[body].centre);
  };
  const Vec2<Real> arm_a = arm(a, joint.anchor_a);
  const Vec2<Real> gap =
      (w.position[b] - w.position[a]).template as<Real>() + (arm(b, joint.anchor_b) - arm_a);
  const Real least = Real(kMinGap) * smaller_extent(w, a, b);
  if (!(length_squared(gap) > least * least)) return;
  const JointGap<Real> open{w.position[a] + arm_a.template as<double>(), gap};
  yield_contacts(w, a, b, open), yield_contacts(w, b, a, open);
}

}  // namespace

template <class Real>
void yield_to_open_joints(WorldData<Real>& w) {
  if (!enabled(Switch::OpenJoints)) return;
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!joint.active) return;
    const JointKind& kind = w.joint_set.definition(joint.slot);
    if (const auto* hinge = std::get_if<RevoluteDefinition>(&kind)) {
      yield_to(w, joint.body_a, joint.body_b, *hinge);
    } else if (const auto* weld = std::get_if<WeldDefinition>(&kind)) {
      // A spring is meant to stretch.
      if (!weld->linear_spring) yield_to(w, joint.body_a, joint.body_b, *weld);
    }
  });
}

template void yield_to_open_joints(WorldData<float>&);
template void yield_to_open_joints(WorldData<double>&);

}  // namespace plumb
