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

GeneralJoints::Ends GeneralJoints::ends_of(const Entry& e, const BodiesNow& now, const Directions& along) {
  const auto pose_of = [&](int body) { return body == kFixedFrame ? Pose<double>{} : now.poses[body]; };
  const auto twist_of = [&](int body) { return body == kFixedFrame ? Twist<double>{} : now.twists[body]; };
  const auto angle_of_body = [&](int body) { return body == kFixedFrame ? 0.0 : now.angles[body]; };
  const Pose<double> a = pose_of(e.a), b = pose_of(e.b);
  const Twist<double> motion_a = twist_of(e.a), motion_b = twist_of(e.b);
  Ends ends;
  ends.pose.rotation_a = turning(a.rotation, along.place_a.angular_velocity);
  ends.pose.rotation_b = turning(b.rotation, along.place_b.angular_velocity);
  ends.velocity_a = moving(motion_a.velocity, along.motion_a.velocity);
  ends.velocity_b = moving(motion_b.velocity, along.motion_b.velocity);
  ends.spin_a = {motion_a.angular_velocity, along.motion_a.angular_velocity};
  ends.spin_b = {motion_b.angular_velocity, along.motion_b.angular_velocity};
  std::visit(
      [&](const auto& kind) {
        using Rows = std::remove_cvref_t<decltype(kind)>;
        if constexpr (Rows::kGrounded) {
          ends.pose.offset = moving(b.position - kind.ground_b, along.place_b.velocity);
          ends.pose.offset_a = moving(a.position - kind.ground_a, along.place_a.velocity);
        } else {
          ends.pose.offset = moving(b.position - a.position, along.place_b.velocity - along.place_a.velocity);
        }
        if constexpr (Rows::kAngle != AngleUse::None) {
          const double angle = angle_of_body(e.b) - e.ratio * angle_of_body(e.a) + e.angle_offset;
          ends.pose.angle = {angle,
                             along.place_b.angular_velocity - e.ratio * along.place_a.angular_velocity};
        }
      },
      e.kind);
  return ends;
}

GeneralJoints::Pull GeneralJoints::pull_of_springs(const Entry& e, const Ends& ends) {
  struct Visitor {
    const Entry& e;
    const Ends& ends;
    Pull& pull;

    void row(const JointRow<Dual>& j, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      // A spring in the angle moves no centre of mass.
      const bool turns = !(length_squared(j.linear_b) > 0);
      const SpringConstants of = spring_constants(rule.spring, turns ? e.springs.turn : e.springs.axial);
      const Dual rate = dot(j.linear_a, ends.velocity_a) + j.angular_a * ends.spin_a +
                        dot(j.linear_b, ends.velocity_b) + j.angular_b * ends.spin_b;
      Dual force = -(of.stiffness * j.residual + of.damping * rate);
      if (force > rule.max_force) force = rule.max_force;
      if (force < -rule.max_force) force = -rule.max_force;
      pull.add(j, force);
    }

    void point(const AnchorPoint<Dual>& at, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      const SpringConstants of = spring_constants(rule.spring, e.springs.point);
      const Vec2<Dual> rate =
          (ends.velocity_b + cross(ends.spin_b, at.arm_b)) - (ends.velocity_a + cross(ends.spin_a, at.arm_a));
      Vec2<Dual> force = Dual(-of.stiffness) * at.gap + Dual(-of.damping) * rate;
      const Dual size = sqrt(length_squared(force));
      if (size > rule.max_force) force *= Dual(rule.max_force) / size;
      pull.add(at.plain_row({1, 0}), force.x);
      pull.add(at.plain_row({0, 1}), force.y);
    }
  };
  Pull pull;
  each_coordinate(e, ends, Visitor{e, ends, pull});
  return pull;
}

