#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/usage.h"
#include "harness/limits/limits_page.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

struct LimitsOptions {
  std::string folder = "stress", out;
};

int start_limits(const LimitsOptions& options) {
  const harness::limits::LimitsData data = harness::limits::read_limits(options.folder);
  const std::string part = harness::limits::measured_part(data);
  if (options.out.empty()) {
    print(part);
    flush();
    return kOk;
  }
  const std::string page = harness::limits::with_measured_part(harness::read_text(options.out), part);
  const std::string kept = std::filesystem::path(options.out).replace_extension(".jsonl").string();
  harness::write_whole(kept, harness::limits::to_jsonl(data));
  harness::write_whole(options.out, page);
  print(fmt::format("{} has the new measured part; its data are in {}\n", options.out, kept));
  flush();
  return kOk;
}

}  // namespace

void add_limits(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "limits", "write the measured part of docs/limits.md from the results of stress and thresholds");
  auto options = std::make_shared<LimitsOptions>();
  command
      ->add_option("folder", options->folder,
                   "folder with stress.jsonl, thresholds.jsonl or both (default stress)")
      ->type_name("DIR");
  command
      ->add_option("--out", options->out,
                   "page whose part between the markers is replaced; its data are written beside it "
                   "as\n.jsonl (default: write the part to stdout)")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->footer(
      "Examples:\n  plumb limits\n"
      "  plumb stress && plumb thresholds && plumb limits stress --out docs/limits.md\n"
      "Exit codes: 0 written, 2 usage, or files that cannot be read or written.");
  command->callback([&chosen, options] { chosen = [options] { return start_limits(*options); }; });
}

}  // namespace plumb::app
