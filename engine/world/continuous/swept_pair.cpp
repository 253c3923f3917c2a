#include "engine/world/continuous/swept_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/collision/distance/hull_distance.h"
#include "engine/collision/distance/time_of_impact.h"
#include "engine/geometry/convex_core.h"
#include "engine/math/trigonometry.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/continuous/chain_passing.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/swept_bound.h"
#include "engine/world/continuous/swept_boxes.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"

namespace plumb {
namespace {

// Remaining motion of a body. `arm` as in SweptBody.
struct Motion {
  Sweep<double> sweep;
  Vec2d arm{};
};

template <class Real>
Motion motion_of(const WorldData<Real>& w, int body, double from, Vec2d origin, double dt) {
  if (const SweptBody* swept = find_swept_body(w, body)) return {swept->sweep(from, origin), swept->arm};
  const SolverBody<Real>& motion = w.motion[body];
  if (motion.delta_angle == 0 && !w.is_dynamic(body)) {
    const Vec2d displacement = motion.delta_position.template as<double>();
    const Rotation<Real> q = w.rotation[body];
    return {{w.position[body] - (1 - from) * displacement - origin,
             (1 - from) * displacement,
             {static_cast<double>(q.c), static_cast<double>(q.s)}}};
  }
  return {swept_body_of(w, body, dt).sweep(from, origin)};
}

// A shape relative to the pivot of its body, which moves straight.
template <class Real>
class RelativeShape {
 public:
  RelativeShape(const Convex<Real>& shape, Vec2d arm) : convex_(shape) {
    if (arm == Vec2d{}) return;
    for (int i = 0; i < shape.count; ++i)
      corners_[i] = {shape.corners[i].point - arm.as<Real>(), shape.corners[i].normal};
    convex_.corners = corners_.data();
  }
  RelativeShape(const RelativeShape&) = delete;
  RelativeShape& operator=(const RelativeShape&) = delete;
  const Convex<Real>& convex() const { return convex_; }

 private:
  std::array<Corner<Real>, kMaxCorners> corners_;
  Convex<Real> convex_;
};

// Returns half the width of a shape's body, the unit of core depths.
template <class Real>
Real half_width_of(const WorldData<Real>& w, int shape) {
  return w.bodies[w.shapes[shape].body].half_width;
}

// Returns half of the distance at which a fast body, or its core, stops before an obstacle, m. It is far less
// than the depth of a core: otherwise the core of a slender body that lies on the obstacle would be stopped.
template <class Real>
Real tolerance_between(const WorldData<Real>& w, const SweptPair<Real>& pair) {
  Real out =
      Real(tuning::kImpactTolerance) * std::min(w.forms[pair.shape].extent, w.forms[pair.other].extent);
  for (const int shape : {pair.shape, pair.other})
    if (const Real half = half_width_of(w, shape); half > 0)
      out = std::min(out, Real(0.25 * tuning::kCoreDepth) * half);
  return out;
}

// Returns the distance of two shapes at the start of their motions, m.
template <class Real>
double distance_between(const Sweep<double>& moving_sweep, const Convex<Real>& moving,
                        const Sweep<double>& other_sweep, const Convex<Real>& standing) {
  const Rotation<double> back = other_sweep.start_rotation.inverse(), q = moving_sweep.start_rotation;
  const Pose<double> pose{back * (moving_sweep.start - other_sweep.start),
                          {back.c * q.c - back.s * q.s, back.s * q.c + back.c * q.s}};
  return hull_distance(standing, moving, pose, nullptr).separation -
         static_cast<double>(moving.radius + standing.radius);
}

// Finds the impacts of a pair of shapes along their remaining motions.
template <class Real>
class PairImpactSearch {
 public:
  using Result = ImpactResult<Real>;

  PairImpactSearch(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair)
      : w_(w),
        path_(path),
        pair_(pair),
        other_motion_(motion_of(w, w.shapes[pair.other].body, path.from, path.origin, path.search.dt)),
        whole_(w.convex(pair.shape), path.swept.arm),
        obstacle_(w.convex(pair.other), other_motion_.arm),
        tolerance_(tolerance_between(w, pair)) {}

