#include "harness/explain.h"

#include <memory>
#include <string>

#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/settings.h"
#include "app/source.h"

namespace plumb::app {

void add_explain(CLI::App& app, Action& chosen) {
  struct Options {
    std::string name, engine = "plumb", format = "console";
    bool precise = false;
    int size = 0;
    SettingsOptions settings;
  };
  CLI::App* command = app.add_subcommand(
      "explain", "show how plumb computes a scene: its stages, the reason for each, and its cost");
  auto options = std::make_shared<Options>();
  command->add_option("name", options->name, "a scenario or a scene file")
      ->required()
      ->type_name("NAME|FILE");
  CLI::Option* engine =
      command->add_option("--engine", options->engine, "plumb, plumb-float or plumb-precise (default plumb)");
  command->add_flag("--precise", options->precise, "short for --engine plumb-precise")->excludes(engine);
  add_size(*command, options->size);
  options->settings.add_to(*command);
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command->footer(
      "Examples:\n  plumb explain elastic_collision/oblique\n  plumb explain pendulum_chain --size 20 "
      "--precise\n"
      "  plumb explain scene.json --engine plumb-float --format json");
  command->callback([&chosen, options] {
    chosen = [options] {
      const reference::Backend& backend =
          reference::find_backend(options->precise ? "plumb-precise" : options->engine);
      const reference::StepSettings settings = options->settings.settings(backend);
      const Source source = load(options->name, options->size);
      const harness::Explanation explanation =
          harness::explain(source.scene, backend, settings, source.duration);
      print(options->format == "json"
                ? harness::to_json(explanation) + "\n"
                : harness::to_console(explanation, harness::Style::of_file(STDOUT_FILENO)));
      return kOk;
    };
  });
}

}  // namespace plumb::app