GeneralJoints::Pull GeneralJoints::pull_of_rows(const Entry& e, const Ends& ends,
                                                std::span<const double> multipliers) {
  Pull pull;
  std::size_t next = e.first_row;
  const auto take = [&](const JointRow<Dual>& j) { pull.add(j, multipliers[next++]); };
  each_coordinate(e, ends, RigidRows{take});
  return pull;
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

Twist<double> twist_of(const BodiesNow& now, int body) {
  return body == kFixedFrame ? Twist<double>{} : now.twists[body];
}

}  // namespace

void GeneralJoints::rows(const BodiesNow& now, std::span<Row<double>> out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    const Twist<double> motion_a = twist_of(now, e.a), motion_b = twist_of(now, e.b);
    std::size_t next = e.first_row;
    const auto take = [&](const JointRow<Dual>& j) {
      out[next++] = row_of(e.a, e.b, j, 1, motion_a, motion_b);
    };
    each_coordinate(e, ends_of(e, now, {.place_a = motion_a, .place_b = motion_b}), RigidRows{take});
  }
}

void GeneralJoints::stop_rows(const BodiesNow& now, std::span<Row<double>> out) const {
  for (const Entry& e : entries_) {
    if (e.stops == 0) continue;
    const Twist<double> motion_a = twist_of(now, e.a), motion_b = twist_of(now, e.b);
    std::size_t next = e.first_stop;
    const auto take = [&](const JointRow<Dual>& j, const RowRule& rule) {
      out[next++] = row_of(e.a, e.b, j, rule.sign, motion_a, motion_b);
    };
    each_coordinate(e, ends_of(e, now, {.place_a = motion_a, .place_b = motion_b}), StopRows{take});
  }
}

void GeneralJoints::add_springs(const BodiesNow& now, std::span<Wrench<double>> out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    const Pull pull = pull_of_springs(e, ends_of(e, now, {}));
    const auto add = [&](int body, const Wrench<Dual>& w) {
      if (body == kFixedFrame) return;
      out[body].force += Vec2d{w.force.x.value, w.force.y.value};
      out[body].torque += w.torque.value;
    };
    add(e.a, pull.a);
    add(e.b, pull.b);
  }
}

void GeneralJoints::each_spring(const BodiesNow& now,
                                const std::function<void(const std::string&, Vec2d, double)>& take) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    const Wrench<Dual> w = pull_of_springs(e, ends_of(e, now, {})).b;
    take(e.name, {w.force.x.value, w.force.y.value}, w.torque.value);
  }
}

/// Adds the derivatives of a pull by the first `directions` of these: x, y and angle of a, then of b; their
/// velocities in the same order.
template <class Evaluate>
void GeneralJoints::add_blocks(const Entry& e, const BodiesNow& now, int directions, const Evaluate& evaluate,
                               std::vector<ForceBlock>& out) {
  const int body[2] = {e.a, e.b};
  ForceBlock blocks[2][2];
  for (int k = 0; k < directions; ++k) {
    const int by = (k / 3) % 2, column = k % 3;
    Directions along;
    Twist<double>& unit =
        k < 6 ? (by == 0 ? along.place_a : along.place_b) : (by == 0 ? along.motion_a : along.motion_b);
    (column == 0 ? unit.velocity.x : column == 1 ? unit.velocity.y : unit.angular_velocity) = 1;
    const Pull pull = evaluate(ends_of(e, now, along));
    const Wrench<Dual> wrench[2] = {pull.a, pull.b};
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

void GeneralJoints::add_spring_blocks(const BodiesNow& now, std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    add_blocks(
        e, now, 12, [&](const Ends& ends) { return pull_of_springs(e, ends); }, out);
  }
}

void GeneralJoints::add_tension_blocks(const BodiesNow& now, std::span<const double> multipliers,
                                       std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    add_blocks(
        e, now, 6, [&](const Ends& ends) { return pull_of_rows(e, ends, multipliers); }, out);
  }
}

}  // namespace plumb::precise
