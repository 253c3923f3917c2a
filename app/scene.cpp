#include <memory>
#include <string>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/source.h"
#include "engine/scene/json.h"

namespace plumb::app {

void add_scene(CLI::App& app, Action& chosen) {
  struct Options {
    std::string name;
    int size = 0;
  };
  CLI::App* command =
      app.add_subcommand("scene", "print a scenario's scene as JSON, for `plumb run` or another program");
  auto options = std::make_shared<Options>();
  command->add_option("name", options->name, "a scenario, or a file to check and print")
      ->required()
      ->type_name("NAME|FILE");
  add_size(*command, options->size);
  command->footer(
      "Examples:\n  plumb scene elastic_collision/oblique\n  plumb scene pendulum_chain --size 20 > "
      "chain.json");
  command->callback([&chosen, options] {
    chosen = [options] {
      print(to_json(load(options->name, options->size).scene) + "\n");
      return kOk;
    };
  });
}

}  // namespace plumb::app
