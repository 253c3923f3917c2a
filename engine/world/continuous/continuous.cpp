#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/core/capacity.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/continuous/common_motion.h"
#include "engine/world/continuous/deep_contacts.h"
#include "engine/world/continuous/impact_hook.h"
#include "engine/world/continuous/joined_stops.h"
#include "engine/world/continuous/mechanism.h"
#include "engine/world/continuous/prefetch_contacts.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/swept_bodies.h"
#include "engine/world/continuous/swept_pair.h"
#include "engine/world/continuous/toi_events.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contact_setup.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Swept bodies per block of a shared loop: at least 10 us of work for a thread.
constexpr int kSweptOfBlock = 16;

// Orders a heap with the earliest time of impact on top. No two entries are equal.
bool is_later(const ToiEvent& a, const ToiEvent& b) {
  return a.fraction != b.fraction
             ? a.fraction > b.fraction
             : (a.swept_body != b.swept_body ? a.swept_body > b.swept_body : a.version > b.version);
}

template <class Real>
void push_toi_event(WorldData<Real>& w, const ToiEvent& meeting) {
  if (!(meeting.fraction < 1)) return;
  w.scratch.continuous.toi_events.push_back(meeting);
  std::push_heap(w.scratch.continuous.toi_events.begin(), w.scratch.continuous.toi_events.end(), is_later);
}

template <class Real>
void schedule_toi_event(WorldData<Real>& w, int index, double from, ImpactSearch& search) {
  push_toi_event(w, first_toi_event(w, index, from, search));
}

// Returns the SweptBody of a body that is hit, or null if it is static.
template <class Real>
SweptBody* moving_swept_body(WorldData<Real>& w, int body, double dt) {
  if (w.bodies[body].type == BodyType::Static) return nullptr;
  return &w.scratch.continuous.swept_bodies[swept_body_index(w, body, dt)];
}

