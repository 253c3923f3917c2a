// `plumb demo` and `plumb view`: the program with the window, started by `plumb`.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/exit_codes.h"
#include "app/output.h"
#include "app/report_error.h"
#include "app/selection.h"
#include "app/source.h"
#include "app/usage.h"
#include "demos/core/registry.h"
#include "demos/window/run.h"
#include "demos/window/view.h"
#include "engine/core/suggest.h"
#include "engine/scene/error.h"
#include "harness/course/course.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

using window::Item;
using window::Player;

// Options of both subcommands, as given.
struct Given {
  std::string name, script, screenshot, seconds, dt, theme = "dark";
  std::vector<std::string> settings, drawings, ghosts;
  int width = 1280, height = 800, colours = 0, frames = 0, size = 0;
  std::vector<std::string> commands;
  std::string engine, check;
  bool list = false, headless = false, bare = false, report = false;
};

void add_options(CLI::App& command, Given& given) {
  command.add_flag("--headless", given.headless, "run without a window and display");
  command.add_option("--seconds", given.seconds, "duration in s of real time (headless: of simulated time)")
      ->type_name("T");
  command.add_option("--screenshot", given.screenshot, "write the last frame to this PNG file")
      ->check(problem_with_path)
      ->type_name("FILE");
  command.add_option("--width", given.width, "px")->check(CLI::Range(64, 8192));
  command.add_option("--height", given.height, "px")->check(CLI::Range(64, 8192));
  command.add_option("--colours", given.colours, "number of colours in pictures, for smaller files")
      ->check(CLI::Range(2, 256));
  command.add_option("--theme", given.theme, "dark or light")->check(CLI::IsMember({"dark", "light"}));
  command.add_flag("--no-panel", given.bare, "start without the panel");
  command.add_flag("--report", given.report, "print time, hash and values at the end, as with --headless");
  command.add_option("--dt", given.dt, "length of a step in s; short for --set dt=DT")->type_name("DT");
  command.add_option("--set", given.settings, "set a control, as NAME=VALUE (may be repeated)");
  command.add_option("--show", given.drawings,
                     "contacts, normals, impulses, boxes, centres, joints, names, velocities, forces, masses "
                     "or code (may be repeated)");
  command
      .add_option("--script", given.script,
                  "file with input events: lines like '0.5 press 1 2' (docs/demos.md)")
      ->check(problem_with_path)
      ->type_name("FILE");
  command
      .add_option("--measure-frames", given.frames, "draw this number of frames and print the time they took")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000));
}

window::Options options_of(const Given& given) {
  window::Options options{.width = given.width,
                          .height = given.height,
                          .screenshot = given.screenshot,
                          .colours = given.colours,
                          .measured_frames = given.frames};
  if (!given.seconds.empty()) options.seconds = parse_number("--seconds", given.seconds);
  if (!given.seconds.empty() && options.seconds < 0)
    throw UsageError("--seconds: '" + given.seconds + "' is before the start");
  if (!given.script.empty())
    options.script = window::parse_script(harness::read_text(given.script), given.script);
  if (given.headless && given.seconds.empty() && given.frames == 0)
    throw UsageError("--headless needs an end; give --seconds T");
  return options;
}

int play(Player& player, const Given& given) {
  const window::Options options = options_of(given);
  player.panel = !given.bare;
  player.theme.dark = given.theme == "dark";
  for (const std::string& drawing : given.drawings) window::show(player, drawing);
  if (!given.dt.empty()) player.demo().set("dt", parse_positive("--dt", given.dt));
  for (const std::string& setting : given.settings) window::assign(player.demo(), setting);
  // Restart, because settings affect the start too.
  if (!given.dt.empty() || !given.settings.empty()) player.restart();
  if (given.headless) {
    window::run_headless(player, options);
    print(window::report(player));
  } else {
    window::run_in_window(player, options);
    if (given.report) print(window::report(player));
  }
  return kOk;
}

std::vector<Item> demo_items() {
  std::vector<Item> items;
  for (const demos::Entry& entry : demos::all())
    items.push_back({entry.about.name, entry.about.summary, [&entry] { return window::Show{entry.make()}; }});
  return items;
}

