#include "harness/report/extremes.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/sweep/front.h"
#include "harness/text_file.h"

namespace plumb::harness::report {
namespace {

using stress::Cell;
using Json = nlohmann::ordered_json;

/// Calls `take` for every line of a file whose "kind" is `kind`.
void for_each_line(const std::filesystem::path& path, std::string_view kind,
                   const std::function<void(const Json&)>& take) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) return;
  const std::string subject = fmt::format("file '{}'", path.string());
  std::istringstream file(read_text(path.string()));
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty()) continue;
    try {
      const Json json = Json::parse(line);
      if (json.at("kind") == kind) take(json);
    } catch (const std::exception& error) {
      if (file.eof()) break;  // no line end: the writer was stopped within this line
      throw Error(Error::Kind::Syntax, subject, fmt::format("line {}", number), "",
                  fmt::format("is not a line of results: {}", error.what()));
    }
  }
}

std::string text_of(const Json& json, const char* name) { return json.at(name).get<std::string>(); }

/// Keeps the last item of each key, at the position of the first.
template <class Item>
class Latest {
 public:
  void add(const std::string& key, Item item) {
    const auto [place, fresh] = places_.try_emplace(key, items_.size());
    if (fresh) {
      items_.push_back(std::move(item));
    } else {
      items_[place->second] = std::move(item);
    }
  }
  std::vector<Item> take() { return std::move(items_); }

 private:
  std::map<std::string, std::size_t> places_;
  std::vector<Item> items_;
};

const std::string kAnyPlumb = "any of plumb's", kAnySetting = "any setting";

/// Returns the best cell of each scene among the engines and settings of a group, named after the group and
/// "any setting". Groups with one engine and setting are left out; an empty name is not a group.
std::vector<Cell> best_of(const std::vector<Cell>& cells,
                          const std::function<std::string(const Cell&)>& group) {
  std::map<std::string, std::set<std::string>> members;
  std::map<std::string, Cell> best;
  const auto rank = [](const Cell& cell) { return cell.survived() ? 2 : cell.counted() ? 1 : 0; };
  for (const Cell& cell : cells) {
    const std::string name = group(cell);
    if (name.empty()) continue;
    members[name].insert(cell.engine + "|" + cell.setting);
    Cell named = cell;
    named.engine = name;
    named.setting = kAnySetting;
    const auto [place, fresh] =
        best.try_emplace(fmt::format("{}|{}|{}", name, cell.family, cell.value), named);
    if (!fresh && rank(cell) > rank(place->second)) place->second = named;
  }
  std::vector<Cell> out;
  for (auto& [key, cell] : best)
    if (members[cell.engine].size() > 1) out.push_back(std::move(cell));
  return out;
}

}  // namespace

Extremes read_extremes(const std::string& folder) {
  Latest<Cell> cells;
  for_each_line(std::filesystem::path(folder) / "stress.jsonl", "cell", [&](const Json& json) {
    Cell cell = stress::cell_from_json(json.dump());
    const std::string key = key_of(cell);
    cells.add(key, std::move(cell));
  });
  Latest<std::string> thresholds;
  for_each_line(std::filesystem::path(folder) / "thresholds.jsonl", "threshold", [&](const Json& json) {
    thresholds.add(
        fmt::format("{}|{}|{}", text_of(json, "name"), text_of(json, "engine"), text_of(json, "setting")),
        json.dump());
  });
  return {cells.take(), thresholds.take()};
}

std::vector<Endurance> endurances(const std::vector<Cell>& cells) {
  std::vector<Cell> all = cells;
  for (const auto& more :
       {best_of(cells, [](const Cell& cell) { return cell.engine; }), best_of(cells, [](const Cell& cell) {
          return sweep::is_plumb(cell.engine) ? kAnyPlumb : std::string();
        })})
    all.insert(all.end(), more.begin(), more.end());
  std::vector<Endurance> out;
  for (const Cell& cell : all) {
    auto row = std::find_if(out.begin(), out.end(), [&](const Endurance& one) {
      return one.engine == cell.engine && one.setting == cell.setting;
    });
    if (row == out.end()) row = out.insert(out.end(), {.engine = cell.engine, .setting = cell.setting});
    ++row->outcomes[std::string(name_of(cell.finding.verdict))];
    if (!cell.counted()) continue;
    for (Count* count : {&row->all, &row->families[cell.family]}) {
      count->survived += cell.survived();
      ++count->total;
    }
  }
  std::map<std::string, double> worst;
  for (const Endurance& row : out) {
    const double share = row.all.total ? static_cast<double>(row.all.survived) / row.all.total : 2;
    const auto [place, fresh] = worst.try_emplace(row.engine, share);
    place->second = std::min(place->second, share);
  }
  const auto rank = [&](const Endurance& row) {
    return std::tuple(row.engine != kAnyPlumb, !sweep::is_plumb(row.engine), worst.at(row.engine),
                      row.engine);
  };
  std::stable_sort(out.begin(), out.end(),
                   [&](const Endurance& a, const Endurance& b) { return rank(a) < rank(b); });
  return out;
}

std::vector<std::string> families_of(const std::vector<Cell>& cells) {
  std::vector<std::string> out;
  for (const Cell& cell : cells)
    if (std::find(out.begin(), out.end(), cell.family) == out.end()) out.push_back(cell.family);
  return out;
}

std::string extremes_data(const Extremes& extremes) {
  Json json{{"cells", Json::array()},
            {"rules", Json::object()},
            {"endurances", Json::array()},
            {"thresholds", Json::array()}};
  const std::vector<std::string> present = families_of(extremes.cells);
  for (const stress::Family& family : stress::all())
    if (std::find(present.begin(), present.end(), family.name) != present.end())
      json["rules"][family.name] = family.rule;
  for (const Cell& cell : extremes.cells) json["cells"].push_back(Json::parse(stress::to_json(cell)));
  for (const Endurance& row : endurances(extremes.cells)) {
    Json families = Json::object();
    for (const auto& [name, count] : row.families)
      families[name] = {{"survived", count.survived}, {"total", count.total}};
    json["endurances"].push_back({{"engine", row.engine},
                                  {"setting", row.setting},
                                  {"survived", row.all.survived},
                                  {"total", row.all.total},
                                  {"families", families},
                                  {"outcomes", row.outcomes}});
  }
  for (const std::string& line : extremes.thresholds) json["thresholds"].push_back(Json::parse(line));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace plumb::harness::report
