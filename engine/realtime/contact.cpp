#include "engine/realtime/contact.h"

namespace plumb {
namespace {

template <class Real>
Manifold<Real> manifold_of(const Contact<Real>& contact, std::span<const SolidShape<Real>> shapes,
                           const Pose<Real>& pose_a, const Pose<Real>& pose_b, Real reach) {
  const SolidShape<Real>& a = shapes[first_of(contact.pair)];
  const SolidShape<Real>& b = shapes[second_of(contact.pair)];
  return collide(a, place(a, pose_a), b, place(b, pose_b), reach);
}

/// Stores the data for `follow`: the face in the reference body's frame, the points in the other's.
template <class Real>
void remember(Contact<Real>& contact, const Manifold<Real>& manifold, const Pose<Real>& pose_a,
              const Pose<Real>& pose_b) {
  contact.reference_is_b = manifold.reference_is_b;
  const Pose<Real>& reference = manifold.reference_is_b ? pose_b : pose_a;
  const Pose<Real>& incident = manifold.reference_is_b ? pose_a : pose_b;
  const Vec2<Real> out_of_face = manifold.reference_is_b ? -manifold.normal : manifold.normal;
  contact.local_normal = reference.rotation.inverse() * out_of_face;
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint<Real>& point = manifold.points[i];
    const Vec2<Real> on_face = manifold.reference_is_b ? point.on_b : point.on_a;
    const Vec2<Real> on_incident = manifold.reference_is_b ? point.on_a : point.on_b;
    contact.face_offset = dot(on_face - reference.position, out_of_face);
    contact.points[i].local = incident.rotation.inverse() * (on_incident - incident.position);
  }
}

}  // namespace

template <class Real>
void detect(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b, Real reach) {
  const Manifold<Real> manifold = manifold_of(contact, shapes, pose_a, pose_b, reach);
  const Contact<Real> before = contact;
  contact.normal = manifold.normal;
  contact.count = manifold.count;
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint<Real>& found = manifold.points[i];
    ContactPoint<Real>& point = contact.points[i];
    point = {};
    point.arm_a = found.on_a - pose_a.position;
    point.arm_b = found.on_b - pose_b.position;
    point.separation = found.separation;
    point.feature = found.feature;
    for (int j = 0; j < before.count; ++j) {
      if (before.points[j].feature != found.feature) continue;
      point.hold = before.points[j].hold;
      point.relax = before.points[j].relax;
    }
  }
  if (contact.two_boxes) remember(contact, manifold, pose_a, pose_b);
  contact.placed = true;
}

template <class Real>
void follow(Contact<Real>& contact, std::span<const SolidShape<Real>> shapes, const Pose<Real>& pose_a,
            const Pose<Real>& pose_b) {
  contact.placed = true;
  if (contact.count == 0) return;
  if (!contact.two_boxes) {
    const Manifold<Real> manifold = manifold_of(contact, shapes, pose_a, pose_b, Real{0});
    contact.normal = manifold.normal;
    contact.points[0].arm_a = manifold.points[0].on_a - pose_a.position;
    contact.points[0].arm_b = manifold.points[0].on_b - pose_b.position;
    contact.points[0].separation = manifold.points[0].separation;
    return;
  }
  const Pose<Real>& reference = contact.reference_is_b ? pose_b : pose_a;
  const Pose<Real>& incident = contact.reference_is_b ? pose_a : pose_b;
  const Vec2<Real> out_of_face = reference.rotation * contact.local_normal;
  const Vec2<Real> apart = incident.position - reference.position;
  contact.normal = contact.reference_is_b ? -out_of_face : out_of_face;
  for (int i = 0; i < contact.count; ++i) {
    ContactPoint<Real>& point = contact.points[i];
    const Vec2<Real> arm_incident = incident.rotation * point.local;
    const Vec2<Real> from_reference = apart + arm_incident;
    point.separation = dot(from_reference, out_of_face) - contact.face_offset;
    const Vec2<Real> arm_reference = from_reference - point.separation * out_of_face;
    point.arm_a = contact.reference_is_b ? arm_incident : arm_reference;
    point.arm_b = contact.reference_is_b ? arm_reference : arm_incident;
  }
}

template <class Real>
void weigh(Contact<Real>& contact) {
  const Vec2<Real> tangent = perpendicular(contact.normal);
  const auto effective = [&contact](const ContactPoint<Real>& point, Vec2<Real> direction) {
    const Real lever_a = cross(point.arm_a, direction), lever_b = cross(point.arm_b, direction);
    const Real inverse =
        (contact.inverse_mass_a + contact.inverse_mass_b) +
        (contact.inverse_inertia_a * lever_a * lever_a + contact.inverse_inertia_b * lever_b * lever_b);
    return inverse > 0 ? 1 / inverse : Real{0};
  };
  for (int i = 0; i < contact.count; ++i) {
    contact.points[i].normal_mass = effective(contact.points[i], contact.normal);
    contact.points[i].tangent_mass = effective(contact.points[i], tangent);
  }
}

#define PLUMB_INSTANTIATE(Real)                                                              \
  template void detect(Contact<Real>&, std::span<const SolidShape<Real>>, const Pose<Real>&, \
                       const Pose<Real>&, Real);                                             \
  template void follow(Contact<Real>&, std::span<const SolidShape<Real>>, const Pose<Real>&, \
                       const Pose<Real>&);                                                   \
  template void weigh(Contact<Real>&);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
