#include "harness/sweep/record.h"

#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/environment.h"
#include "harness/packed_file.h"
#include "harness/sweep/rows.h"

namespace plumb::harness::sweep {
namespace {

using Json = nlohmann::ordered_json;

Json sample_json(const CostSample& sample) {
  return {{"ns_per_step", sample.ns_per_step}, {"setup_ns", sample.setup_ns}, {"steps", sample.steps}};
}

CostSample sample_from(const Json& json) {
  return {json.at("ns_per_step").get<double>(), json.at("setup_ns").get<double>(),
          json.at("steps").get<int>()};
}

// Returns the facts that must not change from one part of a sweep to the next.
Json start_json(const std::vector<std::string>& engines, const std::string& settings) {
  const Environment where = environment();
  return {{"kind", "start"},
          {"engines", engines},
          {"settings", settings},
          {"plumb_version", where.plumb_version},
          {"commit", where.commit},
          {"compiler", where.compiler},
          {"flags", where.flags},
          {"cpu", where.cpu},
          {"build_type", where.build_type}};
}

void require_same(const std::string& path, const Json& then, const Json& now) {
  for (const auto& [name, value] : now.items()) {
    if (then.value(name, Json()) == value) continue;
    throw Error(Error::Kind::Value, fmt::format("file '{}'", path), name, then.value(name, Json()).dump(),
                fmt::format("belongs to another sweep: it is now {}; choose another folder with --out",
                            value.dump()));
  }
}

}  // namespace

Trial* InstanceRecord::find(const std::string& key) {
  const auto place = places.find(key);
  return place == places.end() ? nullptr : &trials[place->second];
}

void InstanceRecord::add(Trial trial) {
  const auto [place, fresh] = places.try_emplace(key_of(trial.result), trials.size());
  if (fresh) {
    trials.push_back(std::move(trial));
  } else {
    trials[place->second] = std::move(trial);
  }
}

Record::Record(const std::string& folder, const std::vector<std::string>& engines,
               const std::string& settings)
    : journal_(folder + "/sweep.jsonl") {
  const Json start = start_json(engines, settings);
  if (journal_.lines().empty()) {
    journal_.append(start.dump());
    return;
  }
  int number = 0;
  try {
    require_same(journal_.path(), Json::parse(journal_.lines().front()), start);
    for (const std::string& line : journal_.lines()) {
      ++number;
      read(line);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, fmt::format("file '{}', line {}", journal_.path(), number), "", "",
                error.what());
  }
}

void Record::read(const std::string& line) {
  const Json json = Json::parse(line);
  const auto kind = json.at("kind").get<std::string>();
  if (kind == "start") return;
  InstanceRecord& instance = instances_[json.at("label").get<std::string>()];
  if (kind == "run") {
    instance.add({result_from_json(json.at("result").dump()), sample_from(json.at("rough")), {}});
  } else if (kind == "explored") {
    instance.explored = true;
    instance.chosen = json.at("chosen").get<std::vector<std::string>>();
  } else if (kind == "cost") {
    if (Trial* trial = instance.find(json.at("key").get<std::string>()); trial != nullptr)
      trial->samples.push_back(sample_from(json));
  } else if (kind == "done") {
    instance.done = true;
  }
}

void Record::take_over(const std::string& folder, const std::set<std::string>& labels) {
  const std::string path = folder + "/sweep.jsonl";
  std::istringstream lines(read_packed_or_plain(path));
  int number = 0;
  try {
    for (std::string line; std::getline(lines, line);) {
      const Json json = Json::parse(line);
      if (++number == 1) {
        Json build = start_json({}, "");
        for (const char* name : {"engines", "settings", "cpu"}) build.erase(name);
        require_same(path, json, build);
      }
      if (json.at("kind") != "run" || !labels.contains(json.at("label").get<std::string>())) continue;
      Trial trial{result_from_json(json.at("result").dump()), sample_from(json.at("rough")), {}};
      const std::string label = json.at("label");
      if (of(label).find(key_of(trial.result)) == nullptr) ran(label, trial);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, fmt::format("file '{}', line {}", path, number), "", "", error.what());
  }
}

void Record::ran(const std::string& label, const Trial& trial) {
  // Embeds the result's own JSON, because parsing and writing it again would give the same text.
  journal_.append(fmt::format(R"({{"kind":"run","label":{},"rough":{},"result":{}}})", Json(label).dump(),
                              sample_json(trial.rough).dump(), to_json(trial.result)));
  of(label).add(trial);
}

void Record::explored(const std::string& label, const std::vector<std::string>& chosen) {
  journal_.append(Json{{"kind", "explored"}, {"label", label}, {"chosen", chosen}}.dump());
  of(label).explored = true;
  of(label).chosen = chosen;
}

void Record::costed(const std::string& label, const std::string& key, const CostSample& sample) {
  Json json{{"kind", "cost"}, {"label", label}, {"key", key}};
  json.update(sample_json(sample));
  journal_.append(json.dump());
  of(label).find(key)->samples.push_back(sample);
}

void Record::done(const std::string& label) {
  journal_.append(Json{{"kind", "done"}, {"label", label}}.dump());
  of(label).done = true;
}

}  // namespace plumb::harness::sweep
