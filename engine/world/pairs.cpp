#include "engine/world/contacts.h"
#include "engine/world/step.h"

namespace plumb {

template <class Real>
void find_pairs(WorldData<Real>& w) {
  std::vector<std::pair<int, int>>& found = w.scratch.found_pairs;
  found.clear();
  for (const int shape : w.moved_shapes) {
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone) continue;  // gone meanwhile
    const BodyType type = w.bodies[record.body].type;
    const Aabb<Real>& box = w.tree_of(type).box(record.proxy);
    const auto visit = [&](int other, int) {
      // Of two that moved, one finds the other.
      if (other == shape || (w.shapes[other].moved && other < shape)) return true;
      if (!w.pairs.contains(shape, other) && may_collide(w, shape, other)) found.emplace_back(shape, other);
      return true;
    };
    const std::uint32_t mask = seen_by(record.filter);
    if (mask == 0) continue;
    w.moving_tree.query(box, mask, visit);
    if (type == BodyType::Dynamic) w.still_tree.query(box, mask, visit);
  }
  for (const int shape : w.moved_shapes) w.shapes[shape].moved = false;
  w.moved_shapes.clear();
  for (const auto& [a, b] : found) {
    if (!w.pairs.contains(a, b)) create_contact(w, a, b);
  }
}

template void find_pairs(WorldData<float>&);
template void find_pairs(WorldData<double>&);

}  // namespace plumb
