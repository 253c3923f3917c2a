#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/metric.h"
#include "app/output.h"
#include "harness/sweep/front_tables.h"
#include "harness/sweep/rows.h"

namespace plumb::app {
namespace {

namespace sweep = harness::sweep;

struct FrontOptions {
  std::string folder, metric, machine, format = "console";
};

int start_front(const FrontOptions& options) {
  const std::vector<harness::Result> rows = sweep::read_rows(options.folder, options.machine);
  sweep::require_rows(rows, options.folder);
  const harness::MetricField* metric = options.metric.empty() ? nullptr : &metric_by_name(options.metric);
  if (options.format != "console") {
    print(sweep::trade_data(rows, metric, options.format));
    return kOk;
  }
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  // Costs of different machines are not comparable: each kind has fronts of its own.
  std::vector<harness::Result> all = options.machine.empty() ? sweep::read_all_costs(options.folder) : rows;
  for (const std::vector<harness::Result>& scene : sweep::by_label(all)) {
    const std::vector<std::string> machines = sweep::machines_of(scene);
    if (machines.size() < 2) print(sweep::front_table(scene, metric, style) + "\n");
    for (std::size_t i = 0; i < machines.size() && machines.size() > 1; ++i) {
      std::vector<harness::Result> one = scene;
      sweep::keep_costs_of_one_machine(one, machines[i]);
      print(fmt::format("on {}:\n{}\n", machines[i], sweep::front_table(one, metric, style)));
    }
  }
  print(sweep::dominance_table(sweep::dominance(rows, metric), style));
  return kOk;
}

}  // namespace

void add_front(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "front",
      "from results: each engine's Pareto front, cost at equal error, error at equal cost, dominance");
  auto options = std::make_shared<FrontOptions>();
  command->add_option("results", options->folder, "a folder that `plumb sweep` wrote, or a results.jsonl")
      ->required()
      ->type_name("DIR");
  add_metric(*command, options->metric,
             "error of the fronts (default: position_error, or the scene's own metric)");
  command
      ->add_option("--machine", options->machine,
                   "kind of machine whose costs are used (default: fronts of each kind; for dominance and "
                   "data, the kind with the most costs in each scene)")
      ->type_name("NAME");
  command->add_option("--format", options->format, "console, json or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->footer("Examples:\n  plumb front sweep\n  plumb front sweep --metric energy_drift --format json");
  command->callback([&chosen, options] { chosen = [options] { return start_front(*options); }; });
}

}  // namespace plumb::app
