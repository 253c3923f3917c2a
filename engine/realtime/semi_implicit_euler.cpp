#include "engine/realtime/realtime.h"

namespace plumb {

/// Semi-implicit (symplectic) Euler, as the course has it: first order, and steady. Under gravity alone
/// y_n = y_0 + v_0 t - g t (t + h) / 2: too far by g h t / 2.
template <class Real>
void RealtimeDriver<Real>::semi_implicit_euler(double t, Real h) {
  stage(Forces, [&] { evaluate_forces(t, t + static_cast<double>(h), bodies_.twist); });  // a(x, v)
  stage(Kick, [&] { kick(h); });                                                          // v += a h
  collide(h);   // J v = 0, v_n >= -e v_n
  drift(h);     // x += v h
  push_out(h);  // s >= 0 where bodies overlap
}

template void RealtimeDriver<float>::semi_implicit_euler(double, float);
template void RealtimeDriver<double>::semi_implicit_euler(double, double);

}  // namespace plumb
