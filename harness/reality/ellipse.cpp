#include "harness/reality/ellipse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/reality/linear_fit.h"

namespace plumb::harness::reality {
namespace {

constexpr int kEvaluations = 1000, kFolds = 5;

/// Step of the finite differences for the derivatives, relative to a parameter's first step in a fit.
constexpr double kDifference = 1e-5;

using precise::ContactImpulse;
using precise::ImpactPoint;

/// Returns the contact point, per unit of mass.
ImpactPoint point_of(const MeasuredImpact& impact, double inertia) {
  const double n = impact.lever_normal, t = impact.lever_tangent;
  return {impact.velocity.y + n * impact.angular_velocity, impact.velocity.x + t * impact.angular_velocity,
          1 + n * n / inertia, n * t / inertia, 1 + t * t / inertia};
}

/// Difference between the velocity after an impulse and the measured one, relative to the latter: its length
/// is the error.
using Off = std::array<double, 3>;

double length_of(const Off& off) { return std::sqrt(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]); }

Off off_of(const MeasuredImpact& impact, const ContactImpulse& impulse, double inertia) {
  const Vec2d velocity = impact.velocity + Vec2d{impulse.tangential, impulse.normal};
  const double turning =
      impact.angular_velocity +
      (impact.lever_normal * impulse.normal + impact.lever_tangent * impulse.tangential) / inertia;
  const Vec2d off = velocity - impact.velocity_after;
  const double turned = impact.angular_velocity_after, off_turned = turning - turned;
  const double size =
      std::sqrt(dot(impact.velocity_after, impact.velocity_after) + kUniformEllipse * turned * turned);
  return {off.x / size, off.y / size, std::sqrt(kUniformEllipse) * off_turned / size};
}

using Rows = std::vector<const MeasuredImpact*>;
using Law = std::function<Off(const MeasuredImpact&, std::span<const double>)>;

/// Returns the error of a law at an impact, for its parameters.
Law off_by(const EllipseLaw& law) {
  return [&law](const MeasuredImpact& impact, std::span<const double> values) {
    return off_of(impact, law.impulse(point_of(impact, values[0]), impact, values), values[0]);
  };
}

/// Returns the error of the best impulse at the contact point.
Off least_off(const MeasuredImpact& impact, std::span<const double> values) {
  const double inertia = values[0];
  // Least squares in the norm of the kinetic energy: two unknowns, three components.
  const double n = impact.lever_normal / inertia, t = impact.lever_tangent / inertia;
  const Vec2d change = impact.velocity_after - impact.velocity;
  const double turned = impact.angular_velocity_after - impact.angular_velocity;
  const double nn = 1 + kUniformEllipse * n * n, nt = kUniformEllipse * n * t,
               tt = 1 + kUniformEllipse * t * t;
  const double b_n = change.y + kUniformEllipse * n * turned, b_t = change.x + kUniformEllipse * t * turned;
  const double determinant = nn * tt - nt * nt;
  return off_of(impact, {(tt * b_n - nt * b_t) / determinant, (nn * b_t - nt * b_n) / determinant}, inertia);
}

std::vector<double> errors_of(const Law& law, const Rows& rows, std::span<const double> values) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const MeasuredImpact* row : rows) out.push_back(length_of(law(*row, values)));
  return out;
}

double middle_of(const Law& law, const Rows& rows, std::span<const double> values) {
  return middle_mean(errors_of(law, rows, values));
}

Fit fit(const Law& law, std::span<const Parameter> parameters, const Rows& rows) {
  return minimise(parameters, kEvaluations,
                  [&](std::span<const double> values) { return middle_of(law, rows, values); });
}

/// Returns the fitted values with their intervals.
std::vector<Estimate> intervals(const Law& law, std::span<const Parameter> parameters,
                                std::span<const double> values, const Rows& rows, std::uint64_t seed) {
  std::vector<Residuals> once(1);
  const std::size_t n = values.size();
  for (const MeasuredImpact* row : rows) {
    const Off off = law(*row, values);
    Residual& one = once[0].emplace_back();
    one.off.assign(off.begin(), off.end());
    one.error = length_of(off);
    one.by.resize(off.size() * n);
    for (std::size_t j = 0; j < n; ++j) {
      std::vector<double> moved(values.begin(), values.end());
      const double step = kDifference * parameters[j].step;
      moved[j] = values[j] + step;
      const Off above = law(*row, moved);
      moved[j] = values[j] - step;
      const Off below = law(*row, moved);
      for (std::size_t c = 0; c < off.size(); ++c) one.by[c * n + j] = (above[c] - below[c]) / (2 * step);
    }
  }
  return with_intervals(values, parameters, once, seed);
}

/// Returns the median over the training half of errors with parameters fitted on the other parts of it.
Estimate validate(const Law& law, std::span<const Parameter> parameters, const Rows& train,
                  std::uint64_t seed) {
  std::vector<double> errors;
  for (int fold = 0; fold < kFolds; ++fold) {
    Rows used, left_out;
    for (std::size_t i = 0; i < train.size(); ++i)
      (static_cast<int>(i % kFolds) == fold ? left_out : used).push_back(train[i]);
    const std::vector<double> some = errors_of(law, left_out, fit(law, parameters, used).values);
    errors.insert(errors.end(), some.begin(), some.end());
  }
  return estimate(errors, 0.5, seed);
}

EllipseFinding examine(const Law& law, std::vector<Parameter> parameters, const Rows& train, const Rows& test,
                       std::uint64_t seed) {
  EllipseFinding out;
  out.validated = validate(law, parameters, train, seed);
  const Fit found = fit(law, parameters, train);
  out.fitted = intervals(law, parameters, found.values, train, seed);
  out.parameters = std::move(parameters);
  out.values = found.values;
  out.train = estimate(errors_of(law, train, found.values), 0.5, seed);
  out.errors = errors_of(law, test, found.values);
  std::sort(out.errors.begin(), out.errors.end());
  out.median = estimate(out.errors, 0.5, seed);
  out.ninetieth = estimate(out.errors, 0.9, seed);
  return out;
}

}  // namespace

EllipseFindings examine_ellipse(std::span<const MeasuredImpact> impacts, std::uint64_t seed,
                                std::span<const reference::Backend* const> engines) {
  EllipseFindings out;
  Rows rows, train, test;
  for (const MeasuredImpact& impact : impacts) {
    ++out.impacts;
    if (impact.doubted) {
      ++out.doubted;
    } else {
      rows.push_back(&impact);
    }
  }
  const Halves halves = halves_of(rows.size(), seed);
  for (const std::size_t i : halves.train) train.push_back(rows[i]);
  for (const std::size_t i : halves.test) test.push_back(rows[i]);
  for (const EllipseLaw& law : ellipse_laws()) {
    EllipseFinding finding = examine(off_by(law), law.parameters, train, test, seed);
    finding.name = law.name;
    finding.text = law.text;
    finding.of_this_floor = law.of_this_floor;
    out.laws.push_back(std::move(finding));
    const std::size_t last = out.laws.size() - 1;
    if (out.laws[last].validated.value < out.laws[out.best].validated.value) out.best = last;
    if (!law.of_this_floor &&
        out.laws[last].validated.value < out.laws[out.best_of_all_floors].validated.value)
      out.best_of_all_floors = last;
  }
  out.bound = examine(least_off, {ellipse_laws()[0].parameters[0]}, train, test, seed);
  out.bound.name = "bound";
  out.bound.text = "best impulse at the contact point: a bound for all such laws";
  out.engines = examine_ellipse_engines(test, out.laws.front(), engines, seed);
  return out;
}

}  // namespace plumb::harness::reality
