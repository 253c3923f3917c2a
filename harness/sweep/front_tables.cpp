#include "harness/sweep/front_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "harness/cost.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"
#include "harness/sweep/trade.h"

namespace plumb::harness::sweep {
namespace {

using Ink = Style::Ink;

std::string unit_of(const MetricField& metric) {
  return metric.unit.empty() ? "" : fmt::format(", {}", metric.unit);
}

// Returns the settings without the options that all points of a front share; those go to `common`.
reference::StepSettings without_common(const Point& point, std::span<const Point> front,
                                       reference::StepSettings& common) {
  reference::StepSettings out = point.row->asked;
  common = {};
  for (const auto& [name, value] : point.row->asked.options) {
    const bool shared = std::all_of(front.begin(), front.end(), [&](const Point& other) {
      const auto found = other.row->asked.options.find(name);
      return found != other.row->asked.options.end() && found->second == value;
    });
    if (!shared) continue;
    common.options[name] = value;
    out.options.erase(name);
  }
  return out;
}

std::string fronts(const SceneTrade& trade, const Style& style) {
  std::string out =
      style.paint(fmt::format("  {:<20}{:>10}{:>12}  settings", "front of", "error", "a simul. s"),
                  Ink::Dim) +
      "\n";
  for (const EngineTrade& engine : trade.engines) {
    for (std::size_t i = 0; i < engine.front.size(); ++i) {
      const Point& point = engine.front[i];
      reference::StepSettings common;
      const reference::StepSettings own = without_common(point, engine.front, common);
      const std::string cost = (is_noisy(*point.row->cost) ? "~" : "") + duration_text(point.cost);
      out += fmt::format("  {:<20}{:>10}{:>12}  {}\n", i == 0 ? engine.engine : "", figure(point.error), cost,
                         settings_text(own));
      if (i + 1 < engine.front.size() || common.options.empty()) continue;
      std::string shared;
      for (const auto& [name, value] : common.options)
        shared += fmt::format("{}{} {}", shared.empty() ? "" : ", ", name, value);
      out += style.paint(pad_right("", 46) + "all with " + shared, Ink::Dim) + "\n";
    }
    if (!engine.front.empty() && (!trade.one_truth || engine.within > 0))
      out += style.paint("  " + pad_right("", 20) + wrap("against " + engine.truth, style.width - 22, 22),
                         Ink::Dim) +
             "\n";
    if (engine.front.empty())
      out += style.paint("  " + pad_right(engine.engine, 20) + wrap(engine.why_none, style.width - 22, 22),
                         Ink::Dim) +
             "\n";
  }
  return out;
}

// Formats one column per decade, the best of each coloured if errors of different engines can be ranked.
template <class Value, class Text>
std::string decades(const SceneTrade& trade, const std::string& title, std::span<const double> columns,
                    const Style& style, Value value, Text heading, Text cell) {
  std::string out = style.paint(fmt::format("  {:<20}", title), Ink::Dim);
  for (const double column : columns) out += style.paint(pad_left(heading(column), 10), Ink::Dim);
  out += "\n";
  std::vector<double> best(columns.size(), INFINITY);
  for (const EngineTrade& engine : trade.engines)
    for (std::size_t i = 0; trade.one_truth && i < columns.size(); ++i)
      if (const auto now = value(engine, columns[i])) best[i] = std::min(best[i], *now);
  for (const EngineTrade& engine : trade.engines) {
    if (engine.front.empty()) continue;
    out += fmt::format("  {:<20}", engine.engine);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::optional<double> now = value(engine, columns[i]);
      const std::string text = now ? cell(*now) : "-";
      out += pad_left("", 10 - static_cast<int>(text.size())) +
             style.paint(text, now && trade.one_truth && *now <= best[i] ? Ink::Green : Ink::Plain);
    }
    out += "\n";
  }
  return out;
}

// Reduces the decades evenly to at most `most`.
std::vector<double> columns_of(std::vector<double> decades_found, int most) {
  const auto count = static_cast<std::size_t>(most);
  if (decades_found.size() > count) {
    std::vector<double> thinned;
    const double stride = static_cast<double>(decades_found.size() - 1) / static_cast<double>(count - 1);
    for (std::size_t i = 0; i < count; ++i)
      thinned.push_back(
          decades_found[static_cast<std::size_t>(std::lround(stride * static_cast<double>(i)))]);
    return thinned;
  }
  return decades_found;
}

std::string orders(const SceneTrade& trade) {
  std::string out;
  for (const EngineTrade& engine : trade.engines)
    if (engine.order)
      out += fmt::format("{}{} {:.1f}", out.empty() ? "" : ", ", engine.engine, engine.order->order);
  return out.empty() ? "" : "observed order in dt: " + out;
}

}  // namespace

