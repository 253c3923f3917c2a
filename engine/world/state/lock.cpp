#include "engine/world/state/lock.h"

#include "engine/scene/error.h"

namespace plumb {

template <class Real>
void require_unlocked(const WorldData<Real>& w) {
  if (!w.stepping && w.active_callbacks == 0) return;
  throw Error(Error::Kind::Unsupported, "world", "", "",
              w.stepping
                  ? "cannot be changed from within its step; have the hook note what is to be done, and do "
                    "it after the step"
                  : "cannot be changed while a force law, a query's visitor, a filter, a combine rule or a "
                    "drawing looks at it; note what is to be done, and do it afterwards");
}

template <class Real>
void require_between_steps(const WorldData<Real>& w) {
  if (!w.stepping) return;
  throw Error(Error::Kind::Unsupported, "world", "", "",
              "cannot be saved from within its step; save it before or after the step");
}

template <class Real>
WorldData<Real>& unlocked(BasicWorld<Real>& world) {
  WorldData<Real>& w = world.data();
  require_unlocked(w);
  return w;
}

template <class Real>
WorldData<Real>& unlocked_with_masses(BasicWorld<Real>& world) {
  WorldData<Real>& w = unlocked(world);
  if (!w.mass_changed_bodies.empty()) apply_mass_changes(w);
  return w;
}

#define PLUMB_FOR(Real)                                        \
  template void require_unlocked(const WorldData<Real>&);      \
  template void require_between_steps(const WorldData<Real>&); \
  template WorldData<Real>& unlocked(BasicWorld<Real>&);       \
  template WorldData<Real>& unlocked_with_masses(BasicWorld<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
