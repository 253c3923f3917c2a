#include "engine/world/swept_pair.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/collide/time_of_impact.h"
#include "engine/geometry/convex_core.h"
#include "engine/world/constants.h"
#include "engine/world/rebound.h"

namespace plumb {
namespace {

// A body's motion for the rest of the step. `arm` as in Flight.
struct Motion {
  Sweep<double> sweep;
  Vec2d arm{};
};

template <class Real>
Motion motion_of(const WorldData<Real>& w, int body, double from, Vec2d origin) {
  if (const Flight* flight = flight_in(w, body)) return {flight->sweep(from, origin), flight->arm};
  const BodyMotion<Real>& motion = w.motion[body];
  if (motion.turned == 0) {
    const Vec2d way = motion.moved.template as<double>();
    const Rotation<Real> q = w.rotation[body];
    return {{w.position[body] - (1 - from) * way - origin,
             (1 - from) * way,
             {static_cast<double>(q.c), static_cast<double>(q.s)}}};
  }
  return {flight_of(w, body).sweep(from, origin)};
}

// A shape as seen from the point of its body whose way is straight.
template <class Real>
class Seen {
 public:
  Seen(const Convex<Real>& shape, Vec2d arm) : convex_(shape) {
    if (arm == Vec2d{}) return;
    for (int i = 0; i < shape.count; ++i)
      corners_[i] = {shape.corners[i].point - arm.as<Real>(), shape.corners[i].normal};
    convex_.corners = corners_.data();
  }
  Seen(const Seen&) = delete;
  Seen& operator=(const Seen&) = delete;
  const Convex<Real>& convex() const { return convex_; }

 private:
  std::array<Corner<Real>, kMaxCorners> corners_;
  Convex<Real> convex_;
};

// How deep below a body's surface its cores lie.
template <class Real>
Real core_depth(const WorldData<Real>& w, int shape) {
  return Real(tuning::kCoreDepth) * w.bodies[w.shapes[shape].body].half_width;
}

// What a chain's segment meets from behind it lets through.
template <class Real>
bool from_behind(const Convex<Real>& segment, const Sweep<double>& way, const ImpactResult<Real>& at) {
  const Rotation<double> q = pose_at(way, at.exact_fraction).rotation;
  return dot(q * segment.corners[0].normal.template as<double>(), at.normal.template as<double>()) < 0;
}

}  // namespace

template <class Real>
double fraction_of_impact(const WorldData<Real>& w, const Way& way, int shape, int other,
                          const ContactConstraint<Real>* contact) {
  using Result = ImpactResult<Real>;
  const Motion of_other = motion_of(w, w.shapes[other].body, way.from, way.origin);
  const Seen<Real> whole(w.convex(shape), way.flight.arm), obstacle(w.convex(other), of_other.arm);
  const Real smaller = std::min(w.forms[shape].extent, w.forms[other].extent);
  const Real tolerance = Real(tuning::kImpactTolerance) * smaller;
  const auto meet = [&](const Convex<Real>& moving, const Convex<Real>& standing) {
    const Result found = time_of_impact(standing, of_other.sweep, moving, way.sweep, tolerance, tolerance,
                                        tuning::kImpactIterations + way.long_searches);
    way.long_searches -= std::max(0, found.iterations - tuning::kImpactIterations);
    return found;
  };
  const auto fraction = [&](const Result& result) {
    return way.from + result.exact_fraction * (1 - way.from);
  };
  const auto passes_behind = [&](const Result& result) {
    return w.forms[other].chain && from_behind(obstacle.convex(), of_other.sweep, result);
  };
  const bool flies_on = way.flight.impacts > 0;
  if ((contact == nullptr || flies_on) && way.flight.yields && may_rebound(w, shape, other)) {
    const Result first = meet(whole.convex(), obstacle.convex());
    if (first.state == Result::State::Separated) return 1;
    if (first.state != Result::State::Overlapped && (first.exact_fraction > 0 || flies_on))
      return passes_behind(first) ? 1 : fraction(first);
  }
  // Two discs may not even graze each other unseen.
  const ShapeForm<Real>&form = w.forms[shape], &other_form = w.forms[other];
  const bool discs = contact == nullptr && form.count == 1 && other_form.count == 1;
  const Real depth = core_depth(w, shape);
  const Core<Real> core(whole.convex(),
                        discs ? Real(tuning::kGraze) * std::min(form.radius, other_form.radius) : depth);
  Result through = meet(core.convex(), obstacle.convex());
  if (through.state == Result::State::Overlapped) {
    // What is that deep in it already is stopped where it would get deeper still.
    const Core<Real> inner(whole.convex(), Real(tuning::kInnerDepth) * w.bodies[way.flight.body].half_width),
        other_core(obstacle.convex(), core_depth(w, other));
    through = meet(core.convex(), other_core.convex());
    if (through.state == Result::State::Overlapped) through = meet(inner.convex(), other_core.convex());
  }
  if (through.state == Result::State::Separated || through.state == Result::State::Overlapped) return 1;
  if (passes_behind(through)) return 1;
  const Result first = meet(whole.convex(), obstacle.convex());
  // Shapes that touched at the start are held by their contact until the core comes too near.
  return first.state == Result::State::Overlapped || first.exact_fraction == 0 ? fraction(through)
                                                                               : fraction(first);
}

template double fraction_of_impact(const WorldData<float>&, const Way&, int, int,
                                   const ContactConstraint<float>*);
template double fraction_of_impact(const WorldData<double>&, const Way&, int, int,
                                   const ContactConstraint<double>*);

}  // namespace plumb