  const Convex<Real>& whole() const { return whole_.convex(); }
  bool had_impact() const { return path_.swept.impacts > 0; }
  const Convex<Real>& obstacle() const { return obstacle_.convex(); }

  Result find_impact(const Convex<Real>& moving, const Convex<Real>& standing) const {
    return find_impact(moving, standing, tolerance_, tolerance_);
  }
  // Finds the impact with the smallest tolerance above rounding; for restitution.
  Result find_impact_closely() const {
    const auto size = [](Vec2d v) { return std::abs(v.x) + std::abs(v.y); };
    const double bodies =
        static_cast<double>(w_.extents[path_.swept.body] + w_.extents[w_.shapes[pair_.other].body]);
    const Sweep<double>&own_sweep = path_.sweep, &other_sweep = other_motion_.sweep;
    const double path_length = size(other_sweep.start) + size(other_sweep.motion) + size(own_sweep.motion) +
                               bodies * (std::abs(own_sweep.delta_angle) + std::abs(other_sweep.delta_angle));
    const Real tolerance = static_cast<Real>(tuning::kReboundTolerance * (bodies + path_length));
    return find_impact(whole(), obstacle(), tolerance, tolerance);
  }
  // Finds the impact of shapes that may start closer than the stopping distance and must not come closer.
  Result find_impact_from_near(const Convex<Real>& moving, const Convex<Real>& standing) const {
    // Without a contact the shapes start apart.
    if (pair_.contact == nullptr && !path_.swept.changed && !pair_.other_stopped)
      return find_impact(moving, standing);
    const double apart = distance(moving, standing);
    if (!(apart > 0)) return {.state = Result::State::Overlapped, .fraction = 0, .exact_fraction = 0};
    const Real start = static_cast<Real>(apart);
    if (start > 2 * tolerance_) return find_impact(moving, standing);
    return find_impact(moving, standing, Real(kKeptDistance) * start, Real((1 - kKeptDistance) / 2) * start);
  }
  double fraction(const Result& result) const {
    return path_.from + result.exact_fraction * (1 - path_.from);
  }
  // Returns true for an impact on a chain that contacts do not see: the shape passes from behind.
  bool passes(const Result& at) const {
    const bool moves = w_.forms[pair_.shape].chain;
    if (!moves && !w_.forms[pair_.other].chain) return false;
    const Corner<Real>* const chain = w_.convex(moves ? pair_.shape : pair_.other).corners;
    const Sweep<double>&own = path_.sweep, &other = other_motion_.sweep;
    const ChainEncounter<Real> encounter{moves ? whole() : obstacle(),
                                         moves ? obstacle() : whole(),
                                         moves ? own : other,
                                         moves ? other : own,
                                         chain[-1].point,
                                         chain[2].point,
                                         chain[0].point,
                                         chain[1].point};
    const Vec2d normal = at.normal.template as<double>();
    return passes_chain(encounter, at.point.template as<double>(), moves ? -normal : normal,
                        at.exact_fraction, at.state == Result::State::Hit);
  }

 private:
  static constexpr double kKeptDistance = 0.999;

  Result find_impact(const Convex<Real>& moving, const Convex<Real>& standing, Real target,
                     Real tolerance) const {
    const Result found = time_of_impact(standing, other_motion_.sweep, moving, path_.sweep, target, tolerance,
                                        tuning::kToiIterations + path_.search.toi_iteration_budget);
    path_.search.toi_iteration_budget -= std::max(0, found.iterations - tuning::kToiIterations);
    return found;
  }
  double distance(const Convex<Real>& moving, const Convex<Real>& standing) const {
    return distance_between(path_.sweep, moving, other_motion_.sweep, standing);
  }

