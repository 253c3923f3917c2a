#include "harness/thresholds/finding.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scene/error.h"
#include "harness/thresholds/finding_table.h"

namespace plumb::harness::thresholds {
namespace {

Finding sample() {
  return {.name = "ramp_friction",
          .title = "the friction that holds a box",
          .quantity = "friction coefficient",
          .unit = "",
          .source = "tan(theta)",
          .judged = "slides by more than 5 mm",
          .holds_below = false,
          .exact = 0.36397,
          .engine = "box2d",
          .engine_version = "2.4.1",
          .settings = {{"dt", "0.0166"}, {"substeps", "1"}},
          .found = 0.375,
          .low = 0.3749,
          .high = 0.3751,
          .reason = "slides 0.0051 m in 2.1 s",
          .runs = 14,
          .seconds = 0.5};
}

TEST(Finding, SurvivesItsJson) {
  Finding finding = sample();
  EXPECT_EQ(to_json(finding_from_json(to_json(finding))), to_json(finding));
  EXPECT_EQ(to_json(finding).substr(0, 42), R"({"kind":"threshold","name":"ramp_friction")");
  finding.outcome = Finding::Outcome::Always;
  finding.found.reset();
  finding.exact.reset();
  const Finding read = finding_from_json(to_json(finding));
  EXPECT_EQ(read.outcome, Finding::Outcome::Always);
  EXPECT_FALSE(read.found || read.exact);
  EXPECT_THROW(finding_from_json("{}"), Error);
  EXPECT_THROW(finding_from_json("["), Error);
}

TEST(Finding, IsALineOfCsv) {
  EXPECT_EQ(
      to_csv(sample()),
      "ramp_friction,,0.36397,box2d,2.4.1,default,found,0.375,0.3749,0.3751,14,slides 0.0051 m in 2.1 s");
}

TEST(Finding, IsARowForPeople) {
  std::vector<Finding> findings{sample(), sample(), sample(), sample()};
  findings[1].outcome = Finding::Outcome::Always;
  findings[1].found.reset();
  findings[1].low = 0.18;
  findings[2].outcome = Finding::Outcome::Refused;
  findings[2].reason = "no boxes";
  findings[3].found = 0.36399;
  const std::string text = finding_table(findings, {});
  for (const char* part : {"ramp_friction: the friction", "0.375", "0.36397", "+3 %", "slides 0.0051 m",
                           "holds down to 0.18", "cannot run it", "no boxes", "0.364", "< 0.1 %"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_EQ(text.find("ramp_friction", 5), std::string::npos) << "one block";
}

TEST(Finding, FiguresHaveTheirDigits) {
  EXPECT_EQ(value_text(0.5, 3, ""), "0.500");
  EXPECT_EQ(value_text(119.96, 3, "m/s"), "120 m/s");
  EXPECT_EQ(value_text(26.5651, 5, "degrees"), "26.565 degrees");
}

}  // namespace
}  // namespace plumb::harness::thresholds