// Finds impacts of other swept bodies with this one, whose motion has changed from a fraction of the step on.
template <class Real>
void schedule_others_toi_events(WorldData<Real>& w, int index, double from, ImpactSearch& search) {
  const SweptBody swept = w.scratch.continuous.swept_bodies[index];
  const Rotation<double> q = swept.rotation_at(from);
  const Pose<Real> pose{swept.position_at(from).template as<Real>(),
                        {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
  std::vector<std::pair<int, int>>& pairs = w.scratch.broad_phase.found_pairs;
  pairs.clear();
  for (int shape = w.bodies[swept.body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = effective_mask(w.shapes[shape].filter);
    if (w.shapes[shape].proxy == kNone || w.forms[shape].sensor || mask == 0) continue;
    w.dynamic_tree.query(convex_bounds(w.convex(shape), pose), mask, [&](int other, int) {
      if (find_swept_body(w, w.shapes[other].body) != nullptr && may_create_contact(w, shape, other))
        pairs.emplace_back(shape, other);
      return true;
    });
  }
  for (const auto& [shape, other] : pairs) {
    const int other_index = w.scratch.continuous.swept_index_of[w.shapes[other].body];
    const SweptBody& other_swept = w.scratch.continuous.swept_bodies[other_index];
    if (other_swept.stopped || move_as_one(w, swept, other_swept.body) || other_swept.pushed_by == swept.body)
      continue;
    // A kinematic body is not stopped, but pushes this one along.
    const bool pushes = !w.is_dynamic(other_swept.body);
    if (pushes && (swept.pushed_by != kNone || !w.is_dynamic(swept.body))) continue;
    const SweptPath path(pushes ? w.scratch.continuous.swept_bodies[index] : other_swept, from, search);
    const int moving = pushes ? shape : other, obstacle = pushes ? other : shape;
    ToiEvent found{.swept_body = pushes ? index : other_index, .version = path.swept.version};
    update_earliest_impact(w, path, {moving, obstacle, nullptr, !pushes}, found);
    push_toi_event(w, with_other_version(w, found));
  }
}

// Lifts a body off a surface that it rests on, instead of stopping it there. Returns false if lifting is not
// allowed.
template <class Real>
bool lift(WorldData<Real>& w, const ToiEvent& next, ImpactSearch& search, bool blocked_link = false) {
  SweptBody& swept = w.scratch.continuous.swept_bodies[next.swept_body];
  if (swept.impacts > 0 || (swept.changed && swept.lifts == 0)) return false;
  const SweptPair<Real> pair{next.shape, next.other, constraint_between(w, next.shape, next.other)};
  const SweptPath path(swept, next.fraction, search);
  const std::optional<Vec2d> by = lift_off(w, path, pair, 1, blocked_link);
  if (!by || *by == Vec2d{}) return false;
  swept.continue_lifted(next.fraction, *by);
  insert_swept_aabb(w, swept);
  schedule_toi_event(w, next.swept_body, next.fraction, search);
  schedule_others_toi_events(w, next.swept_body, next.fraction, search);
  return true;
}

// Stops a link of a mechanism alone if it begins the step where an obstacle in contact with it stopped it
// before: the solver moves it there again and again. Stopped as a whole in each step, a heap of ragdolls
// would hang in the air, and forces would still speed it up. The joints open by the link's way and close by
// and by. A link that slides over an edge is lifted off it, so that they open by the lift, not by its way.
// Returns false if it has moved.
template <class Real>
bool stop_blocked_link(WorldData<Real>& w, const ToiEvent& next, ImpactSearch& search) {
  SweptBody& swept = w.scratch.continuous.swept_bodies[next.swept_body];
  const int obstacle = w.shapes[next.other].body;
  if (swept.stopped || !is_blocked_link(w, swept, next.fraction) ||
      constraint_between(w, next.shape, next.other) == nullptr)
    return false;
  if (lift(w, next, search, true)) return true;
  std::vector<int>& stopped = w.scratch.continuous.stopped;
  stopped.assign(1, next.swept_body);
  if (!w.is_dynamic(obstacle)) remove_remaining_work(w, stopped, next.fraction, search.dt);
  swept.squeezed = swept.pushed_by != kNone;
  swept.stop_at(next.fraction);
  schedule_others_toi_events(w, next.swept_body, next.fraction, search);
  return true;
}

// Stops a body and all bodies connected to it by joints, so that the joints stay closed. Bodies that must be
// corrected for that move until the step's end, where other impacts may stop them. In the next step the
// contact hands on to a dynamic `obstacle` what forces add to them in the rest of this one; any other takes
// it up.
template <class Real>
void stop_island(WorldData<Real>& w, int index, int obstacle, double fraction, ImpactSearch& search) {
  std::vector<int>& stopped = w.scratch.continuous.stopped;
  stopped.clear();
  for_each_jointed(w, index, search.dt, [&](int jointed) {
    if (!w.scratch.continuous.swept_bodies[jointed].stopped) append(stopped, jointed);
  });
  const bool hands_on =
      w.is_dynamic(obstacle) && std::none_of(stopped.begin(), stopped.end(), [&](int jointed) {
        return w.scratch.continuous.swept_bodies[jointed].body == obstacle;
      });
  if (!hands_on) remove_remaining_work(w, stopped, fraction, search.dt);
  find_joint_corrections(w, stopped, fraction);
  for_each_jointed(w, index, search.dt, [&](int jointed) {
    SweptBody& swept = w.scratch.continuous.swept_bodies[jointed];
    if (swept.stopped) return;
    swept.squeezed = swept.pushed_by != kNone;
    const Vec2d joint_correction = swept.joint_correction;
    swept.stop_at(fraction);
    if (joint_correction != Vec2d{}) {
      swept.continue_lifted(fraction, joint_correction);
      insert_swept_aabb(w, swept);
      schedule_toi_event(w, jointed, fraction, search);
    }
    schedule_others_toi_events(w, jointed, fraction, search);
  });
}

// Lets a kinematic body push a body along, with all bodies connected to that by joints.
template <class Real>
void push_along(WorldData<Real>& w, int index, int pusher, double fraction, ImpactSearch& search) {
  for_each_jointed(w, index, search.dt, [&](int jointed) {
    SweptBody& swept = w.scratch.continuous.swept_bodies[jointed];
    if (swept.pushed_by != kNone) return;
    swept.continue_pushed(w.scratch.continuous.swept_bodies[pusher], fraction, w.bodies[swept.body].locks());
    insert_swept_aabb(w, swept);
    schedule_toi_event(w, jointed, fraction, search);
    schedule_others_toi_events(w, jointed, fraction, search);
  });
}

// Rebuilds the points of a contact in the next step: where a core has come too near, they are too far from
// the true ones. A needle would be let fall into the floor and lifted out of it in each step.
template <class Real>
void invalidate_points(WorldData<Real>& w, const ToiEvent& next) {
  if (const auto* const contact = constraint_between(w, next.shape, next.other))
    constraint_of(w, w.contacts[contact->contact]).recycle_budget = -1;
}

// Maximum number of bodies that move together. Each one that is added has all of them searched again, so that
// a crushed heap costs at most this many searches per body; beyond it, bodies are stopped.
constexpr std::size_t kMaxGroup = 32;

// Lets two dynamic bodies in contact, whose inner cores meet, move on as one, with all bodies connected to
// them by joints and those that already move with them. Stopping them would take away the motion that they
// have in common, in each step anew if they begin it that deep in each other. Returns false if they may not.
template <class Real>
bool continue_together(WorldData<Real>& w, const ToiEvent& next, int other_index, ImpactSearch& search) {
  if (!enabled(Switch::CommonMotion)) return false;
  if (other_index == kNone || constraint_between(w, next.shape, next.other) == nullptr) return false;
  std::vector<int>& members = w.scratch.continuous.stopped;
  members.clear();
  const auto add = [&](int index) {
    if (members.size() <= kMaxGroup && std::find(members.begin(), members.end(), index) == members.end())
      append(members, index);
  };
  for (const int index : {next.swept_body, other_index}) {
    const int group = w.scratch.continuous.swept_bodies[index].group;
    if (group == kNone) {
      for_each_jointed(w, index, search.dt, add);
      continue;
    }
    const int count = static_cast<int>(w.scratch.continuous.swept_bodies.size());
    for (int i = 0; i < count; ++i)
      if (w.scratch.continuous.swept_bodies[i].group == group) add(i);
  }
  if (members.size() > kMaxGroup || !may_move_together(w, members)) return false;
  move_together(w, members, next.fraction);
  for (const int index : members) insert_swept_aabb(w, w.scratch.continuous.swept_bodies[index]);
  for (const int index : members) {
    schedule_toi_event(w, index, next.fraction, search);
    schedule_others_toi_events(w, index, next.fraction, search);
  }
  return true;
}

// Fraction of a step between the impacts of two bodies that stay together after one. Between them, a corner
// that turns by w enters the other body by up to arm (w dt / 16)^2 / 2: 1.7 mm for 1 m at 60 rad/s. It is
// moved out at the next impact.
constexpr double kLastingInterval = 1.0 / 16;

// Returns true if an impact is so slow that the bodies would overlap by no more than the tolerance of impacts
// if it waited for the next one.
template <class Real>
bool is_slow_impact(const WorldData<Real>& w, const ToiEvent& at, double approach, double dt) {
  const double smaller = static_cast<double>(std::min(w.forms[at.shape].extent, w.forms[at.other].extent));
  return approach * dt * kLastingInterval < tuning::kImpactTolerance * smaller;
}

// Processes the next event. A stale one, of a body whose motion has changed since it was found, is dropped or
// searched again; so is one that the pre-solve hook disables.
template <class Real>
void process_toi_event(WorldData<Real>& w, const ToiEvent& next, ImpactSearch& search) {
  std::vector<SweptBody>& swept_bodies = w.scratch.continuous.swept_bodies;
  if (swept_bodies[next.swept_body].version != next.version) return;
  const int other_body = w.shapes[next.other].body;
  SweptBody* other = moving_swept_body(w, other_body, search.dt);
  SweptBody& swept = swept_bodies[next.swept_body];
  if ((other != nullptr && other->version != next.other_version) ||
      is_disabled_impact(w, swept, next.shape, other, next.other, next.fraction)) {
    schedule_toi_event(w, next.swept_body, next.fraction, search);
    return;
  }
  const int other_index = other == nullptr ? kNone : w.scratch.continuous.swept_index_of[other_body];
  const Real restitution = restitution_between(w, next.shape, next.other);
  const bool stay = stay_together(w, next.shape, next.other);
  const int max_impacts = restitution == 1          ? tuning::kMaxImpactsPerStep
                          : restitution > 0 || stay ? tuning::kMaxBouncesPerStep + tuning::kMaxLandingsPerStep
                                                    : tuning::kMaxLandingsPerStep;
  if (swept.resolves_impacts && swept.impacts < max_impacts &&
      may_resolve_toi_impact(w, next.shape, next.other, search.dt)) {
    const bool is_last = swept.impacts + 1 == max_impacts;
    const auto [resolved, approach] =
        resolve_toi_impact(w, swept, next.shape, other, next.other, next.fraction, search.dt, is_last);
    // Bodies that stay together would have endlessly many impacts at once, each at the speed of rounding.
    if (stay && (resolved ? next.lasts || is_slow_impact(w, next, approach, search.dt) : !next.lasts)) {
      ToiEvent later = next;
      later.fraction += kLastingInterval, later.lasts = true;
      later.version = swept.version, later.other_version = other->version;
      insert_swept_aabb(w, swept), insert_swept_aabb(w, *other);
      push_toi_event(w, later);
      return;
    }
    if (!resolved || is_last) swept.resolves_impacts = false;  // the bodies do not approach, or they slide on
    if (resolved) insert_swept_aabb(w, swept);
    const bool other_bounced = resolved && other != nullptr && w.is_dynamic(other->body);
    if (other_bounced) insert_swept_aabb(w, *other);
    schedule_toi_event(w, next.swept_body, next.fraction, search);
    if (other_bounced) schedule_toi_event(w, other_index, next.fraction, search);
    if (resolved) schedule_others_toi_events(w, next.swept_body, next.fraction, search);
    if (other_bounced) schedule_others_toi_events(w, other_index, next.fraction, search);
    return;
  }
  const bool by_kinematic = other != nullptr && !w.is_dynamic(other_body);
  if (by_kinematic && swept.pushed_by == kNone) {
    // Leave what joints hold in place to the solver, which pushes it as far as they let it: moved along, it
    // would open its joints farther in each step.
    if (constraint_between(w, next.shape, next.other) != nullptr && is_mechanism_held(w, swept.body)) {
      swept.is_held = true;
      schedule_toi_event(w, next.swept_body, next.fraction, search);
      return;
    }
    push_along(w, next.swept_body, other_index, next.fraction, search);
    return;
  }
  invalidate_points(w, next);
  if (lift(w, next, search)) return;
  const int pushed_by = swept.pushed_by;
  const bool pushes_other = pushed_by != kNone && other != nullptr && !by_kinematic &&
                            other->pushed_by == kNone && !other->squeezed;
  const bool over_limit = swept.impacts >= tuning::kMaxImpactsPerStep && other != nullptr && !by_kinematic;
  // From here on `swept` and `other` are invalid: bodies are added to the list.
  if (continue_together(w, next, other_index, search)) return;
  if (pushes_other) {
    // The pushed body pushes the other one along too.
    push_along(w, other_index, w.scratch.continuous.swept_index_of[pushed_by], next.fraction, search);
    schedule_toi_event(w, next.swept_body, next.fraction, search);
    return;
  }
  // The other body stops too, otherwise it would push this one further.
  if (over_limit) stop_island(w, other_index, w.shapes[next.shape].body, next.fraction, search);
  if (stop_blocked_link(w, next, search)) return;
  stop_island(w, next.swept_body, other_body, next.fraction, search);
}

// Processes impacts in the order of time until the step ends.
template <class Real>
void process_toi_queue(WorldData<Real>& w, ImpactSearch& search) {
  std::vector<ToiEvent>& toi_events = w.scratch.continuous.toi_events;
  // Reserve for four bodies with the maximum number of impacts per step, so that the list seldom grows.
  ensure_capacity(toi_events, 4 * tuning::kMaxImpactsPerStep);
  std::make_heap(toi_events.begin(), toi_events.end(), is_later);
  while (!toi_events.empty()) {
    std::pop_heap(toi_events.begin(), toi_events.end(), is_later);
    const ToiEvent next = toi_events.back();
    toi_events.pop_back();
    process_toi_event(w, next, search);
  }
}

// Finds impacts of dynamic bodies, even slow ones, with a fast kinematic body that passes them.
template <class Real>
void schedule_pusher_impacts(WorldData<Real>& w, int index, ImpactSearch& search) {
  const SweptBody pusher = w.scratch.continuous.swept_bodies[index];
  const auto add_impact = [&](int shape, int other, const ContactConstraint<Real>* contact) {
    const int body = w.shapes[shape].body;
    if (!RelativeMotionTest<Real>(w, body).is_fast(pusher.body)) return;
    const int swept_index = swept_body_index(w, body, search.dt);
    const SweptPath path(w.scratch.continuous.swept_bodies[swept_index], 0, search);
    ToiEvent found{.swept_body = swept_index, .version = path.swept.version};
    update_earliest_impact(w, path, {shape, other, contact}, found);
    if (found.fraction < 1) w.scratch.continuous.toi_events.push_back(with_other_version(w, found));
  };
  if (pusher.covered) {
    for_each_edge(w.contacts, w.bodies[pusher.body].first_contact,
                  [&](int edge, const ContactRecord& contact) {
                    const bool is_a = (edge & 1) == 0;
                    add_impact(is_a ? contact.shape_b : contact.shape_a,
                               is_a ? contact.shape_a : contact.shape_b, constraint_in(w, contact));
                  });
    return;
  }
  std::vector<std::pair<int, int>>& pairs = w.scratch.broad_phase.found_pairs;
  pairs.clear();
  const Aabb<Real> swept_aabb = swept_aabb_of(w, pusher);
  for (int shape = w.bodies[pusher.body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = effective_mask(w.shapes[shape].filter);
    if (w.shapes[shape].proxy == kNone || w.forms[shape].sensor || mask == 0) continue;
    w.dynamic_tree.query(swept_aabb, mask, [&](int other, int) {
      if (may_create_contact(w, shape, other)) pairs.emplace_back(other, shape);
      return true;
    });
  }
  for (const auto& [shape, other] : pairs) add_impact(shape, other, constraint_between(w, shape, other));
}

// Finds the first impacts of the dynamic bodies among the first `count` swept ones. Each block may use the
// whole budget of iterations. Returns false as soon as all blocks together have used more.
template <class Real>
bool find_first_impacts(WorldData<Real>& w, int count, ImpactSearch& search) {
  const int blocks = (count + kSweptOfBlock - 1) / kSweptOfBlock;
  std::atomic<std::int64_t> used_iterations{0};
  w.scratch.continuous.found_toi_events.begin(blocks);
  w.scheduler.blocks(blocks, [&](int block) {
    PrefetchContacts ahead;
    for (int i = block * kSweptOfBlock; i < std::min(count, (block + 1) * kSweptOfBlock); ++i) {
      ahead.advance(w, static_cast<std::size_t>(i));
      if (!w.is_dynamic(w.scratch.continuous.swept_bodies[i].body)) continue;
      if (used_iterations.load(std::memory_order_relaxed) > search.toi_iteration_budget) return;
      ImpactSearch own = search;
      const ToiEvent first = first_toi_event(w, i, 0, own);
      if (first.fraction < 1) w.scratch.continuous.found_toi_events.add(block, first);
      const int iterations = search.toi_iteration_budget - own.toi_iteration_budget;
      if (iterations > 0) used_iterations.fetch_add(iterations, std::memory_order_relaxed);
    }
  });
  if (used_iterations.load() > search.toi_iteration_budget) return false;
  search.toi_iteration_budget -= static_cast<int>(used_iterations.load());
  w.scratch.continuous.found_toi_events.for_each(
      [&](const ToiEvent& first) { append(w.scratch.continuous.toi_events, first); });
  return true;
}

// Inserts the swept AABBs of bodies whose fat AABB was updated to the end of their motion and does not
// contain the whole path.
template <class Real>
void insert_swept_aabbs(WorldData<Real>& w) {
  for (SweptBody& swept : w.scratch.continuous.swept_bodies)
    if (!swept.has_swept_aabb && w.enlarged[swept.body]) insert_swept_aabb(w, swept);
}

template <class Real>
void schedule_deep_contacts(WorldData<Real>& w, ImpactSearch& search) {
  for (const int id : w.scratch.continuous.deep_contacts) {
    const ContactRecord& contact = w.contacts[id];
    const auto half_width = [&](int body) { return w.bodies[body].half_width; };
    const bool is_a =
        w.is_dynamic(contact.body_a) &&
        (!w.is_dynamic(contact.body_b) || half_width(contact.body_a) < half_width(contact.body_b));
    const int swept_index = swept_body_index(w, is_a ? contact.body_a : contact.body_b, search.dt);
    const SweptPath path(w.scratch.continuous.swept_bodies[swept_index], 0, search);
    ToiEvent found{.swept_body = swept_index, .version = path.swept.version};
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    update_earliest_impact(w, path, {shape, other, constraint_in(w, contact)}, found);
    if (found.fraction < 1) w.scratch.continuous.toi_events.push_back(with_other_version(w, found));
  }
}

// Adds the swept bodies of fast bodies. Returns true if the fat AABBs of all contained their motions.
template <class Real>
bool add_fast_bodies(WorldData<Real>& w, double dt) {
  std::vector<SweptBody>& swept_bodies = w.scratch.continuous.swept_bodies;
  bool all_covered = true;
  for (const FastBody& fast : w.scratch.continuous.fast_bodies) {
    if (!(w.settings.continuous && w.extras_of(fast.body).continuous) && !fast.expected) continue;
    all_covered = all_covered && fast.covered;
    if (!w.scheduler.shares()) {
      SweptBody& swept = swept_bodies[swept_body_index(w, fast.body, dt)];
      swept.covered = fast.covered, swept.expected = fast.expected;
      continue;
    }
    w.scratch.continuous.swept_index_of[fast.body] = static_cast<int>(swept_bodies.size());
    SweptBody swept;
    swept.body = fast.body, swept.covered = fast.covered, swept.expected = fast.expected;
    append(swept_bodies, swept);
  }
  if (!w.scheduler.shares()) return all_covered;
  w.scheduler.ranges(static_cast<int>(swept_bodies.size()), kSweptOfBlock, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const SweptBody fast = swept_bodies[i];
      swept_bodies[i] = swept_body_of(w, fast.body, dt);
      set_arm(w, swept_bodies[i]);
      swept_bodies[i].covered = fast.covered, swept_bodies[i].expected = fast.expected;
    }
  });
  return all_covered;
}

}  // namespace

template <class Real>
void solve_continuous(WorldData<Real>& w, Real dt) {
  w.scratch.continuous.deep_contacts.clear(), w.scratch.continuous.swept_bodies.clear();
  if (w.settings.continuous) find_deep_contacts(w);
  if (w.scratch.continuous.fast_bodies.empty() && w.scratch.continuous.deep_contacts.empty()) return;
  find_loaded_bodies(w);
  const double time = static_cast<double>(dt);
  std::vector<SweptBody>& swept_bodies = w.scratch.continuous.swept_bodies;
  w.scratch.continuous.toi_events.clear();
  w.scratch.continuous.swept_index_of.assign(w.bodies.size(), kNone);
  const bool all_covered = add_fast_bodies(w, time);
  for (SweptBody& swept : swept_bodies)
    if (!swept.covered) insert_swept_aabb(w, swept);
  if (!all_covered) insert_swept_aabbs(w);
  // All impacts are found before any body is moved, so that two fast bodies see each other's whole motion.
  ImpactSearch search{
      .dt = time, .toi_iteration_budget = enabled(Switch::LongSearches) ? tuning::kToiIterationBudget : 0};
  const int fast_count = static_cast<int>(swept_bodies.size());
  if (!w.scheduler.shares() || !find_first_impacts(w, fast_count, search)) {
    // Each search gets the part of the budget that earlier searches have left.
    PrefetchContacts ahead;
    for (int i = 0; i < fast_count; ++i) {
      ahead.advance(w, static_cast<std::size_t>(i));
      const ToiEvent first = first_toi_event(w, i, 0, search);
      if (first.fraction < 1) append(w.scratch.continuous.toi_events, first);
    }
  }
  for (int i = 0; i < fast_count; ++i)
    if (!w.is_dynamic(swept_bodies[i].body)) schedule_pusher_impacts(w, i, search);
  schedule_deep_contacts(w, search);
  if (!w.scratch.continuous.toi_events.empty()) {
    insert_swept_aabbs(w);
    process_toi_queue(w, search);
  }
  for (const SweptBody& swept : swept_bodies) {
    if (swept.changed) {
      // A kinematic body that moves a sleeping one wakes it.
      wake_body(w, swept.body);
      commit_sweep(w, swept);
      for (int shape = w.bodies[swept.body].first_shape; shape != kNone; shape = w.shapes[shape].next)
        update_proxy(w, shape, dt, Real(0));
    }
    if (swept.has_swept_aabb) restore_fat_aabb(w, swept.body, dt);
  }
  w.scratch.continuous.swept_index_of.clear();
}

template void solve_continuous(WorldData<float>&, float);
template void solve_continuous(WorldData<double>&, double);

}  // namespace plumb
