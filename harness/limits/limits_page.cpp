#include "harness/limits/limits_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/sweep/front.h"
#include "harness/thresholds/finding_table.h"

namespace plumb::harness::limits {
namespace {

using thresholds::Finding;

// Escapes text for a cell of a table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return out;
}

std::string number(double value, const std::string& unit) {
  const std::string text = fmt::format("{:g}", value);
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

std::string who(std::string_view engine, std::string_view setting) {
  return setting == "default" ? fmt::format("`{}`", engine) : fmt::format("`{}` {}", engine, setting);
}

/// Groups the rows by family, families in the order of their first appearance.
std::vector<std::vector<const FamilyRow*>> by_family(const std::vector<FamilyRow>& rows) {
  std::vector<std::vector<const FamilyRow*>> out;
  std::map<std::string, std::size_t> places;
  for (const FamilyRow& row : rows) {
    const auto [place, fresh] = places.try_emplace(row.family, out.size());
    if (fresh) out.emplace_back();
    out[place->second].push_back(&row);
  }
  return out;
}

// Counts over all families together.
std::string counts(const std::vector<FamilyRow>& rows) {
  struct Count {
    std::size_t survived = 0, total = 0;
    std::map<std::string, std::size_t> others{};
  };
  std::vector<std::pair<std::pair<std::string, std::string>, Count>> all;
  for (const FamilyRow& row : rows) {
    const std::pair key{row.engine, row.setting};
    auto place = std::ranges::find(all, key, &decltype(all)::value_type::first);
    if (place == all.end()) place = all.insert(all.end(), {key, {}});
    for (const std::string& outcome : row.outcomes) {
      if (outcome == "skipped") continue;
      ++place->second.total;
      if (outcome == "ok") {
        ++place->second.survived;
      } else {
        ++place->second.others[outcome];
      }
    }
  }
  std::string out =
      "### Cells survived by each engine\n\n| engine | survived | of | | others |\n|---|---|---|---|---|\n";
  for (const auto& [key, count] : all) {
    if (count.total == 0) continue;
    std::string others;
    for (const auto& [outcome, times] : count.others)
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", times, outcome);
    out += fmt::format(
        "| {} | {} | {} | {:.1f} % | {} |\n", who(key.first, key.second), count.survived, count.total,
        100.0 * static_cast<double>(count.survived) / static_cast<double>(count.total), others);
  }
  return out;
}

bool whole(const FamilyRow& row) { return !row.skipped() && row.survived() == row.outcomes.size(); }

// Lists for each family the settings of plumb that survive all of it. If there is none, lists the setting
// that survives most.
std::string advice(const std::vector<std::vector<const FamilyRow*>>& families) {
  std::string out =
      "### Settings for each extreme\n\n| extreme | values | survived completely by |\n|---|---|---|\n";
  for (const auto& rows : families) {
    std::string names;
    const FamilyRow* farthest = nullptr;
    for (const FamilyRow* row : rows) {
      if (!sweep::is_plumb(row->engine) || row->skipped()) continue;
      if (whole(*row)) names += (names.empty() ? "" : ", ") + who(row->engine, row->setting);
      if (farthest == nullptr || row->survived() > farthest->survived()) farthest = row;
    }
    if (farthest == nullptr) continue;
    if (names.empty())
      names = fmt::format("none; the best is {} with {} of {}", who(farthest->engine, farthest->setting),
                          farthest->survived(), farthest->outcomes.size());
    const FamilyRow& any = *rows.front();
    out += fmt::format("| {} | {} {} to {} | {} |\n", cell(any.title), cell(any.axis),
                       number(any.values.front(), ""), number(any.values.back(), any.unit), names);
  }
  return out;
}

// Formats "sinks at 1000: by 3 mm".
std::string end_of(const FamilyRow& row, std::size_t i) {
  const std::string reason = row.reasons[i].empty() ? "" : ": " + row.reasons[i];
  return cell(fmt::format("{} at {}{}", row.outcomes[i], number(row.values[i], row.unit), reason));
}

std::string family_line(const FamilyRow& row) {
  const std::string name = who(row.engine, row.setting);
  const auto [first, last] = row.survived_range();
  if (first == last) return fmt::format("| {} | nowhere | {} | |\n", name, end_of(row, 0));
  const std::string below = first == 0 ? "" : end_of(row, first - 1);
  std::string beyond = last == row.values.size() ? "" : end_of(row, last);
  if (row.survived() > last - first)
    beyond += fmt::format("; {} more values survive elsewhere", row.survived() - (last - first));
  const std::string range = whole(row) ? "all"
                                       : fmt::format("{} to {}", number(row.values[first], ""),
                                                     number(row.values[last - 1], row.unit));
  return fmt::format("| {} | {} | {} | {} |\n", name, range, below, beyond);
}

std::string family_table(const std::vector<const FamilyRow*>& rows) {
  const FamilyRow& any = *rows.front();
  std::string out = fmt::format(
      "### {}\n\n`{}`: {} {} to {}.\n\n| engine | survives | below | beyond |\n|---|---|---|---|\n",
      any.title, any.family, any.axis, number(any.values.front(), ""), number(any.values.back(), any.unit));
  std::string skipped;
  for (const FamilyRow* row : rows) {
    if (!row->skipped()) {
      out += family_line(*row);
    } else if (row->setting == "default") {
      skipped += fmt::format("{}`{}`", skipped.empty() ? "" : ", ", row->engine);
    }
  }
  return skipped.empty() ? out : out + fmt::format("\nNot supported by {}.\n", skipped);
}

std::string found_cell(const Finding& finding) {
  if (finding.outcome == Finding::Outcome::Refused) return "";
  std::string text = thresholds::found_text(finding);
  const auto difference = finding.relative_difference();
  if (difference && std::abs(*difference) >= 1e-3 && finding.outcome == Finding::Outcome::Found)
    text += fmt::format(" ({:+.2g} %)", 100 * *difference);
  return text;
}

// Formats a table with one row per threshold and one column per engine.
std::string thresholds_table(const std::vector<Finding>& findings) {
  std::vector<std::string> names, engines;
  for (const Finding& finding : findings) {
    const std::string engine = who(finding.engine, finding.setting);
    if (std::ranges::find(names, finding.name) == names.end()) names.push_back(finding.name);
    const bool ran = finding.outcome != Finding::Outcome::Refused;
    if (ran && std::ranges::find(engines, engine) == engines.end()) engines.push_back(engine);
  }
  std::string out =
      "### Critical values\n\nFound by bisection, with default settings at 1/60 s ([how](thresholds.md)). "
      "Brackets show the difference from the exact\nvalue if it is 0.1 % or more. A cell is empty if the "
      "engine lacks a feature that the scene needs.\n\n| | exact |";
  for (const std::string& engine : engines) out += fmt::format(" {} |", engine);
  out += "\n|---|---|";
  for (std::size_t i = 0; i < engines.size(); ++i) out += "---|";
  for (const std::string& name : names) {
    std::map<std::string, const Finding*> row;
    const Finding* any = nullptr;
    for (const Finding& finding : findings) {
      if (finding.name != name) continue;
      row[who(finding.engine, finding.setting)] = &finding;
      if (any == nullptr || (!any->exact && finding.exact)) any = &finding;
    }
    const bool one = std::ranges::all_of(row, [&](const auto& each) {
      return each.second->outcome == Finding::Outcome::Refused || each.second->exact == any->exact;
    });
    const std::string exact = !one         ? "by the engine's method"
                              : any->exact ? thresholds::value_text(*any->exact, any->digits + 1, any->unit)
                                           : "any";
    out += fmt::format("\n| {} | {} |", cell(any->quantity), exact);
    for (const std::string& engine : engines)
      out += fmt::format(" {} |", row.contains(engine) ? cell(found_cell(*row[engine])) : "");
  }
  return out + "\n";
}

/// Returns the positions of the markers: the first character after `kBegin`, and that of `kEnd`.
std::pair<std::size_t, std::size_t> between(std::string_view page) {
  const std::size_t begin = page.find(kBegin), end = page.find(kEnd);
  const bool once = begin != page.npos && end != page.npos && begin < end &&
                    page.find(kBegin, begin + 1) == page.npos && page.find(kEnd, end + 1) == page.npos;
  const auto line = [](std::string_view marker) { return marker.substr(0, marker.find('\n')); };
  if (!once)
    throw Error(
        Error::Kind::Syntax, "the page of limits", "", "",
        fmt::format("does not have its two markers once each, in order: {} {}", line(kBegin), line(kEnd)));
  return {begin + kBegin.size(), end};
}

}  // namespace

std::string measured_part(const LimitsData& data) {
  std::string out = "## Measured extremes\n\n";
  if (!data.measured.empty()) out += fmt::format("Measured with {}.\n", data.measured);
  const auto families = by_family(data.rows);
  if (!families.empty()) {
    out += fmt::format(
        "These are the results of [stress](stress.md) in {} families of scenes. \"Survives\" is the longest "
        "range of values in\nwhich every run is accurate enough to use; beside it is the outcome at the "
        "next value on either side. Engines without a\nnamed setting use their defaults; the others are "
        "[these](stress.md#settings).\n\n",
        families.size());
    out += counts(data.rows) + "\n" + advice(families);
    for (const auto& rows : families) out += "\n" + family_table(rows);
  }
  if (!data.findings.empty()) out += "\n" + thresholds_table(data.findings);
  return out;
}

std::string with_measured_part(std::string_view page, std::string_view part) {
  const auto [begin, end] = between(page);
  return std::string(page.substr(0, begin)) + std::string(part) + std::string(page.substr(end));
}

std::string measured_part_of(std::string_view page) {
  const auto [begin, end] = between(page);
  return std::string(page.substr(begin, end - begin));
}

}  // namespace plumb::harness::limits
