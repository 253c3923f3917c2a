#include "engine/precise/events/impacts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "engine/core/text.h"
#include "engine/precise/impact_laws/impact_law.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Maximum number of impacts resolved one after the other. An endless sequence shrinks like a geometric
/// series. After this many, the remaining approach is rounding and is resolved at once, with restitution only
/// where it is 1.
constexpr std::int64_t kMaxInSequence = 20000;

double fastest(const ContactCandidate& candidate) {
  double least = 0;
  for (int i = 0; i < candidate.count; ++i) least = std::min(least, candidate.gap_rate[i]);
  return least;
}

}  // namespace

ContactProblem ContactProblem::of(std::span<const ContactCandidate> candidates,
                                  const std::function<bool(std::size_t, int)>& select,
                                  std::span<const MotorAtSpeed> motors, EquationsOfMotion& equations,
                                  double time, std::span<const double> y) {
  ContactProblem out;
  std::vector<Row<double>> normals, tangents;
  for (std::size_t t = 0; t < candidates.size(); ++t) {
    bool any = false;
    for (int i = 0; i < candidates[t].count; ++i) {
      if (!select(t, i)) continue;
      if (!any) {
        out.candidates.push_back(t);
        out.problem.patches.push_back({candidates[t].friction, 0, 0});
        tangents.push_back(candidates[t].rows[i].tangent);
      }
      any = true;
      out.candidate_of.push_back(t);
      out.index_of.push_back(static_cast<std::size_t>(i));
      out.problem.patch_of.push_back(static_cast<int>(out.candidates.size()) - 1);
      normals.push_back(candidates[t].rows[i].normal);
    }
  }
  for (const MotorAtSpeed& motor : motors) {
    out.problem.patches.push_back({0, 0, motor.bound});
    tangents.push_back(motor.row);
  }
  normals.insert(normals.end(), tangents.begin(), tangents.end());
  if (!normals.empty())
    equations.compute_response(time, y, std::move(normals), out.response, out.problem.response);
  return out;
}

void ImpactSolver::apply(const ContactResponse& response, std::span<const double> impulses,
                         std::span<ContactCandidate> candidates, std::span<BodyState> states,
                         Compensated& y) {
  assert(impulses.size() == response.rows.size());
  equations_.apply_impulses(response, impulses, y);
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    states[equations_.bodies()[slot]] = EquationsOfMotion::state(y.value(), slot);
  }
  for (ContactCandidate& candidate : candidates) finder_.update_rates(states, candidate);
}

std::string ImpactSolver::subject(const ContactCandidate& candidate) const {
  if (candidate.limit)
    return "joint '" + equations_.general_joints().limits_and_motors()[*candidate.limit].joint + "'";
  return "bodies '" + equations_.name(finder_.shapes()[candidate.pair.a].body) + "' and '" +
         equations_.name(finder_.shapes()[candidate.pair.b].body) + "'";
}

void ImpactSolver::solve_impact(double time, const std::function<bool(std::size_t, int)>& takes_part,
                                std::span<ContactCandidate> candidates, std::span<BodyState> states,
                                Compensated& y, const Restitution& restitution) {
  ContactProblem p = ContactProblem::of(candidates, takes_part, {}, equations_, time, y.value());
  const std::size_t n = p.problem.points();
  for (std::size_t i = 0; i < n; ++i) {
    const ContactCandidate& candidate = candidates[p.candidate_of[i]];
    const int index = static_cast<int>(p.index_of[i]);
    const double gap_rate = candidate.gap_rate[index];
    const double target = gap_rate < 0 ? -restitution(candidate, index) * gap_rate : 0;
    p.problem.rate.push_back(gap_rate - target);
  }
  for (const std::size_t t : p.candidates) p.problem.rate.push_back(candidates[t].slip_speed);
  CoulombSolution solution = solve_coulomb(p.problem);
  if (!solution.solved) {
    throw Error(Error::Kind::Run, subject(candidates[p.candidates[0]]), "effective mass", "infinite",
                "an impact meets what joints and other contacts hold everything fast: nothing can give way");
  }
  // The impulses do the work `first` + `second`, J; scaled by k they do k `first` + k^2 `second`.
  double first = 0, second = 0;
  for (std::size_t i = 0; i < p.problem.size(); ++i) {
    const double before = i < n ? candidates[p.candidate_of[i]].gap_rate[p.index_of[i]] : p.problem.rate[i];
    first += solution.force[i] * before;
    second += solution.force[i] * (solution.rate[i] - p.problem.rate[i]) / 2;
  }
  if (first + second > 0 && second > 0) {
    assert(first < 0);  // the candidate approaches, so the impulses first reduce the energy
    for (double& impulse : solution.force) impulse *= -first / second;
  }
  apply(p.response, solution.force, candidates, states, y);
}

