#include "engine/world/islands/island_choice.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/union_find.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/state/drivers.h"

namespace plumb {
namespace {

// Returns true if a body has passed through a half of another. Rows that push it out of those beyond as well
// contradict each other.
template <class Real>
bool is_deep_in(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  Real half_width = std::numeric_limits<Real>::max();
  for (const int body : {c.body_a, c.body_b})
    if (w.is_dynamic(body)) half_width = std::min(half_width, w.bodies[body].half_width);
  return -std::min(c.separation[0], c.separation[c.count - 1]) > half_width;
}

// Returns true for trees of a few similar hinges without contacts. Iterations are accurate enough for these,
// and cost less.
template <class Real>
bool left_to_iterations(const WorldData<Real>& w, int body) {
  const Scratch<Real>& s = w.scratch;
  return w.settings.solver != Solver::Direct && body < static_cast<int>(s.islands.not_a_tree.size()) &&
         s.islands.not_a_tree[s.islands.tree_root_of[body]] == kLeftToIterations;
}

// Chooses the islands with joints that are solved as one system. These are islands with few bounded rows and
// contacts, and islands with a large mass ratio; with Solver::Direct all.
template <class Real>
void choose_jointed(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  s.islands.lightest.assign(w.bodies.size(), std::numeric_limits<Real>::max());
  s.islands.heaviest.assign(w.bodies.size(), 0);
  s.islands.island_joints.assign(w.bodies.size(), 0);
  s.islands.island_bounded_rows.assign(w.bodies.size(), 0);
  for (const int body : w.awake) {
    const Real mass = w.bodies[body].mass;
    if (!w.is_dynamic(body)) continue;
    const int root = s.islands.island_of[body];
    s.islands.lightest[root] = std::min(s.islands.lightest[root], mass),
    s.islands.heaviest[root] = std::max(s.islands.heaviest[root], mass);
    // A body has infinite mass along a locked axis, which the iterations of joints do not take into account.
    const BodyRecord<Real>& record = w.bodies[body];
    if (record.lock_x || record.lock_y) s.islands.heaviest[root] = std::numeric_limits<Real>::infinity();
  }
  const auto root_of = [&](const JointRecord& joint) {
    return s.islands.island_of[w.is_dynamic(joint.body_a) ? joint.body_a : joint.body_b];
  };
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (!is_outside_trees(w, joint)) return;
    const int root = root_of(joint);
    ++s.islands.island_joints[root];
    s.islands.island_bounded_rows[root] += w.joint_set.bounded_rows(joint.slot);
  });
  for (const int body : w.awake) {
    if (!w.is_dynamic(body) || s.islands.island_of[body] != body || s.islands.island_joints[body] == 0)
      continue;
    // Each contact counts two rows in island_size.
    const bool small = enabled(Switch::JointedIslands) &&
                       s.islands.island_joints[body] <= tuning::kMaxJointedJoints &&
                       s.islands.island_size[body] <= 2 * tuning::kMaxJointedContacts;
    const bool similar_masses =
        s.islands.heaviest[body] <= Real(tuning::kDirectMassRatio) * s.islands.lightest[body];
    const bool few = w.settings.integrator == Integrator::VelocityVerlet &&
                     s.islands.island_bounded_rows[body] <= tuning::kFewBoundedRows &&
                     s.islands.island_size[body] <= 2 * tuning::kFewContacts && !left_to_iterations(w, body);
    const bool always = !similar_masses || w.settings.solver == Solver::Direct;
    s.islands.island_size[body] = small && always ? kJointed : small && few ? kJointedIfCheap : kIterated;
  }
  // From here on: joints less bodies.
  for (const int body : w.awake)
    if (w.is_dynamic(body)) --s.islands.island_joints[s.islands.island_of[body]];
}

