#include "engine/world/contact_solver/sequential_contacts.h"

#include <algorithm>

#include "engine/world/contact_solver/contact_rows.h"

namespace plumb {
namespace {

// Returns the minimum velocity of a point along n. A gap may close within the substep; a fast impact
// separates with restitution times its approach speed.
template <class Real>
Real least_rate(const ContactPair<Real>& pair, int i, const SequentialStep<Real>& step) {
  const ContactConstraint<Real>& c = pair.c;
  const Real s = pair.separation(i);
  const Real wanted = -std::max(s, Real(0)) * step.inverse_h;
  const bool arrives =
      c.restitution > 0 && c.approach[i] < -step.bounce_threshold && s + step.h * c.approach[i] < 0;
  return arrives ? std::max(wanted, -c.restitution * c.approach[i]) : wanted;
}

template <class Real>
void warm_start_one(ContactPair<Real> pair, Real ratio) {
  ContactConstraint<Real>& c = pair.c;
  const Real normal[2] = {ratio * c.normal_impulse[0], ratio * c.normal_impulse[1]};
  const Real friction = ratio * c.tangent_impulse, rolling = ratio * c.rolling_impulse;
  c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  c.load_estimate[0] = c.load_estimate[1] = 0;
  pair.push(normal[0], normal[1]);
  pair.rub(friction);
  if (c.rolling_arm > 0) pair.roll(rolling);
}

}  // namespace

template <class Real>
void warm_start_sequentially(SolverBody<Real>* motion, ContactGraph<Real>& graph,
                             const SequentialStep<Real>& step) {
  graph.for_each(
      [&](ContactConstraint<Real>& c) { warm_start_one(ContactPair<Real>(motion, c), step.warm_start); });
}

template <class Real>
void sweep_contacts(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    ContactPair<Real> pair(motion, c);
    // Friction first: rows solved last are satisfied best.
    pair.rub_and_roll();
    Real least[2] = {};
    for (int i = 0; i < c.count; ++i) least[i] = least_rate(pair, i, step);
    pair.press(least, true, c.count == 2);
  });
}

template <class Real>
void stop_arrivals(SolverBody<Real>* motion, ContactGraph<Real>& graph, const SequentialStep<Real>& step) {
  graph.for_each([&](ContactConstraint<Real>& c) {
    ContactPair<Real> pair(motion, c);
    pair.note_peaks();
    bool arrived[2] = {};
    for (int i = 0; i < c.count; ++i) {
      const Real rate = pair.normal_rate(i);
      arrived[i] = c.normal_impulse[i] > 0 && rate < 0 && pair.separation(i) - step.h * rate > 0;
    }
    if (arrived[0] || arrived[1]) pair.press({0, 0}, arrived[0], arrived[1]);
  });
}

#define PLUMB_FOR(Real)                                                                              \
  template void warm_start_sequentially(SolverBody<Real>*, ContactGraph<Real>&,                      \
                                        const SequentialStep<Real>&);                                \
  template void sweep_contacts(SolverBody<Real>*, ContactGraph<Real>&, const SequentialStep<Real>&); \
  template void stop_arrivals(SolverBody<Real>*, ContactGraph<Real>&, const SequentialStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
