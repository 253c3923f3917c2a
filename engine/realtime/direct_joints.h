#pragma once

#include <vector>

#include "engine/joints/joints.h"
#include "engine/linear_algebra/joint_system.h"
#include "engine/realtime/joint_method.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Solves all joints together: RATTLE (Andersen 1983) on the sparse system A = J M^-1 J^T, factorised once
/// per substep. The factors of the velocity stage at x_{n+1} serve the position stage of the next substep.
template <class Real>
class DirectJoints final : public JointMethod<Real> {
 public:
  DirectJoints(const Scene& scene, const Bodies<Real>& bodies);

  void begin_substep(const Bodies<Real>& bodies, Real h) override;
  void begin_hold(Bodies<Real>&, Real) override {}
  void sweep_hold(Bodies<Real>& bodies, Real h) override;
  void finish_hold(Bodies<Real>& bodies, Real h) override;
  void settle(Bodies<Real>& bodies) override;
  void begin_relax(Bodies<Real>& bodies) override;
  void sweep_relax(Bodies<Real>& bodies) override;
  void begin_follow(Bodies<Real>& bodies, Real h) override;
  void sweep_follow(Bodies<Real>& bodies) override;
  bool passes_on(int body) const override { return jointed_[body] != 0; }
  void pass_on(const Bodies<Real>& bodies, std::span<Twist<Real>> jump) override;
  void forget() override { factored_ = false; }
  std::span<Real> memory() override { return {}; }

 private:
  void factor(const Bodies<Real>& bodies);
  Real predict_gap(const Bodies<Real>& bodies, Real h);
  void correct(Bodies<Real>& bodies, Real h);
  void apply(const Bodies<Real>& bodies, std::span<Twist<Real>> twists, Real sign) const;
  void project(const Bodies<Real>& bodies, std::span<Twist<Real>> twists);

  Joints<Real> joints_;
  std::vector<Row<Real>> rows_;   // at the last factorisation's poses
  std::vector<Row<Real>> ahead_;  // at the predicted poses
  std::vector<Real> kept_gap_;    // m, gap that the present pass leaves open
  std::vector<Real> feedback_;    // m/s, of the Euler steppers
  std::vector<Real> right_side_, multiplier_;
  std::vector<Pose<Real>> arrival_;
  std::vector<int> moving_;    // jointed bodies, in order
  std::vector<char> jointed_;  // by body
  std::vector<Real> span_;     // m, by row: the joint's length scale
  JointSystem<Real> system_;
  bool factored_ = false;
};

}  // namespace plumb
