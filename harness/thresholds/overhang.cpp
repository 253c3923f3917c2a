#include <cmath>

#include <fmt/format.h>

#include "harness/thresholds/catalogue.h"
#include "harness/thresholds/parts.h"

// Blocks that overhang the edge of a table: n blocks reach half the harmonic number H_n times their length
// beyond it. Source: the centre of mass above each edge; Paterson and Zwick, Overhang, Am. Math. Monthly 116
// (2009).
namespace plumb::harness::thresholds {
namespace {

constexpr double kLength = 1, kHeight = 0.2, kFriction = 1;
// Squared radius of gyration about the middle of a block's lower face: (l^2 + h^2)/12 + (h/2)^2.
constexpr double kGyrationSquared = (kLength * kLength + kHeight * kHeight) / 12 + kHeight * kHeight / 4;

// Builds the stack at the table's edge, the origin. Block k, from below, overhangs its support by `shares[k]`
// of the whole overhang.
Trial over_the_edge(std::span<const double> shares, double overhang, double exact, double resolution) {
  Trial trial{.scene = {.name = "overhang", .gravity = {0, -kGravity}}};
  trial.scene.bodies = {held(block("table", 4, 2, {-2, -1}, kFriction))};
  double end = 0, height = kHeight / 2;  // m: the overhanging end, the height of the centre
  for (const double share : shares) {
    end += share * overhang;
    trial.scene.bodies.push_back(block(fmt::format("block {}", trial.scene.bodies.size()), kLength, kHeight,
                                       {end - kLength / 2, height}, kFriction));
    height += kHeight;
  }
  // The stack tilts as a whole: its arm is at most its height, and its inertia exceeds a block's by the arm
  // squared.
  const double count = static_cast<double>(shares.size()), arm = count * kHeight / 2;
  trial.duration =
      time_to_tilt(resolution / 2 * exact / count, arm, count * count * kGyrationSquared, kToppled);
  trial.broke = [](double time, std::span<const BodyState> states) {
    for (const BodyState& state : states)
      if (std::abs(state.angle) > kToppled) return fmt::format("tipped over within {:.2g} s", time);
    return std::string();
  };
  return trial;
}

constexpr const char* kJudged =
    "a block tilts by more than 0.05 rad, within 1.5 times the time that a rigid block needs if it is beyond "
    "the limit by half a unit of the last digit";

}  // namespace

Threshold overhang() {
  constexpr double kExact = 0.5;
  return {.name = "overhang",
          .title = "largest overhang of a block over an edge",
          .quantity = "largest overhang of a block / its length",
          .source = "1/2: the centre of mass above the edge",
          .judged = kJudged,
          .range = {.low = 0.3, .high = 0.7},
          .exact = exactly(kExact),
          .build = [](double value, double resolution) {
            constexpr double kShares[] = {1};
            return over_the_edge(kShares, value, kExact, resolution);
          }};
}

Threshold overhang_of_two() {
  constexpr double kExact = 0.75;
  return {.name = "overhang_of_two",
          .title = "largest overhang of two blocks over an edge",
          .quantity = "largest overhang of two blocks / their length: a third below, two thirds above",
          .source = "3/4 = (1 + 1/2) / 2, the harmonic stack",
          .judged = kJudged,
          .range = {.low = 0.45, .high = 1.05},
          .exact = exactly(kExact),
          .build = [](double value, double resolution) {
            constexpr double kShares[] = {1.0 / 3, 2.0 / 3};
            return over_the_edge(kShares, value, kExact, resolution);
          }};
}

}  // namespace plumb::harness::thresholds
