#include "engine/world/continuous/swept_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
#include "engine/collision/distance/time_of_impact.h"
#include "engine/geometry/convex_core.h"
#include "engine/world/continuous/rebound.h"
#include "engine/world/continuous/swept_bound.h"
#include "engine/world/continuous/swept_boxes.h"
#include "engine/world/state/constants.h"

namespace plumb {
namespace {

// A body's motion for the rest of the step. `arm` as in SweptBody.
struct Motion {
  Sweep<double> sweep;
  Vec2d arm{};
};

template <class Real>
Motion motion_of(const WorldData<Real>& w, int body, double from, Vec2d origin, double dt) {
  if (const SweptBody* flight = flight_in(w, body)) return {flight->sweep(from, origin), flight->arm};
  const BodyMotion<Real>& motion = w.motion[body];
  if (motion.turned == 0 && !w.is_dynamic(body)) {
    const Vec2d way = motion.moved.template as<double>();
    const Rotation<Real> q = w.rotation[body];
    return {{w.position[body] - (1 - from) * way - origin,
             (1 - from) * way,
             {static_cast<double>(q.c), static_cast<double>(q.s)}}};
  }
  return {flight_of(w, body, dt).sweep(from, origin)};
}

// A shape relative to the point of its body that moves along a straight line.
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

// Returns the distance at which a fast body stops before an obstacle, m. Without a contact, which would hold
// a sliding body on the surface, it is far less than the depth of a core.
template <class Real>
Real tolerance_between(const WorldData<Real>& w, const SweptPair<Real>& pair) {
  Real out =
      Real(tuning::kImpactTolerance) * std::min(w.forms[pair.shape].extent, w.forms[pair.other].extent);
  if (pair.contact != nullptr) return out;
  for (const int shape : {pair.shape, pair.other})
    if (const Real half = half_width_of(w, shape); half > 0)
      out = std::min(out, Real(0.25 * tuning::kCoreDepth) * half);
  return out;
}

// Returns the distance of two shapes at the start of their motions, m.
template <class Real>
double distance_between(const Sweep<double>& way, const Convex<Real>& moving, const Sweep<double>& others,
                        const Convex<Real>& standing) {
  const Rotation<double> back = others.start_rotation.inverse(), q = way.start_rotation;
  const Pose<double> pose{back * (way.start - others.start),
                          {back.c * q.c - back.s * q.s, back.s * q.c + back.c * q.s}};
  return hull_distance(standing, moving, pose, nullptr).separation -
         static_cast<double>(moving.radius + standing.radius);
}

// A pair of shapes and their remaining motions.
template <class Real>
class Encountering {
 public:
  using Result = ImpactResult<Real>;

  Encountering(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair)
      : w_(w),
        way_(way),
        pair_(pair),
        of_other_(motion_of(w, w.shapes[pair.other].body, way.from, way.origin, way.search.dt)),
        whole_(w.convex(pair.shape), way.flight.arm),
        obstacle_(w.convex(pair.other), of_other_.arm),
        tolerance_(tolerance_between(w, pair)) {}

  const Convex<Real>& whole() const { return whole_.convex(); }
  bool flies_on() const { return way_.flight.impacts > 0; }
  const Convex<Real>& obstacle() const { return obstacle_.convex(); }

