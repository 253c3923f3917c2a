#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include "app/commands.h"
#include "engine/scene/error.h"

namespace plumb::app {

void add_bench(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "bench", "measure the cost of a step for every scenario, engine and size (Google Benchmark)");
  command->prefix_command();
  command->footer(
      "All options are passed to the benchmarks; `plumb bench --help` lists them.\nExamples:\n  plumb "
      "bench\n  plumb bench --benchmark_filter=pendulum_chain --benchmark_format=json");
}

int run_bench(int argc, char** argv) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plumb_bench";
  std::string name = program.string();
  std::vector<char*> arguments{name.data()};
  for (int i = 2; i < argc; ++i) arguments.push_back(argv[i]);
  arguments.push_back(nullptr);
  execv(name.c_str(), arguments.data());
  throw Error(Error::Kind::Io, "program '" + name + "'", "", "",
              std::string("cannot be started: ") + std::strerror(errno) + "; build the target plumb_bench");
}

}  // namespace plumb::app
