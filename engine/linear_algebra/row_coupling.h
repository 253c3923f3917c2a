#pragma once

#include <span>

#include "engine/linear_algebra/bounded_rows.h"

/// Products J M^-1 J^T of rows that act on the same bodies: what an impulse along one row changes along
/// another.
namespace plumb {

/// Returns the contribution of one body, given the Jacobians of both rows.
inline double coupling(const BoundedBody& body, Vec2d linear_r, double angular_r, Vec2d linear_s,
                       double angular_s) {
  return body.inverse_mass.x * linear_r.x * linear_s.x + body.inverse_mass.y * linear_r.y * linear_s.y +
         body.inverse_inertia * angular_r * angular_s;
}

/// Returns the coupling of two rows. The coupling of a row with itself is its mobility.
inline double coupling(std::span<const BoundedBody> bodies, const BoundedRow& r, const BoundedRow& s) {
  double sum = 0;
  if (r.a == s.a) sum += coupling(bodies[r.a], r.linear_a, r.angular_a, s.linear_a, s.angular_a);
  if (r.a == s.b) sum += coupling(bodies[r.a], r.linear_a, r.angular_a, s.linear_b, s.angular_b);
  if (r.b == s.a) sum += coupling(bodies[r.b], r.linear_b, r.angular_b, s.linear_a, s.angular_a);
  if (r.b == s.b) sum += coupling(bodies[r.b], r.linear_b, r.angular_b, s.linear_b, s.angular_b);
  return sum;
}

/// Couples a row with `count` rows of another block, all of which have the same bodies.
inline void couple(std::span<const BoundedBody> bodies, const BoundedRow& r, const BoundedRow* s, int count,
                   double* out) {
  if (count <= 0) return;
  const bool from_a = r.a == s->a || r.a == s->b, from_b = r.b == s->a || r.b == s->b;
  if (from_a == from_b) {
    for (int k = 0; k < count; ++k) out[k] = coupling(bodies, r, s[k]);
    return;
  }
  // One body in common: the response of that body to row r, along each of the other rows.
  const BoundedBody& body = bodies[from_a ? r.a : r.b];
  const Vec2d linear = from_a ? r.linear_a : r.linear_b;
  const double angular = from_a ? r.angular_a : r.angular_b;
  const double x = body.inverse_mass.x * linear.x, y = body.inverse_mass.y * linear.y,
               angular_response = body.inverse_inertia * angular;
  const bool at_a = s->a == (from_a ? r.a : r.b);
  for (int k = 0; k < count; ++k)
    out[k] = at_a ? x * s[k].linear_a.x + y * s[k].linear_a.y + angular_response * s[k].angular_a
                  : x * s[k].linear_b.x + y * s[k].linear_b.y + angular_response * s[k].angular_b;
}

/// Returns true if two rows act on a dynamic body in common.
inline bool are_neighbours(std::span<const BoundedBody> bodies, const BoundedRow& r, const BoundedRow& s) {
  return ((r.a == s.a || r.a == s.b) && bodies[r.a].is_dynamic()) ||
         ((r.b == s.a || r.b == s.b) && bodies[r.b].is_dynamic());
}

}  // namespace plumb
