#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace plumb::app {

/// What a subcommand does once its options are parsed; returns the exit code.
using Action = std::function<int()>;

// Each adds its subcommand to `app` and puts its action into `chosen` when it is the one that is given.
void add_list(CLI::App& app, Action& chosen);
void add_engines(CLI::App& app, Action& chosen);
void add_explain(CLI::App& app, Action& chosen);
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
void add_report(CLI::App& app, Action& chosen);
void add_bench(CLI::App& app);
void add_window(CLI::App& app);  ///< demo and view

/// Replaces this program by the benchmarks beside it. Returns only when that fails: throws `Error` (Io).
int run_bench(int argc, char** argv);

/// Replaces this program by the one beside it that has the window. Returns only when that fails: throws
/// `Error` (Io) that says what to install.
int run_window(int argc, char** argv);

}  // namespace plumb::app
