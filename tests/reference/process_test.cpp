// Engines as programs: the ones that keep to the protocol, and every way not to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "reference/process_backend.h"
#include "tests/reference/scenes.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Fault = ProcessError::Fault;
namespace fs = std::filesystem;

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

int open_descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

/// This process's children, dead ones that nobody has waited for included.
int children() {
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
    return make_process_backend("test", {"python3", file.string()}, "", limits);
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
      EXPECT_THAT(error.what(), AllOf(HasSubstr("engine 'test'"), HasSubstr(problem)));
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
  int descriptors_ = 0, children_ = 0;
};

TEST_F(ProcessTest, AnEngineThatKeepsToTheProtocolRuns) {
  const auto backend = script("");
  EXPECT_EQ(backend->name(), "test");
  EXPECT_EQ(backend->identity().version, "1");
  EXPECT_EQ(backend->options()[0].fallback, "4");
  EXPECT_EQ(backend->method({.dt = 0.5, .substeps = 4}).substep, 0.125);

  const Scene scene = falling({disc("a", {1, 2}), disc("b", {5, 6})});
  EXPECT_EQ(backend->unsupported(scene, {}), "");
  const Settings expected{{"dt", "0.25"}, {"sleeping", "false"}, {"name", "x"}};
  EXPECT_EQ(backend->effective_settings(scene, {.dt = 0.25}), expected);

  const auto simulator = backend->create(scene, {.dt = 0.25});
  std::vector<BodyState> states(2);
  simulator->read(states);
  EXPECT_EQ(states[1], initial_state(scene.bodies[1]));
  EXPECT_EQ(simulator->advance(3), 1234.5);
  EXPECT_EQ(simulator->time(), 0.75);
  std::vector<double> times, places;
  const double ns = simulator->record(4, 2, 2, [&](double t, std::span<const BodyState> s) {
    times.push_back(t);
    places.push_back(s[1].position.x);
  });
  EXPECT_EQ(ns, 1234.5);
  EXPECT_EQ(times, (std::vector<double>{1.25, 1.75, 2.25, 2.75}));
  EXPECT_EQ(places, (std::vector<double>{5, 7, 9, 11}));
  simulator->read(states);
  EXPECT_EQ(states[0], (BodyState{{11, 2}, 3, {4, 5}, 6}));
}

TEST_F(ProcessTest, Garbage) {
  expect_failure(engine("say('hello there\\n')"), Fault::Protocol, "it is not JSON: 'hello there'");
  expect_failure(engine("say('[1, 2]\\n')"), Fault::Protocol, "not a JSON object");
  expect_failure(engine("say('\\x00\\x01\\n')"), Fault::Protocol, "\\x00");
  expect_failure(engine("say('\\n')"), Fault::Protocol, "not JSON");
  expect_failure(engine("send({'x': 1})"), Fault::Protocol, "no \"t\"");
  expect_failure(engine("send({'done': True, 'ns': 1})"), Fault::Protocol, "no \"t\"");
  expect_failure(engine("sample(1)\nsend({'done': True})"), Fault::Protocol, "\"ns\"");
  expect_failure(engine("sample(1)\nsample(1)"), Fault::Protocol, "not \"done\"");
  expect_failure(engine("send({'t': 'x', 'states': []})"), Fault::Protocol, "\"t\"");
}

TEST_F(ProcessTest, WrongCountsAndTimes) {
  expect_failure(engine("send({'t': dt, 'states': []})"), Fault::Protocol,
                 "has 0 bodies where the scene has 1");
  expect_failure(engine("send({'t': dt, 'states': [[1, 2, 3, 4, 5, 6]] * 2})"), Fault::Protocol,
                 "has 2 bodies");
  expect_failure(engine("send({'t': dt, 'states': [[1, 2, 3, 4, 5]]})"), Fault::Protocol, "body 0");
  expect_failure(engine("send({'t': dt, 'states': [[1, 2, 3, 4, 5, 'x']]})"), Fault::Protocol, "body 0");
  expect_failure(engine("sample(2)"), Fault::Protocol, "is due");
}

TEST_F(ProcessTest, StatesThatAreNotFinite) {
  for (const char* value : {"float('nan')", "float('inf')", "None"}) {
    expect_failure(engine("send({'t': dt, 'states': [[1, 2, " + std::string(value) + ", 4, 5, 6]]})"),
                   Fault::Diverged, "not finite");
  }
  expect_failure(engine("say('{\"t\": 0.1, \"states\": [[1e999,0,0,0,0,0]]}\\n')"), Fault::Protocol, "1e999");
  expect_failure(engine("send({'error': {'kind': 'diverged', 'problem': 'it blew up'}})"), Fault::Diverged,
                 "it blew up");
}

