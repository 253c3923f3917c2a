#include <algorithm>
#include <tuple>
#include <type_traits>
#include <variant>

#include "engine/world/joint_solver/joint_parts.h"
#include "engine/world/joint_solver/joint_set.h"
#include "engine/world/joint_solver/under_relaxation.h"

namespace plumb {
namespace {

/// Evaluates a single joint. Not inlined, because it has many callers.
template <class Joint, class Real>
[[gnu::noinline]] void evaluate(Joint& joint, const SolverBodies<Real>& bodies,
                                const JointVelocities<Real>& v, const JointStep<Real>& step, JointTime time) {
  joint.evaluate(motion_of(bodies, joint.a, joint.b), v, step, time);
}

/// Joints to solve one after the other: from `first` on, or those that `places` refers to.
template <class Joint>
struct JointRange {
  Joint* first = nullptr;
  Joint* const* places = nullptr;
  int count = 0;

  Joint& operator[](int i) const { return places != nullptr ? *places[i] : first[i]; }
};

/// Solves single joints.
template <class Joint, class Real>
[[gnu::noinline]] void run_stage_on(JointStage stage, JointRange<Joint> joints, const SolverBodies<Real>& of,
                                    const JointStep<Real>& settings) {
  const SolverBodies<Real> bodies = of;  // copies, which no other pointer reaches
  const JointStep<Real> step = settings;
  const auto for_each = [&](const auto& run) __attribute__((always_inline)) {
    for (int i = 0; i < joints.count; ++i) {
      Joint& joint = joints[i];
      if constexpr (Joint::kPlainHinge)
        if (joint.external) continue;
      // Ratchets must record the teeth that they pass.
      if (joint.with_island && (stage != JointStage::Relax || !(step.evaluates_all || Joint::kRatchet)))
        continue;
      JointVelocities<Real> v = velocities_of(bodies, joint);
      run(joint, v);
      v.store(bodies.motion[joint.a], bodies.motion[joint.b]);
    }
  };
  using Velocities = JointVelocities<Real>;
  switch (stage) {
    case JointStage::WarmStart:
      return for_each([](const Joint& joint, Velocities& v)
                          __attribute__((always_inline)) { joint.warm_start(v); });
    case JointStage::Solve:
      return for_each([&](Joint & joint, Velocities & v)
                          __attribute__((always_inline)) { joint.solve(v, step); });
    case JointStage::Relax:
      return for_each([&](Joint & joint, Velocities & v) __attribute__((always_inline)) {
        if (joint.with_island) return evaluate(joint, bodies, v, step, JointTime::SubstepEnds);
        if constexpr (Joint::kPlainHinge) return joint.relax(motion_of(bodies, joint.a, joint.b), v, step);
        evaluate(joint, bodies, v, step, JointTime::SubstepEnds);
        joint.solve_coordinates(v, step, kRelax, joint.under_relaxation);
        joint.add_load(step);
      });
  }
}

/// Solves all active joints in the order of solving, colour by colour.
template <class Parts, class Real>
void run_stage(Parts& parts, JointStage stage, LoopScheduler* scheduler, const SolverBodies<Real>& bodies,
               const JointStep<Real>& step) {
  for (const JointRun& run : parts.runs) {
    parts.with(run.form, [&](auto& lists) {
      using One = typename std::decay_t<decltype(lists[0])>::value_type;
      if constexpr (kHasLanes<One>) {
        if (run.sorted) {
          JointBlocks<One>& blocks = std::get<JointBlocks<One>>(parts.lanes);
          const auto visit = [&](JointCounts first, JointCounts last) {
            // Single joints come first. Otherwise blocks of the next colour, which load a body's velocity as
            // one value, would stall on a velocity that was just stored in parts.
            if (first.singles < last.singles)
              run_stage_on<One>(stage,
                                {nullptr, blocks.singles_from(first.singles), last.singles - first.singles},
                                bodies, step);
            if (first.blocks < last.blocks) blocks.run_stage(stage, first.blocks, last.blocks, bodies, step);
          };
          return scheduler != nullptr && scheduler->shares() ? share_blocks(run, scheduler, visit)
                                                             : visit(run.first, run.last);
        }
      }
      auto& list = lists[run.colour];
      share_run(run, static_cast<int>(list.size()), scheduler, [&](int first, int last) {
        run_stage_on<One>(stage, {list.data() + first, nullptr, last - first}, bodies, step);
      });
    });
  }
}

/// Begins a joint's step.
template <class Parts, class Joint, class Real>
void begin_step(const Parts& p, Joint& joint, const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  using Definition = typename Joint::Definition;
  if constexpr (Joint::kHasSprings) {
    const PairMobility<Real> masses = masses_of(velocities_of(bodies, joint));
    if (!joint.springs.fit(masses)) {
      const JointSlot& s = p.slot(joint.joint);
      joint.springs = {.any = true,
                       .known = true,
                       .bodies = masses,
                       .mobility = s.springs(s.centre_a, s.centre_b, masses)};
      joint.known_h = 0;
    }
  }
  if (Joint::kHasRules && joint.known_h != step.h)
    joint.set_substep(std::get<Definition>(p.slot(joint.joint).definition), step.h);
  joint.under_relaxation = 1;
  joint.isolated = std::max(p.body_joints[joint.a].count, p.body_joints[joint.b].count) < 2;
  joint.begin_step(bodies, step);
}

/// Returns the under-relaxation factor of a joint that was evaluated.
template <class Parts, class Joint, class Real>
Real relaxation_factor_of(const Parts& p, const Joint& joint, const SolverBodies<Real>& bodies) {
  const int count_a = p.body_joints[joint.a].count, count_b = p.body_joints[joint.b].count;
  if (std::max(count_a, count_b) < kUnderRelaxedJoints) return 1;
  return under_relaxation_factor(joint.mobility_fractions(velocities_of(bodies, joint)), count_a, count_b);
}

/// Evaluates a joint whose step has begun.
template <class Parts, class Joint, class Real>
void evaluate_first(const Parts& p, Joint& joint, const SolverBodies<Real>& bodies,
                    const JointStep<Real>& step) {
  if constexpr (Joint::kPlainHinge)
    if (joint.external) return;
  const JointVelocities<Real> v = velocities_of(bodies, joint);
  evaluate(joint, bodies, v, step, JointTime::StepStarts);
  joint.under_relaxation = relaxation_factor_of(p, joint, bodies);
  if (joint.under_relaxation < 1) evaluate(joint, bodies, v, step, JointTime::StepStarts);
}

}  // namespace

template <class Real>
void JointSet<Real>::prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  Parts& p = *parts_;
  for (JointRun& run : p.runs) run.sorted = false;
  p.for_each_active([&](auto& joint) {
    joint.with_island = false;
    begin_step(p, joint, bodies, step);
    evaluate_first(p, joint, bodies, step);
  });
}

