#include "harness/stress/map_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumb::harness::stress {
namespace {

using Ink = Style::Ink;

constexpr int kColumn = 7;

Ink ink_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Ok:
      return Ink::Green;
    case Verdict::Inaccurate:
    case Verdict::Refused:
      return Ink::Yellow;
    case Verdict::Skipped:
      return Ink::Dim;
    default:
      return Ink::Red;
  }
}

std::string row_name(const Cell& cell) {
  return cell.setting == "default" ? cell.engine : fmt::format("{} {}", cell.engine, cell.setting);
}

int name_width(std::span<const Cell> cells) {
  std::size_t width = 6;
  for (const Cell& cell : cells) width = std::max(width, row_name(cell).size());
  return static_cast<int>(width);
}

struct Count {
  int survived = 0, counted = 0;

  void add(const Cell& cell) {
    survived += cell.survived() ? 1 : 0;
    counted += cell.counted() ? 1 : 0;
  }
};

std::string count_text(const std::string& name, const Count& count, int width) {
  const double share = count.counted > 0 ? 100.0 * count.survived / count.counted : 0;
  return fmt::format("  {}  {:>4} of {:>4}  {:>5.1f} %\n", pad_right(name, width), count.survived,
                     count.counted, share);
}

}  // namespace

std::string value_text(double value) {
  if (value == 1.0 / 60) return "1/60";
  std::string text = fmt::format("{:.3g}", value);
  for (const char* sign : {"e+0", "e+"})
    if (const std::size_t at = text.find(sign); at != std::string::npos)
      text.replace(at, std::string(sign).size(), "e");
  if (const std::size_t at = text.find("e-0"); at != std::string::npos) text.replace(at, 3, "e-");
  return text;
}

std::string map_text(const Family& family, std::span<const Cell> cells, const Style& style) {
  std::string out = style.paint(family.name, Ink::Bold) + "  " + family.title + "\n";
  out += style.paint("  " + wrap("right is: " + family.rule, style.width - 2, 2), Ink::Dim) + "\n";
  const int width = name_width(cells);
  std::vector<double> values;
  for (const Cell& cell : cells)
    if (std::find(values.begin(), values.end(), cell.value) == values.end()) values.push_back(cell.value);
  const std::string axis =
      family.unit.empty() ? family.axis : fmt::format("{}, {}", family.axis, family.unit);
  std::string head = "  " + pad_right(axis, width);
  if (static_cast<int>(axis.size()) > width) head = "  " + axis + "\n  " + pad_right("", width);
  for (const double value : values) head += pad_left(value_text(value), kColumn);
  out += style.paint(head, Ink::Dim) + "\n";
  for (std::size_t i = 0; i < cells.size();) {
    const std::string name = row_name(cells[i]);
    out += "  " + pad_right(name, width);
    for (; i < cells.size() && row_name(cells[i]) == name; ++i) {
      const Verdict verdict = cells[i].finding.verdict;
      out += style.paint(pad_left(short_name_of(verdict), kColumn), ink_of(verdict));
    }
    out += "\n";
  }
  return out;
}

std::string legend(const Style& style) {
  std::string text;
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    text += fmt::format("{}{}: {}", i == 0 ? "" : "; ", short_name_of(verdict), meaning_of(verdict));
  }
  return style.paint(wrap(text, style.width, 0), Ink::Dim) + "\n";
}

std::string survival_text(std::span<const Cell> cells, const Style& style) {
  std::vector<std::pair<std::string, Count>> rows;
  std::map<std::string, std::set<std::string>> settings;
  std::map<std::string, std::map<std::pair<std::string, double>, Cell>> best;
  for (const Cell& cell : cells) {
    auto row =
        std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.first == row_name(cell); });
    if (row == rows.end()) row = rows.insert(rows.end(), {row_name(cell), {}});
    row->second.add(cell);
    settings[cell.engine].insert(cell.setting);
    const auto [place, fresh] = best[cell.engine].try_emplace({cell.family, cell.value}, cell);
    if (!fresh && cell.survived()) place->second = cell;
  }
  const int width = name_width(cells) + 16;
  std::string out = style.paint("cells survived", Ink::Bold) + "\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out += count_text(rows[i].first, rows[i].second, width);
    const std::string engine = rows[i].first.substr(0, rows[i].first.find(' '));
    const bool last =
        i + 1 == rows.size() || rows[i + 1].first.substr(0, rows[i + 1].first.find(' ')) != engine;
    if (!last || settings[engine].size() < 2) continue;
    Count any;
    for (const auto& [key, cell] : best[engine]) any.add(cell);
    out += count_text(engine + " in any setting", any, width);
  }
  return out;
}

}  // namespace plumb::harness::stress
