#include "harness/catalogue.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/known_limits.h"
#include "harness/needs.h"
#include "reference/backend.h"

namespace plumb::harness {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kDocs = PLUMB_SOURCE_DIR "/docs/";

std::string file_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Catalogue, IsListedInTheDocuments) {
  const std::string docs = kDocs;
  EXPECT_EQ(file_of(docs + "scenarios.md"), catalogue_page(read_agreements(docs + "agreement.jsonl")))
      << "write it anew: plumb list --page docs/agreement.jsonl > docs/scenarios.md";
}

// The page may not say otherwise than the declarations that the tests of agreement enforce.
TEST(Catalogue, TheDocumentsSayOfEachCaseWhoAgreesAsTheKnownLimitsDo) {
  std::set<std::string> cases;
  for (const CatalogueEntry& entry : catalogue()) cases.insert(entry.instance.label());
  for (const Agreement& one : read_agreements(kDocs + std::string("agreement.jsonl"))) {
    EXPECT_EQ(cases.erase(one.label), 1u) << one.label << " is not a case, or is there twice";
    EXPECT_GE(one.ran(), 2u) << one.label;
    for (const std::string& engine : one.agree)
      EXPECT_THAT(find_known_limit(known_limits(), engine, one.label, "position_error", true),
                  testing::IsNull())
          << one.label << " on " << engine;
    for (const Dissent& dissent : one.dissents) {
      EXPECT_NE(dissent.reason, "no reason is declared") << one.label << " on " << dissent.engine;
      const auto judged = [&](const reference::Backend* engine) { return engine->name() == dissent.engine; };
      if (std::ranges::none_of(reference::backends(), judged))
        continue;  // a guest's own sentence is the reason
      continue;    // its own sentence is the reason
      for (const Miss& miss : dissent.misses)
        EXPECT_THAT(find_known_limit(known_limits(), dissent.engine, one.label, miss.check, true),
                    testing::NotNull())
            << one.label << " on " << dissent.engine << ": " << miss.check;
    }
  }
  EXPECT_THAT(cases, IsEmpty()) << "docs/agreement.jsonl lacks these";
}

// Splits a text at its numbers: the words between them, and the numbers.
std::pair<std::string, std::vector<double>> parts_of(const std::string& text) {
  std::pair<std::string, std::vector<double>> out;
  for (const char* at = text.c_str(); *at != 0;) {
    char* end = nullptr;
    const bool starts = (*at >= '0' && *at <= '9') || *at == '-' || *at == '.';
    const double number = starts ? std::strtod(at, &end) : 0;
    if (starts && end != at) {
      out.second.push_back(number);
      out.first += '#';
      at = end;
    } else {
      out.first += *at++;
    }
  }
  return out;
}

TEST(Catalogue, EachScenarioHasItsPictureInTheDocuments) {
  const auto pictures = catalogue_pictures();
  EXPECT_GE(pictures.size(), scenarios::all().size());
  const std::string page = file_of(kDocs + std::string("scenarios.md"));
  for (const auto& [name, text] : pictures) {
    EXPECT_THAT(page, testing::HasSubstr("pictures/scenarios/" + name));
    const auto [words, numbers] = parts_of(text);
    const auto [kept_words, kept_numbers] = parts_of(file_of(kDocs + ("pictures/scenarios/" + name)));
    EXPECT_EQ(words, kept_words) << "draw it anew: plumb list --pictures docs/pictures/scenarios";
    // px; a coordinate on the edge of two roundings to a tenth may go either way with another compiler
    EXPECT_THAT(numbers, testing::Pointwise(testing::DoubleNear(0.11), kept_numbers)) << name;
  }
}

TEST(Catalogue, SaysWhatASceneNeeds) {
  const auto needs = [](std::string_view label) {
    return needs_of(scenarios::select(label).front().build().scene);
  };
  EXPECT_THAT(needs("harmonic_oscillator"), ElementsAre("spring force"));
  EXPECT_THAT(needs("conveyor"), ElementsAre("box", "contacts", "friction", "kinematic"));
  EXPECT_THAT(needs("hinge_limit"), ElementsAre("revolute joint", "limits"));
  EXPECT_THAT(needs("bounce/e_half"), Contains("restitution"));
  EXPECT_THAT(needs("bounce/e_0"), Not(Contains("restitution")));
  EXPECT_THAT(needs("gravity_scales"), ElementsAre("gravity_scale"));
  const std::vector<std::string>& all = all_needs();
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size()) << "a name stands for one need";
}

TEST(Catalogue, FindsCasesByTheirNeeds) {
  const auto found = catalogue({.needs = {"contacts", "restitution"}});
  ASSERT_THAT(found, Not(IsEmpty()));
  for (const CatalogueEntry& entry : found) EXPECT_THAT(entry.needs, Contains("restitution")) << entry.source;
  EXPECT_LT(found.size(), catalogue({.needs = {"contacts"}}).size());
}

TEST(Catalogue, HasSixtyCasesAndMoreInFortyFiveFiles) {
  EXPECT_GE(catalogue().size(), 60u);
  EXPECT_GE(scenarios::all().size(), 45u);
}

TEST(Catalogue, FindsCasesByTextAndByTruth) {
  const auto found = catalogue({.text = "PENDULUM", .truth = "integrated"});
  ASSERT_FALSE(found.empty());
  for (const CatalogueEntry& entry : found) EXPECT_EQ(entry.kind, scenarios::TruthKind::Integrated);
  EXPECT_TRUE(catalogue({.text = "no such text"}).empty());
}

TEST(Catalogue, TellsTopicsByTheScene) {
  for (const CatalogueEntry& entry : catalogue()) {
    const auto expect = [&](std::string_view label, Topic topic) {
      EXPECT_TRUE(entry.instance.label() != label || entry.topic == topic) << label;
    };
    expect("ramp_block/slips", Topic::LastingContacts);
    expect("ramp_block/holds", Topic::LastingContacts);
    expect("kepler", Topic::Forces);
    expect("atwood", Topic::Joints);
    expect("struck_rod/elastic", Topic::Impacts);
    expect("free_fall/vacuum", Topic::FreeMotion);
    expect("overhang[5]", Topic::Equilibrium);
  }
}

}  // namespace
}  // namespace plumb::harness
