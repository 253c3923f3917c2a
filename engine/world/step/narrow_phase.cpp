#include <algorithm>
#include <utility>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/step/contact_update.h"
#include "engine/world/step/expected_impacts.h"
#include "engine/world/step/open_joints.h"
#include "engine/world/step/pushers.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Updates the touching state that events report.
template <class Real>
void update_touching(WorldData<Real>& w, ContactConstraint<Real>& c, bool touching) {
  const ContactRecord& contact = w.contacts[c.contact];
  set_touching(w, c.contact, touching);
  c.touching = touching;
  c.tracking = tracking_of(contact, c);
  c.max_normal_impulse[0] = c.max_normal_impulse[1] = c.step_impulse = 0;
  if (c.tracking == ImpactTracking::Off) c.approach[0] = c.approach[1] = 0;
}

// Contacts per block of a shared loop: 10 to 100 us of work.
constexpr int kNontouchingPerBlock = 128, kContactsPerBlock = 128;

// Cuts the graph's colours into blocks.
template <class Real>
void find_contact_runs(WorldData<Real>& w) {
  std::vector<ContactRun<Real>>& runs = w.scratch.narrow_phase.contact_runs;
  runs.clear();
  // This comes first: if memory runs out, no changes of any run have been recorded.
  std::vector<std::uint8_t>& changes = w.scratch.narrow_phase.contact_changes;
  resize_with_growth(changes, static_cast<int>(w.nontouching_contacts.size() + w.graph.size()));
  std::fill(changes.begin(), changes.end(), std::uint8_t{0});
  std::vector<std::uint8_t>& faces = w.scratch.narrow_phase.separating_faces;
  if (static_cast<int>(faces.size()) < w.contacts.size()) {
    ensure_capacity(faces, static_cast<std::size_t>(w.contacts.size()));
    faces.resize(static_cast<std::size_t>(w.contacts.size()), kNoFace);
  }
  int place = static_cast<int>(w.nontouching_contacts.size());
  w.graph.for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool) {
    const int count = static_cast<int>(colour.size());
    for (int first = 0; first < count; first += kContactsPerBlock) {
      const int size = std::min(kContactsPerBlock, count - first);
      append(runs, ContactRun<Real>{colour.data() + first, size, place});
      place += size;
    }
  });
}

// Stores the new impulses of a run's rebuilt contacts.
template <class Real>
void store_rebuilt_impulses(WorldData<Real>& w, const ContactRun<Real>& run, Real dt) {
  std::uint8_t* const changes = w.scratch.narrow_phase.contact_changes.data() + run.first_index;
  for (int i = 0; i < run.count; ++i) {
    if ((changes[i] & kRebuilt) == 0) continue;
    ContactConstraint<Real>& c = run.first[i];
    c.normal_impulse[0] = c.current_separation[0], c.normal_impulse[1] = c.current_separation[1];
    if ((changes[i] & (kEnded | kNeedsPreSolve)) == 0 && begin_contact_step(w, c, dt)) changes[i] |= kBounces;
  }
}

