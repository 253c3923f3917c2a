#include "harness/course/prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "harness/course/flight.h"
#include "harness/course/likeness.h"
#include "harness/course/student/student.h"

namespace plumb::course {
namespace {

// Largest distance of two paths that count as the same, as a fraction of their distance from the right one. A
// contact that is found a step sooner or later shifts a path by about a hundredth of it.
constexpr double kSamePath = 0.1;

// A mistake that fits less well than another by this factor does not count beside it.
constexpr double kClearly = 5;

// Paths nearer than this fit equally well: with contacts, and in free flight, where only rounding differs.
constexpr double kEqual = 0.01, kRounding = 1e-6;

// The same for a mistake of any factor: its path is fitted, and must lie closer.
constexpr double kFittedPath = 0.02, kExactPath = 0.001;

// Right engines of different manners differ by this much in their paths, so that a wrong one may as well.
constexpr double kManners = 2, kLoosePath = 0.3;

struct Attempt {
  Finding finding;
  std::vector<Recorded> runs;
};

std::optional<Attempt> attempt(const Check& check, const reference::Backend& engine,
                               const reference::StepSettings& settings) {
  Attempt out;
  try {
    const Lab lab(engine, settings, &out.runs);
    out.finding = check.run(lab);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return out;
}

// A mistake as the learner's engine makes it, in one of the ways in which engines work.
struct Planted {
  std::string mistake;
  std::size_t manner = 0;

  auto operator<=>(const Planted&) const = default;
};

// Ways to work that the learner's engines of a chapter differ in. Where one mistake makes sweeps differ from
// each other, their number counts.
std::vector<Manner> manners_of(int chapter) {
  switch (chapter) {
    case 1:
      return {{}, {.once = true}, {.once = true, .after_move = true}};
    case 2:
      return {{}};
    case 3:
      return {{},
              {.once = true},
              {.once = true, .after_move = true},
              {.sweeps = 10},
              {.once = true, .share = 0.4},
              {.once = true, .share = 0.2}};
    case 4:
      return {{}, {.once = true}, {.sweeps = 10}, {.sweeps = 20}, {.sweeps = 5}, {.sweeps = 30}};
    default:
      return {{}, {.once = true}, {.by_positions = true}, {.sweeps = 10}, {.fed = 0.2}};
  }
}

struct Fit {
  std::string name, says;
  double off;  // distance of the paths over that from the right ones
  // Other checks of the chapter in which it predicts another verdict, and those in which other readings.
  int verdicts = 0, readings = 0;
  double elsewhere = 0;  ///< largest `off` of the other checks that fail
  bool exact = false;    ///< its figures are the engine's, and its paths as good as
  bool refuted = false;  ///< another check, which the engine passes, would clearly fail
  int signs = 0;         ///< checks that see a mistake in its motion, and not in that of the engine
};

// Runs the checks of a chapter on the learner's engine, each at most once for each mistake.
class Predictions {
 public:
  Predictions(const Lab& lab, const std::vector<Outcome>& chapter)
      : lab_(lab), chapter_(chapter), manners_(manners_of(chapter.front().chapter->number)) {
    for (const Outcome& outcome : chapter) seen_.push_back(outcome.finding.mistake);
  }

  const std::optional<Attempt>& of(const Planted& planted, std::size_t check) {
    const auto [place, is_new] = attempts_.try_emplace({planted, check});
    if (is_new)
      place->second = attempt(*chapter_[check].check,
                              *make_student(planted.mistake, lab_.scheme(), manners_[planted.manner]),
                              lab_.plain_settings());
    return place->second;
  }

  // Returns the share of an overlap that a step removes.
  double share(std::size_t manner) const { return manners_[manner].after_move ? 1 : manners_[manner].share; }

  std::size_t manners() const { return manners_.size(); }

  // Counts the other checks of which a mistake predicts another verdict, or other wrong readings.
  void refute(const Planted& planted, std::size_t check, Fit& fit) {
    for (std::size_t i = 0; i < chapter_.size(); ++i) {
      const Finding& seen = chapter_[i].finding;
      if (i == check || !chapter_[i].check->repeatable || seen.verdict == Verdict::NotYet ||
          seen.verdict == Verdict::Broken)
        continue;
      const auto& predicted = of(planted, i);
      if (seen.verdict == Verdict::Pass && predicted && refutes(seen, predicted->finding)) fit.refuted = true;
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

  // Returns true if a check sees a mistake in the motion that was predicted, and not in the engine's.
  bool sees_another(std::size_t check, const Finding& predicted) const {
    return predicted.observed && predicted.mistake != seen_[check];
  }

  // Returns the distance of the engine's paths from those of a mistake, over that of the right ones from
  // them. If only velocities are wrong it is 0: readings decide alone.
  double off(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong) {
    const auto& right = of({"", manner}, check);
    if (!right) return 0;
    const std::size_t n = right->runs.size();
    const double way = distance(right->runs, wrong, n);
    return way > 1e-9 ? distance(chapter_[check].runs, wrong, n) / way : 0;
  }

  // Returns true if the engine's paths are those of a mistake. If its figures are exactly those, paths may
  // differ by more: by what right engines differ in, and by how overlaps are corrected that only the mistake
  // causes.
  bool near(std::size_t check, std::size_t manner, const Attempt& wrong) {
    const auto& right = of({"", manner}, check);
    if (!right) return true;
    const std::size_t n = right->runs.size();
    const double way = distance(right->runs, wrong.runs, n),
                 far = distance(chapter_[check].runs, wrong.runs, n);
    if (way <= 1e-9 || far <= kSamePath * way) return true;
    return same_figures(chapter_[check].finding, wrong.finding) &&
           far <= std::max(kSamePath * way + kManners * spread(check), kLoosePath * way);
  }

  // Returns the largest distance of the paths of right engines that work differently.
  double spread(std::size_t check) {
    double most = 0;
    for (std::size_t manner = 1; manner < manners_.size(); ++manner) {
      const auto &first = of({}, check), &other = of({"", manner}, check);
      if (first && other && other->finding.verdict == Verdict::Pass)
        most = std::max(most, distance(first->runs, other->runs, first->runs.size()));
    }
    return most;
  }

  // Returns the factor with which the learner's engine comes nearest to the engine's paths.
  double factor(const std::string& quantity, std::size_t manner, std::size_t check) {
    const auto& right = of({"", manner}, check);
    const std::size_t right_runs = right ? right->runs.size() : 0;
    const auto far = [&](double factor) {
      const auto run =
          attempt(*chapter_[check].check,
                  *make_student(fmt::format("{}*{:.17g}", quantity, factor), lab_.scheme(), manners_[manner]),
                  lab_.plain_settings());
      const double way = run ? distance(chapter_[check].runs, run->runs, right_runs)
                             : std::numeric_limits<double>::infinity();
      return std::isfinite(way) ? way : std::numeric_limits<double>::infinity();
    };
    constexpr double kFactors[] = {-2,   -1, -0.5, 0,   0.05, 0.1, 0.2, 0.35, 0.5,
                                   0.75, 1,  1.25, 1.5, 2,    3,   5,   9,    15};
    std::size_t best = 0;
    std::vector<double> ways;
    for (const double each : kFactors) ways.push_back(far(each));
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i] < ways[best]) best = i;
    double low = kFactors[best == 0 ? 0 : best - 1], high = kFactors[std::min(best + 1, ways.size() - 1)];
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < 24; ++i) {
      const double lower = high - kGolden * (high - low), upper = low + kGolden * (high - low);
      if (far(lower) < far(upper))
        high = upper;
      else
        low = lower;
    }
    return (low + high) / 2;
  }

 private:
  const Lab& lab_;
  const std::vector<Outcome>& chapter_;
  std::vector<std::string> seen_;  ///< the mistakes that the checks themselves saw
  std::vector<Manner> manners_;
  std::map<std::pair<Planted, std::size_t>, std::optional<Attempt>> attempts_;
};

// Returns true if the learner's engine without a mistake fails in the same way: it is the declared method's
// own motion, and no mistake has to explain it.
bool is_the_methods_own(Predictions& predictions, const Outcome& outcome, std::size_t check) {
  const auto& right = predictions.of({}, check);
  return right && right->finding.verdict == Verdict::Fail && same_readings(outcome.finding, right->finding);
}

// Returns true if the mistake of a name would fail a check.
bool fails_as_well(const std::vector<Predictable>& mistakes, Predictions& predictions,
                   const std::string& name, std::size_t check) {
  return std::any_of(mistakes.begin(), mistakes.end(), [&](const Predictable& mistake) {
    if (name != mistake.name) return false;
    const auto& run = predictions.of({mistake.planted}, check);
    return run && run->finding.verdict == Verdict::Fail;
  });
}

bool better(const Fit& a, const Fit& b) {
  return std::tie(a.verdicts, a.readings, a.off) < std::tie(b.verdicts, b.readings, b.off);
}

// Returns true if a mistake's figures are those of the same engine without it: it then explains nothing.
bool changes_nothing(Predictions& predictions, std::size_t manner, std::size_t check, const Attempt& wrong) {
  const auto& right = predictions.of({"", manner}, check);
  if (!right || right->finding.readings.size() != wrong.finding.readings.size()) return false;
  for (std::size_t i = 0; i < wrong.finding.readings.size(); ++i)
    if (right->finding.readings[i].measured != wrong.finding.readings[i].measured) return false;
  return true;
}

// Returns the mistakes that fit, the best first, one for each name.
std::vector<Fit> fits(const std::vector<Predictable>& mistakes, Predictions& predictions,
                      const std::vector<Outcome>& chapter, std::size_t check, const std::string& named) {
  std::vector<Fit> out;
  const Outcome& outcome = chapter[check];
  if (!predictions.of({}, check)) return out;
  const char digit = static_cast<char>('0' + outcome.chapter->number);
  for (const Predictable& mistake : mistakes) {
    const bool belongs = std::string_view(mistake.chapters).find(digit) != std::string_view::npos;
    if (!belongs && named != mistake.name) continue;
    for (std::size_t manner = 0; manner < predictions.manners(); ++manner) {
      const Planted planted{mistake.planted, manner};
      const auto& wrong = predictions.of(planted, check);
      if (!wrong || wrong->finding.verdict != Verdict::Fail || !finite(wrong->finding)) continue;
      if (changes_nothing(predictions, manner, check, *wrong)) continue;
      if (!same_readings(outcome.finding, wrong->finding)) continue;
      if (static_moves(outcome.runs) != static_moves(wrong->runs)) continue;
      if (pushes_farther(outcome.runs, wrong->runs, predictions.share(manner))) continue;
      const double share = predictions.off(check, manner, wrong->runs);
      if (!std::isfinite(share) || !predictions.near(check, manner, *wrong)) continue;
      out.push_back({mistake.name, mistake.says, share});
      predictions.refute(planted, check, out.back());
      // A mistake that is made in some cases only may pass a check that it would fail in all.
      out.back().exact = share <= kEqual && same_figures(outcome.finding, wrong->finding);
      if (out.back().refuted && !out.back().exact) out.pop_back();
    }
  }
  std::stable_sort(out.begin(), out.end(), better);
  std::vector<Fit> names;
  for (const Fit& fit : out)
    if (std::none_of(names.begin(), names.end(), [&](const Fit& other) { return other.name == fit.name; }))
      names.push_back(fit);
  return names;
}

std::size_t wrong_readings(const std::vector<Outcome>& chapter) {
  std::size_t out = 0;
  for (const Outcome& outcome : chapter)
    if (outcome.finding.verdict == Verdict::Fail)
      out += std::count_if(outcome.finding.readings.begin(), outcome.finding.readings.end(),
                           [](const Reading& r) { return !r.good(); });
  return out;
}

// Returns the quantities that give the motion with some factor. The factor is fitted to one check; what the
// others show, or the whole path, must agree with it.
std::vector<Fit> fitted(Predictions& predictions, const std::vector<Outcome>& chapter, std::size_t check) {
  constexpr std::size_t kTried = 3;  // manners
  std::vector<Fit> out;
  const Outcome& outcome = chapter[check];
  const char digit = static_cast<char>('0' + outcome.chapter->number);
  const bool several = wrong_readings(chapter) > 1;
  for (const Scaled& scaled : scaled_quantities()) {
    if (std::string_view(scaled.chapters).find(digit) == std::string_view::npos) continue;
    for (std::size_t manner = 0; manner < std::min(kTried, predictions.manners()); ++manner) {
      const double factor = predictions.factor(scaled.quantity, manner, check);
      const Planted planted{fmt::format("{}*{:.17g}", scaled.quantity, factor), manner};
      const auto& wrong = predictions.of(planted, check);
      if (!wrong || wrong->finding.verdict != Verdict::Fail || !finite(wrong->finding)) continue;
      if (changes_nothing(predictions, manner, check, *wrong)) continue;
      if (!same_readings(outcome.finding, wrong->finding)) continue;
      const double share = predictions.off(check, manner, wrong->runs);
      if (!(share <= (several ? kFittedPath : kExactPath))) continue;
      Fit fit{scaled.name, fmt::format(fmt::runtime(scaled.says), fmt::format("{:.3g}", factor)), share};
      predictions.refute(planted, check, fit);
      if (!fit.refuted && fit.verdicts == 0 && fit.readings == 0) out.push_back(fit);
    }
  }
  std::stable_sort(out.begin(), out.end(), better);
  if (out.size() > 1) out.resize(1);
  return out;
}

// Drops the mistakes that fit clearly worse than the best, here or in the other checks.
void narrow(std::vector<Fit>& found, const Outcome& outcome) {
  if (!found.empty()) {
    const bool exact = std::all_of(outcome.runs.begin(), outcome.runs.end(), flies_freely);
    const Fit best = found.front();
    // Contacts found at other times than here shift a path; a best one that lies closer shows that none were.
    const double equal = exact ? kRounding : best.off < kExactPath ? kExactPath : kEqual;
    const double most = kClearly * std::max(best.off, equal);
    // The other checks refute a mistake unless its motion here fits clearly better than that of the best.
    const double least = best.off / kClearly;
    std::erase_if(found, [&](const Fit& fit) {
      const bool worse = fit.verdicts > best.verdicts || fit.readings > best.readings;
      return fit.off > most || (worse && (fit.off >= least || best.off <= equal));
    });
    // So do their motions there, if none is refuted by figures.
    double nearest = std::numeric_limits<double>::infinity();
    int signs = std::numeric_limits<int>::max();
    for (const Fit& fit : found)
      nearest = std::min(nearest, fit.elsewhere), signs = std::min(signs, fit.signs);
    std::erase_if(found, [&](const Fit& fit) {
      return fit.elsewhere > kClearly * std::max(nearest, kEqual) || fit.signs > signs;
    });
  }
}

// Keeps one of several mistakes: the one that an earlier check has named, or that alone fits another check.
void choose(std::vector<Fit>& found, const std::string& known, const std::set<std::string>& alone) {
  if (found.size() < 2) return;
  const auto keep = [&](const auto& is_it) {
    const auto n = std::count_if(found.begin(), found.end(), is_it);
    if (n == 1) std::erase_if(found, [&](const Fit& fit) { return !is_it(fit); });
    return n == 1;
  };
  if (keep([&](const Fit& fit) { return known == fit.name; })) return;
  keep([&](const Fit& fit) { return alone.contains(fit.name); });
}

void unname(Finding& finding) {
  finding.mistake.clear();
  finding.says = describe(finding);
}

void name_check(const std::vector<Predictable>& mistakes, const std::vector<Fit>& found, Finding& finding) {
  const auto computed = [&](const std::string& name) {
    return std::any_of(mistakes.begin(), mistakes.end(),
                       [&](const Predictable& mistake) { return name == mistake.name; });
  };
  // Lets what was seen besides decide among several. If its own motion cannot be computed, only a close fit
  // is better evidence.
  const bool among =
      std::any_of(found.begin(), found.end(), [&](const Fit& fit) { return finding.mistake == fit.name; });
  const bool close = found.size() == 1 && found.front().off <= kEqual;
  if (finding.observed && !finding.mistake.empty() && (among || (!computed(finding.mistake) && !close)))
    return;
  if (found.size() == 1) {
    if (finding.mistake != found.front().name) finding.says = found.front().says;
    finding.mistake = found.front().name;
    return;
  }
  if (found.size() > 1) {
    finding.mistake.clear();
    finding.says = "Several mistakes give this motion, and the checks do not tell them apart.";
    for (const Fit& fit : found) finding.says += fmt::format(" {}: {}", fit.name, fit.says);
    return;
  }
  // Names nothing that was only suspected, and gives another motion.
  if (finding.proven || finding.mistake.empty() || (!computed(finding.mistake) && !finding.observed)) return;
  unname(finding);
}

}  // namespace

void name_by_motion(const Lab& lab, std::vector<Outcome>& chapter, const std::string& named) {
  using reference::Scheme;
  const Scheme scheme = lab.scheme();
  if (scheme != Scheme::SemiImplicitEuler && scheme != Scheme::ExplicitEuler &&
      scheme != Scheme::VelocityVerlet)
    return;
  const std::vector<Predictable> mistakes = predictable_mistakes();
  Predictions predictions(lab, chapter);
  std::vector<std::vector<Fit>> found(chapter.size());
  std::set<std::string> alone;
  for (std::size_t i = 0; i < chapter.size(); ++i) {
    const Finding& finding = chapter[i].finding;
    if (finding.verdict != Verdict::Fail || !chapter[i].check->repeatable || finding.mistake == kRunsDiffer)
      continue;
    found[i] = fits(mistakes, predictions, chapter, i, named);
    narrow(found[i], chapter[i]);
    if (found[i].empty() && !finding.proven) found[i] = fitted(predictions, chapter, i);
    if (found[i].size() == 1) alone.insert(found[i].front().name);
  }
  std::string known = named;
  for (std::size_t i = 0; i < chapter.size(); ++i) {
    Finding& finding = chapter[i].finding;
    if (finding.verdict != Verdict::Fail || finding.mistake == kRunsDiffer) continue;
    if (chapter[i].check->repeatable && !is_the_methods_own(predictions, chapter[i], i)) {
      choose(found[i], known, alone);
      name_check(mistakes, found[i], finding);
    }
    // A suspicion that no motion confirms is dropped, where motions cannot be compared as well.
    if (!chapter[i].check->repeatable && finding.observed && !finding.proven && finding.mistake != known)
      unname(finding);
    // Blames no second mistake for what the first one does as well.
    if (found[i].empty() && !finding.proven && !known.empty() && finding.mistake != known &&
        fails_as_well(mistakes, predictions, known, i)) {
      finding.mistake.clear();
      finding.says = fmt::format("{}, which is named above, spoils this as well.", known);
    }
    finding.exact = std::any_of(found[i].begin(), found[i].end(),
                                [&](const Fit& fit) { return fit.exact && finding.mistake == fit.name; });
    finding.computed = std::any_of(found[i].begin(), found[i].end(),
                                   [&](const Fit& fit) { return finding.mistake == fit.name; });
    if (known.empty() && finding.computed) known = finding.mistake;
  }
  // Gives the only mistake that the motions show to the checks that it fails and that have no name.
  if (alone.size() != 1 || !alone.contains(known)) return;
  for (std::size_t i = 0; i < chapter.size() && chapter[i].finding.mistake != known; ++i) {
    Finding& finding = chapter[i].finding;
    if (finding.verdict != Verdict::Fail || !finding.mistake.empty() || !found[i].empty()) continue;
    if (!fails_as_well(mistakes, predictions, known, i)) continue;
    finding.mistake = known;
    finding.says = std::find_if(mistakes.begin(), mistakes.end(), [&](const Predictable& mistake) {
                     return known == mistake.name;
                   })->says;
  }
}

}  // namespace plumb::course
