#include "harness/reality/published/domino_row.h"

#include <cmath>

namespace plumb::harness::reality {
namespace {

/// Number of blocks behind the first one that may still move; each is slower than the one before it.
constexpr int kBlocks = 100;
/// Blocks whose equation contributes less than this fraction of the sum are left out, and so are the blocks
/// behind them.
constexpr double kLeast = 1e-9;
constexpr int kSteps = 50;  // steps of fourth order for the first block's rotation between two impacts
/// Maximum number of impacts until the speed is constant to `kSteady`. Each impact leaves a third to nine
/// tenths of the difference.
constexpr int kImpacts = 1000;
constexpr double kSteady = 1e-13;

/// Equation of motion of the leaning blocks, for the angle of the first one: inertia * acceleration + bend *
/// rate^2 = torque. All terms are relative to m h^2 or m g h.
struct Motion {
  double inertia = 0, bend = 0, torque = 0;
};

/// Lengths are relative to the height, times to the square root of height over gravity.
class Row {
 public:
  explicit Row(const DominoRow& row)
      : thick_(row.thickness / row.height), pitch_(thick_ + row.gap / row.height), friction_(row.friction) {}

  double first_angle_at_impact() const { return std::asin(pitch_ - thick_); }
  double pitch() const { return pitch_; }

  /// Sums the equation over the blocks. Each block leans with its upper edge on the back of the block before
  /// it, where the distance across that back is the thickness. The contact's force has the arm (along -
  /// friction thickness) on the block before, and -(cos + friction sin) of the angle between the two on the
  /// block behind. Each block's equation is multiplied such that these forces cancel.
  Motion motion(double angle) const {
    const double own = (1 + thick_ * thick_) / 3;
    Motion out;
    double x = angle, rate = 1, bend = 0, share = 1;  // rate, bend: derivatives of x by the first angle
    for (int i = 0; i < kBlocks && share > kLeast; ++i) {
      out.inertia += share * own * rate;
      out.bend += share * own * bend;
      out.torque += share * (std::sin(x) - thick_ * std::cos(x)) / 2;
      const double across = pitch_ * std::cos(x) - thick_;  // sine of the angle between the two blocks
      const double cosine = std::sqrt(1 - across * across);
      const double along = cosine - pitch_ * std::sin(x);
      const double arm = along - friction_ * thick_;
      if (arm <= 0 || along <= 0) break;  // the blocks behind still lie
      share *= arm / (cosine + friction_ * across);
      // y = x + asin(across)
      const double across_1 = -pitch_ * std::sin(x) * rate;
      const double across_2 = -pitch_ * (std::cos(x) * rate * rate + std::sin(x) * bend);
      x += std::asin(across);
      rate += across_1 / cosine;
      bend += across_2 / cosine + across * across_1 * across_1 / (cosine * cosine * cosine);
    }
    return out;
  }

  /// Returns the square of the rate at the next impact, from that after the last; sets `time` to the time
  /// between them.
  double turn(double square, double& time) const {
    const double step = first_angle_at_impact() / kSteps;
    const auto slope = [&](double angle, double w2) {
      const Motion m = motion(angle);
      return 2 * (m.torque - m.bend * w2) / m.inertia;
    };
    time = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = i * step;
      const double a = slope(angle, square), b = slope(angle + step / 2, square + step / 2 * a),
                   c = slope(angle + step / 2, square + step / 2 * b),
                   d = slope(angle + step, square + step * c);
      const double next = square + step / 6 * (a + 2 * b + 2 * c + d);
      if (!(next > 0)) return 0;
      // Simpson's rule, with the square at the middle from its values and slopes at both ends.
      const double middle = (square + next) / 2 + step / 8 * (a - slope(angle + step, next));
      if (!(middle > 0)) return 0;
      time += step / 6 * (1 / std::sqrt(square) + 4 / std::sqrt(middle) + 1 / std::sqrt(next));
      square = next;
    }
    return square;
  }

  /// Returns the rate of the next block after it was struck, as a fraction of the first block's rate. The
  /// impulses obey the same sums, and all blocks except the new one move before the impact.
  double kept() const {
    const double all = motion(0).inertia, own = (1 + thick_ * thick_) / 3;
    return (all - own) / all;
  }

 private:
  double thick_, pitch_, friction_;
};

}  // namespace

double toppling_speed(const DominoRow& given) {
  const Row row(given);
  const double kept = row.kept();
  double square = 1, time = 0;  // any push will do: its effect dies away
  for (int i = 0; i < kImpacts; ++i) {
    const double before = square;
    square = kept * kept * row.turn(square, time);
    if (square == 0) return 0;
    if (std::abs(square - before) <= kSteady * square) break;
  }
  return row.pitch() / time * std::sqrt(given.gravity * given.height);
}

}  // namespace plumb::harness::reality
