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
constexpr std::int64_t kMostInSequence = 20000;

double fastest(const ContactCandidate& touch) {
  double least = 0;
  for (int i = 0; i < touch.count; ++i) least = std::min(least, touch.closing[i]);
  return least;
}

}  // namespace

TouchProblem TouchProblem::of(std::span<const ContactCandidate> touches,
                              const std::function<bool(std::size_t, int)>& take,
                              std::span<const Brake> brakes, EquationsOfMotion& equations, double time,
                              std::span<const double> y) {
  TouchProblem out;
  std::vector<Row<double>> normals, tangents;
  for (std::size_t t = 0; t < touches.size(); ++t) {
    bool any = false;
    for (int i = 0; i < touches[t].count; ++i) {
      if (!take(t, i)) continue;
      if (!any) {
        out.touches.push_back(t);
        out.problem.patches.push_back({touches[t].friction, 0, 0});
        tangents.push_back(touches[t].rows[i].tangent);
      }
      any = true;
      out.touch_of.push_back(t);
      out.index_of.push_back(static_cast<std::size_t>(i));
      out.problem.patch_of.push_back(static_cast<int>(out.touches.size()) - 1);
      normals.push_back(touches[t].rows[i].normal);
    }
  }
  for (const Brake& brake : brakes) {
    out.problem.patches.push_back({0, 0, brake.bound});
    tangents.push_back(brake.row);
  }
  normals.insert(normals.end(), tangents.begin(), tangents.end());
  if (!normals.empty()) equations.respond(time, y, std::move(normals), out.response, out.problem.response);
  return out;
}

void ImpactLaw::apply(const ContactResponse& response, std::span<const double> impulses,
                      std::span<ContactCandidate> touches, std::span<BodyState> states, Compensated& y) {
  assert(impulses.size() == response.rows.size());
  equations_.push(response, impulses, y);
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    states[equations_.bodies()[slot]] = EquationsOfMotion::state(y.value(), slot);
  }
  for (ContactCandidate& touch : touches) finder_.measure(states, touch);
}

std::string ImpactLaw::subject(const ContactCandidate& touch) const {
  if (touch.stop) return "joint '" + equations_.kind_joints().stops()[*touch.stop].joint + "'";
  return "bodies '" + equations_.name(finder_.outlines()[touch.pair.a].body) + "' and '" +
         equations_.name(finder_.outlines()[touch.pair.b].body) + "'";
}

void ImpactLaw::strike(double time, const std::function<bool(std::size_t, int)>& takes_part,
                       std::span<ContactCandidate> touches, std::span<BodyState> states, Compensated& y,
                       const Restitution& restitution) {
  TouchProblem p = TouchProblem::of(touches, takes_part, {}, equations_, time, y.value());
  const std::size_t n = p.problem.points();
  for (std::size_t i = 0; i < n; ++i) {
    const ContactCandidate& touch = touches[p.touch_of[i]];
    const int index = static_cast<int>(p.index_of[i]);
    const double closing = touch.closing[index];
    const double wanted = closing < 0 ? -restitution(touch, index) * closing : 0;
    p.problem.rate.push_back(closing - wanted);
  }
  for (const std::size_t t : p.touches) p.problem.rate.push_back(touches[t].slip);
  CoulombSolution solution = solve_coulomb(p.problem);
  if (!solution.solved) {
    throw Error(Error::Kind::Run, subject(touches[p.touches[0]]), "effective mass", "infinite",
                "an impact meets what joints and other contacts hold everything fast: nothing can give way");
  }
  // The impulses do the work `first` + `second`, J; scaled by k they do k `first` + k^2 `second`.
  double first = 0, second = 0;
  for (std::size_t i = 0; i < p.problem.size(); ++i) {
    const double before = i < n ? touches[p.touch_of[i]].closing[p.index_of[i]] : p.problem.rate[i];
    first += solution.force[i] * before;
    second += solution.force[i] * (solution.rate[i] - p.problem.rate[i]) / 2;
  }
  if (first + second > 0 && second > 0) {
    assert(first < 0);  // the touch approaches, so the impulses first reduce the energy
    for (double& impulse : solution.force) impulse *= -first / second;
  }
  apply(p.response, solution.force, touches, states, y);
}

