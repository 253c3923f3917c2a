#pragma once

#include <vector>

#include "engine/joints/joints.h"
#include "engine/realtime/joint_method.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Sequential impulses with warm starting (Catto 2006), row by row. Rows are soft while they hold positions
/// (a damped spring as fast as the substep allows, Catto 2011), and rigid while they relax.
template <class Real>
class IterativeJoints final : public JointMethod<Real> {
 public:
  IterativeJoints(const Scene& scene, const Bodies<Real>& bodies);

  void begin_substep(const Bodies<Real>&, Real) override {}
  void begin_hold(Bodies<Real>& bodies, Real h) override;
  void sweep_hold(Bodies<Real>& bodies, Real h) override;
  void finish_hold(Bodies<Real>&, Real) override {}
  void settle(Bodies<Real>&) override {}  // left to the springs of the next substep
  void begin_relax(Bodies<Real>& bodies) override;
  void sweep_relax(Bodies<Real>& bodies) override;
  void begin_follow(Bodies<Real>& bodies, Real h) override;
  void sweep_follow(Bodies<Real>& bodies) override;
  bool passes_on(int) const override { return false; }
  void pass_on(const Bodies<Real>&, std::span<Twist<Real>>) override {}
  void forget() override;
  std::span<Real> memory() override { return impulses_; }

 private:
  /// Softness of a row: P -= m scale (J v + rate C) + leak P.
  struct Spring {
    Real rate = 0;  ///< 1/s
    Real scale = 1;
    Real leak = 0;
  };

  void place(const Bodies<Real>& bodies);
  void warm_start(Bodies<Real>& bodies, std::span<const Real> impulses);
  void sweep(Bodies<Real>& bodies, const Spring& spring, std::span<Real> impulses);
  std::span<Real> hold_impulses() { return {impulses_.data(), rows_.size()}; }
  std::span<Real> relax_impulses() { return {impulses_.data() + rows_.size(), rows_.size()}; }

  Joints<Real> joints_;
  std::vector<Row<Real>> rows_;
  std::vector<Real> mass_;      // kg, 1 / (J M^-1 J^T) by row
  std::vector<Real> impulses_;  // N s, of the hold passes by row, then of the relax passes
  Spring spring_;
};

}  // namespace plumb
