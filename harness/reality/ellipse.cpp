#include "harness/reality/ellipse.h"

#include <algorithm>
#include <cmath>

namespace plumb::harness::reality {
namespace {

/// Inertia over mass of a uniform ellipse of 70 mm x 50 mm, m^2: (a^2 + b^2) / 4. It weighs all errors alike,
/// whatever inertia a law is fitted with.
constexpr double kUniform = (0.035 * 0.035 + 0.025 * 0.025) / 4;

constexpr int kEvaluations = 1000, kFolds = 5;

using precise::ContactImpulse;
using precise::ImpactPoint;

/// The contact point per unit of mass.
ImpactPoint point_of(const MeasuredImpact& impact, double inertia) {
  const double n = impact.lever_normal, t = impact.lever_tangent;
  return {impact.velocity.y + n * impact.angular_velocity, impact.velocity.x + t * impact.angular_velocity,
          1 + n * n / inertia, n * t / inertia, 1 + t * t / inertia};
}

/// Relative error of the velocity that an impulse leaves.
double error_of(const MeasuredImpact& impact, const ContactImpulse& impulse, double inertia) {
  const Vec2d velocity = impact.velocity + Vec2d{impulse.tangential, impulse.normal};
  const double turning =
      impact.angular_velocity +
      (impact.lever_normal * impulse.normal + impact.lever_tangent * impulse.tangential) / inertia;
  const Vec2d off = velocity - impact.velocity_after;
  const double turned = impact.angular_velocity_after, off_turned = turning - turned;
  return std::sqrt((dot(off, off) + kUniform * off_turned * off_turned) /
                   (dot(impact.velocity_after, impact.velocity_after) + kUniform * turned * turned));
}

using Rows = std::vector<const MeasuredImpact*>;
using Law = std::function<double(const MeasuredImpact&, std::span<const double>)>;

/// Returns the error of a law at an impact, for its parameters.
Law error_by(const EllipseLaw& law) {
  return [&law](const MeasuredImpact& impact, std::span<const double> values) {
    return error_of(impact, law.impulse(point_of(impact, values[0]), impact, values), values[0]);
  };
}

/// Returns the error of the best impulse at the contact point.
double least_error(const MeasuredImpact& impact, std::span<const double> values) {
  const double inertia = values[0];
  // Least squares in the norm of the kinetic energy: two unknowns, three components.
  const double n = impact.lever_normal / inertia, t = impact.lever_tangent / inertia;
  const Vec2d change = impact.velocity_after - impact.velocity;
  const double turned = impact.angular_velocity_after - impact.angular_velocity;
  const double nn = 1 + kUniform * n * n, nt = kUniform * n * t, tt = 1 + kUniform * t * t;
  const double b_n = change.y + kUniform * n * turned, b_t = change.x + kUniform * t * turned;
  const double determinant = nn * tt - nt * nt;
  return error_of(impact, {(tt * b_n - nt * b_t) / determinant, (nn * b_t - nt * b_n) / determinant},
                  inertia);
}

std::vector<double> errors_of(const Law& law, const Rows& rows, std::span<const double> values) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (const MeasuredImpact* row : rows) out.push_back(law(*row, values));
  return out;
}

double median_of(const Law& law, const Rows& rows, std::span<const double> values) {
  return quantile(errors_of(law, rows, values), 0.5);
}

double middle_of(const Law& law, const Rows& rows, std::span<const double> values) {
  return middle_mean(errors_of(law, rows, values));
}

Fit fit(const Law& law, std::span<const Parameter> parameters, const Rows& rows) {
  return minimise(parameters, kEvaluations,
                  [&](std::span<const double> values) { return middle_of(law, rows, values); });
}

/// Returns the median over the training half of errors with parameters fitted on the other parts of it.
double validate(const Law& law, std::span<const Parameter> parameters, const Rows& train) {
  std::vector<double> errors;
  for (int fold = 0; fold < kFolds; ++fold) {
    Rows used, left_out;
    for (std::size_t i = 0; i < train.size(); ++i)
      (static_cast<int>(i % kFolds) == fold ? left_out : used).push_back(train[i]);
    const std::vector<double> some = errors_of(law, left_out, fit(law, parameters, used).values);
    errors.insert(errors.end(), some.begin(), some.end());
  }
  return quantile(errors, 0.5);
}

EllipseFinding examine(const Law& law, std::vector<Parameter> parameters, const Rows& train, const Rows& test,
                       std::uint64_t seed) {
  EllipseFinding out;
  out.validated = validate(law, parameters, train);
  const Fit found = fit(law, parameters, train);
  out.parameters = std::move(parameters);
  out.values = found.values;
  out.train = median_of(law, train, found.values);
  out.errors = errors_of(law, test, found.values);
  std::sort(out.errors.begin(), out.errors.end());
  out.median = estimate(out.errors, 0.5, seed);
  out.ninetieth = estimate(out.errors, 0.9, seed);
  return out;
}

}  // namespace

EllipseFindings examine_ellipse(std::span<const MeasuredImpact> impacts, std::uint64_t seed) {
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
    EllipseFinding finding = examine(error_by(law), law.parameters, train, test, seed);
    finding.name = law.name;
    finding.text = law.text;
    finding.of_this_floor = law.of_this_floor;
    out.laws.push_back(std::move(finding));
    const std::size_t last = out.laws.size() - 1;
    if (out.laws[last].validated < out.laws[out.best].validated) out.best = last;
    if (!law.of_this_floor && out.laws[last].validated < out.laws[out.best_of_all_floors].validated)
      out.best_of_all_floors = last;
  }
  out.bound = examine(least_error, {ellipse_laws()[0].parameters[0]}, train, test, seed);
  out.bound.name = "bound";
  out.bound.text = "the best impulse at the contact point: no law there can do better";
  return out;
}

}  // namespace plumb::harness::reality