template <class Real>
void JointSet<Real>::prepare(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
                             const std::vector<char>& excluded, LoopScheduler* scheduler) {
  Parts& p = *parts_;
  std::apply([](auto&... blocks) { (blocks.begin(vector_width()), ...); }, p.lanes);
  for (JointRun& run : p.runs) {
    p.with(run.form, [&](auto& lists) {
      using One = typename std::decay_t<decltype(lists[0])>::value_type;
      auto& list = lists[run.colour];
      run.sorted = kHasLanes<One> && run.colour != kOverflowColour;
      share_run(run, static_cast<int>(list.size()), scheduler, [&](int first, int last) {
        for (int i = first; i < last; ++i) {
          list[i].with_island = !excluded.empty() && excluded[list[i].joint] != 0;
          begin_step(p, list[i], bodies, step);
          if (!run.sorted) evaluate_first(p, list[i], bodies, step);
        }
      });
      if constexpr (kHasLanes<One>) {
        if (!run.sorted) return;
        JointBlocks<One>& blocks = std::get<JointBlocks<One>>(p.lanes);
        run.first = blocks.counts();
        blocks.sort(list, bodies.motion, excluded);
        run.last = blocks.counts();
      }
    });
  }
  const auto evaluate = [&]<class Joint>(JointBlocks<Joint>& blocks) {
    const auto factor_of = [&](const Joint& joint) { return relaxation_factor_of(p, joint, bodies); };
    const JointCounts counts = blocks.counts();
    if (counts.blocks + counts.singles == 0) return;
    share_range(counts.blocks, kBlocksPerTask, scheduler,
                [&](int first, int last) { blocks.prepare(first, last, bodies, step, factor_of); });
    share_range(counts.singles, kJointsPerTask, scheduler, [&](int first, int last) {
      for (int i = first; i < last; ++i) evaluate_first(p, blocks.single(i), bodies, step);
    });
  };
  std::apply([&](auto&... blocks) { (evaluate(blocks), ...); }, p.lanes);
}

template <class Real>
void JointSet<Real>::evaluate(const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  parts_->for_each_active([&](auto& joint) {
    plumb::evaluate(joint, bodies, velocities_of(bodies, joint), step, JointTime::Between);
  });
}

template <class Real>
void JointSet<Real>::store_results(LoopScheduler* scheduler) {
  const auto store = [&](auto& blocks) {
    share_range(blocks.counts().blocks, kBlocksPerTask, scheduler,
                [&](int first, int last) { blocks.store_results(first, last); });
  };
  std::apply([&](auto&... blocks) { (store(blocks), ...); }, parts_->lanes);
}

template <class Real>
void JointSet<Real>::append_impulses(std::vector<Real>& impulses) const {
  parts_->for_each_active(
      [&](auto& joint) { joint.for_each_impulse([&](Real impulse) { impulses.push_back(impulse); }); });
}

