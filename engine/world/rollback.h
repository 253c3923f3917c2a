#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/world/world.h"

namespace plumb {

/// The last states of a world, to go back to: for network play, where inputs arrive late and the steps since
/// then are taken again. States are copies in memory, not bytes: no checksum is made and nothing has to be
/// checked. Once each place of the ring has been used, neither saving nor going back allocates (unless the
/// world has grown since).
///
/// The world must outlive this and stay where it is. A state holds what a snapshot holds (snapshot.h);
/// handles from after it are gone once the world went back.
template <class Real>
class Rollback {
 public:
  /// Keeps the last `frames` states that are saved. Throws Error (Value) unless there are 1 to 10000.
  Rollback(BasicWorld<Real>& world, int frames);
  ~Rollback();
  Rollback(Rollback&&) noexcept;
  Rollback& operator=(Rollback&&) noexcept;

  /// Keeps the world as it is now, under its number of steps. What was kept of this step or a later one is
  /// dropped; when the ring is full, the oldest state is.
  void save();

  /// Makes the world what it was when `step` steps had been taken; later states are dropped. Throws Error
  /// (Value) when that one is not kept; nothing has changed then.
  void back_to(std::int64_t step);

  bool holds(std::int64_t step) const { return find(step) >= 0; }
  int size() const { return size_; }
  int capacity() const;
  /// Steps of the first and last state; -1 when there is none.
  std::int64_t oldest() const { return size_ > 0 ? step_of(0) : -1; }
  std::int64_t latest() const { return size_ > 0 ? step_of(size_ - 1) : -1; }

 private:
  // States from the oldest to the latest are numbered 0 .. size - 1; their steps ascend.
  int place_of(int nth) const;
  std::int64_t step_of(int nth) const;
  int find(std::int64_t step) const;

  BasicWorld<Real>* world_;
  std::vector<std::unique_ptr<WorldData<Real>>> ring_;
  int first_ = 0, size_ = 0;
};

extern template class Rollback<float>;
extern template class Rollback<double>;

}  // namespace plumb
