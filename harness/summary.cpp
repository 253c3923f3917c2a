#include "harness/summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "harness/cost.h"

namespace plumb::harness {
namespace {

using Ink = Style::Ink;

constexpr std::string_view kOurs = "plumb";

/// plumb's and the rival's result of the same instance.
struct Pair {
  const Result* ours;
  const Result* theirs;
};

/// Ratios of theirs to ours, over all instances: above 1 plumb is better.
struct Ratios {
  std::vector<double> values;
  int better = 0, equal = 0, worse = 0;
};

double floored(double value) { return std::max(value, kRoundingFloor); }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : std::sqrt(values[middle - 1] * values[middle]);
}

// Formats a ratio: "12 x", "1.1e3 x".
std::string times(double ratio) {
  if (ratio < 999.5) return fmt::format("{:.3g} x", ratio);
  const std::string rounded = fmt::format("{:.1e}", ratio);  // "1.1e+03"
  return fmt::format("{}e{} x", rounded.substr(0, rounded.find('e')),
                     std::stoi(rounded.substr(rounded.find('e') + 1)));
}

std::string range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.size() == 1) return times(values.front());
  return fmt::format("median {}, from {} to {}", times(median(values)), times(*low), times(*high));
}

std::vector<Pair> pairs_with(std::span<const Result> results, std::string_view rival) {
  std::map<std::string, const Result*> ours;
  for (const Result& result : results)
    if (result.engine == kOurs && result.status == Status::Ok) ours[result.label] = &result;
  std::vector<Pair> pairs;
  for (const Result& result : results)
    if (result.engine == rival && result.ran() && ours.contains(result.label))
      pairs.push_back({ours[result.label], &result});
  return pairs;
}

void compare_metric(const std::vector<Pair>& pairs, const MetricField& field, Ratios& ratios,
                    std::vector<std::string>& worse) {
  for (const auto& [ours, theirs] : pairs) {
    const auto &mine = ours->metrics.*field.value, &other = theirs->metrics.*field.value;
    if (!mine || !other || theirs->status != Status::Ok) continue;
    const double ratio = floored(*other) / floored(*mine);
    if (ratio == 1) {
      ++ratios.equal;
      continue;
    }
    ratios.values.push_back(ratio);
    ++(ratio > 1 ? ratios.better : ratios.worse);
    if (ratio < 1) {
      worse.push_back(fmt::format("{} {}: {} against {} {}", ours->label, field.name, figure(*mine),
                                  figure(*other), field.unit));
    }
  }
}

std::string costs(const std::vector<Pair>& pairs) {
  std::vector<double> ratios;
  int hidden = 0, measured = 0;
  for (const auto& [ours, theirs] : pairs) {
    if (!ours->cost || !theirs->cost || theirs->foreign_cost) continue;
    ++measured;
    if (!clearly_differ(*ours->cost, *theirs->cost)) {
      ++hidden;
    } else {
      ratios.push_back(theirs->cost->ns_per_step / ours->cost->ns_per_step);
    }
  }
  if (measured == 0) return "";
  std::string text = "  cost per step, theirs / plumb's: ";
  text += ratios.empty() ? "unknown" : range(ratios);
  if (hidden > 0) text += fmt::format("; in {} of {} noise hides which is cheaper", hidden, measured);
  return text + "\n";
}

// Lists the scenes in which the rival failed, and counts those that it skips.
std::string not_compared(std::span<const Result> results, const std::string& rival) {
  std::string text;
  int skipped = 0;
  for (const Result& result : results) {
    if (result.engine != rival || result.status == Status::Ok) continue;
    if (result.status == Status::Skipped) {
      ++skipped;
    } else {
      text += fmt::format("  {}: {} is {}\n", result.label, rival, name_of(result.status));
    }
  }
  if (skipped > 0) text += fmt::format("  {} skips {} of these scenes\n", rival, skipped);
  return text;
}

std::string against(std::span<const Result> results, const std::string& rival, const Style& style) {
  const std::vector<Pair> pairs = pairs_with(results, rival);
  if (pairs.empty()) return not_compared(results, rival);
  std::vector<std::string> worse, better;
  int figures = 0;
  for (const MetricField& field : kMetricFields) {
    Ratios ratios;
    compare_metric(pairs, field, ratios, worse);
    const int count = ratios.better + ratios.equal + ratios.worse;
    figures += count;
    if (count == 0) continue;
    std::string line = fmt::format("  {:<23} better in {}, equal in {}, worse in {}", field.name,
                                   ratios.better, ratios.equal, ratios.worse);
    if (!ratios.values.empty()) line += ": " + range(ratios.values);
    better.push_back(line);
  }
  std::string out =
      style.paint(fmt::format("plumb against {}, both at dt = {} s", rival, dt_text(pairs.front().ours->dt)),
                  Ink::Bold) +
      "\n";
  if (worse.empty()) {
    out += style.paint(fmt::format("  worse in none of {} figures", figures), Ink::Green) + "\n";
  } else {
    out +=
        style.paint(fmt::format("  worse in {} of {} figures:", worse.size(), figures), Ink::Yellow) + "\n";
    for (const std::string& line : worse) out += "    " + line + "\n";
  }
  for (const std::string& line : better) out += line + "\n";
  return out + costs(pairs) + not_compared(results, rival);
}

std::string count_of(std::span<const Result> results, const Style& style) {
  std::map<Status, int> statuses;
  int unexpected = 0, limits = 0;
  for (const Result& result : results) {
    ++statuses[result.status];
    unexpected += result.unexpected.empty() ? 0 : 1;
    limits += std::any_of(result.checks.begin(), result.checks.end(),
                          [](const Check& c) { return !c.known_limit.empty(); })
                  ? 1
                  : 0;
  }
  std::string text = fmt::format("{} runs:", results.size());
  for (const auto& [status, count] : statuses) text += fmt::format(" {} {}", count, name_of(status));
  if (limits > 0) text += fmt::format("; {} with a known limit", limits);
  text += unexpected == 0 ? "; all as expected" : fmt::format("; {} NOT as expected", unexpected);
  return style.paint(text, unexpected == 0 ? Ink::Green : Ink::Red) + "\n";
}

}  // namespace

std::string summary(std::span<const Result> results, const Style& style) {
  std::vector<std::string> rivals;
  for (const Result& result : results) {
    if (result.engine.starts_with(kOurs)) continue;
    if (std::find(rivals.begin(), rivals.end(), result.engine) == rivals.end())
      rivals.push_back(result.engine);
  }
  std::string out;
  for (const std::string& rival : rivals) {
    const std::string text = against(results, rival, style);
    if (!text.empty()) out += text + "\n";
  }
  const bool noisy = std::any_of(results.begin(), results.end(),
                                 [](const Result& result) { return result.cost && is_noisy(*result.cost); });
  if (noisy) {
    out += style.paint(wrap("~ before a cost: noisy; the interquartile range of its repetitions exceeds a "
                            "quarter of the median",
                            style.width, 2),
                       Ink::Dim) +
           "\n";
  }
  const bool foreign = std::any_of(results.begin(), results.end(),
                                   [](const Result& result) { return result.cost && result.foreign_cost; });
  if (foreign)
    out +=
        style.paint("* before a cost: WebAssembly or JavaScript, not ranked with native engines", Ink::Dim) +
        "\n";
  return out + count_of(results, style);
}

}  // namespace plumb::harness
