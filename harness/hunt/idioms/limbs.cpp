#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

enum class Ties { Hinges, Limits, Brakes, Welds, Sliders };

void tie(Draft& draft, Ties ties, int a, int b, Vec2d at, double angle) {
  Random& random = draft.random;
  switch (ties) {
    case Ties::Hinges:
      draft.revolute(a, b, at);
      return;
    case Ties::Limits: {
      const double room = random.chance(0.3) ? 0 : random.within(0, 1);
      draft.revolute(a, b, at).limits = Range{-room, room};
      return;
    }
    case Ties::Brakes: {
      // Relative to the weight of both bodies at the length of a limb.
      const double torque = 10 * (draft.body(a).mass + draft.body(b).mass) * draft.size;
      draft.revolute(a, b, at).motor = Motor{.speed = 0, .max_force = random.ladder(0.01, 10) * torque};
      return;
    }
    case Ties::Welds:
      draft.weld(a, b, at);
      return;
    case Ties::Sliders: {
      const double half = random.within(0, 0.2) * draft.size;
      draft.prismatic(a, b, at, {std::cos(angle), std::sin(angle)}).limits = Range{-half, half};
      return;
    }
  }
}

// Builds a trunk with limbs on limbs, which do not touch each other.
void build_tree(Draft& draft, Ties ties, Vec2d at) {
  struct Tip {
    int body;
    Vec2d at;
    double angle;
  };
  Random& random = draft.random;
  const double s = draft.size;
  const int first = draft.box(at, s, 0.3 * s);
  std::vector<Tip> tips{{first, at + Vec2d{0.5 * s, 0}, 0},
                        {first, at - Vec2d{0.5 * s, 0}, std::numbers::pi}};
  const int limbs = random.whole(1, 9);
  for (int i = 0; i < limbs; ++i) {
    const Tip from = tips[static_cast<std::size_t>(random.whole(0, static_cast<int>(tips.size()) - 1))];
    const double angle = from.angle + random.within(-0.8, 0.8), length = random.within(0.3, 0.8) * s;
    const Vec2d along{std::cos(angle), std::sin(angle)};
    const int limb = draft.box(from.at + 0.5 * length * along, length, random.within(0.08, 0.2) * s, angle);
    tie(draft, ties, from.body, limb, from.at, angle);
    tips.push_back({limb, from.at + length * along, angle});
  }
  draft.pass_each_other(first);
}

// Builds trees of joined bodies that fall onto each other: ragdolls in a heap, broken machines.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int trees = random.whole(2, 5);
  double height = random.chance(0.5) ? 1.2 * s : random.within(1.2, 8) * s;
  for (int i = 0; i < trees; ++i, height += 2.5 * s)
    build_tree(draft, static_cast<Ties>(random.whole(0, 4)), {random.within(-1, 1) * s, height});
  draft.out.steps = static_cast<int>(random.within(2, 4) / draft.out.dt);
}

const Register r{{.name = "limbs",
                  .title = "trees of joined bodies that fall onto each other",
                  .weight = 0.7,
                  .air = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