  Result meet(const Convex<Real>& moving, const Convex<Real>& standing) const {
    return meet(moving, standing, tolerance_, tolerance_);
  }
  // Finds the impact with the smallest tolerance above rounding; for restitution.
  Result meet_closely() const {
    const auto size = [](Vec2d v) { return std::abs(v.x) + std::abs(v.y); };
    const double bodies =
        static_cast<double>(w_.extents[way_.flight.body] + w_.extents[w_.shapes[pair_.other].body]);
    const Sweep<double>&own = way_.sweep, &others = of_other_.sweep;
    const double ways = size(others.start) + size(others.motion) + size(own.motion) +
                        bodies * (std::abs(own.turn) + std::abs(others.turn));
    const Real near = static_cast<Real>(tuning::kReboundTolerance * (bodies + ways));
    return meet(whole(), obstacle(), near, near);
  }
  // Finds the impact of shapes that may start closer than the stopping distance: these must not come closer.
  Result hold(const Convex<Real>& moving, const Convex<Real>& standing) const {
    // Without a contact the shapes are apart, and their cores farther apart.
    if (pair_.contact == nullptr && !way_.flight.changed && !pair_.stands) return meet(moving, standing);
    const double apart = distance(moving, standing);
    if (!(apart > 0)) return {.state = Result::State::Overlapped, .fraction = 0, .exact_fraction = 0};
    const Real start = static_cast<Real>(apart);
    if (start > 2 * tolerance_) return meet(moving, standing);
    return meet(moving, standing, Real(kHeld) * start, Real((1 - kHeld) / 2) * start);
  }
  double fraction(const Result& result) const { return way_.from + result.exact_fraction * (1 - way_.from); }
  // Returns true for an impact on the back of a chain segment, which shapes may pass from behind.
  bool passes_behind(const Result& at) const {
    const bool moves = w_.forms[pair_.shape].chain;
    if (!moves && !w_.forms[pair_.other].chain) return false;
    const Sweep<double>& sweep = moves ? way_.sweep : of_other_.sweep;
    const Rotation<double> q = pose_at(sweep, at.exact_fraction).rotation;
    const Vec2d front = q * (moves ? whole() : obstacle()).corners[0].normal.template as<double>(),
                normal = at.normal.template as<double>();
    return dot(front, moves ? -normal : normal) < 0;
  }

 private:
  static constexpr double kHeld = 0.999;

  Result meet(const Convex<Real>& moving, const Convex<Real>& standing, Real target, Real tolerance) const {
    const Result found = time_of_impact(standing, of_other_.sweep, moving, way_.sweep, target, tolerance,
                                        tuning::kImpactIterations + way_.search.toi_iteration_budget);
    way_.search.toi_iteration_budget -= std::max(0, found.iterations - tuning::kImpactIterations);
    return found;
  }
  double distance(const Convex<Real>& moving, const Convex<Real>& standing) const {
    return distance_between(way_.sweep, moving, of_other_.sweep, standing);
  }

