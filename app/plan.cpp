#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/compare_results.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/plan.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/cluster/next_round.h"
#include "harness/cluster/work.h"
#include "harness/cluster/work_folder.h"
#include "harness/packed_file.h"
#include "harness/stress/settings.h"
#include "harness/stress/stress.h"
#include "harness/sweep/sweep.h"
#include "harness/text_file.h"
#include "harness/thresholds/threshold.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;
namespace fs = std::filesystem;

// Default estimates of durations, s, on one core of 2020: a run of `compare` with its cost and without, a
// cell of `stress`, a search of `thresholds`, a scene of `hunt` on an engine.
constexpr double kRun = 0.3, kRunAlone = 0.1, kCell = 1, kSearch = 20, kScene = 0.2;
constexpr double kBudget = 540, kMinutes = 10;  // the commands' own defaults

/// A command line that is divided into units.
struct Given {
  std::string command;
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> options;  ///< by name without dashes; a flag has no values

  bool has(const std::string& name) const { return options.contains(name); }
  std::string value(const std::string& name, const std::string& otherwise) const {
    const auto found = options.find(name);
    return found == options.end() || found->second.empty() ? otherwise : found->second.front();
  }
};

/// Smallest part that a unit can consist of.
struct Piece {
  std::string name, engine;  ///< engine: empty if all of the command's
  double seconds = 0;
  bool measured = false;
};

constexpr const char* kCommands = "compare, sweep, stress, thresholds, hunt or reality";

// Parses a command line with the options of the command itself, so that both accept the same.
Given parse(std::vector<std::string> words) {
  CLI::App app("plumb", "plumb");
  Action ignored;
  for (const auto add : {add_compare, add_sweep, add_stress, add_thresholds, add_hunt, add_reality})
    add(app, ignored);
  if (words.empty()) throw UsageError(fmt::format("plan takes a command after the folder: {}", kCommands));
  const std::string command = words.front();
  CLI::App* parsed = nullptr;
  for (CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; }))
    if (one->get_name() == command) parsed = one;
  if (parsed == nullptr)
    throw UsageError(fmt::format("'{}' cannot be planned; plan takes {}", command, kCommands));
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{}; see `plumb {} --help`", error.what(), command));
  }
  refuse_empty_values(*parsed);
  Given out{.command = command, .names = {}, .options = {}};
  for (const CLI::Option* option : parsed->get_options()) {
    if (option->count() == 0) continue;
    if (option->get_positional()) {
      out.names = option->results();
    } else {
      out.options[option->get_lnames().front()] =
          option->get_items_expected_max() == 0 ? std::vector<std::string>{} : option->results();
    }
  }
  for (const char* name : {"list", "draw", "replay", "explore", "from"})
    if (out.has(name))
      throw UsageError(fmt::format("--{} runs nothing, so that there is nothing to plan", name));
  for (const char* name : {"out", "format"})
    if (out.has(name))
      throw UsageError(
          fmt::format("--{} is an option of `plumb gather`: each unit has its own folder", name));
  return out;
}

/// Seconds that earlier results took, by command, name and engine.
class Earlier {
 public:
  explicit Earlier(const std::vector<std::string>& folders) {
    for (const std::string& folder : folders) {
      std::error_code code;
      if (!fs::is_directory(folder, code))
        throw UsageError(fmt::format("--earlier is '{}': give a folder of results or of work", folder));
      read(folder);
      for (const int number : cluster::numbers_in(folder, "done"))
        read(cluster::path_in(folder, "done", number));
    }
  }

  bool find(const std::string& command, const std::string& name, const std::string& engine,
            double& seconds) const {
    const auto found = seconds_.find(command + "|" + name + "|" + engine);
    if (found == seconds_.end()) return false;
    seconds = found->second;
    return true;
  }

