#include "harness/agreement.h"

#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "harness/known_limits.h"
#include "harness/sweep/rows.h"

namespace plumb::app {
namespace {

struct AgreementOptions {
  std::string folder = "results", format = "console", without;
};

int start_agreement(const AgreementOptions& options) {
  std::vector<harness::Result> rows = harness::sweep::read_rows(options.folder);
  harness::sweep::require_rows(rows, options.folder);
  if (!options.without.empty())
    std::erase_if(rows,
                  [&](const harness::Result& row) { return harness::matches(options.without, row.engine); });
  const std::vector<harness::Agreement> cases = harness::agreements(rows);
  if (options.format == "json") {
    for (const harness::Agreement& one : cases) print(harness::agreement_json(one) + "\n");
  } else if (options.format == "csv") {
    print(harness::agreement_csv(cases));
  } else {
    print(harness::agreement_text(cases, harness::AgreementDetail::Full,
                                  harness::Style::of_file(STDOUT_FILENO)));
  }
  flush();
  return kOk;
}

}  // namespace

void add_agreement(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("agreement",
                         "from results, for each case: the engines that agree with the truth and with each "
                         "other,\nand what the others miss, by how much and why");
  auto options = std::make_shared<AgreementOptions>();
  command
      ->add_option("results", options->folder,
                   "a folder that `plumb compare` wrote, or a results.jsonl (default results)")
      ->type_name("DIR");
  command
      ->add_option("--format", options->format,
                   "console, json (one case per line) or csv (one miss per line)")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command
      ->add_option("--without", options->without,
                   "leave these engines out; '*' matches anything, '|' separates alternatives")
      ->type_name("NAME");
  command->footer(
      "Examples:\n  plumb agreement\n  plumb agreement results --without '*-default' --format json\n"
      "Exit codes: 0 written, 2 usage, or results that cannot be read.");
  command->callback([&chosen, options] { chosen = [options] { return start_agreement(*options); }; });
}

}  // namespace plumb::app
