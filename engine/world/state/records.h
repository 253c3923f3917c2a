#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/world/contact_solver/solver_body.h"
#include "engine/world/definitions.h"
#include "engine/world/events.h"

/// The records of a world's bodies, shapes, contacts and joints. They are in slots with stable indices, and
/// lists through them (a body's shapes, contacts, joints) are linked by index, -1 at the ends.
namespace plumb {

inline constexpr int kNone = -1;

/// Body data that solvers do not need: read at most once per step. A cache line in float.
template <class Real>
struct BodyRecord {
  BodyType type = BodyType::Dynamic;
  bool awake = false;  ///< in the list of awake bodies; never a static one
  bool may_sleep = true;
  bool lock_x = false, lock_y = false, lock_rotation = false;
  bool mass_given = false;
  bool quarantined = false;  ///< while so, its type is Static
  int awake_index = kNone;
  int first_shape = kNone, first_contact = kNone,
      first_joint = kNone;     ///< contact and joint: edge = 2 index + side
  int constraints = 0;         ///< contacts with points, and joints; 0: free flight
  int uncommon = kNone;        ///< index of its BodyExtras
  Real mass = 0, inertia = 0;  ///< kg, kg m^2 about the centre of mass; negative: unknown, for a static body
  Vec2<Real> centre{};         ///< m, centre of rotation in the body's frame: mass.h
  Real half_width = 0;         ///< m, smallest half width of its shapes; negative if in `mass_changed_bodies`
  Real sleep_time = 0;         ///< s, sleep timer
  double angle = 0;            ///< rad, whole turns counted

  BodyLocks locks() const { return {lock_x, lock_y, lock_rotation}; }
};
static_assert(sizeof(BodyRecord<float>) == 64);

/// Optional data of a body: name, damping, gravity scale, continuous collision.
template <class Real>
struct BodyExtras {
  std::string name{};
  Real gravity_scale = 1, linear_damping = 0, angular_damping = 0;
  Vec2<Real> mass_centre{};  ///< m, in the body's frame, if its mass was given
  bool continuous = true;
};

/// Force and torque that the user applies to a body until the end of the next step.
template <class Real>
struct Load {
  Vec2<Real> force{};  ///< N
  Real torque = 0;     ///< N m
};

/// Displacement of a body since its period of rest began: sleeping.h. In single precision, because it is
/// small.
struct RestDisplacement {
  Vec2<float> translation{};  ///< m
  float rotation = 0;         ///< rad
};

/// Linear and angular velocity of a body.
template <class Real>
struct BodyVelocity {
  Vec2<Real> velocity{};      ///< m/s
  Real angular_velocity = 0;  ///< rad/s
};

/// Motion of a body at the start of a step: step_rollback.h.
template <class Real>
struct BodyMotion {
  int body = kNone;
  SolverBody<Real> motion{};
  Rotation<Real> rotation{};
  Vec2d position{}, compensation{};  ///< m
  double angle = 0;                  ///< rad
  Real sleep_time = 0;               ///< s
  RestDisplacement rest_displacement{};
  Load<Real> load{};
};

/// A body in quarantine, and its previous type.
struct QuarantinedBody {
  int body = 0;
  BodyType type = BodyType::Dynamic;  ///< restored at release
  QuarantineEvent why{};
};

/// Collision data of a shape, in the frame of its body's centre of mass.
template <class Real>
struct ShapeForm {
  int corner = 0;  ///< first in the pool; for a chain's segment, that of the neighbour before it
  std::uint16_t count = 0;
  bool chain = false, sensor = false;
  Real radius = 0;  ///< m, of rounding
  Real extent = 0;  ///< m, half the size of the shape
  /// Returns the number of its corners in the pool.
  int stored() const { return count + (chain ? 2 : 0); }
};

template <class Real>
struct ShapeRecord {
  int body = 0;
  int next = kNone, previous = kNone;  ///< of the same body
  int proxy = kNone;
  int chain = kNone;   ///< index of its chain
  bool moved = false;  ///< in the move buffer
  bool hit_events = false, pre_solve = false;
  Filter filter{};
  Real friction = 0, restitution = 0, rolling_resistance = 0, surface_speed = 0;
  Real density = 0;  ///< kg/m^2
};

struct ChainRecord {
  int body = 0;
  std::vector<int> shapes{};
};

struct SensorRecord {
  int shape = 0;
  std::vector<ShapeId> visitors{};  ///< shapes that overlapped it after the last step, by index
};

enum class ContactHome : std::uint8_t {
  NonTouching,          ///< awake, fat AABBs overlap, no points
  Graph,                ///< awake, with points: in the constraint graph
  Sleeping,             ///< with points, all its bodies asleep
  SleepingNonTouching,  ///< without points, all its bodies asleep
};

struct ContactRecord {
  int shape_a = 0, shape_b = 0;
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};  ///< edges in the two bodies' lists
  ContactHome home = ContactHome::NonTouching;
  std::int8_t colour = 0;
  bool touching = false;  ///< as reported by events
  bool pre_solve = false, hit_events = false;
  int index = 0;  ///< index in its home
};

struct JointRecord {
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};
  int slot = 0;  ///< in the joint set
  bool collide = false, active = false;
  double break_force = 0, break_torque = 0;    ///< N, N m; 0: unbreakable
  double report_force = 0, report_torque = 0;  ///< N, N m; 0: never
  std::uint64_t user_data = 0;
};

}  // namespace plumb
