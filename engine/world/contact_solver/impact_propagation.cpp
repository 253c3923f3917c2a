#include "engine/world/contact_solver/impact_propagation.h"

#include <algorithm>
#include <limits>

#include "engine/core/capacity.h"
#include "engine/world/contact_solver/contact_pair.h"
#include "engine/world/contact_solver/impact_round.h"

namespace plumb {
namespace {

// Impacts whose times differ by less than this fraction of a substep are simultaneous.
constexpr double kSimultaneous = 1e-3;
// Approaches slower than this fraction of the fastest are left to the solver's iterations, which stop them.
constexpr double kMinApproach = 1e-4;
// Limits the work of a substep: the contacts examined in all rounds, plus the points solved in all
// iterations. The limit is kWorkLimit plus kWorkForRestitution times the largest restitution e of the
// impacts; with e = 1 about 2 ms. Impacts beyond it are left to the constraints and lose their rebounds, the
// fraction e of the approach. If the limit does not suffice for the first round, this round is skipped: its
// impulses would be those of an unfinished iteration. A stirred heap of 6000 bodies with e = 0.1 exceeds the
// limit in nearly every substep. A limit six times as large reduces its overlaps by 3 %.
constexpr int kWorkLimit = 1 << 12, kWorkForRestitution = 1 << 16;
// Minimum number of iterations over the points of a round: one that solves them, and one that finds no
// change.
constexpr int kMinIterations = 2;
// Maximum number of rounds of a substep in which no time passes: a constant, plus a number for each examined
// contact. An impact propagates to the far end and back in a few rounds. More are needed only if friction or
// a second wall pushes a body back at once.
constexpr int kMaxStalledRounds = 64, kStalledRoundsPerContact = 8;

// Returns the present separation of a point, m.
template <class Real>
Real separation_of(const SolverBody<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const SolverBody<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return c.separation[i] + dot(c.normal, b.delta_position - a.delta_position) +
         (c.arm_b[i] * b.delta_angle - c.arm_a[i] * a.delta_angle);
}

template <class Real>
bool any_impact(const RestitutionContact<Real>& bounce) {
  return bounce.has_impact[0] || bounce.has_impact[1];
}

// Returns the limit on the work of a substep whose largest restitution is this.
template <class Real>
int work_limit(Real restitution) {
  return kWorkLimit + static_cast<int>(Real(kWorkForRestitution) * restitution);
}

// Finds the contacts that have impacts, their fastest approach and their largest restitution.
template <class Real>
void collect_impacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                     ImpactScratch<Real>& scratch) {
  scratch.impacts.clear(), ensure_capacity(scratch.impacts, bounces.size());
  scratch.point_count = 0, scratch.max_approach = scratch.max_restitution = 0;
  for (std::size_t at = 0; at < bounces.size(); ++at) {
    const RestitutionContact<Real>& bounce = bounces[at];
    if (!any_impact(bounce)) continue;
    scratch.impacts.push_back(static_cast<int>(at));
    const ContactConstraint<Real>& c = *bounce.contact;
    scratch.max_restitution = std::max(scratch.max_restitution, c.restitution);
    for (int i = 0; i < c.count; ++i) {
      if (!bounce.has_impact[i]) continue;
      ++scratch.point_count;
      scratch.max_approach = std::max(scratch.max_approach, -velocity_along_normal(motion, c, i));
    }
  }
}

// Time of a point without a next impact.
template <class Real>
constexpr Real kNever = std::numeric_limits<Real>::infinity();

// Resizes the lists for the groups and contacts of a step, and clears all impacts.
template <class Real>
void reset_scratch(const std::vector<RestitutionContact<Real>>& bounces, ImpactScratch<Real>& scratch) {
  int bodies = static_cast<int>(scratch.group.size());
  for (const RestitutionContact<Real>& bounce : bounces)
    bodies = std::max({bodies, bounce.contact->body_a + 1, bounce.contact->body_b + 1});
  const int contacts = static_cast<int>(bounces.size());
  for (std::vector<char>* const flags : {&scratch.in_groups, &scratch.visited}) {
    if (static_cast<int>(flags->size()) < bodies) resize_with_growth(*flags, bodies);
    std::fill_n(flags->begin(), bodies, char(0));
  }
  for (std::vector<int>* const indices : {&scratch.first_contact, &scratch.point_at}) {
    if (static_cast<int>(indices->size()) < bodies) resize_with_growth(*indices, bodies);
    std::fill_n(indices->begin(), bodies, -1);
  }
  if (static_cast<int>(scratch.earliest.size()) < bodies) resize_with_growth(scratch.earliest, bodies);
  if (static_cast<int>(scratch.last.size()) < bodies) resize_with_growth(scratch.last, bodies);
  std::fill_n(scratch.last.begin(), bodies, Real(0));
  if (static_cast<int>(scratch.displacement.size()) < bodies) {
    resize_with_growth(scratch.displacement, bodies), resize_with_growth(scratch.delta_angle, bodies);
    ensure_capacity(scratch.displaced, scratch.displacement.size());
  }
  if (static_cast<int>(scratch.in_pending.size()) < contacts) {
    resize_with_growth(scratch.in_pending, contacts), resize_with_growth(scratch.is_examined, contacts);
    resize_with_growth(scratch.next, 2 * contacts), resize_with_growth(scratch.predicted, contacts);
    const std::size_t points = scratch.next.size();
    ensure_capacity(scratch.points, points), ensure_capacity(scratch.sorted_points, points);
    ensure_capacity(scratch.next_in_group, points), ensure_capacity(scratch.last_in_group, points);
    ensure_capacity(scratch.pending, scratch.in_pending.size());
    ensure_capacity(scratch.examined, scratch.in_pending.size());
    ensure_capacity(scratch.groups, points);
  }
  std::fill_n(scratch.in_pending.begin(), contacts, char(0));
  std::fill_n(scratch.is_examined.begin(), contacts, char(0));
  for (int i = 0; i < contacts; ++i)
    scratch.predicted[i].time[0] = scratch.predicted[i].time[1] = kNever<Real>;
  scratch.pending.clear(), scratch.groups.clear(), scratch.points.clear(), scratch.examined.clear();
}

// Calls visit(contact) for the contacts of a group.
template <class Real, class Visit>
void for_each_at(const ImpactScratch<Real>& scratch, int group, const Visit& visit) {
  for (int edge = scratch.first_contact[group]; edge != -1; edge = scratch.next[edge]) visit(edge / 2);
}

// Adds an item to a list, unless the list contains it. Lists have capacity for all items (`reset_scratch`).
inline void add_once(std::vector<int>& list, std::vector<char>& present, int item) {
  if (present[item]) return;
  present[item] = 1;
  list.push_back(item);
}

// Predicts the next impact of each point of a contact, from the current motion of its bodies.
template <class Real>
void predict_impacts(const SolverBody<Real>* motion, RestitutionContact<Real>& bounce, Real min_approach,
                     Real h, const ImpactScratch<Real>& scratch, PredictedImpact<Real>& predicted) {
  ContactConstraint<Real>& c = *bounce.contact;
  const Real start =
      std::max(scratch.last[group_of(scratch, c.body_a)], scratch.last[group_of(scratch, c.body_b)]);
  if (bounce.radius_sum != 0) update_circle_normal(motion, bounce, h, std::min(start, h));
  for (int i = 0; i < 2; ++i) {
    predicted.time[i] = kNever<Real>;
    if (i >= c.count) continue;
    const Real closing_speed = -velocity_along_normal(motion, c, i);
    const Real s = std::max(separation_of(motion, c, i), Real(0));
    if (!(closing_speed > min_approach) || s > closing_speed * h) continue;
    // A point without an earlier impact bounces as `schedule_impacts` set it, with the effect of gravity
    // before and after.
    const bool scheduled = start == 0 && bounce.has_impact[i];
    predicted.time[i] = std::max(s / closing_speed, start);
    predicted.target[i] = scheduled ? bounce.end_speed[i] : effective_restitution(c) * closing_speed;
    predicted.velocity_before[i] = -closing_speed;
  }
}

// Prefetches the contacts of a list and, once these are loaded, their bodies: they are scattered in memory.
// Always inlined, because GCC 12 drops calls of a function that only prefetches.
template <class Real>
[[gnu::always_inline]] inline void prefetch_contacts(const SolverBody<Real>* motion,
                                                     const std::vector<RestitutionContact<Real>>& bounces,
                                                     const std::vector<int>& list, std::size_t i) {
  constexpr std::size_t kBounces = 12, kContacts = 8, kBodies = 4;
  if (i + kBounces < list.size()) __builtin_prefetch(&bounces[list[i + kBounces]]);
  if (i + kContacts < list.size()) {
    const char* const contact = reinterpret_cast<const char*>(bounces[list[i + kContacts]].contact);
    for (std::size_t byte = 0; byte < sizeof(ContactConstraint<Real>); byte += 64)
      __builtin_prefetch(contact + byte);
  }
  if (i + kBodies >= list.size()) return;
  const ContactConstraint<Real>& c = *bounces[list[i + kBodies]].contact;
  __builtin_prefetch(&motion[c.body_a]), __builtin_prefetch(&motion[c.body_b]);
}

// Sorts the pending contacts, all of which are marked in `in_pending`. Clears the marks.
template <class Real>
void order_pending(int contacts, ImpactScratch<Real>& scratch) {
  constexpr int kSorted = 16;  // lists shorter than 1/16 of all contacts are sorted directly
  if (kSorted * static_cast<int>(scratch.pending.size()) < contacts) {
    std::sort(scratch.pending.begin(), scratch.pending.end());
    for (const int i : scratch.pending) scratch.in_pending[i] = 0;
    return;
  }
  scratch.pending.clear();
  for (int i = 0; i < contacts; ++i) {
    if (scratch.in_pending[i] == 0) continue;
    scratch.in_pending[i] = 0;
    scratch.pending.push_back(i);
  }
}

// Finds the points of the next impacts: for each body those of its earliest one. Examines only the pending
// contacts, whose bodies have had an impact since they were last examined. Predictions for the others have
// not changed.
template <class Real>
void find_next_impacts(const SolverBody<Real>* motion, std::vector<RestitutionContact<Real>>& bounces,
                       Real min_approach, Real h, ImpactScratch<Real>& scratch) {
  scratch.points.clear(), scratch.groups.clear();
  for (std::size_t k = 0; k < scratch.pending.size(); ++k) {
    prefetch_contacts(motion, bounces, scratch.pending, k);
    const int i = scratch.pending[k];
    scratch.in_pending[i] = 0;
    add_once(scratch.examined, scratch.is_examined, i);
    predict_impacts(motion, bounces[i], min_approach, h, scratch, scratch.predicted[i]);
    for (const int body : {bounces[i].contact->body_a, bounces[i].contact->body_b})
      if (is_dynamic(motion[body])) add_once(scratch.groups, scratch.in_groups, group_of(scratch, body));
  }
  scratch.pending.clear();
  for (const int group : scratch.groups) {
    Real earliest = kNever<Real>;
    for_each_at(scratch, group, [&](int i) {
      const Real(&time)[2] = scratch.predicted[i].time;
      earliest = std::min(earliest, std::min(time[0], time[1]));
      add_once(scratch.pending, scratch.in_pending, i);
    });
    scratch.earliest[group] = earliest;
    scratch.in_groups[group] = 0;
  }
  order_pending(static_cast<int>(bounces.size()), scratch);
  for (const int i : scratch.pending) {
    const PredictedImpact<Real>& predicted = scratch.predicted[i];
    if (predicted.time[0] == kNever<Real> && predicted.time[1] == kNever<Real>) continue;
    const ContactConstraint<Real>& c = *bounces[i].contact;
    Real until = kNever<Real>;
    for (const int body : {c.body_a, c.body_b})
      if (is_dynamic(motion[body])) until = std::min(until, scratch.earliest[group_of(scratch, body)]);
    until += Real(kSimultaneous) * h;
    for (int k = 0; k < c.count; ++k) {
      if (predicted.time[k] == kNever<Real> || predicted.time[k] > until) continue;
      scratch.points.push_back(ImpactPoint<Real>{.bounce = &bounces[i],
                                                 .point = k,
                                                 .time = predicted.time[k],
                                                 .target = predicted.target[k],
                                                 .velocity_before = predicted.velocity_before[k]});
    }
  }
  scratch.pending.clear();
}

// Returns true if a next impact comes after the last impacts of its bodies.
template <class Real>
bool time_passes(const ImpactScratch<Real>& scratch) {
  return std::any_of(scratch.points.begin(), scratch.points.end(), [&](const ImpactPoint<Real>& at) {
    const ContactConstraint<Real>& c = *at.bounce->contact;
    return at.time >
           std::max(scratch.last[group_of(scratch, c.body_a)], scratch.last[group_of(scratch, c.body_b)]);
  });
}

// Updates the contacts whose bodies the impacts have moved, and clears the impacts.
template <class Real>
void update_contacts(const SolverBody<Real>* motion, std::vector<RestitutionContact<Real>>& bounces,
                     const ContactStep<Real>& step, ImpactScratch<Real>& scratch) {
  for (const int i : scratch.pending)
    scratch.in_pending[i] = 0, add_once(scratch.examined, scratch.is_examined, i);
  for (const int i : scratch.examined) {
    RestitutionContact<Real>& bounce = bounces[i];
    ContactConstraint<Real>& c = *bounce.contact;
    // The remaining approaches are too slow, or do not close their gap within this substep.
    bounce.impact_pending = false;
    bool open = true;
    for (int k = 0; k < c.count; ++k) {
      const Real closing_speed = -velocity_along_normal(motion, c, k);
      c.current_separation[k] = separation_of(motion, c, k);
      bounce.has_impact[k] = false;
      bounce.impact_pending = bounce.impact_pending || closing_speed > step.bounce_threshold;
      open = open && c.current_separation[k] > step.h * closing_speed;
    }
    bounce.impact_pending = bounce.impact_pending && open;
    scratch.is_examined[i] = 0;
    scratch.predicted[i].time[0] = scratch.predicted[i].time[1] = kNever<Real>;
    for (const int body : {c.body_a, c.body_b}) scratch.last[group_of(scratch, body)] = 0;
  }
  scratch.pending.clear(), scratch.examined.clear();
}

}  // namespace

