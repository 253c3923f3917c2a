#include "engine/joints/joint_check.h"

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/scene/joint_fields.h"

namespace plumb {
namespace {

/// Upper limit for numbers of a joint: no product of two overflows in float.
constexpr double kLargestJointNumber = 1e15;
/// Lower limit for numbers that must be positive: their reciprocals are no larger than the upper limit.
constexpr double kSmallestJointNumber = 1e-15;

/// Checks fields of one joint by their rules in joint_fields.h.
class Check {
 public:
  explicit Check(const char* subject) : subject_(subject) {}

  void operator()(const std::string& field, double value, const FieldRule& rule) const {
    if (!(std::fabs(value) <= kLargestJointNumber)) refuse(field, value, "must be a number of at most 1e15");
    if (rule.limits == Limits::NonNegative && value < 0) refuse(field, value, "must not be negative");
    if (rule.limits == Limits::Positive && value < kSmallestJointNumber)
      refuse(field, value, "must be positive, at least 1e-15");
  }
  void operator()(const std::string& field, Vec2d value, const FieldRule& rule) const {
    (*this)(field + ".x", value.x, FieldRule{});
    (*this)(field + ".y", value.y, FieldRule{});
    if (rule.limits == Limits::NotZero && value == Vec2d{})
      refuse(field, 0, "must not be zero: a direction is wanted");
  }
  template <class T>
  void operator()(const std::string& field, const T& value, const FieldRule& joint_rule) const {
    inner_fields(value, joint_rule, [&](const char* name, double number, const FieldRule& rule) {
      if (number != rule.none) (*this)(field + "." + name, number, rule);
    });
    if constexpr (std::is_same_v<T, Range>) {
      if (value.lower > value.upper)
        refuse(field + ".lower", value.lower, "must not be above the upper bound, " + shortest(value.upper));
    }
  }
  template <class T>
  void operator()(const std::string& field, const std::optional<T>& value, const FieldRule& rule) const {
    if (value) (*this)(field, *value, rule);
  }

  // Rules of one kind.
  void whole(const DistanceDefinition& rod) const {
    if (rod.motor && !rod.spring && !rod.range)
      refuse("motor.speed", rod.motor->speed,
             "has nothing to move: a rod's length is fixed; give a spring or a range");
  }
  void whole(const GearDefinition& gear) const { not_zero("ratio", gear.ratio, 1e-9); }
  void whole(const RatchetDefinition& ratchet) const { not_zero("tooth", ratchet.tooth, 1e-6); }
  void whole(const auto&) const {}

 private:
  void not_zero(const char* field, double value, double smallest) const {
    if (std::fabs(value) < smallest)
      refuse(field, value, "must not be zero, but at least " + shortest(smallest) + " in size");
  }
  [[noreturn]] void refuse(const std::string& field, double value, const std::string& problem) const {
    throw Error(Error::Kind::Value, subject_, field, shortest(value), problem);
  }

  const char* subject_;
};

}  // namespace

void validate(const JointKind& definition) {
  const Check check(name_of(definition));
  std::visit(
      [&](const auto& kind) {
        anchor_fields(kind, check);
        own_fields(kind, check);
        check.whole(kind);
      },
      definition);
}

const char* name_of(const JointKind& definition) {
  static constexpr const char* kNames[] = {
      "distance joint", "revolute joint", "prismatic joint", "weld joint",    "wheel joint",   "motor joint",
      "mouse joint",    "gear joint",     "pulley joint",    "ratchet joint", "friction joint"};
  static_assert(std::size(kNames) == std::variant_size_v<JointKind>);
  return kNames[definition.index()];
}

}  // namespace plumb
