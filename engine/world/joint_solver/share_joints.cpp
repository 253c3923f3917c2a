#include <algorithm>

#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

void share_range(int count, int grain, LoopScheduler* scheduler, VisitRange visit, const void* it) {
  scheduler->ranges(count, grain, [=](int first, int last) { visit(it, first, last); });
}

void share_run(const JointRun& run, int count, LoopScheduler* scheduler, VisitRange visit, const void* it) {
  if (scheduler == nullptr || !scheduler->shares() || run.colour == kOverflowColour ||
      count <= kJointsPerTask)
    return visit(it, 0, count);
  share_range(count, kJointsPerTask, scheduler, visit, it);
}

void share_blocks(const JointRun& run, LoopScheduler* scheduler, VisitCounts visit, const void* it) {
  const int of_blocks = (run.last.blocks - run.first.blocks + kBlocksPerTask - 1) / kBlocksPerTask,
            of_singles = (run.last.singles - run.first.singles + kJointsPerTask - 1) / kJointsPerTask;
  if (scheduler == nullptr || !scheduler->shares() || of_blocks + of_singles < 2)
    return visit(it, run.first, run.last);
  scheduler->blocks(of_blocks + of_singles, [&](int task) {
    JointCounts first = run.first, last = run.first;
    if (task < of_blocks) {
      first.blocks += task * kBlocksPerTask;
      last.blocks = std::min(first.blocks + kBlocksPerTask, run.last.blocks);
    } else {
      first.singles += (task - of_blocks) * kJointsPerTask;
      last.singles = std::min(first.singles + kJointsPerTask, run.last.singles);
    }
    visit(it, first, last);
  });
}

}  // namespace plumb