template <class Real>
bool find_impacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                  ImpactScratch<Real>& scratch) {
  collect_impacts(motion, bounces, scratch);
  const int first_round = static_cast<int>(scratch.impacts.size()) + kMinIterations * scratch.point_count;
  return scratch.point_count > 0 && first_round <= work_limit(scratch.max_restitution);
}

template <class Real>
void link_contacts(const SolverBody<Real>* motion, const std::vector<RestitutionContact<Real>>& bounces,
                   ImpactScratch<Real>& scratch) {
  reset_scratch(bounces, scratch);
  for (int i = static_cast<int>(bounces.size()) - 1; i >= 0; --i) {
    const ContactConstraint<Real>& c = *bounces[i].contact;
    for (int side = 0; side < 2; ++side) {
      const int body = side == 0 ? c.body_a : c.body_b;
      if (!is_dynamic(motion[body])) continue;
      int& first = scratch.first_contact[group_of(scratch, body)];
      scratch.next[2 * i + side] = first, first = 2 * i + side;
    }
  }
}

template <class Real>
int propagate_impacts(SolverBody<Real>* motion, Rotation<Real>* rotation,
                      std::vector<RestitutionContact<Real>>& bounces, const ContactStep<Real>& step,
                      ImpactScratch<Real>& scratch) {
  const Real min_approach = std::max(step.bounce_threshold, Real(kMinApproach) * scratch.max_approach);
  int work_left = work_limit(scratch.max_restitution);
  for (const int body : scratch.displaced) scratch.displacement[body] = {}, scratch.delta_angle[body] = 0;
  scratch.displaced.clear();
  int round = 0, stalled_rounds = 0;
  scratch.pending = scratch.impacts;
  for (; static_cast<int>(scratch.pending.size()) < work_left; ++round) {
    work_left -= static_cast<int>(scratch.pending.size());
    find_next_impacts(motion, bounces, min_approach, step.h, scratch);
    if (scratch.points.empty()) break;
    if (!time_passes(scratch)) ++stalled_rounds;
    resolve_round(motion, rotation, scratch.max_approach, work_left, scratch);
    for (const ImpactPoint<Real>& at : scratch.points) {
      for (const int body : {at.bounce->contact->body_a, at.bounce->contact->body_b})
        if (is_dynamic(motion[body]))
          for_each_at(scratch, group_of(scratch, body),
                      [&](int i) { add_once(scratch.pending, scratch.in_pending, i); });
    }
    if (stalled_rounds >=
        kMaxStalledRounds + kStalledRoundsPerContact * static_cast<int>(scratch.examined.size()))
      break;
  }
  update_contacts(motion, bounces, step, scratch);
  return round;
}

#define PLUMB_FOR(Real)                                                                                      \
  template bool find_impacts(const SolverBody<Real>*, const std::vector<RestitutionContact<Real>>&,          \
                             ImpactScratch<Real>&);                                                          \
  template void link_contacts(const SolverBody<Real>*, const std::vector<RestitutionContact<Real>>&,         \
                              ImpactScratch<Real>&);                                                         \
  template int propagate_impacts(SolverBody<Real>*, Rotation<Real>*, std::vector<RestitutionContact<Real>>&, \
                                 const ContactStep<Real>&, ImpactScratch<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
