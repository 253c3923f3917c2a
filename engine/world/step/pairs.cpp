#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Returns true if most moved shapes have no contact. Estimated from at most 512 samples, because checking a
// million bodies would cause a cache miss for each.
template <class Real>
bool mostly_alone(const WorldData<Real>& w) {
  constexpr std::size_t kSample = 512;
  const std::size_t stride = w.moved_shapes.size() / kSample + 1;
  int looked = 0, alone = 0;
  for (std::size_t i = 0; i < w.moved_shapes.size(); i += stride, ++looked) {
    const ShapeRecord<Real>& record = w.shapes[w.moved_shapes[i]];
    alone += static_cast<int>(record.moved && w.bodies[record.body].first_contact == kNone);
  }
  return 8 * alone >= 7 * looked;
}

// If most moved shapes had no contact, finds in one self-overlap pass which proxies of the dynamic tree
// overlap any other; this saves their queries. Returns false if the pass was skipped.
template <class Real>
bool mark_meetings(WorldData<Real>& w) {
  const int moved = static_cast<int>(w.moved_shapes.size()), all = w.moving_tree.size();
  if (all < tuning::kScreenedMoves) return false;
  w.scratch.meets.resize(static_cast<std::size_t>(w.moving_tree.proxies()));
  if (moved < tuning::kScreenedMoves || moved * tuning::kScreenedShare < all) return false;
  return mostly_alone(w) && w.moving_tree.mark_meetings(w.scratch.meets, 4 * moved);
}

// Prefetch distances in pairs and in shapes: entries of the pair set are scattered, and records of a million
// moved shapes exceed the cache.
constexpr std::size_t kAhead = 8, kShapesAhead = 32;

template <class Real>
[[gnu::always_inline]] inline void ask_for_moved(const WorldData<Real>& w, std::size_t i) {
  if (i + kShapesAhead < w.moved_shapes.size())
    __builtin_prefetch(&w.shapes[w.moved_shapes[i + kShapesAhead]]);
}

}  // namespace

template <class Real>
void find_pairs(WorldData<Real>& w) {
  std::vector<std::pair<int, int>>& found = w.scratch.found_pairs;
  found.clear();
  const bool marked = mark_meetings(w);
  const bool grounds = w.still_tree.size() > 0;
  for (std::size_t i = 0; i < w.moved_shapes.size(); ++i) {
    ask_for_moved(w, i);
    const int shape = w.moved_shapes[i];
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone) continue;  // destroyed meanwhile
    // Without static shapes every proxy is in the dynamic tree, so one without an overlap can be skipped
    // without reading its body.
    if (marked && !grounds && w.scratch.meets[record.proxy] == 0) continue;
    const BodyType type = w.bodies[record.body].type;
    const Aabb<Real>& box = w.tree_of(type).box(record.proxy);
    const auto visit = [&](int other, int) {
      // Of two moved shapes, only one reports the pair.
      if (other != shape && !(w.shapes[other].moved && other < shape)) found.emplace_back(shape, other);
      return true;
    };
    const std::uint32_t mask = seen_by(record.filter);
    if (mask == 0) continue;
    if (type == BodyType::Static || !marked || w.scratch.meets[record.proxy] != 0)
      w.moving_tree.query(box, mask, visit);
    if (type == BodyType::Dynamic) w.still_tree.query(box, mask, visit);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i + kAhead < found.size()) w.pairs.ask_for(found[i + kAhead].first, found[i + kAhead].second);
    const auto [a, b] = found[i];
    if (!w.pairs.contains(a, b) && may_collide(w, a, b)) create_contact(w, a, b);
  }
  // Clear the flags last: if memory runs out above, these pairs are searched again.
  for (std::size_t i = 0; i < w.moved_shapes.size(); ++i) {
    ask_for_moved(w, i);
    w.shapes[w.moved_shapes[i]].moved = false;
  }
  w.moved_shapes.clear();
}

template void find_pairs(WorldData<float>&);
template void find_pairs(WorldData<double>&);

}  // namespace plumb
