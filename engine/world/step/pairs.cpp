#include <algorithm>
#include <cmath>

#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Returns true if most moved shapes have no contact. Estimated from at most 512 samples, because checking a
// million bodies would cause a cache miss for each.
template <class Real>
bool is_mostly_apart(const WorldData<Real>& w) {
  constexpr std::size_t kSample = 512;
  const std::size_t stride = w.move_buffer.size() / kSample + 1;
  int looked = 0, alone = 0;
  for (std::size_t i = 0; i < w.move_buffer.size(); i += stride, ++looked) {
    const ShapeRecord<Real>& record = w.shapes[w.move_buffer[i]];
    alone += static_cast<int>(record.moved && w.bodies[record.body].first_contact == kNone);
  }
  return 8 * alone >= 7 * looked;
}

// If most moved shapes had no contact, finds in one self-overlap pass which proxies of the dynamic tree
// overlap any other; this saves their queries. Returns false if the pass was skipped.
template <class Real>
bool mark_self_overlaps(WorldData<Real>& w) {
  const int moved = static_cast<int>(w.move_buffer.size()), all = w.dynamic_tree.size();
  if (all < tuning::kScreenedMoves) return false;
  w.scratch.meets.resize(static_cast<std::size_t>(w.dynamic_tree.proxies()));
  if (moved < tuning::kScreenedMoves || moved * tuning::kScreenedShare < all) return false;
  return is_mostly_apart(w) && w.dynamic_tree.mark_self_overlaps(w.scratch.meets, 4 * moved);
}

// Prefetch distances in pairs and in shapes: entries of the pair set are scattered, and records of a million
// moved shapes exceed the cache.
constexpr int kAhead = 8;
constexpr std::size_t kShapesAhead = 32;

template <class Real>
[[gnu::always_inline]] inline void ask_for_moved(const WorldData<Real>& w, std::size_t i) {
  if (i + kShapesAhead < w.move_buffer.size()) __builtin_prefetch(&w.shapes[w.move_buffer[i + kShapesAhead]]);
}

// Moved shapes per block of a shared loop: about 30 us of work.
constexpr int kMovedOfBlock = 64;

// Finds the new pairs of a block of moved shapes.
template <class Real>
void find_pairs_of(WorldData<Real>& w, int block, bool marked, bool grounds) {
  BlockLists<std::pair<int, int>>& found = w.scratch.found_pairs_of;
  const std::size_t first = static_cast<std::size_t>(block) * kMovedOfBlock;
  for (std::size_t i = first; i < std::min(first + kMovedOfBlock, w.move_buffer.size()); ++i) {
    ask_for_moved(w, i);
    const int shape = w.move_buffer[i];
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone) continue;  // destroyed meanwhile
    // Without static shapes every proxy is in the dynamic tree, so one without an overlap can be skipped
    // without reading its body.
    if (marked && !grounds && w.scratch.meets[record.proxy] == 0) continue;
    const BodyType type = w.bodies[record.body].type;
    const Aabb<Real>& box = w.tree_of(type).box(record.proxy);
    const auto visit = [&](int other, int) {
      // Of two moved shapes, only one reports the pair.
      if (other != shape && !(w.shapes[other].moved && other < shape)) found.add(block, {shape, other});
      return true;
    };
    const std::uint32_t mask = seen_by(record.filter);
    if (mask == 0) continue;
    if (type == BodyType::Static || !marked || w.scratch.meets[record.proxy] != 0)
      w.dynamic_tree.query(box, mask, visit);
    if (type == BodyType::Dynamic) w.static_tree.query(box, mask, visit);
  }
  // Most pairs have their contact already.
  found.template keep<kAhead>(
      block, [&](const std::pair<int, int>& pair) { w.pairs.ask_for(pair.first, pair.second); },
      [&](const std::pair<int, int>& pair) {
        return !w.pairs.contains(pair.first, pair.second) && may_collide(w, pair.first, pair.second);
      });
}

// Stores fat AABBs with room for this step where they have none: of bodies that were made or moved by calls.
template <class Real>
void make_room_ahead(WorldData<Real>& w, Real dt) {
  for (const int shape : w.move_buffer) {
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone || !w.is_dynamic(record.body)) continue;
    const BodyMotion<Real>& motion = w.motion[record.body];
    const Real extent = w.extents[record.body], turned = dt * std::abs(motion.angular_velocity) * extent;
    if (w.dynamic_tree.box(record.proxy)
            .contains(room_ahead(w.boxes[shape], dt * motion.velocity, turned, extent)))
      continue;
    w.dynamic_tree.enlarge(record.proxy, fat_aabb(w, shape, dt));
    w.enlarged[record.body] = 1;
  }
}

}  // namespace

template <class Real>
void find_pairs(WorldData<Real>& w, Real dt) {
  if (w.move_buffer.empty()) return;
  make_room_ahead(w, dt);
  const bool marked = mark_self_overlaps(w);
  const bool grounds = w.static_tree.size() > 0;
  const int blocks = static_cast<int>((w.move_buffer.size() + kMovedOfBlock - 1) / kMovedOfBlock);
  w.scratch.found_pairs_of.begin(blocks);
  w.crew.blocks(blocks, [&](int block) { find_pairs_of(w, block, marked, grounds); });
  w.scratch.found_pairs_of.for_each([&](const std::pair<int, int>& pair) {
    // A shape that took the place of one that had moved is listed twice, and finds its pairs twice.
    if (!w.pairs.contains(pair.first, pair.second) && is_let_through(w, pair.first, pair.second))
      create_contact(w, pair.first, pair.second);
  });
  // Clear the flags last: if memory runs out above, these pairs are searched again.
  for (std::size_t i = 0; i < w.move_buffer.size(); ++i) {
    ask_for_moved(w, i);
    w.shapes[w.move_buffer[i]].moved = false;
  }
  w.move_buffer.clear();
}

template void find_pairs(WorldData<float>&, float);
template void find_pairs(WorldData<double>&, double);

}  // namespace plumb
