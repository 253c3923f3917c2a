#include "harness/cluster/work_folder.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/environment.h"
#include "harness/text_file.h"
#include "reference/backend.h"

namespace plumb::harness::cluster {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string hash_of_file(const std::string& path) {
  const std::string text = read_text(path);
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

Json program_json(const Program& program) {
  return {{"path", program.path},
          {"hash", program.hash},
          {"version", program.version},
          {"commit", program.commit},
          {"engines", program.engines}};
}

Json unit_json(const Unit& unit) {
  Json out{{"unit", unit.number},
           {"arguments", unit.arguments},
           {"seconds", unit.seconds},
           {"measured", unit.measured},
           {"cost", unit.cost}};
  if (unit.repeats > 0) {
    out["repeats"] = unit.repeats;
    out["attempt"] = unit.attempt;
    out["avoid"] = unit.avoid;
  }
  if (!unit.then.empty()) {
    out["then"] = unit.then;
    out["then_seconds"] = unit.then_seconds;
  }
  return out;
}

/// Locks a folder during its lifetime, if the file system has locks.
class Lock {
 public:
  explicit Lock(const std::string& path) : file_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() {
    if (file_ >= 0) close(file_);
  }

 private:
  int file_;
};

void make_folders(const std::string& folder) {
  for (const char* part : {"claims", "doing", "done", "failed"})
    make_folder((fs::path(folder) / part).string(), "choose another");
}

std::vector<Unit> units_in(const std::string& path) {
  std::vector<Unit> out;
  const std::string text = read_text(path, "`plumb plan` writes it; plan again");
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const Json json = Json::parse(text.substr(begin, end - begin));
    out.push_back({.number = json.at("unit"),
                   .arguments = json.at("arguments"),
                   .seconds = json.at("seconds"),
                   .measured = json.at("measured"),
                   .cost = json.at("cost"),
                   .repeats = json.value("repeats", 0),
                   .attempt = json.value("attempt", 0),
                   .avoid = json.value("avoid", std::vector<std::string>{}),
                   .then = json.value("then", std::vector<std::string>{}),
                   .then_seconds = json.value("then_seconds", 0.0)});
    if (out.back().number != static_cast<int>(out.size()))
      throw Error(Error::Kind::Value, fmt::format("file '{}'", path), "unit",
                  std::to_string(out.back().number), "is not the number of its line",
                  static_cast<int>(out.size()));
  }
  return out;
}

}  // namespace

const Unit& Plan::unit(int number) const {
  if (number < 1 || number > static_cast<int>(units.size()))
    throw Error(Error::Kind::Value, "a unit", "", std::to_string(number),
                fmt::format("is not in the plan: its units are 1 to {}", units.size()));
  return units[static_cast<std::size_t>(number - 1)];
}

bool Plan::measures_cost(const std::vector<int>& numbers) const {
  return std::any_of(numbers.begin(), numbers.end(), [&](int number) { return unit(number).cost; });
}

Program this_program() {
  const Environment where = environment();
  std::error_code code;
  Program out{.path = fs::read_symlink("/proc/self/exe", code).string(),
              .hash = hash_of_file("/proc/self/exe"),
              .version = where.plumb_version,
              .commit = where.commit};
  for (const reference::Backend* backend : reference::backends())
    if (const reference::Identity identity = backend->identity(); identity.available)
      out.engines[std::string(backend->name())] = identity.version;
  return out;
}

void require_same_program(const std::string& folder, const Plan& plan, const Program& now) {
  const auto refuse = [&](const std::string& what, const std::string& then, const std::string& is) {
    throw Error(Error::Kind::Value, fmt::format("the plan in '{}'", folder), what, then,
                fmt::format("is from another program: {} is '{}' here; run '{}', or make a plan in another "
                            "folder with this program",
                            what, is, plan.program.path));
  };
  if (plan.program.hash != now.hash) refuse("hash", plan.program.hash, now.hash);
  for (const auto& [engine, version] : plan.program.engines) {
    const auto here = now.engines.find(engine);
    const std::string is = here == now.engines.end() ? "not installed" : here->second;
    if (is != version) refuse("the version of " + engine, version, is);
  }
}

Plan read_plan(const std::string& folder) {
  const std::string path = (fs::path(folder) / "plan.json").string();
  const std::string text = read_text(path, "`plumb plan` makes a folder of work");
  try {
    const Json json = Json::parse(text);
    const Json& program = json.at("program");
    Plan out{.program = {program.at("path"), program.at("hash"), program.at("version"), program.at("commit"),
                         program.at("engines").get<std::map<std::string, std::string>>()},
             .directory = json.at("directory"),
             .commands = json.at("commands")};
    out.units = units_in((fs::path(folder) / "units.jsonl").string());
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, fmt::format("the plan in '{}'", folder), "", "", error.what());
  }
}

