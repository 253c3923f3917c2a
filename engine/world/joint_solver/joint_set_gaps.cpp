#include <atomic>

#include "engine/world/joint_solver/joint_opening.h"
#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {
namespace {

template <class Joint, class Real>
bool is_open(const Joint& joint, const SolverBodies<Real>& bodies, Real tolerance) {
  if constexpr (Joint::kPlainHinge)
    if (joint.external) return false;
  const SolverBody<Real>&a = bodies.motion[joint.a], &b = bodies.motion[joint.b];
  return joint_opening(joint, {a.inverse_mass, a.inverse_inertia, b.inverse_mass, b.inverse_inertia},
                       tolerance) > 0;
}

}  // namespace

template <class Real>
bool JointSet<Real>::find_open(const SolverBodies<Real>& bodies, Real tolerance, std::vector<char>& open,
                               LoopScheduler* scheduler) {
  Parts& p = *parts_;
  std::atomic<bool> any = false;
  const auto mark = [&](const auto& joint) {
    open[joint.joint] = 1;
    any.store(true, std::memory_order_relaxed);
  };
  const auto check = [&](const auto& joint) {
    if (is_open(joint, bodies, tolerance)) mark(joint);
  };
  for (const JointRun& run : p.runs) {
    p.with(run.form, [&](auto& lists) {
      using One = typename std::decay_t<decltype(lists[0])>::value_type;
      auto& list = lists[run.colour];
      if constexpr (kHasLanes<One>) {
        if (run.sorted) {
          JointBlocks<One>& blocks = std::get<JointBlocks<One>>(p.lanes);
          return share_blocks(run, scheduler, [&](JointCounts first, JointCounts last) {
            if (first.blocks < last.blocks) blocks.open(first.blocks, last.blocks, tolerance, mark);
            for (int i = first.singles; i < last.singles; ++i) check(blocks.single(i));
          });
        }
      }
      share_run(run, static_cast<int>(list.size()), scheduler, [&](int first, int last) {
        for (int i = first; i < last; ++i) check(list[i]);
      });
    });
  }
  return any.load(std::memory_order_relaxed);
}

template bool JointSet<float>::find_open(const SolverBodies<float>&, float, std::vector<char>&,
                                         LoopScheduler*);
template bool JointSet<double>::find_open(const SolverBodies<double>&, double, std::vector<char>&,
                                          LoopScheduler*);

}  // namespace plumb
