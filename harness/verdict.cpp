#include "harness/verdict.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumb::harness {
namespace {

using Json = nlohmann::ordered_json;
using Ink = Style::Ink;

// Returns the missed checks of a run, worst first.
std::string misses_of(const Result& result) {
  std::vector<const Check*> missed;
  for (const Check& check : result.checks)
    if (!check.pass) missed.push_back(&check);
  std::sort(missed.begin(), missed.end(),
            [](const Check* a, const Check* b) { return a->value * b->tolerance > b->value * a->tolerance; });
  std::string out;
  for (const Check* check : missed)
    out += fmt::format("{}{} {} (bound {})", out.empty() ? "" : ", ", check->name, figure(check->value),
                       figure(check->tolerance));
  return out;
}

std::string said_of(const Result& result) {
  switch (ruling_on(result)) {
    case Ruling::Agrees:
      return "";
    case Ruling::Misses:
      if (result.status == Status::Diverged) return "diverged: " + result.reason;
      return misses_of(result) + (result.reason.empty() ? "" : "; " + result.reason);
    case Ruling::Broke:
      return fmt::format("{}: {}", name_of(result.status), result.reason);
    case Ruling::Unsupported:
    case Ruling::NotReached:
      break;
  }
  return result.reason;
}

Ink ink_of(Ruling ruling) {
  switch (ruling) {
    case Ruling::Agrees:
      return Ink::Green;
    case Ruling::Misses:
      return Ink::Yellow;
    case Ruling::Broke:
      return Ink::Red;
    case Ruling::Unsupported:
    case Ruling::NotReached:
      break;
  }
  return Ink::Dim;
}

}  // namespace

std::string_view name_of(Ruling ruling) {
  constexpr std::string_view kNames[] = {"agrees", "misses", "broke", "unsupported", "not reached"};
  return kNames[static_cast<int>(ruling)];
}

Ruling ruling_on(const Result& result) {
  if (result.status == Status::Skipped)
    return result.reason == kOutOfTime ? Ruling::NotReached : Ruling::Unsupported;
  const std::optional<bool> agrees = result.agrees_with_truth();
  return !agrees ? Ruling::Broke : *agrees ? Ruling::Agrees : Ruling::Misses;
}

Score score_of(std::span<const Result> results) {
  Score score;
  int* const counts[] = {&score.agrees, &score.misses, &score.broke, &score.unsupported, &score.not_reached};
  for (const Result& result : results) ++*counts[static_cast<int>(ruling_on(result))];
  return score;
}

std::string verdict_text(std::span<const Result> results, const Style& style) {
  std::string out;
  for (const Ruling ruling :
       {Ruling::Misses, Ruling::Broke, Ruling::Agrees, Ruling::Unsupported, Ruling::NotReached}) {
    for (const Result& result : results) {
      if (ruling_on(result) != ruling) continue;
      const std::string said = said_of(result);
      out += style.paint(fmt::format("{:<12}", name_of(ruling)), ink_of(ruling)) +
             wrap(result.label + (said.empty() ? "" : ": " + said), style.width - 12, 14) + "\n";
    }
  }
  const Score score = score_of(results);
  out += fmt::format("\n{} of {} cases agree; {} miss, {} broke, {} unsupported", score.agrees,
                     score.judged(), score.misses, score.broke, score.unsupported);
  if (score.not_reached > 0) out += fmt::format(", {} not reached in time", score.not_reached);
  return out + "\n";
}

std::string verdict_json(std::span<const Result> results) {
  const Score score = score_of(results);
  Json cases = Json::array();
  for (const Result& result : results) {
    Json json = Json::parse(to_json(result));
    cases.push_back({{"case", result.label},
                     {"verdict", name_of(ruling_on(result))},
                     {"said", said_of(result)},
                     {"truth", result.truth},
                     {"checks", json["checks"]},
                     {"metrics", json["metrics"]}});
  }
  const Json out{{"engine", results.empty() ? "" : results.front().engine},
                 {"engine_version", results.empty() ? "" : results.front().engine_version},
                 {"agrees", score.agrees},
                 {"misses", score.misses},
                 {"broke", score.broke},
                 {"unsupported", score.unsupported},
                 {"not_reached", score.not_reached},
                 {"cases", cases}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string verdict_badge(std::span<const Result> results) {
  const Score score = score_of(results);
  const std::string left = "physics", right = fmt::format("{} of {} agree", score.agrees, score.judged());
  // Average width of a character of the badge's font at 11 px, and the margins.
  constexpr int kCharacter = 7, kMargin = 10;
  const int left_width = kCharacter * static_cast<int>(left.size()) + kMargin;
  const int right_width = kCharacter * static_cast<int>(right.size()) + kMargin;
  const double share = score.judged() == 0 ? 0 : static_cast<double>(score.agrees) / score.judged();
  const char* const colour = share >= 0.9 ? "#2e7d32" : share >= 0.5 ? "#b26a00" : "#b3261e";
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="20" role="img" aria-label="{1}: {2}">
<title>{1}: {2}</title>
<rect width="{3}" height="20" fill="#444"/><rect x="{3}" width="{4}" height="20" fill="{5}"/>
<g fill="#fff" font-family="Verdana,Geneva,sans-serif" font-size="11" text-anchor="middle">
<text x="{6}" y="14">{1}</text><text x="{7}" y="14">{2}</text></g>
</svg>
)",
      left_width + right_width, left, right, left_width, right_width, colour, left_width / 2,
      left_width + right_width / 2);
}

}  // namespace plumb::harness
