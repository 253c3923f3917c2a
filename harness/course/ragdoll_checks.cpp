#include "harness/course/ragdoll_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;

struct Limb {
  const char* name;
  Vec2d centre;
  double width, height;
};

// Builds a head, a torso, and limbs attached by hinges; arms out, so that nothing touches. 1.5 m high.
Scene ragdoll(Vec2d at, double spin, Vec2d gravity) {
  constexpr Limb kLimbs[] = {{"left arm", {-0.45, 0.25}, 0.5, 0.12},
                             {"right arm", {0.45, 0.25}, 0.5, 0.12},
                             {"left leg", {-0.15, -0.65}, 0.12, 0.6},
                             {"right leg", {0.15, -0.65}, 0.12, 0.6}};
  Scene scene = scene_of(
      "ragdoll", gravity,
      {make(Crate{
          .name = "torso", .mass = 20, .width = 0.35, .height = 0.7, .restitution = 0, .friction = 0.5})});
  const auto join = [&](const std::string& name, Vec2d at_torso, Vec2d at_limb) {
    RevoluteJoint joint;
    joint.name = "joint of " + name;
    joint.body_a = "torso";
    joint.body_b = name;
    joint.anchor_a = at_torso;
    joint.anchor_b = at_limb;
    scene.joints.emplace_back(joint);
  };
  scene.bodies.push_back(
      make(Ball{.name = "head", .position = {0, 0.52}, .mass = 4, .radius = 0.13, .restitution = 0}));
  join("head", {0, 0.37}, {0, -0.15});
  for (const Limb& limb : kLimbs) {
    scene.bodies.push_back(make(Crate{.name = limb.name,
                                      .position = limb.centre,
                                      .mass = 5,
                                      .width = limb.width,
                                      .height = limb.height,
                                      .restitution = 0,
                                      .friction = 0.5}));
    const bool arm = limb.width > limb.height;
    const Vec2d end =
        arm ? Vec2d{limb.centre.x > 0 ? -limb.width / 2 : limb.width / 2, 0} : Vec2d{0, limb.height / 2};
    join(limb.name, limb.centre + end, end);
  }
  Vec2d centre{};
  double mass = 0;
  for (const Body& body : scene.bodies) centre += body.mass * body.position, mass += body.mass;
  centre *= 1 / mass;
  for (Body& body : scene.bodies) {
    body.velocity = cross(spin, body.position - centre);
    body.angular_velocity = spin;
    body.position += at - centre;
  }
  return scene;
}

// Returns the largest gap of any hinge of `scene`.
double widest_gap(const Scene& scene, const Trace& trace) {
  double widest = 0;
  for (const auto& states : trace.states) {
    for (const Joint& joint : scene.joints) {
      const auto& hinge = std::get<RevoluteJoint>(joint);
      const auto anchor = [&](const std::string& name, Vec2d local) {
        const BodyState& s = states[*find_body(scene, name)];
        return s.position + Rotation<double>{std::cos(s.angle), std::sin(s.angle)} * local;
      };
      widest = std::max(widest,
                        length(anchor(hinge.body_b, hinge.anchor_b) - anchor(hinge.body_a, hinge.anchor_a)));
    }
  }
  return widest;
}

}  // namespace

