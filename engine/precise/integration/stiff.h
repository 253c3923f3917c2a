#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/forces/force_jacobian.h"
#include "engine/integrate/stiff_flow.h"
#include "engine/linear_algebra/banded_lu.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The equations of motion for an implicit method. With force derivatives K = dF/dq, D = dF/dv, a change of
/// the stages' accelerations x_i obeys
///     M x_i - sum_k (h^2 (A A)_ik K + h a_ik D) x_k - J^T mu_i = g_i,   J x_i = 0,
/// one banded system for all stages, bodies and rows. Neighbours in the mechanism are next to each other in
/// it, so its cost is linear in the length of a chain. K includes the geometric stiffness of joint forces,
/// whose lever arms turn; the curvature of the joints' paths is left to Newton's iterations.
class StiffMotion final : public StiffFlow {
 public:
  StiffMotion(const Scene& scene, const ScenePartition& partition, EquationsOfMotion& equations);

  void rate(double time, std::span<const double> y, std::span<double> out) override {
    equations_.rate(time, y, out);
  }
  void linearise(double time, std::span<const double> y) override;
  bool factor(Use use, std::span<const double> a, int stages, double h) override;
  void solve(Use use, std::span<double> x) override;

 private:
  struct System {
    int stages = 0;
    double h = 0;
    std::vector<double> a;
    BandedLu matrix;
    std::vector<double> right_side;
  };

  void add_tension();
  void find_order();
  bool order_is_known() const;
  void resize(System& system, int stages) const;
  ForceBlock& block(int on, int by);
  int slot_of(int body) const { return body == kFixedFrame ? -1 : slot_[body]; }

  EquationsOfMotion& equations_;
  ForceJacobian force_jacobian_;
  std::vector<int> slot_;                               // by body; -1: not integrated
  std::vector<double> inverse_mass_, inverse_inertia_;  // by slot
  std::vector<double> rate_;
  std::vector<Row<double>> rows_;
  std::vector<ForceBlock> blocks_;

  // Index of a body's or row's first unknown, for one stage.
  std::vector<std::size_t> body_offset_, row_offset_;
  std::vector<std::array<int, 2>> ordered_rows_, ordered_blocks_;  // structure for which the order was found
  std::array<System, 2> systems_;                                  // by Use
  std::vector<double> displacement_;                               // work space of `solve`
};

}  // namespace plumb::precise
