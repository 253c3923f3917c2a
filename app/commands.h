#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace plumb::app {

/// Runs a subcommand once its options are parsed; returns the exit code.
using Action = std::function<int()>;

// Each adds its subcommand to `app` and sets `chosen` to its action when the subcommand is given.
void add_list(CLI::App& app, Action& chosen);
void add_new(CLI::App& app, Action& chosen);
void add_engines(CLI::App& app, Action& chosen);
void add_explain(CLI::App& app, Action& chosen);
void add_bisect(CLI::App& app, Action& chosen);
void add_verdict(CLI::App& app, Action& chosen);
void add_run(CLI::App& app, Action& chosen);
void add_scene(CLI::App& app, Action& chosen);
void add_compare(CLI::App& app, Action& chosen);
void add_check(CLI::App& app, Action& chosen);
void add_sweep(CLI::App& app, Action& chosen);
void add_front(CLI::App& app, Action& chosen);
void add_tune(CLI::App& app, Action& chosen);
void add_stress(CLI::App& app, Action& chosen);
void add_hunt(CLI::App& app, Action& chosen);
void add_limits(CLI::App& app, Action& chosen);
void add_thresholds(CLI::App& app, Action& chosen);
void add_reality(CLI::App& app, Action& chosen);
void add_plan(CLI::App& app, Action& chosen);
void add_work(CLI::App& app, Action& chosen);
void add_gather(CLI::App& app, Action& chosen);
void add_status(CLI::App& app, Action& chosen);
void add_submit(CLI::App& app, Action& chosen);
void add_report(CLI::App& app, Action& chosen);
void add_agreement(CLI::App& app, Action& chosen);
void add_bench(CLI::App& app);
void add_window(CLI::App& app);  ///< demo and view

/// Replaces this program by the benchmarks beside it. Returns only on failure: throws `Error` (Io).
int run_bench(int argc, char** argv);

/// Replaces this program by the windowed one beside it. Returns only on failure: throws `Error` (Io) that
/// names the package to install.
int run_window(int argc, char** argv);

}  // namespace plumb::app
