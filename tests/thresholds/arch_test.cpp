#include "harness/thresholds/arch.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

// The thinnest arch by limit analysis (Heyman's safe theorem): it stands when some line of thrust passes
// inside every joint. By symmetry a line has two unknowns, the thrust H at the crown and its moment H y, and
// each joint asks for two linear inequalities. A linear programme in two unknowns is decided by its corners.
namespace plumb::harness::thresholds {
namespace {

using Real = long double;

constexpr Real kPi = std::numbers::pi_v<Real>;

/// a H + b M >= c
struct Inequality {
  Real a, b, c;
};

struct Point {
  Real x, y;
};

/// Area of a polygon and its moment about x = 0, by the shoelace formula.
struct Weight {
  Real area = 0, moment = 0;
  void add(const std::vector<Point>& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point p = corners[i], q = corners[(i + 1) % corners.size()];
      const Real cross = p.x * q.y - q.x * p.y;
      area += cross / 2;
      moment += (p.x + q.x) * cross / 6;
    }
  }
};

// Forces that the joints of the right half ask for, from the crown down: radius 1, an even number of
// voussoirs.
std::vector<Inequality> inequalities(int voussoirs, Real thickness, Real friction) {
  const Real inner = 1 - thickness / 2, outer = 1 + thickness / 2;
  std::vector<Inequality> out;
  Weight above;  // of all voussoirs between the joint and the crown
  for (int joint = voussoirs / 2; joint >= 0; --joint) {
    const Real angle = joint * kPi / voussoirs, c = std::cos(angle), s = std::sin(angle);
    // Moments of the weight and of the crown's thrust about the joint's ends: inside both.
    out.push_back({outer * s, -1, above.moment - outer * c * above.area});
    out.push_back({-inner * s, 1, -(above.moment - inner * c * above.area)});
    // The force (H, -W) presses along (s, -c) and shears along (c, s): |T| <= friction N.
    out.push_back({friction * s - c, 0, -(friction * c + s) * above.area});
    out.push_back({friction * s + c, 0, -(friction * c - s) * above.area});
    if (joint == 0) break;
    const Real next = (joint - 1) * kPi / voussoirs, nc = std::cos(next), ns = std::sin(next);
    above.add(
        {{inner * nc, inner * ns}, {outer * nc, outer * ns}, {outer * c, outer * s}, {inner * c, inner * s}});
  }
  return out;
}

bool stands(const std::vector<Inequality>& all) {
  const auto inside = [&](Real h, Real m) {
    for (const Inequality& each : all)
      if (each.a * h + each.b * m < each.c - 1e-15L) return false;
    return h >= 0;
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Real determinant = all[i].a * all[k].b - all[k].a * all[i].b;
      if (std::abs(determinant) < 1e-12L) continue;
      if (inside((all[i].c * all[k].b - all[k].c * all[i].b) / determinant,
                 (all[i].a * all[k].c - all[k].a * all[i].c) / determinant))
        return true;
    }
  }
  return false;
}

Real thinnest(int voussoirs, Real friction) {
  Real low = 0.05L, high = 0.2L;
  while (high - low > 1e-11L) {
    const Real middle = (low + high) / 2;
    (stands(inequalities(voussoirs, middle, friction)) ? high : low) = middle;
  }
  return high;
}

TEST(Arch, TheExactValueIsThatOfLimitAnalysis) {
  EXPECT_NEAR(static_cast<double>(thinnest(kVoussoirs, 1)), kThinnestArch, 1e-9);
}

// The voussoirs press rather than slip: friction of half as much would do.
TEST(Arch, FrictionDoesNotDecide) {
  EXPECT_EQ(thinnest(kVoussoirs, 1), thinnest(kVoussoirs, 0.5L));
  EXPECT_GT(thinnest(kVoussoirs, 0.3L), 0.11L);
}

// Milankovitch's 0.1075 for a continuous ring.
TEST(Arch, ManyVoussoirsGiveThePublishedValue) {
  EXPECT_NEAR(static_cast<double>(thinnest(60, 1)), 0.1075, 1e-4);
}

// Neighbours share their corners to the bit, the springings lie level, and both halves mirror each other.
TEST(Arch, VoussoirsMeet) {
  constexpr double kThickness = 1.2;
  for (int i = 0; i + 1 < kVoussoirs; ++i) {
    const auto one = voussoir(i, kThickness), next = voussoir(i + 1, kThickness);
    EXPECT_EQ(one[3], next[0]);
    EXPECT_EQ(one[2], next[1]);
  }
  EXPECT_EQ(voussoir(0, kThickness)[0].y, 0);
  EXPECT_EQ(voussoir(kVoussoirs - 1, kThickness)[3].y, 0);
  EXPECT_DOUBLE_EQ(std::sqrt(length_squared(voussoir(3, kThickness)[1])), kArchRadius + kThickness / 2);
}

}  // namespace
}  // namespace plumb::harness::thresholds
