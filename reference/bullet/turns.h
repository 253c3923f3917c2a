#pragma once

#include <cmath>
#include <numbers>

namespace plumb::reference {

/// The angle, whole turns included, of a body that the engine knows only as a rotation. Each update may
/// change it by less than half a turn.
class TurnCounter {
 public:
  TurnCounter() = default;

  /// `angle`, rad: the initial angle that belongs to `cosine` and `sine`, whole turns included.
  TurnCounter(double angle, double cosine, double sine) : cosine_(cosine), sine_(sine) {
    turns_ = std::round((angle - within_turn()) / (2 * std::numbers::pi));
  }

  void update(double cosine, double sine) {
    // The angle in (-pi, pi] jumps at -x: when it leaves the upper half-plane counter-clockwise, or enters it
    // clockwise.
    const bool was_upper = sine_ >= 0, is_upper = sine >= 0;
    const double turned = cosine_ * sine - sine_ * cosine;  // sine of the angle between the two
    if (was_upper && !is_upper && turned > 0) ++turns_;
    if (!was_upper && is_upper && turned < 0) --turns_;
    cosine_ = cosine;
    sine_ = sine;
  }

  double angle() const { return within_turn() + 2 * std::numbers::pi * turns_; }  ///< rad

 private:
  // + 0.0 turns a negative zero into zero; atan2 would return -pi for it.
  double within_turn() const { return std::atan2(sine_ + 0.0, cosine_); }

  double cosine_ = 1, sine_ = 0;
  double turns_ = 0;
};

}  // namespace plumb::reference
