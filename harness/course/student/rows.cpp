#include "harness/course/student/world.h"

// The formulas that contacts, friction and joints share, with the edits of edit.h.
namespace plumb::course {

StudentWorld::Eases StudentWorld::eases(Row row, Place place, const Rigid& a, const Rigid& b) const {
  const std::array<double, 2> mass{a.inverse_mass, b.inverse_mass},
      inertia{a.inverse_inertia, b.inverse_inertia};
  // Learners treat bodies that cannot rotate separately, whatever replaces the inverse inertia of others.
  const auto if_turns = [&](std::size_t i) { return inertia[i] > 0 ? mass[i] : 0; };
  return {edit_(Quantity::InverseMass, row, place, mass, inertia),
          edit_(Quantity::InverseInertia, row, place, inertia, {if_turns(0), if_turns(1)})};
}

StudentWorld::Moving StudentWorld::moving(Row row, const Rigid& a, const Rigid& b) const {
  const bool both = edit_.quantity == Quantity::PointVelocity;
  return {
      edit_(both ? edit_.quantity : Quantity::Velocity, row, kInSpeed, std::array{a.velocity, b.velocity}),
      edit_(both ? edit_.quantity : Quantity::Spin, row, kInSpeed, std::array{a.spin, b.spin})};
}

// Returns the speed along n at which the point of b leaves that of a.
double StudentWorld::speed_apart(Row row, const Rigid& a, const Rigid& b, Arms arms, Arms raw,
                                 Vec2d n) const {
  const auto [v, w] = moving(row, a, b);
  const auto r = edit_(Quantity::Arm, row, kInSpeed, std::array{arms.a, arms.b}, {raw.a, raw.b});
  const Vec2d turn = mixed("w x r", cross(w[1], r[1])) - mixed("w x r", cross(w[0], r[0]));
  double share = times("w x r");
  if (row == kFrictionRow && is("point_velocity_flipped")) share = -1;
  if (row == kFrictionRow && is("spin_not_in_velocity")) share = 0;
  const Vec2d parting = v[1] - v[0] + share * turn;
  return dot(row == kJointRow ? mixed("velocity in a joint", parting) : parting, n);
}

// Returns the inverse effective mass along n.
double StudentWorld::edited_mass(Row row, const Rigid& a, const Rigid& b, Arms arms, Arms raw,
                                 Vec2d n) const {
  const auto [mass, inertia] = eases(row, kInMass, a, b);
  const auto r = edit_(Quantity::Arm, row, kInMass, std::array{arms.a, arms.b}, {raw.a, raw.b});
  const double sa = cross(r[0], n), sb = cross(r[1], n);
  if (row == kJointRow && is("joint_without_rotation")) return mass[0] + mass[1];
  return mass[0] + mass[1] +
         times("rotation in an effective mass") * (inertia[0] * sa * sa + inertia[1] * sb * sb);
}

// Gives b an impulse at its arm, and a the opposite one.
void StudentWorld::change(Row row, Rigid& a, Rigid& b, Arms arms, Arms raw, Vec2d impulse) {
  const auto [mass, inertia] = eases(row, kInChange, a, b);
  const auto r = edit_(Quantity::Arm, row, kInChange, std::array{arms.a, arms.b}, {raw.a, raw.b});
  const double turn = times("spin by an impulse");
  a.velocity -= mass[0] * impulse;
  a.spin -= turn * inertia[0] * cross(r[0], impulse);
  b.velocity += mass[1] * impulse;
  b.spin += turn * inertia[1] * cross(r[1], impulse);
}

}  // namespace plumb::course
