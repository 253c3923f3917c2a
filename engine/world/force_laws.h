#pragma once

#include "engine/forces/attraction.h"
#include "engine/forces/blast.h"
#include "engine/forces/elastic_spring.h"
#include "engine/forces/wind.h"
#include "engine/forces/wrench.h"
#include "engine/world/query_filter.h"
#include "engine/world/world.h"

/// Laws of force for a world: each call before a step adds the forces of that one step, and `dt` is its
/// length in s. Laws act on dynamic bodies that are awake; with `wakes` they act on sleeping ones as well,
/// and wake those that they push. All laws are computed before any force is added: a call that throws has
/// changed nothing. SI units.
///
/// Functions throw Error (Value) for numbers out of their range or forces that are not finite, and Error
/// (Name) for handles of what is gone. Exist for BasicWorld<float> and BasicWorld<double>. They allocate
/// nothing once a world of the size was seen.
namespace plumb {

struct LawOptions {
  bool wakes = false;
};

/// A body as a law sees it.
struct LawBody {
  BodyId id{};
  Vec2d centre{};  ///< m, of mass
  double angle = 0;
  Vec2d velocity{};  ///< m/s, of the centre of mass
  double angular_velocity = 0;
  double mass = 0, inertia = 0;  ///< kg, kg m^2 about the centre of mass
  std::uint64_t user_data = 0;
};

using BodyLaw = FunctionRef<Wrench<double>(const LawBody&)>;

/// A law of one's own: force and torque (about the centre of mass) on each body. Calls that would change the
/// world throw Error (Unsupported) from within it. A body for which it returns what is not finite, or beyond
/// 1e12, is quarantined (world.h).
template <class Real>
void apply_law(BasicWorld<Real>& world, BodyLaw law, LawOptions options = {});

/// F = -c v and torque -c_w w; c in N s/m, c_w in N m s. In free flight the step ends at the velocity that
/// the law, the weight and the forces added before have in closed form; no step reverses a velocity.
struct LinearDragRates {
  double linear = 0, angular = 0;
};
template <class Real>
void apply_linear_drag(BasicWorld<Real>& world, const LinearDragRates& rates, double dt,
                       LawOptions options = {});
/// F = -c |v| v, c in N s^2/m^2; likewise, exact at the terminal speed.
template <class Real>
void apply_quadratic_drag(BasicWorld<Real>& world, double coefficient, double dt, LawOptions options = {});

/// Attraction to a point, evaluated at the middle of the step.
template <class Real>
void apply_attraction(BasicWorld<Real>& world, Vec2d centre, const Attraction& law, double dt,
                      LawOptions options = {});
/// To a body's centre of mass. A dynamic one feels the opposite of all the forces, so that momentum stays.
template <class Real>
void apply_attraction_to_body(BasicWorld<Real>& world, BodyId centre, const Attraction& law, double dt,
                              LawOptions options = {});

/// Wind on the outlines of all shapes but sensors and chains. Where its force could reverse the motion of a
/// light body in the wind within the step, it is less.
template <class Real>
void apply_wind(BasicWorld<Real>& world, const Wind& wind, double dt, LawOptions options = {});

/// Water below a plane across the world's gravity. What is under it is lifted by the weight of the water in
/// its place, at the centroid of that part; drag acts there too, never past the water's own motion.
struct Water {
  double level = 0;         ///< m, of the surface, along "up": y, where gravity points down
  double density = 1;       ///< kg/m^2, >= 0
  Vec2d velocity{};         ///< m/s, of the current
  double linear_drag = 0;   ///< N s/m for each m^2 under water, >= 0
  double angular_drag = 0;  ///< N m s for each m^2 under water, >= 0
};
template <class Real>
void apply_water(BasicWorld<Real>& world, const Water& water, double dt, LawOptions options = {});

/// A spring between points of two bodies (in the bodies' frames), without a joint. Acts when one of them is
/// awake.
template <class Real>
void apply_spring(BasicWorld<Real>& world, BodyId a, Vec2d point_a, BodyId b, Vec2d point_b,
                  const ElasticSpring& spring, double dt, LawOptions options = {});

struct ExplosionOptions {
  bool occlusion = false;  ///< what another body covers, as rays from the centre see it, is spared
  QueryFilter cover{};     ///< what counts as cover
};
/// A blast: impulses at once on all dynamic bodies in reach, sleeping ones too. A shape that the centre lies
/// in is not pushed.
template <class Real>
void explode(BasicWorld<Real>& world, const Blast& blast, const ExplosionOptions& options = {});

}  // namespace plumb