// Returns the course's chapter of a demo: its checks' names are the demo's name or begin with it.
std::vector<course::Chapter> chapter_of(const std::string& demo) {
  constexpr const char* kDemos[] = {"bouncing_ball", "cannonballs", "pool_break", "spinning_boxes",
                                    "ragdoll"};
  std::vector<course::Chapter> all = course::chapters();
  for (course::Chapter& chapter : all)
    if (demo == kDemos[chapter.number - 1]) return {std::move(chapter)};
  if (demo.empty()) return all;
  throw UsageError(
      fmt::format("'{}' is not a chapter's demo; with --engine-command give bouncing_ball, cannonballs, "
                  "pool_break, spinning_boxes or ragdoll, or no name for all",
                  demo));
}

demos::SampledMotion motion_of(const course::Recorded& run) {
  demos::SampledMotion motion(run.dt, run.scene.bodies.size());
  for (const auto& states : run.trace.states) motion.add(states);
  return motion;
}

// Shows the scenes of the course's checks as moved by the user's engine, with the correct motion as an
// outline.
int run_course(const Given& given) {
  const auto programs = programs_of(given.commands);
  const reference::Backend& engine = *programs.front();
  window::Engines engines;
  for (const auto& program : programs) engines.more.push_back(program.get());
  const std::vector<course::Chapter> chapters = chapter_of(given.name);
  reference::StepSettings settings;
  if (!given.dt.empty()) settings.dt = parse_positive("--dt", given.dt);
  std::vector<Item> items;
  std::optional<std::size_t> first;
  for (const course::Outcome& outcome :
       course::examine(engine, settings, chapters, [](const course::Outcome&) {})) {
    const bool wanted = given.check.empty() ? outcome.finding.verdict == course::Verdict::Fail
                                            : outcome.check->name == given.check;
    const auto same = [&](const Item& item) { return item.name.starts_with(outcome.check->name); };
    // The longest first: others are short experiments on the same mistake.
    std::vector<course::Recorded> runs = outcome.runs;
    std::ranges::stable_sort(runs, std::ranges::greater{},
                             [](const course::Recorded& run) { return run.trace.duration(); });
    for (const course::Recorded& run : runs) {
      if (wanted && !first) first = items.size();
      const auto count = std::count_if(items.begin(), items.end(), same);
      const std::string name =
          count == 0 ? outcome.check->name : fmt::format("{} ({})", outcome.check->name, count + 1);
      const demos::About about{
          .name = name,
          .summary = outcome.check->title,
          .play = fmt::format("Solid: {}. Outline: the right motion. {}{}{}", engine.name(),
                              demos::sentence_of(outcome.check->title),
                              outcome.finding.says.empty() ? "" : " ", outcome.finding.says)};
      window::Engines own = engines;
      own.dt = run.dt;
      items.push_back(window::motion_item(about, run.scene, motion_of(run), own));
    }
  }
  if (!given.check.empty() && !first)
    throw UsageError(fmt::format("there is no run of a check '{}'", given.check));
  if (items.empty())
    throw UsageError(fmt::format("engine '{}' runs no scene of these checks", engine.name()));
  Given rest = given;
  rest.dt.clear();  // the runs have it already
  Player player(items, first.value_or(0));
  return play(player, rest);
}

int run_demo(const Given& given) {
  if (!given.commands.empty()) return run_course(given);
  const std::vector<Item> items = demo_items();
  if (given.list) {
    for (const Item& item : items) print(fmt::format("{:<16} {}\n", item.name, item.summary));
    return kOk;
  }
  std::size_t first = 0;
  if (!given.name.empty()) {
    demos::make(given.name);  // throws if there is no such demo
    while (items[first].name != given.name) ++first;
  }
  Player player(items, first);
  return play(player, given);
}

void show_ghosts(Player& player, const std::vector<std::string>& names) {
  window::Companion& companion = *player.companion();
  for (const std::string& name : names) {
    std::vector<std::string> known;
    for (const window::Ghost& ghost : companion.ghosts()) known.push_back(ghost.name);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw UsageError(fmt::format("there is no engine '{}'{}", name, did_you_mean(name, known)));
    companion.show_ghost(static_cast<std::size_t>(found - known.begin()), true);
  }
}

