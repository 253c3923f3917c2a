#include "engine/joints/joint_check.h"

#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb {

void JointCheck::refuse(const std::string& field, double value, const std::string& problem) const {
  throw Error(Error::Kind::Value, subject_, field, shortest(value), problem);
}

void JointCheck::finite(const char* field, double value) const {
  if (!(std::fabs(value) <= kLargestJointNumber)) refuse(field, value, "must be a number of at most 1e15");
}

void JointCheck::finite(const char* field, Vec2d value) const {
  finite((std::string(field) + ".x").c_str(), value.x);
  finite((std::string(field) + ".y").c_str(), value.y);
}

void JointCheck::not_negative(const char* field, double value) const {
  finite(field, value);
  if (value < 0) refuse(field, value, "must not be negative");
}

void JointCheck::positive(const char* field, double value) const {
  finite(field, value);
  if (!(value >= kSmallestJointNumber)) refuse(field, value, "must be positive, at least 1e-15");
}

void JointCheck::not_zero(const char* field, double value, double smallest) const {
  finite(field, value);
  if (std::fabs(value) < smallest)
    refuse(field, value, "must not be zero, but at least " + shortest(smallest) + " in size");
}

void JointCheck::axis(const char* field, Vec2d value) const {
  finite(field, value);
  if (value == Vec2d{}) refuse(field, 0, "must not be zero: a direction is wanted");
}

void JointCheck::spring(const char* field, const std::optional<Spring>& spring) const {
  if (!spring) return;
  positive((std::string(field) + ".hertz").c_str(), spring->hertz);
  not_negative((std::string(field) + ".damping_ratio").c_str(), spring->damping_ratio);
}

void JointCheck::motor(const char* field, const std::optional<Motor>& motor) const {
  if (!motor) return;
  finite((std::string(field) + ".speed").c_str(), motor->speed);
  not_negative((std::string(field) + ".max_force").c_str(), motor->max_force);
}

void JointCheck::range(const char* field, const std::optional<Range>& range) const {
  if (!range) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string lower = std::string(field) + ".lower", upper = std::string(field) + ".upper";
  if (range->lower != -kInfinity) finite(lower.c_str(), range->lower);
  if (range->upper != kInfinity) finite(upper.c_str(), range->upper);
  if (range->lower > range->upper)
    refuse(lower, range->lower, "must not be above the upper bound, " + shortest(range->upper));
}

void validate(const JointKind& definition) {
  std::visit([](const auto& kind) { validate(kind); }, definition);
}

const char* name_of(const JointKind& definition) {
  static constexpr const char* kNames[] = {
      "distance joint", "revolute joint", "prismatic joint", "weld joint",    "wheel joint",   "motor joint",
      "mouse joint",    "gear joint",     "pulley joint",    "ratchet joint", "friction joint"};
  static_assert(std::size(kNames) == std::variant_size_v<JointKind>);
  return kNames[definition.index()];
}

Vec2d unit(Vec2d axis) {
  // Scaled first: the square of a component must neither overflow nor underflow.
  const double largest = std::fmax(std::fabs(axis.x), std::fabs(axis.y));
  const Vec2d scaled{axis.x / largest, axis.y / largest};
  const double length = std::sqrt(length_squared(scaled));
  return {scaled.x / length, scaled.y / length};
}

}  // namespace plumb
