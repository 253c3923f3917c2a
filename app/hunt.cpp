#include "harness/hunt/hunt.h"

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/progress_line.h"
#include "app/selection.h"
#include "app/usage.h"
#include "engine/scene/json.h"
#include "harness/hunt/examine.h"
#include "harness/interrupt.h"
#include "harness/style.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

namespace hunting = harness::hunt;

constexpr double kMinutes = 10;

struct HuntCommandOptions {
  std::vector<std::string> names;
  EngineOptions engines;
  std::string out = "hunt", format = "console", minutes, replay;
  std::int64_t seed = 1, scenes = 0, draw = -1;
  int jobs = 0, shrinks = 3;
  bool list = false;
};

void list() {
  using Role = hunting::Idiom::Role;
  constexpr std::pair<Role, const char*> kRoles[] = {{Role::Structure, "structures (families)"},
                                                     {Role::Support, "supports"},
                                                     {Role::Disturbance, "disturbances"}};
  for (const auto& [role, title] : kRoles) {
    print(fmt::format("{}\n", title));
    for (const hunting::Idiom& idiom : hunting::idioms())
      if (idiom.role == role) print(fmt::format("  {:<16} {}\n", idiom.name, idiom.title));
  }
}

// Puts structures and case files where they belong.
void choose(const std::vector<std::string>& names, hunting::HuntOptions& what) {
  std::vector<const hunting::Idiom*>& out = what.families;
  for (const std::string& name : names) {
    if (const std::vector<std::string> files = case_files(name); !files.empty()) {
      for (const std::string& file : files) what.cases.push_back(hunting::read_seed(file));
      continue;
    }
    const hunting::Idiom* idiom = &hunting::find_idiom(name);
    if (idiom->role != hunting::Idiom::Role::Structure)
      throw UsageError(fmt::format(
          "'{}' is not a structure but is added to structures automatically; see `plumb hunt --list`", name));
    if (std::find(out.begin(), out.end(), idiom) == out.end()) out.push_back(idiom);
  }
}

std::vector<hunting::Engine> engines_of(const HuntCommandOptions& options,
                                        const std::vector<std::string>& usual,
                                        std::vector<std::unique_ptr<reference::Backend>>& programs) {
  EngineOptions wanted = options.engines;
  if (wanted.names.empty() && wanted.commands.empty()) wanted.names = usual;
  if (wanted.names.empty())
    for (const std::string& command : wanted.commands)
      wanted.names.push_back(command.substr(0, command.find('=')));
  std::vector<hunting::Engine> out;
  for (const reference::Backend* backend : chosen_engines(wanted, programs)) out.emplace_back(*backend);
  return out;
}

int replay(const HuntCommandOptions& options) {
  const std::string text = harness::read_text(options.replay);
  const bool is_finding = nlohmann::json::parse(text, nullptr, false).contains("case");
  hunting::Case one;
  std::vector<std::string> usual{"plumb-float", "plumb"};
  std::string law;
  if (is_finding) {
    const hunting::Finding finding = hunting::finding_from_json(text);
    one = finding.smallest, usual = {finding.engine}, law = finding.objection.law;
  } else {
    one = hunting::case_from_json(text);
  }
  std::vector<std::unique_ptr<reference::Backend>> programs;
  bool objected = false;
  for (const hunting::Engine& engine : engines_of(options, usual, programs)) {
    hunting::Examined seen = hunting::examine(engine, one);
    // Relations are judged in turn, by the number of a case: the one that the finding is of comes in any
    // case.
    const auto of_finding = [&](const hunting::Objection& each) { return each.law == law; };
    if (!law.empty() && law != "crash" &&
        std::none_of(seen.objections.begin(), seen.objections.end(), of_finding))
      for (hunting::Objection& each : hunting::examine(engine, one, law).objections)
        seen.objections.push_back(std::move(each));
    if (!seen.skipped.empty()) print(fmt::format("{}: skipped: {}\n", engine.name(), seen.skipped));
    if (seen.skipped.empty() && seen.objections.empty())
      print(fmt::format("{}: no judge objects\n", engine.name()));
    for (const hunting::Objection& objection : seen.objections) {
      objected = true;
      print(fmt::format("{}: {} at {:.3g} s: {}\n  right: {}\n", engine.name(), objection.judge,
                        objection.time, objection.what, objection.right));
    }
  }
  return objected ? kCheckFailed : kOk;
}

std::string progress_text(std::uint64_t scenes, std::uint64_t findings, double passed,
                          const hunting::HuntOptions& what) {
  std::string text = fmt::format("{} scenes, {} findings", scenes, findings);
  if (passed > 1) text += fmt::format(", {:.0f} scenes a minute", 60 * static_cast<double>(scenes) / passed);
  if (what.seconds > 0) text += fmt::format(", about {:.0f} s left", std::max(0.0, what.seconds - passed));
  return text;
}

