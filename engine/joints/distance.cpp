#include <cmath>

#include "engine/joints/joints.h"

namespace plumb {

// C = |d| - length, d from anchor a to anchor b, u = d / |d|.   dC/dt = u . dd/dt.
// (dJ/dt) v = u . (w_a^2 r_a - w_b^2 r_b) + (|dd/dt|^2 - (u . dd/dt)^2) / |d|: the anchors' centripetal
// accelerations along the rod, and that of the rod's own rotation.
template <class Real>
void Distance<Real>::rows(const Pose<Real>& pose_a, const Pose<Real>& pose_b, const Twist<Real>& twist_a,
                          const Twist<Real>& twist_b, Row<Real>* out) const {
  const Vec2<Real> arm_a = pose_a.rotation * anchor_a;
  const Vec2<Real> arm_b = pose_b.rotation * anchor_b;
  const Vec2<Real> d = (pose_b.position - pose_a.position) + (arm_b - arm_a);
  const Vec2<Real> rate = (twist_b.velocity - twist_a.velocity) +
                          (cross(twist_b.angular_velocity, arm_b) - cross(twist_a.angular_velocity, arm_a));
  const Real separation = std::sqrt(length_squared(d));
  // Coinciding anchors have no direction: any one separates them, and the rod's rotation is undefined.
  const bool apart = separation > 0;
  const Vec2<Real> u = apart ? (1 / separation) * d : Vec2<Real>{1, 0};
  const Real sideways = cross(u, rate);
  const Real turning = apart ? sideways * sideways / separation : 0;
  const Real spin_a = twist_a.angular_velocity * twist_a.angular_velocity;
  const Real spin_b = twist_b.angular_velocity * twist_b.angular_velocity;
  *out = {a,
          b,
          -u,
          u,
          -cross(arm_a, u),
          cross(arm_b, u),
          separation - length,
          dot(u, spin_a * arm_a - spin_b * arm_b) + turning};
}

template struct Distance<float>;
template struct Distance<double>;

}  // namespace plumb
