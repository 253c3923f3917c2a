#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/owned_pointer.h"
#include "engine/world/world.h"

namespace plumb {

/// Stores the last states of a world for rollback: in network play, inputs arrive late, and the steps after
/// them are repeated. States are copies in memory, without serialisation, checksum or validation. Once each
/// slot of the ring has been used, neither saving nor rolling back allocates (unless the world has grown).
/// The world must outlive this object and must not move. A state contains the same data as a snapshot
/// (snapshot.h). After a rollback, handles created after the restored state are invalid.
template <class Real>
class Rollback {
 public:
  /// Keeps up to `frames` saved states. Throws Error (Value) unless `frames` is 1 to 10000.
  Rollback(BasicWorld<Real>& world, int frames);
  ~Rollback();
  Rollback(Rollback&&) noexcept;
  Rollback& operator=(Rollback&&) noexcept;

  /// Saves the current state under its step number. Drops saved states of this and later steps and, if the
  /// ring is full, the oldest.
  void save();

  /// Restores the state that was saved after `step` steps, and drops later ones. If there is none, throws
  /// Error (Value) and changes nothing.
  void back_to(std::int64_t step);

  bool holds(std::int64_t step) const { return find(step) >= 0; }
  int size() const { return size_; }
  int capacity() const;
  /// Step numbers of the first and last saved state; -1 if there is none.
  std::int64_t oldest() const { return size_ > 0 ? step_of(0) : -1; }
  std::int64_t latest() const { return size_ > 0 ? step_of(size_ - 1) : -1; }

 private:
  // States from the oldest to the latest are numbered 0 .. size - 1; their steps ascend.
  int slot_of(int nth) const;
  std::int64_t step_of(int nth) const;
  int find(std::int64_t step) const;

  BasicWorld<Real>* world_;
  std::vector<OwnedPointer<WorldData<Real>>> ring_;
  int first_ = 0, size_ = 0;
};

extern template class Rollback<float>;
extern template class Rollback<double>;

}  // namespace plumb