// Shows the whole catalogue, opened at the given scenario; a scene from a file is shown alone.
int run_view(const Given& given) {
  std::vector<Item> items;
  std::size_t first = 0;
  const auto programs = programs_of(given.commands);
  window::Engines engines;
  for (const auto& program : programs) engines.more.push_back(program.get());
  const bool as_ghost = std::ranges::any_of(programs, [&](const auto& program) {
    return std::ranges::find(given.ghosts, program->name()) != given.ghosts.end();
  });
  if (!given.engine.empty() || (!programs.empty() && !as_ghost))
    engines.shown = &one_engine(given.engine, programs);
  if (engines.shown != nullptr && given.engine == "plumb") engines.shown = nullptr;  // moved live
  if (!given.dt.empty()) engines.dt = parse_positive("--dt", given.dt);
  const Source source = load(given.name, given.size);
  if (source.instance) {
    items = window::scenario_items(engines);
    const std::string label = source.instance->label();
    while (first < items.size() && items[first].name != label) ++first;
    if (first == items.size()) items.push_back(window::scenario_item(*source.instance, engines));
  } else {
    items = {window::scene_item(source.scene, source.duration, engines)};
  }
  Player player(items, first);
  show_ghosts(player, given.ghosts);
  Given rest = given;
  if (engines.shown != nullptr) rest.dt.clear();  // the run has it already
  return play(player, rest);
}

int main(int argc, char** argv) {
  keep_standard_files();
  std::signal(SIGPIPE, SIG_IGN);
  CLI::App app("plumb's window", "plumb");
  app.require_subcommand(1);
  Given given;
  CLI::App* demo = app.add_subcommand("demo", "play the demos of the course");
  demo->add_option("name", given.name, "name of a demo; see --list");
  demo->add_flag("--list", given.list, "the demos");
  add_engine_command(*demo, given.commands);
  demo->add_option("--check", given.check, "with --engine-command: start with this check of `plumb check`")
      ->type_name("NAME");
  add_options(*demo, given);
  demo->footer(
      "With --engine-command the window shows the scenes of the course's checks, run by that engine, with "
      "the right motion as an outline.\nExamples:\n  plumb demo\n  plumb demo bouncing_ball --engine-command "
      "mine='python3 my_engine.py'\n  plumb demo ragdoll --theme light\n  plumb demo bouncing_ball "
      "--headless --seconds 2 --screenshot ball.png");
  CLI::App* view = app.add_subcommand("view", "show a scenario beside its truth and other engines");
  view->add_option("name", given.name, "a scenario or a scene file")->required()->type_name("NAME|FILE");
  add_size(*view, given.size);
  add_engine_command(*view, given.commands);
  view->add_option("--engine", given.engine,
                   "the engine that runs the scene (default: the first --engine-command that is not a "
                   "--ghost, else plumb)")
      ->type_name("ENGINE");
  view->add_option("--ghost", given.ghosts, "draw this engine, or the truth, as an outline (may be repeated)")
      ->type_name("ENGINE");
  add_options(*view, given);
  view->footer(
      "Examples:\n  plumb view pendulum_chain --size 5 --ghost box2d\n  plumb view scene.json\n"
      "  plumb view ball_in_room --engine-command mine='python3 my_engine.py' --ghost plumb\n"
      "  plumb view kepler --headless --seconds 5 --screenshot kepler.png");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return reporting_errors([&] { return say(app, success); });
  } catch (const CLI::ParseError& error) {
    return reporting_errors([&]() -> int {
      const std::string where = argc > 1 ? fmt::format("plumb {}", argv[1]) : "plumb";
      throw UsageError(fmt::format("{}; see `{} --help`", error.what(), where));
    });
  }
  return reporting_errors([&] {
    for (const CLI::App* command : app.get_subcommands()) refuse_empty_values(*command);
    return view->parsed() ? run_view(given) : run_demo(given);
  });
}

}  // namespace
}  // namespace plumb::app

int main(int argc, char** argv) { return plumb::app::main(argc, argv); }
