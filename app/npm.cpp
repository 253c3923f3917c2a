#include "app/npm.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/usage.h"
#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"

extern char** environ;

namespace plumb::app {
namespace {

// Runs npm with `arguments`; returns its stdout, or sends it to stderr if `silent` is false.
std::string npm(const std::vector<std::string>& arguments, bool silent) {
  std::vector<std::string> command{"npm"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw Error(Error::Kind::Io, "npm", "", "", std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, silent ? pipe_ends[1] : STDERR_FILENO, STDOUT_FILENO);
  pid_t process = 0;
  const int failure = posix_spawnp(&process, "npm", &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  std::string out;
  if (failure == 0) {
    char buffer[4096];
    for (ssize_t got = 0;
         (got = read(pipe_ends[0], buffer, sizeof buffer)) > 0 || (got < 0 && errno == EINTR);)
      if (got > 0) out.append(buffer, static_cast<std::size_t>(got));
  }
  close(pipe_ends[0]);
  if (failure != 0)
    throw Error(Error::Kind::Io, "npm", "", "",
                fmt::format("cannot be started ({}); install nodejs and npm", std::strerror(failure)));
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(Error::Kind::Io, "npm", arguments.front(), printable(arguments.back()),
                "failed; its output is above");
  return out;
}

bool is_version(const std::string& text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '+';
         });
}

}  // namespace

NamedVersion named_version(const std::string& text) {
  const std::size_t at = text.find('@');
  const std::string name = text.substr(0, at);
  std::vector<std::string> names;
  for (const reference::NodeEngine& engine : reference::node_engines()) {
    names.push_back(engine.name);
    if (engine.name != name) continue;
    const std::string version = at == std::string::npos ? engine.version : text.substr(at + 1);
    if (!is_version(version))
      throw UsageError(
          fmt::format("'{}' is not a version; give numbers, like {}@{}", version, name, engine.version));
    return {engine, version};
  }
  throw UsageError(fmt::format("npm has no engine '{}' for plumb{}", name, did_you_mean(name, names)));
}

void install(const NamedVersion& wanted) {
  namespace fs = std::filesystem;
  const std::string folder = reference::folder_of(wanted.engine, wanted.version);
  std::error_code code;
  if (fs::is_directory(fs::path(folder) / "node_modules" / wanted.engine.package, code)) return;
  fs::create_directories(folder, code);
  if (code)
    throw Error(Error::Kind::Io, "folder " + plumb::quoted(folder), "", "",
                "cannot be made: " + code.message());
  try {
    // Never run a package's install scripts: they are foreign code that no engine here needs.
    npm({"install", "--ignore-scripts", "--no-audit", "--no-fund", "--no-package-lock", "--loglevel=error",
         "--prefix", folder, wanted.engine.package + "@" + wanted.version},
        false);
  } catch (const Error&) {
    fs::remove_all(folder, code);
    throw;
  }
}

std::vector<std::string> published_versions(const reference::NodeEngine& engine) {
  const auto json =
      nlohmann::json::parse(npm({"view", "--json", engine.package, "versions"}, true), nullptr, false);
  std::vector<std::string> out;
  if (json.is_array())
    for (const auto& version : json)
      if (version.is_string() && version.get<std::string>().find('-') == std::string::npos)
        out.push_back(version);
  if (out.empty()) throw Error(Error::Kind::Io, "npm", "versions", engine.package, "are not listed by npm");
  std::sort(out.begin(), out.end(), reference::older);
  return out;
}

}  // namespace plumb::app