 private:
  void read(const fs::path& folder) {
    for (const char* name : {"results.jsonl", "stress.jsonl", "thresholds.jsonl"}) {
      const std::string path = (folder / name).string();
      if (!harness::is_packed_or_plain(path)) continue;
      std::istringstream file(harness::read_packed_or_plain(path));
      for (std::string line; std::getline(file, line);) {
        try {
          add(nlohmann::json::parse(line));
        } catch (const nlohmann::json::exception&) {  // an estimate is no reason to fail
        }
      }
    }
  }

  void add(const nlohmann::json& line) {
    const std::string kind = line.value("kind", "");
    if (kind == "environment") return;
    const std::string engine = line.at("engine");
    if (kind == "cell") {
      seconds_["stress|" + line.at("family").get<std::string>() + "|" + engine] +=
          line.at("seconds").get<double>();
    } else if (kind == "threshold") {
      seconds_["thresholds|" + line.at("name").get<std::string>() + "|" + engine] +=
          line.at("seconds").get<double>();
    } else if (line.at("cost").is_object()) {
      // A run, and repetitions of at most 15 ms in processes of their own.
      const auto& cost = line.at("cost");
      const double run =
          1e-9 * cost.at("ns_per_simulated_second").get<double>() * line.at("duration").get<double>();
      const double each = 0.005 + 2e-9 * cost.at("setup_ns").get<double>() + std::min(2 * run, 0.03);
      seconds_["compare|" + line.at("label").get<std::string>() + "|" + engine] =
          2 * run + cost.at("repetitions").get<double>() * each;
    }
  }

  std::map<std::string, double> seconds_;
};

// Splits one command line.
class Splitter {
 public:
  Splitter(const PlanOptions& options, const Given& given, const std::string& folder)
      : options_(options), given_(given), folder_(folder), earlier_(options.earlier) {
    EngineOptions wanted;
    if (given.has("engine")) wanted.names = given.options.at("engine");
    if (given.has("engine-command")) wanted.commands = given.options.at("engine-command");
    if (given.command == "hunt" && wanted.names.empty() && wanted.commands.empty())
      wanted.names = {"plumb-float", "plumb"};
    engines_ = chosen_engines(wanted, programs_);
  }

  std::vector<cluster::Unit> units() {
    if (given_.command == "hunt") return hunts();
    if (given_.command == "reality") return {whole()};
    if (given_.command == "sweep") return sweeps();
    const bool apart = given_.command != "compare" || options_.by_engine;
    std::vector<Piece> pieces;
    const std::vector<std::string> names = all_names();
    for (const std::string& engine : apart ? engine_names() : std::vector<std::string>{""})
      for (const std::string& name : names) pieces.push_back(piece(name, engine));
    return grouped(pieces);
  }

 private:
  std::vector<std::string> engine_names() const {
    std::vector<std::string> out;
    for (const reference::Backend* engine : engines_) out.emplace_back(engine->name());
    return out;
  }

  std::vector<std::string> all_names() {
    std::vector<std::string> out;
    const auto add = [&](const std::string& name) {
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    };
    if (given_.command == "stress") {
      for (const std::string& name : given_.names) add(harness::stress::find_family(name).name);
      if (given_.names.empty())
        for (const harness::stress::Family& family : harness::stress::all()) add(family.name);
    } else if (given_.command == "thresholds") {
      for (const std::string& name : given_.names) add(harness::thresholds::find(name).name);
      if (given_.names.empty())
        for (const harness::thresholds::Threshold& one : harness::thresholds::all()) add(one.name);
    } else {
      if (given_.command == "compare" && mean_results(given_.names))
        throw UsageError("compare OLD NEW needs no plan: it runs no scenes");
      const int size = std::stoi(given_.value("size", "0"));
      for (const std::string& name : given_.names)
        if (given_.command == "sweep" && is_file(name)) add(kept_file(name));
      std::vector<std::string> scenarios;
      std::copy_if(given_.names.begin(), given_.names.end(), std::back_inserter(scenarios),
                   [&](const std::string& name) { return given_.command != "sweep" || !is_file(name); });
      if (scenarios.empty() && !given_.names.empty()) return out;
      for (const scenarios::Instance& instance : chosen_instances(scenarios, size)) add(instance.label());
    }
    return out;
  }

