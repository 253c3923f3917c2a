#pragma once

#include <cstdint>
#include <string>

#include "engine/geometry/convex_mass.h"
#include "engine/world/definitions.h"

/// Bad input is refused before anything changes: each function throws Error (Value) that names the thing, its
/// field and the value.
namespace plumb {

void validate(const WorldDefinition& definition);
void validate(const BodyDefinition& definition);
void validate(const ShapeDefinition& definition);
void validate(const ChainDefinition& definition);
void validate(const JointDefinition& definition);
void validate(BodyType type);

/// A shape that gives a dynamic body mass by its density: Error (Value) where a float would not hold mass,
/// inertia and their reciprocals. A double holds them for whatever is valid.
void require_weight(const ShapeDefinition& definition);
/// `part` is seen from the body's origin or its centre of mass.
void require_weight(double density, const ConvexMass& part);

/// A single number or vector of a call: finite and, in size, at most kLargestNumber.
void require_finite(const std::string& subject, const std::string& field, double value);
void require_finite(const std::string& subject, const std::string& field, Vec2d value);
void require_not_negative(const std::string& subject, const std::string& field, double value);
void require_positive(const std::string& subject, const std::string& field, double value);
/// kg m^2: from kSmallestInertia to its inverse.
void require_inertia(const std::string& subject, double value);

/// A place that is only read at: finite, and so is what follows from it.
void require_place(const std::string& subject, const std::string& field, Vec2d value);

/// Beyond this, squares and cubes of a float would not be finite.
inline constexpr double kLargestNumber = 1e12;
inline constexpr double kSmallestNumber = 1e-12;
/// A box of 1e-6 m and 1e-12 kg has 1e-25 kg m^2. Inverses, and their products with levers of a body's own
/// size, are floats.
inline constexpr double kSmallestInertia = 1e-30;
inline constexpr double kLargestInertia = 1e30;
/// kg: a body of 1e-6 m may have less than 1e-12.
inline constexpr double kLargestMass = 1e18;
/// Masses and inertias of float worlds: a float's reciprocal of the smallest is finite, and hundreds of the
/// largest are.
inline constexpr double kSmallestWeight = 1e-36, kLargestWeight = 1e36;

/// Steps of a world: a double holds each number up to here. A thousand a second take 285,000 years.
inline constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;

}  // namespace plumb
