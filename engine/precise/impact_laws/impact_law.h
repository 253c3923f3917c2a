#pragma once

/// Laws of one impact at one contact point, in closed form, one per file. A law uses only the rates of gap
/// and slip and their response to unit impulses, so it holds for any shapes and joints.
namespace plumb::precise {

/// A contact point in an impact. Rates are those before it.
struct ImpactPoint {
  double gap_rate = 0;          ///< m/s, of the gap, negative
  double slip_speed = 0;        ///< m/s, along the tangent
  double normal_response = 1;   ///< 1/kg, of the gap's rate to a normal impulse, > 0
  double cross_response = 0;    ///< 1/kg, of the slip to a normal impulse, and the other way round
  double tangent_response = 1;  ///< 1/kg, of the slip to a tangential impulse, > 0
};

struct ImpactCoefficients {
  double restitution = 0;     ///< 0..1; each law has its own definition
  double friction = 0;        ///< Coulomb's coefficient for the slip with which the impact begins
  double later_friction = 0;  ///< coefficient after that slip has stopped, for sticking and reversed slip
  double tangential_restitution = 0;  ///< 0..1, see `with_tangential_restitution`
};

struct ContactImpulse {
  double normal = 0;      ///< N s, >= 0
  double tangential = 0;  ///< N s
};

/// Applies Newton's law: the gap opens at `restitution` times the rate at which it closed. Friction obeys
/// Coulomb's law for the impulses and the final slip. With friction the impact may gain energy, because the
/// opening rate is prescribed whatever friction does (Kane and Levinson 1985). `later_friction` is not used.
ContactImpulse newton_impulse(const ImpactPoint& point, const ImpactCoefficients& coefficients);

/// Applies Poisson's law by Routh's method: the slip is followed along the growing normal impulse, with
/// Coulomb's friction at each instant; the impulse of restitution is `restitution` times that of compression.
/// Source: Routh, Dynamics of a System of Rigid Bodies (1860); Wang and Mason, J. Appl. Mech. 59 (1992) 635.
ContactImpulse poisson_impulse(const ImpactPoint& point, const ImpactCoefficients& coefficients);

/// Applies Stronge's law: along the same path, the normal impulse does in restitution `restitution`^2 times
/// the work that it took in compression. Never gains energy. Source: Stronge, Proc. R. Soc. A 431 (1990) 169.
ContactImpulse stronge_impulse(const ImpactPoint& point, const ImpactCoefficients& coefficients);

/// Returns the coefficient of restitution at an impact of `speed`: `restitution` up to `yield_speed`, beyond
/// that restitution (speed / yield_speed)^-exponent. An exponent of 1/4 describes a body that yields
/// plastically (Johnson, Contact Mechanics (1985), 11.5). Speeds in m/s; with a `yield_speed` of 0 it is
/// constant.
double falling_restitution(double restitution, double speed, double yield_speed, double exponent = 0.25);

/// Restores a part of the slip that friction has stopped. Adds the tangential impulse that leaves a slip of
/// -tangential_restitution times the initial one, limited such that friction holds, the gap does not close
/// again and the whole impact loses energy. Does nothing if the contact slips at the end.
ContactImpulse with_tangential_restitution(const ImpactPoint& point, const ImpactCoefficients& coefficients,
                                           const ContactImpulse& impulse);

/// Returns the change of the kinetic energy by an impulse, J.
double energy_change(const ImpactPoint& point, const ContactImpulse& impulse);

/// Returns the rate of the gap, or the slip, after an impulse, m/s.
double gap_rate_after(const ImpactPoint& point, const ContactImpulse& impulse);
double slip_speed_after(const ImpactPoint& point, const ContactImpulse& impulse);

}  // namespace plumb::precise
