#include "engine/scene/formula.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <stdexcept>
#include <string_view>

namespace plumb {
namespace {

constexpr std::array<std::string_view, 1> kT{"t"};

double value(std::string_view text, double t = 0) {
  const double now[] = {t};
  return Formula(text, kT).at(std::span<const double>(now));
}

using Long = long double;

/// A formula of t, and the same function by the C library in long double.
struct Function {
  std::string_view text;
  Long (*truth)(Long);
};
constexpr Function kFunctions[] = {
    {"sin(3*t)", [](Long t) { return std::sin(3 * t); }},
    {"cos(3*t)", [](Long t) { return std::cos(3 * t); }},
    {"tan(t/2)", [](Long t) { return std::tan(t / 2); }},
    {"asin(t/2)", [](Long t) { return std::asin(t / 2); }},
    {"acos(t/2)", [](Long t) { return std::acos(t / 2); }},
    {"atan(2*t)", [](Long t) { return std::atan(2 * t); }},
    {"atan2(t*t, 1 - t)", [](Long t) { return std::atan2(t * t, 1 - t); }},
    {"sinh(t)", [](Long t) { return std::sinh(t); }},
    {"sinh(t/9)", [](Long t) { return std::sinh(t / 9); }},
    {"cosh(t)", [](Long t) { return std::cosh(t); }},
    {"tanh(t)", [](Long t) { return std::tanh(t); }},
    {"exp(-t*t)", [](Long t) { return std::exp(-t * t); }},
    {"ln(1 + t)", [](Long t) { return std::log(1 + t); }},
    {"log10(1 + t)", [](Long t) { return std::log10(1 + t); }},
    {"sqrt(1 + t)", [](Long t) { return std::sqrt(1 + t); }},
    {"hypot(t, 2)", [](Long t) { return std::sqrt(t * t + 4); }},
    {"abs(t - 2)", [](Long t) { return std::abs(t - 2); }},
    {"mod(t*t, 0.5)", [](Long t) { return t * t - Long(0.5) * std::floor(2 * t * t); }},
    {"max(t, t*t)", [](Long t) { return std::max(t, t * t); }},
    {"(1 + t)/(2 + t*t)", [](Long t) { return (1 + t) / (2 + t * t); }},
    {"(1 + t)^3", [](Long t) { return (1 + t) * (1 + t) * (1 + t); }},
    {"(1 + t)^-2.5", [](Long t) { return std::pow(1 + t, Long(-2.5)); }},
    {"2^t", [](Long t) { return std::pow(Long(2), t); }},
    {"(1 + t)^(t*t)", [](Long t) { return std::pow(1 + t, t * t); }},
    {"t < 1 ? t^2 : t^3", [](Long t) { return t < 1 ? t * t : t * t * t; }},
};

TEST(Formula, FunctionsAndTheirDerivativesAreThoseOfTheCLibrary) {
  for (const Function& function : kFunctions) {
    const Formula formula(function.text, kT);
    for (const double t : {0.3, 0.85, 1.4}) {
      const auto f = [&](int steps) { return function.truth(t + steps * Long(0x1p-12)); };
      const Long h = 0x1p-12L;
      // Central differences of fourth order: h^4 is 4e-15, rounding 1e-19/h^2 = 2e-12 in the second.
      const Long first = (8 * (f(1) - f(-1)) - (f(2) - f(-2))) / (12 * h);
      const Long second = (16 * (f(1) + f(-1)) - (f(2) + f(-2)) - 30 * f(0)) / (12 * h * h);
      const Jet now[] = {{t, 1}};
      const Jet jet = formula.at(std::span<const Jet>(now));
      const double size = 1 + std::abs(static_cast<double>(f(0)));
      EXPECT_NEAR(jet.value, static_cast<double>(f(0)), 4e-16 * size) << function.text << " at " << t;
      EXPECT_NEAR(jet.first, static_cast<double>(first), 1e-11 * size) << function.text << " at " << t;
      EXPECT_NEAR(jet.second, static_cast<double>(second), 1e-9 * size) << function.text << " at " << t;
      EXPECT_EQ(jet.value, value(function.text, t)) << function.text << ": the same bits without derivatives";
    }
  }
}

TEST(Formula, BindsAsMathematicsDoes) {
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("8 - 4 - 2"), 2);
  EXPECT_EQ(value("8/4/2"), 1);
  EXPECT_EQ(value("2 + 3*4 < 3*5 && 1 != 2"), 1);
  EXPECT_EQ(value("0 ? 1 : 0 ? 2 : 3"), 3);
  EXPECT_EQ(value("1 || 0 && 0"), 1);
  EXPECT_EQ(value("--t", 3), 3);
}

TEST(Formula, TablesAreStraightBetweenTheirPointsAndConstantBeyond) {
  const std::string_view text = "table(t, -1, 4, 1, 0, 2, 8)";
  const struct {
    double t, value, slope;
  } rows[] = {{-3, 4, 0}, {-1, 4, 0}, {0, 2, -2}, {1.25, 2, 8}, {2, 8, 0}, {9, 8, 0}};
  for (const auto& row : rows) {
    const Jet now[] = {{row.t, 1}};
    const Jet jet = Formula(text, kT).at(std::span<const Jet>(now));
    EXPECT_EQ(jet.value, row.value) << row.t;
    EXPECT_EQ(jet.first, row.slope) << row.t;
    EXPECT_EQ(jet.second, 0) << row.t;
  }
}

TEST(Formula, RefusesWhatIsNoFormula) {
  for (const std::string_view text : {"", "1 +", "sin(t", "sin", "atan2(1)", "u", "1..2", "2 t", "t ? 1",
                                      "table(t, 1, 2)", "table(t, 1, 2, 1, 3)", "table(t, 1, t)", "(1"})
    EXPECT_THROW(Formula(text, kT), std::invalid_argument) << text;
}

// Bounds over an interval of time contain all values, and decisions that count as made are the same
// throughout.
TEST(Formula, SurveysBoundAllValuesAndDecisions) {
  const std::string_view time[] = {"t"};
  std::mt19937 draw(1);
  for (const char* text :
       {"table(t,1,0,1.5,1,2,-3)", "t > 1 && t < 1.2 ? 5 : 0", "exp(-((t-1)/0.1)^2)", "sin(7*t)*cos(3*t)",
        "abs(t-1) + sign(t-2)", "max(0, sin(t))^3", "min(t, 2-t)", "mod(t,0.3) < 0.1 ? t : -t",
        "floor(3*t)/2", "t^3 - 2*t^2 + sqrt(abs(t))", "atan2(t-1, t-2)", "1/(1+t^2)",
        "tanh(5*(t-1)) + ln(1+t*t)", "2^(-t)", "tan(t/3)", "cosh(t-1) - sinh(t)", "t < 1 || t == 2 ? 1 : 2",
        "hypot(t-1, 0.5)", "acos(t/9)"}) {
    const Formula formula(text, time);
    for (int i = 0; i < 2000; ++i) {
      const double from = std::uniform_real_distribution<double>(-3, 4)(draw);
      const double to = from + std::exp(std::uniform_real_distribution<double>(-12, 1.5)(draw));
      const Formula::Survey all = formula.survey(from, to);
      const Formula::Survey first = formula.survey(from, from);
      for (int k = 0; k <= 8; ++k) {
        const double t = std::min(from + k / 8.0 * (to - from), to);
        const double values[] = {t}, value = formula.at(values);
        if (std::isnan(value)) continue;
        EXPECT_LE(all.low, value) << text << " " << from << " " << to << " " << t;
        EXPECT_GE(all.high, value) << text << " " << from << " " << to << " " << t;
        if (all.decided) {
          EXPECT_EQ(formula.survey(t, t).decisions, first.decisions) << text << " " << from << " " << to;
        }
      }
    }
  }
}

}  // namespace
}  // namespace plumb
