#include "harness/stress/stress.h"

#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/environment.h"
#include "harness/interrupt.h"
#include "harness/stress/run_cell.h"
#include "harness/sweep/journal.h"

namespace plumb::harness::stress {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kQuick = 3;  // every third value

Json environment_json(const StressOptions& options) {
  const Environment where = environment();
  return {{"kind", "environment"},
          {"plumb_version", where.plumb_version},
          {"commit", where.commit},
          {"compiler", where.compiler},
          {"flags", where.flags},
          {"build_type", where.build_type},
          {"cpu", where.cpu},
          {"os", where.os},
          {"date", where.date},
          {"cell_seconds", options.cell_seconds},
          {"cell_memory", options.cell_memory}};
}

/// Writes stress.jsonl: the environment, then one line per cell.
class Record {
 public:
  explicit Record(const StressOptions& options) : journal_(options.folder + "/stress.jsonl") {
    const Json now = environment_json(options);
    if (journal_.lines().empty()) {
      journal_.append(now.dump());
      return;
    }
    try {
      require_same(Json::parse(journal_.lines().front()), now);
    } catch (const nlohmann::json::exception& error) {
      throw Error(Error::Kind::Syntax, fmt::format("file '{}'", journal_.path()), "", "", error.what(), 1);
    }
    for (std::size_t i = 1; i < journal_.lines().size(); ++i) {
      try {
        // Gathered results may begin with the environment of another machine.
        if (const Json line = Json::parse(journal_.lines()[i], nullptr, false);
            line.is_object() && line.value("kind", Json()) == "environment") {
          require_same(line, now);
          continue;
        }
        keep(cell_from_json(journal_.lines()[i]));
      } catch (const Error& error) {
        throw Error(Error::Kind::Syntax, fmt::format("file '{}'", journal_.path()), "", "", error.what(),
                    static_cast<int>(i + 1));
      }
    }
  }

  const Cell* find(const std::string& key) const {
    const auto place = cells_.find(key);
    return place == cells_.end() ? nullptr : &place->second;
  }

  void add(const Cell& cell) {
    journal_.append(to_json(cell));
    keep(cell);
  }

 private:
  void keep(Cell cell) {
    std::string key = key_of(cell);
    cells_.insert_or_assign(std::move(key), std::move(cell));
  }

  void require_same(const Json& then, const Json& now) const {
    for (const auto& [name, value] : now.items()) {
      if (name == "date" || then.value(name, Json()) == value) continue;
      throw Error(Error::Kind::Value, fmt::format("file '{}'", journal_.path()), name,
                  then.value(name, Json()).dump(),
                  fmt::format("belongs to another run: it is now {}; choose another folder with --out",
                              value.dump()));
    }
  }

  sweep::Journal journal_;
  std::map<std::string, Cell> cells_;
};

std::vector<Task> tasks_of(const Family& family, const StressOptions& options) {
  std::vector<Task> out;
  for (const reference::Backend* backend : options.engines)
    for (const Setting& setting : settings_of(*backend))
      for (const double value : values_of(family, options.quick))
        out.push_back({&family, value, backend, setting});
  return out;
}

std::string key_of(const Task& task) {
  return stress::key_of(task.family->name, task.value, task.backend->name(), task.setting.name);
}

/// The missing cells of one family.
struct Part {
  const Family* family;
  std::vector<Task> tasks;
  std::size_t missing = 0;
};

class Run {
 public:
  Run(const StressOptions& options, const StressEvents& events)
      : options_(options), events_(events), record_(options) {
    for (const Family* family : options.families) {
      Part part{family, tasks_of(*family, options)};
      for (const Task& task : part.tasks) {
        if (record_.find(key_of(task)) != nullptr) continue;
        ++part.missing;
        missing_.push_back(task);
        part_of_.push_back(parts_.size());
      }
      parts_.push_back(std::move(part));
    }
    progress_.total = missing_.size();
  }

  Stressed run() {
    tell_finished();
    run_cells(missing_, options_.jobs, {options_.cell_seconds, options_.cell_memory},
              [&](std::size_t i, const Cell& cell) { take(i, cell); });
    Stressed out;
    for (const Part& part : parts_)
      for (const Task& task : part.tasks)
        if (const Cell* cell = record_.find(key_of(task)); cell != nullptr) out.cells.push_back(*cell);
    out.interrupted = interrupted();
    return out;
  }

 private:
  void take(std::size_t i, const Cell& cell) {
    record_.add(cell);
    ++progress_.done;
    progress_.what = fmt::format("{} at {:g} on {}", cell.family, cell.value, cell.engine);
    if (events_.progress) events_.progress(progress_);
    --parts_[part_of_[i]].missing;
    tell_finished();
  }

  // Reports finished families in their order.
  void tell_finished() {
    for (; reported_ < parts_.size() && parts_[reported_].missing == 0; ++reported_) {
      std::vector<Cell> cells;
      for (const Task& task : parts_[reported_].tasks) cells.push_back(*record_.find(key_of(task)));
      if (events_.finished) events_.finished(*parts_[reported_].family, cells);
    }
  }

  const StressOptions& options_;
  const StressEvents& events_;
  Record record_;
  std::vector<Part> parts_;
  std::vector<Task> missing_;
  std::vector<std::size_t> part_of_;  // of each missing task
  std::size_t reported_ = 0;          // number of parts reported so far
  Progress progress_;
};

}  // namespace

std::vector<double> values_of(const Family& family, bool quick) {
  if (!quick) return family.values;
  std::vector<double> out;
  for (std::size_t i = 0; i < family.values.size(); i += kQuick) out.push_back(family.values[i]);
  return out;
}

Stressed stress(const StressOptions& options, const StressEvents& events) {
  return Run(options, events).run();
}

}  // namespace plumb::harness::stress
