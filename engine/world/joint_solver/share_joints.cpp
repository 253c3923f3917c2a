#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

void share_joints(Crew& crew, int count, int grain, void (*visit)(void*, int, int), void* data) {
  crew.ranges(count, grain, [=](int first, int last) { visit(data, first, last); });
}

}  // namespace plumb