  const WorldData<Real>& w_;
  const SweptPath& path_;
  const SweptPair<Real>& pair_;
  Motion other_motion_;
  RelativeShape<Real> whole_, obstacle_;
  Real tolerance_;
};

// Returns true if both bodies are dynamic and have, or will have, a contact, which separates them unless
// their inner cores pass. If they were stopped earlier, a pile that is hit would be pushed over them.
template <class Real>
bool are_dynamic_in_contact(const WorldData<Real>& w, const SweptPair<Real>& pair) {
  return (pair.contact != nullptr || pair.other_stopped) && w.is_dynamic(w.shapes[pair.shape].body) &&
         w.is_dynamic(w.shapes[pair.other].body);
}

// Returns the time of impact of a core with the other shape. If it starts deeper and would penetrate further,
// tests first the cores of both, then smaller inner cores.
template <class Real>
ImpactResult<Real> core_impact(const WorldData<Real>& w, const PairImpactSearch<Real>& at,
                               const SweptPair<Real>& pair) {
  using State = typename ImpactResult<Real>::State;
  const ShapeForm<Real>&form = w.forms[pair.shape], &other_form = w.forms[pair.other];
  const Real half_width = half_width_of(w, pair.shape), other_half_width = half_width_of(w, pair.other);
  // For discs, even a grazing impact counts.
  const bool discs =
      pair.contact == nullptr && !pair.other_stopped && form.count == 1 && other_form.count == 1;
  const Real depth = discs ? Real(tuning::kCircleStopOverlap) * std::min(form.radius, other_form.radius)
                           : Real(tuning::kCoreDepth) * half_width;
  // After a resolved impact no contact supports the body, so it stops at the surface of a stopped body.
  const SweptBody* other_swept = find_swept_body(w, w.shapes[pair.other].body);
  if (at.had_impact() && other_swept != nullptr && other_swept->stopped) {
    const Core<Real> core(at.whole(), Real(tuning::kCircleStopOverlap) * half_width);
    const ImpactResult<Real> found = at.find_impact_from_near(core.convex(), at.obstacle());
    if (found.state != State::Overlapped) return found;
  }
  if (are_dynamic_in_contact(w, pair)) {
    const Core<Real> core(at.whole(), Real(tuning::kInnerCoreDepth) * half_width),
        other_core(at.obstacle(), Real(tuning::kInnerCoreDepth) * other_half_width);
    const ImpactResult<Real> found = at.find_impact_from_near(core.convex(), other_core.convex());
    return found.state == State::Overlapped ? ImpactResult<Real>{} : found;
  }
  const bool others_core = form.chain || (pair.other_stopped && other_half_width > half_width);
  if (others_core) {
    const Core<Real> core(at.obstacle(), Real(tuning::kCoreDepth) * other_half_width);
    const ImpactResult<Real> found = at.find_impact_from_near(at.whole(), core.convex());
    if (found.state != State::Overlapped) return found;
  } else {
    const Core<Real> core(at.whole(), depth);
    const ImpactResult<Real> found = at.find_impact_from_near(core.convex(), at.obstacle());
    if (found.state != State::Overlapped) return found;
  }
  for (const double depth_fraction :
       {tuning::kCoreDepth, 0.5 * (tuning::kCoreDepth + tuning::kInnerCoreDepth), tuning::kInnerCoreDepth}) {
    const Core<Real> core(at.whole(), Real(depth_fraction) * half_width),
        other_core(at.obstacle(), Real(depth_fraction) * other_half_width);
    const ImpactResult<Real> found = at.find_impact_from_near(core.convex(), other_core.convex());
    if (found.state != State::Overlapped) return found;
  }
  return {};
}

// Returns true if a quick bound shows that a pair of shapes does not collide on the solver's motions.
template <class Real>
bool is_clear(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair) {
  if (pair.other_stopped) return false;
  const SweptAabbTest<Real> aabb_test(w, path.swept, path.search.dt);
  if (!aabb_test.both_as_solved(w.shapes[pair.other].body)) return false;
  const ShapeForm<Real>&form = w.forms[pair.shape], &other_form = w.forms[pair.other];
  const Real apart = aabb_test.no_impact_distance(pair.shape, pair.other);
  if (!pair.aabbs_overlap && aabb_test.stay_separated(pair.shape, pair.other, apart)) return true;
  const bool discs = form.count == 1 && other_form.count == 1;
  const Real depth = form.chain ? half_width_of(w, pair.other) : half_width_of(w, pair.shape);
  const Real both = half_width_of(w, pair.shape) + half_width_of(w, pair.other);
  const Real allowed_depth = are_dynamic_in_contact(w, pair) ? Real(tuning::kInnerCoreDepth) * both
                                                             : Real(tuning::kCoreDepth) * depth;
  const Real enough = pair.contact == nullptr && discs ? apart : apart - allowed_depth;
  // Shapes in contact may overlap by almost the depth of a core, so their AABBs may too.
  if (enough < apart && aabb_test.stay_separated(pair.shape, pair.other, enough) &&
      (pair.contact != nullptr || !may_resolve_toi_impact(w, pair.shape, pair.other, path.search.dt)))
    return true;
  SweptBound<Real> bound(w, pair.shape, pair.other, enough);
  const auto test_all = [&] {
    if (pair.contact == nullptr) return bound.test_edge_normals();
    return bound.test_axis(pair.contact->body_b == path.swept.body ? pair.contact->normal
                                                                   : -pair.contact->normal) ||
           bound.test_edge_normals();
  };
  if (!test_all()) return false;
  return pair.contact != nullptr || bound.lower_bound() >= apart ||
         !may_resolve_toi_impact(w, pair.shape, pair.other, path.search.dt);
}

// Returns the minimum coordinate of a shape along a direction at a pose, m.
template <class Real>
double min_along(const Convex<Real>& shape, const Pose<double>& pose, Vec2d direction) {
  const Vec2d local = pose.rotation.inverse() * direction;
  double minimum = std::numeric_limits<double>::max();
  for (int i = 0; i < shape.count; ++i)
    minimum = std::min(minimum, dot(local, shape.corners[i].point.template as<double>()));
  return dot(direction, pose.position) + minimum - static_cast<double>(shape.radius);
}

// Maximum lift, as a fraction of the smaller extent: more than a resting body's tip moves in a step.
constexpr double kMaxLift = 0.25;
// Number of lifts per step after which a body is stopped. Each surface that it rests on may cause one.
constexpr int kMaxLifts = 8;
// Maximum number of poses on a path at which the depth is computed; above it a body is stopped instead of
// lifted. A pose is added where its two neighbours do not bound the depth between them. A rod that turns on a
// corner needs about one for each doubling of its ratio of length to width: 16 at a ratio of 600,000.
constexpr int kMaxPoses = 32;
// Lift that counts as rounding, as a fraction of the body's extent.
constexpr double kMinLift = 1e-9;

// Separations of two shapes along the normal of their contact, m: as it was at the step's start, which
// belongs to the obstacle's side, and turning with the moving body, to whose side it belongs when that pivots
// on a corner. Neither exceeds the distance of the shapes.
struct AxisSeparations {
  double fixed = 0, turning = 0;