std::string front_table(std::span<const Result> rows, const MetricField* metric, const Style& style) {
  if (rows.empty()) return "";
  const SceneTrade trade = trade_of(rows, metric);
  const MetricField& judged = *trade.metric;
  std::string out = style.paint(trade.label, Ink::Bold) +
                    style.paint(fmt::format("  {}{}; {:g} s; truth: {}", judged.name, unit_of(judged),
                                            trade.duration, trade.truth)
                                    .substr(0, static_cast<std::size_t>(std::max(
                                                   20, style.width - static_cast<int>(trade.label.size())))),
                                Ink::Dim) +
                    "\n";
  out += fronts(trade, style);
  const int most = std::max(2, (style.width - 22) / 10);
  out += decades(
      trade, "cost at an error of", columns_of(trade.errors, most), style,
      [](const EngineTrade& engine, double error) { return cost_at_error(engine.front, error); },
      +[](double error) { return fmt::format("{:.0e}", error); },
      +[](double cost) { return duration_text(cost); });
  out += decades(
      trade, "error at a cost of", columns_of(trade.costs, most), style,
      [](const EngineTrade& engine, double cost) { return error_at_cost(engine.front, cost); },
      +[](double cost) { return duration_text(cost); }, +[](double error) { return figure(error); });
  if (const std::string text = orders(trade); !text.empty())
    out += "  " + wrap(text, style.width - 2, 4) + "\n";
  const auto elsewhere =
      std::count_if(rows.begin(), rows.end(), [](const Result& row) { return row.cost_left_out; });
  if (elsewhere > 0)
    out += fmt::format(
        "  the costs of {} runs are left out: measured on another kind of machine than the others\n",
        elsewhere);
  return out;
}

double overall_share(std::span<const Dominance> rows) {
  double points = 0, dominated = 0;
  for (const Dominance& row : rows) {
    if (!row.compared) continue;
    points += row.points;
    dominated += row.dominated;
  }
  return points > 0 ? dominated / points : std::numeric_limits<double>::quiet_NaN();
}

namespace {

std::string share(int part, int whole) {
  return whole == 0 ? "-" : fmt::format("{}/{} {:>3.0f} %", part, whole, std::floor(100.0 * part / whole));
}

std::string exception_text(const Dominance& row, const Dominance::Exception& point) {
  std::string out = fmt::format("{} {}: {}: {} {} at {}", row.label, row.rival, point.settings, point.metric,
                                figure(point.error), duration_text(point.cost));
  if (point.cost_ratio > 0) {
    out += fmt::format("; plumb pays {} x for this", figure(point.cost_ratio));
  } else {
    out += "; no setting of plumb is as accurate";
  }
  if (point.noise) out += ", which the noise hides";
  return out;
}

}  // namespace

std::string dominance_table(std::span<const Dominance> rows, const Style& style) {
  if (rows.empty()) return "no rival has a point: nothing to dominate\n";
  std::string out = style.paint(
                        "dominance: rival points for which some point of plumb is at least as accurate and "
                        "at least as cheap",
                        Ink::Bold) +
                    "\n";
  int width = 8;
  for (const Dominance& row : rows) width = std::max(width, static_cast<int>(row.label.size()) + 2);
  out += style.paint(fmt::format("  {:<{}}{:<18}{:>16}{:>18}{:>8}", "scene", width, "rival", "all points",
                                 "of its front", "failed"),
                     Ink::Dim) +
         "\n";
  Dominance all;
  for (const Dominance& row : rows) {
    if (!row.compared) {
      out += fmt::format("  {:<{}}{:<18}not compared: against its own limit, not plumb's truth\n", row.label,
                         width, row.rival);
      all.failed += row.failed;
      continue;
    }
    out += fmt::format("  {:<{}}{:<18}{:>16}{:>18}{:>8}\n", row.label, width, row.rival,
                       share(row.dominated, row.points), share(row.front_dominated, row.front), row.failed);
    all.points += row.points;
    all.dominated += row.dominated;
    all.front += row.front;
    all.front_dominated += row.front_dominated;
    all.failed += row.failed;
  }
  out += style.paint(
             fmt::format("  {:<{}}{:<18}{:>16}{:>18}{:>8}", "overall", width, "",
                         share(all.dominated, all.points), share(all.front_dominated, all.front), all.failed),
             Ink::Bold) +
         "\n";
  if (all.dominated == all.points) return out;
  out += style.paint("not dominated", Ink::Bold) + "\n";
  for (const Dominance& row : rows)
    for (const Dominance::Exception& point : row.exceptions)
      out += "  " + wrap(exception_text(row, point), style.width - 2, 4) + "\n";
  return out;
}

}  // namespace plumb::harness::sweep
