#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "engine/core/room.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/direct_islands.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/islands/joint_gaps.h"
#include "engine/world/islands/jointed_islands.h"
#include "engine/world/solvers/restitution.h"
#include "engine/world/solvers/solvers.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// Returns the softness of a contact: as stiff as a substep of length `longest` permits. The impulse scale
// (compliance under load) is only kContactComplianceScale of the spring's.
template <class Real>
Softness<Real> contact_softness(double frequency_share, double h, double longest) {
  Softness<Real> soft = softness<Real>(frequency_share / longest, tuning::kContactDampingRatio, h);
  soft.impulse_scale *= Real(tuning::kContactComplianceScale);
  soft.mass_scale = 1 - soft.impulse_scale;
  return soft;
}

// Projects joints that an impact has driven beyond their limits.
template <class Real>
void project_angular_limits(WorldData<Real>& w) {
  bool any = true;
  for (int sweep = 0; any && sweep < tuning::kLimitSweeps; ++sweep) {
    any = w.joint_set.project_angular_limits(w.solver_bodies(), w.rotation.data(), Real(tuning::kLimitSlack),
                                             Real(tuning::kLimitTurn), &w.crew);
    if (any) enforce_motion_locks(w);
  }
}

// Returns true if no body is left to solve: each awake body was in free flight or is part of an articulated
// body.
template <class Real>
bool nothing_left(const WorldData<Real>& w) {
  const std::vector<VelocityIncrement<Real>>& kicks = w.scratch.kicks;
  return w.graph.empty() && std::all_of(kicks.begin(), kicks.end(), [](const auto& k) { return k.in_tree; });
}

// Returns marks, by record, of contacts that must not be solved in lanes: those with a second solver, which
// reads and changes them between the passes, and fast approaching discs without restitution. Empty if there
// are none.
template <class Real>
const std::vector<char>& contacts_apart(WorldData<Real>& w) {
  std::vector<char>& apart = w.scratch.apart;
  apart.clear();
  const auto mark = [&](const ContactConstraint<Real>& c) {
    if (apart.empty()) make_room(apart, w.contacts.size());
    apart[c.contact] = 1;
  };
  for (const RestitutionContact<Real>& bounce : w.scratch.bounces)
    if (!(bounce.contact->restitution > 0)) mark(*bounce.contact);
  for (int i = 0; i < w.scratch.jointed_count; ++i)
    for (const ContactConstraint<Real>* c : w.scratch.jointed[i].contacts) mark(*c);
  return apart;
}

// Returns marks, by slot, of the joints that are solved with their island. Empty if there are none.
template <class Real>
const std::vector<char>& joints_apart(WorldData<Real>& w) {
  std::vector<char>& apart = w.scratch.joints_apart;
  apart.clear();
  for (int i = 0; i < w.scratch.jointed_count; ++i) {
    for (const int joint : w.scratch.jointed[i].joints) {
      if (apart.empty()) make_room(apart, w.joint_set.slots());
      apart[joint] = 1;
    }
  }
  return apart;
}

// Returns true if any joint is solved by iterations: neither as part of an articulated body nor with its
// island.
template <class Real>
bool any_joint_swept(const WorldData<Real>& w) {
  std::size_t apart = static_cast<std::size_t>(w.scratch.trees.hinges);
  for (int i = 0; i < w.scratch.jointed_count; ++i) apart += w.scratch.jointed[i].joints.size();
  return static_cast<std::size_t>(w.joint_set.active_count()) > apart;
}

// Number of contacts with restitution in one task of a thread: some microseconds of work.
constexpr int kBouncesOfTask = 128;

// Calls `run` for parts of the contacts with restitution, shared among threads. Returns true if any call
// returned true.
template <class Real, class Run>
bool any_bounce(WorldData<Real>& w, const Run& run) {
  const std::span<RestitutionContact<Real>> all(w.scratch.bounces);
  std::atomic<bool> any = false;
  w.crew.ranges(static_cast<int>(all.size()), kBouncesOfTask, [&](int first, int last) {
    if (run(all.subspan(first, last - first))) any.store(true, std::memory_order_relaxed);
  });
  return any;
}

}  // namespace

