#include <algorithm>
#include <cmath>

#include "harness/reality/ellipse.h"

namespace plumb::harness::reality {
namespace {

using precise::ContactImpulse;
using precise::ImpactCoefficients;
using precise::ImpactPoint;
using Values = std::span<const double>;

// Bounds of inertia over mass for the ellipse of 70 mm x 50 mm. A uniform ellipse has 4.6e-4 m^2; one with
// its mass nearer to the centre has less.
const Parameter kInertia{"inertia / mass", "m^2", 4e-4, 3e-5, 2e-4, 7e-4};
const Parameter kFriction{"friction", "", 0.2, 0.03, 0, 1};
const Parameter kRestitution{"restitution", "", 0.55, 0.03, 0, 1};
const Parameter kLater{"later friction", "", 0.2, 0.03, 0, 1};
const Parameter kTangential{"tangential restitution", "", 0.1, 0.05, 0, 1};
const Parameter kExponent{"exponent", "", 0.25, 0.1, 0, 2};
const Parameter kOblique{"restitution lost by obliquity", "", 0.1, 0.05, -1, 1};
const Parameter kSlope{"restitution along the floor", "1/m", 0, 0.3, -4, 4};

/// Speed beyond which restitution falls, m/s. It is below all measured speeds, so that only the exponent and
/// the coefficient at this speed remain to be fitted.
constexpr double kYieldSpeed = 2;

/// Position on the floor at which restitution equals its constant part, m: about the middle of the impacts,
/// so that the two parameters can be distinguished.
constexpr double kMiddle = 0.38;

using Rule = ContactImpulse (*)(const ImpactPoint&, const ImpactCoefficients&);

EllipseLaw simple(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            return rule(point, {v[2], v[1], v[1], 0});
          }};
}

EllipseLaw tangential(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kTangential},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            const ImpactCoefficients c{v[2], v[1], v[1], v[3]};
            return precise::with_tangential_restitution(point, c, rule(point, c));
          }};
}

EllipseLaw falling(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kExponent},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            const double e = precise::falling_restitution(v[2], -point.gap_rate, kYieldSpeed, v[3]);
            return rule(point, {e, v[1], v[1], 0});
          }};
}

EllipseLaw later(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kLater},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            return rule(point, {v[2], v[1], v[3], 0});
          }};
}

EllipseLaw later_falling(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kLater, kExponent},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            const double e = precise::falling_restitution(v[2], -point.gap_rate, kYieldSpeed, v[4]);
            return rule(point, {e, v[1], v[3], 0});
          }};
}

EllipseLaw oblique(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kLater, kOblique},
          false,
          [rule](const ImpactPoint& point, const MeasuredImpact&, Values v) {
            const double e = v[2] * (1 - v[4] * std::abs(point.slip_speed / point.gap_rate));
            return rule(point, {std::clamp(e, 0.0, 1.0), v[1], v[3], 0});
          }};
}

EllipseLaw along_floor(const char* name, const char* text, Rule rule) {
  return {name,
          text,
          {kInertia, kFriction, kRestitution, kLater, kSlope},
          true,
          [rule](const ImpactPoint& point, const MeasuredImpact& impact, Values v) {
            const double e = std::clamp(v[2] + v[4] * (impact.place - kMiddle), 0.0, 1.0);
            return rule(point, {e, v[1], v[3], 0});
          }};
}

}  // namespace

const std::vector<EllipseLaw>& ellipse_laws() {
  static const std::vector<EllipseLaw> laws{
      simple("newton", "Newton's restitution, Coulomb's friction for the impulses", precise::newton_impulse),
      simple("poisson", "Poisson's restitution by Routh's method", precise::poisson_impulse),
      simple("stronge", "Stronge's energetic restitution", precise::stronge_impulse),
      tangential("stronge-tangential", "Stronge's, with partial reversal of the slip",
                 precise::stronge_impulse),
      falling("stronge-falling", "Stronge's, with restitution that decreases with speed",
              precise::stronge_impulse),
      later("poisson-later", "Poisson's, with a second friction coefficient after the slip has stopped",
            precise::poisson_impulse),
      later("stronge-later", "Stronge's, with a second friction coefficient after the slip has stopped",
            precise::stronge_impulse),
      later_falling("stronge-later-falling",
                    "Stronge's, with a second friction coefficient and restitution that decreases with speed",
                    precise::stronge_impulse),
      oblique("stronge-later-oblique",
              "Stronge's, with a second friction coefficient and restitution that decreases with slip / "
              "approach speed",
              precise::stronge_impulse),
      along_floor(
          "stronge-later-floor",
          "Stronge's, with a second friction coefficient and restitution that varies along this floor",
          precise::stronge_impulse)};
  return laws;
}

}  // namespace plumb::harness::reality
