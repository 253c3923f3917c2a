#include "engine/realtime/realtime.h"

namespace plumb {

/// Explicit Euler, as the course starts with it: first order; it gains energy. Under gravity alone
/// y_n = y_0 + v_0 t - g t (t - h) / 2: too little by g h t / 2.
template <class Real>
void RealtimeDriver<Real>::explicit_euler(double t, Real h) {
  stage(Forces, [&] { evaluate_forces(t, t + static_cast<double>(h), bodies_.twist); });  // a(x, v)
  drift(h);                                                                               // x += v h
  stage(Kick, [&] { kick(h); });                                                          // v += a h
  collide(h);   // J v = 0, v_n >= -e v_n
  push_out(h);  // s >= 0 where bodies overlap
}

template void RealtimeDriver<float>::explicit_euler(double, float);
template void RealtimeDriver<double>::explicit_euler(double, double);

}  // namespace plumb