// Includes towers and other slender heaps of any height: if there are few loops, and few contacts on any
// body, the factorisation has linear cost. `contacts_of(body)` returns the number of a body's contacts, and
// `size_of(root)` the rows of an island, which it sets to what counts as small if the island is slender.
template <class Real, class ContactsOf, class SizeOf>
void choose_slender(WorldData<Real>& w, const ContactsOf& contacts_of, const SizeOf& size_of) {
  if (!enabled(Switch::SlenderIslands)) return;
  std::vector<int>& limits = w.scratch.islands.max_island_rows;
  limits.assign(w.bodies.size(), 2 * tuning::kMaxSlenderLoops);
  for (const int body : w.awake) {
    if (!w.is_dynamic(body)) continue;
    int& limit = limits[w.scratch.islands.island_of[body]];
    limit = contacts_of(body) > tuning::kMaxSlenderContacts ? -tuning::kMaxSlenderRows : limit + 2;
  }
  for (const int body : w.awake) {
    int& size = size_of(body);
    if (size > tuning::kMaxDirectRows && size <= tuning::kMaxSlenderRows && size <= limits[body])
      size = tuning::kMaxDirectRows;
  }
}

// The velocities of an island's bodies after its contacts have acted for a substep as in the last one.
template <class Real>
class WarmStartedBodies {
 public:
  // `most` contacts have at most twice as many bodies.
  static constexpr std::size_t kMostContacts = tuning::kFewContacts;

  WarmStartedBodies(const WorldData<Real>& w, const DirectIsland<Real>& island) : w_(w) {
    assert(island.contacts.size() <= kMostContacts);
    for (const ContactConstraint<Real>* c : island.contacts) {
      SolverBody<Real>&a = at(c->body_a), &b = at(c->body_b);
      const Vec2<Real> n = c->normal, t{n.y, -n.x};
      const Real p = c->normal_impulse[0], q = c->normal_impulse[1], f = c->tangent_impulse;
      const Vec2<Real> impulse = (p + q) * n + f * t;
      a.apply(-impulse, -(c->arm_a[0] * p + c->arm_a[1] * q + c->arm_tangent_a * f + c->rolling_impulse));
      b.apply(impulse, c->arm_b[0] * p + c->arm_b[1] * q + c->arm_tangent_b * f + c->rolling_impulse);
    }
  }

  const SolverBody<Real>& operator[](int body) const {
    return const_cast<WarmStartedBodies*>(this)->at(body);
  }

 private:
  SolverBody<Real>& at(int body) {
    for (std::size_t i = 0; i < count_; ++i)
      if (bodies_[i].first == body) return bodies_[i].second;
    SolverBody<Real> moved = w_.motion[body];
    if (w_.is_dynamic(body))
      moved.velocity += (w_.impulse_h * free_acceleration(w_, body)).template as<Real>();
    return (bodies_[count_++] = {body, moved}).second;
  }

  const WorldData<Real>& w_;
  std::array<std::pair<int, SolverBody<Real>>, 2 * kMostContacts> bodies_{};
  std::size_t count_ = 0;
};

// Returns true if points of a contact approach or part by more than `tolerance`, m/s.
template <class Real>
bool closes_or_opens(const ContactConstraint<Real>& c, const SolverBody<Real>& a, const SolverBody<Real>& b,
                     Real tolerance) {
  for (int i = 0; i < c.count; ++i) {
    const Real rate = dot(c.normal, b.velocity - a.velocity) + c.arm_b[i] * b.angular_velocity -
                      c.arm_a[i] * a.angular_velocity;
    if (std::abs(rate) > tolerance) return true;
  }
  return false;
}

}  // namespace

template <class Real>
bool needs_one_system(const WorldData<Real>& w, const DirectIsland<Real>& island, Real dt) {
  if (!enabled(Switch::JointedIslands) || island.contacts.size() > tuning::kFewContacts) return false;
  Real lightest = std::numeric_limits<Real>::max(), heaviest = 0;
  bool has_pair = false;
  for (const ContactConstraint<Real>* c : island.contacts) {
    // Leaves out driven bodies: they press with any force, of which only joints keep the part that is a load.
    if (is_driver(w, c->body_a) || is_driver(w, c->body_b)) return false;
    for (const int body : {c->body_a, c->body_b}) {
      if (!w.is_dynamic(body)) continue;
      lightest = std::min(lightest, w.bodies[body].mass), heaviest = std::max(heaviest, w.bodies[body].mass);
    }
    has_pair = has_pair || (w.is_dynamic(c->body_a) && w.is_dynamic(c->body_b));
  }
  if (!has_pair || heaviest > Real(tuning::kMaxSystemMassRatio) * lightest) return false;
  if (heaviest > Real(tuning::kDirectMassRatio) * lightest) return true;
  const WarmStartedBodies<Real> warm_started(w, island);
  const Real fall = dt * static_cast<Real>(std::sqrt(length_squared(w.settings.gravity)));
  return std::any_of(island.contacts.begin(), island.contacts.end(), [&](const ContactConstraint<Real>* c) {
    const int a = c->body_a, b = c->body_b;
    return (is_near(w, *c, 0, dt) || (c->count == 2 && is_near(w, *c, 1, dt))) &&
           (closes_or_opens(*c, w.motion[a], w.motion[b], fall) ||
            closes_or_opens(*c, warm_started[a], warm_started[b], fall));
  });
}