void ImpactSolver::apply_impact_law(double time, std::size_t struck, std::span<ContactCandidate> candidates,
                                    std::span<BodyState> states, Compensated& y,
                                    const Restitution& restitution) {
  const ContactCandidate& candidate = candidates[struck];
  const auto part = [&](std::size_t t, int point) { return t == struck && closes_at(candidate, point); };
  ContactProblem p = ContactProblem::of(candidates, part, {}, equations_, time, y.value());
  const std::size_t n = p.problem.points(), size = n + 1;
  // Fraction of the normal impulse at each point: the same as for the impulse that stops all points.
  std::vector<double> fraction(n, 1);
  for (std::size_t i = 0; i < n; ++i) p.problem.rate.push_back(candidate.gap_rate[p.index_of[i]]);
  p.problem.rate.push_back(candidate.slip_speed);
  if (n > 1) {
    const CoulombSolution stopped = solve_coulomb(p.problem);
    const double sum =
        std::accumulate(stopped.force.begin(), stopped.force.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
    if (stopped.solved && sum > 0) {
      for (std::size_t i = 0; i < n; ++i) fraction[i] = stopped.force[i] / sum;
    } else {
      std::fill(fraction.begin(), fraction.end(), 1.0 / static_cast<double>(n));
    }
  }
  const std::vector<double>& response = p.problem.response;
  ImpactPoint point{0, candidate.slip_speed, 0, 0, response[size * size - 1]};
  const ContactRules& rules = finder_.rules();
  ImpactCoefficients c{0, candidate.friction, candidate.friction * rules.friction_after_stop,
                       rules.tangential_restitution};
  for (std::size_t i = 0; i < n; ++i) {
    point.gap_rate += fraction[i] * candidate.gap_rate[p.index_of[i]];
    c.restitution += fraction[i] * restitution(candidate, static_cast<int>(p.index_of[i]));
    point.cross_response += fraction[i] * response[i * size + n];
    for (std::size_t j = 0; j < n; ++j)
      point.normal_response += fraction[i] * fraction[j] * response[i * size + j];
  }
  if (!(point.normal_response > 0)) {
    throw Error(Error::Kind::Run, subject(candidate), "effective mass", "infinite",
                "an impact meets what joints and other contacts hold everything fast: nothing can give way");
  }
  // Without a response along the tangent there is no slip, and nothing couples to the tangent.
  if (!(point.tangent_response > 0))
    point.tangent_response = 1, point.cross_response = 0, c.friction = c.later_friction = 0;
  const ContactImpulse along =
      rules.impact == ImpactRule::Poisson ? poisson_impulse(point, c) : stronge_impulse(point, c);
  const ContactImpulse impulse = with_tangential_restitution(point, c, along);
  std::vector<double> impulses;
  for (std::size_t i = 0; i < n; ++i) impulses.push_back(fraction[i] * impulse.normal);
  impulses.push_back(impulse.tangential);
  apply(p.response, impulses, candidates, states, y);
}

std::int64_t ImpactSolver::resolve(double time, std::vector<ContactCandidate>& candidates,
                                   std::span<BodyState> states, Compensated& y,
                                   const Restitution& restitution) {
  std::int64_t count = 0;
  const bool together = finder_.rules().simultaneous == Simultaneous::Together;
  const auto all = [](std::size_t, int) { return true; };
  const auto to_rest = [&](const ContactCandidate& candidate, int point) {
    const double e = restitution(candidate, point);
    return e < 1 ? 0 : e;
  };
  for (;;) {
    std::size_t worst = candidates.size();
    for (std::size_t t = 0; t < candidates.size(); ++t) {
      if (closes(candidates[t]) &&
          (worst == candidates.size() || fastest(candidates[t]) < fastest(candidates[worst])))
        worst = t;
    }
    if (worst == candidates.size()) return count;
    if (count >= 2 * kMaxInSequence) {
      throw Error(Error::Kind::Run, subject(candidates[worst]), "impacts",
                  std::to_string(count) + " and more", "they do not stop at one instant");
    }
    const bool at_limit = count >= kMaxInSequence;
    if (together || at_limit) {
      for (const ContactCandidate& candidate : candidates) count += closes(candidate) ? 1 : 0;
      if (at_limit) {
        solve_impact(time, all, candidates, states, y, to_rest);
      } else {
        solve_impact(time, all, candidates, states, y, restitution);
      }
      continue;
    }
    ++count;
    if (finder_.rules().impact != ImpactRule::Newton && !candidates[worst].limit) {
      apply_impact_law(time, worst, candidates, states, y, restitution);
      continue;
    }
    // Corners of one shape that approach together are one impact. If one of them opens, the corners are
    // resolved alternately until neither approaches: this is the limit for corners that touch at slightly
    // different times.
    const ContactCandidate& struck = candidates[worst];
    bool both = true;
    for (int i = 0; i < struck.count; ++i) both = both && closes_at(struck, i);
    const auto part = [&](std::size_t t, int point) {
      return candidates[t].limit.has_value() || (t == worst && (both || closes_at(candidates[t], point)));
    };
    solve_impact(time, part, candidates, states, y, restitution);
  }
}

bool ImpactSolver::resolve_jamming(double time, std::vector<ContactCandidate>& candidates,
                                   std::span<BodyState> states, Compensated& y) {
  std::size_t worst = candidates.size();
  int worst_point = 0, worst_direction = 0;
  double least = 0, response[4] = {};
  ContactResponse found;
  for (std::size_t t = 0; t < candidates.size(); ++t) {
    const ContactCandidate& candidate = candidates[t];
    if (std::abs(candidate.slip_speed) <= candidate.rate_tolerance || candidate.sliding_friction == 0)
      continue;
    const int direction = candidate.slip_speed > 0 ? 1 : -1;
    for (int i = 0; i < candidate.count; ++i) {
      if (std::abs(candidate.gap_rate[i]) > candidate.rate_tolerance) continue;
      ContactResponse r;
      std::vector<double> w;
      equations_.compute_response(time, y.value(), {candidate.rows[i].normal, candidate.rows[i].tangent}, r,
                                  w);
      const double own = w[0] - direction * candidate.sliding_friction *
                                    w[1];  // the gap's rate per normal impulse with its friction
      if (own / w[0] >= least) continue;
      least = own / w[0];
      worst = t, worst_point = i, worst_direction = direction;
      std::copy(w.begin(), w.end(), response);
      found = std::move(r);
    }
  }
  if (worst == candidates.size()) return false;
  const ContactCandidate& candidate = candidates[worst];
  const double nn = response[0], nt = response[1], tn = response[2], tt = response[3],
               mu = candidate.sliding_friction;
  // First phase, until the slip ends: J_t = -mu J_n.
  const double slowing = tn - worst_direction * mu * tt;
  if (worst_direction * slowing >= 0) return false;
  const double first = -candidate.slip_speed / slowing;
  double gap_rate = candidate.gap_rate[worst_point] + (nn - worst_direction * mu * nt) * first;
  // Second phase, without slip (or with reversed slip if friction does not hold), until the gap no longer
  // closes.
  const double stick = -tn / tt;
  const double drawn = std::clamp(stick, -mu, mu);
  const double opening = nn + drawn * nt;
  const double second = opening > 0 && gap_rate < 0 ? -gap_rate / opening : 0;
  const double impulses[2] = {first + second, -worst_direction * mu * first + drawn * second};
  apply(found, impulses, candidates, states, y);
  return true;
}

}  // namespace plumb::precise
