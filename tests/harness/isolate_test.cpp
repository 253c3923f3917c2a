#include "harness/isolate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/isolated_run.h"
#include "reference/process_backend.h"
#include "tests/harness/fakes.h"

namespace plumb::harness {
namespace {

using namespace fakes;

TEST(Isolate, HandsOverWhatIsReturned) {
  const std::string long_text(3'000'000, 'x');
  const Outcome outcome = isolate([&] { return long_text; }, 10);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Done);
  EXPECT_EQ(outcome.text, long_text);
  EXPECT_EQ(isolate([] { return std::string(); }, 10).kind, Outcome::Kind::Done);
}

TEST(Isolate, AllOfThemAFewAtATime) {
  std::vector<std::string> texts(7);
  const auto begin = std::chrono::steady_clock::now();
  isolate_all(
      texts.size(), 7, 10,
      [](std::size_t i) -> std::string {
        usleep(100'000);
        if (i == 3) throw std::runtime_error("three");
        return std::to_string(i);
      },
      [&](std::size_t i, const Outcome& outcome) {
        EXPECT_EQ(outcome.kind, i == 3 ? Outcome::Kind::Failed : Outcome::Kind::Done);
        texts[i] += outcome.text;
      });
  EXPECT_EQ(texts, (std::vector<std::string>{"0", "1", "2", "three", "4", "5", "6"}));
  const auto passed = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(std::chrono::duration<double>(passed).count(), 0.6) << "one after the other";
}

TEST(Isolate, AnExceptionIsAFailure) {
  const Outcome outcome = isolate([]() -> std::string { throw std::runtime_error("no such law"); }, 10);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Failed);
  EXPECT_EQ(outcome.text, "no such law");
}

TEST(Isolate, ACrashHasItsSignalAndLastWords) {
  const Outcome outcome = isolate(
      []() -> std::string {
        std::fprintf(stderr, "first\nassertion failed: mass > 0\n");
        std::signal(SIGABRT, SIG_DFL);
        std::abort();
      },
      10);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Crashed);
  EXPECT_EQ(outcome.text, "signal 6 (SIGABRT): assertion failed: mass > 0");
  const Outcome left = isolate([]() -> std::string { _exit(3); }, 10);
  EXPECT_EQ(left.kind, Outcome::Kind::Crashed);
  EXPECT_EQ(left.text, "exit code 3 without an answer");
}

TEST(Isolate, AHangIsStopped) {
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = isolate(
      []() -> std::string {
        while (true) pause();
      },
      0.3);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Timeout);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

/// Says, once for each name, that it is asked for the first time: by any process.
class FirstTime {
 public:
  explicit FirstTime(const char* name)
      : path_(testing::TempDir() + "/first_time_" + name + "_" + std::to_string(getpid())) {
    std::remove(path_.c_str());
  }
  ~FirstTime() { std::remove(path_.c_str()); }
  bool operator()() const {
    const int file = open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY, 0600);
    if (file >= 0) close(file);
    return file >= 0;
  }

 private:
  std::string path_;
};

TEST(Isolate, WorkThatIsKilledFromOutsideIsDoneAgain) {
  for (const int signal : {SIGKILL, SIGTERM, SIGINT, SIGHUP}) {
    const FirstTime first(std::to_string(signal).c_str());
    const Outcome outcome = isolate(
        [&]() -> std::string {
          if (first()) raise(signal);
          return "whole";
        },
        10);
    EXPECT_EQ(outcome.kind, Outcome::Kind::Done) << signal << ": " << outcome.text;
    EXPECT_EQ(outcome.text, "whole") << signal;
  }
}

TEST(Isolate, FaultsOfTheWorkAreNotTriedAgain) {
  const FirstTime first("fault");
  const Outcome outcome = isolate(
      [&]() -> std::string {
        if (first()) raise(SIGFPE);
        return "whole";
      },
      10);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Crashed);
  EXPECT_EQ(outcome.text, "signal 8 (SIGFPE)");
}

TEST(Isolate, WorkWhoseEngineIsKilledIsDoneAgain) {
  using reference::ProcessError;
  const FirstTime first("engine");
  const Outcome outcome = isolate(
      [&]() -> std::string {
        if (first()) throw ProcessError(ProcessError::Fault::Killed, "mine", "run", "it was killed");
        return "whole";
      },
      10);
  EXPECT_EQ(outcome.text, "whole");
}

// Only one signal ended it: that of the engine's program.
TEST(Isolate, AnEngineThatIsKilledEachTimeIsNamedWithItsOwnSignal) {
  using reference::ProcessError;
  const Outcome outcome = isolate(
      []() -> std::string {
        throw ProcessError(ProcessError::Fault::Killed, "mine", "run", "it was killed by signal 15");
      },
      10);
  EXPECT_EQ(outcome.kind, Outcome::Kind::Crashed);
  EXPECT_NE(outcome.text.find("signal 15, in each of 3 attempts"), std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find("SIGKILL"), std::string::npos) << outcome.text;
}

TEST(Isolate, PrintingDoesNotBlockTheChild) {
  const Outcome outcome = isolate(
      [] {
        for (int i = 0; i < 200'000; ++i) std::printf("%d: a banner that nobody asked for\n", i);
        return std::string("done");
      },
      20);
  EXPECT_EQ(outcome.text, "done");
}

IsolatedRun run_fake(Motion motion, double seconds = 20) {
  const scenarios::Scenario scenario = family(thrown);
  const Case scene_case({&scenario, "", 1}, 1.0 / 60);
  return run_isolated(scene_case, FakeBackend("fake", std::move(motion)), {}, nullptr, seconds);
}

TEST(IsolatedRun, ComesBackWhole) {
  const IsolatedRun isolated = run_fake(exactly(thrown()));
  const scenarios::Scenario scenario = family(thrown);
  const Case scene_case({&scenario, "", 1}, 1.0 / 60);
  const Result direct = run(scene_case, FakeBackend("fake", exactly(thrown())), {});
  EXPECT_EQ(to_json(isolated.result), to_json(direct));
  EXPECT_EQ(isolated.nanoseconds, 120 * 1000.0);
}

TEST(IsolatedRun, EveryEndHasAStatus) {
  const IsolatedRun failed =
      run_fake([](long, double, std::span<BodyState>) { throw std::runtime_error("too stiff"); });
  EXPECT_EQ(failed.result.status, Status::Failed);
  EXPECT_EQ(failed.result.reason, "too stiff");
  EXPECT_EQ(failed.result.engine, "fake");
  const IsolatedRun crashed = run_fake([](long, double, std::span<BodyState>) { raise(SIGKILL); });
  EXPECT_EQ(crashed.result.status, Status::Crashed);
  EXPECT_EQ(crashed.result.reason, "signal 9 (SIGKILL), in each of 3 attempts");
  const IsolatedRun hung = run_fake([](long, double, std::span<BodyState>) { sleep(100); }, 0.3);
  EXPECT_EQ(hung.result.status, Status::Timeout);
  const IsolatedRun diverged =
      run_fake([](long, double, std::span<BodyState> out) { out[0].velocity.x = NAN; });
  EXPECT_EQ(diverged.result.status, Status::Diverged);
}

}  // namespace
}  // namespace plumb::harness