template <class Real>
void find_islands(WorldData<Real>& w) {
  UnionFind islands(w.scratch.islands.island_of, w.bodies.size());
  const auto connect = [&](int a, int b) {
    if (w.is_dynamic(a) && w.is_dynamic(b)) islands.join(a, b);
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { connect(c.body_a, c.body_b); });
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (is_outside_trees(w, joint)) connect(joint.body_a, joint.body_b);
  });
  w.scratch.islands.island_size.assign(w.bodies.size(), 0);
  w.scratch.islands.island_index.assign(w.bodies.size(), kNone);
  const auto count = [&](int a, int b, int rows) {
    w.scratch.islands.island_size[islands.find(w.is_dynamic(a) ? a : b)] += rows;
  };
  w.graph.for_each([&](const ContactConstraint<Real>& c) { count(c.body_a, c.body_b, 2); });
  for (const int body : w.awake) w.scratch.islands.island_of[body] = islands.find(body);
  choose_slender(
      w, [&](int body) { return w.bodies[body].constraints; },
      [&](int body) -> int& { return w.scratch.islands.island_size[body]; });
  if (joints_outside_trees(w) > 0) choose_jointed(w);
  const auto any = [&](const auto& test) {
    return std::any_of(w.awake.begin(), w.awake.end(),
                       [&](int body) { return test(w.scratch.islands.island_size[body]); });
  };
  w.scratch.islands.has_direct_islands = any([](int size) { return is_direct(size) || is_jointed(size); });
  w.scratch.islands.has_crowded_islands = enabled(Switch::DirectIslands) && any(is_crowded);
}

template <class Real>
bool choose_crowded(WorldData<Real>& w, Real dt) {
  Scratch<Real>& s = w.scratch;
  if (!s.islands.has_crowded_islands) return false;
  s.islands.near_rows.assign(w.bodies.size(), 0), s.islands.near_contacts.assign(w.bodies.size(), 0);
  // Number of islands that may still have few enough: a large heap is left after a part of its contacts.
  auto undecided = std::count_if(w.awake.begin(), w.awake.end(), [&](int body) {
    return s.islands.island_of[body] == body && is_crowded(s.islands.island_size[body]);
  });
  const auto add = [&](const ContactConstraint<Real>& c) {
    const int root = s.islands.island_of[w.is_dynamic(c.body_a) ? c.body_a : c.body_b];
    int& rows = s.islands.near_rows[root];
    if (!is_crowded(s.islands.island_size[root]) || rows > tuning::kMaxSlenderRows) return;
    if (!is_near(w, c, 0, dt) && !(c.count == 2 && is_near(w, c, 1, dt))) return;
    // Those with the ground close no loops of bodies.
    if (w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b)) rows += is_deep_in(w, c) ? kIterated : 2;
    if (rows > tuning::kMaxSlenderRows) --undecided;
    ++s.islands.near_contacts[c.body_a], ++s.islands.near_contacts[c.body_b];
  };
  w.graph.for_each_colour([&](const std::vector<ContactConstraint<Real>>& colour, bool) {
    for (std::size_t i = 0; i < colour.size() && undecided > 0; ++i) add(colour[i]);
  });
  choose_slender(
      w, [&](int body) { return s.islands.near_contacts[body]; },
      [&](int body) -> int& { return s.islands.near_rows[body]; });
  return std::any_of(w.awake.begin(), w.awake.end(),
                     [&](int body) { return is_direct(s.islands.near_rows[body]); });
}

#define PLUMB_FOR(Real)                                 \
  template void find_islands(WorldData<Real>&);         \
  template bool choose_crowded(WorldData<Real>&, Real); \
  template bool needs_one_system(const WorldData<Real>&, const DirectIsland<Real>&, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
