#include "engine/world/world_data.h"

namespace plumb {

template <class Real>
WorldData<Real>::WorldData() {}
template <class Real>
WorldData<Real>::~WorldData() {}

template WorldData<float>::WorldData();
template WorldData<float>::~WorldData();
template WorldData<double>::WorldData();
template WorldData<double>::~WorldData();

}  // namespace plumb
