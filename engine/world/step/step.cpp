#include "engine/world/step/step.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "engine/math/trigonometry.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/step_rollback.h"

namespace plumb {
namespace {

// kMaxSubstepGrowth: maximum ratio of a substep to the last one. kMaxSubstepFactor: maximum factor on the
// requested substeps for keeping this ratio. A pyramid of 12 rows rests under steps of random lengths from 1
// to 10 as under equal ones. With a ratio of 1.1 it creeps ten times as fast; without a bound it explodes at
// lengths of 1 and 3 in turn. A step over 60 times as long as the last disturbs resting bodies.
constexpr double kMaxSubstepGrowth = 1.02;
constexpr int kMaxSubstepFactor = 16;

// While this guard is alive, events go into the current step's buffer. Events raised between two steps are
// reported with the later step.
template <class Real>
struct StepGuard {
  explicit StepGuard(WorldData<Real>& world) : w(world) {
    std::swap(w.events, w.pending);
    w.pending.clear();
    forget_motion(w);
    w.stepping = true;
  }
  ~StepGuard() {
    w.stepping = false;
    end_use(w);
  }
  WorldData<Real>& w;
};

// Restores a consistent state after an interrupted step: rotations match angles, and fat AABBs contain their
// shapes.
template <class Real>
void restore_consistency(WorldData<Real>& w) {
  w.topology_changed = true;  // islands and articulated bodies are found again
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    c.hardness =
        w.is_dynamic(c.body_a) && w.is_dynamic(c.body_b) ? ContactHardness::Soft : ContactHardness::Stiff;
  });
  for (const int body : w.awake) {
    const Rotation<double> q = rotation_of(w.bodies[body].angle);
    w.rotation[body] = {static_cast<Real>(q.c), static_cast<Real>(q.s)};
    w.motion[body].delta_position = {}, w.motion[body].delta_angle = 0;
    // Direct islands may have increased the inertia of links.
    const BodyRecord<Real>& record = w.bodies[body];
    if (record.type == BodyType::Dynamic) {
      w.motion[body].inverse_mass = inverse_mass_of(record, record.mass);
      w.motion[body].inverse_inertia =
          record.lock_rotation || !(record.inertia > 0) ? Real(0) : 1 / record.inertia;
    }
    for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
      const int proxy = w.shapes[shape].proxy;
      w.tight_aabbs[shape] = tight_aabb(w, shape);
      if (proxy == kNone || w.dynamic_tree.box(proxy).contains(w.tight_aabbs[shape])) continue;
      w.dynamic_tree.enlarge(proxy, fat_aabb(w, shape, Real(0)));
      w.enlarged[body] = 1;
      try {
        add_to_move_buffer(w, shape);
      } catch (const std::bad_alloc&) {
        // The shape is added when it next leaves its fat AABB.
      }
    }
  }
}

// Moves the bodies of an interrupted step back, if their motion was kept, into a consistent state.
template <class Real>
void undo_motion(WorldData<Real>& w) {
  restore_motion(w);
  restore_consistency(w);
  restore_motion(w);  // rotations too, which are those of the angles but for rounding
}

// Returns the number of substeps, increased if the step is longer than the last. Warm starting scales
// impulses with h. Their convergence error grows with h, the velocities do not, so alternating long and short
// steps would add energy. Overlaps at rest scale with h^2 and would change, too. Hence h may grow only
// slowly. Solvers without warm starting, or that iterate to convergence, do not need this.
template <class Real>
int substeps_of(const WorldData<Real>& w, double dt, int requested) {
  const bool one_iteration = w.settings.solver == Solver::SoftSteps || w.settings.solver == Solver::Direct;
  if (!one_iteration || !enabled(Switch::SubstepGrowth) || !(w.impulse_h > 0) ||
      (w.graph.empty() && w.joint_set.active_count() == 0))
    return requested;
  const double longest = kMaxSubstepGrowth * w.impulse_h;
  if (dt <= longest * requested) return requested;
  const double wanted = std::ceil(dt / longest), maximum = double(kMaxSubstepFactor) * requested;
  return static_cast<int>(std::min(wanted, maximum));
}

// Minimum number of awake bodies, contacts and joints for a step to be shared by threads. Below it, waking a
// second thread costs about as much as the work that it takes over (docs/decisions/threads.md).
constexpr std::size_t kMinSharedWork = 256;

template <class Real>
bool is_worth_sharing(const WorldData<Real>& w) {
  return w.awake.size() + w.nontouching_contacts.size() + w.graph.size() +
             static_cast<std::size_t>(w.joint_set.active_count()) >=
         kMinSharedWork;
}

// Measures the wall time of each stage, if the world is profiled.
template <class Real>
class StageClock {
 public:
  explicit StageClock(WorldData<Real>& world) : w_(world), start_(now()) {}

  // Adds the time since the last stage to this one.
  void end(WorldStage stage) {
    if (!w_.profiled) return;
    const auto time = now();
    w_.profile.nanoseconds[static_cast<std::size_t>(stage)] +=
        std::chrono::duration<double, std::nano>(time - start_).count();
    start_ = time;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point now() const { return w_.profiled ? Clock::now() : Clock::time_point{}; }

  WorldData<Real>& w_;
  Clock::time_point start_;
};

}  // namespace

template <class Real>
void step_world(WorldData<Real>& w, double dt, int substeps) {
  apply_mass_changes(w);
  // RAII guard: resets `stepping` even if a stage throws.
  const StepGuard<Real> stepping(w);
  StageClock<Real> clock(w);
  if (w.settings.quarantine && w.loads.used()) quarantine_overloaded(w, dt);
  w.scheduler.set_busy(w.scheduler.threads() > 1 && is_worth_sharing(w));
  find_pairs(w, static_cast<Real>(dt)), clock.end(WorldStage::BroadPhase);
  substeps = substeps_of(w, dt, substeps);
  const double h = dt / substeps;
  update_contacts(w, static_cast<Real>(dt), static_cast<Real>(h)), clock.end(WorldStage::NarrowPhase);
  keep_motion(w);
  try {
    w.scheduler.session([&] { solve_motion(w, h, substeps); });
    clock.end(WorldStage::Solver);
    report_impacts(w), clock.end(WorldStage::Events);
    w.scheduler.session([&] { finalize_bodies(w, static_cast<Real>(dt)); });
    clock.end(WorldStage::Finalize);
    {
      const LoopScheduler::SerialGuard serial(w.scheduler, w.calls_user_code());
      const auto solve = [&] { solve_continuous(w, static_cast<Real>(dt)); };
      // The pre-solve hook is called between loops, on the calling thread; each loop has its own session.
      if (w.pre_solve) {
        solve();
      } else {
        w.scheduler.session(solve);
      }
    }
    clock.end(WorldStage::Continuous);
  } catch (...) {
    undo_motion(w);
    throw;
  }
  break_joints(w);
  update_sensors(w), clock.end(WorldStage::Events);
  sleep_islands(w), clock.end(WorldStage::Sleep);
  w.time += dt;
  ++w.steps, w.profile.steps += w.profiled ? 1 : 0;
}

template <class Real>
void end_interrupted_step(WorldData<Real>& w) {
  undo_motion(w);
  w.stepping = false;
}

template void step_world(WorldData<float>&, double, int);
template void step_world(WorldData<double>&, double, int);
template void end_interrupted_step(WorldData<float>&);
template void end_interrupted_step(WorldData<double>&);

}  // namespace plumb