  const WorldData<Real>& w_;
  const Way& way_;
  const SweptPair<Real>& pair_;
  Motion of_other_;
  RelativeShape<Real> whole_, obstacle_;
  Real tolerance_;
};

// Returns true if both bodies are dynamic and have, or will have, a contact. It separates them unless their
// inner cores pass. If such bodies were stopped earlier, a pile that is hit would overrun them.
template <class Real>
bool both_yield(const WorldData<Real>& w, const SweptPair<Real>& pair) {
  return (pair.contact != nullptr || pair.stands) && w.is_dynamic(w.shapes[pair.shape].body) &&
         w.is_dynamic(w.shapes[pair.other].body);
}

// Returns the time of impact of a core with the other shape. If it starts deeper and would penetrate further,
// tests first the cores of both, then smaller inner cores.
template <class Real>
ImpactResult<Real> core_impact(const WorldData<Real>& w, const Encountering<Real>& at,
                               const SweptPair<Real>& pair) {
  using State = typename ImpactResult<Real>::State;
  const ShapeForm<Real>&form = w.forms[pair.shape], &other_form = w.forms[pair.other];
  const Real own = half_width_of(w, pair.shape), others = half_width_of(w, pair.other);
  // Two discs may not graze each other unnoticed.
  const bool discs = pair.contact == nullptr && !pair.stands && form.count == 1 && other_form.count == 1;
  const Real depth = discs ? Real(tuning::kGraze) * std::min(form.radius, other_form.radius)
                           : Real(tuning::kCoreDepth) * own;
  // After an impact in flight no contact supports the body: in front of a stopped body it stops at the
  // surface.
  const SweptBody* met = flight_in(w, w.shapes[pair.other].body);
  if (at.flies_on() && met != nullptr && met->stands) {
    const Core<Real> core(at.whole(), Real(tuning::kGraze) * own);
    const ImpactResult<Real> found = at.hold(core.convex(), at.obstacle());
    if (found.state != State::Overlapped) return found;
  }
  if (both_yield(w, pair)) {
    const Core<Real> core(at.whole(), Real(tuning::kInnerDepth) * own),
        other_core(at.obstacle(), Real(tuning::kInnerDepth) * others);
    const ImpactResult<Real> found = at.hold(core.convex(), other_core.convex());
    return found.state == State::Overlapped ? ImpactResult<Real>{} : found;
  }
  const bool others_core = form.chain || (pair.stands && others > own);
  if (others_core) {
    const Core<Real> core(at.obstacle(), Real(tuning::kCoreDepth) * others);
    const ImpactResult<Real> found = at.hold(at.whole(), core.convex());
    if (found.state != State::Overlapped) return found;
  } else {
    const Core<Real> core(at.whole(), depth);
    const ImpactResult<Real> found = at.hold(core.convex(), at.obstacle());
    if (found.state != State::Overlapped) return found;
  }
  for (const double share :
       {tuning::kCoreDepth, 0.5 * (tuning::kCoreDepth + tuning::kInnerDepth), tuning::kInnerDepth}) {
    const Core<Real> core(at.whole(), Real(share) * own), other_core(at.obstacle(), Real(share) * others);
    const ImpactResult<Real> found = at.hold(core.convex(), other_core.convex());
    if (found.state != State::Overlapped) return found;
  }
  return {};
}

// Returns true if a quick bound shows that a pair of shapes does not collide on the solver's motions.
template <class Real>
bool is_clear(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair) {
  if (pair.stands) return false;
  const SweptBoxes<Real> boxes(w, way.flight, way.search.dt);
  if (!boxes.both_straight(w.shapes[pair.other].body)) return false;
  const ShapeForm<Real>&form = w.forms[pair.shape], &other_form = w.forms[pair.other];
  const Real apart = boxes.apart(pair.shape, pair.other);
  if (!pair.boxes_meet && boxes.stay_apart(pair.shape, pair.other, apart)) return true;
  const bool discs = form.count == 1 && other_form.count == 1;
  const Real depth = form.chain ? half_width_of(w, pair.other) : half_width_of(w, pair.shape);
  const Real both = half_width_of(w, pair.shape) + half_width_of(w, pair.other);
  const Real deepest =
      both_yield(w, pair) ? Real(tuning::kInnerDepth) * both : Real(tuning::kCoreDepth) * depth;
  const Real enough = pair.contact == nullptr && discs ? apart : apart - deepest;
  // Shapes in contact may overlap by almost a core along the axes of their AABBs, too.
  if (enough < apart && boxes.stay_apart(pair.shape, pair.other, enough) &&
      (pair.contact != nullptr || !may_rebound(w, pair.shape, pair.other, way.search.dt)))
    return true;
  SweptBound<Real> bound(w, pair.shape, pair.other, enough);
  const auto try_all = [&] {
    if (pair.contact == nullptr) return bound.try_edges();
    return bound.try_along(pair.contact->body_b == way.flight.body ? pair.contact->normal
                                                                   : -pair.contact->normal) ||
           bound.try_edges();
  };
  if (!try_all()) return false;
  return pair.contact != nullptr || bound.least() >= apart ||
         !may_rebound(w, pair.shape, pair.other, way.search.dt);
}

// Returns the least coordinate of a shape along a direction at a pose, m.
template <class Real>
double least_along(const Convex<Real>& shape, const Pose<double>& pose, Vec2d direction) {
  const Vec2d local = pose.rotation.inverse() * direction;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < shape.count; ++i)
    least = std::min(least, dot(local, shape.corners[i].point.template as<double>()));
  return dot(direction, pose.position) + least - static_cast<double>(shape.radius);
}

// Maximum lift, as a fraction of the smaller extent: more than the motion of a resting body's tip in a step.
constexpr double kLargestLift = 0.25;
// Lifts per step after which a body is stopped: each surface that it rests on may cause one.
constexpr int kMostLifts = 8;
// Number of pieces of a path above which a body is stopped instead of lifted; a corner's arc is checked at
// the ends of each piece. A rod a hundred times as long as wide reaches this number at 7 radians a step.
constexpr double kMostPieces = 64;
// Lift below which it counts as rounding, as a fraction of the body's extent.
constexpr double kNoLift = 1e-9;

// Returns true if a body touches something that it may be lifted off.
template <class Real>
bool may_lift(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair) {
  const int body = way.flight.body, other = w.shapes[pair.other].body;
  if (pair.contact == nullptr || way.flight.lifts >= kMostLifts || way.flight.carrier != kNone) return false;
  // The normal of a deep contact may point to the wrong side.
  const ContactConstraint<Real>& c = *pair.contact;
  const Real touching = Real(tuning::kTouch / tuning::kPushSpeed) * c.push_speed;
  if (std::min(c.separation[0], c.separation[1]) < -touching) return false;
  if (w.bodies[body].first_joint != kNone || w.bodies[body].lock_x || w.bodies[body].lock_y) return false;
  return !w.is_dynamic(other) && w.motion[other].turned == 0;
}

}  // namespace