template <class Real>
void solve_soft_steps(WorldData<Real>& w, double h, int substeps) {
  const Integrator integrator = w.settings.integrator;
  prepare_integration(w, h, substeps, integrator);
  move_hinge_trees(w, h, substeps);
  const bool jointed = w.joint_set.active_count() > w.scratch.trees.hinges;
  if (!jointed && nothing_left(w)) return;

  const Real warm_start = w.last_h > 0 ? static_cast<Real>(h / w.last_h) : Real(1);
  // A step shorter than the last one keeps the last one's stiffness, so that overlaps at rest do not change.
  const double longest = std::max(h, w.last_h);
  ContactStep<Real> contacts{
      .h = static_cast<Real>(h),
      .inverse_h = static_cast<Real>(1 / h),
      .softness = {{contact_softness<Real>(tuning::kContactFrequencyShare, h, longest)},
                   {contact_softness<Real>(tuning::kStiffFrequencyShare, h, longest)},
                   {{static_cast<Real>(tuning::kPushShare / h), 1, 0}}},
      .warm_start = warm_start,
      .bounce_threshold = bounce_threshold(w, h * substeps),
      .load_push_share = Real(tuning::kLoadPushShare)};
  const Softness<Real> rigid =
      softness<Real>(tuning::kJointFrequencyShare / h, tuning::kJointDampingRatio, h);
  JointStep<Real> joints{.h = static_cast<Real>(h),
                         .inverse_h = static_cast<Real>(1 / h),
                         .softness = rigid,
                         .stiffest = stiffest_spring<Real>(1),
                         .stiff_rate = rigid.bias_rate,
                         .warm_start = warm_start};
  const SolverBodies<Real> bodies = w.solver_bodies();
  prepare_direct_islands(w);
  if (jointed) w.joint_set.prepare(bodies, joints, joints_apart(w), &w.crew);
  const bool swept = jointed && any_joint_swept(w);
  collect_restitution_contacts(w);
  SoftContacts<Real>& passes = w.scratch.passes;
  passes.begin(w.graph, bodies.motion, contacts_apart(w), w.crew);
  using Bounce = RestitutionContact<Real>;
  const bool bounces = !w.scratch.bounces.empty();
  bool strikes = false;
  const auto place = [&] {
    strikes = any_bounce(
        w, [&](std::span<Bounce> some) { return schedule_impacts(bodies.motion, some, contacts); });
    strikes = strikes && propagate_impacts(w, contacts);
    if (!strikes) return;
    enforce_motion_locks(w);  // impact propagation ignores locks, and displaces bodies
  };
  for (int substep = 0; substep < substeps; ++substep) {
    if (bounces && substep > 0) passes.show_bounces();
    const bool parted =
        any_bounce(w, [&](std::span<Bounce> some) { return note_approaches(bodies.motion, some, contacts); });
    // Do not reuse the last substep's impulses after an impact, or if a contact separated.
    const bool repeat = substep > 0 && !jointed && !strikes && !parted;
    begin_jointed_substep(w);
    repeat ? integrate_and_warm_start(w) : integrate_velocities(w);
    // Find impacts before warm starting. Warm-start impulses cancel only in the solve; before that, they
    // would be mistaken for an approach velocity (those of an earlier impact threw heavy bodies up from light
    // ones). In substeps without impacts, warm starting follows.
    const bool place_first = !repeat;
    note_free_velocities(w);
    if (place_first) place();
    if (strikes) note_blows(w);
    if (swept) w.joint_set.warm_start(bodies, joints, &w.crew);
    if (!place_first) place();
    let_pass(std::span<Bounce>(w.scratch.bounces));
    if (bounces) passes.take_bounces();
    if (!repeat) passes.warm_start(bodies.motion, contacts);
    if (swept) w.joint_set.solve(bodies, joints, &w.crew);
    solve_direct_islands(w, contacts, true);
    passes.solve(bodies.motion, contacts);
    hold_jointed_islands(w, contacts);
    integrate_positions(w, static_cast<Real>(h), integrator);
    if (jointed) project_angular_limits(w);
    joints.looks = substep + 1 == substeps;
    if (jointed) w.joint_set.relax(bodies, joints, &w.crew);
    solve_direct_islands(w, contacts, false);
    passes.relax(bodies.motion, contacts);
    relax_jointed_islands(w, contacts, substep + 1 == substeps);
    hold_again(std::span<Bounce>(w.scratch.bounces));
    contacts.warm_start = joints.warm_start = 1;
  }
  if (jointed) close_joint_gaps(w, h, substeps);
  passes.finish();
  if (jointed) w.joint_set.finish(bodies, &w.crew);
  finish_direct_islands(w);
}

template void solve_soft_steps(WorldData<float>&, double, int);
template void solve_soft_steps(WorldData<double>&, double, int);

}  // namespace plumb
