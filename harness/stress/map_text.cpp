#include "harness/stress/map_text.h"

#include <algorithm>
#include <cmath>
#include <map>
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

/// Counts the scenes that an engine survived with at least one of several settings.
class Tally {
 public:
  void add(const Cell& cell) {
    if (!cell.counted()) return;
    bool& survived = scenes_[{cell.family, cell.value}];
    survived = survived || cell.survived();
  }

  std::string line(const std::string& name, int width) const {
    const auto survived =
        std::count_if(scenes_.begin(), scenes_.end(), [](const auto& s) { return s.second; });
    const double share =
        scenes_.empty() ? 0 : 100.0 * static_cast<double>(survived) / static_cast<double>(scenes_.size());
    return fmt::format("  {}  {:>4} of {:>4}  {:>5.1f} %\n", pad_right(name, width), survived, scenes_.size(),
                       share);
  }

 private:
  std::map<std::pair<std::string, double>, bool> scenes_;
};

/// Tallies of an engine: each setting in order, and all of them together.
struct EngineTally {
  std::string engine;
  std::vector<std::pair<std::string, Tally>> settings{};
  Tally any{};

  void add(const Cell& cell) {
    any.add(cell);
    const std::string name = row_name(cell);
    auto known =
        std::find_if(settings.begin(), settings.end(), [&](const auto& s) { return s.first == name; });
    if (known == settings.end()) known = settings.insert(settings.end(), {name, {}});
    known->second.add(cell);
  }
};

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
  std::string out =
      style.paint(family.name, Ink::Bold) + "\n  " + wrap(family.title, style.width - 2, 2) + "\n";
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
  std::vector<EngineTally> engines;
  Tally plumb;
  int of_plumb = 0;
  for (const Cell& cell : cells) {
    auto known = std::find_if(engines.begin(), engines.end(),
                              [&](const EngineTally& e) { return e.engine == cell.engine; });
    if (known == engines.end()) {
      known = engines.insert(engines.end(), {cell.engine});
      of_plumb += cell.engine.starts_with("plumb") ? 1 : 0;
    }
    known->add(cell);
    if (cell.engine.starts_with("plumb")) plumb.add(cell);
  }
  constexpr int kWords = 16;  // " in any setting"
  const int width = name_width(cells) + kWords;
  std::string out = style.paint("cells survived", Ink::Bold) + "\n";
  for (const EngineTally& engine : engines) {
    for (const auto& [name, tally] : engine.settings) out += tally.line(name, width);
    if (engine.settings.size() > 1) out += engine.any.line(engine.engine + " in any setting", width);
  }
  if (of_plumb > 1) out += plumb.line("any of plumb's engines", width);
  return out;
}

}  // namespace plumb::harness::stress