template <class Real>
void JointSet<Real>::add_impulses(std::span<const Real> earlier, Real kept, Real scale) {
  std::size_t next = 0;
  parts_->for_each_active([&](auto& joint) {
    joint.for_each_impulse([&](Real& impulse) { impulse = kept * earlier[next++] + scale * impulse; });
  });
}

template <class Real>
void JointSet<Real>::add_loads(const JointStep<Real>& step) {
  parts_->for_each_active([&](auto& joint) { joint.add_load(step); });
}

template <class Real>
void JointSet<Real>::add_load(int joint, const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  parts_->at(joint, [&]<class Joint>(Joint& constraint) {
    JointRows<Real> rows;
    if constexpr (Joint::kHasRows) constraint.kind.evaluate(constraint.pose(bodies), rows);
    constraint.add_load(step, rows);
  });
}

template <class Real>
void JointSet<Real>::add_impulse(int joint, Vec2<Real> impulse, Real moment, const JointStep<Real>& step) {
  parts_->at(joint, [&](auto& constraint) { constraint.add_impulse(impulse, moment, step); });
}

template <class Real>
Vec2<Real> JointSet<Real>::anchor_arm(int joint, const SolverBodies<Real>& bodies) const {
  return parts_->at(joint, [&]<class Joint>(const Joint& constraint) {
    JointRows<Real> rows;
    constraint.kind.evaluate(constraint.pose(bodies), rows);
    return Joint::kHasRows ? rows.arm_b : rows.point.arm_b;
  });
}

template <class Real>
void JointSet<Real>::finish(const SolverBodies<Real>& bodies, LoopScheduler* scheduler) {
  Parts& p = *parts_;
  const auto finish = [&]<class Joint>(JointBlocks<Joint>& blocks) {
    if constexpr (Joint::kAngle != AngleUse::None) {
      share_range(blocks.counts().blocks, kBlocksPerTask, scheduler,
                  [&](int first, int last) { blocks.end_step(first, last, bodies); });
    }
  };
  std::apply([&](auto&... blocks) { (finish(blocks), ...); }, p.lanes);
  // Does the same for joints not in blocks: gaps were closed since they were evaluated.
  for (const JointRun& run : p.runs) {
    p.with(run.form, [&](auto& lists) {
      using One = typename std::decay_t<decltype(lists[0])>::value_type;
      if constexpr (One::kAngle != AngleUse::None) {
        if constexpr (kHasLanes<One>) {
          JointBlocks<One>& blocks = std::get<JointBlocks<One>>(p.lanes);
          if (run.sorted)
            for (int i = run.first.singles; i < run.last.singles; ++i) blocks.single(i).end_step(bodies);
          if (run.sorted) return;
        }
        for (One& joint : lists[run.colour]) joint.end_step(bodies);
      }
    });
  }
}

template <class Real>
void JointSet<Real>::warm_start(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
                                LoopScheduler* scheduler) {
  run_stage(*parts_, JointStage::WarmStart, scheduler, bodies, step);
}

template <class Real>
void JointSet<Real>::solve(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
                           LoopScheduler* scheduler) {
  run_stage(*parts_, JointStage::Solve, scheduler, bodies, step);
}

template <class Real>
void JointSet<Real>::relax(const SolverBodies<Real>& bodies, const JointStep<Real>& step,
                           LoopScheduler* scheduler) {
  run_stage(*parts_, JointStage::Relax, scheduler, bodies, step);
}

#define PLUMB_FOR(R)                                                                                        \
  template void JointSet<R>::prepare(const SolverBodies<R>&, const JointStep<R>&);                          \
  template void JointSet<R>::prepare(const SolverBodies<R>&, const JointStep<R>&, const std::vector<char>&, \
                                     LoopScheduler*);                                                       \
  template void JointSet<R>::evaluate(const SolverBodies<R>&, const JointStep<R>&);                         \
  template void JointSet<R>::store_results(LoopScheduler*);                                                 \
  template void JointSet<R>::append_impulses(std::vector<R>&) const;                                        \
  template void JointSet<R>::add_impulses(std::span<const R>, R, R);                                        \
  template void JointSet<R>::add_loads(const JointStep<R>&);                                                \
  template void JointSet<R>::add_load(int, const SolverBodies<R>&, const JointStep<R>&);                    \
  template void JointSet<R>::add_impulse(int, Vec2<R>, R, const JointStep<R>&);                             \
  template Vec2<R> JointSet<R>::anchor_arm(int, const SolverBodies<R>&) const;                              \
  template void JointSet<R>::finish(const SolverBodies<R>&, LoopScheduler*);                                \
  template void JointSet<R>::warm_start(const SolverBodies<R>&, const JointStep<R>&, LoopScheduler*);       \
  template void JointSet<R>::solve(const SolverBodies<R>&, const JointStep<R>&, LoopScheduler*);            \
  template void JointSet<R>::relax(const SolverBodies<R>&, const JointStep<R>&, LoopScheduler*);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
