#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "engine/core/mutex.h"

namespace plumb {

/// Lists of the results of a loop's blocks (crew.h), one list per block, to be read in the order of the
/// blocks: the same for every number of threads. Lists consist of chunks from a common store that is kept, so
/// that the amount of memory in use does not depend on the threads either.
template <class T>
class BlockLists {
 public:
  /// Empties the lists, for a loop of `blocks` blocks.
  void begin(int blocks) {
    // Free most of the memory if an earlier step, such as the first one of a scene, was much larger.
    if (chunks_.size() > kKept && chunks_.size() > 4 * used_) chunks_.resize(std::max(kKept, 2 * used_));
    used_ = 0;
    lists_.assign(static_cast<std::size_t>(blocks), {});
  }

  /// Appends to the list of a block; to be called by the thread that runs the block.
  void add(int block, const T& value) {
    List& list = lists_[static_cast<std::size_t>(block)];
    if (list.last == nullptr || list.last->count == kChunk) take_chunk(list);
    list.last->items[list.last->count++] = value;
  }

  /// Keeps the values of a block for which `test(value)` is true. Calls `look(value)` `kAhead` values
  /// earlier, to prefetch the data that the test reads.
  template <int kAhead, class Look, class Test>
  void keep(int block, const Look& look, const Test& test) {
    List& list = lists_[static_cast<std::size_t>(block)];
    if (list.first == nullptr) return;
    Chunk* to = list.first;
    int kept = 0;
    for (Chunk* from = list.first; from != nullptr; from = from->next) {
      for (int i = 0; i < std::min(kAhead, from->count); ++i) look(from->items[i]);
      for (int i = 0; i < from->count; ++i) {
        if (i + kAhead < from->count) look(from->items[i + kAhead]);
        if (!test(from->items[i])) continue;
        if (kept == kChunk) to = to->next, kept = 0;
        to->items[kept++] = from->items[i];
      }
    }
    to->count = kept;
    list.last = to;
    for (Chunk* rest = to->next; rest != nullptr; rest = rest->next) rest->count = 0;
  }

  /// Calls `visit(value)` for the values of a block, in their order.
  template <class Visit>
  void for_each_of(int block, Visit&& visit) {
    for (Chunk* chunk = lists_[static_cast<std::size_t>(block)].first; chunk != nullptr; chunk = chunk->next)
      for (int i = 0; i < chunk->count; ++i) visit(chunk->items[i]);
  }
  /// Calls `visit(value)` for all, in the order of the blocks.
  template <class Visit>
  void for_each(Visit&& visit) {
    if (used_ == 0) return;
    for (int block = 0; block < static_cast<int>(lists_.size()); ++block) for_each_of(block, visit);
  }
  bool empty() const { return used_ == 0; }

 private:
  static constexpr int kChunk = std::max(4, static_cast<int>(2048 / sizeof(T)));
  static constexpr std::size_t kKept = 16;
  struct Chunk {
    int count = 0;
    Chunk* next = nullptr;
    T items[kChunk];
  };
  struct List {
    Chunk *first = nullptr, *last = nullptr;
  };

  void take_chunk(List& list) {
    Chunk* chunk;
    {
      const MutexLock lock(taking_);
      if (used_ == chunks_.size()) chunks_.push_back(std::make_unique<Chunk>());
      chunk = chunks_[used_++].get();
    }
    chunk->count = 0, chunk->next = nullptr;
    (list.first == nullptr ? list.first : list.last->next) = chunk;
    list.last = chunk;
  }

  std::vector<List> lists_;
  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::size_t used_ = 0;
  Mutex taking_;
};

}  // namespace plumb
