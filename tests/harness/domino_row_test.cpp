#include "harness/reality/published/domino_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

// Van Leeuwen's model of toppling dominoes, formulated anew: every contact's force is an unknown of its own,
// every block has its own equation of rotation, the row starts as one block and grows by one an impact, and
// time is the variable of integration. The formula under test has one equation, of the first block, by its
// angle.
namespace plumb::harness::reality {
namespace {

using Vector = std::array<double, 2>;

double dot(Vector a, Vector b) { return a[0] * b[0] + a[1] * b[1]; }

/// Directions across and up a block that leans forward by `angle`.
Vector across(double angle) { return {std::cos(angle), -std::sin(angle)}; }
Vector up(double angle) { return {std::sin(angle), std::cos(angle)}; }

/// Solves a system whose rows reach one column to the left and one to the right of the diagonal.
std::vector<double> solved(std::vector<std::array<double, 4>> rows, std::vector<double> right) {
  // rows[i][k] belongs to column i - 1 + k; exchanged rows need one more to the right.
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    std::array<double, 4> next{rows[i + 1][0], rows[i + 1][1], rows[i + 1][2], 0};  // from column i on
    std::array<double, 4> own{rows[i][1], rows[i][2], rows[i][3], 0};
    if (std::abs(next[0]) > std::abs(own[0])) {
      std::swap(next, own);
      std::swap(right[i], right[i + 1]);
    }
    const double factor = next[0] / own[0];
    for (std::size_t k = 0; k < 4; ++k) next[k] -= factor * own[k];
    right[i + 1] -= factor * right[i];
    rows[i] = {0, own[0], own[1], own[2]};
    rows[i + 1] = {0, next[1], next[2], next[3]};
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = 2; k < 4; ++k)
      if (i + k - 1 < n) right[i] -= rows[i][k] * right[i + k - 1];
    right[i] /= rows[i][1];
  }
  return right;
}

/// Leaning blocks, the foremost first. Heights and the acceleration of gravity are 1, masses too.
struct Blocks {
  std::vector<double> angles, rates;
};

class Contacts {
 public:
  Contacts(double thickness, double gap, double friction)
      : thick_(thickness), pitch_(thickness + gap), friction_(friction) {}

  /// Returns the accelerations of the angles.
  std::vector<double> accelerations(const Blocks& b) const {
    std::vector<double> weights, bends;
    for (std::size_t i = 0; i < b.angles.size(); ++i) {
      // The centre of mass is half a thickness behind the foot, half the height up.
      weights.push_back((up(b.angles[i])[0] - thick_ * across(b.angles[i])[0]) / 2);
      bends.push_back(i + 1 < b.angles.size() ? -bend(b, i) : 0);
    }
    return every_second(solved(matrix(b), interleaved(weights, bends)));
  }

  /// Returns the rates after an impact in which impulses at all contacts leave no gap.
  std::vector<double> rates_after(const Blocks& b) const {
    std::vector<double> momenta;
    for (const double rate : b.rates) momenta.push_back(inertia() * rate);
    return every_second(solved(matrix(b), interleaved(momenta, std::vector<double>(b.angles.size(), 0))));
  }

  /// Returns how deep the foremost block has passed into the next one, which stands upright.
  double depth(double first_angle) const { return up(first_angle)[0] - (pitch_ - thick_); }

  double pitch() const { return pitch_; }

 private:
  double inertia() const { return (1 + thick_ * thick_) / 3; }

  /// Returns block i + 1's upper front edge as seen from the foot of block i.
  Vector edge(const Blocks& b, std::size_t i) const {
    const Vector u = up(b.angles[i + 1]);
    return {u[0] - pitch_, u[1]};
  }

  /// Returns the part of the gap's second derivative that is quadratic in the rates. The gap is the edge's
  /// distance along `across(i)` from the back of block i, which is at minus the thickness.
  double bend(const Blocks& b, std::size_t i) const {
    const double w = b.rates[i], v = b.rates[i + 1];
    const Vector e = edge(b, i), ahead = across(b.angles[i]), along = up(b.angles[i]);
    return -v * v * dot(up(b.angles[i + 1]), ahead) - 2 * v * w * dot(across(b.angles[i + 1]), along) -
           w * w * dot(e, ahead);
  }

