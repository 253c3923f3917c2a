#include "harness/impacts.h"
#include "harness/magnitude.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::harness {
namespace {

struct Moment {
  std::vector<BodyState> before, after;
};

bool jumps(const Moment& moment, std::size_t body) {
  const BodyState &a = moment.before[body], &b = moment.after[body];
  // Within the margin, forces change the velocity by far less than this fraction of the speed.
  const double speed = magnitude(a.velocity) + magnitude(b.velocity) + 1e-3;
  const double spin = std::abs(a.angular_velocity) + std::abs(b.angular_velocity) + 1e-3;
  return magnitude(b.velocity - a.velocity) > 1e-6 * speed ||
         std::abs(b.angular_velocity - a.angular_velocity) > 1e-6 * spin;
}

// Returns the body with the nearest surface. Not all bodies that jump at the same time meet each other, and
// the partner may be too heavy for its own jump to be visible.
std::optional<std::size_t> partner_of(const Scene& scene, const Moment& moment, std::size_t body) {
  std::optional<std::size_t> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < scene.bodies.size(); ++j) {
    if (j == body || scene.bodies[j].shapes.empty()) continue;
    const double gap = magnitude(moment.before[j].position - moment.before[body].position) -
                       bounding_radius(scene.bodies[j]) - bounding_radius(scene.bodies[body]);
    if (gap < nearest) {
      nearest = gap;
      best = j;
    }
  }
  return best;
}

Jump jump_of(const Scene& scene, const Moment& moment, std::size_t body) {
  const BodyState &before = moment.before[body], &after = moment.after[body];
  const Vec2d change = after.velocity - before.velocity;
  Jump jump{.body = body, .partner = partner_of(scene, moment, body)};
  jump.velocity = change;
  jump.angular_velocity = std::abs(after.angular_velocity - before.angular_velocity);
  Vec2d relative = before.velocity;
  jump.distance = std::max(bounding_radius(scene.bodies[body]), 1e-9);
  if (jump.partner) {
    relative = relative - moment.before[*jump.partner].velocity;
    jump.distance = magnitude(moment.before[*jump.partner].position - before.position);
  }
  const double speed = magnitude(relative);
  if (magnitude(change) > 0) jump.normal = (1 / magnitude(change)) * change;
  jump.closing = std::max(std::abs(dot(relative, jump.normal)), 1e-9 * speed);
  jump.sliding = std::abs(cross(relative, jump.normal));
  return jump;
}

}  // namespace

double bounding_radius(const Body& body) {
  double radius = 0;
  for (const Shape& shape : body.shapes)
    radius = std::max(radius, magnitude(shape.position) + reach_of(shape.geometry));
  return radius;
}

std::vector<Impact> find_impacts(const scenarios::Problem& problem) {
  std::vector<Impact> impacts;
  if (!problem.truth.exact) return impacts;
  const std::size_t bodies = problem.scene.bodies.size();
  std::vector<double> times = problem.truth.impacts;
  std::sort(times.begin(), times.end());
  Moment moment{std::vector<BodyState>(bodies), std::vector<BodyState>(bodies)};
  for (const double time : times) {
    if (time > problem.duration) break;
    problem.truth.exact(std::max(0.0, time - kImpactMargin), moment.before);
    problem.truth.exact(time + kImpactMargin, moment.after);
    Impact impact{time, {}};
    for (std::size_t i = 0; i < bodies; ++i)
      if (jumps(moment, i)) impact.jumps.push_back(jump_of(problem.scene, moment, i));
    if (!impact.jumps.empty()) impacts.push_back(std::move(impact));
  }
  return impacts;
}

}  // namespace plumb::harness
