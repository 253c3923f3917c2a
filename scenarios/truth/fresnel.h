#pragma once

#include "scenarios/truth/motion.h"

namespace plumb::scenarios::truth {

/// Returns the Fresnel integrals (C(s), S(s)) of cos and sin of pi u^2/2 from 0 to s. Gauss-Legendre
/// quadrature over panels in which the phase makes a quarter turn. Source: Abramowitz and Stegun 7.3.1,
/// 7.3.2.
Vec2<Real> fresnel(Real s);

/// Returns the motion from rest at t = 0 of a body under a body-fixed force. Its lever arm gives the constant
/// angular acceleration `alpha` > 0. With angle = alpha t^2/2 and K = integral of (cos, sin)(angle): v = a K,
/// and x = a (t K - (sin, 1 - cos)(angle)/alpha) by parts. Both are rotated to the direction of
/// `acceleration` (the force over the mass, in the body's frame at angle 0).
Motion thruster(Vec2<Real> acceleration, Real alpha, Real time);

}  // namespace plumb::scenarios::truth
