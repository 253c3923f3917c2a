#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "engine/core/mutex.h"

namespace plumb {

/// Lists of the results of a loop's blocks (loop_scheduler.h), one list per block, to be read in the order of
/// the blocks: the same for every number of threads. Lists consist of chunks from a common store that is
/// kept, so that the amount of memory in use does not depend on the threads either.
template <class T>
class BlockLists {
 public:
  /// Empties the lists, for a loop of `blocks` blocks.
  void begin(int blocks) {
    // Free most of the memory if an earlier step, such as the first one of a scene, was much larger.
    if (chunks_.size() > kRetainedChunks && chunks_.size() > 4 * used_)
      chunks_.resize(std::max(kRetainedChunks, 2 * used_));
    used_ = 0;
    lists_.assign(static_cast<std::size_t>(blocks), {});
  }

  /// Appends to the list of a block; to be called by the thread that runs the block.
  void add(int block, const T& value) {
    List& list = lists_[static_cast<std::size_t>(block)];
    if (list.last == nullptr || list.last->count == kChunk) add_chunk(list);
    list.last->items[list.last->count++] = value;
  }

  /// Keeps the values of a block for which `test(value)` is true. Calls `prefetch(value)` `kAhead` values
  /// earlier, to prefetch the data that the test reads.
  template <int kAhead, class Prefetch, class Test>
  void filter(int block, const Prefetch& prefetch, const Test& test) {
    List& list = lists_[static_cast<std::size_t>(block)];
    if (list.first == nullptr) return;
    Chunk* to = list.first;
    int kept = 0;
    for (Chunk* from = list.first; from != nullptr; from = from->next) {
      for (int i = 0; i < std::min(kAhead, from->count); ++i) prefetch(from->items[i]);
      for (int i = 0; i < from->count; ++i) {
        if (i + kAhead < from->count) prefetch(from->items[i + kAhead]);
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
  static constexpr std::size_t kRetainedChunks = 16;
  struct Chunk {
    int count = 0;
    Chunk* next = nullptr;
    T items[kChunk];
  };
  struct List {
    Chunk *first = nullptr, *last = nullptr;
  };

  void add_chunk(List& list) {
    Chunk* chunk;
    {
      const MutexLock lock(mutex_);
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
  Mutex mutex_;
};

}  // namespace plumb
