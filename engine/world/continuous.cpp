#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/collide/time_of_impact.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/math/trigonometry.h"
#include "engine/world/constants.h"
#include "engine/world/contacts.h"
#include "engine/world/step.h"

namespace plumb {
namespace {

// A shape shrunk towards its middle. While the core of a body has passed nothing, contacts push it out again
// on the side that it came from; so a body is only stopped on its way when its core would get through.
template <class Real>
struct Core {
  Core(const Convex<Real>& shape, Real share) {
    Vec2<Real> middle{};
    for (int i = 0; i < shape.count; ++i) middle += shape.corners[i].point;
    middle *= Real(1) / static_cast<Real>(shape.count);
    for (int i = 0; i < shape.count; ++i) {
      const Corner<Real>& from = shape.corners[i];
      std::construct_at(corners + i, Corner<Real>{middle + share * (from.point - middle), from.normal});
    }
    convex = {corners, shape.count, share * shape.radius};
  }
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;
  union {
    Corner<Real> corners[kMaxCorners];  // the first `convex.count` alone are made
  };
  Convex<Real> convex;
};

// The body's motion in this step, in double, seen from `origin`. The rotation is that of the step's end,
// turned back.
template <class Real>
Sweep<double> sweep_of(const WorldData<Real>& w, int body, Vec2d origin) {
  const BodyMotion<Real>& motion = w.motion[body];
  const Vec2d moved = motion.moved.template as<double>();
  const double turned = static_cast<double>(motion.turned);
  const Rotation<double> q{static_cast<double>(w.rotation[body].c), static_cast<double>(w.rotation[body].s)};
  const Rotation<double> back = rotation_of(-turned);
  return {w.position[body] - moved - origin,
          moved,
          {q.c * back.c - q.s * back.s, q.s * back.c + q.c * back.s},
          turned};
}

template <class Real>
bool in_front(const WorldData<Real>& w, int chain_segment, Vec2d point, const Sweep<double>& chain) {
  const Convex<Real> segment = w.convex(chain_segment);
  const Vec2d local = chain.start_rotation.inverse() * (point - chain.start);
  const Corner<Real>& first = segment.corners[0];
  return dot(first.normal.template as<double>(), local - first.point.template as<double>()) >= 0;
}

// Whether two bodies move fast relative to each other: no slower than one could pass through the other.
template <class Real>
bool pass_fast(const WorldData<Real>& w, int a, int b) {
  const Vec2<Real> way = w.motion[b].moved - w.motion[a].moved;
  const Real turned =
      std::abs(w.motion[a].turned) * w.extents[a] + std::abs(w.motion[b].turned) * w.extents[b];
  return std::abs(way.x) + std::abs(way.y) + turned > Real(tuning::kFastShare) * w.bodies[a].half_width;
}

// A fast body's way, seen from where it started.
template <class Real>
struct Way {
  Way(const WorldData<Real>& w, int body_)
      : body(body_),
        origin(w.position[body] - w.motion[body].moved.template as<double>()),
        sweep(sweep_of(w, body, origin)) {}
  int body;
  Vec2d origin;
  Sweep<double> sweep;
};

// How much of a shape is its core against another one. Two discs may not even graze each other unseen.
template <class Real>
Real core_share(const WorldData<Real>& w, int shape, int other) {
  const ShapeForm<Real>&a = w.forms[shape], &b = w.forms[other];
  if (a.count != 1 || b.count != 1) return Real(tuning::kCoreShare);
  return 1 - Real(tuning::kGraze) * std::min(b.radius / a.radius, Real(1));
}

// The fraction of the step at which `shape` of a fast body meets `other`; 1 when it does not.
template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way<Real>& way, int shape, int other) {
  const Sweep<double> other_sweep = sweep_of(w, w.shapes[other].body, way.origin);
  const Sweep<double>& sweep = way.sweep;
  if (w.forms[other].chain && !in_front(w, other, sweep.start, other_sweep)) return 1;
  const Convex<Real> whole = w.convex(shape), obstacle = w.convex(other);
  const Core<Real> core(whole, core_share(w, shape, other));
  using State = typename ImpactResult<Real>::State;
  const Real smaller = std::min(w.forms[shape].extent, w.forms[other].extent);
  const Real tolerance = Real(tuning::kImpactTolerance) * smaller;
  const ImpactResult<Real> through =
      time_of_impact(obstacle, other_sweep, core.convex, sweep, tolerance, tolerance);
  if (through.state == State::Separated || through.state == State::Overlapped) return 1;
  const ImpactResult<Real> first = time_of_impact(obstacle, other_sweep, whole, sweep, tolerance, tolerance);
  // Shapes that touched at the start are held by their contact until the core comes too near.
  return first.state == State::Overlapped || first.exact_fraction == 0 ? through.exact_fraction
                                                                       : first.exact_fraction;
}

// Whether a contact between the shapes had points in this step: the solver has seen to it.
template <class Real>
bool was_solved(const WorldData<Real>& w, int body, int shape, int other) {
  const int other_body = w.shapes[other].body;
  const auto is_solved = [&](const ContactRecord& contact) {
    return contact.home == ContactHome::Graph && ((contact.shape_a == shape && contact.shape_b == other) ||
                                                  (contact.shape_a == other && contact.shape_b == shape));
  };
  return any_between(w.contacts, w.bodies[body].first_contact, w.bodies[other_body].first_contact, body,
                     other_body, is_solved);
}

// A box around all that the body covers on its way.
template <class Real>
Aabb<Real> way_of(const WorldData<Real>& w, int body) {
  const Real extent = w.extents[body];
  const Vec2<Real> end = w.position[body].template as<Real>(), start = end - w.motion[body].moved;
  return merged(Aabb<Real>{start, start}, Aabb<Real>{end, end}).grown(extent);
}

// Smallest fraction over all that the body meets, when all of that has a contact with it.
template <class Real>
double first_impact_of_pairs(const WorldData<Real>& w, const Way<Real>& way) {
  double first = 1;
  const int body = way.body;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    if (contact.home == ContactHome::Graph) return;  // the solver has seen to it
    const bool is_a = (edge & 1) == 0;
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    if (w.forms[shape].chain || !pass_fast(w, body, w.shapes[other].body)) return;
    first = std::min(first, fraction_of_impact(w, way, shape, other));
  });
  return first;
}

