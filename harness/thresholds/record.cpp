#include "harness/thresholds/record.h"

#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/environment.h"

namespace plumb::harness::thresholds {
namespace {

using Json = nlohmann::ordered_json;

Json environment_json() {
  const Environment where = environment();
  return {{"kind", "environment"},  {"plumb_version", where.plumb_version},
          {"commit", where.commit}, {"compiler", where.compiler},
          {"flags", where.flags},   {"build_type", where.build_type},
          {"cpu", where.cpu},       {"os", where.os},
          {"date", where.date}};
}

void require_same(const std::string& path, const Json& then) {
  const Json now = environment_json();
  for (const char* name : {"plumb_version", "commit", "compiler", "flags", "cpu"}) {
    if (then.value(name, Json()) == now.at(name)) continue;
    throw Error(Error::Kind::Value, fmt::format("file '{}'", path), name, then.value(name, Json()).dump(),
                fmt::format("was measured elsewhere: it is now {}; choose another folder with --out",
                            now.at(name).dump()));
  }
}

}  // namespace

Record::Record(const std::string& folder) : journal_(folder + "/thresholds.jsonl") {
  if (journal_.lines().empty()) journal_.append(environment_json().dump());
  int number = 0;
  for (const std::string& line : journal_.lines()) {
    ++number;
    const Json json = Json::parse(line, nullptr, false);
    const auto kind = json.is_object() ? json.value("kind", Json()) : Json();
    if (kind == "environment") {
      require_same(path(), json);
    } else if (kind == "threshold") {
      Finding finding = finding_from_json(line);
      findings_[{finding.name, finding.engine, finding.setting, finding.digits}] = std::move(finding);
    } else {
      throw Error(Error::Kind::Syntax, fmt::format("file '{}', line {}", path(), number), "", "",
                  "is not a line of thresholds.jsonl");
    }
  }
}

const Finding* Record::find(const Request& request, int digits) const {
  const auto place = findings_.find(
      {request.threshold->name, std::string(request.backend->name()), request.setting, digits});
  return place == findings_.end() ? nullptr : &place->second;
}

void Record::append(const Finding& finding) {
  journal_.append(to_json(finding));
  findings_[{finding.name, finding.engine, finding.setting, finding.digits}] = finding;
}

Searched find_missing(std::span<const Request> requests, const FindOptions& options, Record& record,
                      const std::function<void(const Progress&)>& progress) {
  std::vector<Request> missing;
  for (const Request& request : requests)
    if (record.find(request, options.digits) == nullptr) missing.push_back(request);
  Searched out;
  std::size_t ended = 0;
  progress({0, missing.size(), "thresholds"});
  find_all(missing, options, [&](std::size_t, const std::optional<Finding>& finding) {
    if (!finding) {
      out.interrupted = true;
      return;
    }
    record.append(*finding);
    progress({++ended, missing.size(), fmt::format("{} on {}", finding->name, finding->engine)});
  });
  for (const Request& request : requests)
    if (const Finding* finding = record.find(request, options.digits)) out.findings.push_back(*finding);
  return out;
}

}  // namespace plumb::harness::thresholds