TEST_F(ProcessTest, DeathNamesItsCauseAndTheLastWords) {
  expect_failure(engine("sys.exit(3)"), Fault::Crash, "it ended with exit code 3");
  expect_failure(engine("os.kill(os.getpid(), signal.SIGSEGV)"), Fault::Crash, "killed by signal 11");
  expect_failure(engine("say('{\"t\": 0.0')\nsys.exit(0)"), Fault::Crash, "in the middle of a line");
  expect_failure(engine("os.close(1)\ntime.sleep(60)"), Fault::Crash, "it closed its output");
  expect_failure(engine("for i in range(9): print('line', i, file=sys.stderr)\nraise RuntimeError('oops')"),
                 Fault::Crash, "RuntimeError: oops");
  expect_failure(engine("print('x' * 1000000, file=sys.stderr)\nprint('last', file=sys.stderr)\nsys.exit(1)"),
                 Fault::Crash, "last");
}

TEST_F(ProcessTest, Hanging) {
  const auto start = std::chrono::steady_clock::now();
  const ProcessLimits limits{.seconds = 0.5};
  // The time is that of a line, however slowly its bytes come.
  const std::string drip = "while True:\n    say(' ')\n    time.sleep(0.01)";
  expect_failure(engine(drip, {.seconds = 5}), Fault::Timeout, "within 5 s");
  // What ignores the polite end as well.
  expect_failure(
      engine("signal.signal(signal.SIGTERM, signal.SIG_IGN)\nos.fork()\ntime.sleep(60)", {.seconds = 5}),
      Fault::Timeout, "within 5 s");
  const auto mute = make_process_backend("mute", {"sleep", "60"}, "", limits);
  EXPECT_FALSE(mute->identity().available);
  EXPECT_THAT(mute->identity().reason, HasSubstr("it did not answer within 0.5 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(ProcessTest, AnEngineThatDoesNotReadIsNotWaitedForForEver) {
  // The scene is far larger than a pipe.
  Scene scene = falling({});
  for (int i = 0; i < 5000; ++i) scene.bodies.push_back(disc("body " + std::to_string(i), {3.0 * i, 0}));
  const auto backend = script("def hello():\n    time.sleep(60)\n", {.seconds = 1});
  EXPECT_FALSE(backend->identity().available);
  const auto deaf = script(
      "original = hello\n"
      "def hello():\n"
      "    original()\n"
      "    sys.stderr.write('e' * 1000000)\n"  // must be taken in meanwhile
      "    time.sleep(60)\n",
      {.seconds = 5});
  try {
    deaf->create(scene, {});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ProcessError& error) {
    EXPECT_EQ(error.fault(), Fault::Timeout);
    EXPECT_THAT(error.what(), HasSubstr("load"));
  }
}

TEST_F(ProcessTest, FloodsAreBounded) {
  const ProcessLimits limits{.seconds = 10, .line_bytes = 1 << 20};
  expect_failure(engine("while True: say('x' * 65536)", limits), Fault::Protocol,
                 "a line of more than 1048576 bytes");
  expect_failure(engine("while True: say('{}\\n' * 1000)", limits), Fault::Protocol, "no \"t\"");
  expect_failure(engine("sample(1)\nwhile True: say(' ' * 65536 + '\\n')", limits), Fault::Protocol,
                 "not JSON");
  // Output that nobody asked for while a long message is being sent.
  Scene scene = falling({});
  for (int i = 0; i < 5000; ++i) scene.bodies.push_back(disc("body " + std::to_string(i), {3.0 * i, 0}));
  const auto backend =
      script("original = hello\ndef hello():\n    original()\n    while True: say('x' * 65536)\n", limits);
  EXPECT_THROW(backend->create(scene, {}), ProcessError);
}

TEST_F(ProcessTest, ErrorsThatAnEngineReports) {
  const Scene scene = falling({disc("ball", {})});
  const auto typed = script(
      "def load(scene, settings):\n"
      "    send({'error': {'kind': 'value', 'field': 'iterations', 'value': '0', 'problem': 'too few'}})\n");
  try {
    typed->create(scene, {});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Value);
    EXPECT_EQ(error.field(), "iterations");
    EXPECT_THAT(error.what(), AllOf(HasSubstr("engine 'test'"), HasSubstr("too few")));
  }
  const auto plain = engine("send({'error': 'out of beans'})");
  try {
    plain->create(scene, {})->advance(1);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("out of beans"));
  }
}

