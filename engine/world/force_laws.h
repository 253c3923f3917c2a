#pragma once

#include "engine/forces/attraction.h"
#include "engine/forces/blast.h"
#include "engine/forces/elastic_spring.h"
#include "engine/forces/wind.h"
#include "engine/forces/wrench.h"
#include "engine/world/queries/query_filter.h"
#include "engine/world/world.h"

/// Force laws for a world. Each call before a step adds the forces of that one step; `dt` is its length in s.
/// Laws act on awake dynamic bodies. With `wakes` they act on sleeping ones as well, and wake those that they
/// push. All forces are computed before any is added, so a call that throws has changed nothing. SI units.
/// Functions throw Error (Value) for numbers out of their range or forces that are not finite, and Error
/// (Name) for invalid handles. They exist for BasicWorld<float> and BasicWorld<double>. They allocate nothing
/// after the first calls for a world of that size.
namespace plumb {

struct LawOptions {
  bool wakes = false;
  /// s, of the step that follows, for `apply_law` alone: the law then sees bodies as at the middle of that
  /// step (slightly earlier for bodies with contacts), which keeps the energy of springs and orbits. With 0
  /// it sees them as they are. A force held through a step that began with it feeds a spring of angular
  /// frequency w: the amplitude grows by exp(w^2 dt t / 4).
  double dt = 0;
};

/// State of a body, as passed to a law.
struct LawBody {
  BodyId id{};
  Vec2d centre{};  ///< m, centre of mass
  double angle = 0;
  Vec2d velocity{};  ///< m/s, of the centre of mass
  double angular_velocity = 0;
  double mass = 0, inertia = 0;  ///< kg, kg m^2 about the centre of mass
  std::uint64_t user_data = 0;
};

using BodyLaw = FunctionRef<Wrench<double>(const LawBody&)>;

/// Applies the user's law: force and torque (about the centre of mass) for each body. Changes to the world
/// from within the law throw Error (Unsupported). A body for which it returns a number that is not finite, or
/// beyond 1e12, is quarantined (world.h).
template <class Real>
void apply_law(BasicWorld<Real>& world, BodyLaw law, LawOptions options = {});

/// Applies F = -c v and torque -c_w w; c in N s/m, c_w in N m s. In free flight the velocity at the step's
/// end is the closed-form solution for the drag, the weight and the forces added before. No step reverses a
/// velocity.
struct LinearDragRates {
  double linear = 0, angular = 0;
};
template <class Real>
void apply_linear_drag(BasicWorld<Real>& world, const LinearDragRates& rates, double dt,
                       LawOptions options = {});
/// Applies F = -c |v| v, c in N s^2/m^2. Of second order in `dt`, exact at the terminal speed; no step
/// reverses a velocity.
template <class Real>
void apply_quadratic_drag(BasicWorld<Real>& world, double coefficient, double dt, LawOptions options = {});

/// Applies attraction to a point. In free flight it is evaluated at the middle of the step.
template <class Real>
void apply_attraction(BasicWorld<Real>& world, Vec2d centre, const Attraction& law, double dt,
                      LawOptions options = {});
/// Applies attraction to a body's centre of mass. If that body is dynamic, the reaction acts on it, which
/// conserves momentum.
template <class Real>
void apply_attraction_to_body(BasicWorld<Real>& world, BodyId centre, const Attraction& law, double dt,
                              LawOptions options = {});

/// Applies wind to the outlines of all shapes but sensors and chains. The force is limited so that it cannot
/// reverse the motion of a light body relative to the wind within the step.
template <class Real>
void apply_wind(BasicWorld<Real>& world, const Wind& wind, double dt, LawOptions options = {});

/// Water below a plane perpendicular to gravity. Buoyancy is the weight of the displaced water, and acts at
/// the centroid of the submerged part. Drag acts there too, and never reverses the motion relative to the
/// water.
struct Water {
  double level = 0;         ///< m, height of the surface along "up": y if gravity points down
  double density = 1;       ///< kg/m^2, >= 0
  Vec2d velocity{};         ///< m/s, current
  double linear_drag = 0;   ///< N s/m for each m^2 under water, >= 0
  double angular_drag = 0;  ///< N m s for each m^2 under water, >= 0
};
template <class Real>
void apply_water(BasicWorld<Real>& world, const Water& water, double dt, LawOptions options = {});

/// Applies a spring between points of two bodies (in the bodies' frames), without a joint. Acts if either
/// body is awake.
template <class Real>
void apply_spring(BasicWorld<Real>& world, BodyId a, Vec2d point_a, BodyId b, Vec2d point_b,
                  const ElasticSpring& spring, double dt, LawOptions options = {});

struct ExplosionOptions {
  bool occlusion = false;  ///< spares points that another body hides from the centre (tested by rays)
  QueryFilter cover{};     ///< shapes that can hide others
};
/// Applies a blast: immediate impulses to all dynamic bodies within its radius, sleeping ones too. A shape
/// that contains the centre is not pushed.
template <class Real>
void explode(BasicWorld<Real>& world, const Blast& blast, const ExplosionOptions& options = {});

}  // namespace plumb
