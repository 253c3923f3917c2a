#include <algorithm>
#include <cmath>

#include "engine/world/ablation/ablation.h"
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
  int samples = 0, isolated = 0;
  for (std::size_t i = 0; i < w.move_buffer.size(); i += stride, ++samples) {
    const ShapeRecord<Real>& record = w.shapes[w.move_buffer[i]];
    isolated += static_cast<int>(record.moved && w.bodies[record.body].first_contact == kNone);
  }
  return 8 * isolated >= 7 * samples;
}

// If most moved shapes had no contact, finds in one self-overlap pass which proxies of the dynamic tree
// overlap any other; this saves their queries. Returns false if the pass was skipped.
template <class Real>
bool mark_self_overlaps(WorldData<Real>& w) {
  const int moved = static_cast<int>(w.move_buffer.size()), all = w.dynamic_tree.size();
  if (all < tuning::kMinOverlapPassMoves || !enabled(Switch::SelfOverlapPass)) return false;
  w.scratch.broad_phase.has_overlap.resize(static_cast<std::size_t>(w.dynamic_tree.proxies()));
  if (moved < tuning::kMinOverlapPassMoves || moved * tuning::kOverlapPassDivisor < all) return false;
  return is_mostly_apart(w) &&
         w.dynamic_tree.mark_self_overlaps(w.scratch.broad_phase.has_overlap, 4 * moved);
}

// Prefetch distances in pairs and in shapes: entries of the pair set are scattered, and records of a million
// moved shapes exceed the cache.
constexpr int kPairsAhead = 8;
constexpr std::size_t kShapesAhead = 32;

template <class Real>
[[gnu::always_inline]] inline void prefetch_moved_shape(const WorldData<Real>& w, std::size_t i) {
  if (i + kShapesAhead < w.move_buffer.size()) __builtin_prefetch(&w.shapes[w.move_buffer[i + kShapesAhead]]);
}

// Moved shapes per block of a shared loop: about 30 us of work.
constexpr int kMovedPerBlock = 64;

// Maximum number of moved shapes of one body that share a search, and of their pairs that are stored until it
// ends.
constexpr int kMaxGroup = 8, kMaxGroupPairs = 256;

// Consecutive shapes of the move buffer that belong to one dynamic body, with the box around their fat AABBs.
template <class Real>
struct MovedGroup {
  int count = 0;
  int shapes[kMaxGroup];
  Aabb<Real> fat_aabbs[kMaxGroup];
  Aabb<Real> around{};
};

// Returns true if two moved shapes may share a search.
template <class Real>
bool may_share_search(const WorldData<Real>& w, const ShapeRecord<Real>& shape, int next) {
  const ShapeRecord<Real>& other = w.shapes[next];
  return other.body == shape.body && other.moved && other.proxy != kNone &&
         effective_mask(other.filter) == effective_mask(shape.filter);
}

// Collects the shapes of one body, starting at an index of the move buffer, as long as one search in the box
// around them enters fewer nodes than one search for each, estimated by their perimeters.
template <class Real>
MovedGroup<Real> collect_group(const WorldData<Real>& w, std::size_t first, std::size_t last) {
  MovedGroup<Real> out;
  const ShapeRecord<Real>& record = w.shapes[w.move_buffer[first]];
  for (std::size_t i = first; i < last && out.count < kMaxGroup; ++i) {
    const int shape = w.move_buffer[i];
    if (i > first && !may_share_search(w, record, shape)) break;
    const Aabb<Real>& box = w.dynamic_tree.box(w.shapes[shape].proxy);
    const Aabb<Real> around = i > first ? merged(out.around, box) : box;
    if (i > first && around.half_perimeter() > out.around.half_perimeter() + box.half_perimeter()) break;
    out.around = around;
    out.shapes[out.count] = shape, out.fat_aabbs[out.count] = box;
    ++out.count;
  }
  return out;
}

// Finds the pairs of several shapes of a dynamic body in one search of each tree, in the order in which one
// search for each shape would find them. Returns false, without a result, if there are too many.
template <class Real, class Found>
bool find_group_pairs(const WorldData<Real>& w, const MovedGroup<Real>& moved, const Found& found) {
  struct Candidate {
    int place, other;
  };
  Candidate candidates[kMaxGroupPairs];
  int count = 0;
  const ShapeRecord<Real>& record = w.shapes[moved.shapes[0]];
  const std::uint32_t mask = effective_mask(record.filter);
  const auto search = [&](const DynamicTree<Real>& tree) {
    tree.query(moved.around, mask, [&](int other, int proxy) {
      if (w.shapes[other].body == record.body) return true;
      const Aabb<Real>& box = tree.box(proxy);
      for (int i = 0; i < moved.count; ++i) {
        if (!box.overlaps(moved.fat_aabbs[i])) continue;
        if (count < kMaxGroupPairs) candidates[count] = {i, other};
        ++count;
      }
      return count <= kMaxGroupPairs;
    });
  };
  search(w.dynamic_tree);
  search(w.static_tree);
  if (count > kMaxGroupPairs) return false;
  for (int i = 0; i < moved.count; ++i)
    for (int k = 0; k < count; ++k)
      if (candidates[k].place == i) found(moved.shapes[i], candidates[k].other);
  return true;
}

