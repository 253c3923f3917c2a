#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/course/likeness.h"
#include "harness/course/predictions.h"

// Finds the property of an engine's design that spoils a check, such as too large a share of an overlap.
namespace plumb::course {
namespace {

// The largest fraction of an overlap that a step should remove, as the course advises.
constexpr double kAdvisedShare = 0.5;

}  // namespace

bool Predictions::fails_without_mistake(std::size_t check, std::size_t manner) {
  const auto& right = of({"", manner}, check);
  return right && right->finding.verdict == Verdict::Fail &&
         same_readings(chapter_[check].finding, right->finding);
}

// Looks for the property in one design.
std::optional<Fit> Predictions::cause_in(const Manner& own, std::size_t check) {
  const auto passes_with = [&](const Manner& other) {
    const auto run = attempt("", other, *chapter_[check].check, {});
    return run && run->finding.verdict == Verdict::Pass;
  };
  const auto cause = [](const char* name, std::string says) {
    return Fit{.name = name, .says = std::move(says), .planted = {}, .exact = true};
  };
  Manner gentle = own, patient = own;
  gentle.share = std::min(own.share, kAdvisedShare);
  patient.sweeps = std::max(own.sweeps, Manner{}.sweeps);
  patient.once = false;
  if (gentle.share < own.share && !own.after_move && passes_with(gentle))
    return cause(
        "pushed_too_far",
        fmt::format("A step removes {:.3g} of an overlap, so that what should rest loses its contact "
                    "and bounces or trembles: remove 0.3 to 0.5 of it, and leave the last half "
                    "millimetre.",
                    own.share));
  if ((own.once || own.sweeps < patient.sweeps) && passes_with(patient))
    return cause(
        "one_sweep",
        fmt::format("Contacts are answered {} a step, and what one changes spoils another: go over all of "
                    "them 10 to 30 times.",
                    own.once || own.sweeps == 1 ? "once" : fmt::format("{} times", own.sweeps)));
  return std::nullopt;
}

std::optional<Fit> Predictions::cause_in_design(std::size_t check) {
  const std::vector<std::size_t> designs = known_ ? likely_ : std::vector<std::size_t>{0};
  for (const std::size_t manner : designs)
    if (fails_without_mistake(check, manner))
      if (auto cause = cause_in(manners_[manner], check)) return cause;
  return std::nullopt;
}

}  // namespace plumb::course
