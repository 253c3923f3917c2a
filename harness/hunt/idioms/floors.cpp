#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

void take_floor(Draft& draft, double width) {
  draft.site = {.kind = Site::Kind::Floor, .width = width, .friction = draft.friction};
}

// Builds a slab with a thickness of twice the size.
void slab(Draft& draft) {
  const double s = draft.size, width = draft.random.pick({40, 100, 400}) * s;
  draft.box({0, -s}, width, 2 * s, 0, BodyType::Static);
  take_floor(draft, width);
}

// Builds boxes, or polygons that are boxes, side by side.
void tiles(Draft& draft) {
  const double s = draft.size, side = draft.random.pick({0.5, 1.0, 1.0, 2.0}) * s;
  const int half = draft.random.whole(4, 8);
  const bool polygons = draft.random.chance(0.25), one_body = draft.random.chance(0.25);
  int first = -1;
  for (int i = -half; i <= half; ++i) {
    Geometry tile = Box{side, side};
    const double x = side / 2;
    if (polygons) tile = Polygon{{{-x, -x}, {x, -x}, {x, x}, {-x, x}}};
    if (one_body && first >= 0) {
      Shape shape = draft.body(first).shapes.front();
      shape.geometry = tile;
      shape.position.x += side * (i + half);
      draft.body(first).shapes.push_back(shape);
    } else {
      const int made = draft.add(tile, {side * i, -side / 2}, 0, BodyType::Static);
      if (first < 0) first = made;
    }
  }
  take_floor(draft, side * (2 * half + 1));
}

void segments(Draft& draft) {
  const double s = draft.size, side = draft.random.pick({1.0, 2.0, 5.0}) * s;
  const int half = draft.random.whole(4, 8);
  for (int i = -half; i <= half; ++i)
    draft.add(Segment{{-side / 2, 0}, {side / 2, 0}}, {side * i, 0}, 0, BodyType::Static);
  take_floor(draft, side * (2 * half + 1));
}

void chain(Draft& draft) {
  const double s = draft.size, side = draft.random.pick({1.0, 2.0, 5.0}) * s;
  const int half = draft.random.whole(4, 8);
  Chain points;
  for (int i = half; i >= -half; --i) points.points.push_back({side * i, 0});
  draft.add(points, {0, 0}, 0, BodyType::Static);
  take_floor(draft, 2 * side * half);
}

// Builds a lift or a train, whose motion is prescribed, beneath everything.
void platform(Draft& draft) {
  const double s = draft.size;
  const int made = draft.box({0, -s}, 200 * s, 2 * s, 0, BodyType::Kinematic);
  draft.body(made).velocity = {draft.random.within(-2, 2) * s, draft.random.within(-1, 1) * s};
  take_floor(draft, 200 * s);
  draft.site.moves = true;
}

void conveyor(Draft& draft) {
  const double s = draft.size;
  const int made = draft.box({0, -s}, 60 * s, 2 * s, 0, BodyType::Static);
  draft.body(made).shapes.front().surface_speed = draft.random.within(-3, 3) * s;
  take_floor(draft, 60 * s);
  draft.site.moves = true;
}

const Register a{{.name = "slab",
                  .title = "a floor of one box",
                  .role = Idiom::Role::Support,
                  .weight = 4,
                  .build = slab}};
const Register b{{.name = "tiles",
                  .title = "a floor of boxes side by side",
                  .role = Idiom::Role::Support,
                  .weight = 2,
                  .build = tiles}};
const Register c{{.name = "segments",
                  .title = "a floor of lines",
                  .role = Idiom::Role::Support,
                  .weight = 0.7,
                  .build = segments}};
const Register d{{.name = "chain_floor",
                  .title = "a floor of one chain of lines",
                  .role = Idiom::Role::Support,
                  .weight = 0.7,
                  .build = chain}};
const Register e{{.name = "platform",
                  .title = "a moving kinematic floor",
                  .role = Idiom::Role::Support,
                  .weight = 0.5,
                  .build = platform}};
const Register f{{.name = "conveyor",
                  .title = "a floor with a surface speed",
                  .role = Idiom::Role::Support,
                  .weight = 0.5,
                  .build = conveyor}};

}  // namespace
}  // namespace plumb::harness::hunt
