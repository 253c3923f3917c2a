#include "harness/cluster/gather.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <unordered_map>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/cluster/claim.h"
#include "harness/cluster/next_round.h"
#include "harness/hunt/kinds.h"
#include "harness/packed_file.h"
#include "harness/stress/cell.h"
#include "harness/sweep/rows.h"
#include "harness/text_file.h"
#include "harness/thresholds/finding.h"

namespace plumb::harness::cluster {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string dump(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Thrown when results cannot be written, as opposed to errors in a unit.
class CannotWrite : public Error {
  using Error::Error;
};

/// A file that replaces another when it is complete.
class Replacement {
 public:
  explicit Replacement(const fs::path& path)
      : path_(path.string()), own_(fmt::format("{}.{}.new", path.string(), getpid())) {
    file_.reset(std::fopen(own_.c_str(), "w"));
    if (!file_) fail();
  }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;
  ~Replacement() { unlink(own_.c_str()); }

  void append(const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() ||
        std::fputc('\n', file_.get()) < 0)
      fail();
  }

  void finish() {
    if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0 ||
        rename(own_.c_str(), path_.c_str()) != 0)
      fail();
  }

 private:
  [[noreturn]] void fail() {
    throw CannotWrite(
        Error::Kind::Io, fmt::format("file '{}'", path_), "", "",
        fmt::format("cannot be written: {}; the previous file is unchanged", std::strerror(errno)));
  }
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_, own_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Identity of a line, and the part of it that must stay the same when the unit is repeated.
struct Entry {
  std::string key, essence, status;
};

Entry entry_of_result(const std::string& line) {
  const Result row = result_from_json(line);
  const Json json = Json::parse(line);
  return {sweep::key_of(row), dump(json.at("metrics")) + std::string(name_of(row.status)),
          std::string(name_of(row.status))};
}

Entry entry_of_cell(const std::string& line) {
  const stress::Cell cell = stress::cell_from_json(line);
  const std::string outcome(name_of(cell.finding.verdict));
  return {stress::key_of(cell), fmt::format("{} {}", outcome, cell.finding.figure), outcome};
}

Entry entry_of_threshold(const std::string& line) {
  const thresholds::Finding one = thresholds::finding_from_json(line);
  const std::string outcome(name_of(one.outcome));
  return {fmt::format("{}|{}|{}|{}", one.name, one.engine, one.setting, one.digits),
          fmt::format("{} {}", outcome, one.found.value_or(0)), outcome};
}

struct Format {
  const char* file;
  Entry (*entry)(const std::string& line);
};
constexpr Format kFormats[] = {{"results.jsonl", entry_of_result},
                               {"stress.jsonl", entry_of_cell},
                               {"thresholds.jsonl", entry_of_threshold}};

// Calls `take` for each whole line; returns true if the last line is truncated.
bool for_each_line(const fs::path& path, const std::function<void(const std::string&)>& take) {
  const std::string text = read_packed_or_plain(path.string());
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    if (end > begin) take(text.substr(begin, end - begin));
  return begin < text.size();
}

// Adds the kind of machine to a line's environment, if it is not the processor's name.
std::string with_machine(const std::string& line, const Machine& machine) {
  if (machine.kind == machine.cpu) return line;
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return line;
  if (json.contains("environment")) json["environment"]["machine"] = machine.kind;
  if (json.value("kind", Json()) == "environment") json["machine"] = machine.kind;
  return dump(json);
}

// Returns an environment without its date.
std::string place_of(const std::string& line) {
  Json json = Json::parse(line, nullptr, false);
  if (json.is_object()) json.erase("date");
  return dump(json);
}

/// Merges the units' files of one format.
class Merger {
 public:
  Merger(const Format& format, const std::string& folder, const fs::path& out, Gathered& gathered)
      : format_(format), folder_(folder), out_(out / format.file), gathered_(gathered) {}

  void add(const Done& done) {
    const fs::path path = fs::path(path_in(folder_, "done", done.number)) / format_.file;
    if (!is_packed_or_plain(path.string())) return;
    std::string environment;
    const auto take = [&](const std::string& line) {
      if (is_environment(line)) {
        environment = with_machine(line, done.machine);
      } else {
        add_line(with_machine(line, done.machine), environment, done.number);
      }
    };
    try {
      if (for_each_line(path, take)) ++gathered_.cut_short;
    } catch (const CannotWrite&) {
      throw;
    } catch (const std::exception& error) {
      gathered_.survey.damaged[done.number] = fmt::format("{}: {}", format_.file, error.what());
    }
  }

  void finish() {
    if (!file_) return;
    file_->finish();
    gathered_.lines[format_.file] = seen_.size();
  }