// Finds the new pairs of a block of moved shapes.
template <class Real>
void find_pairs_of(WorldData<Real>& w, int block, bool marked, bool has_static) {
  BlockLists<std::pair<int, int>>& found = w.scratch.broad_phase.found_pairs_of;
  // Of two moved shapes, only one reports the pair.
  const auto note = [&](int shape, int other) {
    if (other != shape && !(w.shapes[other].moved && other < shape)) found.add(block, {shape, other});
  };
  const std::size_t first = static_cast<std::size_t>(block) * kMovedPerBlock,
                    last = std::min(first + kMovedPerBlock, w.move_buffer.size());
  for (std::size_t i = first; i < last; ++i) {
    prefetch_moved_shape(w, i);
    const int shape = w.move_buffer[i];
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone) continue;  // destroyed meanwhile
    // Without static shapes every proxy is in the dynamic tree, so one without an overlap can be skipped
    // without reading its body.
    if (marked && !has_static && w.scratch.broad_phase.has_overlap[record.proxy] == 0) continue;
    const BodyType type = w.bodies[record.body].type;
    const std::uint32_t mask = effective_mask(record.filter);
    if (mask == 0) continue;
    if (enabled(Switch::SharedSearches) && !marked && type == BodyType::Dynamic && i + 1 < last &&
        may_share_search(w, record, w.move_buffer[i + 1])) {
      const MovedGroup<Real> moved = collect_group(w, i, last);
      if (moved.count > 1 && find_group_pairs(w, moved, note)) {
        i += static_cast<std::size_t>(moved.count - 1);
        continue;
      }
    }
    const Aabb<Real>& box = w.tree_of(type).box(record.proxy);
    const auto visit = [&](int other, int) {
      note(shape, other);
      return true;
    };
    if (type == BodyType::Static || !marked || w.scratch.broad_phase.has_overlap[record.proxy] != 0)
      w.dynamic_tree.query(box, mask, visit);
    if (type == BodyType::Dynamic) w.static_tree.query(box, mask, visit);
  }
  // Most pairs have their contact already.
  found.template filter<kPairsAhead>(
      block, [&](const std::pair<int, int>& pair) { w.pairs.prefetch(pair.first, pair.second); },
      [&](const std::pair<int, int>& pair) {
        return !w.pairs.contains(pair.first, pair.second) && may_collide(w, pair.first, pair.second);
      });
}

// Predicts fat AABBs for this step for bodies that calls have created or moved.
template <class Real>
void predict_fat_aabbs(WorldData<Real>& w, Real dt) {
  for (const int shape : w.move_buffer) {
    const ShapeRecord<Real>& record = w.shapes[shape];
    if (!record.moved || record.proxy == kNone || !w.is_dynamic(record.body)) continue;
    const SolverBody<Real>& motion = w.motion[record.body];
    const Real extent = w.extents[record.body],
               rotation_distance = dt * std::abs(motion.angular_velocity) * extent;
    if (w.dynamic_tree.box(record.proxy)
            .contains(predicted_aabb(w.tight_aabbs[shape], dt * motion.velocity, rotation_distance, extent)))
      continue;
    w.dynamic_tree.enlarge(record.proxy, fat_aabb(w, shape, dt));
    w.enlarged[record.body] = 1;
  }
}

}  // namespace

template <class Real>
void find_pairs(WorldData<Real>& w, Real dt) {
  if (w.move_buffer.empty()) return;
  predict_fat_aabbs(w, dt);
  const bool marked = mark_self_overlaps(w);
  const bool has_static = w.static_tree.size() > 0;
  const int blocks = static_cast<int>((w.move_buffer.size() + kMovedPerBlock - 1) / kMovedPerBlock);
  w.scratch.broad_phase.found_pairs_of.begin(blocks);
  w.scheduler.blocks(blocks, [&](int block) { find_pairs_of(w, block, marked, has_static); });
  w.scratch.broad_phase.found_pairs_of.for_each([&](const std::pair<int, int>& pair) {
    // If a shape was created in the slot of a destroyed one that had moved, it is listed twice, and finds its
    // pairs twice.
    if (!w.pairs.contains(pair.first, pair.second) && passes_user_filter(w, pair.first, pair.second))
      create_contact(w, pair.first, pair.second);
  });
  // Clear the flags last: if memory runs out above, these pairs are searched again.
  for (std::size_t i = 0; i < w.move_buffer.size(); ++i) {
    prefetch_moved_shape(w, i);
    w.shapes[w.move_buffer[i]].moved = false;
  }
  w.move_buffer.clear();
}

template void find_pairs(WorldData<float>&, float);
template void find_pairs(WorldData<double>&, double);

}  // namespace plumb
