#include "harness/bounds.h"

#include <algorithm>
#include <cmath>

#include "harness/magnitude.h"
#include "harness/pulls.h"

namespace plumb::harness {
namespace {

using scenarios::Bounds;

constexpr double kPromisedTolerance = 1e-9;  // relative tolerance of `Problem::precise`

}  // namespace

Tolerances::Tolerances(const scenarios::Problem& problem, const TruthTable& truth,
                       const reference::Method& method, const reference::StepSettings& settings,
                       const ConservationScale& scale)
    : problem_(problem), truth_(truth), method_(method), scale_(scale) {
  const double tolerance = settings.tolerance.value_or(kPromisedTolerance);
  if (method.order == 0) {
    stated_ = &problem.precise;
    stated_factor_ = std::max(1.0, tolerance / kPromisedTolerance);
  } else if (method.order >= 2) {
    stated_ = &problem.second_order;
    stated_factor_ = method.substep * method.substep;
  }
  if (truth.known()) envelope_.emplace(problem, truth, method, tolerance);
  for (const Body& body : problem.scene.bodies) {
    radii_.push_back(bounding_radius(body));
    inertias_.push_back(body.type == BodyType::Dynamic ? inertia_of(body) : 0);
  }
}

// Returns the number of substeps up to the sample. Returns 1 for an engine with a tolerance: its tolerance
// already covers the errors of its steps, and only the rounding of one result remains.
double Tolerances::steps(int sample) const {
  return method_.order == 0 ? 1 : sample * truth_.dt() / method_.substep;
}

StateBound Tolerances::rounding(int sample) const {
  return rounding_bound(truth_.scale(), method_.epsilon, steps(sample), sample * truth_.dt());
}

Tolerances::Bound Tolerances::stated(double Bounds::*member, double rounding) const {
  if (stated_ == nullptr || std::isnan(stated_->*member)) return {};
  const double promised = stated_->*member * stated_factor_;
  return method_.order == 0 ? std::max(promised, rounding) : promised + rounding;
}

Tolerances::Bound Tolerances::state(int sample, std::size_t body, double Bounds::*stated_member,
                                    double StateBound::*member) const {
  const double rounding = this->rounding(sample).*member;
  if (const Bound bound = stated(stated_member, rounding)) return bound;
  if (!envelope_) return {};
  return envelope_->at(sample, body).*member + rounding;
}

Tolerances::Bound Tolerances::position(int sample, std::size_t body) const {
  return state(sample, body, &Bounds::position, &StateBound::position);
}

Tolerances::Bound Tolerances::angle(int sample, std::size_t body) const {
  return state(sample, body, &Bounds::angle, &StateBound::angle);
}

Tolerances::Bound Tolerances::velocity(int sample, std::size_t body) const {
  return state(sample, body, &Bounds::velocity, &StateBound::velocity);
}

Tolerances::Bound Tolerances::angular_velocity(int sample, std::size_t body) const {
  return state(sample, body, &Bounds::angular_velocity, &StateBound::angular_velocity);
}

Tolerances::Bound Tolerances::energy(int sample) const {
  const double rounding = kRoundings * method_.epsilon * (steps(sample) + 1);
  if (const Bound bound = stated(&Bounds::energy, rounding)) return bound;
  if (!envelope_) return {};
  double sum = 0;
  for (std::size_t i = 0; i < truth_.bodies(); ++i) {
    const Body& body = problem_.scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const BodyState& exact = truth_.at(sample)[i];
    const double v = magnitude(exact.velocity), w = std::abs(exact.angular_velocity);
    const double off_v = *velocity(sample, i), off_w = *angular_velocity(sample, i);
    sum +=
        body.mass * (v * off_v + off_v * off_v / 2) + inertias_[i] * (w * off_w + off_w * off_w / 2) +
        body.mass * std::abs(body.gravity_scale) * magnitude(problem_.scene.gravity) * *position(sample, i);
  }
  // The error of a potential is its force times the displacement error, plus half its stiffness times the
  // square. If both ends have errors, (a + b)^2/2 <= a^2 + b^2.
  for (const Pull& pull : pulls_in(problem_.scene, truth_.at(sample))) {
    const double off = *position(sample, pull.body) + pull.arm * *angle(sample, pull.body);
    sum += pull.force * off + pull.stiffness * off * off;
  }
  return sum / scale_.energy + rounding;
}

Tolerances::Bound Tolerances::momentum(int sample) const {
  const double rounding = kRoundings * method_.epsilon * (steps(sample) + 1);
  if (const Bound bound = stated(&Bounds::momentum, rounding)) return bound;
  return rounding;
}

Tolerances::Bound Tolerances::angular_momentum(int sample) const {
  const double rounding = kRoundings * method_.epsilon * (steps(sample) + 1);
  if (const Bound bound = stated(&Bounds::angular_momentum, rounding)) return bound;
  if (!envelope_) return {};
  double sum = 0;
  for (std::size_t i = 0; i < truth_.bodies(); ++i) {
    const Body& body = problem_.scene.bodies[i];
    if (body.type != BodyType::Dynamic) continue;
    const BodyState& exact = truth_.at(sample)[i];
    const double x = magnitude(exact.position), v = magnitude(exact.velocity);
    const double off_x = *position(sample, i), off_v = *velocity(sample, i);
    sum += body.mass * (x * off_v + off_x * v + off_x * off_v) + inertias_[i] * *angular_velocity(sample, i);
  }
  return sum / scale_.angular_momentum + rounding;
}

double Tolerances::reach(int sample, std::size_t body, double radius) const {
  if (problem_.scene.bodies[body].type != BodyType::Dynamic) return 0;
  return *position(sample, body) + radius * *angle(sample, body);
}

Tolerances::Bound Tolerances::joint_gap(int sample, const JointGaps& joints, std::size_t joint) const {
  if (const Bound bound = stated(&Bounds::joint_gap, rounding(sample).position)) return bound;
  if (!envelope_) return {};
  const JointGaps::End &a = joints.end_a(joint), &b = joints.end_b(joint);
  double sum = 0;
  if (a.body) sum += reach(sample, *a.body, magnitude(a.anchor) + joints.lever(joint, truth_.at(sample)));
  if (b.body) sum += b.gain * reach(sample, *b.body, magnitude(b.anchor));
  return sum;
}

Tolerances::Bound Tolerances::penetration(int sample) const {
  if (const Bound bound = stated(&Bounds::penetration, rounding(sample).position)) return bound;
  if (!envelope_) return {};
  double largest = 0;
  for (std::size_t i = 0; i < truth_.bodies(); ++i) largest = std::max(largest, reach(sample, i, radii_[i]));
  return 2 * largest;
}

}  // namespace plumb::harness