// Updates all contacts independently; changes that affect others are recorded.
template <class Real>
void update_each(WorldData<Real>& w, Real dt, Real h) {
  Scratch<Real>& scratch = w.scratch;
  find_contact_runs(w);
  const int nontouching_count = static_cast<int>(w.nontouching_contacts.size()),
            nontouching_blocks = (nontouching_count + kNontouchingPerBlock - 1) / kNontouchingPerBlock;
  const std::vector<ContactRun<Real>>& runs = scratch.narrow_phase.contact_runs;
  const int blocks = nontouching_blocks + static_cast<int>(runs.size());
  scratch.narrow_phase.begun_contacts.begin(blocks), scratch.narrow_phase.found_impacts.begin(blocks);
  scratch.narrow_phase.found_loaded.begin(blocks), scratch.narrow_phase.found_turning.begin(blocks);
  std::uint8_t* const changes = scratch.narrow_phase.contact_changes.data();
  // By run: the union of its contacts' changes.
  std::vector<int>& any = scratch.block_firsts;
  any.assign(runs.size(), 0);
  scratch.narrow_phase.has_contact_load.assign(w.bodies.size(), 0);
  scratch.narrow_phase.pushers.assign(w.bodies.size(), kNone);
  const LoopScheduler::SerialGuard serial(w.scheduler, w.has_rules());
  const bool shared = w.scheduler.shares();
  const auto recycle = [&](int block) {
    const ContactRun<Real> run = runs[block];
    for (int i = 0; i < run.count; ++i) {
      const int change = recycle_contact(w, run.first[i], dt, shared);
      if (change == 0) continue;
      changes[run.first_index + i] = static_cast<std::uint8_t>(change);
      any[block] |= change;
    }
  };
  const auto update = [&](int block) {
    if (block < nontouching_blocks) {
      const int first = block * kNontouchingPerBlock,
                count = std::min(kNontouchingPerBlock, nontouching_count - first);
      const int* const ids = w.nontouching_contacts.data() + first;
      for (int i = 0; i < count; ++i) {
        prefetch_contacts(w, i, count, [&](int k) { return ids[k]; });
        changes[first + i] = static_cast<std::uint8_t>(update_nontouching(w, block, ids[i], dt, h));
      }
      return;
    }
    const int all = any[block - nontouching_blocks];
    if ((all & (kStale | kLeftFatAabb)) == 0) return;
    const ContactRun<Real> run = runs[block - nontouching_blocks];
    int places[kContactsPerBlock], count = 0;
    for (int i = 0; i < run.count; ++i)
      if ((changes[run.first_index + i] & (kStale | kLeftFatAabb)) != 0) places[count++] = i;
    for (int i = 0; i < count; ++i) {
      prefetch_contacts(w, i, count, [&](int k) { return run.first[places[k]].contact; });
      std::uint8_t& change = changes[run.first_index + places[i]];
      change = static_cast<std::uint8_t>(rebuild_contact(w, block, run.first[places[i]], change, dt, h));
      any[block - nontouching_blocks] |= change;
    }
  };
  const auto store = [&](int block) {
    if ((any[block] & kRebuilt) != 0) store_rebuilt_impulses(w, runs[block], dt);
  };
  const int run_count = static_cast<int>(runs.size());
  w.scheduler.session([&] {
    w.scheduler.blocks(run_count, recycle);
    w.scheduler.blocks(blocks, update);
    w.scheduler.blocks(run_count, store);
  });
}

// After an exception, makes the next step recompute the points of the contacts.
template <class Real>
void invalidate_all(WorldData<Real>& w) {
  for (const ContactRun<Real>& run : w.scratch.narrow_phase.contact_runs) {
    for (int i = 0; i < run.count; ++i) {
      ContactConstraint<Real>& c = run.first[i];
      if ((w.scratch.narrow_phase.contact_changes[run.first_index + i] & kRebuilt) != 0)
        c.normal_impulse[0] = c.current_separation[0], c.normal_impulse[1] = c.current_separation[1];
      c.recycle_budget = -1;
    }
  }
}

// Calls the user's pre-solve hook for a contact. Returns false if the hook disables it in this step.
template <class Real>
bool passes_pre_solve_hook(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  const ContactRecord& contact = w.contacts[c.contact];
  if (w.pre_solve(contact, c)) return true;
  w.disabled_pairs.insert(contact.shape_a, contact.shape_b);
  return false;
}

// Calls the user's pre-solve hook for impacts that are expected in flight, unless they have points already
// and were decided with the contacts. Continuous collision does not call it again for those that are enabled.
template <class Real>
void decide_impacts_by_hook(WorldData<Real>& w) {
  w.scratch.narrow_phase.found_impacts.for_each([&](const ExpectedImpact<Real>& impact) {
    const int id = impact.constraint.contact;
    const ContactRecord& contact = w.contacts[id];
    if (!contact.pre_solve) return;
    const bool disabled = impact.in_graph ? w.disabled_pairs.contains(contact.shape_a, contact.shape_b)
                                          : !passes_pre_solve_hook(w, impact.constraint);
    if (!disabled) {
      w.enabled_pairs.insert(contact.shape_a, contact.shape_b);
    } else if (!impact.in_graph && contact.touching) {
      append(w.scratch.narrow_phase.bounced_contacts, id);
    }
  });
}

// Calls the user's pre-solve hook for contacts with new points and for expected impacts, on the calling
// thread and in their order.
template <class Real>
void call_pre_solve_hook(WorldData<Real>& w, Real dt) {
  if (!w.pre_solve) return;
  w.scratch.narrow_phase.begun_contacts.for_each([&](BegunContact<Real>& begun) {
    if (!begun.needs_pre_solve) return;
    begun.disabled = !passes_pre_solve_hook(w, begun.constraint);
    if (!begun.disabled) begun.bounces = begin_contact_step(w, begun.constraint, dt);
  });
  for (const ContactRun<Real>& run : w.scratch.narrow_phase.contact_runs) {
    for (int i = 0; i < run.count; ++i) {
      std::uint8_t& change = w.scratch.narrow_phase.contact_changes[run.first_index + i];
      if ((change & kNeedsPreSolve) == 0) continue;
      ContactConstraint<Real>& c = run.first[i];
      if (!passes_pre_solve_hook(w, c)) {
        change |= kEnded;
      } else if (begin_contact_step(w, c, dt)) {
        change |= kBounces;
      }
    }
  }
  decide_impacts_by_hook(w);
}

