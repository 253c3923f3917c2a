#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

bool has_dynamic(const Draft& draft) {
  for (const Body& body : draft.out.scene.bodies)
    if (body.type == BodyType::Dynamic) return draft.out.scene.forces.empty();
  return false;
}
bool on_floor(const Draft& draft) {
  return draft.site.kind == Site::Kind::Floor && draft.site.level && !draft.site.moves && has_dynamic(draft);
}

int any_dynamic(Draft& draft) {
  for (;;) {
    const int at = draft.random.whole(0, draft.count() - 1);
    if (draft.body(at).type == BodyType::Dynamic) return at;
  }
}

// Returns a step by which most bodies on a floor have come to rest and sleep, and extends the run beyond it.
int later(Draft& draft) {
  const double time = draft.random.within(0.1, 4);
  draft.out.steps = std::max(draft.out.steps, static_cast<int>((time + 1.5) / draft.out.dt));
  return static_cast<int>(time / draft.out.dt);
}

// Puts a body of any type onto bodies at rest.
void intruder(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const double x = draft.body(any_dynamic(draft)).position.x;
  const Vec2d at{x + random.within(-0.6, 0.6) * s, random.within(0.2, 0.8) * s};
  draft.restitution = 0;
  draft.out.sleeping = draft.out.sleeping || random.chance(0.7);
  const int step = later(draft);
  const BodyType type =
      random.pick({BodyType::Static, BodyType::Static, BodyType::Kinematic, BodyType::Dynamic});
  const double size = random.within(0.5, 1) * s;
  if (random.chance(0.5)) {
    const int made = draft.box(at, size, size, 0, type);
    draft.out.actions.push_back({.kind = ActionKind::Create, .step = step, .target = draft.name(made)});
  } else {  // an existing body is teleported there
    const int made = draft.box({at.x + 30 * s, at.y + 40 * s}, size, size, 0,
                               type == BodyType::Dynamic ? BodyType::Static : type);
    draft.out.actions.push_back(
        {.kind = ActionKind::Teleport, .step = step, .target = draft.name(made), .position = at});
  }
  draft.out.expectations.clear();
}

// Removes a body.
void removal(Draft& draft) {
  const int at = draft.random.whole(0, draft.count() - 1);
  draft.out.sleeping = draft.out.sleeping || draft.random.chance(0.7);
  draft.out.actions.push_back({.kind = ActionKind::Destroy, .step = later(draft), .target = draft.name(at)});
  draft.out.expectations.clear();
}

// Removes a joint.
void release(Draft& draft) {
  const Joint& joint = draft.random.pick(draft.out.scene.joints);
  draft.out.sleeping = draft.out.sleeping || draft.random.chance(0.5);
  draft.out.actions.push_back({.kind = ActionKind::DestroyJoint,
                               .step = later(draft),
                               .target = std::visit([](const auto& j) { return j.name; }, joint)});
  draft.out.expectations.clear();
}

// Adds a sensor near a body; later destroys the sensor, its shape or the body, or moves the sensor.
void sensor(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  const int visitor = any_dynamic(draft);
  const Vec2d at = draft.body(visitor).position + Vec2d{random.within(-1, 1) * s, random.within(-1, 1) * s};
  const double width = random.within(1, 3) * s, height = random.within(1, 3) * s;
  const double angle = random.within(-1, 1);
  const int made = draft.box(at, width, height, angle,
                             random.pick({BodyType::Static, BodyType::Static, BodyType::Kinematic}));
  draft.out.sensors.push_back(draft.name(made));
  const int step = static_cast<int>(random.within(0.05, 1) / draft.out.dt);
  switch (random.whole(0, 3)) {
    case 0:
      draft.out.actions.push_back({.kind = ActionKind::Destroy, .step = step, .target = draft.name(made)});
      break;
    case 1:
      draft.out.actions.push_back({.kind = ActionKind::Destroy, .step = step, .target = draft.name(visitor)});
      draft.out.expectations.clear();
      break;
    case 2:
      draft.out.actions.push_back(
          {.kind = ActionKind::DestroyShape, .step = step, .target = draft.name(made)});
      break;
    default:
      draft.out.actions.push_back(
          {.kind = ActionKind::Teleport,
           .step = step,
           .target = draft.name(made),
           .position = at + Vec2d{random.within(-2, 2) * s, random.within(-2, 2) * s}});
  }
}

// Makes a body static, and perhaps dynamic again; or disables its collisions, and perhaps enables them again.
void change(Draft& draft) {
  Random& random = draft.random;
  const int at = any_dynamic(draft), step = later(draft);
  const bool type = random.chance(0.5);
  Action action{
      .kind = type ? ActionKind::SetType : ActionKind::SetFilter, .step = step, .target = draft.name(at)};
  action.type = random.pick({BodyType::Static, BodyType::Kinematic});
  draft.out.actions.push_back(action);
  if (random.chance(0.5)) {
    action.step += random.whole(1, 30);
    action.type = BodyType::Dynamic, action.touches = true;
    draft.out.actions.push_back(action);
  }
  draft.out.expectations.clear();
}

const Register a{{.name = "intruder",
                  .title = "a body is created inside others that are at rest",
                  .role = Idiom::Role::Disturbance,
                  .weight = 1,
                  .fits = on_floor,
                  .build = intruder}};
const Register b{{.name = "removal",
                  .title = "a body is destroyed",
                  .role = Idiom::Role::Disturbance,
                  .weight = 1,
                  .fits = has_dynamic,
                  .build = removal}};
const Register c{
    {.name = "release",
     .title = "a joint is destroyed",
     .role = Idiom::Role::Disturbance,
     .weight = 0.7,
     .fits = [](const Draft& draft) { return has_dynamic(draft) && !draft.out.scene.joints.empty(); },
     .build = release}};
const Register d{{.name = "sensor",
                  .title = "a sensor is destroyed or moved",
                  .role = Idiom::Role::Disturbance,
                  .weight = 1,
                  .fits = has_dynamic,
                  .build = sensor}};
const Register e{{.name = "change",
                  .title = "a body becomes static or collides with nothing",
                  .role = Idiom::Role::Disturbance,
                  .weight = 0.7,
                  .fits = has_dynamic,
                  .build = change}};

}  // namespace
}  // namespace plumb::harness::hunt