TEST_F(ProcessTest, UnsupportedComesFromTheDeclarationOrFromTheEngine) {
  const auto backend = script("");
  Scene scene = falling({disc("a", {}), disc("b", {5, 0})});
  EXPECT_EQ(backend->unsupported(scene, {}), "");
  scene.bodies[0].fixed_rotation = true;
  EXPECT_THAT(backend->unsupported(scene, {}), HasSubstr("body 'a' has a fixed rotation"));
  scene.bodies[0] = of_type(disc("a", {}), BodyType::Kinematic);
  EXPECT_THAT(backend->unsupported(scene, {}), HasSubstr("body 'a' is kinematic"));
  scene.bodies[0] = disc("a", {});
  scene.bodies[0].shapes[0].filter.group = 1;
  EXPECT_THAT(backend->unsupported(scene, {}), HasSubstr("body 'a' has a collision filter"));
  scene.bodies[0] = disc("a", {});
  scene.joints = {RevoluteJoint{.name = "pin", .body_a = "a", .body_b = "b"}};
  EXPECT_THAT(backend->unsupported(scene, {}), HasSubstr("joint 'pin' is a revolute joint"));
  scene.joints.clear();
  scene.forces = {Torque{.body = "a", .torque = 1}};
  EXPECT_THAT(backend->unsupported(scene, {}), HasSubstr("torque"));
  scene.forces.clear();

  const auto picky = script("def load(scene, settings):\n    send({'unsupported': 'not on Mondays'})\n");
  EXPECT_EQ(picky->unsupported(scene, {}), "not on Mondays");
  EXPECT_THROW(picky->create(scene, {}), Error);
}

TEST_F(ProcessTest, ProgramsThatCannotBeStarted) {
  const auto missing = make_process_backend("ghost", {"plumb-no-such-program"});
  EXPECT_FALSE(missing->identity().available);
  EXPECT_THAT(missing->identity().reason,
              AllOf(HasSubstr("engine 'ghost'"), HasSubstr("plumb-no-such-program"),
                    HasSubstr("No such file or directory")));
  EXPECT_THAT(missing->unsupported(falling({}), {}), HasSubstr("cannot be started"));
  EXPECT_THROW(missing->create(falling({}), {}), Error);
  const auto folder = make_process_backend("folder", {"/"});
  EXPECT_THAT(folder->identity().reason, HasSubstr("cannot be started"));
  const auto nothing = make_process_backend("nothing", {});
  EXPECT_FALSE(nothing->identity().available);
  const auto old = script("def hello():\n    send({'protocol': 99})\n");
  EXPECT_THAT(old->identity().reason, HasSubstr("version 99 of the protocol"));
}

TEST_F(ProcessTest, WorkersAreFoundThroughTheEnvironment) {
  const fs::path file = folder_.path() / "my-engine";
  script("");
  std::ofstream(file) << "#!/bin/sh\nexec python3 " << (folder_.path() / "engine.py").string() << "\n";
  fs::permissions(file, fs::perms::owner_all);
  setenv("PLUMB_WORKER_PATH", ("/nowhere:" + folder_.path().string()).c_str(), 1);
  EXPECT_TRUE(make_process_backend("mine", {"my-engine"})->identity().available);
  unsetenv("PLUMB_WORKER_PATH");
  EXPECT_FALSE(make_process_backend("mine", {"my-engine"})->identity().available);
}

TEST_F(ProcessTest, AForkLeavesTheParentsEngineAlone) {
  const auto backend = script("");
  const Scene scene = falling({disc("ball", {})});
  ASSERT_EQ(backend->unsupported(scene, {}), "");
  const pid_t child = fork();
  if (child == 0) {
    // A different question, so that it cannot be answered from memory.
    const bool fine = backend->effective_settings(scene, {.dt = 0.5})[0].second == "0.5";
    _exit(fine ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(backend->effective_settings(scene, {.dt = 0.125})[0].second, "0.125");
}

TEST_F(ProcessTest, AnEngineDiesWithAHostThatIsKilled) {
  const fs::path file = folder_.path() / "pid";
  const auto backend = engine("with open('" + file.string() +
                              "', 'w') as f: f.write(str(os.getpid()) + '\\n')\nwhile True: pass");
  const pid_t host = fork();
  if (host == 0) {
    backend->create(falling({disc("ball", {})}), {})->advance(1);
    _exit(0);
  }
  pid_t engine_pid = 0;
  for (int i = 0; i < 1000 && engine_pid == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::ifstream(file) >> engine_pid;
  }
  kill(host, SIGKILL);
  waitpid(host, nullptr, 0);
  ASSERT_GT(engine_pid, 1);
  // Gone, or a zombie that waits for init.
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::ifstream stat("/proc/" + std::to_string(engine_pid) + "/stat");
    std::string pid, name, state;
    gone = !(stat >> pid >> name >> state) || state == "Z";
  }
  EXPECT_TRUE(gone);
  if (!gone) kill(engine_pid, SIGKILL);
}

}  // namespace
}  // namespace plumb::reference
