#include "harness/course/prediction.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "harness/course/factors.h"
#include "harness/course/flight.h"
#include "harness/course/likeness.h"
#include "harness/course/predictions.h"

namespace plumb::course {
namespace {

// A mistake is dropped if another one fits better by this factor.
constexpr double kClearly = 5;

// Paths nearer than this fit equally well: kEqual with contacts, kRounding in free flight, where only
// rounding differs.
constexpr double kEqual = 0.01, kRounding = 1e-6;

// Steps of the learner's engine that the searches of a chapter may take: half a minute at most. In a check of
// a box with 40 iterations a step takes 5 to 12 microseconds. With fewer steps, mistakes of engines of
// unknown design are not found, because each mistake is tried in ten designs. With more, a learner waits.
constexpr long kSteps = 2'500'000;

// Number of checks of a chapter for which edits and factors are tried if nothing else explains the check.
// They take most of the time.
constexpr std::size_t kSearches = 2;

// For a mistake with a fitted factor, the path must be nearer than this: kExactPath if the design is known or
// only one reading is wrong, otherwise kFittedPath.
constexpr double kFittedPath = 0.02, kExactPath = 0.001;

// The mistakes that fit a check, and how many were not tried.
struct Search {
  std::vector<Fit> fits;
  std::size_t untried = 0;
};

// Returns the variants of a named mistake that can affect a check: those that fitted an earlier check, and
// all known ones.
std::vector<Planted> ways_to_make(const std::vector<Predictable>& mistakes, const std::string& name,
                                  const std::vector<Search>& found) {
  std::vector<Planted> out;
  for (const Search& search : found)
    for (const Fit& fit : search.fits)
      if (fit.name == name) out.push_back(fit.planted);
  for (const Predictable& mistake : mistakes)
    if (mistake.name == name) out.push_back({mistake.planted});
  return out;
}

// Returns true if one of the mistakes would fail a check. If `proven` is not empty, the check's own
// experiments must also name that mistake.
bool fails_as_well(const std::vector<Planted>& mistakes, Predictions& predictions, std::size_t check,
                   const std::string& proven = "") {
  return std::any_of(mistakes.begin(), mistakes.end(), [&](const Planted& planted) {
    const auto& run = predictions.of(planted, check);
    return run && run->finding.verdict == Verdict::Fail && (proven.empty() || run->finding.mistake == proven);
  });
}

bool better(const Fit& a, const Fit& b) {
  return std::tie(a.contradicted, a.verdicts, a.readings, a.off) <
         std::tie(b.contradicted, b.verdicts, b.readings, b.off);
}

// Returns true if a mistake gives the same figures as the engine without it: it then explains nothing.
bool changes_nothing(Predictions& predictions, std::size_t manner, std::size_t check, const Attempt& wrong) {
  const auto& right = predictions.of({"", manner}, check);
  if (!right || right->finding.readings.size() != wrong.finding.readings.size()) return false;
  for (std::size_t i = 0; i < wrong.finding.readings.size(); ++i)
    if (right->finding.readings[i].measured != wrong.finding.readings[i].measured) return false;
  return true;
}

// Keeps the best mistake of each name. If several mistakes of a generated family fit equally well, describes
// them all.
std::vector<Fit> one_for_each_name(const std::vector<Fit>& sorted) {
  std::vector<Fit> out;
  for (const Fit& fit : sorted) {
    const auto best =
        std::find_if(out.begin(), out.end(), [&](const Fit& other) { return other.name == fit.name; });
    if (best == out.end()) {
      out.push_back(fit);
      continue;
    }
    const bool alike = fit.verdicts == best->verdicts && fit.readings == best->readings &&
                       fit.off <= kClearly * std::max(best->off, kEqual);
    if (fit.generated && alike && best->says.find(fit.says) == std::string::npos)
      best->says += fmt::format(" Or: {}", fit.says);
  }
  return out;
}

// Returns true if anything moves: bodies held in place do not show the cause.
bool moves(const std::vector<Recorded>& runs) {
  return std::any_of(runs.begin(), runs.end(), [](const Recorded& run) {
    for (std::size_t b = 0; b < run.scene.bodies.size(); ++b)
      if (!run.trace.still(b)) return true;
    return false;
  });
}

// Adds each variant of a mistake that fits. With `exactly`, only variants that give the tested engine's exact
// paths.
void add_fits(const Predictable& mistake, Predictions& predictions, const Outcome& outcome, std::size_t check,
              bool exactly, std::vector<Fit>& out) {
  for (const std::size_t manner : predictions.likely()) {
    const Planted planted{mistake.planted, manner};
    const auto& wrong = predictions.nearby(planted, check, exactly);
    if (exactly && wrong && !predictions.exactly(check, manner, wrong->runs)) continue;
    if (!wrong || wrong->finding.verdict != Verdict::Fail) continue;
    if (changes_nothing(predictions, manner, check, *wrong)) continue;
    // A motion that diverges has no figures.
    if (!outcome.finding.diverged &&
        (!finite(wrong->finding) || !same_readings(outcome.finding, wrong->finding)))
      continue;
    if (static_moves(outcome.runs) != static_moves(wrong->runs)) continue;
    if (pushes_farther(outcome.runs, wrong->runs, predictions.share(manner))) continue;
    const double share = predictions.off(check, manner, wrong->runs);
    if (!std::isfinite(share) || !predictions.near(check, manner, *wrong)) continue;
    out.push_back({.name = mistake.name, .says = mistake.says, .planted = planted, .off = share});
    out.back().generated = mistake.generated;
    predictions.refute(planted, check, out.back());
    out.back().exact = share <= kEqual && moves(wrong->runs) && same_figures(outcome.finding, wrong->finding);
    // A mistake that is made only in some cases is still named if its motion is exactly the tested engine's.
    if (out.back().refuted && !out.back().exact) out.pop_back();
  }
}

// Returns true if a mistake predicts every verdict and every wrong reading of the chapter.
bool explains_all(const Fit& fit) { return fit.verdicts == 0 && fit.readings == 0 && !fit.contradicted; }

// Returns true if a mistake fits that no other check contradicts.
bool any_unrefuted(const std::vector<Fit>& fits) {
  return std::any_of(fits.begin(), fits.end(), [](const Fit& fit) { return !fit.contradicted; });
}

// Returns true if a mistake has a different name in the chapter of `digit`, which applies there.
bool renamed(const std::vector<Predictable>& mistakes, const Predictable& mistake, char digit) {
  if (mistake.generated || mistake.chapters.find(digit) != std::string::npos) return false;
  return std::any_of(mistakes.begin(), mistakes.end(), [&](const Predictable& other) {
    return other.planted == mistake.planted && other.chapters.find(digit) != std::string::npos;
  });
}

// Searches for the mistakes that fit, the best first, until the learner's engine has taken `until` steps in
// all. First come mistakes that explain the whole chapter according to another check (`likely`). Other
// mistakes are returned only if none of these fits, and generated families only if no other mistake explains
// everything, or with `all`. Mistakes that give the tested engine's exact paths precede those that come near
// them; the latter count only for engines of an unknown design.
Search search(const std::vector<Predictable>& mistakes, Predictions& predictions,
              const std::vector<Outcome>& chapter, std::size_t check, const std::string& named,
              const std::vector<Fit>& likely, long until, bool all = false) {
  Search found;
  std::vector<Fit>& out = found.fits;
  const Outcome& outcome = chapter[check];
  if (!predictions.of({}, check)) return found;
  const char digit = static_cast<char>('0' + outcome.chapter->number);
  // Bodies without contacts or joints move in the same way in every design.
  const bool free = std::all_of(outcome.runs.begin(), outcome.runs.end(), flies_freely);
  for (const bool exactly : {true, false}) {
    if (any_unrefuted(out) || (!exactly && free)) break;
    for (const Fit& fit : likely)
      add_fits({fit.planted.mistake, fit.name, "", fit.says, fit.generated, false}, predictions, outcome,
               check, exactly, out);
    for (const bool generated : {false, true}) {
      if (!all && any_unrefuted(out) && !likely.empty()) break;
      if (!all && generated && std::any_of(out.begin(), out.end(), explains_all)) break;
      for (const Predictable& mistake : mistakes) {
        if (mistake.generated != generated || (mistake.exactly && !exactly)) continue;
        // Includes mistakes of earlier chapters, because an engine with such a mistake may have passed those
        // checks.
        const bool belongs =
            exactly ? mistake.chapters.front() <= digit : mistake.chapters.find(digit) != std::string::npos;
        if (!belongs && named != mistake.name) continue;
        if (renamed(mistakes, mistake, digit)) continue;
        if (predictions.steps() < until)
          add_fits(mistake, predictions, outcome, check, exactly, out);
        else
          ++found.untried;
      }
    }
  }
  // An engine that does all chapters may make the mistake of a later one, such as friction where there is
  // none.
  if (!any_unrefuted(out))
    for (const Predictable& mistake : mistakes)
      if (!mistake.generated && mistake.chapters.front() > digit && predictions.steps() < until)
        add_fits(mistake, predictions, outcome, check, true, out);
  if (any_unrefuted(out)) std::erase_if(out, [](const Fit& fit) { return fit.contradicted; });
  // If the design is known, mistakes that only come near and contradict other checks are wrong.
  if (predictions.design_known())
    std::erase_if(out, [](const Fit& fit) { return !fit.exact && !explains_all(fit); });
  std::stable_sort(out.begin(), out.end(), better);
  return found;
}

std::size_t wrong_readings(const std::vector<Outcome>& chapter) {
  std::size_t out = 0;
  for (const Outcome& outcome : chapter)
    if (outcome.finding.verdict == Verdict::Fail)
      out += std::count_if(outcome.finding.readings.begin(), outcome.finding.readings.end(),
                           [](const Reading& r) { return !r.good(); });
  return out;
}

// Adds a quantity that is wrong by a factor; returns false if it does not fit. `several` is true if a chapter
// has more than one wrong reading.
bool add_factor(Predictions& predictions, const Outcome& outcome, std::size_t check, const Scaled& scaled,
                double factor, std::size_t manner, bool several, std::vector<Fit>& out) {
  const Planted planted{fmt::format("{}*{:.17g}", scaled.quantity, factor), manner};
  const auto& wrong = predictions.of(planted, check);
  if (!wrong || wrong->finding.verdict != Verdict::Fail || !finite(wrong->finding)) return false;
  if (changes_nothing(predictions, manner, check, *wrong)) return false;
  if (!same_readings(outcome.finding, wrong->finding)) return false;
  const double share = predictions.off(check, manner, wrong->runs);
  if (!(share <= (several && !predictions.design_known() ? kFittedPath : kExactPath))) return false;
  if (predictions.design_known() && !predictions.exactly(check, manner, wrong->runs)) return false;
  Fit fit{.name = scaled.name,
          .says = fmt::format(fmt::runtime(scaled.says), factor_text(factor, predictions.dt())),
          .planted = planted,
          .off = share};
  predictions.refute(planted, check, fit);
  if (fit.refuted || !explains_all(fit)) return false;
  out.push_back(std::move(fit));
  return true;
}

// Adds the quantity whose factor can best be fitted to the motion. The factor is fitted to one check; the
// other checks, or the whole path, must agree with it.
void add_fitted(Predictions& predictions, const std::vector<Outcome>& chapter, std::size_t check, long until,
                Search& found) {
  const std::vector<std::size_t>& likely = predictions.likely();
  const std::size_t tried = std::min<std::size_t>(predictions.design_known() ? 1 : 3, likely.size());
  std::vector<Fit>& out = found.fits;
  const Outcome& outcome = chapter[check];
  const char digit = static_cast<char>('0' + outcome.chapter->number);
  const bool several = wrong_readings(chapter) > 1;
  for (const Scaled& scaled : scaled_quantities()) {
    if (std::string_view(scaled.chapters).find(digit) == std::string_view::npos) continue;
    if (predictions.steps() >= until) {
      ++found.untried;
      continue;
    }
    for (const std::size_t manner : std::span(likely).first(tried)) {
      const auto fitted = predictions.factor(scaled.quantity, manner, check);
      if (!fitted) continue;
      const double plain = plain_factor(*fitted, predictions.dt());
      if (!add_factor(predictions, outcome, check, scaled, plain, manner, several, out) && plain != *fitted)
        add_factor(predictions, outcome, check, scaled, *fitted, manner, several, out);
    }
  }
  std::stable_sort(out.begin(), out.end(), better);
  if (out.size() > 1) out.resize(1);
}

// Drops the mistakes that fit clearly worse than the best one, here or in the other checks.
void narrow(std::vector<Fit>& found, const Outcome& outcome) {
  if (!found.empty()) {
    const bool exact = std::all_of(outcome.runs.begin(), outcome.runs.end(), flies_freely);
    const Fit best = found.front();
    // Contacts that are found at other times than here shift a path. If the best path is nearer than such a
    // shift, there was no shift.
    const double equal = exact ? kRounding : best.off < kExactPath ? kExactPath : kEqual;
    const double most = kClearly * std::max(best.off, equal);
    // The other checks refute a mistake, with two exceptions: its motion in this check fits clearly better
    // than that of the best mistake, or the best mistake does not explain the other checks either.
    const double least = best.off / kClearly;
    std::erase_if(found, [&](const Fit& fit) {
      const bool worse = explains_all(best) && !explains_all(fit);
      return fit.off > most || (worse && (fit.off >= least || best.off <= equal));
    });
    // If the figures refute none, the motions in the other checks decide.
    double nearest = std::numeric_limits<double>::infinity();
    int signs = std::numeric_limits<int>::max();
    for (const Fit& fit : found)
      nearest = std::min(nearest, fit.elsewhere), signs = std::min(signs, fit.signs);
    std::erase_if(found, [&](const Fit& fit) {
      return fit.elsewhere > kClearly * std::max(nearest, kEqual) || fit.signs > signs;
    });
  }
}

// Keeps one of several mistakes: the one that an earlier check has named, or the only one that fits another
// check.
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

// Returns the description of a mistake from the first check that it fits.
std::string says_of(const std::vector<Search>& found, const std::string& name) {
  for (const Search& search : found)
    for (const Fit& fit : search.fits)
      if (fit.name == name) return fit.says;
  return name;
}

// Returns true for a check that fails, or breaks because its motion diverges.
bool fails(const Finding& finding) { return finding.verdict == Verdict::Fail || finding.diverged; }

void unname(Finding& finding) {
  finding.mistake.clear();
  finding.says = describe(finding);
}

// Says how many mistakes a search has left out.
std::string untried_text(std::size_t untried) {
  return fmt::format(" {} of the known mistakes were not tried here: a search takes half a minute at most.",
                     untried);
}

void name_check(const std::vector<Predictable>& mistakes, const Search& search, Finding& finding) {
  const std::vector<Fit>& found = search.fits;
  const auto computed = [&](const std::string& name) {
    return std::any_of(mistakes.begin(), mistakes.end(),
                       [&](const Predictable& mistake) { return name == mistake.name; });
  };
  // Lets symptoms decide among several mistakes. If the motion of a symptom's mistake cannot be computed,
  // only a close fit is better evidence.
  const bool among =
      std::any_of(found.begin(), found.end(), [&](const Fit& fit) { return finding.mistake == fit.name; });
  const bool close = found.size() == 1 && found.front().off <= kEqual;
  if (finding.observed && !finding.mistake.empty() && (among || (!computed(finding.mistake) && !close)))
    return;
  // A mistake of a generated family is no better evidence than an experiment.
  if (finding.proven && std::all_of(found.begin(), found.end(), [](const Fit& fit) { return fit.generated; }))
    return;
  // A mistake that was not tried may fit as well.
  if (!found.empty() && search.untried > 0) {
    finding.mistake.clear();
    finding.says = "Of the mistakes that were tried, this gives the motion.";
    for (const Fit& fit : found) finding.says += fmt::format(" {}: {}", fit.name, fit.says);
    finding.says += untried_text(search.untried);
    return;
  }
  if (found.size() == 1 && found.front().contradicted) {
    // Keeps what the check itself has recognised by its readings: other checks refute only what was found.
    if (finding.proven || (!finding.mistake.empty() && finding.mistake != found.front().name)) return;
    finding.mistake.clear();
    finding.says = fmt::format("{} It is close to this, but other checks, which pass, would differ. {}: {}",
                               describe(finding), found.front().name, found.front().says);
    return;
  }
  if (found.size() == 1) {
    if (finding.mistake != found.front().name) finding.says = found.front().says;
    finding.mistake = found.front().name;
    return;
  }
  if (found.size() > 1) {
    finding.mistake.clear();
    finding.says = std::any_of(found.begin(), found.end(), explains_all)
                       ? "Several mistakes give this motion, and the checks do not tell them apart."
                       : "Several mistakes give this motion, but none gives those of all other checks.";
    for (const Fit& fit : found) finding.says += fmt::format(" {}: {}", fit.name, fit.says);
    return;
  }
  // Drops the name of a mistake that was only suspected and whose motion differs. Also drops the name of one
  // whose motion cannot be computed and whose figures are only near.
  if (finding.proven || finding.mistake.empty()) return;
  const bool known = computed(finding.mistake);
  if (!known && !finding.observed && finding.certain) return;
  const std::string suspected = finding.says;
  unname(finding);
  if (!known) finding.says += " It is compatible with this: " + suspected;
}

}  // namespace

void name_by_motion(const Lab& lab, std::vector<Outcome>& chapter, const std::vector<Outcome>& before,
                    const std::string& named) {
  using reference::Scheme;
  const Scheme scheme = lab.scheme();
  if (scheme != Scheme::SemiImplicitEuler && scheme != Scheme::ExplicitEuler &&
      scheme != Scheme::VelocityVerlet)
    return;
  if (std::none_of(chapter.begin(), chapter.end(),
                   [](const Outcome& outcome) { return fails(outcome.finding); }))
    return;
  const std::vector<Predictable> mistakes = predictable_mistakes();
  std::vector<Predictable> listed = mistakes;
  std::erase_if(listed, [](const Predictable& mistake) { return mistake.exactly; });
  std::size_t in_vain = 0;  // checks that no mistake explains
  Predictions predictions(lab, chapter);
  std::vector<Search> found(chapter.size());
  std::set<std::string> alone;
  std::vector<Fit> likely;
  for (std::size_t i = 0; i < chapter.size(); ++i) {
    const Finding& finding = chapter[i].finding;
    if (!fails(finding) || !chapter[i].check->repeatable || finding.mistake == kRunsDiffer) continue;
    // Leaves half of the remaining steps to later checks, which may be more informative.
    const long until = predictions.steps() + (kSteps - predictions.steps()) / 2;
    const bool all = in_vain < kSearches;
    std::vector<Fit>& fits = found[i].fits;
    const auto look = [&](bool at_families) {
      found[i] = search(all ? mistakes : listed, predictions, chapter, i, named, likely, until, at_families);
      const bool any = !fits.empty();
      narrow(fits, chapter[i]);
      predictions.tell_apart(fits);
      return any;
    };
    // If the experiments show another motion than each mistake that explains the checks, a mistake of a
    // family, such as one in a single component, may explain both.
    if (look(false) && fits.empty()) look(true);
    fits = one_for_each_name(fits);
    if (finding.diverged) std::erase_if(fits, [](const Fit& fit) { return !fit.exact; });
    // The checks of earlier chapters contradict a mistake as well.
    constexpr std::size_t kFew = 4;
    if (fits.size() <= kFew)
      for (Fit& fit : fits)
        fit.contradicted =
            fit.contradicted || std::any_of(before.begin(), before.end(), [&](const Outcome& passed) {
              return predictions.contradicts(fit.planted, passed);
            });
    if (any_unrefuted(fits)) std::erase_if(fits, [](const Fit& fit) { return fit.contradicted; });
    if (fits.empty() && !finding.proven && !finding.diverged && all)
      add_fitted(predictions, chapter, i, until, found[i]);
    if (fits.empty() && !all) found[i].untried += mistakes.size() - listed.size();
    in_vain += fits.empty();
    if (fits.size() == 1 && found[i].untried == 0 && any_unrefuted(fits)) alone.insert(fits.front().name);
    if (likely.empty()) std::copy_if(fits.begin(), fits.end(), std::back_inserter(likely), explains_all);
  }
  std::string known = named;
  for (std::size_t i = 0; i < chapter.size(); ++i) {
    Finding& finding = chapter[i].finding;
    if (!fails(finding) || finding.mistake == kRunsDiffer) continue;
    if (finding.diverged && found[i].fits.empty()) continue;
    const bool comparable = chapter[i].check->repeatable;
    const auto cause = comparable ? predictions.cause_in_design(i) : std::nullopt;
    if (cause) found[i].fits = {*cause};
    if (cause || (comparable && !predictions.fails_without_mistake(i, 0))) {
      const std::string ended =
          finding.diverged ? finding.says + (finding.says.ends_with('.') ? " " : ". ") : "";
      choose(found[i].fits, known, alone);
      name_check(mistakes, found[i], finding);
      finding.says.insert(0, ended);
    }
    // Drops a suspicion that no motion confirms, including checks whose motions cannot be compared.
    if (!chapter[i].check->repeatable && finding.observed && !finding.proven && finding.mistake != known)
      unname(finding);
    // Names no second mistake for a failure that the first mistake explains equally well, nor one that
    // contradicts the figures of other checks: it gives this motion by chance.
    if (std::none_of(found[i].fits.begin(), found[i].fits.end(), explains_all) && !known.empty() &&
        finding.mistake != known &&
        fails_as_well(ways_to_make(mistakes, known, found), predictions, i,
                      finding.proven ? finding.mistake : "")) {
      finding.mistake.clear();
      finding.says = fmt::format("{}, which is named above, spoils this as well.", known);
    }
    const std::vector<Fit>& fits = found[i].fits;
    finding.exact = std::any_of(fits.begin(), fits.end(),
                                [&](const Fit& fit) { return fit.exact && finding.mistake == fit.name; });
    finding.computed =
        std::any_of(fits.begin(), fits.end(), [&](const Fit& fit) { return finding.mistake == fit.name; });
    if (finding.mistake.empty() && fits.empty() && known.empty() && found[i].untried > 0)
      finding.says += untried_text(found[i].untried);
    // If motions cannot be compared, the figures of the check choose among mistakes that give one motion.
    if (!chapter[i].check->repeatable && std::any_of(likely.begin(), likely.end(), [&](const Fit& fit) {
          return finding.mistake == fit.name;
        }))
      finding.exact = finding.computed = true;
    if (known.empty() && finding.computed) known = finding.mistake;
  }
  // If the motions show a single mistake, assigns it to the failed checks without a name.
  if (alone.size() != 1 || !alone.contains(known)) return;
  for (std::size_t i = 0; i < chapter.size() && chapter[i].finding.mistake != known; ++i) {
    Finding& finding = chapter[i].finding;
    if (finding.verdict != Verdict::Fail || !finding.mistake.empty() || !found[i].fits.empty()) continue;
    if (!fails_as_well(ways_to_make(mistakes, known, found), predictions, i)) continue;
    finding.mistake = known;
    finding.says = says_of(found, known);
  }
}

}  // namespace plumb::course
