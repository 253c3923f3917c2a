#pragma once

#include <cstdint>
#include <string>

#include "engine/geometry/convex_mass.h"
#include "engine/world/definitions.h"

/// Rejects bad input before anything changes: each function throws Error (Value) that names the subject, its
/// field and the value.
namespace plumb {

void validate(const WorldDefinition& definition);
/// Throws Error (Value) for a number of threads that a world cannot have.
void require_threads(int threads);
void validate(const BodyDefinition& definition);
void validate(const ShapeDefinition& definition);
void validate(const ChainDefinition& definition);
void validate(const JointDefinition& definition);
void validate(BodyType type);
void validate(const std::string& subject, const Material& material);

/// Checks a shape that gives a dynamic body mass by its density: throws Error (Value) if float cannot hold
/// mass, inertia and their reciprocals. Double can, for all valid input.
void require_float_mass(const ShapeDefinition& definition);
/// Does the same; `part` is relative to the body's origin or its centre of mass.
void require_float_mass(double density, const ConvexMass& part);

/// Checks a number or vector of a call: finite and at most kLargestNumber in magnitude.
void require_finite(const std::string& subject, const std::string& field, double value);
void require_finite(const std::string& subject, const std::string& field, Vec2d value);
void require_not_negative(const std::string& subject, const std::string& field, double value);
void require_positive(const std::string& subject, const std::string& field, double value);
/// Checks an inertia, kg m^2: from kSmallestInertia to its inverse.
void require_inertia(const std::string& subject, double value);

/// Checks a position that is used only for reading: any finite value is allowed.
void require_query_position(const std::string& subject, const std::string& field, Vec2d value);

/// Limits beyond which squares and cubes of a float would not be finite.
inline constexpr double kLargestNumber = 1e12;
inline constexpr double kSmallestNumber = 1e-12;
/// m or rad: limit of positions and sizes; valid calls and steps lead to none beyond it. A position within
/// 1e12 m and the arms of shapes and centres of mass, of a few 1e12 m, may add up. Squares of this limit fit
/// into a float, and boxes that grow from there stay finite.
inline constexpr double kMaxPosition = 100 * kLargestNumber;
/// For comparison: a box of 1e-6 m and 1e-12 kg has 1e-25 kg m^2. Inverses, and their products with lever
/// arms of the body's size, fit into a float.
inline constexpr double kSmallestInertia = 1e-30;
inline constexpr double kLargestInertia = 1e30;
/// kg; the smallest may be below 1e-12, for a body of 1e-6 m.
inline constexpr double kLargestMass = 1e18;
/// Limits of mass and inertia in float worlds: the reciprocal of the smallest is finite in float, and so is
/// the sum of hundreds of the largest.
inline constexpr double kSmallestFloatMass = 1e-36, kLargestFloatMass = 1e36;

/// Maximum number of steps of a world: doubles represent every integer up to here. It lasts 285,000 years at
/// a thousand steps per second.
inline constexpr std::int64_t kMaxSteps = std::int64_t{1} << 53;

}  // namespace plumb
