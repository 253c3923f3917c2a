#include "harness/course/course.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/course/flight.h"
#include "harness/course/hindsight.h"
#include "harness/course/prediction.h"
#include "reference/process_backend.h"

namespace plumb::course {
namespace {

using reference::ProcessError;

bool is(const Error& error, ProcessError::Fault fault) {
  const auto* process = dynamic_cast<const ProcessError*>(&error);
  return process != nullptr && process->fault() == fault;
}

constexpr const char* kGrowsForEver =
    ". Numbers that grow without end come from impulses or forces of the wrong sign or too large: from a "
    "term "
    "that is missing in an effective mass, as (r x n)^2/I, from a missing dt, or from a force that grows "
    "faster "
    "than the steps follow.";

constexpr const char* kSlowEngine =
    ". A slow engine may take longer: --timeout sets the limit of a line, in s.";

constexpr const char* kWrongStep =
    "The steps do not have the length that was asked for: each is \"dt\" of the settings, in seconds, and is "
    "not "
    "measured with a clock; a sample comes after \"every\" steps.";

Finding not_yet(const Check& check, const std::string& reason) {
  Finding out;
  out.verdict = Verdict::NotYet;
  // Engines refuse scenes for reasons of their own, whatever they declare.
  const bool lacks = reason.find("does not declare") != std::string::npos;
  out.says = lacks ? fmt::format("{}. This check needs {}", reason, check.wants)
                   : fmt::format(
                         "The engine declares what this check needs, and refuses a scene: \"{}\". The scenes "
                         "have {}",
                         reason, check.wants);
  return out;
}

Finding broken(const std::string& says) {
  Finding out;
  out.verdict = Verdict::Broken;
  out.says = says;
  return out;
}

// Runs a failed check again. The same scene and settings must give the same bits; otherwise no figure of the
// first run can identify a mistake.
void compare_with_second_run(const Check& check, const Lab& lab, Finding& finding) {
  const Finding again = check.run(lab);
  for (std::size_t i = 0; i < std::min(finding.readings.size(), again.readings.size()); ++i) {
    const Reading &first = finding.readings[i], &second = again.readings[i];
    if (first.measured == second.measured) continue;
    finding.mistake = kRunsDiffer;
    finding.says = fmt::format(
        "Two runs of the same scene differ: {} is {:.6g} in one and {:.6g} in the other. Is the step taken "
        "from "
        "a clock? It is \"dt\" of the settings, each time. Or is something random, or used before it is set?",
        first.what, first.measured, second.measured);
    return;
  }
}

// Names a mistake that shows in free flight, which explains a failed check better than its figures do.
void look_at_flights(const std::vector<Recorded>& runs, Finding& finding) {
  for (const Recorded& run : runs) {
    const std::optional<Seen> seen = seen_in_flight(run);
    if (!seen || (seen->general && !finding.mistake.empty())) continue;
    finding.mistake = seen->mistake;
    finding.says = seen->says;
    finding.proven = true;
    return;
  }
}

Finding run(const Check& check, const Lab& lab, int& timeouts) {
  try {
    Finding out = check.run(lab);
    if (out.verdict == Verdict::Fail) compare_with_second_run(check, lab, out);
    for (const Reading& reading : out.readings)
      if (!std::isfinite(reading.measured)) {
        Finding endless = broken(fmt::format("{} is not a finite number", reading.what));
        endless.diverged = true;
        return endless;
      }
    return out;
  } catch (const NotYet& reason) {
    return not_yet(check, reason.what());
  } catch (const Error& error) {
    if (error.kind() == Error::Kind::Unsupported) return not_yet(check, error.what());
    if (is(error, ProcessError::Fault::Timeout)) ++timeouts;
    const bool grows = is(error, ProcessError::Fault::Diverged);
    const bool late = is(error, ProcessError::Fault::Timeout);
    Finding out = broken(error.what() + std::string(grows ? kGrowsForEver : late ? kSlowEngine : ""));
    out.diverged = grows;
    if (is(error, ProcessError::Fault::Time)) {
      out.mistake = "wrong_dt";
      out.says = kWrongStep + fmt::format(" ({})", error.what());
    }
    return out;
  }
}

}  // namespace

std::vector<Chapter> chapters() {
  return {bouncing_ball(), cannonballs(), circle_collisions(), rotation_and_boxes(),
          constraints_and_ragdoll()};
}

std::vector<Outcome> examine(const reference::Backend& engine, const reference::StepSettings& settings,
                             std::span<const Chapter> chapters,
                             const std::function<void(const Outcome&)>& done) {
  std::vector<Outcome> out;
  std::size_t told = 0;  // number of checks for which `done` was called
  int timeouts = 0;
  bool unexplained = false;  // an earlier check has failed, and no mistake was named so far
  std::string named, known;  // the first mistake, and the first whose motion was computed
  for (const Chapter& chapter : chapters) {
    std::vector<Outcome> outcomes;
    for (const Check& check : chapter.checks) {
      Outcome outcome{.chapter = &chapter, .check = &check, .finding = {}};
      const Lab lab(engine, settings, &outcome.runs);
      outcome.finding = timeouts >= kPatience
                            ? broken(fmt::format("not tried: the engine has hung {} times", timeouts))
                            : run(check, lab, timeouts);
      outcomes.push_back(std::move(outcome));
    }
    name_by_motion(Lab(engine, settings), outcomes, out, known);
    for (Outcome& outcome : outcomes) {
      Finding& finding = outcome.finding;
      if (finding.verdict == Verdict::Fail && finding.mistake != kRunsDiffer)
        look_at_flights(outcome.runs, finding);
      if (!named.empty() && finding.mistake != named) finding.follows = named;
      // After a failure that has no name, or another one, a later mistake is named only on strong evidence:
      // the first cause may affect any check.
      const bool later = (!named.empty() && finding.mistake != named) || unexplained;
      // In that case, an experiment with many bodies that all show the mistake proves nothing.
      const bool proven = finding.proven && (!unexplained || outcome.check->repeatable);
      const bool sure = proven || (unexplained ? finding.exact : finding.computed);
      if (later && !sure && finding.verdict == Verdict::Fail && !finding.mistake.empty()) {
        finding.mistake.clear();
        finding.says = describe(finding);
      }
      if (finding.verdict == Verdict::Fail && finding.mistake.empty() && named.empty()) unexplained = true;
      if (named.empty()) named = finding.mistake;
      if (known.empty() && finding.computed) known = finding.mistake;
      out.push_back(std::move(outcome));
    }
    // Waits: a later check may name the mistake of a failure that has no name so far.
    const bool last = &chapter == &chapters.back();
    if (unexplained && !last && named.empty()) continue;
    if (unexplained && told < out.size()) name_in_hindsight(Lab(engine, settings), out, told);
    for (; told < out.size(); ++told) done(out[told]);
  }
  return out;
}

}  // namespace plumb::course
