#include <unistd.h>

#include <csignal>
#include <limits>
#include <new>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "tests/stress/fixture.h"

// Each outcome is made on purpose, and named.
namespace plumb::harness::stress {
namespace {

using States = std::span<BodyState>;

const ChildLimits kLimits{10, std::size_t{4} << 30};

Cell outcome_of(const reference::Backend& backend, const Family& what = family("mixed"),
                ChildLimits limits = kLimits) {
  Cell out;
  int cells = 0;
  run_cells({{&what, what.values.front(), &backend, {.name = "default"}}}, 1, limits,
            [&](std::size_t, const Cell& cell) {
              out = cell;
              ++cells;
            });
  EXPECT_EQ(cells, 1);
  return out;
}

Finding finding_of(fakes::Motion motion) { return outcome_of(engine("fake", std::move(motion))).finding; }

TEST(Outcomes, Ok) {
  const Cell cell = outcome_of(engine("fake"));
  EXPECT_EQ(cell.finding.verdict, Verdict::Ok) << cell.finding.reason;
  EXPECT_EQ(cell.steps, 60);
  EXPECT_EQ(cell.engine, "fake");
  EXPECT_EQ(cell.setting, "default");
  EXPECT_EQ(cell.settings, (reference::Settings{{"fake", "yes"}}));
  EXPECT_DOUBLE_EQ(cell.dt, 1.0 / 60);
  EXPECT_GT(cell.memory, 1u << 20);
  EXPECT_GT(cell.seconds, 0);
  EXPECT_NEAR(cell.engine_seconds, 60e-6, 1e-12) << "a microsecond a step, by the fake's own account";
  EXPECT_TRUE(cell.finding.reason.empty());
}

TEST(Outcomes, BySamplesOfTheRun) {
  EXPECT_EQ(finding_of([](long, double, States s) { s[0].position.y = 0.45; }).verdict, Verdict::Inaccurate);
  EXPECT_EQ(finding_of([](long, double, States s) { s[0].position.y = 0.2; }).verdict, Verdict::Sinks);
  EXPECT_EQ(
      finding_of([](long n, double, States s) { s[0].position.x = -0.7 * static_cast<double>(n); }).verdict,
      Verdict::Drifts);
  EXPECT_EQ(finding_of([](long n, double, States s) { s[2].position.y -= n > 30 ? 1 : 0; }).verdict,
            Verdict::Stretches);
  EXPECT_EQ(finding_of([](long, double, States s) { s[0].angular_velocity = -1; }).verdict, Verdict::Freezes);
  EXPECT_EQ(finding_of([](long, double, States s) { s[0].position.x = 2.5; }).verdict, Verdict::Tunnels);
  EXPECT_EQ(finding_of([](long, double, States s) { s[0].position.y *= 3; }).verdict, Verdict::Explodes);
}

TEST(Outcomes, WhatIsWorstIsSaidWithItsFigure) {
  const Finding finding = finding_of([](long, double, States s) { s[0].position = {2.5, 0.2}; });
  EXPECT_EQ(finding.verdict, Verdict::Tunnels);
  EXPECT_EQ(finding.measure, "distance past the wall");
  EXPECT_DOUBLE_EQ(finding.figure, 0.5);
  EXPECT_EQ(finding.bound, 0);
  EXPECT_EQ(finding.unit, "m");
  EXPECT_EQ(finding.reason, "distance past the wall is 0.5 m, limit 0 m");
}

TEST(Outcomes, NotANumber) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Cell cell = outcome_of(engine("fake", [bad](long n, double, States s) {
      if (n > 30) s[2].angle = bad;
    }));
    EXPECT_EQ(cell.finding.verdict, Verdict::NotFinite);
    EXPECT_EQ(name_of(cell.finding.verdict), "NaN");
    EXPECT_NE(cell.finding.reason.find("rod"), std::string::npos) << cell.finding.reason;
    EXPECT_EQ(cell.steps, 36);
  }
}

TEST(Outcomes, Crashed) {
  const Cell cell = outcome_of(engine("fake", [](long n, double, States) {
    if (n > 30) raise(SIGKILL);
  }));
  EXPECT_EQ(cell.finding.verdict, Verdict::Crashed);
  EXPECT_NE(cell.finding.reason.find("SIGKILL"), std::string::npos) << cell.finding.reason;
  EXPECT_NE(cell.finding.reason.find("after 30 steps"), std::string::npos) << cell.finding.reason;
  EXPECT_EQ(cell.steps, 30);
  EXPECT_EQ(cell.settings, (reference::Settings{{"fake", "yes"}})) << "known from before it died";
  EXPECT_EQ(finding_of([](long, double, States) { throw std::logic_error("oh"); }).verdict, Verdict::Crashed);
}