// Ends the contacts that are disabled in this step, by the hook or because they yield to an open joint,
// unless they are destroyed.
template <class Real>
void end_disabled_contacts(WorldData<Real>& w) {
  if (w.disabled_pairs.size() == 0) return;
  const auto is_disabled = [&](const ContactConstraint<Real>& c) {
    const ContactRecord& contact = w.contacts[c.contact];
    return w.disabled_pairs.contains(contact.shape_a, contact.shape_b);
  };
  w.scratch.narrow_phase.begun_contacts.for_each(
      [&](BegunContact<Real>& begun) { begun.disabled = begun.disabled || is_disabled(begun.constraint); });
  for (std::size_t block = 0; block < w.scratch.narrow_phase.contact_runs.size(); ++block) {
    const ContactRun<Real>& run = w.scratch.narrow_phase.contact_runs[block];
    for (int i = 0; i < run.count; ++i) {
      std::uint8_t& change = w.scratch.narrow_phase.contact_changes[run.first_index + i];
      if ((change & kSeparated) != 0 || !is_disabled(run.first[i])) continue;
      change |= kEnded;
      w.scratch.block_firsts[block] |= kEnded;
    }
  }
}

// Collects the recorded changes, in the order of the contacts.
template <class Real>
void collect_changes(WorldData<Real>& w) {
  Scratch<Real>& scratch = w.scratch;
  scratch.narrow_phase.begun_contacts.for_each([&](const BegunContact<Real>& begun) {
    if (begun.disabled) return;
    const ContactConstraint<Real>& c = begun.constraint;
    if (begun.bounces) append(scratch.narrow_phase.bounce_candidates, c.contact);
    if (begun.loaded) mark_loaded(w, c.body_a, c.body_b);
  });
  scratch.narrow_phase.found_loaded.for_each(
      [&](const std::pair<int, int>& bodies) { mark_loaded(w, bodies.first, bodies.second); });
  scratch.narrow_phase.found_turning.for_each(
      [&](int id) { append(scratch.narrow_phase.turning_contacts, id); });
  scratch.narrow_phase.found_impacts.for_each([&](const ExpectedImpact<Real>& impact) {
    const ContactRecord& contact = w.contacts[impact.constraint.contact];
    if (w.disabled_pairs.size() == 0 || !w.disabled_pairs.contains(contact.shape_a, contact.shape_b))
      append(scratch.narrow_phase.expected_impacts, impact);
  });
  const std::vector<std::uint8_t>& changes = scratch.narrow_phase.contact_changes;
  for (std::size_t i = 0; i < w.nontouching_contacts.size(); ++i) {
    if ((changes[i] & kSeparated) != 0)
      append(scratch.narrow_phase.separated_contacts, w.nontouching_contacts[i]);
    if ((changes[i] & kTouchChange) != 0)
      append(scratch.narrow_phase.bounced_contacts, w.nontouching_contacts[i]);
  }
  constexpr int kCollected = kTouchChange | kSeparated | kEnded | kBounces;
  for (std::size_t block = 0; block < scratch.narrow_phase.contact_runs.size(); ++block) {
    const ContactRun<Real>& run = scratch.narrow_phase.contact_runs[block];
    // Rebuilt contacts may bounce, too.
    if ((scratch.block_firsts[block] & (kCollected | kRebuilt)) == 0) continue;
    for (int i = 0; i < run.count; ++i) {
      const int change = changes[run.first_index + i];
      if ((change & kCollected) == 0) continue;
      const int id = run.first[i].contact;
      if ((change & kTouchChange) != 0) append(scratch.narrow_phase.touch_changes, id);
      if ((change & kSeparated) != 0) append(scratch.narrow_phase.separated_contacts, id);
      if ((change & kEnded) != 0) append(scratch.narrow_phase.ended_contacts, id);
      if ((change & kBounces) != 0) append(scratch.narrow_phase.bounce_candidates, id);
    }
  }
}

// Leaves predicted impacts that do not happen in free flight to the solver.
template <class Real>
void resolve_expected_impacts(WorldData<Real>& w, Real dt) {
  decide_expected_impacts(w, dt);
  w.scratch.narrow_phase.solver_impacts.clear();
  for (ExpectedImpact<Real>& impact : w.scratch.narrow_phase.expected_impacts) {
    ContactConstraint<Real>& c = impact.constraint;
    if (impact.in_graph) {
      if (!impact.left_to_solver) append(w.scratch.narrow_phase.ended_contacts, c.contact);
    } else if (impact.left_to_solver) {
      if (begin_contact_step(w, c, dt)) append(w.scratch.narrow_phase.bounce_candidates, c.contact);
      append(w.scratch.narrow_phase.solver_impacts, c);
      if (turns_in_step(w, c, dt)) append(w.scratch.narrow_phase.turning_contacts, c.contact);
    } else {
      wake_body(w, c.body_a), wake_body(w, c.body_b);
    }
  }
}