  /// Returns the system of the accelerations (or rates) and the contacts' forces (or impulses), in turn: the
  /// rotation of block 0, contact of blocks 1 and 0, the rotation of block 1, ...
  std::vector<std::array<double, 4>> matrix(const Blocks& b) const {
    const std::size_t n = b.angles.size();
    std::vector<std::array<double, 4>> rows(2 * n - 1, {0, 0, 0, 0});
    for (std::size_t i = 0; i < n; ++i) rows[2 * i][1] = inertia();
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vector e = edge(b, i), ahead = across(b.angles[i]), along = up(b.angles[i]),
                   turn = across(b.angles[i + 1]);
      // Slip of the edge along the back of block i, whose points move along it at thickness times the rate.
      const double slip = dot(turn, along) * b.rates[i + 1] - thick_ * b.rates[i];
      const double drag = std::copysign(friction_, slip);
      const Vector force{ahead[0] + drag * along[0], ahead[1] + drag * along[1]};  // on block i
      rows[2 * i][2] = -(e[1] * force[0] - e[0] * force[1]);  // torque forward about the foot
      rows[2 * i + 2][0] = dot(turn, force);                  // reaction, at a height along block i + 1
      rows[2 * i + 1] = {-dot(e, along), 0, dot(turn, ahead), 0};
    }
    return rows;
  }

  static std::vector<double> interleaved(const std::vector<double>& even, const std::vector<double>& odd) {
    std::vector<double> out;
    for (std::size_t i = 0; i < even.size(); ++i) {
      out.push_back(even[i]);
      if (i + 1 < even.size()) out.push_back(odd[i]);
    }
    return out;
  }

  static std::vector<double> every_second(const std::vector<double>& all) {
    std::vector<double> out;
    for (std::size_t i = 0; i < all.size(); i += 2) out.push_back(all[i]);
    return out;
  }

  double thick_, pitch_, friction_;
};

/// Classical Runge-Kutta step.
Blocks stepped(const Contacts& contacts, const Blocks& b, double dt) {
  const auto moved = [&](const Blocks& slope, double h) {
    Blocks out = b;
    for (std::size_t i = 0; i < b.angles.size(); ++i) {
      out.angles[i] += h * slope.angles[i];
      out.rates[i] += h * slope.rates[i];
    }
    return out;
  };
  const auto slope = [&](const Blocks& at) { return Blocks{at.rates, contacts.accelerations(at)}; };
  const Blocks k1 = slope(b), k2 = slope(moved(k1, dt / 2)), k3 = slope(moved(k2, dt / 2)),
               k4 = slope(moved(k3, dt));
  Blocks out = b;
  for (std::size_t i = 0; i < b.angles.size(); ++i) {
    out.angles[i] += dt / 6 * (k1.angles[i] + 2 * k2.angles[i] + 2 * k3.angles[i] + k4.angles[i]);
    out.rates[i] += dt / 6 * (k1.rates[i] + 2 * k2.rates[i] + 2 * k3.rates[i] + k4.rates[i]);
  }
  return out;
}

/// Returns the speed over the root of gravity times height, from the time between the last two of `impacts`.
double speed_by_forces(double thickness, double gap, double friction, int impacts = 120, double dt = 0.02) {
  const Contacts contacts(thickness, gap, friction);
  Blocks b{{0}, {1}};
  double since = 0;
  for (int i = 0; i < impacts; ++i) {
    since = 0;
    Blocks next = stepped(contacts, b, dt);
    for (; contacts.depth(next.angles[0]) < 0; next = stepped(contacts, b, dt)) {
      b = next;
      since += dt;
    }
    double low = 0, high = dt;  // the impact is within this step
    while (high - low > 1e-15) {
      const double middle = (low + high) / 2;
      (contacts.depth(stepped(contacts, b, middle).angles[0]) < 0 ? low : high) = middle;
    }
    b = stepped(contacts, b, low);
    since += low;
    b.angles.insert(b.angles.begin(), 0);
    b.rates.insert(b.rates.begin(), 0);
    b.rates = contacts.rates_after(b);
  }
  return contacts.pitch() / since;
}

TEST(DominoRow, SpeedIsThatOfForcesAtEveryContact) {
  const double thin = 7.5 / 48;
  const struct {
    double thickness, gap, friction;
  } rows[] = {{thin, 0.100, 0.25}, {thin, 0.204, 0.25}, {thin, 0.309, 0.25}, {thin, 0.406, 0.25},
              {thin, 0.503, 0.25}, {thin, 0.600, 0.25}, {thin, 0.309, 0},    {thin, 0.309, 0.5},
              {0.1, 0.309, 0.25},  {0.25, 0.4, 0.1}};
  for (const auto& row : rows) {
    const double found = toppling_speed({1, row.thickness, row.gap, row.friction, 1});
    const double truth = speed_by_forces(row.thickness, row.gap, row.friction);
    // Both have errors of fourth order: half the steps change the truth by 1.6e-9 and the formula by 7e-10.
    EXPECT_NEAR(found, truth, 4e-9 * truth)
        << "thickness " << row.thickness << ", gap " << row.gap << ", friction " << row.friction;
  }
}

TEST(DominoRow, SpeedGrowsWithTheRootOfGravityAndHeight) {
  const double unit = toppling_speed({1, 0.2, 0.4, 0.25, 1});
  EXPECT_NEAR(toppling_speed({4, 0.8, 1.6, 0.25, 9}), 6 * unit, 1e-12);
}

TEST(DominoRow, MuchFrictionStopsTheWave) { EXPECT_EQ(toppling_speed({1, 7.5 / 48, 0.01, 2, 1}), 0); }

}  // namespace
}  // namespace plumb::harness::reality
