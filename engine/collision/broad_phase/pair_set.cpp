#include "engine/collision/broad_phase/pair_set.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace plumb {

bool PairSet::insert(int a, int b) {
  assert(a != b && a >= 0 && b >= 0);
  if (2 * (static_cast<std::size_t>(size_) + 1) > keys_.size()) resize(std::max(kSmallest, 2 * keys_.size()));
  const Key wanted = key(a, b);
  Key& slot = keys_[find(wanted)];
  if (slot == wanted) return false;
  slot = wanted;
  ++size_;
  return true;
}

bool PairSet::erase(int a, int b) {
  if (keys_.empty()) return false;
  std::size_t hole = find(key(a, b));
  if (keys_[hole] == kEmpty) return false;
  const std::size_t mask = keys_.size() - 1;
  for (std::size_t slot = (hole + 1) & mask; keys_[slot] != kEmpty; slot = (slot + 1) & mask) {
    // A key may move back to the hole unless its home lies behind the hole, where no probe would pass it.
    const std::size_t home = hash(keys_[slot]) & mask;
    if (((slot - home) & mask) < ((slot - hole) & mask)) continue;
    keys_[hole] = keys_[slot];
    hole = slot;
  }
  keys_[hole] = kEmpty;
  --size_;
  return true;
}

void PairSet::clear() {
  std::fill(keys_.begin(), keys_.end(), kEmpty);
  size_ = 0;
}

void PairSet::reserve(int pairs) {
  const std::size_t needed = std::bit_ceil(2 * static_cast<std::size_t>(std::max(pairs, 0)));
  if (needed > keys_.size()) resize(std::max(kSmallest, needed));
}

void PairSet::resize(std::size_t capacity) {
  const std::vector<Key> old = std::exchange(keys_, std::vector<Key>(capacity, kEmpty));
  for (const Key each : old)
    if (each != kEmpty) keys_[find(each)] = each;
}

double PairSet::mean_probes() const {
  if (size_ == 0) return 0;
  const std::size_t mask = keys_.size() - 1;
  double sum = 0;
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (keys_[i] != kEmpty) sum += static_cast<double>(((i - hash(keys_[i])) & mask) + 1);
  return sum / size_;
}

}  // namespace plumb
