#include "engine/world/contact_solver/contact_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/world/contact_solver/locked_axes.h"

namespace plumb {
namespace {

constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

// Mobility, as a fraction of that along the normal without friction, up to which friction jams a contact: the
// rest is rounding of the rows. Bounds the impulse to the inverse of this times the load.
constexpr double kJammed = kDependentRows;
// Violation of the conditions, as a fraction of the speeds, by a solution as badly conditioned as that.
constexpr double kSolved = kRounding / kJammed;

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

  // Returns false if no case meets the conditions.
  bool solve() {
    for (int i = 0; i < 2; ++i) {
      if (may_press_[i]) speed_ = std::max({speed_, std::abs(rows_.rate[i]), std::abs(target_[i])});
    }
    if (friction_ > 0) speed_ = std::max(speed_, std::abs(rows_.rate[2]));
    for (const bool both : {true, false}) {
      for (const int slip : {0, -1, 1}) {
        for (int only = 0; only < (both ? 1 : 2); ++only) {
          const bool presses[2] = {both || only == 0, both || only == 1};
          if ((presses[0] && !may_press_[0]) || (presses[1] && !may_press_[1])) continue;
          if (try_case(presses, slip) <= kRounding * speed_) return true;
        }
        if (!(friction_ > 0)) break;
      }
    }
    return best_violation_ <= kSolved * speed_;
  }
  const ImpactImpulses& solution() const { return best_; }

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
      if (presses[i] && !(m[i][i] > kJammed * k[i][i])) return std::numeric_limits<double>::infinity();
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
      const double missing = target_[i] - rows_.after(i, found);
      violation = std::max(violation, presses[i] ? -found.normal[i] * k[i][i] : missing);
      // A solution of dependent rows is that of their rounding.
      if (presses[i] && std::abs(missing) > kSolved * speed_)
        violation = std::max(violation, std::abs(missing));
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
  double speed_ = 0;  // m/s, the largest, to which rounding is relative
  ImpactImpulses best_;
  double best_violation_ = std::numeric_limits<double>::infinity();
};

// Returns the work of impulses, J, and by which factor, at most 1, they can be scaled without gaining energy.
double energy_scale(const ImpactRows& rows, const ImpactImpulses& by) {
  const double impulses[3] = {by.normal[0], by.normal[1], by.friction};
  // If all impulses are scaled by k, they do the work k `linear` + k^2 `quadratic`.
  double linear = 0, quadratic = 0;
  for (int i = 0; i < 3; ++i) {
    linear += impulses[i] * rows.rate[i];
    quadratic += impulses[i] * (rows.after(i, by) - rows.rate[i]) / 2;
  }
  if (!(linear + quadratic > 0)) return 1;
  return linear < 0 ? -linear / quadratic : 0;
}

// Follows Coulomb's law at one point while the normal impulse grows from 0, and ends at the target velocity.
// The slip stops at one impulse and may turn round at a later one; in between, the path of (normal, friction)
// is straight. Along it the work grows by u - mu |s| per impulse, with u the velocity along the normal and s
// the slip: no energy is gained until the approach has ended. Where sticking or sliding leaves no mobility
// along the normal (the body jams), a larger impulse changes nothing, and the path ends. It also ends where
// all energy that the approach has lost is regained.
class ImpactPath {
 public:
  ImpactPath(const ImpactRows& rows, int point, double target, double friction)
      : k_nn_(rows.response[point][point]),
        k_nt_(rows.response[point][2]),
        k_tt_(rows.response[2][2]),
        u_(rows.rate[point]),
        s_(rows.rate[2]),
        target_(target),
        friction_(k_tt_ > 0 ? friction : 0) {}

