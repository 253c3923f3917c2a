#include "engine/precise/dynamics/joints.h"

#include <cmath>
#include <type_traits>

#include "engine/precise/dynamics/joint_coordinates.h"

namespace plumb::precise {

namespace {

Vec2<Dual> moving(Vec2d value, Vec2d change) { return {{value.x, change.x}, {value.y, change.y}}; }

Rotation<Dual> turning(Rotation<double> q, double change) {
  return {{q.c, -q.s * change}, {q.s, q.c * change}};
}

}  // namespace

GeneralJoints::JointMotion GeneralJoints::ends_of(const Entry& e, const BodiesView& now,
                                                  const Directions& along) {
  const auto pose_of = [&](int body) { return body == kFixedFrame ? Pose<double>{} : now.poses[body]; };
  const auto twist_of = [&](int body) { return body == kFixedFrame ? Twist<double>{} : now.twists[body]; };
  const auto angle_of_body = [&](int body) { return body == kFixedFrame ? 0.0 : now.angles[body]; };
  const Pose<double> a = pose_of(e.a), b = pose_of(e.b);
  const Twist<double> motion_a = twist_of(e.a), motion_b = twist_of(e.b);
  JointMotion ends;
  ends.pose.rotation_a = turning(a.rotation, along.pose_a.angular_velocity);
  ends.pose.rotation_b = turning(b.rotation, along.pose_b.angular_velocity);
  ends.velocity_a = moving(motion_a.velocity, along.motion_a.velocity);
  ends.velocity_b = moving(motion_b.velocity, along.motion_b.velocity);
  ends.spin_a = {motion_a.angular_velocity, along.motion_a.angular_velocity};
  ends.spin_b = {motion_b.angular_velocity, along.motion_b.angular_velocity};
  std::visit(
      [&](const auto& kind) {
        using Rows = std::remove_cvref_t<decltype(kind)>;
        if constexpr (Rows::kGrounded) {
          ends.pose.offset = moving(b.position - kind.ground_b, along.pose_b.velocity);
          ends.pose.offset_a = moving(a.position - kind.ground_a, along.pose_a.velocity);
        } else {
          ends.pose.offset = moving(b.position - a.position, along.pose_b.velocity - along.pose_a.velocity);
        }
        if constexpr (Rows::kAngle != AngleUse::None) {
          const double angle = angle_of_body(e.b) - e.ratio * angle_of_body(e.a) + e.angle_offset;
          ends.pose.angle = {angle, along.pose_b.angular_velocity - e.ratio * along.pose_a.angular_velocity};
        }
      },
      e.kind);
  return ends;
}

GeneralJoints::JointForces GeneralJoints::spring_forces(const Entry& e, const JointMotion& ends) {
  struct Visitor {
    const Entry& e;
    const JointMotion& ends;
    JointForces& forces;

    void row(const JointRow<Dual>& j, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      // A spring in the angle moves no centre of mass.
      const bool turns = !(length_squared(j.linear_b) > 0);
      const SpringConstants of = spring_constants(rule.spring, turns ? e.springs.angular : e.springs.axial);
      const Dual rate = dot(j.linear_a, ends.velocity_a) + j.angular_a * ends.spin_a +
                        dot(j.linear_b, ends.velocity_b) + j.angular_b * ends.spin_b;
      Dual force = -(of.stiffness * j.residual + of.damping * rate);
      if (force > rule.max_force) force = rule.max_force;
      if (force < -rule.max_force) force = -rule.max_force;
      forces.add(j, force);
    }

    void point(const AnchorPoint<Dual>& at, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      const SpringConstants of = spring_constants(rule.spring, e.springs.point);
      const Vec2<Dual> rate =
          (ends.velocity_b + cross(ends.spin_b, at.arm_b)) - (ends.velocity_a + cross(ends.spin_a, at.arm_a));
      Vec2<Dual> force = Dual(-of.stiffness) * at.gap + Dual(-of.damping) * rate;
      const Dual size = sqrt(length_squared(force));
      if (size > rule.max_force) force *= Dual(rule.max_force) / size;
      forces.add(at.plain_row({1, 0}), force.x);
      forces.add(at.plain_row({0, 1}), force.y);
    }
  };
  JointForces forces;
  for_each_coordinate(e, ends, Visitor{e, ends, forces});
  return forces;
}

GeneralJoints::JointForces GeneralJoints::row_forces(const Entry& e, const JointMotion& ends,
                                                     std::span<const double> multipliers) {
  JointForces forces;
  std::size_t next = e.first_row;
  const auto take = [&](const JointRow<Dual>& j) { forces.add(j, multipliers[next++]); };
  for_each_coordinate(e, ends, RigidRows{take});
  return forces;
}

namespace {

/// Converts to a row of the equations of motion, with derivatives along the motion itself.
Row<double> row_of(int a, int b, const JointRow<Dual>& j, double sign, const Twist<double>& motion_a,
                   const Twist<double>& motion_b) {
  const auto value = [&](Vec2<Dual> v) { return sign * Vec2d{v.x.value, v.y.value}; };
  const auto change = [](Vec2<Dual> v) { return Vec2d{v.x.change, v.y.change}; };
  const double bias =
      dot(change(j.linear_a), motion_a.velocity) + j.angular_a.change * motion_a.angular_velocity +
      dot(change(j.linear_b), motion_b.velocity) + j.angular_b.change * motion_b.angular_velocity;
  return {a,
          b,
          value(j.linear_a),
          value(j.linear_b),
          sign * j.angular_a.value,
          sign * j.angular_b.value,
          sign * j.residual.value,
          sign * bias};
}

Twist<double> twist_of(const BodiesView& now, int body) {
  return body == kFixedFrame ? Twist<double>{} : now.twists[body];
}

}  // namespace

void GeneralJoints::rows(const BodiesView& now, std::span<Row<double>> out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    const Twist<double> motion_a = twist_of(now, e.a), motion_b = twist_of(now, e.b);
    std::size_t next = e.first_row;
    const auto take = [&](const JointRow<Dual>& j) {
      out[next++] = row_of(e.a, e.b, j, 1, motion_a, motion_b);
    };
    for_each_coordinate(e, ends_of(e, now, {.pose_a = motion_a, .pose_b = motion_b}), RigidRows{take});
  }
}

