// Engines as programs: the ones that keep to the protocol, and every way not to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/reference/process_fixture.h"

namespace plumb::reference {
namespace {

using namespace plumb::reference::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

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
  expect_failure(engine("sample(2)"), Fault::Time, "is due");
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

TEST_F(ProcessTest, AnswersThatNobodyAskedForAreNotTakenForOthers) {
  const Scene scene = falling({disc("ball", {})});
  const auto backend = engine("sample(1)\nsend({'done': True, 'ns': 1})\nsend({'done': True, 'ns': 1})");
  const auto simulator = backend->create(scene, {});
  EXPECT_EQ(simulator->advance(1), 1);
  try {
    simulator->advance(1);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const ProcessError& error) {
    EXPECT_EQ(error.fault(), Fault::Protocol) << error.what();
  }
}

TEST_F(ProcessTest, EnginesThatFailAtTheStartAreNotAvailable) {
  const struct {
    const char* hello;
    const char* reason;
  } cases[] = {{"sys.exit(7)", "exit code 7"},
               {"os.kill(os.getpid(), signal.SIGABRT)", "killed by signal 6"},
               {"say('{\"protocol\": 1')\n    sys.exit(0)", "in the middle of a line"},
               {"say('hi\\n')", "not JSON"},
               {"say('\\x00\\xff\\n')", "not JSON"},
               {"say('[' * 100000 + '\\n')", "nests too deep"},
               {"say('{}\\n')", "protocol"},
               {"send({'protocol': '1'})", "protocol"},
               {"send({'protocol': 1, 'name': 7})", "\"name\""},
               {"os.close(1)\n    time.sleep(60)", "closed its output"},
               {"while True: say('x' * 65536)", "a line of more than"}};
  for (const auto& each : cases) {
    const auto backend =
        script(std::string("def hello():\n    ") + each.hello + "\n", {.seconds = 10, .line_bytes = 1 << 20});
    EXPECT_FALSE(backend->identity().available) << each.hello;
    EXPECT_THAT(backend->identity().reason, HasSubstr(each.reason)) << each.hello;
    EXPECT_THROW(backend->create(falling({}), {}), Error) << each.hello;
  }
}

TEST_F(ProcessTest, EnginesThatIgnoreSignalsAreEndedAllTheSame) {
  const fs::path file = folder_.path() / "pid";
  expect_failure(engine("for s in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE):\n"
                        "    signal.signal(s, signal.SIG_IGN)\n"
                        "with open('" +
                            file.string() + "', 'w') as f: f.write(str(os.getpid()))\nwhile True: pass",
                        {.seconds = 3}),
                 Fault::Timeout, "within 3 s");
  EXPECT_TRUE(gone(file));
}

TEST_F(ProcessTest, DeathNamesItsCauseAndTheLastWords) {
  expect_failure(engine("sys.exit(3)"), Fault::Crash, "it ended with exit code 3");
  expect_failure(engine("os.kill(os.getpid(), signal.SIGSEGV)"), Fault::Crash, "killed by signal 11");
  expect_failure(engine("os.kill(os.getpid(), signal.SIGKILL)"), Fault::Killed, "killed by signal 9");
  expect_failure(engine("say('{\"t\": 0.0')\nsys.exit(0)"), Fault::Crash, "in the middle of a line");
  // Deaf when it answers "load": the next request goes nowhere, and the host survives that.
  expect_failure(
      script("answer = load\ndef load(scene, settings):\n    os.close(0)\n    answer(scene, settings)\n"
             "    sys.exit(4)\n"),
      Fault::Crash, "it ended with exit code 4");
  expect_failure(engine("os.close(1)\ntime.sleep(60)"), Fault::Crash, "it closed its output");
  expect_failure(engine("for i in range(9): print('line', i, file=sys.stderr)\nraise RuntimeError('oops')"),
                 Fault::Crash, "RuntimeError: oops");
  expect_failure(engine("print('x' * 1000000, file=sys.stderr)\nprint('last', file=sys.stderr)\nsys.exit(1)"),
                 Fault::Crash, "last");
}

TEST_F(ProcessTest, EnginesThatAreKilledFromOutsideAreAskedAgain) {
  for (const std::string request : {"hello()", "load(scene, settings)"}) {
    const fs::path file = folder_.path() / request.substr(0, 4);
    const auto backend =
        script("answer = " + request.substr(0, request.find('(')) + "\ndef " + request +
               ":\n    if not os.path.exists('" + file.string() + "'):\n        open('" + file.string() +
               "', 'w').close()\n        os.kill(os.getpid(), signal.SIGKILL)\n" + "    return answer" +
               request.substr(request.find('(')) + "\n");
    EXPECT_TRUE(backend->identity().available) << backend->identity().reason;
    EXPECT_EQ(backend->unsupported(falling({}), {}), "") << request;
    EXPECT_TRUE(fs::exists(file)) << "it was killed in " << request;
  }
}

TEST_F(ProcessTest, Hanging) {
  const auto start = std::chrono::steady_clock::now();
  const ProcessLimits limits{.seconds = 0.5};
  // The time is that of a line, however slowly its bytes come.
  const std::string drip = "while True:\n    say(' ')\n    time.sleep(0.01)";
  expect_failure(engine(drip, {.seconds = 5}), Fault::Timeout, "within 5 s");
  // Its child processes go with it.
  const fs::path file = folder_.path() / "pid";
  expect_failure(engine("if os.fork() == 0:\n    with open('" + file.string() +
                            "', 'w') as f: f.write(str(os.getpid()))\ntime.sleep(60)",
                        {.seconds = 5}),
                 Fault::Timeout, "within 5 s");
  EXPECT_TRUE(gone(file));
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
  EXPECT_THAT(make_process_backend("folder", {"/"})->identity().reason, HasSubstr("cannot be started"));
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
  auto backend = script("");
  const Scene scene = falling({disc("ball", {})});
  ASSERT_EQ(backend->unsupported(scene, {}), "");
  const pid_t child = fork();
  if (child == 0) {
    // A different question, so that it cannot be answered from memory.
    const bool fine = backend->effective_settings(scene, {.dt = 0.5})[0].second == "0.5";
    backend.reset();
    _exit(fine ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(backend->effective_settings(scene, {.dt = 0.125})[0].second, "0.125");
}

// A shell that stays, as a wrapper script does which has something left to do.
const std::vector<std::string> kWrapper{"sh", "-c", "\"$@\"; exit $?", "wrapper"};

// Keeps running whatever asks it to end, having written its number down.
std::string deaf_engine(const fs::path& file, const std::string& before = "") {
  return before +
         "for s in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP): signal.signal(s, signal.SIG_IGN)\n" +
         "with open('" + file.string() +
         "', 'w') as f: f.write(str(os.getpid()))\nwhile True: time.sleep(0.01)";
}

TEST_F(ProcessTest, AnEngineBehindAWrapperEndsWithItsTime) {
  wrapper_ = kWrapper;
  const fs::path file = folder_.path() / "pid";
  expect_failure(engine(deaf_engine(file), {.seconds = 5}), Fault::Timeout, "within 5 s");
  EXPECT_TRUE(gone(file));
}

TEST_F(ProcessTest, AnEngineThatLeftForASessionOfItsOwnEndsWithItsTime) {
  const fs::path file = folder_.path() / "pid";
  expect_failure(engine("if os.fork() == 0:\n    os.setsid()\n    if os.fork() > 0: os._exit(0)\n" +
                            indented(deaf_engine(file)) + "while True: time.sleep(0.01)",
                        {.seconds = 5}),
                 Fault::Timeout, "within 5 s");
  EXPECT_TRUE(gone(file));
}

TEST_F(ProcessTest, AnEngineThatDiesAndLeavesAChildOnThePipeIsNoticedAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  const fs::path file = folder_.path() / "pid";
  expect_failure(engine("if os.fork() == 0:\n" + indented(deaf_engine(file)) + "while not os.path.exists('" +
                            file.string() + "'): time.sleep(0.01)\nos._exit(3)",
                        {.seconds = 60}),
                 Fault::Crash, "it ended with exit code 3");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_TRUE(gone(file));
}

TEST_F(ProcessTest, LongDescriptionsAreRefusedAtABound) {
  const auto many = script(
      "def hello():\n    options = [{'name': 'o%d' % i, 'fallback': '1'} for i in range(1001)]\n"
      "    send({'protocol': 1, 'name': 'test', 'version': '1', 'precision': 'double',\n"
      "          'method': {'scheme': 'velocity_verlet', 'order': 2, 'epsilon': 2.2e-16},\n"
      "          'shapes': [], 'options': options})\n");
  EXPECT_THAT(many->identity().reason, HasSubstr("\"options\" has 1001 entries; at most 1000"));
  const auto long_one = script("def hello():\n    say('{\"summary\": \"' + 'x' * 50000000 + '\"}\\n')\n");
  EXPECT_THAT(long_one->identity().reason, HasSubstr("a line of more than 1048576 bytes"));
  const auto settings = script(
      "def load(scene, settings):\n    send({'effective_settings': {str(i): i for i in range(1001)}})\n");
  EXPECT_THROW(settings->effective_settings(falling({}), {}), ProcessError);
}

TEST_F(ProcessTest, ControlCharactersInWhatAnEngineSaysAreEscaped) {
  const auto backend = script(
      "def hello():\n"
      "    send({'protocol': 1, 'name': 'test', 'version': '\\x1b[2J1', 'precision': 'double',\n"
      "          'summary': '\\x07', 'method': {'scheme': 'velocity_verlet', 'order': 2, 'epsilon': "
      "2.2e-16},\n"
      "          'shapes': ['circle'], 'options': [{'name': 'a', 'fallback': 1, 'help': '\\x1b[31m'}]})\n"
      "def load(scene, settings):\n    send({'effective_settings': {'\\x1b': '\\x9b'}})\n");
  EXPECT_EQ(backend->identity().version, "\\x1b[2J1");
  EXPECT_EQ(backend->options()[0].help, "\\x1b[31m");
  EXPECT_EQ(backend->effective_settings(falling({}), {}), (Settings{{"\\x1b", "\\xc2\\x9b"}}));
  const auto named = script(
      "def hello():\n"
      "    send({'protocol': 1, 'name': 'test', 'version': '1', 'precision': 'double',\n"
      "          'method': {'scheme': 'velocity_verlet', 'order': 2, 'epsilon': 2.2e-16},\n"
      "          'shapes': [], 'options': [{'name': '\\x1b', 'fallback': 1}]})\n");
  EXPECT_THAT(named->identity().reason, HasSubstr("control characters"));
}

TEST_F(ProcessTest, AnEngineDiesWithAHostThatIsKilled) {
  const fs::path file = folder_.path() / "pid";
  const auto backend =
      engine("with open('" + file.string() + "', 'w') as f: f.write(str(os.getpid()))\nwhile True: pass");
  const pid_t host = fork();
  if (host == 0) {
    backend->create(falling({disc("ball", {})}), {})->advance(1);
    _exit(0);
  }
  for (int i = 0; i < 1000 && !(fs::exists(file) && fs::file_size(file) > 0); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(host, SIGKILL);
  waitpid(host, nullptr, 0);
  EXPECT_TRUE(gone(file));
}

TEST_F(ProcessTest, AnEngineBehindAWrapperDiesWithAHostThatIsKilled) {
  wrapper_ = kWrapper;
  const fs::path file = folder_.path() / "pid";
  const auto backend = engine(deaf_engine(file));
  const pid_t host = fork();
  if (host == 0) {
    backend->create(falling({disc("ball", {})}), {})->advance(1);
    _exit(0);
  }
  for (int i = 0; i < 1000 && !(fs::exists(file) && fs::file_size(file) > 0); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(host, SIGKILL);
  waitpid(host, nullptr, 0);
  EXPECT_TRUE(gone(file));
}

}  // namespace
}  // namespace plumb::reference
