#include "scenarios/truth/billiard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "engine/scene/error.h"
#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {

// After an impact a pair separates. After a plastic impact, an approach velocity is only rounding, and does
// not count.
Real time_to_touch(const Disc& first, const Disc& second) {
  constexpr Real kNever = std::numeric_limits<Real>::infinity();
  const Vec2<Real> d = second.motion.position - first.motion.position;
  const Vec2<Real> u = second.motion.velocity - first.motion.velocity;
  const Real reach = first.radius + second.radius;
  const Real approach = -dot(d, u), speed_squared = length_squared(u);
  if (approach <= 0) return kNever;
  // b is the miss distance times |u|.
  const Real b = cross(d, u), discriminant = reach * reach * speed_squared - b * b;
  if (discriminant <= 0) return kNever;
  if (approach <= 1e-15L * std::sqrt(length_squared(d) * speed_squared)) return kNever;
  // The earlier root of |u|^2 t^2 - 2 (approach) t + |d|^2 - reach^2 = 0, in the form without cancellation.
  const Real gap = length_squared(d) - reach * reach;
  return std::max<Real>(0, gap / (approach + std::sqrt(discriminant)));
}

namespace {

constexpr std::size_t kMostImpacts = 100'000;

struct Impact {
  Real delay = std::numeric_limits<Real>::infinity();
  std::size_t first = 0, second = 0;
  const Wall* wall = nullptr;  // in place of the second disc
};

/// Returns the time until a disc touches a wall: the first root of gap + rate t + half t^2 at which it
/// approaches, in the form without cancellation.
Real time_to_touch(const Disc& disc, const Wall& wall, Vec2<Real> gravity) {
  constexpr Real kNever = std::numeric_limits<Real>::infinity();
  const Real gap = std::max<Real>(0, dot(disc.motion.position - wall.point, wall.normal) - disc.radius);
  const Real rate = dot(disc.motion.velocity, wall.normal), half = dot(gravity, wall.normal) / 2;
  const Real discriminant = rate * rate - 4 * half * gap;
  if (discriminant < 0 || (rate >= 0 && half >= 0)) return kNever;
  const Real root = std::sqrt(discriminant);
  return rate < 0 ? 2 * gap / (root - rate) : (rate + root) / (-2 * half);
}

Impact next_impact(const std::vector<Disc>& discs, const Table& table) {
  Impact next;
  for (std::size_t i = 0; i < discs.size(); ++i)
    for (const Wall& wall : table.walls)
      if (const Real delay = time_to_touch(discs[i], wall, table.gravity); delay < next.delay)
        next = {delay, i, i, &wall};
  for (std::size_t i = 0; i < discs.size(); ++i)
    for (std::size_t j = i + 1; j < discs.size(); ++j)
      if (const Real delay = time_to_touch(discs[i], discs[j]); delay < next.delay) next = {delay, i, j};
  return next;
}

void collide(Disc& first, Disc& second, Real restitution) {
  const Vec2<Real> d = second.motion.position - first.motion.position;
  const Vec2<Real> normal = 1 / std::sqrt(length_squared(d)) * d;
  const Real closing = dot(normal, first.motion.velocity - second.motion.velocity);
  const Real impulse = (1 + restitution) * closing / (1 / first.mass + 1 / second.mass);
  first.motion.velocity -= impulse / first.mass * normal;
  second.motion.velocity += impulse / second.mass * normal;
}

void reflect(Disc& disc, const Wall& wall, Real restitution) {
  disc.motion.velocity -= (1 + restitution) * dot(disc.motion.velocity, wall.normal) * wall.normal;
}

std::vector<Motion> motions_of(const std::vector<Disc>& discs) {
  std::vector<Motion> motions;
  for (const Disc& disc : discs) motions.push_back(disc.motion);
  return motions;
}

}  // namespace

Billiard::Billiard(std::vector<Disc> discs, Real restitution, Real duration, Table table)
    : gravity_(table.gravity) {
  Real now = 0;
  flights_.push_back({now, motions_of(discs)});
  for (Impact next = next_impact(discs, table); now + next.delay < duration;
       next = next_impact(discs, table)) {
    if (impacts_.size() == kMostImpacts)
      throw Error(Error::Kind::Run, "billiard", "impacts", std::to_string(kMostImpacts),
                  "there is no end to them before " + std::to_string(static_cast<double>(duration)) + " s");
    now += next.delay;
    for (Disc& disc : discs) disc.motion = coast(disc.motion, next.delay, {gravity_});
    if (next.wall)
      reflect(discs[next.first], *next.wall, restitution);
    else
      collide(discs[next.first], discs[next.second], restitution);
    flights_.push_back({now, motions_of(discs)});
    impacts_.push_back(static_cast<double>(now));
  }
}

std::vector<Motion> Billiard::at(Real time) const {
  const auto later = std::ranges::upper_bound(flights_, time, {}, &Flight::start);
  const Flight& flight = later == flights_.begin() ? *later : *std::prev(later);
  std::vector<Motion> motions = flight.motions;
  for (Motion& motion : motions) motion = coast(motion, time - flight.start, {gravity_});
  return motions;
}

Truth billiard_truth(const Scene& scene, double duration, std::vector<Wall> walls) {
  std::vector<Disc> discs;
  Real restitution = 0;
  for (const Body& body : scene.bodies) {
    if (body.type != BodyType::Dynamic) continue;
    const Shape& shape = body.shapes.front();
    discs.push_back({body.mass, std::get<Circle>(shape.geometry).radius, motion_of(body)});
    restitution = shape.restitution;
  }
  const auto billiard = std::make_shared<const Billiard>(std::move(discs), restitution, duration,
                                                         Table{scene.gravity.as<Real>(), std::move(walls)});
  return follow(
      scene, "conservation of momentum and Newton's restitution, pair by pair, normal at the contact",
      [billiard](Real time, Moving moving) { std::ranges::copy(billiard->at(time), moving.begin()); },
      billiard->impacts());
}

}  // namespace plumb::scenarios::truth