 private:
  static bool is_environment(const std::string& line) {
    if (!line.starts_with(R"({"kind":)")) return false;  // results have no kind; parsing would take long
    const Json json = Json::parse(line, nullptr, false);
    return json.is_object() && json.value("kind", Json()) == "environment";
  }

  void add_line(const std::string& line, const std::string& environment, int unit) {
    const Entry entry = format_.entry(line);
    const std::size_t essence = std::hash<std::string>{}(entry.essence);
    const auto [place, fresh] = seen_.try_emplace(entry.key, essence, unit);
    if (!fresh) {
      ++gathered_.twice;
      if (place->second.first != essence)
        gathered_.differ.push_back(
            fmt::format("{} in units {} and {}", entry.key, place->second.second, unit));
      return;
    }
    if (!file_) file_ = std::make_unique<Replacement>(out_);
    if (!environment.empty() && place_of(environment) != place_) {
      place_ = place_of(environment);
      file_->append(environment);
    }
    file_->append(line);
    ++gathered_.statuses[entry.status];
  }

  const Format& format_;
  std::string folder_;
  fs::path out_;
  Gathered& gathered_;
  std::unique_ptr<Replacement> file_;
  std::string place_;
  std::unordered_map<std::string, std::pair<std::size_t, int>> seen_;
};

// Merges hunts of several seeds; their scenes are numbered in one sequence.
void gather_hunts(const std::string& folder, const fs::path& out, Gathered& gathered) {
  std::vector<hunt::Found> findings;
  for (const Done& done : gathered.survey.done) {
    const fs::path path = fs::path(path_in(folder, "done", done.number)) / "hunt.jsonl";
    if (!is_packed_or_plain(path.string())) continue;
    gathered.hunted = true;
    const std::uint64_t before = gathered.hunt.scenes;
    const auto take = [&](const std::string& line) {
      const Json json = Json::parse(line);
      if (json.contains("scene")) ++gathered.hunt.scenes;
      gathered.hunt.runs += json.value("runs", std::uint64_t{0});
      gathered.hunt.skipped += json.value("skipped", std::uint64_t{0});
      if (json.contains("finding"))
        findings.push_back({before + json.at("scene_of").get<std::uint64_t>(),
                            hunt::finding_from_json(dump(json["finding"]))});
    };
    try {
      if (for_each_line(path, take)) ++gathered.cut_short;
    } catch (const std::exception& error) {
      gathered.survey.damaged[done.number] = fmt::format("hunt.jsonl: {}", error.what());
    }
  }
  if (!gathered.hunted) return;
  gathered.hunt.kinds = hunt::kinds_of(findings);
  const std::string fresh = fmt::format("{}.{}.new", (out / "findings").string(), getpid());
  std::error_code ignored;
  fs::create_directories(fresh);
  for (const hunt::Kind& kind : gathered.hunt.kinds) hunt::write_finding(kind.smallest, fresh, kind.file);
  fs::remove_all(out / "findings", ignored);
  fs::rename(fresh, out / "findings", ignored);
  write_whole((out / "kinds.json").string(), hunt::kinds_json(gathered.hunt) + "\n");
}

// Copies the files that are not lists of runs: pages and pictures.
void copy_files(const std::string& folder, const Done& done, const fs::path& out) {
  for (const auto& [name, bytes] : done.bytes)
    write_whole((out / name).string(), read_text(path_in(folder, "done", done.number) + "/" + name));
}

// Reports a unit whose files have changed in length since it was completed.
std::string shortened(const std::string& folder, const Done& done) {
  for (const auto& [name, bytes] : done.bytes) {
    std::error_code code;
    const std::uintmax_t now = fs::file_size(fs::path(path_in(folder, "done", done.number)) / name, code);
    if (code) return fmt::format("{} is gone", name);
    if (now != bytes) return fmt::format("{} has {} bytes of {}", name, now, bytes);
  }
  return "";
}

void use_machine(const Done& done, Survey& out) {
  MachineUse& use = out.machines[done.machine.kind];
  const double ms = done.after.median_ms;
  use.fastest_ms = use.units == 0 ? ms : std::min(use.fastest_ms, ms);
  use.slowest_ms = std::max(use.slowest_ms, ms);
  ++use.units;
  use.hosts.insert(done.machine.host);
}

}  // namespace

std::vector<int> Survey::missing() const {
  std::vector<int> out = free;
  out.insert(out.end(), running.begin(), running.end());
  for (const auto& [kind, numbers] : failed) out.insert(out.end(), numbers.begin(), numbers.end());
  for (const auto& [number, why] : damaged)
    if (std::none_of(done.begin(), done.end(), [n = number](const Done& one) { return one.number == n; }))
      out.push_back(number);
  std::sort(out.begin(), out.end());
  return out;
}