  // Copies a scene into the folder of work, so that units run the scene as it was when the plan was made.
  std::string kept_file(const std::string& path) {
    const std::string text = harness::read_text(path);
    const fs::path files = fs::path(folder_) / "files";
    fs::create_directories(files);
    const std::string name = fs::path(path).filename().string();
    const fs::path to = files / name;
    std::error_code code;
    if (fs::exists(to, code) && harness::read_text(to.string()) != text)
      throw UsageError(fmt::format("the plan already has another file '{}'; rename this one", name));
    harness::write_whole(to.string(), text);
    return "{folder}/files/" + name;
  }

  Piece piece(const std::string& name, const std::string& engine) const {
    Piece out{.name = name, .engine = engine, .seconds = 0, .measured = false};
    bool all_known = given_.command != "sweep";
    for (const reference::Backend* backend : engines_) {
      if (!engine.empty() && backend->name() != engine) continue;
      double seconds = 0;
      if (!earlier_.find(given_.command, name, std::string(backend->name()), seconds)) {
        seconds = usual_seconds(name, *backend);
        all_known = false;
      }
      out.seconds += seconds;
    }
    out.measured = all_known;
    return out;
  }

  double usual_seconds(const std::string& name, const reference::Backend& backend) const {
    if (given_.command == "stress") {
      const auto values =
          harness::stress::values_of(harness::stress::find_family(name), given_.has("quick")).size();
      return kCell * static_cast<double>(values * harness::stress::settings_of(backend).size());
    }
    if (given_.command == "thresholds") {
      const auto settings = given_.has("all-settings") ? harness::stress::settings_of(backend).size() : 1;
      return kSearch * static_cast<double>(settings);
    }
    return given_.has("no-cost") ? kRunAlone : kRun;
  }

  // Options that all units share.
  std::vector<std::string> shared(const std::string& engine) const {
    std::vector<std::string> out;
    for (const auto& [name, values] : given_.options) {
      if (name == "size" || name == "budget" || name == "seed") continue;
      if (name == "jobs" && given_.command == "sweep") continue;
      if (name == "engine" && !engine.empty()) continue;
      if (name == "engine") {
        std::string joined;
        for (const std::string& value : values) joined += (joined.empty() ? "" : ",") + value;
        out.insert(out.end(), {"--engine", joined});
        continue;
      }
      if (values.empty()) out.push_back("--" + name);
      for (const std::string& value : values) {
        if (name == "engine-command" && !engine.empty() && !value.starts_with(engine + "=")) continue;
        out.insert(out.end(), {"--" + name, value});
      }
    }
    if (!engine.empty()) out.insert(out.end(), {"--engine", engine});
    // A unit uses one core, unless costs are measured: then it has the machine to itself.
    if (given_.command != "compare" && given_.command != "sweep" && given_.command != "reality" &&
        !given_.has("jobs"))
      out.insert(out.end(), {"--jobs", "1"});
    if (given_.command == "compare") out.emplace_back("--no-report");
    return out;
  }

  double unit_seconds() const {
    const double out =
        options_.unit_seconds.empty() ? 60 : parse_number("--unit-seconds", options_.unit_seconds);
    if (out < 0) throw UsageError("--unit-seconds is negative: give a number from 0");
    return out;
  }

