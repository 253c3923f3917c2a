#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

void share_range(int count, int grain, Crew* crew, VisitRange visit, const void* it) {
  crew->ranges(count, grain, [=](int first, int last) { visit(it, first, last); });
}

void share_run(const JointRun& run, int count, Crew* crew, VisitRange visit, const void* it) {
  if (crew == nullptr || !crew->shares() || run.colour == kOverflowColour || count <= kJointsOfTask)
    return visit(it, 0, count);
  share_range(count, kJointsOfTask, crew, visit, it);
}

void share_blocks(const JointRun& run, Crew* crew, VisitCounts visit, const void* it) {
  const int of_blocks = (run.last.blocks - run.first.blocks + kBlocksOfTask - 1) / kBlocksOfTask,
            of_alone = (run.last.alone - run.first.alone + kJointsOfTask - 1) / kJointsOfTask;
  if (crew == nullptr || !crew->shares() || of_blocks + of_alone < 2) return visit(it, run.first, run.last);
  crew->blocks(of_blocks + of_alone, [&](int task) {
    JointCounts first = run.first, last = run.first;
    if (task < of_blocks) {
      first.blocks += task * kBlocksOfTask;
      last.blocks = std::min(first.blocks + kBlocksOfTask, run.last.blocks);
    } else {
      first.alone += (task - of_blocks) * kJointsOfTask;
      last.alone = std::min(first.alone + kJointsOfTask, run.last.alone);
    }
    visit(it, first, last);
  });
}

}  // namespace plumb
