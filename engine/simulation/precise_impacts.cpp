#include "engine/simulation/precise_impacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"

namespace plumb::precise {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// A point of a body: its arm from the centre of mass, and its motion.
struct PointMotion {
  Vec2d arm, position, velocity, acceleration;
};

PointMotion centre_of(const Disc& disc, const Motion& body) {
  const Vec2d arm = disc.offset == Vec2d{} ? Vec2d{} : rotation_of(body.state.angle) * disc.offset;
  const double w = body.state.angular_velocity;
  return {arm, body.state.position + arm, body.state.velocity + cross(w, arm),
          body.acceleration + cross(body.angular_acceleration, arm) - (w * w) * arm};
}

double length(Vec2d v) { return std::sqrt(length_squared(v)); }

/// |d|^2 - distance^2 for d = b - a, of twice the paths' degree. Product of Bernstein polynomials:
/// c_k = sum_i C(n, i) C(n, k - i) / C(2n, k) d_i . d_(k-i).
Bernstein<11> squared_gap(const std::array<Vec2d, 6>& a, const std::array<Vec2d, 6>& b, double distance) {
  constexpr double kChoose5[6] = {1, 5, 10, 10, 5, 1};
  constexpr double kChoose10[11] = {1, 10, 45, 120, 210, 252, 210, 120, 45, 10, 1};
  Bernstein<11> c{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      c[i + j] += kChoose5[i] * kChoose5[j] / kChoose10[i + j] * dot(b[i] - a[i], b[j] - a[j]);
    }
  }
  for (double& x : c) x -= distance * distance;
  return c;
}

}  // namespace

Impacts::Impacts(const Scene& scene, Parts parts)
    : rules_(scene),
      parts_(std::move(parts)),
      discs_(parts_.discs),
      paths_(discs_.size()),
      extents_(discs_.size()) {}

Encounter Impacts::encounter(const Impact& impact, std::span<const Motion> motions) const {
  const Disc& disc_a = discs_[impact.disc_a];
  const Disc& disc_b = discs_[impact.disc_b];
  const PointMotion a = centre_of(disc_a, motions[disc_a.body]), b = centre_of(disc_b, motions[disc_b.body]);
  const Vec2d apart = b.position - a.position;
  const double distance = length(apart);
  Encounter e;
  e.normal = distance > 0 ? (1 / distance) * apart : Vec2d{1, 0};
  e.gap = distance - impact.distance;
  e.speed = dot(e.normal, b.velocity - a.velocity);
  e.noise = 16 * kEpsilon * (length(a.position) + length(b.position) + impact.distance);
  e.quiet = 64 * kEpsilon * (length(a.velocity) + length(b.velocity));
  return e;
}

