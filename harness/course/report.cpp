#include "harness/course/report.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plumb::course {
namespace {

using harness::Style;
using harness::wrap;
using Json = nlohmann::ordered_json;

constexpr int kIndent = 8;

struct Mark {
  std::string_view text, json;
  Style::Ink ink;
};

Mark mark_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Pass:
      return {"pass", "pass", Style::Ink::Green};
    case Verdict::Fail:
      return {"FAIL", "fail", Style::Ink::Red};
    case Verdict::NotYet:
      return {"not yet", "not_yet", Style::Ink::Yellow};
    case Verdict::Broken:
      return {"BROKEN", "broken", Style::Ink::Red};
  }
  return {"", "", Style::Ink::Plain};
}

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string paragraph(const std::string& text, const Style& style) {
  return fmt::format("{:{}}{}\n", "", kIndent, wrap(text, style.width - kIndent, kIndent));
}

struct Count {
  int passed = 0, all = 0;
};

Count count_of(std::span<const Outcome> outcomes, const Chapter* chapter = nullptr) {
  Count out;
  for (const Outcome& outcome : outcomes) {
    if (chapter != nullptr && outcome.chapter != chapter) continue;
    ++out.all;
    out.passed += outcome.finding.verdict == Verdict::Pass ? 1 : 0;
  }
  return out;
}

std::vector<const Chapter*> chapters_of(std::span<const Outcome> outcomes) {
  std::vector<const Chapter*> out;
  for (const Outcome& outcome : outcomes)
    if (out.empty() || out.back() != outcome.chapter) out.push_back(outcome.chapter);
  return out;
}

}  // namespace

std::string heading(const Chapter& chapter, const Style& style) {
  return style.paint(fmt::format("{}. {}", chapter.number, chapter.title), Style::Ink::Bold) + "\n";
}

std::string line(const Outcome& outcome, const Style& style) {
  const Finding& finding = outcome.finding;
  const Mark mark = mark_of(finding.verdict);
  std::string out = fmt::format("  {}{:{}} {:24} {}\n", style.paint(mark.text, mark.ink), "",
                                kIndent - 1 - static_cast<int>(mark.text.size()), outcome.check->name,
                                outcome.check->title);
  if (finding.verdict == Verdict::Pass) return out;
  if (finding.verdict == Verdict::NotYet) return out + paragraph(finding.says, style);
  if (finding.verdict == Verdict::Fail) {
    for (const Reading& reading : finding.readings) {
      const bool good = reading.good();
      out += paragraph(fmt::format("{} {}: {}, expected {} within {:.2g}", good ? "  " : "x ", reading.what,
                                   with_unit(reading.measured, reading.unit),
                                   with_unit(reading.expected, reading.unit), reading.tolerance),
                       style);
    }
  }
  if (!finding.follows.empty())
    out += paragraph(
        fmt::format("This may follow from {} above; if it stays when that is corrected:", finding.follows),
        style);
  return out + paragraph((finding.mistake.empty() ? "" : finding.mistake + ": ") + finding.says, style);
}

std::string score(std::span<const Outcome> outcomes, const Style& style) {
  const Count total = count_of(outcomes);
  std::string out =
      "\n" + style.paint(fmt::format("{} of {} checks pass", total.passed, total.all), Style::Ink::Bold);
  const Chapter* next = nullptr;
  std::string parts;
  for (const Chapter* chapter : chapters_of(outcomes)) {
    const Count count = count_of(outcomes, chapter);
    parts += fmt::format("{}chapter {}: {}/{}", parts.empty() ? "" : ", ", chapter->number, count.passed,
                         count.all);
    if (next == nullptr && count.passed < count.all) next = chapter;
  }
  out += " (" + parts + ")\n";
  if (next != nullptr)
    out += fmt::format(
        "Next: chapter {}, docs/course/{}. Begin with the first check that fails: it may cause the others.\n",
        next->number, next->page);
  return out;
}

std::string as_json(const std::string& engine, std::span<const Outcome> outcomes) {
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  Json checks = Json::array();
  for (const Outcome& outcome : outcomes) {
    Json readings = Json::array();
    for (const Reading& reading : outcome.finding.readings) {
      readings.push_back({{"what", reading.what},
                          {"unit", reading.unit},
                          {"measured", number(reading.measured)},
                          {"expected", number(reading.expected)},
                          {"tolerance", number(reading.tolerance)},
                          {"good", reading.good()}});
    }
    checks.push_back({{"chapter", outcome.chapter->number},
                      {"check", outcome.check->name},
                      {"title", outcome.check->title},
                      {"verdict", mark_of(outcome.finding.verdict).json},
                      {"mistake", outcome.finding.mistake},
                      {"may_follow_from", outcome.finding.follows},
                      {"says", outcome.finding.says},
                      {"readings", readings}});
  }
  const Count total = count_of(outcomes);
  const Json out{{"engine", engine}, {"passed", total.passed}, {"checks", total.all}, {"results", checks}};
  return out.dump(2) + "\n";
}

bool all_passed(std::span<const Outcome> outcomes) {
  return std::all_of(outcomes.begin(), outcomes.end(),
                     [](const Outcome& outcome) { return outcome.finding.verdict == Verdict::Pass; });
}

}  // namespace plumb::course
