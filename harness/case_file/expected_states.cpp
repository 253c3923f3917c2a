#include "harness/case_file/expected_states.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <utility>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "harness/case_file/expression.h"

namespace plumb::harness::case_file {
namespace {

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  std::string cell;
  bool open = false;
  for (const char c : line) {
    if (c == '"') {
      open = !open;
    } else if (c == ',' && !open) {
      cells.push_back(std::exchange(cell, ""));
    } else {
      cell += c;
    }
  }
  cells.push_back(cell);
  return cells;
}

double parse(const std::string& text, const std::string& path, const std::string& column, int line) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || stop != end || !std::isfinite(value))
    throw Error(Error::Kind::Syntax, "file " + plumb::quoted(path), column, printable(text), "is no number",
                line);
  return value;
}

// Returns the index of a column's component; -1 for t, -2 for body.
int column_of(const std::string& name, const std::string& path) {
  if (name == "t") return -1;
  if (name == "body") return -2;
  for (std::size_t c = 0; c < kStateComponents.size(); ++c)
    if (name == kStateComponents[c]) return static_cast<int>(c);
  throw Error(Error::Kind::Name, "file " + plumb::quoted(path), "", printable(name),
              "is not a column; the columns are t, body, x, y, angle, vx, vy and w", 1);
}

}  // namespace

std::vector<StateRow> states_from_csv(const std::string& text, const std::string& path) {
  std::istringstream in(text);
  std::vector<StateRow> rows;
  std::vector<int> columns;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const std::vector<std::string> cells = cells_of(line);
    if (columns.empty()) {
      for (const std::string& cell : cells) columns.push_back(column_of(cell, path));
      for (const int needed : {-1, -2})
        if (std::count(columns.begin(), columns.end(), needed) != 1)
          throw Error(Error::Kind::Syntax, "file " + plumb::quoted(path), "", "",
                      "must have one column t and one column body", number);
      continue;
    }
    if (cells.size() != columns.size())
      throw Error(Error::Kind::Syntax, "file " + plumb::quoted(path), "", printable(line),
                  "has " + std::to_string(cells.size()) + " cells where there are " +
                      std::to_string(columns.size()) + " columns",
                  number);
    StateRow row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns[i] == -2) {
        row.body = cells[i];
      } else if (columns[i] == -1) {
        row.time = parse(cells[i], path, "t", number);
      } else if (!cells[i].empty()) {
        const auto c = static_cast<std::size_t>(columns[i]);
        row.values[c] = parse(cells[i], path, kStateComponents[c], number);
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<StateRow> states_from(const Member& list) {
  std::vector<StateRow> rows;
  list.each([&](const Member& entry) {
    entry.only({"t", "body", "x", "y", "angle", "vx", "vy", "w"});
    StateRow row{.time = entry.at("t").number(), .body = entry.at("body").text()};
    for (std::size_t c = 0; c < kStateComponents.size(); ++c)
      if (entry.has(kStateComponents[c])) row.values[c] = entry.at(kStateComponents[c]).number();
    rows.push_back(std::move(row));
  });
  return rows;
}

std::vector<scenarios::Expectation> expectations_of(const std::vector<StateRow>& rows, const Scene& scene,
                                                    double duration, const StateTolerances& tolerances) {
  std::map<std::pair<std::size_t, std::size_t>, std::map<double, double>> series;  // by body and component
  for (const StateRow& row : rows) {
    const auto body = find_body(scene, row.body);
    if (!body) {
      std::vector<std::string> names;
      for (const Body& each : scene.bodies) names.push_back(each.name);
      throw Error(Error::Kind::Name, "states", "body", printable(row.body),
                  "is no body of the scene" + did_you_mean(row.body, names));
    }
    if (!(row.time >= 0) || row.time > duration)
      throw Error(Error::Kind::Value, "states", "t", shortest(row.time), "must be from 0 to the duration");
    for (std::size_t c = 0; c < row.values.size(); ++c)
      if (row.values[c] && tolerances[kind_of(c)]) series[{*body, c}][row.time] = *row.values[c];
  }
  if (series.empty())
    throw Error(Error::Kind::Value, "states", "", "",
                "have no value with a tolerance, so that nothing would be compared");
  std::vector<scenarios::Expectation> out;
  for (const auto& [key, values] : series) {
    const auto [body, c] = key;
    scenarios::Expectation expectation{.name =
                                           formula_name(scene.bodies[body].name) + "." + kStateComponents[c]};
    for (const auto& [time, value] : values) expectation.times.push_back(time);
    expectation.miss = [body = body, c = c, values = values, tolerance = *tolerances[kind_of(c)]](
                           double time, std::span<const BodyState> states) {
      return scenarios::Expectation::Miss{std::abs(component(states[body], c) - values.at(time)), tolerance};
    };
    out.push_back(std::move(expectation));
  }
  return out;
}

}  // namespace plumb::harness::case_file
