#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace plumb::reference {

/// A rigid massless rod between two anchors, which Bullet lacks. It is one row for Bullet's solver,
///     u . (v_a + w_a x r_a - v_b - w_b x r_b) = erp/h (|d| - length),
/// with d from anchor a to anchor b and u = d/|d|. The error reduction is that of btPoint2PointConstraint.
class BulletDistanceJoint final : public btTypedConstraint {
 public:
  BulletDistanceJoint(btRigidBody& a, btRigidBody& b, const btVector3& anchor_a, const btVector3& anchor_b,
                      btScalar length)
      : btTypedConstraint(POINT2POINT_CONSTRAINT_TYPE, a, b),
        anchor_a_(anchor_a),
        anchor_b_(anchor_b),
        length_(length) {}

  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = 1;
    info->nub = 1;
  }

  void getInfo2(btConstraintInfo2* info) override {
    const btTransform& pose_a = m_rbA.getCenterOfMassTransform();
    const btTransform& pose_b = m_rbB.getCenterOfMassTransform();
    const btVector3 arm_a = pose_a.getBasis() * anchor_a_;
    const btVector3 arm_b = pose_b.getBasis() * anchor_b_;
    const btVector3 between = pose_b.getOrigin() + arm_b - pose_a.getOrigin() - arm_a;
    const btScalar distance = between.length();
    const btVector3 direction = distance > 0 ? between / distance : btVector3(1, 0, 0);
    write(info->m_J1linearAxis, direction);
    write(info->m_J1angularAxis, arm_a.cross(direction));
    write(info->m_J2linearAxis, -direction);
    write(info->m_J2angularAxis, -arm_b.cross(direction));
    info->m_constraintError[0] = info->fps * info->erp * (distance - length_);
  }

  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

 private:
  static void write(btScalar* out, const btVector3& v) {
    out[0] = v.x();
    out[1] = v.y();
    out[2] = v.z();
  }

  btVector3 anchor_a_, anchor_b_;
  btScalar length_;
};

}  // namespace plumb::reference
