#include <cmath>

#include "engine/realtime/manifold.h"

namespace plumb {

template <class Real>
Manifold<Real> collide_circles(const SolidShape<Real>& a, const Placement<Real>& at_a,
                               const SolidShape<Real>& b, const Placement<Real>& at_b) {
  const Vec2<Real> between = at_b.center - at_a.center;
  const Real distance = std::sqrt(length_squared(between));
  Manifold<Real> out;
  // Coinciding centres give no direction: use up.
  out.normal = distance > 0 ? Vec2<Real>{between.x / distance, between.y / distance} : Vec2<Real>{0, 1};
  out.count = 1;
  out.points[0] = {at_a.center + a.radius * out.normal, at_b.center - b.radius * out.normal,
                   distance - (a.radius + b.radius), 0};
  return out;
}

template <class Real>
Manifold<Real> collide_box_circle(const SolidShape<Real>& a, const Placement<Real>& at_a,
                                  const SolidShape<Real>& b, const Placement<Real>& at_b) {
  const Vec2<Real> local = at_a.rotation.inverse() * (at_b.center - at_a.center);
  const Vec2<Real> nearest{std::fmin(std::fmax(local.x, -a.half.x), a.half.x),
                           std::fmin(std::fmax(local.y, -a.half.y), a.half.y)};
  const Vec2<Real> outward = local - nearest;
  const Real distance = std::sqrt(length_squared(outward));

  Vec2<Real> normal, on_box = nearest;
  Real gap = distance;
  if (distance > 0) {
    // On a face the direction is the face's own, without the rounding of a division.
    if (outward.x == 0) {
      normal = {0, outward.y > 0 ? Real{1} : Real{-1}};
    } else if (outward.y == 0) {
      normal = {outward.x > 0 ? Real{1} : Real{-1}, 0};
    } else {
      normal = {outward.x / distance, outward.y / distance};
    }
  } else {
    const Real depth_x = a.half.x - std::abs(local.x), depth_y = a.half.y - std::abs(local.y);
    if (depth_x < depth_y) {
      normal = {local.x < 0 ? Real{-1} : Real{1}, 0};
      on_box.x = normal.x * a.half.x;
      gap = -depth_x;
    } else {
      normal = {0, local.y < 0 ? Real{-1} : Real{1}};
      on_box.y = normal.y * a.half.y;
      gap = -depth_y;
    }
  }

  Manifold<Real> out;
  out.normal = at_a.rotation * normal;
  out.count = 1;
  out.points[0] = {at_a.center + at_a.rotation * on_box, at_b.center - b.radius * out.normal, gap - b.radius,
                   0};
  return out;
}

template <class Real>
Manifold<Real> collide(const SolidShape<Real>& a, const Placement<Real>& at_a, const SolidShape<Real>& b,
                       const Placement<Real>& at_b, Real reach) {
  if (a.kind == ShapeKind::Box && b.kind == ShapeKind::Box) return collide_boxes(a, at_a, b, at_b, reach);
  if (a.kind == ShapeKind::Circle && b.kind == ShapeKind::Circle) return collide_circles(a, at_a, b, at_b);
  if (a.kind == ShapeKind::Box) return collide_box_circle(a, at_a, b, at_b);
  Manifold<Real> out = collide_box_circle(b, at_b, a, at_a);
  out.normal = -out.normal;
  std::swap(out.points[0].on_a, out.points[0].on_b);
  return out;
}

#define PLUMB_INSTANTIATE(Real)                                                                             \
  template Manifold<Real> collide_circles(const SolidShape<Real>&, const Placement<Real>&,                  \
                                          const SolidShape<Real>&, const Placement<Real>&);                 \
  template Manifold<Real> collide_box_circle(const SolidShape<Real>&, const Placement<Real>&,               \
                                             const SolidShape<Real>&, const Placement<Real>&);              \
  template Manifold<Real> collide(const SolidShape<Real>&, const Placement<Real>&, const SolidShape<Real>&, \
                                  const Placement<Real>&, Real);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
