#include "engine/solve/bounces.h"

#include <algorithm>
#include <cmath>

#include "engine/solve/contact_pair.h"

namespace plumb {
namespace {

template <class Real>
Real velocity_along_normal(const BodyMotion<Real>* motion, const ContactConstraint<Real>& c, int i) {
  const BodyMotion<Real>&a = motion[c.body_a], &b = motion[c.body_b];
  return dot(c.normal, b.velocity - a.velocity) +
         (c.arm_b[i] * b.angular_velocity - c.arm_a[i] * a.angular_velocity);
}

// Impulses that make points which strike leave at `speeds`: Newton's law.
template <class Real>
void leave_at(BodyMotion<Real>* motion, const Bounce<Real>& bounce, const Real (&speeds)[2]) {
  ContactConstraint<Real>& c = *bounce.contact;
  if (!bounce.strikes[0] && !bounce.strikes[1]) return;
  Pair<Real> pair(motion, c);
  if (bounce.strikes[0] && bounce.strikes[1]) {
    press(pair, c, Demand<Real>{-speeds[0], 1, 0}, Demand<Real>{-speeds[1], 1, 0});
  } else {
    const int i = bounce.strikes[0] ? 0 : 1;
    const Real before = c.normal_impulse[i];
    const Real rate = pair.along_normal() + (c.arm_b[i] * pair.wb - c.arm_a[i] * pair.wa) - speeds[i];
    c.normal_impulse[i] = std::max(before - c.mass[i] * rate, Real(0));
    const Real d = c.normal_impulse[i] - before;
    pair.push(d, c.arm_a[i] * d, c.arm_b[i] * d);
  }
  note_peaks(c);
  pair.store();
}

// What is still open when the substep ends, and closes fast enough to bounce in the next one, is not to be
// slowed before: takes back what the sweeps gave it.
template <class Real>
void let_strike(BodyMotion<Real>* motion, const Bounce<Real>& bounce) {
  ContactConstraint<Real>& c = *bounce.contact;
  const bool open = c.now[0] > 0 && (c.count == 1 || c.now[1] > 0);
  const Real pressed = c.normal_impulse[0] + c.normal_impulse[1];
  if (!bounce.closes || !open || pressed == 0) return;
  Pair<Real> pair(motion, c);
  pair.push(-pressed, -(c.arm_a[0] * c.normal_impulse[0] + c.arm_a[1] * c.normal_impulse[1]),
            -(c.arm_b[0] * c.normal_impulse[0] + c.arm_b[1] * c.normal_impulse[1]));
  pair.rub(c, -c.tangent_impulse);
  pair.roll(-c.rolling_impulse);
  pair.store();
  c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  c.peak_impulse[0] = c.peak_impulse[1] = 0;
}

}  // namespace

template <class Real>
void find_bounces(ContactGraph<Real>& graph, std::vector<Bounce<Real>>& bounces) {
  bounces.clear();
  graph.for_each([&](ContactConstraint<Real>& c) {
    if (c.restitution > 0) bounces.push_back({.contact = &c});
  });
}

template <class Real>
void note_approaches(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                     const ContactStep<Real>& step) {
  for (Bounce<Real>& bounce : bounces) {
    ContactConstraint<Real>& c = *bounce.contact;
    bool parts = true;
    for (int i = 0; i < c.count; ++i) {
      bounce.before[i] = velocity_along_normal(motion, c, i);
      parts = parts && bounce.before[i] > Real(0.5) * c.restitution * step.bounce_threshold;
    }
    if (!parts) continue;
    c.normal_impulse[0] = c.normal_impulse[1] = c.tangent_impulse = c.rolling_impulse = 0;
  }
}

template <class Real>
bool place_bounces(const BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                   const ContactStep<Real>& step) {
  const Real h = step.h;
  bool any = false;
  for (Bounce<Real>& bounce : bounces) {
    const ContactConstraint<Real>& c = *bounce.contact;
    bounce.closes = false;
    for (int i = 0; i < c.count; ++i) {
      const Real closing = -velocity_along_normal(motion, c, i), s = std::max(c.now[i], Real(0));
      const Real u = -bounce.before[i], a = (closing - u) * step.inverse_h;
      const Real strike = std::sqrt(std::max(u * u + 2 * a * s, Real(0)));
      bounce.closes = bounce.closes || closing > step.bounce_threshold;
      // Sooner than not: whether it is pressed decides in the end, and must not be missed by rounding.
      bounce.strikes[i] = closing * h > Real(0.999) * s && strike > step.bounce_threshold;
      if (!bounce.strikes[i]) continue;
      any = true;
      const Real left = u + strike > 0 ? std::max(h - 2 * s / (u + strike), Real(0)) : Real(0);
      const Real rebound = c.restitution * strike;
      bounce.way[i] = std::max(left * (rebound - Real(0.5) * a * left), Real(0));
      bounce.speed[i] = std::max(rebound - a * left, Real(0));
    }
  }
  return any;
}

template <class Real>
void bounce_positions(BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces,
                      const ContactStep<Real>& step) {
  for (Bounce<Real>& bounce : bounces) {
    const ContactConstraint<Real>& c = *bounce.contact;
    // A point that another contact has held back in the meantime does not strike.
    for (int i = 0; i < 2; ++i) bounce.strikes[i] = bounce.strikes[i] && c.normal_impulse[i] > 0;
    leave_at(motion, bounce,
             {(bounce.way[0] - std::max(c.now[0], Real(0))) * step.inverse_h,
              (bounce.way[1] - std::max(c.now[1], Real(0))) * step.inverse_h});
  }
}

template <class Real>
void bounce_velocities(BodyMotion<Real>* motion, std::vector<Bounce<Real>>& bounces) {
  for (const Bounce<Real>& bounce : bounces) {
    if (bounce.strikes[0] || bounce.strikes[1]) {
      leave_at(motion, bounce, bounce.speed);
    } else {
      let_strike(motion, bounce);
    }
  }
}

#define PLUMB_FOR(Real)                                                                                    \
  template void find_bounces(ContactGraph<Real>&, std::vector<Bounce<Real>>&);                             \
  template void note_approaches(const BodyMotion<Real>*, std::vector<Bounce<Real>>&,                       \
                                const ContactStep<Real>&);                                                 \
  template bool place_bounces(const BodyMotion<Real>*, std::vector<Bounce<Real>>&,                         \
                              const ContactStep<Real>&);                                                   \
  template void bounce_positions(BodyMotion<Real>*, std::vector<Bounce<Real>>&, const ContactStep<Real>&); \
  template void bounce_velocities(BodyMotion<Real>*, std::vector<Bounce<Real>>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
