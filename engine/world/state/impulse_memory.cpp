#include "engine/world/state/impulse_memory.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"

namespace plumb {
namespace {

// Decrease of `impulse_h` per second of shorter steps. At 1/4 it becomes h within the duration of a step of
// four substeps of the old length. With less, loads that change in slow motion are found later; with more,
// steps of 1 and 0.1 in turn are divided into more substeps.
constexpr double kShrinkRate = 0.25;

// Returns true if the solver starts from stored impulses; position-based ones start without.
bool starts_warm(Solver solver) {
  return solver == Solver::SoftSteps || solver == Solver::Direct || solver == Solver::SequentialImpulses;
}

// Calls visit(impulse) for each impulse of a contact that warm starting applies.
template <class Real, class Visit>
void for_each_impulse(ContactConstraint<Real>& c, const Visit& visit) {
  visit(c.normal_impulse[0]), visit(c.normal_impulse[1]), visit(c.tangent_impulse), visit(c.rolling_impulse);
}

}  // namespace

template <class Real>
ImpulseMemory<Real>::ImpulseMemory(WorldData<Real>& w, double h)
    : w_(w),
      h_(h),
      shorter_(enabled(Switch::ImpulseMemory) && starts_warm(w.settings.solver) && h < w.impulse_h) {
  if (!shorter_) return;
  std::vector<Real>& earlier = w.scratch.solver.earlier_impulses;
  earlier.clear();
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    for_each_impulse(c, [&](Real impulse) { earlier.push_back(impulse); });
  });
  w.joint_set.append_impulses(earlier);
}

template <class Real>
void ImpulseMemory<Real>::finish(double dt) {
  if (shorter_) {
    const double shrunk = std::max(h_, w_.impulse_h - kShrinkRate * dt);
    const Real kept = static_cast<Real>((1 - h_ / w_.impulse_h) * shrunk / w_.impulse_h),
               scale = static_cast<Real>(shrunk / w_.impulse_h);
    const std::vector<Real>& earlier = w_.scratch.solver.earlier_impulses;
    std::size_t next = 0;
    w_.graph.for_each([&](ContactConstraint<Real>& c) {
      for_each_impulse(c, [&](Real& impulse) { impulse = kept * earlier[next++] + scale * impulse; });
      for (Real& load : c.load_estimate) load *= static_cast<Real>(shrunk / h_);
    });
    w_.joint_set.add_impulses(std::span<const Real>(earlier).subspan(next), kept, scale);
    w_.impulse_h = shrunk;
  } else {
    w_.impulse_h = h_;
  }
  w_.last_h = h_, w_.last_substeps = static_cast<int>(std::lround(dt / h_));
}

template class ImpulseMemory<float>;
template class ImpulseMemory<double>;

}  // namespace plumb
