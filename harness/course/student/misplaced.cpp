#include <cmath>

#include "harness/course/student/world.h"

// Makes the mistakes that any engine can make in several places: a wrongly rotated point, a corner used
// twice, a force that changes the wrong quantity.
namespace plumb::course {

// Returns the vector in the world, rotated in the way in which the mistake rotates the points of `what`.
Vec2d StudentWorld::turned(Name what, const Rigid& body, Vec2d local) const {
  const Rotation<double> q = body.rotation();
  const Vec2d right = q * local;
  if (what.hash != turned_hash_) return right;
  const auto how = [&](Name name) { return name.hash == turned_how_; };
  if (how("not")) return local;
  if (how("backwards")) return q.inverse() * local;
  if (how("by the first angle") && body.body != nullptr) {
    const double angle = body.turns * body.body->angle;
    return Rotation<double>{std::cos(angle), std::sin(angle)} * local;
  }
  if (how("overwriting x")) return {right.x, q.s * right.x + q.c * local.y};
  if (how("exchanging sin and cos")) return {q.s * local.x - q.c * local.y, q.c * local.x + q.s * local.y};
  if (how("without the minus")) return {q.c * local.x + q.s * local.y, q.s * local.x + q.c * local.y};
  return right;
}

// Returns the signs of a box's corners, in the order in which an engine visits them. With "corner 1 as 2",
// one of them occurs twice.
std::array<Vec2d, 4> StudentWorld::corner_signs() const {
  std::array<Vec2d, 4> out{Vec2d{-1, -1}, Vec2d{1, -1}, Vec2d{1, 1}, Vec2d{-1, 1}};
  constexpr std::string_view kText = "corner ";
  if (mistake_.starts_with(kText)) out.at(mistake_[7] - '0') = out.at(mistake_[12] - '0');
  return out;
}

// Returns the body whose quantity stands for that of `body`: the first or the last of its kind, by mistake.
// Kinds are circles and boxes; static bodies have no mass that could stand for another.
const Rigid& StudentWorld::another(Name quantity, const Rigid& body) const {
  if (quantity.hash != others_hash_ || body.body == nullptr) return body;
  const Rigid* out = nullptr;
  for (const Rigid& each : bodies_) {
    if (each.body == nullptr || each.body->type != body.body->type) continue;
    if (each.body->shapes[0].geometry.index() != body.body->shapes[0].geometry.index()) continue;
    if (out == nullptr || others_whose_ == Name("the last").hash) out = &each;
  }
  return out == nullptr ? body : *out;
}

// Adds a law's force to the body's sum, or lets it change the quantity that the mistake names.
void StudentWorld::act(Name law, Rigid& body, Vec2d force) {
  if (law.hash != acting_hash_) {
    body.force += force;
    return;
  }
  const auto how = [&](Name name) { return name.hash == acting_how_; };
  if (body.inverse_mass == 0) return;
  if (how("position by dt")) body.position += dt_ * force;
  if (how("position by dt/m")) body.position += dt_ * body.inverse_mass * force;
  if (how("position by dt^2/m")) body.position += dt_ * dt_ * body.inverse_mass * force;
  if (how("velocity")) body.velocity += force;
  if (how("velocity by 1/m")) body.velocity += body.inverse_mass * force;
}

}  // namespace plumb::course
