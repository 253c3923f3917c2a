#include "harness/plain_words.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "harness/summary.h"

namespace plumb::harness {
namespace {

using Ink = Style::Ink;

// Returns the name up to the first '-'. Engines for which it is the same share most of their code.
std::string_view maker_of(std::string_view engine) { return engine.substr(0, engine.find('-')); }

bool misses_truth(const Result& result) {
  return std::any_of(result.checks.begin(), result.checks.end(), [](const Check& check) {
    return check.oracle == Oracle::Exact && !check.pass && check.known_limit.empty();
  });
}

std::map<std::string, std::vector<const Result*>> by_scene(std::span<const Result> results) {
  std::map<std::string, std::vector<const Result*>> out;
  for (const Result& result : results)
    if (result.status == Status::Ok) out[result.label].push_back(&result);
  return out;
}

struct Tally {
  int ran = 0, nearest = 0, limits = 0, unexpected = 0;
};

}  // namespace

std::string legend(const Style& style) {
  const char* text =
      "Reading the tables: position, angle and velocity are the largest errors against the truth, over all "
      "bodies and the whole run; energy is its drift as a fraction of the largest kinetic energy; joint gap "
      "and overlap are the largest distances by which joints come apart and bodies overlap; cost is the time "
      "of one step. \"agrees with\" is yes if every check passes: truth (the exact motion, within the error "
      "of the engine's method), scheme (results that its method computes exactly), laws (conserved "
      "quantities). It is \"no\" for a known limit, with the reason below the table, and \"NO\" for an "
      "unexpected miss. 5/7: the engine agrees with five of seven other engines.";
  return style.paint(wrap(text, style.width, 0), Ink::Dim) + "\n\n";
}

std::vector<std::string> suspect_truths(std::span<const Result> results) {
  std::vector<std::string> out;
  for (const auto& [label, runs] : by_scene(results)) {
    std::set<std::string_view> makers;
    bool suspect = true;
    for (const Result* run : runs) {
      makers.insert(maker_of(run->engine));
      suspect = suspect && misses_truth(*run) && run->disagrees_with.empty() && !run->agrees_with.empty();
    }
    if (suspect && makers.size() >= 2) out.push_back(label);
  }
  return out;
}

std::string conclusion(std::span<const Result> results, const Style& style) {
  std::vector<std::string> engines;
  std::map<std::string, Tally> tallies;
  for (const Result& result : results) {
    if (std::find(engines.begin(), engines.end(), result.engine) == engines.end())
      engines.push_back(result.engine);
    Tally& tally = tallies[result.engine];
    tally.unexpected += result.unexpected.empty() ? 0 : 1;
    if (result.status != Status::Ok) continue;
    ++tally.ran;
    tally.limits += std::any_of(result.checks.begin(), result.checks.end(),
                                [](const Check& check) { return !check.known_limit.empty(); })
                        ? 1
                        : 0;
  }
  int compared = 0;
  for (const auto& [label, runs] : by_scene(results)) {
    std::optional<double> best;
    for (const Result* run : runs)
      if (const auto& error = run->metrics.position_error) best = std::min(best.value_or(*error), *error);
    if (!best || runs.size() < 2) continue;
    ++compared;
    for (const Result* run : runs)
      if (run->metrics.position_error && *run->metrics.position_error <= std::max(*best, kRoundingFloor))
        ++tallies[run->engine].nearest;
  }
  std::string out = style.paint("In plain words", Ink::Bold) + "\n";
  const auto scenes = [](int count) { return fmt::format("{} {}", count, count == 1 ? "scene" : "scenes"); };
  for (const std::string& engine : engines) {
    const Tally& tally = tallies[engine];
    std::string line = fmt::format("{:<19} ", engine);
    if (tally.ran == 0 && tally.unexpected == 0) {
      line += "ran none of these scenes";
    } else {
      line += fmt::format("ran {}", scenes(tally.ran));
      if (compared > 0) line += fmt::format(", nearest to the true positions in {}", tally.nearest);
      line += tally.limits == 0
                  ? "; as accurate as its method promises"
                  : fmt::format("; less accurate than its method promises in {}, for known reasons",
                                tally.limits);
      if (tally.unexpected > 0) line += fmt::format("; NOT as expected in {}", tally.unexpected);
    }
    out += "  " + style.paint(wrap(line, style.width - 2, 22), tally.unexpected > 0 ? Ink::Red : Ink::Plain) +
           "\n";
  }
  for (const std::string& label : suspect_truths(results)) {
    out += style.paint(
               wrap(fmt::format(
                        "  {}: all engines agree with each other, and none with the truth. The truth may be "
                        "wrong: check the scenario's formula, its units and its initial state first.",
                        label),
                    style.width, 4),
               Ink::Red) +
           "\n";
  }
  return out;
}

}  // namespace plumb::harness
