#include "engine/realtime/broad_phase.h"

namespace plumb {

template <class Real>
bool BroadPhase<Real>::place(int shape, const Aabb<Real>& swept, Real margin) {
  const Aabb<Real> wanted = swept.grown(margin);
  const Aabb<Real>& stored = tree_.box(shape);
  // A long box left over from a fast motion would find pairs that are far away.
  constexpr Real kNeedlesslyLarge = 2;
  if (holds(shape) && stored.contains(swept) &&
      stored.half_perimeter() <= kNeedlesslyLarge * wanted.half_perimeter())
    return false;
  put(shape, wanted);
  if (!moved_flag_[shape]) moved_.push_back(shape);
  moved_flag_[shape] = true;
  return true;
}

template <class Real>
void BroadPhase<Real>::put(int shape, const Aabb<Real>& box) {
  tree_.place(shape, box);
}

template class BroadPhase<float>;
template class BroadPhase<double>;

}  // namespace plumb
