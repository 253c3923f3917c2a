#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/forces/force_jacobian.h"
#include "engine/forces/wrench.h"
#include "engine/joints/distance_joint.h"
#include "engine/joints/friction_joint.h"
#include "engine/joints/gear_joint.h"
#include "engine/joints/motor_joint.h"
#include "engine/joints/mouse_joint.h"
#include "engine/joints/prismatic_joint.h"
#include "engine/joints/pulley_joint.h"
#include "engine/joints/ratchet_joint.h"
#include "engine/joints/revolute_joint.h"
#include "engine/joints/row.h"
#include "engine/joints/spring_stiffness.h"
#include "engine/joints/weld_joint.h"
#include "engine/joints/wheel_joint.h"
#include "engine/math/dual.h"
#include "engine/scene/formula.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Poses and velocities of all bodies of the scene, by body.
struct BodiesView {
  std::span<const Pose<double>> poses;
  std::span<const double> angles;  ///< rad, whole turns counted
  std::span<const Twist<double>> twists;
};

/// General joints: those of a scene other than plain hinges and rods, with their rigid rows, and their
/// springs as forces. Residuals and Jacobians are those of engine/joints; their derivatives along a motion,
/// for accelerations and implicit methods, are computed by `Dual`.
class GeneralJoints {
 public:
  /// The scene is valid.
  explicit GeneralJoints(const Scene& scene);

  std::size_t row_count() const { return row_names_.size(); }
  /// Returns the joint's name by row.
  const std::vector<std::string>& row_names() const { return row_names_; }
  bool has_springs() const { return has_springs_; }

  /// Computes the rigid rows; `out` has `row_count` elements.
  void rows(const BodiesView& now, std::span<Row<double>> out) const;

  /// Unilateral rows: limits, C >= 0 with a force >= 0 along C, and motors, which drive dC/dt to a speed with
  /// a bounded force.
  struct LimitOrMotor {
    RowRole role = RowRole::Limit;
    double speed = 0, max_force = 0;
    std::optional<Formula> drive{};  ///< of a motor's speed, in place of `speed`
    std::string joint{};
    /// Meaning of C for a limit: an angle; the position of anchor b along a's axis; the distance of the
    /// anchors.
    enum class Kind { Angle, Translation, Distance };
    Kind kind = Kind::Angle;
    int a = kFixedFrame, b = kFixedFrame;
    Vec2d anchor_a{}, anchor_b{};  ///< m, from the centres of mass; a's only for distances
    /// Returns the motor's speed at `time`, s, and its rate.
    Jet speed_at(double time) const {
      const Jet now[] = {{time, 1}};
      return drive ? drive->at(std::span<const Jet>(now)) : Jet(speed);
    }
  };
  const std::vector<LimitOrMotor>& limits_and_motors() const { return limits_and_motors_; }
  /// Computes the rows of C; `out` has an element for each limit and motor.
  void limit_motor_rows(const BodiesView& now, std::span<Row<double>> out) const;

  /// Adds the forces of springs, N and N m. With J the row of a coordinate C,
  ///   lambda = -(k C + c J v),
  /// bounded if the joint has a bound; for a point the same along the gap. k and c are constants of the
  /// scene's initial poses (engine/joints/spring_stiffness.h).
  void add_springs(const BodiesView& now, std::span<Wrench<double>> out) const;

  /// Calls `take(joint, force, torque)` for each joint with such forces: force and torque on body b, about
  /// its centre.
  void for_each_spring(const BodiesView& now,
                       const std::function<void(const std::string&, Vec2d, double)>& take) const;

  /// Adds the derivatives of those forces by the bodies' positions and velocities.
  void add_spring_blocks(const BodiesView& now, std::vector<ForceBlock>& out) const;

  /// Adds the derivatives of J^T lambda of the rigid rows by the bodies' positions, for fixed multipliers.
  void add_tension_blocks(const BodiesView& now, std::span<const double> multipliers,
                          std::vector<ForceBlock>& out) const;

 private:
  using Kind = std::variant<DistanceRows<Dual>, RevoluteRows<Dual>, PrismaticRows<Dual>, WeldRows<Dual>,
                            SoftWeldRows<Dual>, WheelRows<Dual>, MotorRows<Dual>, MouseRows<Dual>,
                            GearRows<Dual>, PulleyRows<Dual>>;
  struct Entry {
    Kind kind{};
    JointRules rules{};
    int a = kFixedFrame, b = kFixedFrame;
    double mass_a = 0, mass_b = 0, inertia_a = 0, inertia_b = 0;  // inverse
    double ratio = 1, angle_offset = 0;  // the joint's angle: angle_b - ratio angle_a + offset, rad
    bool rigid_elsewhere = false;        // its rigid rows are among `Joints`
    bool has_springs = false;
    SpringMobility springs{};
    std::size_t first_row = 0, rows = 0;
    std::size_t first_limit_motor = 0, limit_motors = 0;
    std::string name{};
  };
  struct JointMotion;
  struct Directions;
  struct JointForces;

  static void add(const Scene& scene, const Joint& joint, std::vector<Entry>& entries);
  static void set_limit_anchors(const Entry& entry, bool moves, LimitOrMotor& limit_motor);
  static JointMotion ends_of(const Entry& entry, const BodiesView& now, const Directions& along);
  template <class Visit>
  static void for_each_coordinate(const Entry& entry, const JointMotion& ends, const Visit& visit);
  static JointForces spring_forces(const Entry& entry, const JointMotion& ends);
  static JointForces row_forces(const Entry& entry, const JointMotion& ends,
                                std::span<const double> multipliers);
  template <class Evaluate>
  static void add_blocks(const Entry& entry, const BodiesView& now, int directions, const Evaluate& evaluate,
                         std::vector<ForceBlock>& out);

  std::vector<Entry> entries_;
  std::vector<std::string> row_names_;
  std::vector<LimitOrMotor> limits_and_motors_;
  bool has_springs_ = false;
};

}  // namespace plumb::precise
