#include "engine/world/contact_solver/contact_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

// Normal velocities of a contact's two points and its slip velocity, and their changes by unit impulses.
struct ImpactRows {
  double response[3][3] = {};  // 1/kg
  double rate[3] = {};         // m/s, without impulses

  double after(int row, const ImpactImpulses& by) const {
    return rate[row] + response[row][0] * by.normal[0] + response[row][1] * by.normal[1] +
           response[row][2] * by.friction;
  }
};

template <class Real>
ImpactRows make_rows(const SolverBody<Real>& a, const SolverBody<Real>& b, const ContactConstraint<Real>& c) {
  const double arm_a[3] = {double(c.arm_a[0]), double(c.arm_a[1]), double(c.arm_tangent_a)},
               arm_b[3] = {double(c.arm_b[0]), double(c.arm_b[1]), double(c.arm_tangent_b)};
  const Vec2d relative_velocity = b.velocity.template as<double>() - a.velocity.template as<double>(),
              n = c.normal.template as<double>();
  const Vec2d row[3] = {n, n, {n.y, -n.x}};
  ImpactRows rows;
  for (int i = 0; i < 3; ++i) {
    rows.rate[i] = dot(row[i], relative_velocity) - (i == 2 ? double(c.surface_speed) : 0) +
                   arm_b[i] * double(b.angular_velocity) - arm_a[i] * double(a.angular_velocity);
    for (int j = 0; j < 3; ++j) {
      rows.response[i][j] = linear_response(a, b, c.locks, row[i], row[j], (i == 2) == (j == 2)) +
                            double(a.inverse_inertia) * arm_a[i] * arm_a[j] +
                            double(b.inverse_inertia) * arm_b[i] * arm_b[j];
    }
  }
  return rows;
}

// Solves the linear complementarity problem (LCP) of an impact by trying its cases: which points press, and
// sticking or slipping in either direction. Keeps the case that violates the conditions least.
class ImpactLcp {
 public:
  ImpactLcp(const ImpactRows& rows, const bool (&may_press)[2], const double (&target)[2], double friction)
      : rows_(rows), may_press_(may_press), target_(target), friction_(friction) {}

  ImpactImpulses solve() {
    double speed = 0;
    for (int i = 0; i < 2; ++i) {
      if (may_press_[i]) speed = std::max({speed, std::abs(rows_.rate[i]), std::abs(target_[i])});
    }
    if (friction_ > 0) speed = std::max(speed, std::abs(rows_.rate[2]));
    for (const bool both : {true, false}) {
      for (const int slip : {0, -1, 1}) {
        for (int only = 0; only < (both ? 1 : 2); ++only) {
          const bool presses[2] = {both || only == 0, both || only == 1};
          if ((presses[0] && !may_press_[0]) || (presses[1] && !may_press_[1])) continue;
          if (try_case(presses, slip) <= kRounding * speed) return best_;
        }
        if (!(friction_ > 0)) break;
      }
    }
    return best_;
  }

 private:
  // Solves for impulses at the points in `presses` that give them their target velocities, with a contact
  // that sticks (slip 0) or slips in a direction. Keeps the best solution so far. Returns the violation of
  // the conditions by this one, m/s.
  double try_case(const bool (&presses)[2], int slip) {
    const double(&k)[3][3] = rows_.response;
    const bool sticks = slip == 0 && friction_ > 0;
    const double friction_ratio = -slip * friction_;  // to the normal impulse
    if (sticks && !(k[2][2] > 0)) return std::numeric_limits<double>::infinity();
    double m[2][2], rhs[2];
    for (int i = 0; i < 2; ++i) {
      rhs[i] = target_[i] - rows_.rate[i] + (sticks ? k[i][2] * rows_.rate[2] / k[2][2] : 0);
      for (int j = 0; j < 2; ++j)
        m[i][j] = k[i][j] + (sticks ? -k[i][2] * k[2][j] / k[2][2] : friction_ratio * k[i][2]);
    }
    ImpactImpulses found;
    if (presses[0] && presses[1]) {
      const double product = m[0][0] * m[1][1], determinant = product - m[0][1] * m[1][0];
      if (std::abs(determinant) > kRounding * std::abs(product)) {
        found.normal[0] = (m[1][1] * rhs[0] - m[0][1] * rhs[1]) / determinant;
        found.normal[1] = (m[0][0] * rhs[1] - m[1][0] * rhs[0]) / determinant;
      } else {  // points too close together to be distinguished share the impulse
        for (int i = 0; i < 2; ++i) found.normal[i] = 0.5 * rhs[i] / m[i][i];
      }
    } else {
      const int i = presses[0] ? 0 : 1;
      found.normal[i] = rhs[i] / m[i][i];
    }
    const double total_normal = found.normal[0] + found.normal[1];
    found.friction = sticks
                         ? -(rows_.rate[2] + k[2][0] * found.normal[0] + k[2][1] * found.normal[1]) / k[2][2]
                         : friction_ratio * total_normal;
    double violation = 0;
    for (int i = 0; i < 2; ++i) {
      if (!may_press_[i]) continue;
      violation =
          std::max(violation, presses[i] ? -found.normal[i] * k[i][i] : target_[i] - rows_.after(i, found));
    }
    if (sticks) {
      violation = std::max(violation, (std::abs(found.friction) - friction_ * total_normal) * k[2][2]);
    } else if (slip != 0) {
      violation = std::max(violation, -slip * rows_.after(2, found));
    }
    if (!(violation < best_violation_)) return std::numeric_limits<double>::infinity();
    best_violation_ = violation, best_ = found;
    return violation;
  }

  const ImpactRows& rows_;
  const bool (&may_press_)[2];
  const double (&target_)[2];
  double friction_;
  ImpactImpulses best_;
  double best_violation_ = std::numeric_limits<double>::infinity();
};

}  // namespace

template <class Real>
ImpactImpulses solve_impact(const SolverBody<Real>& a, const SolverBody<Real>& b,
                            const ContactConstraint<Real>& c, const bool (&may_press)[2],
                            const double (&target)[2]) {
  const ImpactRows rows = make_rows(a, b, c);
  ImpactImpulses found =
      ImpactLcp(rows, may_press, target, c.tangent_mass > 0 ? double(c.friction) : 0).solve();
  for (double& normal : found.normal) normal = std::max(normal, 0.0);
  const double impulses[3] = {found.normal[0], found.normal[1], found.friction};
  // If all impulses are scaled by k, they do the work k `linear` + k^2 `quadratic`.
  double linear = 0, quadratic = 0;
  for (int i = 0; i < 3; ++i) {
    linear += impulses[i] * rows.rate[i];
    quadratic += impulses[i] * (rows.after(i, found) - rows.rate[i]) / 2;
  }
  if (!(linear + quadratic > 0)) return found;
  const double scale = linear < 0 ? -linear / quadratic : 0;
  return {{scale * found.normal[0], scale * found.normal[1]}, scale * found.friction};
}

#define PLUMB_FOR(Real)                                                                  \
  template ImpactImpulses solve_impact(const SolverBody<Real>&, const SolverBody<Real>&, \
                                       const ContactConstraint<Real>&, const bool(&)[2], \
                                       const double(&)[2]);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
