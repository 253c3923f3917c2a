#include <cmath>

#include "engine/realtime/constants.h"
#include "engine/realtime/contact_solver.h"

namespace plumb {

// The separation of curved shapes is convex in time, so Newton steps from the left never pass the first root.
template <class Real>
Real time_of_contact(Contact<Real>& contact, int index, std::span<const SolidShape<Real>> shapes,
                     const Bodies<Real>& bodies, Real from, Real h) {
  const Real never = 2 * h;
  const ContactPoint<Real>& point = contact.points[index];
  Real t = from;
  for (int iteration = 0; iteration < constants::kTimeIterations; ++iteration) {
    follow(contact, shapes, pose_after(bodies, contact.a, t, h), pose_after(bodies, contact.b, t, h));
    const Vec2<Real> relative =
        relative_velocity(point, twist_after(bodies, contact.a, t, h), twist_after(bodies, contact.b, t, h));
    const Real speed = dot(relative, contact.normal);
    if (!(speed < 0)) return never;
    const Real next = std::fmax(from, t - point.separation / speed);
    if (next > h) return never;
    if (std::abs(next - t) <= h * std::numeric_limits<Real>::epsilon()) return next;
    t = next;
  }
  return t;
}

template float time_of_contact(Contact<float>&, int, std::span<const SolidShape<float>>, const Bodies<float>&,
                               float, float);
template double time_of_contact(Contact<double>&, int, std::span<const SolidShape<double>>,
                                const Bodies<double>&, double, double);

}  // namespace plumb
