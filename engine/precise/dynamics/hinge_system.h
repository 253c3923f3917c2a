#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/joints/joints.h"
#include "engine/linear_algebra/joint_system.h"
#include "engine/math/pose.h"

namespace plumb::precise {

/// Chains and trees of hinges, the most common mechanism, in one pass over the bodies: the work of
/// `Joints::rows` and `JointSystem`, without rows. A hinge's Jacobian follows from its arms r = R s,
///   C = x_b + r_b - x_a - r_a,   J v = v_b + w_b x r_b - v_a - w_a x r_a,
///   (dJ/dt) v = w_a^2 r_a - w_b^2 r_b,
/// so that A = J M^-1 J^T has blocks of 2 x 2: with p = (-r_y, r_x),
///   own:            (1/m_a + 1/m_b) I + p_a p_a^T / I_a + p_b p_b^T / I_b,
///   of a neighbour: +-(I / m + p p'^T / I) of the body that both share.
class HingeSystem {
 public:
  /// `order` is `JointSystem::hinges` of a system whose rows are those of `hinges` alone. Empty if `hinges`
  /// is.
  HingeSystem(std::span<const HingePlace> order, const std::vector<Revolute>& hinges,
              std::span<const double> inverse_mass, std::span<const double> inverse_inertia);

  bool empty() const { return nodes_.empty(); }

  /// Returns true if every body is connected by hinges, directly or through others, to something that joints
  /// do not move: the angles then determine all positions.
  bool is_rooted() const { return !steps_.empty(); }
  /// Sets positions and velocities of hanging bodies from the bodies that they hang on and from the angles,
  /// so that gaps are zero to rounding. The arms are those of the last `update`. Calls `moved(body)` for
  /// each.
  template <class Moved>
  void forward_kinematics(std::span<Pose<double>> poses, std::span<Twist<double>> twists,
                          const Moved& moved) const {
    for (const Step& step : steps_) {
      const Block& block = blocks_[step.node];
      const Node& node = nodes_[step.node];
      const int parent = step.b_is_child ? node.a : node.b, child = step.b_is_child ? node.b : node.a;
      const Vec2d parent_arm = step.b_is_child ? block.arm_a : block.arm_b,
                  own = step.b_is_child ? block.arm_b : block.arm_a;
      const Vec2d place = parent == kFixedFrame ? Vec2d{} : poses[parent].position;
      const Twist<double> motion = parent == kFixedFrame ? Twist<double>{} : twists[parent];
      Twist<double>& twist = twists[child];
      poses[child].position = place + (parent_arm - own);
      twist.velocity =
          motion.velocity + (cross(motion.angular_velocity, parent_arm) - cross(twist.angular_velocity, own));
      moved(static_cast<std::size_t>(child));
    }
  }

  /// Computes the arms and the blocks of A at `poses`, which are by body.
  void update(std::span<const Pose<double>> poses);

  /// The widest gap, m, at given poses, and its hinge.
  struct LargestGap {
    double gap = 0;
    int hinge = 0;
  };
  LargestGap largest_gap(std::span<const Pose<double>> poses) const;

  /// Adds M^-1 J^T lambda to the accelerations such that J a + (dJ/dt) v = 0, at the poses of `update`. Call
  /// it once for each `update`.
  void add_accelerations(std::span<const Twist<double>> twists, std::span<Twist<double>> accelerations);
  /// Adds to `shift` the M^-1 J^T lambda that makes J v zero.
  void stop_velocities(std::span<const Twist<double>> twists, std::span<Twist<double>> shift);
  /// Adds to `shift` the M^-1 J^T lambda that closes the gaps, to first order.
  void close_gaps(std::span<const Pose<double>> poses, std::span<Twist<double>> shift);

  /// Results of the last of these functions: the number of dependent directions, which get no force; and the
  /// least independent fraction of a direction, as in `JointSystem::min_pivot_ratio`.
  int dependent() const { return dependent_; }
  double min_pivot_ratio() const { return min_pivot_ratio_; }

 private:
  struct Node {
    int a = kFixedFrame, b = kFixedFrame, hinge = 0;
    int next = -1;                         // the one later hinge that shares a body
    bool side = false, next_side = false;  // true: the shared body is b of this hinge; of the next
    double mass_a = 0, mass_b = 0, inertia_a = 0, inertia_b = 0;  // inverse
    Vec2d anchor_a{}, anchor_b{};
    double shared_mass = 0, shared_inertia = 0;  // inverses of the shared body, signed as in A
  };
  /// A hinge during elimination: the inverse of its own block, and its effect on its neighbour.
  struct Block {
    Vec2d arm_a{}, arm_b{};
    double xx = 0, xy = 0, yy = 0;  // of A; then reduced by earlier hinges
    double own_x = 0, own_y = 0;
    double x = 0, y = 0;  // right side; then reduced; then multipliers
    double w00 = 0, w01 = 0, w10 = 0,
           w11 = 0;  // the coupling block to the next hinge, times the inverse of this one's
  };
  struct Inverse {
    double xx = 0, xy = 0, yy = 0;
  };

  /// One body that hangs on an earlier one.
  struct Step {
    std::size_t node = 0;
    bool b_is_child = false;
  };
  void order_from_root();

  Vec2d gap(std::size_t k, std::span<const Pose<double>> poses) const;
  Inverse inverse(const Block& block);
  Inverse singular_inverse(const Block& block);
  void reorder_from_both_ends();
  void eliminate();
  void solve(std::span<Twist<double>> motion);

  std::vector<Node> nodes_;  // in the order of elimination
  std::vector<Step> steps_;  // from the root on; empty without a root
  std::vector<Block> blocks_;
  double min_pivot_ratio_ = 1;
  int dependent_ = 0;
};

}  // namespace plumb::precise
