#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "engine/math/vec2.h"

/// Edits of the learner's formulas: in one place, one quantity of a body stands where another should.
namespace plumb::course {

/// Rows of the engine: each closes the speed or the gap of two bodies. They are bits, because a learner may
/// share code between rows.
enum Row : unsigned {
  kContactRow = 1,
  kFrictionRow = 2,
  kOverlapRow = 4,
  kJointRow = 8,
  kCorrectionRow = 16
};

/// Places in a row's formulas: the relative speed, the effective mass, the change of the two bodies, and a
/// joint's gap C.
enum Place : unsigned { kInSpeed = 1, kInMass = 2, kInChange = 4, kInGap = 8 };

/// `PointVelocity` stands for the velocity and the spin of a body, together.
enum class Quantity { None, Arm, InverseMass, InverseInertia, Velocity, Spin, PointVelocity };

/// Replacement of a quantity. `Raw` is the point itself for a contact's arm, the unrotated anchor for a
/// joint's arm, the inverse mass for an inverse inertia, and the inverse inertia for an inverse mass.
/// `Finite` is 1 in place of 0, as of a static body with a mass of 1 kg.
enum class Instead { Others, Zero, Minus, One, Inverse, Raw, Finite };

struct Edit {
  Quantity quantity = Quantity::None;
  unsigned rows = 0, places = 0;
  unsigned bodies = 0;  ///< bit 0: the first, bit 1: the second
  Instead instead = Instead::Others;

  /// Returns the edit as text, for `make_student`, and back.
  std::string text() const;
  static std::optional<Edit> read(std::string_view text);

  /// Returns the values of both bodies after this edit.
  template <class T>
  std::array<T, 2> operator()(Quantity what, Row row, Place place, std::array<T, 2> own,
                              std::array<T, 2> raw = {}) const {
    if (quantity != what || (rows & row) == 0 || (places & place) == 0) return own;
    std::array<T, 2> out = own;
    for (std::size_t i = 0; i < 2; ++i)
      if ((bodies >> i & 1U) != 0) out[i] = replaced(own[i], own[1 - i], raw[i]);
    return out;
  }

 private:
  Vec2d replaced(Vec2d own, Vec2d others, Vec2d raw) const;
  double replaced(double own, double others, double raw) const;
};

}  // namespace plumb::course
