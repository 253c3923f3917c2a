#include "harness/table.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cost.h"

namespace plumb::harness {
namespace {

using Ink = Style::Ink;

constexpr int kEngineWidth = 19, kFigureWidth = 10, kVerdictWidth = 30;

/// A column of figures.
struct Column {
  std::string title, unit;
  std::function<std::optional<double>(const Result&)> value;
  std::function<std::string(double)> text;
  int priority = 0;  // the highest is dropped first on a narrow terminal
  bool is_cost = false;
};

Column metric_column(const char* title, const char* unit, std::optional<double> Metrics::*member,
                     int priority) {
  return {title, unit, [member](const Result& result) { return result.metrics.*member; }, figure, priority};
}

std::vector<Column> all_columns() {
  return {metric_column("position", "m", &Metrics::position_error, 1),
          metric_column("angle", "rad", &Metrics::angle_error, 6),
          metric_column("velocity", "m/s", &Metrics::velocity_error, 4),
          metric_column("energy", "drift", &Metrics::energy_drift, 2),
          metric_column("joint gap", "m", &Metrics::joint_gap, 3),
          metric_column("overlap", "m", &Metrics::penetration, 5),
          metric_column("expected", "of tol.", &Metrics::expected_miss, 0),
          {"cost", "a step",
           [](const Result& result) {
             return result.cost ? std::optional(result.cost->ns_per_step) : std::nullopt;
           },
           duration_text, 0, true}};
}

// Returns the columns with any figures, as many as fit.
std::vector<Column> columns_for(std::span<const Result> results, int width) {
  std::vector<Column> columns;
  for (Column& column : all_columns()) {
    const bool used = std::any_of(results.begin(), results.end(),
                                  [&](const Result& r) { return column.value(r).has_value(); });
    if (used) columns.push_back(std::move(column));
  }
  const auto total = [&] {
    return kEngineWidth + kFigureWidth * static_cast<int>(columns.size()) + kVerdictWidth;
  };
  while (columns.size() > 1 && total() > width) {
    columns.erase(std::max_element(columns.begin(), columns.end(),
                                   [](const Column& a, const Column& b) { return a.priority < b.priority; }));
  }
  return columns;
}

double best_of(std::span<const Result> results, const Column& column) {
  double best = std::numeric_limits<double>::infinity();
  for (const Result& result : results)
    if (const auto value = column.value(result);
        value && result.status == Status::Ok && !(column.is_cost && result.foreign_cost))
      best = std::min(best, *value);
  return best;
}

/// A footnote: engines that miss the same checks for the same reason share one, with the first one's figures.
struct Note {
  std::string engines, text, key;
};

/// Summary of a row's checks, with the footnote that explains it.
struct Verdict {
  std::string text;
  Ink ink = Ink::Plain;
  std::string note{};
};

// Returns every known limit of a result with the checks that it covers: equal for results that may share a
// footnote.
std::string key_of(const Result& result) {
  if (!result.unexpected.empty() || result.status != Status::Ok) return "only " + result.engine;
  std::string key;
  for (const Check& check : result.checks)
    if (!check.known_limit.empty()) key += check.name + ": " + check.known_limit + "\n";
  return key;
}

// Returns the letter of the note, adding it if there is none like it.
char refer_to(std::vector<Note>& notes, const Result& result, const std::string& text) {
  const std::string key = key_of(result);
  const auto same =
      std::find_if(notes.begin(), notes.end(), [&](const Note& note) { return note.key == key; });
  const auto letter = static_cast<char>('a' + (same - notes.begin()) % 26);
  if (same == notes.end()) {
    notes.push_back({result.engine, text, key});
  } else {
    same->engines += ", " + result.engine;
  }
  return letter;
}

std::string kind_name(Oracle oracle) {
  switch (oracle) {
    case Oracle::Exact:
      return "truth";
    case Oracle::Discrete:
      return "scheme";
    case Oracle::Invariant:
      return "laws";
    case Oracle::Consensus:
    case Oracle::Self:
      break;
  }
  return std::string(name_of(oracle));
}

// Lists the kinds of checks that all passed, or of which some failed.
std::string kinds(const Result& result, bool passed) {
  std::string text;
  for (const Oracle oracle : {Oracle::Exact, Oracle::Discrete, Oracle::Invariant, Oracle::Self}) {
    bool any = false, all = true;
    for (const Check& check : result.checks) {
      if (check.oracle != oracle) continue;
      any = true;
      all = all && check.pass;
    }
    if (any && all == passed) text += (text.empty() ? "" : " ") + kind_name(oracle);
  }
  return text;
}

std::string misses(const Result& result, bool known) {
  std::string text;
  for (const Check& check : result.checks) {
    if (check.pass || check.known_limit.empty() == known) continue;
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {} (bound {})", check.name, figure(check.value), figure(check.tolerance));
  }
  return text;
}

std::string note_of(const Result& result) {
  std::string note;
  const std::string declared = misses(result, true);
  if (!declared.empty()) {
    std::string reason;
    for (const Check& check : result.checks) {
      if (check.known_limit.empty() || reason.find(check.known_limit) != std::string::npos) continue;
      reason += (reason.empty() ? "" : "; ") + check.known_limit;
    }
    note = fmt::format("known limit: {}: {}", declared, reason);
  }
  for (const std::string& sentence : result.unexpected)
    note += (note.empty() ? "" : note.ends_with('.') ? " " : ". ") + ("UNEXPECTED: " + sentence);
  return note;
}

Verdict verdict(const Result& result) {
  const std::size_t others = result.agrees_with.size() + result.disagrees_with.size();
  std::string with;
  if (others > 0) with = fmt::format("{}/{}", result.agrees_with.size(), others);
  const std::string missed = kinds(result, false);
  Verdict out;
  out.note = note_of(result);
  if (missed.empty() && result.unexpected.empty()) {
    const std::string held = kinds(result, true);
    out.text = "yes: " + held + (with.empty() ? "" : ", " + with);
    out.ink = Ink::Green;
    if (held.empty()) out = {"not checked", Ink::Dim, ""};
  } else {
    out.text = fmt::format("{}: {}{}", result.unexpected.empty() ? "no" : "NO",
                           missed.empty() ? "limit gone" : missed, with.empty() ? "" : ", " + with);
    out.ink = result.unexpected.empty() ? Ink::Yellow : Ink::Red;
  }
  return out;
}

std::string heading(const Result& first, const Style& style) {
  std::string text = style.paint(first.label, Ink::Bold);
  text += style.paint(fmt::format("  {:g} s at dt = {} s", first.duration, dt_text(first.dt)), Ink::Dim);
  if (!first.truth.empty()) {
    const int room = style.width - 30 - static_cast<int>(first.label.size());
    std::string source = first.truth;
    if (room > 20 && static_cast<int>(source.size()) > room)
      source = source.substr(0, static_cast<std::size_t>(room - 3)) + "...";
    if (room > 20) text += style.paint(", truth: " + source, Ink::Dim);
  }
  return text + "\n";
}

std::string header(const std::vector<Column>& columns, const Style& style) {
  std::string titles = pad_right("", kEngineWidth), units = titles;
  for (const Column& column : columns) {
    titles += pad_left(column.title, kFigureWidth);
    units += pad_left(column.unit, kFigureWidth);
  }
  titles += "  agrees with";
  return style.paint(titles, Ink::Dim) + "\n" + style.paint(units, Ink::Dim) + "\n";
}

std::string row(const Result& result, const std::vector<Column>& columns, const std::vector<double>& best,
                const Style& style, std::vector<Note>& notes) {
  std::string line = pad_right(result.engine, kEngineWidth);
  if (!result.ran()) {
    const Ink ink = result.status == Status::Skipped ? Ink::Dim : Ink::Red;
    const std::string text = fmt::format("{}: {}", name_of(result.status), result.reason);
    return line + style.paint(wrap("  " + text, style.width - kEngineWidth, kEngineWidth + 2), ink) + "\n";
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto value = columns[i].value(result);
    std::string text = value ? columns[i].text(*value) : "-";
    const bool foreign = columns[i].is_cost && result.foreign_cost;
    if (columns[i].is_cost && value && is_noisy(*result.cost)) text = "~" + text;
    if (foreign && value) text = "*" + text;
    const bool is_best = value && *value <= best[i] && result.status == Status::Ok && !foreign;
    line += pad_left("", kFigureWidth - static_cast<int>(text.size())) +
            style.paint(text, is_best ? Ink::Green : Ink::Plain);
  }
  Verdict said = verdict(result);
  if (result.status == Status::Diverged) {
    said.text = "diverged";
    said.note = result.reason + (said.note.empty() ? "" : "; " + said.note);
  }
  if (!said.note.empty()) said.text += fmt::format(" ({})", refer_to(notes, result, said.note));
  return line + "  " + style.paint(said.text, said.ink) + "\n";
}

// Lists the engines that did not run the scene, those with the same reason together.
std::string skips(std::span<const Result> results, const Style& style) {
  std::vector<std::pair<std::string, std::string>> reasons;  // a reason and its engines
  for (const Result& result : results) {
    if (result.status != Status::Skipped) continue;
    const auto same = std::find_if(reasons.begin(), reasons.end(),
                                   [&](const auto& each) { return each.first == result.reason; });
    if (same == reasons.end()) {
      reasons.emplace_back(result.reason, result.engine);
    } else {
      same->second += ", " + result.engine;
    }
  }
  std::string text;
  for (const auto& [reason, engines] : reasons)
    text += fmt::format("{}{} ({})", text.empty() ? "skipped: " : "; ", engines, reason);
  return text.empty() ? "" : "  " + style.paint(wrap(text, style.width - 2, 11), Ink::Dim) + "\n";
}

}  // namespace

std::string table(std::span<const Result> results, const Style& style) {
  if (results.empty()) return "";
  const std::vector<Column> columns = columns_for(results, style.width);
  std::vector<double> best;
  for (const Column& column : columns) best.push_back(best_of(results, column));
  std::string out = heading(results.front(), style) + header(columns, style);
  std::vector<Note> notes;
  for (const Result& result : results)
    if (result.status != Status::Skipped) out += row(result, columns, best, style, notes);
  out += skips(results, style);
  for (std::size_t i = 0; i < notes.size(); ++i) {
    const std::string note =
        fmt::format("({}) {}: {}", static_cast<char>('a' + i % 26), notes[i].engines, notes[i].text);
    out += "  " + style.paint(wrap(note, style.width - 2, 6), Ink::Dim) + "\n";
  }
  return out;
}

}  // namespace plumb::harness
