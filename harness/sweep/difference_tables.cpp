#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/sweep/difference.h"

namespace plumb::harness::sweep {
namespace {

using Ink = Style::Ink;
using Json = nlohmann::ordered_json;

std::string value_text(const std::optional<double>& value) { return value ? figure(*value) : "none"; }

std::string exactly(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string status_text(const std::optional<Status>& status) {
  return status ? std::string(name_of(*status)) : "not there";
}

struct Line {
  bool worse;
  std::string text;
};

// Appends the changes of one run, one per line.
void describe(const Difference& row, std::vector<Line>& out) {
  const std::string where = fmt::format("{} {}, {}", row.label, row.engine, row.settings);
  if (row.before != row.after && row.before && row.after)
    out.push_back({row.before == Status::Ok,
                   fmt::format("{}: {}, was {}", where, status_text(row.after), status_text(row.before))});
  for (const MetricChange& error : row.errors)
    out.push_back({!error.better(), fmt::format("{}: {} {}, was {}", where, error.metric->name,
                                                value_text(error.after), value_text(error.before))});
  if (row.cost == Verdict::Better || row.cost == Verdict::Worse)
    out.push_back({row.cost == Verdict::Worse,
                   fmt::format("{}: cost {} a step, was {} ({:.3g} x, p = {:.1e})", where,
                               duration_text(row.cost_after), duration_text(row.cost_before),
                               row.cost_after / row.cost_before, row.chance)});
}

std::string counts(std::span<const Difference> rows) {
  int verdicts[6] = {}, same = 0, better = 0, worse = 0, gone = 0, fresh = 0;
  for (const Difference& row : rows) {
    if (!row.after) ++gone;
    if (!row.before) ++fresh;
    if (!row.before || !row.after) continue;
    ++verdicts[static_cast<int>(row.cost)];
    same += row.errors.empty() ? 1 : 0;
    for (const MetricChange& error : row.errors) ++(error.better() ? better : worse);
  }
  std::string out =
      fmt::format("{} runs in both: errors of {} identical to the bit; {} figures better, {} worse\n",
                  static_cast<int>(rows.size()) - gone - fresh, same, better, worse);
  out += fmt::format("costs: {} better, {} worse, {} cannot be told from noise", verdicts[0], verdicts[1],
                     verdicts[2]);
  if (verdicts[3] > 0)
    out += fmt::format(", {} have fewer than {} repetitions, which a rank test needs", verdicts[3], kEnough);
  if (verdicts[4] > 0) out += fmt::format(", {} not measured", verdicts[4]);
  if (verdicts[5] > 0)
    out += fmt::format(", {} left out: measured on different kinds of machine", verdicts[5]);
  out += "\n";
  if (gone + fresh > 0)
    out += fmt::format("{} runs only in the old results, {} only in the new\n", gone, fresh);
  return out;
}

}  // namespace

std::string difference_table(std::span<const Difference> rows, const Style& style) {
  std::vector<Line> lines;
  for (const Difference& row : rows) describe(row, lines);
  std::stable_partition(lines.begin(), lines.end(), [](const Line& line) { return line.worse; });
  std::string out;
  for (const Line& line : lines)
    out += style.paint(pad_right(line.worse ? "worse" : "better", 8), line.worse ? Ink::Red : Ink::Green) +
           wrap(line.text, style.width - 8, 10) + "\n";
  return out + counts(rows);
}

std::string difference_json(std::span<const Difference> rows) {
  Json array = Json::array();
  for (const Difference& row : rows) {
    Json errors = Json::array();
    for (const MetricChange& error : row.errors)
      errors.push_back({{"metric", error.metric->name},
                        {"before", error.before ? Json(*error.before) : Json(nullptr)},
                        {"after", error.after ? Json(*error.after) : Json(nullptr)},
                        {"verdict", error.better() ? "better" : "worse"}});
    array.push_back({{"label", row.label},
                     {"engine", row.engine},
                     {"settings", row.settings},
                     {"before", row.before ? Json(name_of(*row.before)) : Json(nullptr)},
                     {"after", row.after ? Json(name_of(*row.after)) : Json(nullptr)},
                     {"errors", errors},
                     {"cost", name_of(row.cost)},
                     {"ns_per_step_before", row.cost_before},
                     {"ns_per_step_after", row.cost_after},
                     {"p", row.chance},
                     {"repetitions", row.repetitions}});
  }
  return array.dump(2) + "\n";
}

std::string difference_csv(std::span<const Difference> rows) {
  std::string out = "label,engine,settings,before,after,figure,old,new,verdict,p\n";
  for (const Difference& row : rows) {
    const std::string start = fmt::format("{},{},\"{}\",{},{}", row.label, row.engine, row.settings,
                                          status_text(row.before), status_text(row.after));
    for (const MetricChange& error : row.errors)
      out += fmt::format("{},{},{},{},{},\n", start, error.metric->name, exactly(error.before),
                         exactly(error.after), error.better() ? "better" : "worse");
    out += fmt::format("{},ns_per_step,{},{},{},{}\n", start, row.cost_before, row.cost_after,
                       name_of(row.cost), row.chance);
  }
  return out;
}

}  // namespace plumb::harness::sweep
