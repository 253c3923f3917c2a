#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/islands/contact_gains.h"
#include "engine/world/islands/direct_islands.h"
#include "engine/world/islands/hinge_trees.h"
#include "engine/world/islands/joint_gaps.h"
#include "engine/world/islands/jointed_islands.h"
#include "engine/world/solvers/driven_contacts.h"
#include "engine/world/solvers/restitution.h"
#include "engine/world/solvers/solvers.h"
#include "engine/world/solvers/turning_contacts.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/impulse_memory.h"

namespace plumb {
namespace {

// Returns the softness of a contact: as stiff as a substep of length `longest` permits. The impulse scale
// (compliance under load) is only kContactComplianceScale of the spring's. In a shorter substep the bias
// shrinks with it, as loads do: a bias that does not would leave its convergence error to all later steps.
template <class Real>
Softness<Real> contact_softness(double frequency_share, double h, double longest) {
  Softness<Real> soft = softness<Real>(frequency_share / longest, tuning::kContactDampingRatio, h);
  soft.impulse_scale *= Real(tuning::kContactComplianceScale);
  soft.mass_scale = 1 - soft.impulse_scale;
  soft.bias_rate *= static_cast<Real>(h / longest);
  return soft;
}

// Projects joints that an impact has driven beyond their limits.
template <class Real>
void project_angular_limits(WorldData<Real>& w) {
  if (!enabled(Switch::AngularLimits)) return;
  bool any = true;
  for (int iteration = 0; any && iteration < tuning::kLimitIterations; ++iteration) {
    any = w.joint_set.project_angular_limits(w.solver_bodies(), w.rotation.data(), Real(tuning::kLimitSlack),
                                             Real(tuning::kLimitMaxRotation), &w.scheduler);
    if (any) enforce_motion_locks(w);
  }
}

// Returns true if all awake bodies have been moved: in free flight, or as part of an articulated body.
template <class Real>
bool all_bodies_moved(const WorldData<Real>& w) {
  const std::vector<VelocityIncrement<Real>>& increments = w.scratch.solver.velocity_increments;
  return w.graph.empty() &&
         std::all_of(increments.begin(), increments.end(), [](const auto& k) { return k.in_tree; });
}

// Returns marks, by record, of contacts that must not be solved in SIMD lanes: those that a second solver
// changes between the passes, and fast approaching circles without restitution. Empty if there are none.
template <class Real>
const std::vector<char>& scalar_contacts(WorldData<Real>& w) {
  std::vector<char>& marks = w.scratch.solver.is_scalar;
  marks.clear();
  const auto mark = [&](const ContactConstraint<Real>& c) {
    if (marks.empty()) resize_with_growth(marks, w.contacts.size());
    marks[c.contact] = 1;
  };
  for (const RestitutionContact<Real>& bounce : w.scratch.solver.restitution_contacts)
    if (!(bounce.contact->restitution > 0)) mark(*bounce.contact);
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i)
    for (const ContactConstraint<Real>* c : w.scratch.islands.jointed_islands[i].contacts) mark(*c);
  for (const int id : w.scratch.narrow_phase.turning_contacts) mark(constraint_of(w, w.contacts[id]));
  return marks;
}

// Returns marks, by slot, of the joints that are solved with their island. Empty if there are none.
template <class Real>
const std::vector<char>& joints_in_islands(WorldData<Real>& w) {
  std::vector<char>& marks = w.scratch.islands.joints_in_islands;
  marks.clear();
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i) {
    for (const int joint : w.scratch.islands.jointed_islands[i].joints) {
      if (marks.empty()) resize_with_growth(marks, w.joint_set.slots());
      marks[joint] = 1;
    }
  }
  return marks;
}

// Returns true if any joint is solved by iterations: neither as part of an articulated body nor with its
// island.
template <class Real>
bool any_joint_iterated(const WorldData<Real>& w) {
  std::size_t others = static_cast<std::size_t>(w.scratch.islands.trees.hinge_count);
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i)
    others += w.scratch.islands.jointed_islands[i].joints.size();
  return static_cast<std::size_t>(w.joint_set.active_count()) > others;
}

// Adds the impulses of a substep to the loads of joints that are solved with their island.
template <class Real>
void add_island_loads(WorldData<Real>& w, const JointStep<Real>& step) {
  for (int i = 0; i < w.scratch.islands.jointed_count; ++i)
    for (const int joint : w.scratch.islands.jointed_islands[i].joints)
      w.joint_set.add_load(joint, w.solver_bodies(), step);
}

// Number of contacts with restitution in one task of a thread: some microseconds of work.
constexpr int kBouncesPerTask = 128;

