#include "harness/course/prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/course/student/student.h"

namespace plumb::course {
namespace {

// Largest distance of two paths that count as the same, as a fraction of their distance from the right one. A
// contact that is found a step sooner or later shifts a path by about a hundredth of it.
constexpr double kSamePath = 0.1;

// A mistake that fits less well than another by this factor does not count beside it.
constexpr double kClearly = 5;

constexpr double kEqual = 0.01;  // paths nearer than this fit equally well

constexpr double kLever = 0.5;  // m: turns an angle into a length, half the size of the checks' boxes

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

// Adds up the squared distances of the bodies' places in two runs.
double distance(const Trace& a, const Trace& b) {
  double sum = 0;
  for (std::size_t k = 0; k < std::min(a.states.size(), b.states.size()); ++k)
    for (std::size_t i = 0; i < std::min(a.states[k].size(), b.states[k].size()); ++i) {
      const Vec2d way = a.states[k][i].position - b.states[k][i].position;
      const double turn = kLever * (a.states[k][i].angle - b.states[k][i].angle);
      sum += dot(way, way) + turn * turn;
    }
  return sum;
}

double distance(const std::vector<Recorded>& a, const std::vector<Recorded>& b) {
  double sum = 0;
  for (std::size_t r = 0; r < std::min(a.size(), b.size()); ++r) sum += distance(a[r].trace, b[r].trace);
  return std::sqrt(sum);
}

// Returns true if each reading is that of the mistake, within the tolerance that figures of mistakes have.
bool same_readings(const Finding& seen, const Finding& predicted) {
  if (seen.readings.size() != predicted.readings.size()) return false;
  Judgement judgement;
  std::vector<double> gives;
  for (std::size_t i = 0; i < seen.readings.size(); ++i) {
    const Reading& r = seen.readings[i];
    judgement.read(r.what, r.unit, r.measured, r.expected, r.tolerance);
    gives.push_back(predicted.readings[i].measured);
  }
  judgement.mistake("this", std::move(gives), "");
  return judgement.finding().mistake == "this";
}

struct Fit {
  const Predictable* mistake;
  double off;  // distance of the paths over that from the right ones
};

// Returns how well each mistake fits, the best first, one for each name.
std::vector<Fit> fits(const std::vector<Predictable>& mistakes, const Check& check, int chapter,
                      const Lab& lab, const std::vector<Recorded>& runs, const Finding& finding) {
  std::vector<Fit> out;
  const auto right = attempt(check, *make_student("", lab.scheme()), lab.plain_settings());
  if (!right) return out;
  for (const Predictable& mistake : mistakes) {
    if (std::string_view(mistake.chapters).find(static_cast<char>('0' + chapter)) == std::string_view::npos)
      continue;
    for (const char* sweeps : {"", ", one sweep"}) {
      const std::string planted = std::string(mistake.planted) + sweeps;
      const auto wrong = attempt(check, *make_student(planted, lab.scheme()), lab.plain_settings());
      if (!wrong || wrong->finding.verdict != Verdict::Fail || !same_readings(finding, wrong->finding))
        continue;
      const double way = distance(right->runs, wrong->runs), off = distance(runs, wrong->runs);
      // If only velocities are wrong, readings decide alone.
      const double share = way > 1e-9 ? off / way : 0;
      if (std::isfinite(share) && share <= kSamePath) out.push_back({&mistake, share});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Fit& a, const Fit& b) { return a.off < b.off; });
  std::vector<Fit> names;
  for (const Fit& fit : out)
    if (std::none_of(names.begin(), names.end(), [&](const Fit& other) {
          return std::string_view(other.mistake->name) == fit.mistake->name;
        }))
      names.push_back(fit);
  return names;
}

}  // namespace

void name_by_motion(const Check& check, int chapter, const Lab& lab, const std::vector<Recorded>& runs,
                    Finding& finding) {
  using reference::Scheme;
  const Scheme scheme = lab.scheme();
  if (scheme != Scheme::SemiImplicitEuler && scheme != Scheme::ExplicitEuler &&
      scheme != Scheme::VelocityVerlet)
    return;
  const std::vector<Predictable> mistakes = predictable_mistakes();
  std::vector<Fit> found = fits(mistakes, check, chapter, lab, runs, finding);
  if (!found.empty())
    std::erase_if(found, [least = found.front().off](const Fit& fit) {
      return fit.off > kClearly * std::max(least, kEqual);
    });
  if (found.size() == 1) {
    if (finding.mistake != found.front().mistake->name) finding.says = found.front().mistake->says;
    finding.mistake = found.front().mistake->name;
    return;
  }
  if (found.size() > 1) {
    finding.mistake.clear();
    finding.says = "Several mistakes give this motion, and this check does not tell them apart.";
    for (const Fit& fit : found) finding.says += fmt::format(" {}: {}", fit.mistake->name, fit.mistake->says);
    return;
  }
  const bool refuted = std::any_of(mistakes.begin(), mistakes.end(), [&](const Predictable& mistake) {
    return finding.mistake == mistake.name;
  });
  if (!refuted) return;
  finding.mistake.clear();
  finding.says = describe(finding.readings);
}

}  // namespace plumb::course
