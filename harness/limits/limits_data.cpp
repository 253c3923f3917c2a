#include "harness/limits/limits_data.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/report/environments.h"
#include "harness/sweep/front.h"
#include "harness/thresholds/threshold.h"

namespace plumb::harness::limits {
namespace {

using Json = nlohmann::ordered_json;

/// Facts of a cell's line in stress.jsonl that the page needs.
struct CellFacts {
  double value;
  std::string outcome, reason;
};

std::string where_measured(const std::string& folder) {
  std::string out;
  for (const report::EnvironmentUse& use : report::read_environments(folder)) {
    const std::string text =
        fmt::format("plumb {}, commit {}, on {}", use.where.plumb_version, use.where.commit, use.where.cpu);
    if (out.find(text) == std::string::npos) out += (out.empty() ? "" : "; ") + text;
  }
  return out;
}

FamilyRow row_from(const FamilyRow& head, std::vector<CellFacts> cells) {
  FamilyRow row = head;
  std::ranges::stable_sort(cells, {}, &CellFacts::value);
  for (CellFacts& cell : cells) {
    row.values.push_back(cell.value);
    row.outcomes.push_back(std::move(cell.outcome));
    row.reasons.push_back(std::move(cell.reason));
  }
  // Keep the reasons beside the surviving range; if nothing survives, only the first.
  const auto [first, last] = row.survived_range();
  for (std::size_t i = 0; i < row.reasons.size(); ++i) {
    const bool is_shown = first == last ? i == 0 : i + 1 == first || i == last;
    if (!is_shown) row.reasons[i].clear();
  }
  return row;
}

std::vector<FamilyRow> rows_of(const std::vector<stress::Cell>& cells) {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::vector<FamilyRow> heads;
  std::map<Key, std::vector<CellFacts>> facts;
  for (const stress::Cell& cell : cells) {
    std::vector<CellFacts>& row = facts[{cell.family, cell.engine, cell.setting}];
    if (row.empty())
      heads.push_back({.family = cell.family,
                       .title = cell.title,
                       .axis = cell.axis,
                       .unit = cell.unit,
                       .engine = cell.engine,
                       .setting = cell.setting});
    row.push_back({cell.value, std::string(name_of(cell.finding.verdict)), cell.finding.reason});
  }
  std::vector<FamilyRow> out;
  for (const FamilyRow& head : heads)
    out.push_back(row_from(head, facts[{head.family, head.engine, head.setting}]));
  return out;
}

// Returns the position in the order of `plumb thresholds --list`; searches end in any order.
std::ptrdiff_t place_of(const thresholds::Finding& finding) {
  const auto& all = thresholds::all();
  return std::ranges::find(all, finding.name, &thresholds::Threshold::name) - all.begin();
}

Json row_json(const FamilyRow& row) {
  return {{"kind", "row"},          {"family", row.family}, {"title", row.title},
          {"axis", row.axis},       {"unit", row.unit},     {"engine", row.engine},
          {"setting", row.setting}, {"values", row.values}, {"outcomes", row.outcomes},
          {"reasons", row.reasons}};
}

FamilyRow row_from(const Json& json) {
  const auto text = [&](const char* name) { return json.at(name).get<std::string>(); };
  const auto texts = [&](const char* name) { return json.at(name).get<std::vector<std::string>>(); };
  FamilyRow row{.family = text("family"),
                .title = text("title"),
                .axis = text("axis"),
                .unit = text("unit"),
                .engine = text("engine"),
                .setting = text("setting"),
                .values = json.at("values").get<std::vector<double>>(),
                .outcomes = texts("outcomes"),
                .reasons = texts("reasons")};
  if (row.outcomes.size() != row.values.size() || row.reasons.size() != row.values.size())
    throw Error(Error::Kind::Syntax, "limits", "outcomes", "", "are not as many as the values");
  return row;
}

}  // namespace

std::pair<std::size_t, std::size_t> FamilyRow::survived_range() const {
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (std::size_t first = 0; first < outcomes.size(); ++first) {
    std::size_t last = first;
    while (last < outcomes.size() && outcomes[last] == "ok") ++last;
    if (last - first > best.second - best.first) best = {first, last};
    first = last;
  }
  return best;
}

std::size_t FamilyRow::survived() const {
  return static_cast<std::size_t>(std::ranges::count(outcomes, "ok"));
}

bool FamilyRow::skipped() const {
  return std::ranges::all_of(outcomes, [](const std::string& outcome) { return outcome == "skipped"; });
}

LimitsData read_limits(const std::string& folder) {
  const report::Extremes extremes = report::read_extremes(folder);
  if (extremes.empty())
    throw Error(
        Error::Kind::Io, fmt::format("folder '{}'", folder), "", "",
        "has neither stress.jsonl nor thresholds.jsonl; `plumb stress` and `plumb thresholds` make them");
  LimitsData data{.measured = where_measured(folder), .rows = rows_of(extremes.cells), .findings = {}};
  for (const std::string& line : extremes.thresholds) {
    thresholds::Finding finding = thresholds::finding_from_json(line);
    finding.seconds = 0;
    data.findings.push_back(std::move(finding));
  }
  std::ranges::stable_sort(data.findings, {}, [](const thresholds::Finding& finding) {
    return std::tuple(place_of(finding), !sweep::is_plumb(finding.engine), finding.engine, finding.setting);
  });
  return data;
}

std::string to_jsonl(const LimitsData& data) {
  std::string out = Json{{"kind", "measured"}, {"where", data.measured}}.dump() + "\n";
  for (const FamilyRow& row : data.rows)
    out += row_json(row).dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  for (const thresholds::Finding& finding : data.findings) out += thresholds::to_json(finding) + "\n";
  return out;
}

LimitsData limits_from_jsonl(std::string_view text) {
  LimitsData data;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    try {
      const Json json = Json::parse(line);
      const auto kind = json.at("kind").get<std::string>();
      if (kind == "measured") {
        data.measured = json.at("where").get<std::string>();
      } else if (kind == "row") {
        data.rows.push_back(row_from(json));
      } else {
        data.findings.push_back(thresholds::finding_from_json(line));
      }
    } catch (const Json::exception& error) {
      throw Error(Error::Kind::Syntax, "limits", "", "", error.what(), number);
    }
  }
  return data;
}

}  // namespace plumb::harness::limits
