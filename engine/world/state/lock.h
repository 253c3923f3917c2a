#pragma once

#include "engine/world/state/mass.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"

/// A world is locked while it calls the user's code (a pre-solve hook, a combine rule, a force law, a query's
/// visitor or filter, a drawing). Calls that would change it then throw Error (Unsupported) and change
/// nothing. Reading is allowed.
namespace plumb {

/// Throws if the world is locked.
template <class Real>
void require_unlocked(const WorldData<Real>& w);
/// Throws during a step, because the data are then not the state of any step.
template <class Real>
void require_between_steps(const WorldData<Real>& w);

/// Returns the data of an unlocked world, for calls that change it.
template <class Real>
WorldData<Real>& unlocked(BasicWorld<Real>& world);
/// Does the same, and updates all masses. For calls that act on motions.
template <class Real>
WorldData<Real>& unlocked_with_masses(BasicWorld<Real>& world);

/// Ends a use of the world. If the user destroyed the world from a callback, the last use deletes its data.
template <class Real>
void end_use(const WorldData<Real>& w) {
  if (w.abandoned && !w.stepping && w.active_callbacks == 0) delete &w;
}

/// Locks the world while the user's code reads it. Locks may overlap, also from several threads.
template <class Real>
class Lock {
 public:
  /// `has_user_code` is false if there is no user code to call; then nothing is locked.
  explicit Lock(const WorldData<Real>& w, bool has_user_code = true) : w_(has_user_code ? &w : nullptr) {
    if (w_ != nullptr) w_->active_callbacks.fetch_add(1, std::memory_order_relaxed);
  }
  ~Lock() {
    if (w_ == nullptr) return;
    w_->active_callbacks.fetch_sub(1, std::memory_order_relaxed);
    end_use(*w_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  const WorldData<Real>* w_;
};

}  // namespace plumb
