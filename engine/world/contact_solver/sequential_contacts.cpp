#include "engine/world/contact_solver/sequential_contacts.h"

#include <algorithm>

#include "engine/world/contact_solver/contact_rows.h"

namespace plumb {
namespace {

// Returns the minimum velocity of a point along n: a gap may close within the substep, a fast impact
// separates with restitution times its approach speed.
template <class Real>
Real min_normal_velocity(const ContactPair<Real>& pair, int i, const SequentialStep<Real>& step) {
  const ContactConstraint<Real>& c = pair.c;
  const Real s = pair.separation(i);
  const Real target = -std::max(s, Real(0)) * step.inverse_h;
  const bool arrives =
      c.restitution > 0 && c.approach[i] < -step.bounce_threshold && s + step.h * c.approach[i] < 0;
  return arrives ? std::max(target, -effective_restitution(c) * c.approach[i]) : target;
}

template <class Real>
void warm_start_one(ContactPair<Real> pair, Real ratio) {
  ContactConstraint<Real>& c = pair.c;
  const Real normal[2] = {ratio * c.normal_impulse[0], ratio * c.normal_impulse[1]};
  const Real friction = ratio * c.tangent_impulse, rolling = ratio * c.rolling_impulse;
  c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  if (!is_driven(c)) c.load_estimate[0] = c.load_estimate[1] = 0;
  pair.apply_normal(normal[0], normal[1]);
  pair.set_friction(friction);
  if (c.rolling_arm > 0) pair.set_rolling(rolling);
}

}  // namespace

template <class Real>
void warm_start_sequentially(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                             const SequentialStep<Real>& step) {
  graph.for_each(
      [&](ContactConstraint<Real>& c) { warm_start_one(ContactPair<Real>(motion, c), step.warm_start); });
}

template <class Real>
void iterate_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    ContactPair<Real> pair(motion, c);
    // Friction first: rows solved last are satisfied best.
    pair.solve_friction_and_rolling();
    Real min_velocity[2] = {};
    for (int i = 0; i < c.count; ++i) min_velocity[i] = min_normal_velocity(pair, i, step);
    pair.solve_normal_block(min_velocity, true, c.count == 2);
  });
}

template <class Real>
void stop_closed_gaps(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    ContactPair<Real> pair(motion, c);
    pair.record_max_impulse();
    bool closed_gap[2] = {};
    for (int i = 0; i < c.count; ++i) {
      const Real rate = pair.normal_velocity(i);
      closed_gap[i] = c.normal_impulse[i] > 0 && rate < 0 && pair.separation(i) - step.h * rate > 0;
    }
    if (closed_gap[0] || closed_gap[1]) pair.solve_normal_block({0, 0}, closed_gap[0], closed_gap[1]);
  });
}

#define PLUMB_FOR(Real)                                                                                \
  template void warm_start_sequentially(SolverBody<Real>*, ContactGraph<Real>&,                        \
                                        const SequentialStep<Real>&);                                  \
  template void iterate_contacts(SolverBody<Real>*, ContactGraph<Real>&, const SequentialStep<Real>&); \
  template void stop_closed_gaps(SolverBody<Real>*, ContactGraph<Real>&, const SequentialStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
