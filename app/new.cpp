#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/new_scenario_text.h"
#include "app/output.h"
#include "app/usage.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

std::string problem_with_name(const std::string& name) {
  const bool letters = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos &&
                       !name.empty() && name[0] >= 'a' && name[0] <= 'z';
  return letters
             ? ""
             : "a scenario's name consists of lower-case letters, digits and '_', and starts with a letter";
}

// Writes `folder`/`name`.cpp, which must not exist yet.
void write_scenario(const std::string& name, const std::string& folder) {
  std::string text = kNewScenario;
  const std::string stand_in = "new_scenario_name";
  for (auto at = text.find(stand_in); at != std::string::npos; at = text.find(stand_in, at))
    text.replace(at, stand_in.size(), name);
  const std::filesystem::path path = std::filesystem::path(folder) / (name + ".cpp");
  if (!std::filesystem::is_directory(folder))
    throw UsageError(fmt::format(
        "there is no folder '{}'; run this in a checkout, or give a folder with --folder", folder));
  if (std::filesystem::exists(path)) throw UsageError(fmt::format("'{}' exists already", path.string()));
  harness::write_whole(path.string(), text);
  print(fmt::format("{}: build, then `plumb compare {}`; see docs/adding-a-scenario.md\n", path.string(),
                    name));
}

}  // namespace

void add_new(CLI::App& app, Action& chosen) {
  struct Options {
    std::string kind, name, folder = "scenarios";
  };
  CLI::App* command = app.add_subcommand("new", "write the file of a new scenario, which builds and passes");
  auto options = std::make_shared<Options>();
  command->add_option("kind", options->kind, "what to write")->required()->check(CLI::IsMember({"scenario"}));
  command->add_option("name", options->name, "its name, as in `plumb compare NAME`")
      ->required()
      ->check(problem_with_name);
  command->add_option("--folder", options->folder, "where to write it")->capture_default_str();
  command->footer("Example:\n  plumb new scenario rolling_ring");
  command->callback([&chosen, options] {
    chosen = [options] {
      write_scenario(options->name, options->folder);
      return kOk;
    };
  });
}

}  // namespace plumb::app
