#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/math/vec2.h"
#include "engine/scene/geometry.h"
#include "engine/scene/joint.h"

/// One scene for every engine: plain data in SI units, double precision, y up.
namespace plumb {

/// Joints use this in place of a body's name for the fixed frame.
inline constexpr std::string_view kWorld = "world";

/// Two shapes may touch when each one's category is in the other's mask. An equal non-zero group takes
/// precedence: positive always, negative never.
struct Filter {
  std::uint64_t category = 1;
  std::uint64_t mask = ~std::uint64_t{0};
  std::int32_t group = 0;
  friend bool operator==(const Filter&, const Filter&) = default;
};

struct Shape {
  Geometry geometry;
  Vec2d position{};        ///< m, of the shape's centre in the body's frame
  double angle = 0;        ///< rad, in the body's frame
  double friction = 0.5;   ///< Coulomb coefficient, >= 0
  double restitution = 0;  ///< Newton's coefficient, 0..1
  Filter filter{};
  double rolling_resistance =
      0;                     ///< fraction of the rounding radius at which the normal force resists rolling,
                             ///< >= 0
  double surface_speed = 0;  ///< m/s, of the surface, to the right for an observer standing on it
  std::optional<double> density{};  ///< kg/m^2, >= 0; if one shape of a body has it, all must
  friend bool operator==(const Shape&, const Shape&) = default;
};

enum class BodyType : std::uint8_t { Static, Kinematic, Dynamic };

/// Path of a kinematic body, given by formulas in the time t, s (`Formula`). A coordinate without a formula
/// follows from the body's initial position and velocity.
struct PrescribedMotion {
  std::string x{}, y{};  ///< m
  std::string angle{};   ///< rad
  bool empty() const { return x.empty() && y.empty() && angle.empty(); }
  friend bool operator==(const PrescribedMotion&, const PrescribedMotion&) = default;
};

/// A rigid body. Its frame has its origin at the centre of mass.
struct Body {
  std::string name;  ///< unique, not empty, not "world"
  BodyType type = BodyType::Dynamic;
  Vec2d position{};                 ///< m, of the centre of mass
  double angle = 0;                 ///< rad, counter-clockwise
  Vec2d velocity{};                 ///< m/s, of the centre of mass
  double angular_velocity = 0;      ///< rad/s
  double mass = 1;                  ///< kg, > 0; only a dynamic body has one
  std::optional<double> inertia{};  ///< kg m^2 about the centre of mass, > 0; absent: see `inertia_of`
  bool fixed_rotation = false;
  std::vector<Shape> shapes{};
  double gravity_scale = 1;    ///< fraction of the scene's gravity that acts on the body
  double linear_damping = 0;   ///< 1/s, >= 0: the velocity decays as exp(-damping t)
  double angular_damping = 0;  ///< 1/s, >= 0: the same for the angular velocity
  bool lock_x = false;         ///< the centre of mass keeps its x
  bool lock_y = false;         ///< the centre of mass keeps its y
  PrescribedMotion motion{};   ///< of a kinematic body; its coordinates replace those above
  friend bool operator==(const Body&, const Body&) = default;
};

/// F = -coefficient v at the centre of mass, and the torque -angular_coefficient w: slow flow past a body.
struct LinearDrag {
  std::string body;
  double coefficient = 0;          ///< N s/m, >= 0
  double angular_coefficient = 0;  ///< N m s, >= 0
  friend bool operator==(const LinearDrag&, const LinearDrag&) = default;
};

/// F = -coefficient |v| v, at the centre of mass.
struct QuadraticDrag {
  std::string body;
  double coefficient = 0;  ///< N s^2/m^2, >= 0
  friend bool operator==(const QuadraticDrag&, const QuadraticDrag&) = default;
};

enum class Frame { World, Body };

/// A force at a point that moves with the body, from `start` for `duration`.
struct PointForce {
  std::string body;
  Vec2d force{};                                              ///< N, in `frame`
  Vec2d point{};                                              ///< m, in the body's frame
  Frame frame = Frame::World;                                 ///< frame of the force's direction
  double start = 0;                                           ///< s
  double duration = std::numeric_limits<double>::infinity();  ///< s
  friend bool operator==(const PointForce&, const PointForce&) = default;
};

/// A torque from `start` for `duration`.
struct Torque {
  std::string body;
  double torque = 0;                                          ///< N m, counter-clockwise
  double start = 0;                                           ///< s
  double duration = std::numeric_limits<double>::infinity();  ///< s
  friend bool operator==(const Torque&, const Torque&) = default;
};

/// Hooke's law with viscous damping along the line between two points: the tension is
/// stiffness (length - rest_length) + damping d(length)/dt; zero for coinciding points.
struct SpringForce {
  std::string body_a;  ///< a body's name, or "world"
  std::string body_b;
  Vec2d anchor_a{};        ///< m, in body a's frame
  Vec2d anchor_b{};        ///< m, in body b's frame
  double rest_length = 0;  ///< m, >= 0
  double stiffness = 0;    ///< N/m, >= 0
  double damping = 0;      ///< N s/m, >= 0
  friend bool operator==(const SpringForce&, const SpringForce&) = default;
};

/// Attraction of a body's centre of mass towards a point: F = strength m / r^exponent, m the body's mass. The
/// body that the point is fixed to feels the opposite force there. No force at r = 0.
struct AttractionForce {
  std::string body;
  std::string centre_body{kWorld};  ///< frame of `centre`: a body's name, or "world"
  Vec2d centre{};                   ///< m, in the frame of `centre_body`
  double strength = 0;              ///< m^(1 + exponent)/s^2; negative repels
  int exponent = 2;                 ///< -9..9: 2 is Newton's law, -1 a force that grows with the distance
  friend bool operator==(const AttractionForce&, const AttractionForce&) = default;
};

inline constexpr int kLargestExponent = 9;

/// A sinusoidal force at a point of the body: F = amplitude sin(angular_frequency t + phase).
struct SinusoidalForce {
  std::string body;
  Vec2d amplitude{};             ///< N, fixed in the world
  Vec2d point{};                 ///< m, in the body's frame
  double angular_frequency = 0;  ///< rad/s, >= 0
  double phase = 0;              ///< rad
  friend bool operator==(const SinusoidalForce&, const SinusoidalForce&) = default;
};

/// A force and a torque by formulas (`Formula`) in the names of `kForceVariables`: the time and the body's
/// state, for forces that vary with time, place or velocity.
struct FormulaForce {
  std::string body;
  std::string x{"0"}, y{"0"};  ///< N, along the world's axes
  std::string torque{"0"};     ///< N m, besides that of the force at `point`
  Vec2d point{};               ///< m, in the body's frame
  friend bool operator==(const FormulaForce&, const FormulaForce&) = default;
};

/// A spring between two points whose tension is a formula in the names of `kSpringVariables`, so that it may
/// follow any curve or table; zero for coinciding points.
struct FormulaSpring {
  std::string body_a;  ///< a body's name, or "world"
  std::string body_b;
  Vec2d anchor_a{};          ///< m, in body a's frame
  Vec2d anchor_b{};          ///< m, in body b's frame
  std::string tension{"0"};  ///< N; positive pulls the points together
  friend bool operator==(const FormulaSpring&, const FormulaSpring&) = default;
};

/// Names in the formulas of a `FormulaForce`: the time (s), the body's position (m), angle (rad, from -pi to
/// pi), velocity (m/s) and angular velocity (rad/s), and its mass (kg).
inline constexpr std::array<std::string_view, 8> kForceVariables{"t",  "x",  "y", "angle",
                                                                 "vx", "vy", "w", "m"};
/// Names in the formula of a `FormulaSpring`: the time (s), the distance of its points (m) and its rate
/// (m/s).
inline constexpr std::array<std::string_view, 3> kSpringVariables{"t", "length", "rate"};
/// The only name in formulas of a `PrescribedMotion` and of a `Drive`: the time (s).
inline constexpr std::array<std::string_view, 1> kTimeVariable{"t"};

using ForceLaw = std::variant<LinearDrag, QuadraticDrag, PointForce, Torque, SpringForce, AttractionForce,
                              SinusoidalForce, FormulaForce, FormulaSpring>;

/// Drives the motor of a joint at a speed that varies: it replaces the motor's own.
struct Drive {
  std::string joint;       ///< name of a joint with a motor
  std::string speed{"0"};  ///< rad/s or m/s, a formula in the time t
  friend bool operator==(const Drive&, const Drive&) = default;
};

/// Returns the names of the bodies that a law acts on: one, and another or "world" for laws between two.
std::array<std::string_view, 2> ends_of(const ForceLaw& law);

/// Combination of two shapes' coefficients into a contact's.
enum class Combine { GeometricMean, Product, Maximum, Minimum, Average };

/// Resolution of simultaneous impacts, in engines that offer a choice.
enum class Simultaneous {
  Sequence,  ///< pair by pair, fastest first, until none approaches: impacts pass along a row of balls
  Together,  ///< all at once, as one complementarity problem: none approaches, and order does not matter
};

/// Law of an impact at one contact point (engine/precise/impact_laws), in engines that offer a choice.
enum class ImpactRule {
  Newton,   ///< restitution is a ratio of velocities; gains energy in some impacts with friction
  Poisson,  ///< a ratio of impulses, with the slip followed through the impact (Routh's method)
  Stronge,  ///< the square root of a ratio of works, along the same path; never gains energy
};

struct ContactRules {
  Combine friction = Combine::GeometricMean;
  Combine restitution = Combine::Maximum;
  double restitution_threshold = 0;  ///< m/s; slower impacts do not bounce
  Simultaneous simultaneous = Simultaneous::Sequence;
  ImpactRule impact = ImpactRule::Newton;
  double yield_speed = 0;  ///< m/s, >= 0: above, restitution falls with the speed's fourth root; 0: never
  double tangential_restitution =
      0;  ///< 0..1, fraction of the slip that is restored after friction has stopped it
  double friction_after_stop =
      1;  ///< 0..1, fraction of the friction that remains in an impact after the slip has stopped
  double friction_while_sliding =
      1;  ///< 0..1, kinetic over static friction: fraction that remains while a lasting contact slips
  friend bool operator==(const ContactRules&, const ContactRules&) = default;
};

struct Scene {
  std::string name;
  Vec2d gravity{0, -9.81};  ///< m/s^2
  ContactRules contact_rules{};
  std::vector<Body> bodies{};
  std::vector<Joint> joints{};
  std::vector<ForceLaw> forces{};
  std::vector<Drive> drives{};
  friend bool operator==(const Scene&, const Scene&) = default;
};

/// The state of motion of a body. The angle counts whole turns: it is not wrapped.
struct BodyState {
  Vec2d position{};             ///< m, of the centre of mass
  double angle = 0;             ///< rad
  Vec2d velocity{};             ///< m/s
  double angular_velocity = 0;  ///< rad/s
  friend bool operator==(const BodyState&, const BodyState&) = default;
};

/// Returns the initial state of `body`; with a prescribed motion, at t = 0. Throws `std::invalid_argument` if
/// a formula is invalid.
BodyState initial_state(const Body& body);

/// Returns the rotational inertia of a dynamic body about its centre of mass, kg m^2: as given, otherwise
/// from its shapes with their densities, or with uniform density (overlaps counted twice). 0 with fixed
/// rotation. Source: `extent_of`, parallel axes.
double inertia_of(const Body& body);

/// Returns the sum of the shapes' masses by density, kg; nothing if shapes have none. A body with densities
/// has this mass.
std::optional<double> mass_by_density(const Body& body);

/// Combines coefficients `a` and `b` of two shapes into a contact's.
double combine(Combine rule, double a, double b);

/// Folds 64 category or mask bits to 32 such that a category within a mask stays within it. A test of the
/// folded bits can thus skip most pairs that the exact test would reject.
inline std::uint32_t folded(std::uint64_t bits) { return static_cast<std::uint32_t>(bits | bits >> 32); }
/// Returns true if two shapes' filters let them touch.
bool may_touch(const Filter& a, const Filter& b);

/// Returns the index of the body called `name`; nothing for "world" or an unknown name.
std::optional<std::size_t> find_body(const Scene& scene, std::string_view name);

/// Returns true if the scene has formulas: force laws, prescribed motions or drives.
bool has_formulas(const Scene& scene);

/// Returns the 64-bit FNV-1a of the scene's one-line JSON: scenes with the same bits have the same hash on
/// every platform. A negative zero counts as different from zero, though the two compare equal. Throws as
/// `to_json`.
std::uint64_t hash(const Scene& scene);

}  // namespace plumb