// Moves a contact that has got its first points to the graph.
template <class Real>
void add_to_graph(WorldData<Real>& w, const ContactConstraint<Real>& c) {
  const int id = c.contact;
  const bool touching = has_touched(c);
  begin_contact(w, id, c);
  if (touching || w.contacts[id].touching) update_touching(w, constraint_of(w, w.contacts[id]), touching);
}

// Begins the step of contacts whose bodies this update has woken: within the step, an
// impact may push a woken body into a neighbour.
template <class Real>
void begin_woken_contacts(WorldData<Real>& w, Real dt) {
  for (const int id : w.scratch.narrow_phase.woken_contacts) {
    if (w.contacts[id].home != ContactHome::Graph) continue;
    if (begin_contact_step(w, constraint_of(w, w.contacts[id]), dt))
      append(w.scratch.narrow_phase.bounce_candidates, id);
  }
  w.scratch.narrow_phase.woken_contacts.clear();
}

}  // namespace

template <class Real>
void update_contacts(WorldData<Real>& w, Real dt, Real h) {
  auto& scratch = w.scratch;
  scratch.narrow_phase.separated_contacts.clear(), scratch.narrow_phase.ended_contacts.clear(),
      scratch.narrow_phase.touch_changes.clear();
  scratch.narrow_phase.bounce_candidates.clear(), scratch.narrow_phase.bounced_contacts.clear(),
      scratch.narrow_phase.woken_contacts.clear();
  scratch.narrow_phase.turning_contacts.clear();
  clear_expected_impacts(w);
  if (w.disabled_pairs.size() > 0) w.disabled_pairs.clear();
  if (w.enabled_pairs.size() > 0) w.enabled_pairs.clear();
  if (w.nontouching_contacts.empty() && w.graph.empty()) return;
  try {
    yield_to_open_joints(w);
    update_each(w, dt, h);
    call_pre_solve_hook(w, dt);
    end_disabled_contacts(w);
    collect_changes(w);
  } catch (...) {
    invalidate_all(w);
    throw;
  }
  resolve_expected_impacts(w, dt);
  for (const int id : scratch.narrow_phase.touch_changes) {
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    update_touching(w, c, !c.touching);
  }
  for (const int id : scratch.narrow_phase.bounced_contacts) set_touching(w, id, false);
  for (const int id : scratch.narrow_phase.separated_contacts) destroy_contact(w, id);
  for (const int id : scratch.narrow_phase.ended_contacts) end_contact(w, id);
  scratch.narrow_phase.begun_contacts.for_each([&](const BegunContact<Real>& begun) {
    if (begun.disabled) {
      set_touching(w, begun.constraint.contact, false);
    } else {
      add_to_graph(w, begun.constraint);
    }
  });
  for (const ContactConstraint<Real>& c : scratch.narrow_phase.solver_impacts) add_to_graph(w, c);
  begin_woken_contacts(w, dt);
}

template <class Real>
void report_impacts(WorldData<Real>& w) {
  const auto had_impact = [](const ContactConstraint<Real>& c) {
    return c.max_normal_impulse[0] > 0 || (c.count == 2 && c.max_normal_impulse[1] > 0);
  };
  for (const int id : w.scratch.narrow_phase.bounce_candidates) {
    if (w.contacts[id].home != ContactHome::Graph) continue;
    ContactConstraint<Real>& c = constraint_of(w, w.contacts[id]);
    if (had_impact(c)) set_touching(w, id, true);
  }
  if (!w.reports_hits) return;
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const ContactRecord& contact = w.contacts[c.contact];
    if (!contact.hit_events) return;
    const int hardest = c.count == 2 && c.approach[1] < c.approach[0] ? 1 : 0;
    if (c.max_normal_impulse[hardest] == 0 || c.approach[hardest] > -min_hit_speed(w, c)) return;
    set_touching(w, c.contact, true);
    const ContactReading reading = reading_of(w, contact, c);
    w.event_buffer().hits.push_back({reading.shape_a, reading.shape_b, reading.points[hardest],
                                     reading.normal, -static_cast<double>(c.approach[hardest]),
                                     reading.step_impulse});
  });
}

template void report_impacts(WorldData<float>&);
template void report_impacts(WorldData<double>&);
template void update_contacts(WorldData<float>&, float, float);
template void update_contacts(WorldData<double>&, double, double);

}  // namespace plumb