  double largest() const { return std::max(fixed, turning); }
};

// Computes the separations of a moving shape and an obstacle that does not turn, along their paths.
template <class Real>
struct LiftAxes {
  const Convex<Real>&shape, &obstacle;
  const Sweep<double>&sweep, &other_sweep;
  Vec2d normal;          // from the obstacle, at the step's start
  double turned_before;  // rad, rotation of the moving shape from the step's start to the path's

  // Returns the normal that turns with the moving body, at a fraction of its path.
  Vec2d turned(double fraction) const {
    return rotation_of(turned_before + fraction * sweep.delta_angle) * normal;
  }
  AxisSeparations at(double fraction) const {
    const Pose<double> pose = pose_at(sweep, fraction), other_pose = pose_at(other_sweep, fraction);
    const auto along = [&](Vec2d n) {
      return min_along(shape, pose, n) + min_along(obstacle, other_pose, -n);
    };
    const double fixed = along(normal);
    return {fixed, turned_before == 0 && sweep.delta_angle == 0 ? fixed : along(turned(fraction))};
  }
  // Returns true if one of the separations is above a limit everywhere on the path. Each differs between two
  // poses from its chord by at most an eighth of its second derivative times the square of their distance.
  // `start`, `end`: at the path's ends; `extent`: of the moving body, m.
  bool stay_above(double limit, const AxisSeparations& start, const AxisSeparations& end,
                  double extent) const {
    const auto size = [](Vec2d v) { return std::abs(v.x) + std::abs(v.y); };
    const double turn = std::abs(sweep.delta_angle), curve = 2 * size(sweep.curve);
    // Relative to the turning body, a point that touches it is at most its extent and the path away.
    const double path_length = size(sweep.motion - other_sweep.motion) + curve;
    const AxisSeparations bend{extent * turn * turn + curve,
                               (extent + path_length) * turn * turn + 2 * path_length * turn + curve};
    struct Piece {
      double first, last;
      AxisSeparations at_first, at_last;
    };
    // Halves of halves: each entry is at most half as long as the one below it.
    std::array<Piece, kMaxPoses + 1> pieces;
    int count = 1, poses = 2;
    pieces[0] = {0, 1, start, end};
    while (count > 0) {
      const Piece piece = pieces[--count];
      const double square = 0.125 * (piece.last - piece.first) * (piece.last - piece.first);
      if (std::min(piece.at_first.fixed, piece.at_last.fixed) - square * bend.fixed >= limit ||
          std::min(piece.at_first.turning, piece.at_last.turning) - square * bend.turning >= limit)
        continue;
      if (++poses > kMaxPoses) return false;
      const double middle = 0.5 * (piece.first + piece.last);
      const AxisSeparations at_middle = at(middle);
      if (at_middle.largest() < limit) return false;
      pieces[count++] = {middle, piece.last, at_middle, piece.at_last};
      pieces[count++] = {piece.first, middle, piece.at_first, at_middle};
    }
    return true;
  }
};

// Returns true if a joint holds a body to one that is not dynamic. A mouse joint pulls, but does not hold.
template <class Real>
bool is_joint_held(const WorldData<Real>& w, int body) {
  return any_edge(w.joints, w.bodies[body].first_joint, [&](const JointRecord& joint) {
    return joint.active && !(w.is_dynamic(joint.body_a) && w.is_dynamic(joint.body_b)) &&
           !std::holds_alternative<MouseDefinition>(w.joint_set.definition(joint.slot));
  });
}

// Returns true if a body touches a surface that it may be lifted off.
template <class Real>
bool may_lift(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair,
              bool blocked_link) {
  const int body = path.swept.body, other = w.shapes[pair.other].body;
  if (pair.contact == nullptr || path.swept.lifts >= kMaxLifts || path.swept.pushed_by != kNone) return false;
  // The normal of a deep contact may point to the wrong side. Down to the cores of both it does not, nor down
  // to the inner cores, to which joints press a blocked link.
  const ContactConstraint<Real>& c = *pair.contact;
  const Real touching = Real(tuning::kTouchSeparation / tuning::kDepenetrationSpeed) * c.depenetration_speed,
             core = Real(blocked_link ? tuning::kInnerCoreDepth : tuning::kCoreDepth) *
                    std::min(half_width_of(w, pair.shape), half_width_of(w, pair.other));
  if (std::min(c.separation[0], c.separation[1]) < -std::max(touching, core)) return false;
  if (blocked_link ? is_joint_held(w, body) : w.bodies[body].first_joint != kNone) return false;
  if (w.bodies[body].lock_x || w.bodies[body].lock_y) return false;
  return !w.is_dynamic(other) && w.motion[other].delta_angle == 0;
}

}  // namespace

template <class Real>
std::optional<Vec2d> lift_off(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair,
                              double entry_fraction, bool blocked_link) {
  if (!enabled(Switch::Lifts) || !may_lift(w, path, pair, blocked_link)) return std::nullopt;
  const int body = path.swept.body, other = w.shapes[pair.other].body;
  const double side = pair.contact->body_b == body ? 1 : -1;
  const Vec2d normal = side * pair.contact->normal.template as<double>();
  const Motion other_motion = motion_of(w, other, path.from, path.origin, path.search.dt);
  const Convex<Real> shape = w.convex(pair.shape), obstacle = w.convex(pair.other);
  const SweptBody& swept = path.swept;
  const double turned_before =
      swept.delta_angle_before + swept.elapsed_fraction(path.from) * swept.delta_angle;
  const LiftAxes<Real> axes{shape, obstacle, path.sweep, other_motion.sweep, normal, turned_before};
  const AxisSeparations start = axes.at(0), end = axes.at(1);
  const double core = tuning::kCoreDepth * static_cast<double>(half_width_of(w, pair.shape));
  // Along a slender shape's normal, a wide shape may overlap it far from the contact point. So use the
  // decrease of the distance along the path, if the shapes are apart.
  const double apart = distance_between(path.sweep, shape, other_motion.sweep, obstacle);
  const double offset = apart > 0 ? apart - start.largest() : 0;
  // If the separation along the normals does not decrease, the core enters through another side: stop it.
  const double smaller = static_cast<double>(pair.contact->depenetration_speed) / tuning::kDepenetrationSpeed;
  const double stop_distance = 2 * static_cast<double>(tolerance_between(w, pair));
  if (entry_fraction < 1 && axes.at(entry_fraction).largest() + offset > stop_distance - 0.5 * core)
    return std::nullopt;
  const double lift = stop_distance - core - end.largest() - offset;
  // Between the ends of the path, corners move on arcs, and another impact may stop the body where they are
  // deepest. Below both ends, allow the depth from the core to the inner core, which contacts push out.
  const double half_width = static_cast<double>(half_width_of(w, pair.shape));
  const double allowed_depth = (tuning::kInnerCoreDepth - tuning::kCoreDepth) * half_width;
  const double limit = std::min(start.largest(), end.largest()) - allowed_depth;
  if (!axes.stay_above(limit, start, end, static_cast<double>(w.extents[body]))) return std::nullopt;
  const double min_lift = path.swept.lifts > 0 ? kMinLift * static_cast<double>(w.extents[body]) : 0;
  // Joints open by a link's lift, or by its way if it is stopped.
  const double way =
      length(path.sweep.motion) + std::abs(path.sweep.delta_angle) * static_cast<double>(w.extents[body]);
  if (lift > (blocked_link ? way : kMaxLift * smaller)) return std::nullopt;
  return lift > min_lift ? lift * (end.turning > end.fixed ? axes.turned(1) : normal) : Vec2d{};
}

template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair) {
  using Result = ImpactResult<Real>;
  if (enabled(Switch::SweptBounds) && is_clear(w, path, pair)) return 1;
  const PairImpactSearch<Real> at(w, path, pair);
  const bool had_impact = path.swept.impacts > 0;
  if ((pair.contact == nullptr || had_impact) && path.swept.resolves_impacts &&
      may_resolve_toi_impact(w, pair.shape, pair.other, path.search.dt)) {
    const Result first = at.find_impact_closely();
    if (first.state == Result::State::Separated) return 1;
    if (first.state != Result::State::Overlapped && !at.passes(first)) return at.fraction(first);
  }
  const Result core_result = core_impact(w, at, pair);
  if (core_result.state == Result::State::Separated || at.passes(core_result)) return 1;
  const Result first = at.find_impact(at.whole(), at.obstacle());
  // Shapes that touch at the start are separated by their contact until the core comes too near.
  const bool touch =
      first.state == Result::State::Overlapped || first.exact_fraction == 0 || at.passes(first);
  const bool blocked_link = is_blocked_link(w, path.swept, at.fraction(core_result));
  if (touch && lift_off(w, path, pair, core_result.exact_fraction, blocked_link) == Vec2d{}) return 1;
  return touch ? at.fraction(core_result) : at.fraction(first);
}

#define PLUMB_FOR(Real)                                                                                    \
  template std::optional<Vec2d> lift_off(const WorldData<Real>&, const SweptPath&, const SweptPair<Real>&, \
                                         double, bool);                                                    \
  template double fraction_of_impact(const WorldData<Real>&, const SweptPath&, const SweptPair<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