Finding ragdoll_flies(const Lab& lab) {
  const double spin = 3;
  const Scene scene = ragdoll({}, spin, {0, -kGravity});
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration();
  Vec2d centre{}, velocity{};
  double mass = 0, l0 = 0, l = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const double m = scene.bodies[i].mass;
    mass += m;
    centre += m * trace.last(i).position;
    velocity += m * trace.last(i).velocity;
  }
  centre *= 1 / mass;
  velocity *= 1 / mass;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const Geometry& geometry = body.shapes[0].geometry;
    const auto* box = std::get_if<Box>(&geometry);
    const double r = box == nullptr ? std::get<Circle>(geometry).radius : 0;
    const double inertia =
        body.mass * (box == nullptr ? r * r / 2 : (box->width * box->width + box->height * box->height) / 12);
    const auto about = [&](const BodyState& s, Vec2d at, Vec2d v) {
      return body.mass * cross(s.position - at, s.velocity - v) + inertia * s.angular_velocity;
    };
    l0 += about(trace.first(i), {}, {});
    l += about(trace.last(i), centre, velocity);
  }
  const double gap = widest_gap(scene, trace), fall = lab.way(0, -kGravity, t);
  // Tolerates the loss that would occur if all limbs circled the centre on sticks held by position
  // corrections.
  const double lost = std::max(0.05, 1 - lab.spin_kept_by_positions(spin, t));
  // Soft steps move jointed bodies by semi-implicit Euler, free ones exactly.
  const double held = lab.scheme() == reference::Scheme::SoftStep ? kGravity * t * lab.substep() / 2 : 0;
  const double off = 0.005 * std::abs(fall) + held;
  return Judgement()
      .read("fall of the centre of mass", "m", centre.y, fall, off)
      .read("drift of the centre of mass", "m", centre.x, 0, 0.01)
      .read("spin kept", "of all", l / l0, 1, lost)
      .read("widest gap in a joint", "m", gap, 0, 0.02 * lab.coarseness())
      .mistake_if(gap > 0.5, "joint_ignored", "The limbs fly off: hinges hold the two anchors together.")
      .symptom_if(std::abs(centre.x) > 0.01 || std::abs(centre.y - fall) > off,
                  "The centre of mass does not fall as a single ball does.")
      .symptom_if(std::abs(l / l0 - 1) > lost, "Joints change the angular momentum of the whole.")
      .mistake_if(gap > 0.02 * lab.coarseness(), "too_few_iterations",
                  "Joints come apart: go over them several times a step.")
      .finding();
}

Finding ragdoll_drops(const Lab& lab) {
  Scene scene = ragdoll({0, 2}, 0.5, {0, -kGravity});
  scene.bodies.push_back(fixed(make(Crate{
      .name = "ground", .position = {0, -1}, .width = 20, .height = 2, .restitution = 0, .friction = 0.5})));
  const Trace trace = lab.run(scene, 4);
  const double gap = widest_gap(scene, trace);
  double lowest = 1e9, fastest = 0;
  for (std::size_t i = 0; i + 1 < scene.bodies.size(); ++i) {
    lowest = std::min(lowest, trace.last(i).position.y);
    fastest = std::max(fastest, length(trace.last(i).velocity));
  }
  const double in_ground = std::max(0.0, -lowest);
  // The torso alone, on the same ground.
  const auto lands_alone = [&] {
    Scene torso = scene;
    torso.joints.clear();
    torso.bodies = {scene.bodies.front(), scene.bodies.back()};
    return lab.run(torso, 2).last(0).position.y > 0;
  };
  const bool joined_fall = in_ground > 0.5 && lands_alone();
  // After a fall from 2 m nothing moves faster than sqrt(2 g 2.6). From 4 s on it is at rest, apart from slow
  // sliding.
  return Judgement()
      .read("widest gap in a joint", "m", gap, 0, 0.1 * lab.coarseness())
      .read("deepest centre below the ground", "m", in_ground, 0, 0.02)
      .read("fastest limb after 4 s", "m/s", fastest, 0, 1.5)
      .proven_if(
          joined_fall, "joined_collide_with_nothing",
          "The torso alone lands on the ground, and with joints it falls through: a joint keeps its two "
          "bodies from colliding with each other, and with nothing else. Keep a list of pairs, not of "
          "bodies.")
      .mistake_if(in_ground > 0.5, "falls_through", "The ragdoll falls through the ground.")
      .symptom_if(gap > 0.1 * lab.coarseness(), "The ragdoll comes apart when it lands.")
      .symptom_if(fastest > 1.5, "The ragdoll does not settle.")
      .finding();
}

}  // namespace plumb::course
