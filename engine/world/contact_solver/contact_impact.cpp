#include "engine/world/contact_solver/contact_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

// Rates of a contact's two points and of its slip, and their changes by unit impulses.
struct ImpactRows {
  double response[3][3] = {};  // 1/kg
  double rate[3] = {};         // m/s, without impulses

  double after(int row, const ImpactImpulses& by) const {
    return rate[row] + response[row][0] * by.normal[0] + response[row][1] * by.normal[1] +
           response[row][2] * by.friction;
  }
};

template <class Real>
ImpactRows rows_of(const SolverBody<Real>& a, const SolverBody<Real>& b, const ContactConstraint<Real>& c) {
  const double arm_a[3] = {double(c.arm_a[0]), double(c.arm_a[1]), double(c.arm_tangent_a)},
               arm_b[3] = {double(c.arm_b[0]), double(c.arm_b[1]), double(c.arm_tangent_b)};
  const Vec2d between = b.velocity.template as<double>() - a.velocity.template as<double>(),
              n = c.normal.template as<double>();
  const Vec2d row[3] = {n, n, {n.y, -n.x}};
  ImpactRows rows;
  for (int i = 0; i < 3; ++i) {
    rows.rate[i] = dot(row[i], between) - (i == 2 ? double(c.surface_speed) : 0) +
                   arm_b[i] * double(b.angular_velocity) - arm_a[i] * double(a.angular_velocity);
    for (int j = 0; j < 3; ++j) {
      rows.response[i][j] = linear_response(a, b, c.locks, row[i], row[j], (i == 2) == (j == 2)) +
                            double(a.inverse_inertia) * arm_a[i] * arm_a[j] +
                            double(b.inverse_inertia) * arm_b[i] * arm_b[j];
    }
  }
  return rows;
}

// Solves the complementarity problem of an impact by trying its cases: the points that push, and sticking or
// slipping in either direction. Keeps the case that violates the conditions least.
class Impact {
 public:
  Impact(const ImpactRows& rows, const bool (&strikes)[2], const double (&wanted)[2], double friction)
      : rows_(rows), strikes_(strikes), wanted_(wanted), friction_(friction) {}

  ImpactImpulses solve() {
    double speed = 0;
    for (int i = 0; i < 2; ++i) {
      if (strikes_[i]) speed = std::max({speed, std::abs(rows_.rate[i]), std::abs(wanted_[i])});
    }
    if (friction_ > 0) speed = std::max(speed, std::abs(rows_.rate[2]));
    for (const bool both : {true, false}) {
      for (const int slip : {0, -1, 1}) {
        for (int only = 0; only < (both ? 1 : 2); ++only) {
          const bool pushes[2] = {both || only == 0, both || only == 1};
          if ((pushes[0] && !strikes_[0]) || (pushes[1] && !strikes_[1])) continue;
          if (take(pushes, slip) <= kRounding * speed) return best_;
        }
        if (!(friction_ > 0)) break;
      }
    }
    return best_;
  }

 private:
  // Solves for impulses at the points in `pushes` that give them their wanted rates, with a contact that
  // sticks (slip 0) or slips in a direction. Keeps the best solution so far. Returns the speed, m/s, by which
  // this one violates the conditions.
  double take(const bool (&pushes)[2], int slip) {
    const double(&k)[3][3] = rows_.response;
    const bool sticks = slip == 0 && friction_ > 0;
    const double share = -slip * friction_;  // of the pressure
    if (sticks && !(k[2][2] > 0)) return std::numeric_limits<double>::infinity();
    double m[2][2], wanted[2];
    for (int i = 0; i < 2; ++i) {
      wanted[i] = wanted_[i] - rows_.rate[i] + (sticks ? k[i][2] * rows_.rate[2] / k[2][2] : 0);
      for (int j = 0; j < 2; ++j)
        m[i][j] = k[i][j] + (sticks ? -k[i][2] * k[2][j] / k[2][2] : share * k[i][2]);
    }
    ImpactImpulses found;
    if (pushes[0] && pushes[1]) {
      const double product = m[0][0] * m[1][1], determinant = product - m[0][1] * m[1][0];
      if (std::abs(determinant) > kRounding * std::abs(product)) {
        found.normal[0] = (m[1][1] * wanted[0] - m[0][1] * wanted[1]) / determinant;
        found.normal[1] = (m[0][0] * wanted[1] - m[1][0] * wanted[0]) / determinant;
      } else {  // points too close together to be distinguished share the impulse
        for (int i = 0; i < 2; ++i) found.normal[i] = 0.5 * wanted[i] / m[i][i];
      }
    } else {
      const int i = pushes[0] ? 0 : 1;
      found.normal[i] = wanted[i] / m[i][i];
    }
    const double pressure = found.normal[0] + found.normal[1];
    found.friction = sticks
                         ? -(rows_.rate[2] + k[2][0] * found.normal[0] + k[2][1] * found.normal[1]) / k[2][2]
                         : share * pressure;
    double missed = 0;
    for (int i = 0; i < 2; ++i) {
      if (!strikes_[i]) continue;
      missed = std::max(missed, pushes[i] ? -found.normal[i] * k[i][i] : wanted_[i] - rows_.after(i, found));
    }
    if (sticks) {
      missed = std::max(missed, (std::abs(found.friction) - friction_ * pressure) * k[2][2]);
    } else if (slip != 0) {
      missed = std::max(missed, -slip * rows_.after(2, found));
    }
    if (!(missed < missed_)) return std::numeric_limits<double>::infinity();
    missed_ = missed, best_ = found;
    return missed;
  }

  const ImpactRows& rows_;
  const bool (&strikes_)[2];
  const double (&wanted_)[2];
  double friction_;
  ImpactImpulses best_;
  double missed_ = std::numeric_limits<double>::infinity();
};

}  // namespace

template <class Real>
ImpactImpulses impact_of(const SolverBody<Real>& a, const SolverBody<Real>& b,
                         const ContactConstraint<Real>& c, const bool (&strikes)[2],
                         const double (&wanted)[2]) {
  const ImpactRows rows = rows_of(a, b, c);
  ImpactImpulses found = Impact(rows, strikes, wanted, c.tangent_mass > 0 ? double(c.friction) : 0).solve();
  for (double& normal : found.normal) normal = std::max(normal, 0.0);
  const double impulses[3] = {found.normal[0], found.normal[1], found.friction};
  // If all impulses are scaled by k, they do the work k `first` + k^2 `second`.
  double first = 0, second = 0;
  for (int i = 0; i < 3; ++i) {
    first += impulses[i] * rows.rate[i];
    second += impulses[i] * (rows.after(i, found) - rows.rate[i]) / 2;
  }
  if (!(first + second > 0)) return found;
  const double scale = first < 0 ? -first / second : 0;
  return {{scale * found.normal[0], scale * found.normal[1]}, scale * found.friction};
}

#define PLUMB_FOR(Real)                                                               \
  template ImpactImpulses impact_of(const SolverBody<Real>&, const SolverBody<Real>&, \
                                    const ContactConstraint<Real>&, const bool(&)[2], const double(&)[2]);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
