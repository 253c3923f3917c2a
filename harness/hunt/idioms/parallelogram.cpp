#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds two or three parallel cranks and a bar between their tips, which turn through the positions in which
// all of them lie in one line. Without gravity they turn at a constant rate, and the bar keeps its direction.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size, apart = random.within(0.8, 2) * s, rate = random.within(1, 6);
  draft.site.kind = Site::Kind::Air;
  draft.out.scene.gravity = {0, 0};
  const int first = draft.count();
  const double start = random.within(0.3, 2.5);
  const Vec2d to = direction(start), tip = s * to;
  std::vector<int> cranks;
  // Uses its own static base: positions in its frame are more precise than those of a world far from the
  // origin.
  const int base = draft.box({0.5 * apart, -0.1 * s}, apart, 0.1 * s, 0, BodyType::Static);
  const int count = random.pick({2, 2, 2, 3});
  std::vector<std::string> needs{std::string(kMasses), draft.name(base)};
  for (int i = 0; i < count; ++i) {
    const Vec2d foot{apart * i / (count - 1), 0};
    const int crank = draft.box(foot + 0.5 * tip, s, 0.1 * s, start);
    needs.push_back(draft.revolute(base, crank, foot).name), needs.push_back(draft.name(crank));
    draft.body(crank).angular_velocity = rate;
    draft.body(crank).velocity = cross(rate, 0.5 * tip);
    cranks.push_back(crank);
  }
  const int bar = draft.box(tip + Vec2d{0.5 * apart, 0}, apart, 0.1 * s);
  draft.body(bar).velocity = cross(rate, tip), draft.body(bar).angular_velocity = 0;
  needs.push_back(draft.name(bar));
  for (int i = 0; i < count; ++i)
    needs.push_back(
        draft.revolute(cranks[static_cast<std::size_t>(i)], bar, tip + Vec2d{apart * i / (count - 1), 0})
            .name);
  draft.pass_each_other(first);
  const double time = std::min(3.0, random.within(2, 7) / rate);
  const int steps = draft.out.steps = std::max(10, static_cast<int>(time / draft.out.dt));
  Expectation& turns = draft.expect("turns_on", cranks.front(), Quantity::Angle);
  const double right = start + rate * steps * draft.out.dt,
               slack = 0.03 * rate * steps * draft.out.dt + rate * draft.out.dt;
  turns.lower = right - slack, turns.upper = right + slack;
  turns.from = turns.to = steps * draft.out.dt;
  turns.why = "parallel cranks rotate through the positions in which all links lie in one line";
  turns.needs = needs;
  Expectation& keeps = draft.expect("keeps_its_direction", bar, Quantity::Angle);
  keeps.lower = -0.05, keeps.upper = 0.05;
  keeps.why = "the coupler of a parallelogram stays parallel to its base";
  keeps.needs = needs;
}

const Register r{{.name = "parallelogram",
                  .title = "parallel cranks joined by a coupler",
                  .weight = 0.3,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