  // A sweep goes in rounds: each engine's fronts are searched on a core anywhere, then the costs of all
  // engines take turns on one machine. Each scene has its share of the time, and each engine of a scene's
  // search.
  std::vector<cluster::Unit> sweeps() {
    const std::vector<std::string> names = all_names(), engines = engine_names();
    const double budget =
        given_.has("budget") ? parse_positive("--budget", given_.value("budget", "")) : kBudget;
    const double each = budget / static_cast<double>(names.size());
    const auto scenes =
        std::min(names.size(), static_cast<std::size_t>(std::max(1.0, unit_seconds() / each)));
    std::vector<cluster::Unit> out;
    for (std::size_t i = 0; i < names.size(); i += scenes) {
      const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(i + scenes, names.size()));
      std::vector<std::string> start{"sweep"};
      start.insert(start.end(), names.begin() + static_cast<std::ptrdiff_t>(i), end);
      const double seconds = each * static_cast<double>(start.size() - 1);
      const double search = harness::sweep::kExploring * seconds *
                            std::min<double>(options_.at_once, static_cast<double>(engines.size())) /
                            static_cast<double>(engines.size());
      const auto with = [&](const std::string& engine, double time) {
        std::vector<std::string> words = start;
        for (const std::string& word : shared(engine)) words.push_back(word);
        words.insert(words.end(), {"--budget", fmt::format("{:g}", time)});
        return words;
      };
      const double measuring = (1 - harness::sweep::kExploring) * seconds;
      for (const std::string& engine : engines) {
        cluster::Unit unit{.number = 0,
                           .arguments = with(engine, seconds),
                           .seconds = search,
                           .then = with("", measuring),
                           .then_seconds = measuring};
        unit.arguments.insert(unit.arguments.end(), {"--explore", fmt::format("{:g}", search)});
        out.push_back(std::move(unit));
      }
    }
    return out;
  }

  // Held against measurements, all engines are on one page, whose laws are fitted once.
  cluster::Unit whole() const {
    cluster::Unit unit{.number = 0, .arguments = {"reality"}, .seconds = kSearch, .measured = false};
    for (const std::string& word : shared("")) unit.arguments.push_back(word);
    return unit;
  }

  std::vector<cluster::Unit> grouped(const std::vector<Piece>& pieces) const {
    const double enough = unit_seconds();
    std::vector<cluster::Unit> out;
    for (std::size_t i = 0; i < pieces.size();) {
      cluster::Unit unit{.number = 0,
                         .arguments = {given_.command},
                         .seconds = 0,
                         .measured = true,
                         .cost = given_.command == "compare" && !given_.has("no-cost")};
      const std::string& engine = pieces[i].engine;
      do {
        unit.arguments.push_back(pieces[i].name);
        unit.seconds += pieces[i].seconds;
        unit.measured = unit.measured && pieces[i].measured;
      } while (++i < pieces.size() && pieces[i].engine == engine &&
               unit.seconds + pieces[i].seconds <= enough);
      for (const std::string& word : shared(engine)) unit.arguments.push_back(word);
      out.push_back(std::move(unit));
    }
    return out;
  }

  std::vector<cluster::Unit> hunts() const {
    std::vector<cluster::Unit> out;
    const bool counted = given_.has("scenes") && !given_.has("minutes");
    const double seconds =
        counted ? kScene * std::stod(given_.value("scenes", "0")) * static_cast<double>(engines_.size())
                : 60 * (given_.has("minutes") ? parse_positive("--minutes", given_.value("minutes", ""))
                                              : kMinutes);
    const std::int64_t first = std::stoll(given_.value("seed", "1"));
    if (first > std::numeric_limits<std::int64_t>::max() - options_.seeds)
      throw UsageError(fmt::format("--seed is '{}': give one that leaves room for the seeds of {} units",
                                   first, options_.seeds));
    for (std::int64_t seed = first; seed < first + options_.seeds; ++seed) {
      cluster::Unit unit{.number = 0, .arguments = {"hunt"}, .seconds = seconds, .measured = !counted};
      unit.arguments.insert(unit.arguments.end(), given_.names.begin(), given_.names.end());
      for (const std::string& word : shared("")) unit.arguments.push_back(word);
      unit.arguments.insert(unit.arguments.end(), {"--seed", std::to_string(seed)});
      out.push_back(std::move(unit));
    }
    return out;
  }

  const PlanOptions& options_;
  const Given& given_;
  std::string folder_;
  Earlier earlier_;
  std::vector<std::unique_ptr<reference::Backend>> programs_;
  std::vector<const reference::Backend*> engines_;
};

void tell(const std::string& folder) {
  print(fmt::format(
      "`plumb submit {0} --on local` runs them on this machine, `--on slurm` and `--on parallel` on others\n",
      folder));
}

