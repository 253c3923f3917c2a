#include "engine/world/continuous/deep_contacts.h"

#include <algorithm>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Contacts per block of a shared loop: at least 10 us of work for a thread.
constexpr int kContactsOfBlock = 512;

}  // namespace

template <class Real>
void find_loaded_bodies(WorldData<Real>& w) {
  w.scratch.narrow_phase.has_contact_load.assign(w.bodies.size(), 0);
  w.graph.for_each([&](const ContactConstraint<Real>& c) {
    if (has_pressed(c)) return mark_contact_load(w, c);
    const Real near_gap =
        c.depenetration_speed * Real(tuning::kRecycleDistance / tuning::kDepenetrationSpeed);
    if (c.separation[0] > near_gap && (c.count < 2 || c.separation[1] > near_gap)) return;
    for (const int body : {c.body_a, c.body_b})
      if (w.scratch.narrow_phase.has_contact_load[body] == 0)
        w.scratch.narrow_phase.has_contact_load[body] = kMayHold;
  });
}

template <class Real>
void find_deep_contacts(WorldData<Real>& w) {
  const auto is_deep = [&](const ContactConstraint<Real>& c) {
    const Real depth = -std::min(c.current_separation[0], c.current_separation[1]);
    if (!(depth > Real(tuning::kCoreCheckOverlap / tuning::kDepenetrationSpeed) * c.depenetration_speed))
      return false;
    const auto half_width = [&](int body) { return w.bodies[body].half_width; };
    const bool a_dynamic = w.is_dynamic(c.body_a), b_dynamic = w.is_dynamic(c.body_b);
    const Real limit =
        (a_dynamic ? half_width(c.body_a) : Real(0)) + (b_dynamic ? half_width(c.body_b) : Real(0));
    return depth > Real(0.5 * tuning::kCoreDepth) * limit;
  };
  if (!w.scheduler.shares()) {
    w.graph.for_each([&](const ContactConstraint<Real>& c) {
      if (is_deep(c)) w.scratch.continuous.deep_contacts.push_back(c.contact);
    });
    return;
  }
  std::vector<ContactRun<Real>>& runs = w.scratch.narrow_phase.contact_runs;
  runs.clear();
  w.graph.for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool) {
    const int count = static_cast<int>(colour.size());
    for (int first = 0; first < count; first += kContactsOfBlock)
      append(runs, ContactRun<Real>{colour.data() + first, std::min(kContactsOfBlock, count - first), 0});
  });
  w.scratch.continuous.found_deep.begin(static_cast<int>(runs.size()));
  w.scheduler.blocks(static_cast<int>(runs.size()), [&](int block) {
    const ContactRun<Real>& run = runs[block];
    for (int i = 0; i < run.count; ++i)
      if (is_deep(run.first[i])) w.scratch.continuous.found_deep.add(block, run.first[i].contact);
  });
  w.scratch.continuous.found_deep.for_each(
      [&](int contact) { append(w.scratch.continuous.deep_contacts, contact); });
}

#define PLUMB_FOR(Real)                               \
  template void find_loaded_bodies(WorldData<Real>&); \
  template void find_deep_contacts(WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
