#include "engine/realtime/realtime.h"

namespace plumb {

/// Velocity Verlet with constraints: RATTLE (Andersen 1983) for joints, the same for contacts as
/// inequalities. Second order; forces that depend on velocity enter the second half kick at a predicted
/// velocity.
template <class Real>
void RealtimeDriver<Real>::velocity_verlet(double t, Real h) {
  const Real half = h / 2;
  const double middle = t + static_cast<double>(half), end = t + static_cast<double>(h);

  stage(Forces, [&] { evaluate_forces(t, middle, bodies_.twist); });  // a(x, v)
  stage(Kick, [&] { kick(half); });                                   // v += a h/2
  stage(JointHold, [&] { joints_->begin_substep(bodies_, h); });      // A = J M^-1 J^T at x
  stage(Restitution, [&] { resolve_impacts(h); });                    // v_n -> -e v_n at the time of contact
  hold(h);                                                            // C(x + h v) = 0, s + h v_n >= 0
  drift(h);                                                           // x += v h
  push_out(h);                                                        // s >= 0 where bodies overlap
  stage(Forces, [&] {
    predict_velocities(half);
    evaluate_forces(middle, end, predicted_);  // a(x', v + a h/2)
  });
  stage(Kick, [&] { kick(half); });  // v += a' h/2
  relax(h);                          // J v = 0, v_n >= 0
}

template void RealtimeDriver<float>::velocity_verlet(double, float);
template void RealtimeDriver<double>::velocity_verlet(double, double);

}  // namespace plumb
