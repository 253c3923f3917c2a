#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/precise/integration/integrator.h"
#include "engine/scene/error.h"

// Steps of closed linkages near kinematic singularities, and across them.
namespace plumb::precise {
namespace {

/// A crossing farther away than kNear steps is ignored. At tolerances finer than kNearAt this distance grows
/// as the tolerance falls, because steps beside a crossing may be small. Steps that see the singularity off
/// the branch shorten in proportion to the distance, and steps limited by rounding (divided by the strength
/// of a weak row) in proportion to the tolerance. They would never come near the crossing, and would
/// underflow.
constexpr double kNear = 5, kNearAt = 1e-9;
/// Rows count as weak if the independent fraction of the weakest row is below this: about 0.3 rad from a
/// crossing. Crossings do not affect steps farther away, and a larger value would treat other motions as an
/// approach.
constexpr double kWeak = 0.1;
/// Look-ahead, in steps: a step that ends before a crossing leaves room for the step across it.
constexpr double kAhead = 2.2;
/// Position of the crossing within the step across it, as a fraction of the step, in order of preference: far
/// from the method's stages, which suffer from rounding near the crossing. kSoon is for steps that start
/// close to a crossing.
constexpr double kBetween[] = {0.465, 0.45, 0.48, 0.43, 0.5, 0.4, 0.55, 0.715, 0.7, 0.15, 0.16};
constexpr double kSoon[] = {0.15, 0.16, 0.14, 0.225, 0.065, 0.03, 0.02, 0.465, 0.43, 0.5};
/// Distances to a crossing, in steps. Within kPass a step goes across it, and within kClose it uses kSoon's
/// positions. From farther away a step ends before the crossing: half a step before it, or beyond kFar at
/// least kFar / 2 steps before it.
constexpr double kFar = 1.1, kPass = 0.75, kClose = 0.3;
/// Shortest and longest step across a crossing, as multiples of the proposed step.
constexpr double kShortestOver = 0.2, kLongestOver = 2.5;
/// Error bound of steps near crossings, as a fraction of the scene's length or speed, or of one radian: the
/// motion so far selects the branch, so it must be accurate.
constexpr double kTight = 1e-11;
/// Error bound of a step across a crossing, in tolerances, where rounding prevents a smaller error.
constexpr double kLoose = 1;
/// Steps give up if they are shorter than this fraction of the time in which the scene's accelerations cross
/// its length.
constexpr double kShortest = 1e-5;

}  // namespace

/// Returns true if the linkage approaches or leaves a singularity: the strength of its weakest row, which is
/// proportional to the distance from the singularity, would reach zero within a few steps if extrapolated.
/// The last step is from `start_` to `time_`.
bool EventFreeIntegrator::is_near_singularity() {
  if (!equations_.has_loops() || stiff_ || method_ == MotionMethod::Symplectic ||
      equations_.has_active_constraints())
    return false;
  const double h = time_ - start_;
  if (!(h > 0) || last_implicit_ || proposed_step_ == 0) return near_singularity_;
  const double now = std::sqrt(rank_at_start_.min_pivot_ratio), before = std::sqrt(previous_pivot_ratio_);
  const bool weak = rank_at_start_.min_pivot_ratio < kWeak;
  const double steps = kNear * (weak ? std::max(1.0, kNearAt / (kSteps * tolerance_)) : 1);
  return now * h < std::abs(now - before) * steps * std::max(proposed_step_, h);
}

/// Extrapolates the motion so far to the expected motion of the next step.
void EventFreeIntegrator::extrapolate_motion() {
  const bool near = is_near_singularity();
  if (near && !near_singularity_) {
    equations_.min_pivot_ratio_at(time_, y_.value());
    equations_.freeze_dependent();
  }
  if (!near && near_singularity_) equations_.release_dependent();
  near_singularity_ = near;
  has_expected_ = near && time_ > start_ && !last_implicit_;
  if (!has_expected_) return;
  const StepPolynomial& path = polynomial();
  passage_.set_expected(path, start_, time_, y0_.value());
}

/// Decides from the rows themselves whether the next step is near a singularity. For use if there was no last
/// step.
void EventFreeIntegrator::check_initial_rank() {
  if (!equations_.has_loops() || near_singularity_ || stiff_ || method_ == MotionMethod::Symplectic ||
      equations_.has_active_constraints())
    return;
  near_singularity_ = rank_at_start_.min_pivot_ratio < kWeak || rank_at_start_.dependent > 0;
}

double EventFreeIntegrator::step_near_singularity(double limit) {
  if (!has_expected_) passage_.set_expected(start_, y0_.value(), rate_at_start());
  const double shortest_step = kShortest * scales_.length / scales_.speed;
  double h = proposed_step_;
  for (;;) {
    if (!(h > shortest_step) || !(start_ + h > start_)) throw_singular();
    const std::optional<SingularityPassage::Crossing> crossing =
        passage_.crossing(start_, start_ + kAhead * h);
    const double left = crossing ? crossing->time - start_ : 0;
    const bool meets = crossing && crossing->meets;
    const double strict = crossing ? std::min(1.0, kTight / tolerance_) : 1;
    const double loose = std::max(strict, kLoose * kSteps);
    double error = std::numeric_limits<double>::infinity();
    if (!meets || left > kPass * h) {
      const double end = start_ + (!crossing         ? h
                                   : !meets          ? std::min(h, 0.5 * left)
                                   : left > kFar * h ? std::min(h, left - 0.5 * kFar * h)
                                                     : left - 0.5 * h);
      error = try_near_singularity(std::min(end, limit));
      if (error <= strict) return accept_near_singularity(error / strict);
      h = (std::min(end, limit) - start_) * control_.after_rejection(error / strict);
      if (!crossing) proposed_step_ = std::min(proposed_step_, h);  // later steps must not be longer
    } else {
      const std::span<const double> places = left > kClose * h ? std::span<const double>(kBetween) : kSoon;
      double best = loose, best_end = 0;
      for (const double place : places) {
        const double length = left / place;
        if (length < kShortestOver * h || length > kLongestOver * h || start_ + length > limit) continue;
        error = try_near_singularity(start_ + length);
        if (error <= strict) break;
        if (error <= best) best = error, best_end = start_ + length;
        ++rejected_;
      }
      if (error > strict && best_end > 0) error = try_near_singularity(best_end);
      if (error <= loose) {
        ++singularity_steps_;
        return accept_near_singularity(std::min(error / strict, 1.0));
      }
      if (limit < start_ + left / 0.55) {  // another event comes before the step's end
        error = try_near_singularity(limit);
        if (error <= loose) return accept_near_singularity(std::min(error / strict, 1.0));
      }
      h *= 0.6;
    }
    ++rejected_;
    y_ = y0_;
    time_ = start_;
    rate_known_ = false;
  }
}

double EventFreeIntegrator::accept_near_singularity(double error) {
  equations_.reset_rank();
  rate_at_end();
  accept(time_ - start_, error);
  return time_;
}

/// Tries a step to `end` and returns its error, without the part that violates the joints, because the
/// projection removes that part. Leaves y at `end`.
double EventFreeIntegrator::try_near_singularity(double end) {
  const double h = end - start_;
  constexpr double kRefused = std::numeric_limits<double>::infinity();
  last_near_singularity_ = true;
  last_implicit_ = false;
  all_.method.step(passage_, start_, h, y0_.value());
  std::vector<double> fifth(y_.size()), third(y_.size());
  all_.method.error_vectors(h, fifth, third);
  double raw_size = 0;
  for (const double e : fifth) raw_size = std::max(raw_size, std::abs(e));
  if (!std::isfinite(raw_size)) return kRefused;
  std::vector<double> raw(y0_.value().begin(), y0_.value().end());
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] += all_.method.increment()[i];
  try {
    apply_increment(end);
  } catch (const Error&) {  // too far from the joints' manifold to be projected
    return kRefused;
  }
  equations_.project_change(fifth);
  equations_.project_change(third);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    // If the projection moves the state by more than the tolerance, it may have reached another branch.
    if (i % EquationsOfMotion::kPerBody < 3 &&
        !(std::abs(y_[i] - raw[i]) <= kSteps * std::max(1.0, kTight / tolerance_) * all_.error_scale[i]))
      return kRefused;
  }
  return Dop853::error(all_.error_scale, fifth, third);
}

void EventFreeIntegrator::throw_singular() const {
  const std::string joint = equations_.weakest_joint();
  throw Error(Error::Kind::Run, joint.empty() ? "the mechanism" : "joint '" + joint + "'", "hold",
              shortest(std::sqrt(rank_at_start_.min_pivot_ratio)),
              "the linkage is all but singular here, and its way on cannot be told to tolerance " +
                  shortest(tolerance_ * kSteps) +
                  ": joints hardly hold a direction that two branches of its motion share; try a larger "
                  "tolerance (1e-9 if cranks are redundant), give a link that need not be as long as another "
                  "a length "
                  "that is clearly its own, or use Realtime");
}

}  // namespace plumb::precise