void GeneralJoints::limit_motor_rows(const BodiesView& now, std::span<Row<double>> out) const {
  for (const Entry& e : entries_) {
    if (e.limit_motors == 0) continue;
    const Twist<double> motion_a = twist_of(now, e.a), motion_b = twist_of(now, e.b);
    std::size_t next = e.first_limit_motor;
    const auto take = [&](const JointRow<Dual>& j, const RowRule& rule) {
      out[next++] = row_of(e.a, e.b, j, rule.sign, motion_a, motion_b);
    };
    for_each_coordinate(e, ends_of(e, now, {.pose_a = motion_a, .pose_b = motion_b}), LimitMotorRows{take});
  }
}

void GeneralJoints::add_springs(const BodiesView& now, std::span<Wrench<double>> out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    const JointForces forces = spring_forces(e, ends_of(e, now, {}));
    const auto add = [&](int body, const Wrench<Dual>& w) {
      if (body == kFixedFrame) return;
      out[body].force += Vec2d{w.force.x.value, w.force.y.value};
      out[body].torque += w.torque.value;
    };
    add(e.a, forces.a);
    add(e.b, forces.b);
  }
}

void GeneralJoints::for_each_spring(
    const BodiesView& now, const std::function<void(const std::string&, Vec2d, double)>& take) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    const Wrench<Dual> w = spring_forces(e, ends_of(e, now, {})).b;
    take(e.name, {w.force.x.value, w.force.y.value}, w.torque.value);
  }
}

/// Adds the derivatives of the forces by the first `directions` of these: x, y and angle of a, then of b;
/// their velocities in the same order.
template <class Evaluate>
void GeneralJoints::add_blocks(const Entry& e, const BodiesView& now, int directions,
                               const Evaluate& evaluate, std::vector<ForceBlock>& out) {
  const int body[2] = {e.a, e.b};
  ForceBlock blocks[2][2];
  for (int k = 0; k < directions; ++k) {
    const int by = (k / 3) % 2, column = k % 3;
    Directions along;
    Twist<double>& unit =
        k < 6 ? (by == 0 ? along.pose_a : along.pose_b) : (by == 0 ? along.motion_a : along.motion_b);
    (column == 0 ? unit.velocity.x : column == 1 ? unit.velocity.y : unit.angular_velocity) = 1;
    const JointForces forces = evaluate(ends_of(e, now, along));
    const Wrench<Dual> wrench[2] = {forces.a, forces.b};
    for (int on = 0; on < 2; ++on) {
      auto& matrix = k < 6 ? blocks[on][by].position : blocks[on][by].velocity;
      matrix[0][column] = wrench[on].force.x.change;
      matrix[1][column] = wrench[on].force.y.change;
      matrix[2][column] = wrench[on].torque.change;
    }
  }
  for (int on = 0; on < 2; ++on) {
    for (int by = 0; by < 2; ++by) {
      if (body[on] == kFixedFrame || body[by] == kFixedFrame) continue;
      blocks[on][by].on = static_cast<std::size_t>(body[on]);
      blocks[on][by].by = static_cast<std::size_t>(body[by]);
      out.push_back(blocks[on][by]);
    }
  }
}

void GeneralJoints::add_spring_blocks(const BodiesView& now, std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    add_blocks(
        e, now, 12, [&](const JointMotion& ends) { return spring_forces(e, ends); }, out);
  }
}

void GeneralJoints::add_tension_blocks(const BodiesView& now, std::span<const double> multipliers,
                                       std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    add_blocks(
        e, now, 6, [&](const JointMotion& ends) { return row_forces(e, ends, multipliers); }, out);
  }
}

}  // namespace plumb::precise