int start_plan(const PlanOptions& options, const std::vector<std::string>& words) {
  cluster::Plan plan = plan_of(options, words);
  const std::size_t wanted = plan.units.size();
  double seconds = 0, longest = 0;
  for (const cluster::Unit& unit : plan.units) {
    seconds += unit.seconds;
    longest = std::max(longest, unit.seconds);
  }
  const int added =
      cluster::add_to_plan(fs::absolute(options.folder).lexically_normal().string(), std::move(plan));
  print(fmt::format("{} units, about {:.3g} s in total, {:.2g} s for the longest", wanted, seconds, longest));
  if (added != static_cast<int>(wanted)) print(fmt::format("; {} of them are new", added));
  print("\n");
  tell(options.folder);
  return kOk;
}

// Adds what the results so far call for.
int start_next(const std::string& given) {
  const std::string folder = fs::absolute(given).lexically_normal().string();
  cluster::Plan plan = cluster::read_plan(folder);
  cluster::require_same_program(given, plan, cluster::this_program());
  const cluster::Survey survey = cluster::survey(folder, plan, cluster::WorkOptions{}.expiry);
  cluster::NextRound next = cluster::next_round(folder, plan, survey);
  plan.units = std::move(next.units);
  if (cluster::add_to_plan(folder, std::move(plan)) == 0) {
    notice("the results require no further units");
    return kNothingFree;
  }
  print(fmt::format(
      "{} units continue from finished ones, {} are measured again because other programs used the machine\n",
      next.further, next.again));
  tell(given);
  return kOk;
}

}  // namespace

cluster::Plan plan_of(const PlanOptions& options, const std::vector<std::string>& words) {
  const Given given = parse(words);
  const std::string folder = fs::absolute(options.folder).lexically_normal().string();
  return {.program = cluster::this_program(),
          .directory = fs::current_path().string(),
          .commands = {words},
          .units = Splitter(options, given, folder).units()};
}

void add_plan(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "plan", "split a comparison, sweep, stress map, search or hunt into units of work for many machines");
  auto options = std::make_shared<PlanOptions>();
  auto next = std::make_shared<bool>(false);
  command->add_option("folder", options->folder, "folder of work; an existing one gets the missing units")
      ->required()
      ->check(problem_with_path)
      ->type_name("FOLDER");
  command
      ->add_option("--unit-seconds", options->unit_seconds,
                   "s; short scenes share a unit up to this time; 0: one unit for each scene (default 60)")
      ->type_name("T");
  command
      ->add_option("--seeds", options->seeds, "number of units of a hunt, each with its own seed (default 8)")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  command
      ->add_option("--earlier", options->earlier,
                   "folder of results or of work from which run times are estimated; may be repeated")
      ->allow_extra_args(false)
      ->type_name("DIR");
  command->add_flag("--by-engine", options->by_engine,
                    "also split compare by engine; then agreement is not computed, and costs come from one "
                    "kind of machine");
  command->add_flag("--next", *next,
                    "instead of a command: plan the further units that the results require, which are the "
                    "costs of a sweep whose fronts are found, and units that were disturbed");
  command->prefix_command();
  command->footer(
      "Examples:\n  plumb plan work compare\n  plumb plan work --unit-seconds 30 stress --timeout 60\n  "
      "plumb plan work --seeds 100 hunt --minutes 30\n  plumb plan work --next\nAfter the folder and the "
      "options of plan, give a command as for plumb itself: compare, sweep,\nstress, thresholds, hunt or "
      "reality. See docs/cluster.md. Exit codes: 0 planned, 2 usage, 3 --next: no further units.");
  command->callback([&chosen, options, next, command] {
    chosen = [options, next, words = command->remaining()] {
      if (*next && !words.empty())
        throw UsageError("--next takes no command; it continues the commands of the folder");
      return *next ? start_next(options->folder) : start_plan(*options, words);
    };
  });
}

}  // namespace plumb::app