int add_to_plan(const std::string& folder, Plan plan) {
  make_folders(folder);
  const Lock lock((fs::path(folder) / ".lock").string());
  const std::string path = (fs::path(folder) / "plan.json").string();
  std::vector<Unit> units;
  std::error_code code;
  if (fs::exists(path, code) && fs::exists(fs::path(folder) / "units.jsonl", code)) {
    Plan before = read_plan(folder);
    require_same_program(folder, before, plan.program);
    units = std::move(before.units);
    for (auto& command : plan.commands)
      if (std::find(before.commands.begin(), before.commands.end(), command) == before.commands.end())
        before.commands.push_back(std::move(command));
    plan.commands = std::move(before.commands);
    plan.directory = before.directory;
  }
  std::set<std::pair<std::vector<std::string>, int>> there;
  for (const Unit& unit : units) there.emplace(unit.arguments, unit.attempt);
  const std::size_t before = units.size();
  for (Unit& unit : plan.units) {
    if (!there.emplace(unit.arguments, unit.attempt).second) continue;
    unit.number = static_cast<int>(units.size()) + 1;
    units.push_back(std::move(unit));
  }
  std::string lines;
  for (const Unit& unit : units) lines += dump(unit_json(unit)) + "\n";
  write_whole((fs::path(folder) / "units.jsonl").string(), lines);
  write_whole(path, dump({{"plumb_plan", 1},
                          {"program", program_json(plan.program)},
                          {"directory", plan.directory},
                          {"commands", plan.commands},
                          {"made", time_text()}},
                         2) +
                        "\n");
  return static_cast<int>(units.size() - before);
}

std::string name_of_unit(int number) { return fmt::format("{:05}", number); }

std::string path_in(const std::string& folder, const std::string& part, int number) {
  return (fs::path(folder) / part / name_of_unit(number)).string();
}

std::set<int> numbers_in(const std::string& folder, const std::string& part) {
  std::set<int> out;
  std::error_code code;
  for (fs::directory_iterator at(fs::path(folder) / part, code), end; !code && at != end;
       at.increment(code)) {
    const std::string name = at->path().stem().string();
    int number = 0;
    const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && stop == name.data() + name.size()) out.insert(number);
  }
  return out;
}

std::string to_json(const Done& done) {
  return dump({{"unit", done.number},
               {"seconds", done.seconds},
               {"code", done.code},
               {"machine", Json::parse(to_json(done.machine))},
               {"before", Json::parse(to_json(done.before))},
               {"after", Json::parse(to_json(done.after))},
               {"noisy", done.noisy()},
               {"began", done.began},
               {"ended", done.ended},
               {"bytes", done.bytes}},
              2) +
         "\n";
}

Done read_done(const std::string& folder, int number) {
  const std::string path = path_in(folder, "done", number) + "/unit.json";
  const std::string text = read_text(path);
  try {
    const Json json = Json::parse(text);
    return {.number = json.at("unit"),
            .seconds = json.at("seconds"),
            .code = json.at("code"),
            .machine = machine_from_json(json.at("machine").dump()),
            .before = calibration_from_json(json.at("before").dump()),
            .after = calibration_from_json(json.at("after").dump()),
            .began = json.at("began"),
            .ended = json.at("ended"),
            .bytes = json.at("bytes").get<std::map<std::string, std::uintmax_t>>()};
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, fmt::format("file '{}'", path), "", "", error.what());
  }
}

std::string to_json(const Failure& failure) {
  return dump({{"attempts", failure.attempts},
               {"kind", failure.kind},
               {"message", failure.message},
               {"host", failure.host}}) +
         "\n";
}

std::optional<Failure> read_failure(const std::string& folder, int number) {
  std::ifstream file(path_in(folder, "failed", number) + ".json");
  const Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) return {};
  return Failure{json.value("attempts", 0), json.value("kind", ""), json.value("message", ""),
                 json.value("host", "")};
}

std::string ranges(const std::vector<int>& numbers) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    out += fmt::format("{}{}", out.empty() ? "" : ",", numbers[i]);
    if (last > i) out += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return out;
}

std::string time_text() { return environment().date; }

}  // namespace plumb::harness::cluster