int start_hunt(const HuntCommandOptions& options) {
  if (options.list) {
    list();
    return kOk;
  }
  if (!options.replay.empty()) return replay(options);
  hunting::HuntOptions what{.seed = static_cast<std::uint64_t>(options.seed),
                            .scenes = static_cast<std::uint64_t>(options.scenes),
                            .folder = options.out,
                            .shrinks = options.shrinks};
  choose(options.names, what);
  if (options.draw >= 0) {
    const auto index = static_cast<std::uint64_t>(options.draw);
    print(hunting::to_json(hunting::draw(what, index)) + "\n");
    return kOk;
  }
  std::vector<std::unique_ptr<reference::Backend>> programs;
  what.engines = engines_of(options, {"plumb-float", "plumb"}, programs);
  what.jobs =
      options.jobs > 0 ? options.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  what.seconds = !options.minutes.empty() ? 60 * parse_positive("--minutes", options.minutes)
                 : options.scenes > 0     ? 0
                                          : 60 * kMinutes;
  ProgressLine progress;
  harness::catch_interrupts();
  hunting::HuntEvents events;
  events.progress = [&](std::uint64_t scenes, std::uint64_t findings, double passed) {
    progress.say(progress_text(scenes, findings, passed, what));
  };
  const hunting::Hunted done = hunting::hunt(what, events);
  progress.clear();
  for (const hunting::Kind& kind : done.kinds)
    hunting::write_finding(kind.smallest, options.out + "/findings", kind.file);
  if (options.format == "json") {
    print(hunting::kinds_json(done) + "\n");
  } else {
    print(hunting::kinds_text(done));
    print(
        fmt::format("\n{} scenes, {} runs, {} skipped: {} kinds of findings; each is in {}/findings, and\n"
                    "`plumb hunt --replay FILE` runs one again\n",
                    done.scenes, done.runs, done.skipped, done.kinds.size(), options.out));
  }
  if (done.interrupted) {
    fmt::print(stderr, "plumb: interrupted; the same command continues from the results in {}\n",
               options.out);
    return kInterrupted;
  }
  return done.kinds.empty() ? kOk : kCheckFailed;
}

}  // namespace

void add_hunt(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("hunt", "run random scenes, judged by physical laws, symmetries and other engines");
  auto options = std::make_shared<HuntCommandOptions>();
  command
      ->add_option("families", options->names,
                   "families of scenes (default: all), see --list; or case files and folders of them, whose "
                   "scenes are varied")
      ->type_name("FAMILY|CASE");
  options->engines.add_to(*command);
  command->add_option("--seed", options->seed, "seed of the random scenes (default 1)")
      ->check(whole_number(0))
      ->type_name("N");
  command->add_option("--minutes", options->minutes, "duration of the hunt, min (default 10)")
      ->type_name("T");
  command->add_option("--scenes", options->scenes, "stop after this number of scenes")
      ->check(whole_number(1))
      ->type_name("N");
  command
      ->add_option("--shrinks", options->shrinks,
                   "number of findings of a judge, engine and family that are shrunk (default 3)")
      ->check(whole_number(0, 1'000'000))
      ->type_name("N");
  command->add_option("--jobs", options->jobs, "number of processes (default: one per core)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command
      ->add_option("--out", options->out,
                   "folder for the findings; an existing hunt continues (default hunt)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command->add_option("--replay", options->replay, "run and judge the file of a finding again")
      ->type_name("FILE");
  command->add_flag("--list", options->list, "list the parts of which scenes are composed");
  command->add_option("--draw", options->draw, "print the scene with this number, from 0, without running it")
      ->check(whole_number(0))
      ->type_name("N");
  command->footer(
      "Examples:\n  plumb hunt --minutes 5\n  plumb hunt star wall --engine plumb-float,box2d --seed 7 --out "
      "walls\n  "
      "plumb hunt --engine-command \"mine=python3 my_engine.py\" --scenes 500 --out mine\n  plumb hunt "
      "my_case.json "
      "museum --minutes 5 --out varied\n  plumb hunt --replay hunt/findings/001-energy.json\nThe same seed "
      "gives the same "
      "scenes on every machine. If it is stopped, at most the scenes that run are lost;\nthe same command "
      "continues. See docs/hunting.md. Exit codes: 0 nothing was found; 1 something\nwas; 2 usage; 130 "
      "interrupted.");
  command->callback([&chosen, options] { chosen = [options] { return start_hunt(*options); }; });
}

}  // namespace plumb::app
