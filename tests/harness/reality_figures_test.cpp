#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/reality/reality.h"
#include "tests/harness/made_up_measurements.h"

// Figures of the page and of the JSON, as a reader finds them: an interval for each, and shares of numerical
// error.
namespace plumb::harness::reality {
namespace {

using Json = nlohmann::json;

std::vector<const reference::Backend*> engines() {
  return {&reference::find_backend("plumb"), &reference::find_backend("bullet")};
}

/// Impacts and drops that obey Poisson's law, so that Newton's, with which the engines run, has an error.
Findings made_up_findings() {
  const EllipseLaw& poisson = ellipse_laws()[1];
  const DropLaw& of_drops = drop_laws()[1];
  Findings out;
  out.ellipse = examine_ellipse(made_up(poisson, {3.7e-4, 0.17, 0.62}), 1, engines());
  out.drops = examine_drops(made_up_drops(of_drops, {0.0302, 0, 0.01, 5.8e-4, 0.15, 0.45}), engines(), 1);
  return out;
}

const Findings& findings() {
  static const Findings all = made_up_findings();
  return all;
}

/// Reports figures without an interval that holds them. Numbers that are no figures are named one by one.
void expect_intervals(const Json& json, const std::string& path) {
  static const std::vector<std::string> kCounts{"seed",     "impacts", "doubted", "dt",   "drops",
                                                "left_out", "tested",  "failed",  "after"};
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i) expect_intervals(json[i], path + "/" + std::to_string(i));
  if (!json.is_object()) return;
  for (const auto& [key, part] : json.items()) {
    const std::string here = path + "/" + key;
    expect_intervals(part, here);
    ASSERT_FALSE(part.is_null()) << here << " is not finite";
    if (!part.is_number() || key == "low" || key == "high") continue;
    if (std::find(kCounts.begin(), kCounts.end(), key) != kCounts.end()) continue;
    ASSERT_TRUE(json.contains("low") && json.contains("high")) << here << " has no interval";
    EXPECT_LE(json["low"].get<double>(), part.get<double>()) << here;
    EXPECT_GE(json["high"].get<double>(), part.get<double>()) << here;
  }
}

/// Returns the upper end of the interval of the largest share of numerical error in any table.
double largest_share(const Json& json, const std::string& engine, double dt) {
  double largest = 0;
  const auto look = [&](const auto& self, const Json& part) -> void {
    if (part.is_object() && part.contains("high")) largest = std::max(largest, part["high"].get<double>());
    if (part.is_structured())
      for (const Json& inner : part) self(self, inner);
  };
  for (const char* body : {"ellipse", "square"})
    for (const Json& row : json[body]["engines"])
      if (row["engine"] == engine && row["dt"].get<double>() == dt) look(look, row.at("share"));
  return largest;
}

TEST(RealityFigures, EveryFigureOfTheJsonHasAnInterval) {
  const Json json = Json::parse(to_json(findings()));
  expect_intervals(json, "");
  EXPECT_EQ(json["ellipse"]["laws"].size(), ellipse_laws().size());
}

TEST(RealityFigures, EveryFigureOfThePageHasAnInterval) {
  std::string page = page_of(findings());
  const std::string number = R"([-+0-9.e]+)";
  const std::regex with_interval(number + R"( <span class="unit">\[)" + number + " " + number +
                                 R"(\]</span>)");
  const std::regex cells(R"re(<(?:td class="(?:number|wide)"|p class="note fitted")>(.*?)</(?:td|p)>)re"),
      label(R"(<br>90 %: |m\^2|1/m)");
  int figures = 0, counts = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), cells), end; at != end; ++at) {
    const std::string cell = (*at)[1];
    figures += static_cast<int>(
        std::distance(std::sregex_iterator(cell.begin(), cell.end(), with_interval), std::sregex_iterator()));
    const std::string rest = std::regex_replace(std::regex_replace(cell, with_interval, ""), label, "");
    if (std::regex_match(rest, std::regex("[1-7]")))
      ++counts;  // of a law's parameters
    else
      EXPECT_FALSE(std::regex_search(rest, std::regex("[0-9]{2}|[0-9]\\.[0-9]"))) << cell;
  }
  EXPECT_EQ(counts, static_cast<int>(ellipse_laws().size()) + 1);
  EXPECT_GT(figures, 300);
  // Labels of the pictures: what has a decimal point is a figure, if it is no tick of an axis.
  for (const std::string& picture : {ellipse_picture(findings()), engine_picture(findings())}) {
    const std::regex text(R"re(<text class="([^"]*)"[^>]*>([^<]*)</text>)re");
    for (std::sregex_iterator at(picture.begin(), picture.end(), text), end; at != end; ++at) {
      const std::string shown = (*at)[2];
      if ((*at)[1] == "soft" || !std::regex_search(shown, std::regex("[0-9]\\.[0-9]"))) continue;
      EXPECT_TRUE(std::regex_search(shown, std::regex(R"(\[.* .*\])"))) << shown;
    }
  }
}

TEST(RealityFigures, PlumbsNumericalErrorIsBelowAFiftiethOfTheLawsInEveryTable) {
  const Json json = Json::parse(to_json(findings()));
  const double share = largest_share(json, "plumb", 1 / kFramesPerSecond);
  EXPECT_GT(share, 0) << "there are no tables";
  EXPECT_LT(share, 0.02);
  if (reference::find_backend("bullet").identity().available) {
    EXPECT_GT(largest_share(json, "bullet", 1 / kFramesPerSecond), 0.02) << "the tables tell engines apart";
  }
}

TEST(RealityFigures, PlumbsNumericalErrorIsBelowAFiftiethOfTheMeasuredErrorInEveryTable) {
  const char* folder = std::getenv("PLUMB_REALITY_DATA");
  if (folder == nullptr || !missing_file(folder).empty())
    GTEST_SKIP() << "set PLUMB_REALITY_DATA to the folder of the measurements, see docs/reality.md";
  // A quarter of the impacts and of the drops.
  const auto quarter = [](auto all) {
    std::size_t i = 0;
    std::erase_if(all, [&](const auto&) { return i++ % 4 != 0; });
    return all;
  };
  Findings out;
  out.ellipse = examine_ellipse(quarter(read_impacts(std::string(folder) + "/" + kImpactFile)), 1, engines());
  out.drops = examine_drops(quarter(read_drops(std::string(folder) + "/" + kDropFile)), engines(), 1);
  const Json json = Json::parse(to_json(out));
  expect_intervals(json, "");
  EXPECT_LT(largest_share(json, "plumb", 1 / kFramesPerSecond), 0.02);
}

}  // namespace
}  // namespace plumb::harness::reality
