#include <algorithm>
#include <cmath>

#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

// Returns a force law on a body, perhaps with a second body: any kind that a scene may have, including forces
// that change within a step, and pulses that begin and end within a step.
ForceLaw some_law(Draft& draft, int made, int other) {
  Random& random = draft.random;
  const Body& body = draft.body(made);
  const double s = draft.size, dt = draft.out.dt, time = draft.out.steps * dt;
  const double push = random.within(1, 30) * s * body.mass;  // N
  const Vec2d beside{random.within(-0.3, 0.3) * s, random.within(-0.3, 0.3) * s};
  const auto frame = random.chance(0.5) ? Frame::Body : Frame::World;
  switch (random.whole(0, 7)) {
    case 0:
      return LinearDrag{.body = body.name, .coefficient = random.ladder(0.05, 5) * body.mass};
    case 1:
      return QuadraticDrag{.body = body.name, .coefficient = random.ladder(0.05, 5) * body.mass / s};
    case 2: {  // a pulse, perhaps shorter than a step
      const double lasts =
          random.chance(0.5) ? random.within(0.05, 0.9) * dt : random.within(0.05, 0.5) * time;
      return PointForce{.body = body.name,
                        .force = push * std::min(20.0, 0.3 / lasts) * direction(random.within(0, 6)),
                        .point = beside,
                        .frame = frame,
                        .start = random.within(0, 0.7) * time,
                        .duration = lasts};
    }
    case 3:
      return PointForce{
          .body = body.name, .force = push * direction(random.within(0, 6)), .point = beside, .frame = frame};
    case 4:
      return Torque{.body = body.name,
                    .torque = random.within(-1, 1) * push * s,
                    .start = random.within(0, 0.5) * time,
                    .duration = random.within(0.02, 0.5) * time};
    case 5: {
      const double rate = random.ladder(0.5, 1 / dt);
      return SinusoidalForce{.body = body.name,
                             .amplitude = push * direction(random.within(0, 6)),
                             .point = beside,
                             .angular_frequency = rate,
                             .phase = random.within(0, 6)};
    }
    case 6:
      return AttractionForce{.body = body.name,
                             .centre_body = other < 0 ? std::string(kWorld) : draft.name(other),
                             .centre = {random.within(-0.2, 0.2) * s, random.within(3, 6) * s},
                             .strength = random.within(1, 10) * s * s * s,
                             .exponent = random.pick({0, 1, 2})};
    default: {
      const double rate = random.within(0.5, 8);
      return SpringForce{.body_a = draft.name(other),
                         .body_b = body.name,
                         .anchor_a = beside,
                         .anchor_b = {random.within(-0.3, 0.3) * s, 0},
                         .rest_length = random.within(0, 3) * s,
                         .stiffness = rate * rate * body.mass,
                         .damping = random.chance(0.5) ? 0 : random.within(0, 1) * rate * body.mass};
    }
  }
}

// Builds bodies that pass through each other under several force laws at once.
void build(Draft& draft) {
  Random& random = draft.random;
  const double s = draft.size;
  draft.site.kind = Site::Kind::Air;
  const int bodies = random.whole(1, 5), first = draft.count();
  for (int i = 0; i < bodies; ++i) {
    const int made =
        draft.any({3 * s * i, random.within(-2, 2) * s}, s * random.within(0.4, 1.2), random.within(-3, 3));
    Body& body = draft.body(made);
    body.velocity = random.within(0, 5) * s * direction(random.within(0, 6));
    body.angular_velocity = random.within(-5, 5);
    if (random.chance(0.2))
      body.linear_damping = random.within(0, 1), body.angular_damping = random.within(0, 1);
  }
  draft.pass_each_other(first);
  for (int i = 0; i < bodies; ++i)
    for (int count = random.whole(1, 3); count > 0; --count) {
      const int other = bodies > 1 && random.chance(0.5) ? first + (i + 1) % bodies : -1;
      draft.out.scene.forces.push_back(some_law(draft, first + i, other));
    }
}

const Register r{{.name = "swarm",
                  .title = "bodies under several force laws at once",
                  .weight = 0.8,
                  .floor = false,
                  .build = build}};

}  // namespace
}  // namespace plumb::harness::hunt
