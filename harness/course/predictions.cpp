#include "harness/course/predictions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "harness/course/design.h"
#include "harness/course/flight.h"
#include "harness/course/likeness.h"

namespace plumb::course {
namespace {

// Largest distance of two paths that count as equal, as a fraction of their distance from the correct one. A
// contact that is found a step sooner or later shifts a path by about a hundredth of it.
constexpr double kSamePath = 0.1;

// If figures are exactly equal, paths may deviate by kManners times the difference between correct engines of
// different design, or by kLoosePath of the mistake's distance from the correct paths.
constexpr double kManners = 2, kLoosePath = 0.3;

// A search for a factor gives up if even near the best factor this distance remains, as a fraction of the
// tested engine's distance from the correct paths.
constexpr double kHopeless = 0.2;

// A design is dropped if another one is nearer to the engine in the checks that it passes, by this factor.
constexpr double kClearlyNearer = 5;

// Largest distance from the tested engine's paths in an experiment at which a mistake still counts as
// confirmed, as a fraction of that engine's distance from the correct paths.
constexpr double kNearest = 0.05;

// m, over all states: a design is dropped if it is farther than this from the engine in a check in which
// another one gives its paths. Iterations that end sooner or later cause smaller differences.
constexpr double kSameDesign = 1e-4;

// A mistake changes nothing if its paths are nearer than this to those of a correct engine.
constexpr double kUnchanged = 1e-6;

// Largest distance of the tested engine's paths from those of the mistake that explains them, as a fraction
// of their distance from the correct ones. Iterations that have not converged cause such differences.
constexpr double kExactly = 1e-3;

// The same for bodies without contacts or joints: only rounding differs.
constexpr double kExactlyFree = 1e-9;

// m, largest difference that iterations cause over all states, even if the paths are far from the correct
// ones.
constexpr double kMostLeft = 0.01;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct TooFar : std::runtime_error {
  TooFar() : std::runtime_error("too far") {}
};

// Returns true if an engine's paths are those of a correct one, and those of a mistake differ.
bool shows_no_mistake(const std::vector<Recorded>& seen, const std::vector<Recorded>& right,
                      const std::vector<Recorded>& wrong) {
  return distance(seen, seen, right, right.size()) <= kUnchanged &&
         distance(seen, seen, wrong, right.size()) > kSameDesign;
}

// Returns true for each design that gives the tested engine's paths in all checks that a mistake does not
// spoil: those in which some design gives its paths. A mistake may change the paths of a check that the
// engine passes, such as angles where only a spin is read; no design gives these paths, and they tell nothing
// about designs. Returns true for all designs if unspoilt checks contradict each other.
std::vector<bool> designs_of_unspoilt_checks(const std::vector<std::vector<double>>& off) {
  std::vector<bool> out(off.size(), true);
  for (std::size_t check = 0; check < off.front().size(); ++check) {
    const auto gives = [&](const std::vector<double>& design) { return design[check] <= kUnchanged; };
    if (std::none_of(off.begin(), off.end(), gives)) continue;
    for (std::size_t i = 0; i < off.size(); ++i) out[i] = out[i] && off[i][check] <= kSameDesign;
  }
  if (std::find(out.begin(), out.end(), true) == out.end()) out.assign(off.size(), true);
  return out;
}

}  // namespace

Predictions::Predictions(const Lab& lab, const std::vector<Outcome>& chapter)
    : lab_(lab),
      chapter_(chapter),
      manners_(manners_of(chapter.front().chapter->number, lab)),
      experiments_(experiments(chapter.front().chapter->number)) {
  for (const Outcome& outcome : chapter) seen_.push_back(outcome.finding.mistake);
  const std::vector<std::vector<double>> off = misfits();
  std::vector<double> far;  // over all checks
  for (const std::vector<double>& each : off) {
    double sum = 0;
    for (const double distance : each) sum = std::hypot(sum, distance);
    far.push_back(sum);
  }
  const double least = *std::min_element(far.begin(), far.end());
  for (std::size_t manner = 0; manner < manners_.size(); ++manner)
    if (far[manner] <= kClearlyNearer * std::max(least, kUnchanged)) likely_.push_back(manner);
  const std::vector<bool> agrees = designs_of_unspoilt_checks(off);
  std::stable_partition(likely_.begin(), likely_.end(), [&](std::size_t manner) { return agrees[manner]; });
  const bool told_apart = manners_.size() == 1 || likely_.size() < manners_.size();
  known_ = least <= kUnchanged && (told_apart || (chapter.front().chapter->number < 4 && measured_push(lab)));
}

// Returns the distances of the tested engine's paths from those of a correct engine of each design, in each
// of the checks that it passes.
std::vector<std::vector<double>> Predictions::misfits() {
  std::vector<std::vector<double>> out(manners_.size());
  for (std::size_t i = 0; i < chapter_.size(); ++i) {
    if (!chapter_[i].check->repeatable || chapter_[i].finding.verdict != Verdict::Pass) continue;
    for (std::size_t manner = 0; manner < manners_.size(); ++manner)
      if (const auto& right = of({"", manner}, i); right)
        out[manner].push_back(distance(chapter_[i].runs, chapter_[i].runs, right->runs, right->runs.size()));
      else
        out[manner].push_back(0);
  }
  return out;
}

const std::optional<Attempt>& Predictions::of(const Planted& planted, std::size_t check) {
  const auto [place, is_new] = attempts_.try_emplace({planted, check});
  if (is_new) place->second = within(planted, check, kInfinity);
  return place->second;
}

std::optional<Attempt> Predictions::attempt(const Planted& planted, std::size_t check, Lab::Watcher watcher) {
  return attempt(planted, *chapter_[check].check, std::move(watcher));
}

std::optional<Attempt> Predictions::attempt(const Planted& planted, const Check& check,
                                            Lab::Watcher watcher) {
  return attempt(planted.mistake, manners_[planted.manner], check, std::move(watcher));
}

std::optional<Attempt> Predictions::attempt(const std::string& mistake, const Manner& manner,
                                            const Check& check, Lab::Watcher watcher) {
  const auto student = make_student(mistake, lab_.scheme(), manner);
  const auto watch = [&](std::size_t run, std::size_t state, std::span<const BodyState> states) {
    ++steps_;
    if (watcher) watcher(run, state, states);
  };
  Attempt out;
  try {
    Lab lab(*student, lab_.plain_settings(), &out.runs, watch);
    lab.refuse_as(lab_);
    out.finding = check.run(lab);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return out;
}

// Runs a check until its paths are farther than `limit` from the tested engine's; returns nullopt in that
// case.
std::optional<Attempt> Predictions::within(const Planted& planted, std::size_t check, double limit) {
  if (std::isinf(limit)) return attempt(planted, check, {});
  const auto right = attempts_.find({Planted{"", planted.manner}, check});
  if (right == attempts_.end() || !right->second) return std::nullopt;
  Distance distance(chapter_[check].runs, right->second->runs.size());
  return attempt(planted, check, [&](std::size_t run, std::size_t state, std::span<const BodyState> states) {
    if (distance.add(run, state, states) > limit) throw TooFar();
  });
}

const std::optional<Attempt>& Predictions::nearby(const Planted& planted, std::size_t check, bool exactly) {
  static const std::optional<Attempt> none;
  if (const auto known = attempts_.find({planted, check}); known != attempts_.end()) return known->second;
  if (too_far_.contains({planted, check})) return none;
  const double limit = exactly ? exact_limit(check, planted.manner) : farthest(check, planted.manner);
  std::optional<Attempt> run;
  if (!screened_out(planted, check, limit)) run = within(planted, check, limit);
  if (!run) {
    if (!exactly) too_far_.emplace(planted, check);
    return none;
  }
  return attempts_.emplace(std::pair{planted, check}, std::move(run)).first->second;
}

// Returns true if a mistake is already too far from the tested engine in the run that leaves the correct
// paths first. Most mistakes change nothing in that run, and running the check up to it would take longer.
bool Predictions::screened_out(const Planted& planted, std::size_t check, double limit) {
  const auto& right = of({"", planted.manner}, check);
  if (!right || std::isinf(limit)) return false;
  const std::vector<Recorded>& seen = chapter_[check].runs;
  const auto [place, is_new] = screens_.try_emplace({check, planted.manner, limit});
  if (is_new)
    for (std::size_t r = 0; r < std::min(seen.size(), right->runs.size()); ++r) {
      Distance distance(seen, right->runs.size());
      const auto& states = right->runs[r].trace.states;
      for (std::size_t k = 1; k < std::min(states.size(), seen[r].trace.states.size()); ++k) {
        if (!(distance.add(r, k, states[k]) > limit)) continue;
        if (!place->second || k < place->second->second) place->second = {r, k};
        break;
      }
    }
  if (!place->second) return false;
  const auto [run, states] = *place->second;
  Distance distance(seen, right->runs.size());
  const auto student = make_student(planted.mistake, lab_.scheme(), manners_[planted.manner]);
  try {
    const Lab lab(*student, lab_.plain_settings(), nullptr,
                  [&, run = run](std::size_t, std::size_t state, std::span<const BodyState> now) {
                    ++steps_;
                    if (distance.add(run, state, now) > limit) throw TooFar();
                  });
    const double dt = seen[run].dt;
    lab.run(seen[run].scene, (static_cast<double>(states) + 0.5) * dt,
            static_cast<int>(std::round(lab_.dt() / dt)));
  } catch (const TooFar&) {
    return true;
  } catch (const std::exception&) {
    return false;
  }
  return false;
}

// Returns the tested engine's run of an experiment; nullopt if it does not support the scene.
const std::optional<Recorded>& Predictions::seen_in(std::size_t experiment) {
  const auto [place, is_new] = seen_in_.try_emplace(experiment);
  if (!is_new) return place->second;
  const auto& [scene, duration] = experiments_[experiment];
  try {
    place->second = {scene, lab_.run(scene, duration), lab_.dt()};
  } catch (const std::exception&) {
    place->second.reset();
  }
  return place->second;
}

// Returns the distance of the tested engine's paths from those of a mistake in an experiment.
std::optional<double> Predictions::far_in(std::size_t experiment, const Planted& planted) {
  const auto& seen = seen_in(experiment);
  if (!seen) return std::nullopt;
  const auto student = make_student(planted.mistake, lab_.scheme(), manners_[planted.manner]);
  const auto& [scene, duration] = experiments_[experiment];
  std::vector<Recorded> wrong;
  try {
    Lab(*student, lab_.plain_settings(), &wrong).run(scene, duration);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  steps_ += static_cast<long>(wrong.front().trace.states.size());
  return distance({*seen}, {*seen}, wrong, 1);
}

void Predictions::tell_apart(std::vector<Fit>& found) {
  const auto same_name = [&](const Fit& fit) { return fit.name == found.front().name; };
  for (std::size_t i = 0; i < experiments_.size() && !found.empty(); ++i) {
    const auto& seen = seen_in(i);
    if (!seen) continue;
    // A spring's force is a formula of several terms, of which learners spoil more than one.
    const auto is_spring = [](const ForceLaw& law) { return std::holds_alternative<SpringForce>(law); };
    const bool free =
        flies_freely(*seen) && std::none_of(seen->scene.forces.begin(), seen->scene.forces.end(), is_spring);
    // A body that is alone has no contacts, not even by mistake: only rounding differs.
    const bool alone = seen->scene.bodies.size() == 1 && seen->scene.joints.empty();
    if (!free && std::all_of(found.begin(), found.end(), same_name)) continue;
    std::vector<double> far, limit;
    std::vector<bool> moves_right;
    double least = kInfinity, all = kInfinity;  // of the mistakes, and of the correct engine
    for (const Fit& fit : found) {
      const std::optional<double> right = far_in(i, {"", fit.planted.manner}), wrong = far_in(i, fit.planted);
      if (!right || !wrong) break;
      far.push_back(*wrong);
      moves_right.push_back(*wrong == *right);
      limit.push_back(std::max(kUnchanged, std::min(kMostLeft, (alone ? kExactlyFree : kExactly) * *right)));
      least = std::min(least, *wrong);
      all = std::min(all, *right);
    }
    if (far.size() < found.size()) continue;
    const auto exact = [&](std::size_t k) { return far[k] <= limit[k]; };
    bool any = false;
    for (std::size_t k = 0; k < far.size(); ++k) any = any || exact(k);
    // A design that is not exactly the tested engine's leaves a distance, but a much smaller one than another
    // mistake.
    if (!any && !free && !(least <= kNearest * all)) continue;
    std::size_t k = 0;
    std::erase_if(found, [&](const Fit&) {
      const bool keep = exact(k) || (!any && (free ? moves_right[k] : far[k] <= kClearlyNearer * least));
      ++k;
      return !keep;
    });
  }
}

// Returns a distance of the tested engine's paths from those of a mistake above which `near` is certainly
// false. With r for the correct paths, w for the mistake's and e for the tested engine's, `near` requires |e
// - w| <= a |r - w| + b, and |r - w| <= |r - e| + |e - w|.
double Predictions::farthest(std::size_t check, std::size_t manner) {
  const auto [place, is_new] = farthest_.try_emplace({check, manner}, kInfinity);
  const auto& right = of({"", manner}, check);
  if (!is_new || !right) return place->second;
  const std::vector<Recorded>& seen = chapter_[check].runs;
  const std::size_t n = right->runs.size();
  const double most = kLoosePath * distance(seen, seen, right->runs, n) + kManners * spread(check);
  return farthest_[{check, manner}] = std::max(kUnchanged, most / (1 - kLoosePath));
}

double Predictions::exact_limit(std::size_t check, std::size_t manner) {
  const auto [place, is_new] = exact_limits_.try_emplace({check, manner}, kUnchanged);
  const auto& right = of({"", manner}, check);
  if (is_new && right) {
    const auto& seen = chapter_[check].runs;
    const bool free = std::all_of(seen.begin(), seen.end(), flies_freely);
    const double least = free ? kExactlyFree : kUnchanged;
    const double apart = distance(seen, seen, right->runs, right->runs.size());
    place->second = std::max(least, std::min(kMostLeft, (free ? kExactlyFree : kExactly) * apart));
  }
  return place->second;
}

bool Predictions::exactly(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong) {
  const auto& right = of({"", manner}, check);
  const auto& seen = chapter_[check].runs;
  return right && distance(seen, seen, wrong, right->runs.size()) <= exact_limit(check, manner);
}

void Predictions::refute(const Planted& planted, std::size_t check, Fit& fit) {
  for (std::size_t i = 0; i < chapter_.size(); ++i) {
    const Finding& seen = chapter_[i].finding;
    if (i == check || !chapter_[i].check->repeatable || seen.verdict == Verdict::NotYet ||
        seen.verdict == Verdict::Broken)
      continue;
    const auto& predicted = of(planted, i);
    if (seen.verdict == Verdict::Pass && predicted) {
      fit.refuted = fit.refuted || refutes(seen, predicted->finding);
      const auto& right = of({"", planted.manner}, i);
      fit.contradicted =
          fit.contradicted || (right && shows_no_mistake(chapter_[i].runs, right->runs, predicted->runs));
    }
    if (!predicted || predicted->finding.verdict != seen.verdict)
      ++fit.verdicts;
    else if (seen.verdict == Verdict::Fail && !same_readings(seen, predicted->finding))
      ++fit.readings;
    else if (seen.verdict == Verdict::Fail)
      fit.elsewhere = std::max(fit.elsewhere, off(i, planted.manner, predicted->runs));
    if (predicted) fit.signs += sees_another(i, predicted->finding);
  }
  fit.signs += sees_another(check, of(planted, check)->finding);
}

bool Predictions::contradicts(const Planted& planted, const Outcome& passed) {
  if (passed.finding.verdict != Verdict::Pass || !passed.check->repeatable) return false;
  const auto key = std::pair{planted.manner, passed.check->name};
  const auto [place, is_new] = right_earlier_.try_emplace(key);
  if (is_new) place->second = attempt({"", planted.manner}, *passed.check, {});
  if (!place->second) return false;
  const auto wrong = attempt(planted, *passed.check, {});
  return wrong && shows_no_mistake(passed.runs, place->second->runs, wrong->runs);
}

// Returns true if a check detects a mistake in the predicted motion, but not in the tested engine's.
bool Predictions::sees_another(std::size_t check, const Finding& predicted) const {
  return predicted.observed && predicted.mistake != seen_[check];
}

double Predictions::off(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong) {
  const auto& right = of({"", manner}, check);
  if (!right) return 0;
  const auto& seen = chapter_[check].runs;
  const std::size_t n = right->runs.size();
  const double way = distance(seen, right->runs, wrong, n);
  return way > 1e-9 ? distance(seen, seen, wrong, n) / way : 0;
}

bool Predictions::near(std::size_t check, std::size_t manner, const Attempt& wrong) {
  const auto& right = of({"", manner}, check);
  if (!right) return true;
  const std::size_t n = right->runs.size();
  const auto& seen = chapter_[check].runs;
  const double way = distance(seen, right->runs, wrong.runs, n), far = distance(seen, seen, wrong.runs, n);
  if (way <= 1e-9) return far <= std::max(kUnchanged, kManners * spread(check));
  if (far <= kSamePath * way) return true;
  return same_figures(chapter_[check].finding, wrong.finding) &&
         far <= std::max(kSamePath * way + kManners * spread(check), kLoosePath * way);
}

// Returns the largest distance between the paths of correct engines of different design.
double Predictions::spread(std::size_t check) {
  const auto [place, is_new] = spreads_.try_emplace(check, 0);
  if (!is_new) return place->second;
  double most = 0;
  for (std::size_t manner = 1; manner < manners_.size(); ++manner) {
    const auto &first = of({}, check), &other = of({"", manner}, check);
    if (first && other && other->finding.verdict == Verdict::Pass)
      most = std::max(most, distance(first->runs, first->runs, other->runs, first->runs.size()));
  }
  return spreads_[check] = most;
}

std::optional<double> Predictions::factor(const std::string& quantity, std::size_t manner,
                                          std::size_t check) {
  const auto& right = of({"", manner}, check);
  const std::size_t right_runs = right ? right->runs.size() : 0;
  const auto& seen = chapter_[check].runs;
  double least = kInfinity;
  // Returns infinity for distances above `limit`.
  const auto far = [&](double factor, double limit) {
    const auto run = within({fmt::format("{}*{:.17g}", quantity, factor), manner}, check, limit);
    const double way = run ? distance(seen, seen, run->runs, right_runs) : kInfinity;
    least = std::min(least, std::isfinite(way) ? way : kInfinity);
    return std::isfinite(way) ? way : kInfinity;
  };
  constexpr double kFactors[] = {-2,   -1, -0.5, 0,   0.05, 0.1, 0.2, 0.35, 0.5,
                                 0.75, 1,  1.25, 1.5, 2,    3,   5,   9,    15};
  const auto count = static_cast<std::ptrdiff_t>(std::size(kFactors));
  const double all = right ? distance(seen, seen, right->runs, right_runs) : 0;
  // A quantity that is not used here changes nothing, whatever its factor.
  if (far(kFactors[0], kInfinity) == all && far(kFactors[count - 1], kInfinity) == all) return std::nullopt;
  std::ptrdiff_t best = 0;
  for (std::ptrdiff_t i = 0; i < count; ++i)
    if (const double before = least; far(kFactors[i], before) < before) best = i;
  if (std::isinf(least)) return std::nullopt;
  double low = kFactors[std::max<std::ptrdiff_t>(best - 1, 0)],
         high = kFactors[std::min(best + 1, count - 1)];
  constexpr double kGolden = 0.6180339887498949;
  double lower = high - kGolden * (high - low), upper = low + kGolden * (high - low);
  double at_lower = far(lower, kInfinity), at_upper = far(upper, kInfinity);
  for (int i = 0; i < 24; ++i) {
    // A twentieth of the interval changes the path only a little: a path that is not near here cannot come
    // near within the rest of the interval.
    if (i == 7 && least > kHopeless * all) return std::nullopt;
    if (at_lower < at_upper) {
      high = std::exchange(upper, lower);
      at_upper = at_lower;
      at_lower = far(lower = high - kGolden * (high - low), at_upper);
    } else {
      low = std::exchange(lower, upper);
      at_lower = at_upper;
      at_upper = far(upper = low + kGolden * (high - low), at_lower);
    }
  }
  // Near the best factor the distance is that of a line, so two factors beside it give it to all digits. A
  // free flight needs them: there only rounding may differ.
  double factor = (low + high) / 2, width = high - low, nearest = far(factor, kInfinity);
  for (int i = 0; i < 3; ++i, width *= 1e-3) {
    const double below = far(factor - width, kInfinity), above = far(factor + width, kInfinity);
    if (!std::isfinite(below + above) || below + above == 0) break;
    const double between = factor + width * (below - above) / (below + above);
    const double distance = far(between, kInfinity);
    if (distance >= nearest) continue;
    nearest = distance;
    factor = between;
  }
  return factor;
}

}  // namespace plumb::course
