#include "harness/course/hindsight.h"

#include <algorithm>
#include <exception>

#include <fmt/format.h>

#include "harness/course/design.h"
#include "harness/course/likeness.h"
#include "harness/course/prediction.h"

namespace plumb::course {
namespace {

enum class Explains { Nothing, Failure, Readings };

// Returns how much of a failed check a mistake explains, in the best of the ways in which it can be made.
Explains explains(const Lab& lab, const Outcome& outcome, const std::string& name) {
  Explains out = Explains::Nothing;
  const std::vector<Manner> manners = manners_of(outcome.chapter->number, lab);
  for (const Predictable& mistake : predictable_mistakes()) {
    if (mistake.name != name || mistake.generated) continue;
    for (const Manner& manner : manners) {
      try {
        const auto student = make_student(mistake.planted, lab.scheme(), manner);
        const Finding predicted = outcome.check->run(Lab(*student, lab.plain_settings()));
        if (predicted.verdict != Verdict::Fail) continue;
        if (same_readings(outcome.finding, predicted)) return Explains::Readings;
        out = Explains::Failure;
      } catch (const std::exception&) {
        continue;
      }
    }
  }
  return out;
}

}  // namespace

void name_in_hindsight(const Lab& lab, std::vector<Outcome>& outcomes, std::size_t told) {
  const auto unnamed = [](const Outcome& outcome) {
    return outcome.finding.verdict == Verdict::Fail && outcome.finding.mistake.empty();
  };
  const auto fails = [](const Outcome& outcome) {
    return outcome.finding.verdict == Verdict::Fail || outcome.finding.verdict == Verdict::Broken;
  };
  const auto first =
      std::find_if(outcomes.begin() + static_cast<std::ptrdiff_t>(told), outcomes.end(), fails);
  if (first == outcomes.end() || !unnamed(*first)) return;
  const auto later = std::find_if(first, outcomes.end(), [](const Outcome& outcome) {
    return outcome.finding.computed && !outcome.finding.mistake.empty();
  });
  if (later == outcomes.end()) return;
  const Finding& named = later->finding;
  for (auto outcome = first; outcome != later; ++outcome) {
    if (!unnamed(*outcome) || !outcome->check->repeatable) continue;
    const Explains how = explains(lab, *outcome, named.mistake);
    if (how == Explains::Nothing) continue;
    if (how == Explains::Readings) {
      outcome->finding.mistake = named.mistake;
      outcome->finding.says = named.says;
      outcome->finding.computed = true;
    } else {
      outcome->finding.says += fmt::format(" {} below names a mistake that spoils this as well. {}: {}",
                                           later->check->name, named.mistake, named.says);
    }
  }
}

}  // namespace plumb::course