// Smallest fraction over all that the body meets.
template <class Real>
double first_impact(const WorldData<Real>& w, const FastBody& fast) {
  const int body = fast.body;
  const Way<Real> way(w, body);
  if (fast.covered) return first_impact_of_pairs(w, way);
  double first = 1;
  const Aabb<Real> swept = way_of(w, body);
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = seen_by(w.shapes[shape].filter);
    if (w.forms[shape].sensor || w.forms[shape].chain || mask == 0) continue;
    const auto visit = [&](int other, int) {
      if (!pass_fast(w, body, w.shapes[other].body) || !may_collide(w, shape, other) ||
          was_solved(w, body, shape, other))
        return true;
      first = std::min(first, fraction_of_impact(w, way, shape, other));
      return true;
    };
    w.still_tree.query(swept, mask, visit);
    w.moving_tree.query(swept, mask, visit);
  }
  return first;
}

// Stores the whole way of a fast body, so that others find it.
template <class Real>
void show_way(WorldData<Real>& w, int body) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    DynamicTree<Real>& tree = w.tree_of(w.bodies[body].type);
    tree.enlarge(w.shapes[shape].proxy, merged(way_of(w, body), tree.box(w.shapes[shape].proxy)));
  }
}

// Stores what is needed from here on again.
template <class Real>
void hide_way(WorldData<Real>& w, int body, Real dt) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (w.shapes[shape].proxy == kNone) continue;
    w.tree_of(w.bodies[body].type).enlarge(w.shapes[shape].proxy, stored_box(w, shape, dt));
    w.enlarged[body] = 1;
    if (!w.shapes[shape].moved) append(w.moved_shapes, shape);
    w.shapes[shape].moved = true;
  }
}

template <class Real>
void turn_back(WorldData<Real>& w, int body, double fraction, Real dt) {
  BodyMotion<Real>& motion = w.motion[body];
  const double rest = 1 - fraction;
  w.position[body] -= rest * motion.moved.template as<double>();
  const Real back = static_cast<Real>(-rest) * motion.turned;
  const Rotation<Real> q = w.rotation[body], r = rotation_of(back);
  w.rotation[body] = {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s};
  w.bodies[body].angle += static_cast<double>(back);
  motion.moved *= static_cast<Real>(fraction);
  motion.turned += back;
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next)
    refresh_box(w, shape, dt, Real(0));
}

}  // namespace

template <class Real>
void stop_at_impacts(WorldData<Real>& w, Real dt) {
  if (w.scratch.fast_bodies.empty()) return;
  std::vector<double>& fractions = w.scratch.fractions;
  fractions.clear();
  for (const FastBody& fast : w.scratch.fast_bodies) {
    if (!fast.covered) show_way(w, fast.body);
  }
  // All are found before any is moved, so that two fast bodies see each other's whole way.
  for (const FastBody& fast : w.scratch.fast_bodies) {
    fractions.push_back(w.gives_way(fast.body) ? first_impact(w, fast) : 1);
  }
  for (std::size_t i = 0; i < fractions.size(); ++i) {
    const FastBody& fast = w.scratch.fast_bodies[i];
    if (fractions[i] < 1) turn_back(w, fast.body, fractions[i], dt);
    if (!fast.covered) hide_way(w, fast.body, dt);
  }
}

template void stop_at_impacts(WorldData<float>&, float);
template void stop_at_impacts(WorldData<double>&, double);

}  // namespace plumb