TEST(Outcomes, OutOfMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer reserves more than any limit";
#endif
  const Cell cell = outcome_of(engine("fake",
                                      [](long, double, States) {
                                        std::vector<char> much(std::size_t{8} << 30, 'x');
                                        write(STDERR_FILENO, much.data(), 1);
                                      }),
                               family("mixed"), {10, std::size_t{1} << 30});
  EXPECT_EQ(cell.finding.verdict, Verdict::Crashed);
  EXPECT_EQ(cell.finding.reason, "out of memory");
}

TEST(Outcomes, Timeout) {
  const Cell cell = outcome_of(engine("fake",
                                      [](long n, double, States) {
                                        if (n > 12) pause();
                                      }),
                               family("mixed"), {0.3});
  EXPECT_EQ(cell.finding.verdict, Verdict::Timeout);
  EXPECT_EQ(cell.finding.reason, "no end within 0.3 s, after 12 steps");
  EXPECT_GE(cell.seconds, 0.3);
  EXPECT_LE(cell.seconds, 3);
}

TEST(Outcomes, PatienceIsTheFamilys) {
  Family patient = family("mixed");
  patient.patience = 20;
  const Cell cell = outcome_of(engine("fake", [](long, double, States) { usleep(50'000); }), patient, {0.2});
  EXPECT_EQ(cell.finding.verdict, Verdict::Ok) << cell.finding.reason;
}

TEST(Outcomes, Refused) {
  const auto refuse = [](long n, double, States) {
    if (n > 30) throw Error(Error::Kind::Run, "body 'rod'", "position", "1e400", "is out of range");
  };
  const Finding finding = finding_of(refuse);
  EXPECT_EQ(finding.verdict, Verdict::Refused);
  EXPECT_NE(finding.reason.find("out of range"), std::string::npos) << finding.reason;
}

// Tells what an engine never does from a limit that it has reached.
TEST(Outcomes, SkippedIsNotRefused) {
  fakes::FakeBackend never = engine("never");
  never.unsupported_ = "it has no joints";
  EXPECT_EQ(outcome_of(never).finding.verdict, Verdict::Skipped);
  EXPECT_EQ(outcome_of(never).finding.reason, "it has no joints");

  class Limited : public fakes::FakeBackend {
   public:
    using FakeBackend::FakeBackend;
    std::string unsupported(const Scene& scene, const reference::StepSettings&) const override {
      return scene.bodies[0].mass > 3 ? "too heavy" : "";
    }
  };
  Family heavy = family("mixed", {4, 5, 6, 7, 8});
  heavy.build = [](double mass) {
    Trial trial = mixed(mass);
    trial.scene.bodies[0].mass = mass;
    return trial;
  };
  const Finding finding = outcome_of(Limited("limited", [](long, double, States) {}), heavy).finding;
  EXPECT_EQ(finding.verdict, Verdict::Refused) << "it does mass 1, the usual one";
  EXPECT_EQ(finding.reason, "too heavy");

  fakes::FakeBackend missing = engine("missing");
  missing.identity_.available = false;
  missing.identity_.reason = "install it";
  EXPECT_EQ(outcome_of(missing).finding.verdict, Verdict::Skipped);
}

TEST(Cells, AreReadBackAsTheyWere) {
  Cell cell = outcome_of(engine("fake", [](long, double, States s) { s[0].position.y = 0.2; }));
  cell.settings.emplace_back("odd", "a \"b\", \xff");
  const std::string text = to_json(cell);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const Cell back = cell_from_json(text);
  EXPECT_EQ(to_json(back), text);
  EXPECT_EQ(back.finding.figure, cell.finding.figure);
  EXPECT_EQ(key_of(back), key_of(cell));
  EXPECT_THROW(cell_from_json("{}"), Error);
  EXPECT_THROW(cell_from_json("{\"kind\":"), Error);
}

TEST(Verdicts, HaveNames) {
  for (int i = 0; i < kVerdicts; ++i) {
    const auto verdict = static_cast<Verdict>(i);
    EXPECT_EQ(verdict_of(name_of(verdict)), verdict);
    EXPECT_LE(short_name_of(verdict).size(), 6u);
    EXPECT_FALSE(meaning_of(verdict).empty());
  }
  EXPECT_THROW(verdict_of("fine"), Error);
}

}  // namespace
}  // namespace plumb::harness::stress
