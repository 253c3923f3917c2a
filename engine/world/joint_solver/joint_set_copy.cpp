#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {

template <class Real>
void JointSet<Real>::assign(const JointSet& other) {
  *parts_ = *other.parts_;
}

template void JointSet<float>::assign(const JointSet&);
template void JointSet<double>::assign(const JointSet&);

}  // namespace plumb
