#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "reference/process_backend.h"
#include "tests/reference/scenes.h"

/// Engines that are written by a test, and proof that nothing of them is left behind.
namespace plumb::reference::testing {

namespace fs = std::filesystem;
using Fault = ProcessError::Fault;

/// A folder that lives as long as a test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "plumb-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

inline int open_descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

/// This process's children, dead ones that nobody has waited for included.
inline int children() {
  int count = 0;
  for (const auto& each : fs::directory_iterator("/proc")) {
    std::ifstream file(each.path() / "stat");
    std::string text;
    std::getline(file, text);
    // "pid (name) state parent ...", and the name may hold anything.
    std::istringstream rest(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    std::string state;
    pid_t parent = 0;
    if (rest >> state >> parent && parent == getpid()) ++count;
  }
  return count;
}

/// Returns true if the process that wrote its number to `file` is gone within 5 s, or a zombie that init has
/// yet to reap. One that is not gone is killed.
inline bool gone(const fs::path& file) {
  pid_t number = 0;
  std::ifstream(file) >> number;
  if (number <= 1) throw std::runtime_error("no process number in " + file.string());
  for (int i = 0; i < 500; ++i) {
    std::ifstream stat("/proc/" + std::to_string(number) + "/stat");
    std::string pid, name, state;
    if (!(stat >> pid >> name >> state) || state == "Z") return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(number, SIGKILL);
  return false;
}

class ProcessTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(std::system("python3 -c pass"), 0) << "these tests write their engines in Python 3";
    descriptors_ = open_descriptors();
    children_ = children();
  }

  void TearDown() override { EXPECT_EQ(open_descriptors(), descriptors_) << "file descriptors have leaked"; }

  /// A Python engine that answers hello and load, and whose answer to "run" (with `samples`, `every`) is
  /// `run`.
  std::unique_ptr<Backend> engine(const std::string& run, ProcessLimits limits = {.seconds = 10}) {
    return script("def run(samples, every):\n" + indented(run), limits);
  }

  /// The same, with any of hello(), load(scene, settings) and run(samples, every) replaced by `definitions`.
  std::unique_ptr<Backend> script(const std::string& definitions, ProcessLimits limits = {.seconds = 10}) {
    static constexpr const char* kStart = R"(import json, os, signal, sys, time
def say(text):
    sys.stdout.write(text)
    sys.stdout.flush()
def send(message):
    say(json.dumps(message) + "\n")
def hello():
    send({"protocol": 1, "name": "test", "version": "1", "precision": "double",
          "method": {"scheme": "velocity_verlet", "order": 2, "epsilon": 2.2e-16}, "shapes": ["circle", "box"],
          "features": ["contacts"], "options": [{"name": "iterations", "fallback": 4}]})
def load(scene, settings):
    global bodies, dt, steps
    bodies, dt, steps = len(scene["bodies"]), settings["dt"], 0
    send({"effective_settings": {"dt": dt, "sleeping": False, "name": "x"}})
def sample(every):
    global steps
    steps += every
    send({"t": steps * dt, "states": [[steps, 2, 3, 4, 5, 6]] * bodies})
def run(samples, every):
    for _ in range(samples):
        sample(every)
    send({"done": True, "ns": 1234.5})
)";
    static constexpr const char* kEnd = R"(
for line in sys.stdin:
    m = json.loads(line)
    if m["request"] == "hello": hello()
    elif m["request"] == "load": load(m["scene"], m["settings"])
    elif m["request"] == "run": run(m["samples"], m["every"])
    else: break
)";
    const fs::path file = folder_.path() / "engine.py";
    std::ofstream(file) << kStart << definitions << kEnd;
    std::vector<std::string> command = wrapper_;
    command.insert(command.end(), {"python3", file.string()});
    return make_process_backend("test", command, "", limits);
  }

  /// Runs a step and checks how it fails.
  void expect_failure(std::unique_ptr<Backend> backend, Fault fault, const std::string& problem) {
    const Scene scene = falling({disc("ball", {})});
    try {
      const auto simulator = backend->create(scene, {});
      simulator->advance(1);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const ProcessError& error) {
      EXPECT_EQ(static_cast<int>(error.fault()), static_cast<int>(fault)) << error.what();
      EXPECT_EQ(error.kind(), Error::Kind::Run);
      EXPECT_THAT(error.what(),
                  ::testing::AllOf(::testing::HasSubstr("engine 'test'"), ::testing::HasSubstr(problem)));
    }
  }

  static std::string indented(const std::string& text) {
    std::string out = "    ";
    for (const char c : text) {
      out += c;
      if (c == '\n') out += "    ";
    }
    return out + "\n";
  }

  TemporaryFolder folder_;
  std::vector<std::string> wrapper_;  ///< words before each engine's command
  int descriptors_ = 0, children_ = 0;
};

}  // namespace plumb::reference::testing
