#pragma once

#include <optional>
#include <vector>

#include "harness/energy.h"
#include "harness/envelope.h"
#include "harness/joint_gap.h"
#include "harness/truth_table.h"
#include "reference/backend.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// Tolerances of every check of one run, none of them fitted to an engine. Their sources, in order:
///
/// 1. The scenario's promise: `Problem::precise` for a method with a tolerance (times tolerance/1e-9 if a
///    looser one was asked for), `Problem::second_order` for one of second order: C h^2 + rounding.
/// 2. Else the truth's own motion and the method's order: `Envelope` + rounding.
/// 3. All other bounds follow from those on position and velocity errors, P, V (and on angles, A, W):
///    energy       sum m |v| V + m V^2/2 + I |w| W + I W^2/2 + m |s g| P (s: the body's gravity scale), over
///                 the energy scale
///    momentum     rounding alone: every exchange of momentum is equal and opposite
///    ang. mom.    sum m (|x| V + P |v| + P V) + I W, over its scale
///    joint gap    P_a + r_a A_a + P_b + r_b A_b, with r the distance of each anchor from its body's centre.
///                 If the joint has an axis on a, d A_a is added, with d the distance between the anchors.
///                 For a pulley, b's part is multiplied by its ratio
///    penetration  twice the largest P + r A over the bodies, r the radius of a circle around the body
class Tolerances {
 public:
  Tolerances(const scenarios::Problem& problem, const TruthTable& truth, const reference::Method& method,
             const reference::StepSettings& settings, const ConservationScale& scale);

  /// Tolerance of a check; absent if none can be derived (no truth and no promise of the scenario).
  using Bound = std::optional<double>;

  Bound position(int sample, std::size_t body) const;
  Bound angle(int sample, std::size_t body) const;
  Bound velocity(int sample, std::size_t body) const;
  Bound angular_velocity(int sample, std::size_t body) const;
  Bound energy(int sample) const;
  Bound momentum(int sample) const;
  Bound angular_momentum(int sample) const;
  Bound joint_gap(int sample, const JointGaps& joints, std::size_t joint) const;
  Bound penetration(int sample) const;

  /// Returns the rounding error possible up to `sample`: the tolerance of the discrete oracle.
  StateBound rounding(int sample) const;

 private:
  double steps(int sample) const;
  Bound stated(double scenarios::Bounds::*member, double rounding) const;
  Bound state(int sample, std::size_t body, double scenarios::Bounds::*stated_member,
              double StateBound::*member) const;
  double reach(int sample, std::size_t body, double radius) const;

  const scenarios::Problem& problem_;
  const TruthTable& truth_;
  reference::Method method_;
  ConservationScale scale_;
  const scenarios::Bounds* stated_ = nullptr;
  double stated_factor_ = 0;
  std::optional<Envelope> envelope_;
  std::vector<double> radii_, inertias_;
};

}  // namespace plumb::harness