// Calls `run` for parts of the contacts with restitution, shared among threads. Returns true if any call
// returned true.
template <class Real, class Run>
bool any_bounce(WorldData<Real>& w, const Run& run) {
  const std::span<RestitutionContact<Real>> all(w.scratch.solver.restitution_contacts);
  std::atomic<bool> any = false;
  w.scheduler.ranges(static_cast<int>(all.size()), kBouncesPerTask, [&](int first, int last) {
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
  const bool jointed = w.joint_set.active_count() > w.scratch.islands.trees.hinge_count;
  if (!jointed && all_bodies_moved(w)) return;

  const bool ramps = ramp_kinematic_velocities(w, h, substeps);
  const Real warm_start = static_cast<Real>(warm_start_ratio(w, h));
  // A step shorter than those before keeps their stiffness, so that overlaps at rest do not change.
  const double longest = std::max(h, w.impulse_h), length_ratio = h / longest;
  const Softness<Real> stiff = contact_softness<Real>(tuning::kStiffFrequencyRatio, h, longest),
                       direct{static_cast<Real>(length_ratio * tuning::kDirectPushFraction / longest), 1, 0};
  ContactStep<Real> contacts{
      .h = static_cast<Real>(h),
      .inverse_h = static_cast<Real>(1 / h),
      .softness = {{contact_softness<Real>(tuning::kContactFrequencyRatio, h, longest)},
                   {stiff},
                   {direct},
                   {{stiff.bias_rate, 1, 0}},  // driven ones yield in their own way
                   {direct}},
      .warm_start = warm_start,
      .bounce_threshold = bounce_threshold(w, h * substeps),
      .load_push_fraction = Real(tuning::kLoadPushFraction)};
  const Softness<Real> rigid =
      softness<Real>(tuning::kJointFrequencyRatio / h, tuning::kJointDampingRatio, h);
  Softness<Real> joint_softness = rigid;
  joint_softness.bias_rate *= static_cast<Real>(length_ratio * length_ratio);  // rigid's goes with 1 / h
  JointStep<Real> joints{.h = static_cast<Real>(h),
                         .inverse_h = static_cast<Real>(1 / h),
                         .inverse_dt = static_cast<Real>(1 / (h * substeps)),
                         .softness = joint_softness,
                         .max_stiffness = max_spring_stiffness<Real>(1),
                         .stiff_rate = rigid.bias_rate,
                         .warm_start = warm_start};
  const SolverBodies<Real> bodies = w.solver_bodies();
  const bool driven = mark_driven_contacts(w);
  prepare_direct_islands(w, static_cast<Real>(h * substeps));
  if (driven) set_driver_loads(w);
  begin_contact_gains(w, static_cast<Real>(h * substeps));
  if (jointed) w.joint_set.prepare(bodies, joints, joints_in_islands(w), &w.scheduler);
  const bool iterated = jointed && any_joint_iterated(w);
  collect_restitution_contacts(w);
  collect_turning_contacts(w);
  SoftContacts<Real>& soft_contacts = w.scratch.solver.soft_contacts;
  soft_contacts.prepare(w.graph, bodies.motion, scalar_contacts(w), w.scheduler);
  using Bounce = RestitutionContact<Real>;
  const bool bounces = !w.scratch.solver.restitution_contacts.empty();
  stop_joint_rates(w);
  bool has_impacts = false;
  const auto handle_impacts = [&] {
    has_impacts = any_bounce(
        w, [&](std::span<Bounce> some) { return schedule_impacts(bodies.motion, some, contacts); });
    has_impacts = has_impacts && propagate_impacts(w, contacts);
    if (!has_impacts) return;
    enforce_motion_locks(w);  // impact propagation ignores locks, and displaces bodies
  };
  for (int substep = 0; substep < substeps; ++substep) {
    if (bounces && substep > 0) soft_contacts.scatter_restitution();
    const bool separated = any_bounce(
        w, [&](std::span<Bounce> some) { return record_approaches(bodies.motion, some, contacts); });
    // Do not reuse the last substep's impulses after an impact, or if a contact separated.
    const bool renewed = substep > 0 && renew_turning_contacts(w, static_cast<Real>(h));
    const bool fuse_warm_start = substep > 0 && !jointed && w.scratch.islands.jointed_count == 0 &&
                                 !has_impacts && !separated && !renewed;
    begin_jointed_substep(w);
    fuse_warm_start ? integrate_and_warm_start(w) : integrate_velocities(w);
    // Find impacts before warm starting. Warm-start impulses cancel only in the solve; before that, they
    // would be mistaken for an approach velocity (those of an earlier impact threw heavy bodies up from light
    // ones). In substeps without impacts, warm starting follows.
    const bool impacts_first = !fuse_warm_start;
    save_free_velocities(w);
    if (impacts_first) handle_impacts();
    if (has_impacts) add_impact_velocities(w);
    if (iterated) w.joint_set.warm_start(bodies, joints, &w.scheduler);
    if (!impacts_first) handle_impacts();
    defer_impacts(std::span<Bounce>(w.scratch.solver.restitution_contacts));
    if (bounces) soft_contacts.gather_restitution();
    if (!fuse_warm_start) soft_contacts.warm_start(bodies.motion, contacts);
    if (iterated) w.joint_set.solve(bodies, joints, &w.scheduler);
    solve_direct_islands(w, contacts, true);
    soft_contacts.solve(bodies.motion, contacts);
    solve_turning_contacts(w, contacts);
    solve_jointed_islands(w, contacts);
    integrate_positions(w, static_cast<Real>(h), integrator);
    if (jointed) project_angular_limits(w);
    joints.evaluates_all = substep + 1 == substeps;
    if (jointed) w.joint_set.relax(bodies, joints, &w.scheduler);
    solve_direct_islands(w, contacts, false);
    soft_contacts.relax(bodies.motion, contacts);
    relax_jointed_islands(w, contacts, substep + 1 == substeps);
    bound_contact_gains(w, contacts);
    add_island_loads(w, joints);
    restore_deferred(std::span<Bounce>(w.scratch.solver.restitution_contacts));
    contacts.warm_start = joints.warm_start = 1;
  }
  if (ramps) end_kinematic_ramps(w, h, substeps);
  soft_contacts.finish();
  if (jointed) w.joint_set.store_results(&w.scheduler);
  if (jointed) close_joint_gaps(w, h, substeps);
  if (jointed) w.joint_set.finish(bodies, &w.scheduler);
  if (jointed) add_impact_loads(w, joints);
  finish_direct_islands(w);
  if (driven) unmark_driven_contacts(w);
}

template void solve_soft_steps(WorldData<float>&, double, int);
template void solve_soft_steps(WorldData<double>&, double, int);

}  // namespace plumb