/// Pairs of discs whose ways overlap as boxes, by sweep and prune along x, in ascending order.
void Impacts::find_pairs(std::span<const Path> paths) {
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    // A polynomial stays in the hull of its coefficients.
    const auto [left, right] =
        std::minmax_element(paths[i].begin(), paths[i].end(), [](Vec2d a, Vec2d b) { return a.x < b.x; });
    const auto [bottom, top] =
        std::minmax_element(paths[i].begin(), paths[i].end(), [](Vec2d a, Vec2d b) { return a.y < b.y; });
    const double noise = 32 * kEpsilon * (length(paths[i][0]) + discs_[i].radius);
    const double reach = discs_[i].radius + noise;
    extents_[i] = {left->x - reach, right->x + reach, bottom->y - reach, top->y + reach, i};
  }
  std::sort(extents_.begin(), extents_.end(), [](const Extent& a, const Extent& b) {
    return a.left != b.left ? a.left < b.left : a.disc < b.disc;
  });
  pairs_.clear();
  for (std::size_t i = 0; i < extents_.size(); ++i) {
    for (std::size_t j = i + 1; j < extents_.size() && extents_[j].left <= extents_[i].right; ++j) {
      if (extents_[j].bottom > extents_[i].top || extents_[i].bottom > extents_[j].top) continue;
      const auto [a, b] = std::minmax(extents_[i].disc, extents_[j].disc);
      if (may_meet(rules_, parts_, discs_[a].body, discs_[a].filter, discs_[b].body, discs_[b].filter)) {
        pairs_.push_back({a, b});
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
}

void Impacts::follow(std::span<const Motion> at_start, std::span<const Motion> at_end, double duration) {
  const double h = duration;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    const PointMotion p = centre_of(discs_[i], at_start[discs_[i].body]);
    const PointMotion q = centre_of(discs_[i], at_end[discs_[i].body]);
    paths_[i] = {p.position,
                 p.position + (h / 5) * p.velocity,
                 p.position + (2 * h / 5) * p.velocity + (h * h / 20) * p.acceleration,
                 q.position - (2 * h / 5) * q.velocity + (h * h / 20) * q.acceleration,
                 q.position - (h / 5) * q.velocity,
                 q.position};
  }
}

std::optional<Impact> Impacts::touching(double time, std::span<const Motion> motions) {
  follow(motions, motions, 0);
  find_pairs(paths_);
  std::optional<Impact> fastest;
  double speed = 0;
  for (const auto& [a, b] : pairs_) {
    const Impact impact{a, b, time, discs_[a].radius + discs_[b].radius};
    const Encounter e = encounter(impact, motions);
    if (e.gap > e.noise || e.speed >= -e.quiet || e.speed >= speed) continue;
    fastest = impact;
    speed = e.speed;
  }
  return fastest;
}

std::optional<Impact> Impacts::first(double start, double end, std::span<const Motion> at_start,
                                     std::span<const Motion> at_end) {
  follow(at_start, at_end, end - start);
  find_pairs(paths_);
  std::optional<Impact> earliest;
  for (const auto& [a, b] : pairs_) {
    Impact impact{a, b, end, discs_[a].radius + discs_[b].radius};
    const Encounter e = encounter(impact, at_start);
    // Discs that touch already, and do not approach, meet again only when they are pressed into each other.
    if (e.gap <= e.noise) impact.distance = std::min(impact.distance, impact.distance + e.gap) - e.noise;
    const auto s = first_descent(squared_gap(paths_[a], paths_[b], impact.distance));
    if (!s) continue;
    impact.time = start + *s * (end - start);
    if (!earliest || impact.time < earliest->time) earliest = impact;
  }
  return earliest;
}

double Impacts::longest_step(std::span<const Motion> motions) const {
  double fastest = 0;
  for (const Disc& disc : discs_) {
    if (disc.offset == Vec2d{}) continue;
    fastest = std::max(fastest, std::abs(motions[disc.body].state.angular_velocity));
  }
  return fastest > 0 ? 0.25 / fastest : std::numeric_limits<double>::infinity();
}

Impacts::Directions Impacts::directions(const Impact& impact, std::span<const Motion> motions) const {
  const Disc& disc_a = discs_[impact.disc_a];
  const Disc& disc_b = discs_[impact.disc_b];
  const Vec2d arm_a = centre_of(disc_a, motions[disc_a.body]).arm;
  const Vec2d arm_b = centre_of(disc_b, motions[disc_b.body]).arm;
  const Vec2d n = encounter(impact, motions).normal, t = perpendicular(n);
  // The point of contact is at arm_a + radius_a n and arm_b - radius_b n. The radii have no lever about n,
  // and all of it about t: (r n) x n = 0, (r n) x t = r.
  const int a = static_cast<int>(disc_a.body), b = static_cast<int>(disc_b.body);
  return {{a, b, -n, n, -cross(arm_a, n), cross(arm_b, n), 0, 0},
          {a, b, -t, t, -(cross(arm_a, t) + disc_a.radius), cross(arm_b, t) - disc_b.radius, 0, 0}};
}

Impacts::Impulse Impacts::impulse(const Impact& impact, double speed, double slip, double nn, double nt,
                                  double tt) const {
  const Disc& a = discs_[impact.disc_a];
  const Disc& b = discs_[impact.disc_b];
  const bool bounces = -speed >= rules_.contact_rules.restitution_threshold;
  const double restitution =
      bounces ? combine(rules_.contact_rules.restitution, a.restitution, b.restitution) : 0;
  const double friction = combine(rules_.contact_rules.friction, a.friction, b.friction);
  const double wanted = -(1 + restitution) * speed;  // the change of the normal velocity: v_n' = -e v_n
  const double frictionless = wanted / nn;
  if (friction == 0 || (slip == 0 && nt == 0)) return {frictionless, 0};

  // Sticking: nn J_n + nt J_t = wanted,  nt J_n + tt J_t = -slip.
  const double determinant = nn * tt - nt * nt;
  const double push = -(nn * slip + nt * wanted);  // J_t times the determinant
  if (determinant > 0) {
    const Impulse stick{(tt * wanted + nt * slip) / determinant, push / determinant};
    if (std::abs(stick.tangent) <= friction * stick.normal) return stick;
  }
  // Sliding: J_t = mu J_n, against the slip.
  const double along = push > 0 ? friction : -friction;
  const double resisted = nn + along * nt;
  const double normal = resisted > 0 ? wanted / resisted : frictionless;
  return {normal, along * normal};
}

}  // namespace plumb::precise