  // Sets the impulses at the end of the path.
  void follow(double& normal, double& friction) {
    if (friction_ > 0) {
      follow_friction();
    } else {
      advance(0, kNever);
    }
    normal = normal_, friction = tangent_;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void follow_friction() {
    const double start = s_, direction = start != 0 ? (start > 0 ? 1 : -1) : (k_nt_ > 0 ? -1 : 1),
                 slows = -(direction * k_nt_ - friction_ * k_tt_),
                 turns = -(direction * k_nt_ + friction_ * k_tt_);
    const double stops_at = slows > 0 ? std::abs(start) / slows : kNever;
    if (!advance(-direction * friction_, stops_at)) return;
    s_ = 0;
    // A jammed point may come free where its slip turns round: then its impulse is that at which it does.
    const double turns_at = turns > 0 ? std::abs(start) / turns : kNever;
    if (!advance(-k_nt_ / k_tt_, turns_at)) return;
    advance(direction * friction_, kNever);
  }

  // Follows a straight part of the path, with friction growing by `ratio` per normal impulse, up to the
  // normal impulse `until`. Returns false if the path ends on it.
  bool advance(double ratio, double until) {
    const double mobility = k_nn_ + ratio * k_nt_, length = until - normal_;
    if (length <= 0) return true;
    double step = length;
    bool ends = false;
    if (mobility > kJammed * k_nn_) {
      if (const double to_target = std::max((target_ - u_) / mobility, 0.0); to_target <= step)
        step = to_target, ends = true;
    } else if (step == kNever) {
      return false;
    }
    // The work on this part is step `linear` + step^2 `quadratic`.
    const double slows = k_nt_ + ratio * k_tt_, linear = u_ + ratio * s_,
                 quadratic = (mobility + ratio * slows) / 2;
    if (work_ + step * (linear + step * quadratic) > 0) {
      const double root = std::sqrt(std::max(linear * linear - 4 * quadratic * work_, 0.0));
      const double limit = linear > 0 ? -2 * work_ / (linear + root) : (root - linear) / (2 * quadratic);
      if (limit < step) step = std::max(limit, 0.0), ends = true;
    }
    work_ += step * (linear + step * quadratic);
    normal_ += step, tangent_ += ratio * step;
    u_ += step * mobility, s_ += step * slows;
    return !ends;
  }

  double k_nn_, k_nt_, k_tt_;  // 1/kg
  double u_, s_;               // m/s, along the normal and the slip
  double target_, friction_;
  double normal_ = 0, tangent_ = 0;  // N s
  double work_ = 0;                  // J
};

// Resolves the impacts of the points one after the other, each along its path, until none falls short of its
// target by more than rounding. No impact gains energy, so all together do not.
ImpactImpulses follow_paths(ImpactRows rows, const bool (&may_press)[2], const double (&target)[2],
                            double friction) {
  constexpr int kMaxImpacts = 16;
  ImpactImpulses total;
  total.jammed = true;
  double speed = 0;
  for (int i = 0; i < 2; ++i)
    if (may_press[i]) speed = std::max({speed, std::abs(rows.rate[i]), std::abs(target[i])});
  for (int impact = 0; impact < kMaxImpacts; ++impact) {
    const auto missing = [&](int i) { return may_press[i] ? std::min(target[i], 0.0) - rows.rate[i] : 0; };
    const int i = missing(1) > missing(0) ? 1 : 0;
    if (!(missing(i) > kSolved * speed)) break;
    ImpactImpulses by;
    ImpactPath(rows, i, target[i], friction).follow(by.normal[i], by.friction);
    if (!(by.normal[i] > 0)) break;
    const double after[3] = {rows.after(0, by), rows.after(1, by), rows.after(2, by)};
    std::copy_n(after, 3, rows.rate);
    total.normal[i] += by.normal[i], total.friction += by.friction;
  }
  return total;
}

}  // namespace

template <class Real>
ImpactImpulses solve_impact(const SolverBody<Real>& a, const SolverBody<Real>& b,
                            const ContactConstraint<Real>& c, const bool (&may_press)[2],
                            const double (&target)[2]) {
  const ImpactRows rows = make_rows(a, b, c);
  const bool presses[2] = {may_press[0] && c.mass[0] > 0, may_press[1] && c.mass[1] > 0};
  const double friction = c.tangent_mass > 0 ? double(c.friction) : 0;
  ImpactLcp lcp(rows, presses, target, friction);
  if (lcp.solve()) {
    ImpactImpulses found = lcp.solution();
    for (double& normal : found.normal) normal = std::max(normal, 0.0);
    const double scale = energy_scale(rows, found);
    if (scale == 1) return found;
    for (double& normal : found.normal) normal *= scale;
    found.friction *= scale;
    bool ends = true;
    for (int i = 0; i < 2; ++i)
      ends = ends && !(presses[i] && rows.after(i, found) < std::min(target[i], 0.0));
    if (ends) return found;
  }
  return follow_paths(rows, presses, target, friction);
}

#define PLUMB_FOR(Real)                                                                  \
  template ImpactImpulses solve_impact(const SolverBody<Real>&, const SolverBody<Real>&, \
                                       const ContactConstraint<Real>&, const bool(&)[2], \
                                       const double(&)[2]);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
