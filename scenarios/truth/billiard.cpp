#include "scenarios/truth/billiard.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "engine/scene/error.h"

namespace plumb::scenarios::truth {
namespace {

constexpr std::size_t kMostImpacts = 100'000;

struct Impact {
  Real delay = std::numeric_limits<Real>::infinity();
  std::size_t first = 0, second = 0;
};

/// Returns the time until the two touch; infinite if they miss. After an impact a pair separates; after a
/// plastic one rounding alone makes it approach, which does not count.
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

Impact next_impact(const std::vector<Disc>& discs) {
  Impact next;
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

std::vector<Motion> motions_of(const std::vector<Disc>& discs) {
  std::vector<Motion> motions;
  for (const Disc& disc : discs) motions.push_back(disc.motion);
  return motions;
}

}  // namespace

Billiard::Billiard(std::vector<Disc> discs, Real restitution, Real duration) {
  Real now = 0;
  flights_.push_back({now, motions_of(discs)});
  for (Impact next = next_impact(discs); now + next.delay < duration; next = next_impact(discs)) {
    if (impacts_.size() == kMostImpacts)
      throw Error(Error::Kind::Run, "billiard", "impacts", std::to_string(kMostImpacts),
                  "there is no end to them before " + std::to_string(static_cast<double>(duration)) + " s");
    now += next.delay;
    for (Disc& disc : discs) disc.motion = coast(disc.motion, next.delay);
    collide(discs[next.first], discs[next.second], restitution);
    flights_.push_back({now, motions_of(discs)});
    impacts_.push_back(static_cast<double>(now));
  }
}

std::vector<Motion> Billiard::at(Real time) const {
  const auto later = std::ranges::upper_bound(flights_, time, {}, &Flight::start);
  const Flight& flight = later == flights_.begin() ? *later : *std::prev(later);
  std::vector<Motion> motions = flight.motions;
  for (Motion& motion : motions) motion = coast(motion, time - flight.start);
  return motions;
}

Truth billiard_truth(const Scene& scene, double duration) {
  std::vector<Disc> discs;
  for (const Body& body : scene.bodies)
    discs.push_back({body.mass, std::get<Circle>(body.shapes.front().geometry).radius, motion_of(body)});
  const Real restitution = scene.bodies.front().shapes.front().restitution;
  const auto billiard = std::make_shared<const Billiard>(std::move(discs), restitution, duration);
  return {.source = "conservation of momentum and Newton's restitution, pair by pair, normal at the contact",
          .exact =
              [billiard](double time, std::span<BodyState> out) {
                std::ranges::transform(billiard->at(time), out.begin(), rounded);
              },
          .impacts = billiard->impacts()};
}

}  // namespace plumb::scenarios::truth
