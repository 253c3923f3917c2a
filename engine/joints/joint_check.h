#pragma once

#include <optional>
#include <string>

#include "engine/joints/definitions.h"

namespace plumb {

/// Upper limit for numbers of a joint: no product of two overflows in float.
inline constexpr double kLargestJointNumber = 1e15;
/// Lower limit for numbers that must be positive: their reciprocals are no larger than the upper limit.
inline constexpr double kSmallestJointNumber = 1e-15;

/// Checks the fields of one joint; throws an Error (Value) that names the joint.
class JointCheck {
 public:
  explicit JointCheck(const char* subject) : subject_(subject) {}

  void finite(const char* field, double value) const;
  void finite(const char* field, Vec2d value) const;
  void not_negative(const char* field, double value) const;
  void positive(const char* field, double value) const;
  /// Requires a magnitude of at least `smallest`.
  void not_zero(const char* field, double value, double smallest) const;
  void axis(const char* field, Vec2d value) const;
  void spring(const char* field, const std::optional<Spring>& spring) const;
  void motor(const char* field, const std::optional<Motor>& motor) const;
  /// Bounds may be infinite, for no bound.
  void range(const char* field, const std::optional<Range>& range) const;
  [[noreturn]] void refuse(const std::string& field, double value, const std::string& problem) const;

 private:
  std::string subject_;
};

/// Throws Error (Value) if no joint can be made from the definition.
void validate(const DistanceDefinition& definition);
void validate(const RevoluteDefinition& definition);
void validate(const PrismaticDefinition& definition);
void validate(const WeldDefinition& definition);
void validate(const WheelDefinition& definition);
void validate(const MotorDefinition& definition);
void validate(const MouseDefinition& definition);
void validate(const GearDefinition& definition);
void validate(const PulleyDefinition& definition);
void validate(const RatchetDefinition& definition);
void validate(const FrictionDefinition& definition);
void validate(const JointKind& definition);

/// "distance joint", "revolute joint", ...
const char* name_of(const JointKind& definition);

/// Normalises `axis`, which is not zero.
Vec2d unit(Vec2d axis);

}  // namespace plumb