void ImpactLaw::strike_point(double time, std::size_t struck, std::span<ContactCandidate> touches,
                             std::span<BodyState> states, Compensated& y, const Restitution& restitution) {
  const ContactCandidate& touch = touches[struck];
  const auto part = [&](std::size_t t, int point) { return t == struck && closes_at(touch, point); };
  TouchProblem p = TouchProblem::of(touches, part, {}, equations_, time, y.value());
  const std::size_t n = p.problem.points(), size = n + 1;
  // Fraction of the normal impulse at each point: the same as for the impulse that stops all points.
  std::vector<double> share(n, 1);
  for (std::size_t i = 0; i < n; ++i) p.problem.rate.push_back(touch.closing[p.index_of[i]]);
  p.problem.rate.push_back(touch.slip);
  if (n > 1) {
    const CoulombSolution stopped = solve_coulomb(p.problem);
    const double sum =
        std::accumulate(stopped.force.begin(), stopped.force.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
    if (stopped.solved && sum > 0) {
      for (std::size_t i = 0; i < n; ++i) share[i] = stopped.force[i] / sum;
    } else {
      std::fill(share.begin(), share.end(), 1.0 / static_cast<double>(n));
    }
  }
  const std::vector<double>& response = p.problem.response;
  ImpactPoint point{0, touch.slip, 0, 0, response[size * size - 1]};
  const ContactRules& rules = finder_.rules();
  ImpactCoefficients c{0, touch.friction, touch.friction * rules.friction_after_stop,
                       rules.tangential_restitution};
  for (std::size_t i = 0; i < n; ++i) {
    point.closing += share[i] * touch.closing[p.index_of[i]];
    c.restitution += share[i] * restitution(touch, static_cast<int>(p.index_of[i]));
    point.cross_response += share[i] * response[i * size + n];
    for (std::size_t j = 0; j < n; ++j) point.normal_response += share[i] * share[j] * response[i * size + j];
  }
  if (!(point.normal_response > 0)) {
    throw Error(Error::Kind::Run, subject(touch), "effective mass", "infinite",
                "an impact meets what joints and other contacts hold everything fast: nothing can give way");
  }
  // Without a response along the tangent there is no slip, and nothing couples to the tangent.
  if (!(point.tangent_response > 0))
    point.tangent_response = 1, point.cross_response = 0, c.friction = c.later_friction = 0;
  const ContactImpulse along =
      rules.impact == ImpactRule::Poisson ? poisson_impulse(point, c) : stronge_impulse(point, c);
  const ContactImpulse impulse = with_tangential_restitution(point, c, along);
  std::vector<double> impulses;
  for (std::size_t i = 0; i < n; ++i) impulses.push_back(share[i] * impulse.normal);
  impulses.push_back(impulse.tangential);
  apply(p.response, impulses, touches, states, y);
}

std::int64_t ImpactLaw::resolve(double time, std::vector<ContactCandidate>& touches,
                                std::span<BodyState> states, Compensated& y, const Restitution& restitution) {
  std::int64_t count = 0;
  const bool together = finder_.rules().simultaneous == Simultaneous::Together;
  const auto all = [](std::size_t, int) { return true; };
  const auto to_rest = [&](const ContactCandidate& touch, int point) {
    const double e = restitution(touch, point);
    return e < 1 ? 0 : e;
  };
  for (;;) {
    std::size_t worst = touches.size();
    for (std::size_t t = 0; t < touches.size(); ++t) {
      if (closes(touches[t]) && (worst == touches.size() || fastest(touches[t]) < fastest(touches[worst])))
        worst = t;
    }
    if (worst == touches.size()) return count;
    if (count >= 2 * kMostInSequence) {
      throw Error(Error::Kind::Run, subject(touches[worst]), "impacts", std::to_string(count) + " and more",
                  "they do not stop at one instant");
    }
    const bool at_limit = count >= kMostInSequence;
    if (together || at_limit) {
      for (const ContactCandidate& touch : touches) count += closes(touch) ? 1 : 0;
      if (at_limit) {
        strike(time, all, touches, states, y, to_rest);
      } else {
        strike(time, all, touches, states, y, restitution);
      }
      continue;
    }
    ++count;
    if (finder_.rules().impact != ImpactRule::Newton && !touches[worst].stop) {
      strike_point(time, worst, touches, states, y, restitution);
      continue;
    }
    // Corners of one shape that approach together are one impact. If one of them opens, the corners are
    // resolved alternately until neither approaches: this is the limit for corners that touch at slightly
    // different times.
    const ContactCandidate& struck = touches[worst];
    bool both = true;
    for (int i = 0; i < struck.count; ++i) both = both && closes_at(struck, i);
    const auto part = [&](std::size_t t, int point) {
      return touches[t].stop.has_value() || (t == worst && (both || closes_at(touches[t], point)));
    };
    strike(time, part, touches, states, y, restitution);
  }
}

bool ImpactLaw::jamb(double time, std::vector<ContactCandidate>& touches, std::span<BodyState> states,
                     Compensated& y) {
  std::size_t worst = touches.size();
  int worst_point = 0, worst_way = 0;
  double least = 0, response[4] = {};
  ContactResponse found;
  for (std::size_t t = 0; t < touches.size(); ++t) {
    const ContactCandidate& touch = touches[t];
    if (std::abs(touch.slip) <= touch.quiet || touch.sliding_friction == 0) continue;
    const int way = touch.slip > 0 ? 1 : -1;
    for (int i = 0; i < touch.count; ++i) {
      if (std::abs(touch.closing[i]) > touch.quiet) continue;
      ContactResponse r;
      std::vector<double> w;
      equations_.respond(time, y.value(), {touch.rows[i].normal, touch.rows[i].tangent}, r, w);
      const double own =
          w[0] - way * touch.sliding_friction * w[1];  // the gap's rate per normal impulse with its friction
      if (own / w[0] >= least) continue;
      least = own / w[0];
      worst = t, worst_point = i, worst_way = way;
      std::copy(w.begin(), w.end(), response);
      found = std::move(r);
    }
  }
  if (worst == touches.size()) return false;
  const ContactCandidate& touch = touches[worst];
  const double nn = response[0], nt = response[1], tn = response[2], tt = response[3],
               mu = touch.sliding_friction;
  // First phase, until the slip ends: J_t = -mu J_n.
  const double slowing = tn - worst_way * mu * tt;
  if (worst_way * slowing >= 0) return false;
  const double first = -touch.slip / slowing;
  double closing = touch.closing[worst_point] + (nn - worst_way * mu * nt) * first;
  // Second phase, without slip (or with reversed slip if friction does not hold), until the gap no longer
  // closes.
  const double stick = -tn / tt;
  const double drawn = std::clamp(stick, -mu, mu);
  const double opening = nn + drawn * nt;
  const double second = opening > 0 && closing < 0 ? -closing / opening : 0;
  const double impulses[2] = {first + second, -worst_way * mu * first + drawn * second};
  apply(found, impulses, touches, states, y);
  return true;
}

}  // namespace plumb::precise
