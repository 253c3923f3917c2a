#include "engine/world/constants.h"
#include "engine/world/contacts.h"
#include "engine/world/step.h"

namespace plumb {
namespace {

// Finds out at once which of the boxes in the moving tree meet any other, when that promises to spare most of
// many a query: when most of what moved had no contact. False: it is not known.
template <class Real>
bool mark_meetings(WorldData<Real>& w) {
  const int moved = static_cast<int>(w.moved_shapes.size()), all = w.moving_tree.size();
  if (all < tuning::kScreenedMoves) return false;
  w.scratch.meets.resize(static_cast<std::size_t>(w.moving_tree.proxies()));
  if (moved < tuning::kScreenedMoves || moved * tuning::kScreenedShare < all) return false;
  int lone = 0;
  for (const int shape : w.moved_shapes) {
    const ShapeRecord<Real>& record = w.shapes[shape];
    lone += static_cast<int>(record.moved && w.bodies[record.body].first_contact == kNone);
  }
  return 8 * lone >= 7 * moved && w.moving_tree.mark_meetings(w.scratch.meets, 4 * moved);
}

// Places in the set of pairs lie anywhere in memory: they are asked for so many pairs ahead.
constexpr std::size_t kAhead = 8;

}  // namespace

template <class Real>
void find_pairs(WorldData<Real>& w) {
  std::vector<std::pair<int, int>>& found = w.scratch.found_pairs;
  found.clear();
  const bool marked = mark_meetings(w);
  for (const int shape : w.moved_shapes) {
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone) continue;  // gone meanwhile
    const BodyType type = w.bodies[record.body].type;
    const Aabb<Real>& box = w.tree_of(type).box(record.proxy);
    const auto visit = [&](int other, int) {
      // Of two that moved, one finds the other.
      if (other != shape && !(w.shapes[other].moved && other < shape)) found.emplace_back(shape, other);
      return true;
    };
    const std::uint32_t mask = seen_by(record.filter);
    if (mask == 0) continue;
    if (type == BodyType::Static || !marked || w.scratch.meets[record.proxy] != 0)
      w.moving_tree.query(box, mask, visit);
    if (type == BodyType::Dynamic) w.still_tree.query(box, mask, visit);
  }
  for (const int shape : w.moved_shapes) w.shapes[shape].moved = false;
  w.moved_shapes.clear();
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i + kAhead < found.size()) w.pairs.ask_for(found[i + kAhead].first, found[i + kAhead].second);
    const auto [a, b] = found[i];
    if (!w.pairs.contains(a, b) && may_collide(w, a, b)) create_contact(w, a, b);
  }
}

template void find_pairs(WorldData<float>&);
template void find_pairs(WorldData<double>&);

}  // namespace plumb