template <class Real>
std::optional<Vec2d> lift_off(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair,
                              double entered) {
  if (!may_lift(w, way, pair)) return std::nullopt;
  const int body = way.flight.body, other = w.shapes[pair.other].body;
  const double side = pair.contact->body_b == body ? 1 : -1;
  const Vec2d normal = side * pair.contact->normal.template as<double>();
  const Motion of_other = motion_of(w, other, way.from, way.origin, way.search.dt);
  const Convex<Real> shape = w.convex(pair.shape), obstacle = w.convex(pair.other);
  const auto separation = [&](double fraction) {
    return least_along(shape, pose_at(way.sweep, fraction), normal) +
           least_along(obstacle, pose_at(of_other.sweep, fraction), -normal);
  };
  const double core = tuning::kCoreDepth * static_cast<double>(half_width_of(w, pair.shape));
  // A wide shape may overlap a slender one far from where they touch, along the slender shape's normal. So
  // use the decrease of the distance along the path, if the shapes are apart.
  const double apart = distance_between(way.sweep, shape, of_other.sweep, obstacle);
  const double hidden = apart > 0 ? apart - separation(0) : 0;
  // A core that enters although the separation along the normal does not decrease enters through another
  // side. Stop it up to two tolerances earlier, which is much for a needle.
  const double smaller = static_cast<double>(pair.contact->push_speed) / tuning::kPushSpeed;
  const double held_off = 2 * tuning::kImpactTolerance * smaller;
  if (entered < 1 && separation(entered) + hidden > held_off - 0.5 * core) return std::nullopt;
  const double lift = -core - separation(1) - hidden;
  // Between the ends of the path, corners move on arcs. Another impact may end the flight where they are
  // deepest: allow at most the depth from a core to the inner core below both ends, which contacts can still
  // push out.
  const double half_width = static_cast<double>(half_width_of(w, pair.shape));
  const double bend = static_cast<double>(w.extents[body]) * way.sweep.turn * way.sweep.turn +
                      2 * (std::abs(way.sweep.curve.x) + std::abs(way.sweep.curve.y));
  const double room = (tuning::kInnerDepth - tuning::kCoreDepth) * half_width;
  const double pieces = std::ceil(std::sqrt(0.25 * bend / room));  // arcs may use half of the room
  if (!(pieces <= kMostPieces)) return std::nullopt;
  const double ends = std::min(separation(0), separation(1));
  for (int i = 1; i < static_cast<int>(pieces); ++i)
    if (separation(i / pieces) < ends - 0.5 * room) return std::nullopt;
  const double least = way.flight.lifts > 0 ? kNoLift * static_cast<double>(w.extents[body]) : 0;
  if (lift > kLargestLift * smaller) return std::nullopt;
  return lift > least ? lift * normal : Vec2d{};
}

template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair) {
  using Result = ImpactResult<Real>;
  if (is_clear(w, way, pair)) return 1;
  const Encountering<Real> at(w, way, pair);
  const bool flies_on = way.flight.impacts > 0;
  if ((pair.contact == nullptr || flies_on) && way.flight.yields &&
      may_rebound(w, pair.shape, pair.other, way.search.dt)) {
    const Result first = at.meet_closely();
    if (first.state == Result::State::Separated) return 1;
    if (first.state != Result::State::Overlapped) return at.passes_behind(first) ? 1 : at.fraction(first);
  }
  const Result through = core_impact(w, at, pair);
  if (through.state == Result::State::Separated || at.passes_behind(through)) return 1;
  const Result first = at.meet(at.whole(), at.obstacle());
  // Shapes that touch at the start are separated by their contact until the core comes too near.
  const bool touch = first.state == Result::State::Overlapped || first.exact_fraction == 0;
  if (touch && lift_off(w, way, pair, through.exact_fraction) == Vec2d{}) return 1;
  return touch ? at.fraction(through) : at.fraction(first);
}

#define PLUMB_FOR(Real)                                                                              \
  template std::optional<Vec2d> lift_off(const WorldData<Real>&, const Way&, const SweptPair<Real>&, \
                                         double);                                                    \
  template double fraction_of_impact(const WorldData<Real>&, const Way&, const SweptPair<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
