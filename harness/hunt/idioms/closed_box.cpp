#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Builds four walls, of any thickness; their corners overlap.
void build(Draft& draft) {
  const double s = draft.size, inside = draft.random.pick({6, 10, 20}) * s;
  const double wall = draft.random.ladder(0.02, 2) * s, half = inside / 2, long_way = inside + 2 * wall;
  const bool capsules = draft.random.chance(0.15);
  const auto add = [&](Vec2d at, double width, double height) {
    if (capsules) {
      const bool flat = width > height;
      const double r = (flat ? height : width) / 2;
      draft.add(
          flat ? Capsule{{-width / 2, 0}, {width / 2, 0}, r} : Capsule{{0, -height / 2}, {0, height / 2}, r},
          at, 0, BodyType::Static);
    } else {
      draft.box(at, width, height, 0, BodyType::Static);
    }
  };
  add({0, -wall / 2}, long_way, wall);
  add({0, inside + wall / 2}, long_way, wall);
  add({-half - wall / 2, half}, wall, long_way);
  add({half + wall / 2, half}, wall, long_way);
  draft.site = {.kind = Site::Kind::Enclosure,
                .width = inside,
                .height = inside,
                .wall = wall,
                .friction = draft.friction};
}

const Register r{{.name = "closed_box",
                  .title = "four walls around everything",
                  .role = Idiom::Role::Support,
                  .weight = 2,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
