#pragma once

#include "engine/world/mass.h"
#include "engine/world/world.h"
#include "engine/world/world_data.h"

/// A world that calls the user's code (a pre-solve hook, a combine rule, a force law, a query's visitor or
/// filter) is at work on itself, or has others at work on it: until that code has returned it is locked, and
/// whatever would change it throws Error (Unsupported), with nothing changed. Reading is allowed.
namespace plumb {

/// Throws when the world is locked.
template <class Real>
void require_unlocked(const WorldData<Real>& w);
/// Throws when the world is in a step: its state is of no step then.
template <class Real>
void require_between_steps(const WorldData<Real>& w);

/// What a call that changes the world works on.
template <class Real>
WorldData<Real>& unlocked(BasicWorld<Real>& world);
/// Likewise, with all masses known: for whatever acts on motions.
template <class Real>
WorldData<Real>& settled(BasicWorld<Real>& world);

/// Ends a use of the world. Who destroys a world from a callback leaves what it consists of to the last use.
template <class Real>
void end_use(const WorldData<Real>& w) {
  if (w.abandoned && !w.stepping && w.callers == 0) delete &w;
}

/// Locks the world while the user's code looks at it. Such looks may be taken side by side.
template <class Real>
class Lock {
 public:
  /// `wanted`: whether there is code of the user's.
  explicit Lock(const WorldData<Real>& w, bool wanted = true) : w_(wanted ? &w : nullptr) {
    if (w_ != nullptr) w_->callers.fetch_add(1, std::memory_order_relaxed);
  }
  ~Lock() {
    if (w_ == nullptr) return;
    w_->callers.fetch_sub(1, std::memory_order_relaxed);
    end_use(*w_);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  const WorldData<Real>* w_;
};

}  // namespace plumb
