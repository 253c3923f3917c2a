#include "harness/course/finding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace plumb::course {
namespace {

// Tolerance of a mistake's figure, as a fraction of its distance from the correct figure.
constexpr double kSmallestShare = 0.03, kLargestShare = 0.1;

// Returns a sentence about the first reading that is wrong, without a cause.
std::string describe(const std::vector<Reading>& readings) {
  std::string out = "No known mistake gives this motion";
  for (const Reading& reading : readings) {
    if (reading.good()) continue;
    if (reading.expected == 0) return out + fmt::format(": {} should be 0.", reading.what);
    const double times = reading.measured / reading.expected;
    if (times < 0) return out + fmt::format(": {} has the wrong sign.", reading.what);
    if (std::abs(times - 1) < 0.1)
      return out + fmt::format(": {} is {:.2g} % too {}.", reading.what, 100 * std::abs(times - 1),
                               times > 1 ? "large" : "small");
    return out + fmt::format(": {} is {:.4g} times what it should be.", reading.what, times);
  }
  return out + ".";
}

}  // namespace

std::string describe(const Finding& finding) {
  return describe(finding.readings) + (finding.symptom.empty() ? "" : " " + finding.symptom);
}

bool Reading::good() const { return std::abs(measured - expected) <= tolerance; }

Judgement& Judgement::read(std::string what, std::string unit, double measured, double expected,
                           double tolerance) {
  readings_.push_back({std::move(what), std::move(unit), measured, expected, tolerance});
  return *this;
}

Judgement& Judgement::mistake(std::string name, std::vector<double> gives, std::string says) {
  mistakes_.push_back({std::move(name), std::move(says), std::move(gives)});
  return *this;
}

Judgement& Judgement::proven_if(bool seen, std::string name, std::string says) {
  if (seen) proven_.push_back({std::move(name), std::move(says), {}, true});
  return *this;
}

Judgement& Judgement::symptom_if(bool seen, std::string says) {
  if (seen) symptoms_.push_back({"", std::move(says), {}});
  return *this;
}

Judgement& Judgement::mistake_if(bool seen, std::string name, std::string says) {
  if (seen) seen_.push_back({std::move(name), std::move(says), {}});
  return *this;
}

Judgement& Judgement::otherwise_if(bool seen, std::string name, std::string says) {
  if (seen) otherwise_.push_back({std::move(name), std::move(says), {}, true});
  return *this;
}

// Returns the largest distance of a reading from the mistake's figure, in units of the tolerance; if it is
// above 1, the mistake does not match. A mistake that gives no figure for any wrong reading explains nothing.
double Judgement::miss(const Mistake& mistake) const {
  double worst = 0;
  bool explains = false;
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const Reading& reading = readings_[i];
    const double gives = i < mistake.gives.size() ? mistake.gives[i] : kAny;
    if (std::isnan(gives)) continue;
    explains = explains || !reading.good();
    const double way = std::abs(gives - reading.expected);
    // If the mistake does not change a figure, the reading's own tolerance applies.
    const double most = way <= reading.tolerance ? reading.tolerance : kLargestShare * way;
    const double passes = std::max(std::min(reading.tolerance, most), kSmallestShare * way);
    worst = std::max(worst, std::abs(reading.measured - gives) / passes);
  }
  return explains ? worst : std::numeric_limits<double>::infinity();
}

// Returns true if a mistake gives every wrong reading as exactly as a right reading must be.
bool Judgement::certain(const Mistake& mistake) const {
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const Reading& reading = readings_[i];
    const double gives = i < mistake.gives.size() ? mistake.gives[i] : kAny;
    if (std::isnan(gives) ? !reading.good() : std::abs(reading.measured - gives) > reading.tolerance)
      return false;
  }
  return true;
}

bool Judgement::good() const {
  return std::all_of(readings_.begin(), readings_.end(), [](const Reading& r) { return r.good(); });
}

Finding Judgement::finding() const {
  Finding out;
  out.readings = readings_;
  if (good()) return out;
  out.verdict = Verdict::Fail;
  if (!symptoms_.empty()) out.symptom = symptoms_.front().says;
  const Mistake* nearest = !proven_.empty() ? &proven_.front() : seen_.empty() ? nullptr : &seen_.front();
  double least = nearest == nullptr ? 1 : 0;
  for (const Mistake& mistake : mistakes_) {
    const double off = miss(mistake);
    if (off >= least) continue;
    least = off;
    nearest = &mistake;
  }
  if (nearest == nullptr && !otherwise_.empty()) nearest = &otherwise_.front();
  if (nearest == nullptr) {
    out.says = describe(out);
    return out;
  }
  out.mistake = nearest->name;
  out.says = nearest->says;
  out.observed = nearest->gives.empty();
  out.proven = nearest->proven;
  out.certain = certain(*nearest);
  return out;
}

}  // namespace plumb::course
