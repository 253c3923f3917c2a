#include "harness/course/circle_pairs.h"

#include <cmath>

namespace plumb::course {

double distance(const Trace& trace, std::size_t k) {
  const Vec2d way = trace.states[k][1].position - trace.states[k][0].position;
  return std::hypot(way.x, way.y);
}

Trace head_on(const Lab& lab, Ball a, Ball b, double duration, int finer) {
  a.name = "a";
  b.name = "b";
  return lab.run(scene_of("head on", {}, {make(a), make(b)}), duration, finer);
}

double parting(const std::vector<BodyState>& states) { return states[1].velocity.x - states[0].velocity.x; }

bool pulled_back(const Trace& trace, double closing) {
  bool bounced = false;
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    const double before = parting(trace.states[k - 1]), after = parting(trace.states[k]);
    if (bounced && before > 0.01 * closing && after < before - 0.01 * closing) return true;
    const bool in_order = trace.states[k][1].position.x > trace.states[k][0].position.x;
    bounced = bounced || (in_order && before < 0 && after > 0.01 * closing);
  }
  return false;
}

bool two_bounce(const Lab& lab) {
  const Trace met =
      head_on(lab, {.position = {-1, 0}, .velocity = {1, 0}}, {.position = {1, 0}, .velocity = {-1, 0}});
  return met.last(0).velocity.x < -0.5 && met.last(1).velocity.x > 0.5;
}

}  // namespace plumb::course
