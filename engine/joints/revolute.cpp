#include "engine/joints/joints.h"

namespace plumb {

// C = (x_b + R_b s_b) - (x_a + R_a s_a), r = R s.   dC/dt = v_b + w_b z x r_b - v_a - w_a z x r_a.
// (dJ/dt) v = -w_b^2 r_b + w_a^2 r_a: the centripetal accelerations of the anchors.
template <class Real>
void Revolute<Real>::rows(const Pose<Real>& pose_a, const Pose<Real>& pose_b, const Twist<Real>& twist_a,
                          const Twist<Real>& twist_b, Row<Real>* out) const {
  const Vec2<Real> arm_a = pose_a.rotation * anchor_a;
  const Vec2<Real> arm_b = pose_b.rotation * anchor_b;
  const Vec2<Real> gap = (pose_b.position - pose_a.position) + (arm_b - arm_a);
  const Real spin_a = twist_a.angular_velocity * twist_a.angular_velocity;
  const Real spin_b = twist_b.angular_velocity * twist_b.angular_velocity;
  const Vec2<Real> bias = spin_a * arm_a - spin_b * arm_b;
  out[0] = {a, b, {-1, 0}, {1, 0}, arm_a.y, -arm_b.y, gap.x, bias.x};
  out[1] = {a, b, {0, -1}, {0, 1}, -arm_a.x, arm_b.x, gap.y, bias.y};
}

template struct Revolute<float>;
template struct Revolute<double>;

}  // namespace plumb
