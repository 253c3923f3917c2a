#include "engine/world/rollback.h"

#include <string>

#include "engine/scene/error.h"
#include "engine/world/snapshot/world_members.h"
#include "engine/world/state/lock.h"

namespace plumb {
namespace {

template <class T>
void copy(const T& from, T& to) {
  to = from;
}
template <class Real>
void copy(const JointSet<Real>& from, JointSet<Real>& to) {
  to.assign(from);
}

// Copies state into existing memory; hook and scratch are unchanged.
template <class Real>
void copy_state(const WorldData<Real>& from, WorldData<Real>& to) {
  const auto source = state_of(from);
  const auto target = state_of(to);
  [&]<std::size_t... kEach>(std::index_sequence<kEach...>) {
    (copy(std::get<kEach>(source), std::get<kEach>(target)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(source)>>{});
  to.topology_changed = true;
}

}  // namespace

template <class Real>
Rollback<Real>::Rollback(BasicWorld<Real>& world, int frames) : world_(&world) {
  if (frames < 1 || frames > 10000) {
    throw Error(Error::Kind::Value, "rollback", "frames", std::to_string(frames),
                "must be a number from 1 to 10000");
  }
  for (int i = 0; i < frames; ++i) ring_.push_back(OwnedPointer(new WorldData<Real>));
}
template <class Real>
Rollback<Real>::~Rollback() = default;
template <class Real>
Rollback<Real>::Rollback(Rollback&&) noexcept = default;
template <class Real>
Rollback<Real>& Rollback<Real>::operator=(Rollback&&) noexcept = default;

template <class Real>
int Rollback<Real>::capacity() const {
  return static_cast<int>(ring_.size());
}
template <class Real>
int Rollback<Real>::slot_of(int nth) const {
  return (first_ + nth) % capacity();
}
template <class Real>
std::int64_t Rollback<Real>::step_of(int nth) const {
  return ring_[slot_of(nth)]->steps;
}
template <class Real>
int Rollback<Real>::find(std::int64_t step) const {
  for (int nth = size_ - 1; nth >= 0; --nth) {
    if (step_of(nth) == step) return nth;
  }
  return -1;
}

template <class Real>
void Rollback<Real>::save() {
  require_between_steps(std::as_const(*world_).data());
  const std::int64_t step = world_->step_count();
  while (size_ > 0 && latest() >= step) --size_;
  if (size_ == capacity()) {
    first_ = slot_of(1);
    --size_;
  }
  copy_state(std::as_const(*world_).data(), *ring_[slot_of(size_)]);
  ++size_;
}

template <class Real>
void Rollback<Real>::back_to(std::int64_t step) {
  const int nth = find(step);
  if (nth < 0) {
    throw Error(Error::Kind::Value, "rollback", "step", std::to_string(step),
                size_ == 0 ? "is not kept: nothing has been saved"
                           : "is not kept: there are " + std::to_string(oldest()) + " to " +
                                 std::to_string(latest()));
  }
  copy_state(*ring_[slot_of(nth)], unlocked(*world_));
  size_ = nth + 1;
}

template class Rollback<float>;
template class Rollback<double>;

}  // namespace plumb