Survey survey(const std::string& folder, const Plan& plan, double expiry) {
  Survey out;
  const std::set<int> done = numbers_in(folder, "done"), claimed = numbers_in(folder, "claims"),
                      failed = numbers_in(folder, "failed");
  double estimated = 0, left = 0, calibrating = 0;
  for (const Unit& unit : plan.units) {
    if (done.contains(unit.number)) {
      try {
        out.done.push_back(read_done(folder, unit.number));
      } catch (const Error& error) {
        out.damaged[unit.number] = error.what();
        left += unit.seconds;
        continue;
      }
      const Done& one = out.done.back();
      if (const std::string why = shortened(folder, one); !why.empty()) out.damaged[unit.number] = why;
      use_machine(one, out);
      out.seconds_done += one.seconds;
      estimated += unit.seconds;
      calibrating += 1e-3 * (one.before.median_ms * one.before.repetitions +
                             one.after.median_ms * one.after.repetitions);
      continue;
    }
    left += unit.seconds;
    if (claimed.contains(unit.number) && is_claimed(folder, unit.number, expiry)) {
      out.running.push_back(unit.number);
    } else if (const std::optional<Failure> failure =
                   failed.contains(unit.number) ? read_failure(folder, unit.number) : std::nullopt) {
      out.failed[failure->kind].push_back(unit.number);
    } else {
      out.free.push_back(unit.number);
    }
  }
  for (const auto& [number, best] : least_disturbed(plan, out))
    if (plan.unit(number).cost && best->noisy()) out.noisy.push_back(number);
  out.seconds_left = estimated > 0 ? left * out.seconds_done / estimated : left;
  const auto open = static_cast<double>(plan.units.size() - out.done.size());
  if (!out.done.empty()) out.seconds_left += open * calibrating / static_cast<double>(out.done.size());
  return out;
}

Gathered gather(const std::string& folder, const Plan& plan, const std::string& out, double expiry) {
  std::error_code code;
  fs::create_directories(out, code);
  if (code)
    throw Error(Error::Kind::Io, fmt::format("folder '{}'", out), "", "",
                fmt::format("cannot be created: {}; choose another with --out", code.message()));
  const std::string lock_path = (fs::path(out) / ".lock").string();
  const int lock = open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock >= 0) flock(lock, LOCK_EX);
  const std::unique_ptr<const int, void (*)(const int*)> unlock(&lock, [](const int* file) {
    if (*file >= 0) close(*file);
  });
  remove_dead_claims(folder, expiry);
  Gathered gathered{.survey = survey(folder, plan, expiry)};
  // If a unit was measured several times, the least disturbed attempt counts.
  std::vector<const Done*> counted;
  for (const auto& [number, best] : least_disturbed(plan, gathered.survey)) counted.push_back(best);
  for (const Format& format : kFormats) {
    Merger merger(format, folder, out, gathered);
    for (const Done* done : counted) merger.add(*done);
    merger.finish();
  }
  gather_hunts(folder, out, gathered);
  for (const Done* done : counted)
    if (plan.unit(done->number).arguments.front() == "reality") copy_files(folder, *done, out);
  write_whole((fs::path(out) / "gathered.json").string(), to_json(plan, gathered));
  return gathered;
}

namespace {

Json survey_json(const Plan& plan, const Survey& survey) {
  Json machines = Json::array(), failed = Json::object(), damaged = Json::object();
  for (const auto& [kind, use] : survey.machines)
    machines.push_back({{"kind", kind},
                        {"units", use.units},
                        {"hosts", use.hosts},
                        {"calibration_ms", {use.fastest_ms, use.slowest_ms}}});
  for (const auto& [kind, numbers] : survey.failed) failed[kind] = numbers;
  for (const auto& [number, why] : survey.damaged) damaged[std::to_string(number)] = why;
  return {{"units", plan.units.size()},
          {"done", survey.done.size()},
          {"free", survey.free},
          {"running", survey.running},
          {"failed", failed},
          {"damaged", damaged},
          {"noisy", survey.noisy},
          {"machines", machines},
          {"seconds_done", survey.seconds_done},
          {"seconds_left", survey.seconds_left}};
}

}  // namespace

std::string to_json(const Plan& plan, const Survey& survey) {
  return dump(survey_json(plan, survey), 2) + "\n";
}

std::string to_json(const Plan& plan, const Gathered& gathered) {
  Json json = survey_json(plan, gathered.survey);
  json["lines"] = gathered.lines;
  json["statuses"] = gathered.statuses;
  json["cut_short"] = gathered.cut_short;
  json["twice"] = gathered.twice;
  json["differ"] = gathered.differ;
  if (gathered.hunted)
    json["hunt"] = {{"scenes", gathered.hunt.scenes},
                    {"runs", gathered.hunt.runs},
                    {"kinds", gathered.hunt.kinds.size()}};
  return dump(json, 2) + "\n";
}

}  // namespace plumb::harness::cluster
