// Chapter 4: torque, inertia, levers, and boxes that collide.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/course/course.h"
#include "harness/course/scenes.h"
#include "harness/course/turning_contacts.h"
#include "harness/course/turning_scenes.h"

namespace plumb::course {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr const char* kBox = "\"shapes\":[\"circle\",\"box\"]: bodies that turn";
constexpr const char* kTorque = "\"shapes\":[\"circle\",\"box\"] and \"forces\":[\"torque\"]";
constexpr const char* kPush = "\"shapes\":[\"circle\",\"box\"] and \"forces\":[\"point_force\"]";
constexpr const char* kContacts =
    "\"shapes\":[\"circle\",\"box\"] and \"features\":[\"contacts\"]: boxes that turn and collide";

Finding torque_spins(const Lab& lab) {
  // Not a square, for which w^2 + h^2, 2 w h and half of (w + h)^2 are equal.
  const double mass = 3, width = 1.2, height = 0.5, torque = 0.4225;
  const double share = mass / 12, inertia = share * (width * width + height * height);
  Scene scene = scene_of("torque", {}, {make(Crate{.mass = mass, .width = width, .height = height})});
  scene.forces.emplace_back(Torque{.body = "box", .torque = torque});
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), w = torque / inertia * t;
  const auto with = [&](double other) { return torque / (share * other) * t; };
  const Spin timed = by_a_torque_for_a_time(lab), dragged = under_drag(lab);
  return Judgement()
      .read("spin after 1 s", "rad/s", trace.last(0).angular_velocity, w, lab.rounding(w, t))
      .read("spin by a torque from 0.2 s to 0.4 s", "rad/s", timed.is, timed.due, 5.1 * timed.due * lab.dt())
      .read("spin that a box keeps on which drag acts", "rad/s", dragged.is, dragged.due,
            lab.rounding(dragged.due, 1))
      .read("angle after 1 s", "rad", trace.last(0).angle, lab.way(0, torque / inertia, t),
            lab.rounding(w, t))
      .mistake("inertia_sixth", {w / 2},
               "Twice too slow: is the inertia 1/6 where it should be 1/12? A box has m (w^2 + h^2)/12.")
      .mistake("inertia_half", {2 * w}, "Twice too fast: is the inertia 1/24? A box has m (w^2 + h^2)/12.")
      .mistake("one_side", {with(width * width)}, "The box's height is left out: a box has m (w^2 + h^2)/12.")
      .mistake("one_side", {with(height * height)},
               "The box's width is left out: a box has m (w^2 + h^2)/12.")
      .mistake("thin_box_as_square", {with(2 * width * width)},
               "The box spins as a square of its width does: w^2 + h^2, not 2 w^2.")
      .mistake("thin_box_as_square", {with(2 * height * height)},
               "The box spins as a square of its height does: w^2 + h^2, not 2 h^2.")
      .mistake("square_of_sum", {with((width + height) * (width + height))},
               "(w + h)^2 stands where w^2 + h^2 should.")
      .mistake("box_by_area", {with(width * height)}, "w h stands where w^2 + h^2 should.")
      .mistake("torque_without_dt", {w / lab.dt()},
               "dt is missing: a step adds torque dt/I to the spin, not torque/I.")
      .mistake("torque_dt_twice", {w * lab.dt()}, "dt enters twice: a step adds torque dt/I to the spin.")
      .mistake("inertia_third", {w / 4},
               "Four times too slow: 1/3 is a rod about its end; about its centre it is 1/12.")
      .mistake("half_sides", {4 * w},
               "Four times too fast: m (w^2 + h^2)/12 takes the whole sides, not half of them.")
      .mistake("mass_for_inertia", {torque / mass * t},
               "The torque is divided by the mass: divide it by the inertia.")
      .mistake("inertia_of_one", {torque * t}, "The inertia is 1, or forgotten: w grows by torque dt/I.")
      .mistake("torque_backwards", {-w},
               "It spins the wrong way: a positive torque turns counter-clockwise, y up.")
      .mistake("degrees", {w * kDegrees},
               "57.3 times too fast: the spin is in radians a second, not degrees.")
      .mistake("torque_ignored", {0}, "The torque does nothing: add torque dt/I to the spin.")
      .finding();
}

Finding shapes_have_inertia(const Lab& lab) {
  const double mass = 3, width = 1.6, height = 0.1, r = 0.5;
  const double thin = mass * (width * width + height * height) / 12, disc = mass * r * r / 2;
  Scene scene = scene_of("inertia", {},
                         {make(Crate{.position = {-2, 0}, .mass = mass, .width = width, .height = height}),
                          make(Ball{.position = {2, 0}, .mass = mass, .radius = r})});
  scene.forces.emplace_back(Torque{.body = "box", .torque = thin});
  scene.forces.emplace_back(Torque{.body = "ball", .torque = disc});
  const Trace trace = lab.run(scene, 1);
  const double t = trace.duration(), tolerance = lab.rounding(1, t);
  const auto box_as = [&](double inertia) { return thin / inertia * t; };
  return Judgement()
      .read("spin of a thin box", "rad/s", trace.last(0).angular_velocity, t, tolerance)
      .read("spin of a disc", "rad/s", trace.last(1).angular_velocity, t, tolerance)
      .mistake("thin_box_as_square", {box_as(mass * width * width / 6), kAny},
               "The thin box spins as a square of its width does: w^2 + h^2, not 2 w^2.")
      .mistake("thin_box_as_square", {box_as(mass * height * height / 6), kAny},
               "The thin box spins as a square of its height does: w^2 + h^2, not 2 h^2.")
      .mistake("inertia_sixth", {t / 2, kAny},
               "The box is twice too slow: is it 1/6? A box has m (w^2 + h^2)/12.")
      .mistake("inertia_half", {2 * t, kAny},
               "The box is twice too fast: is it 1/24? A box has m (w^2 + h^2)/12.")
      .mistake("half_sides", {box_as(thin / 4), kAny},
               "Four times too fast: m (w^2 + h^2)/12 takes the whole sides, not half of them.")
      .mistake("box_by_area", {box_as(mass * width * height / 12), kAny},
               "w h stands where w^2 + h^2 should.")
      .mistake("disc_as_ring", {kAny, t / 2}, "The disc spins as a ring does: m r^2/2, not m r^2.")
      .mistake("disc_as_sphere", {kAny, t * 5 / 4},
               "The disc spins as a sphere does: m r^2/2, not 2/5 m r^2.")
      .mistake("disc_as_box", {kAny, t * 3 / 4}, "The disc spins as the box around it does: m r^2/2.")
      .finding();
}

Finding angle_in_radians(const Lab& lab) {
  const double w = 2, start = 0.5;
  const Trace trace = lab.run(scene_of("spin", {}, {make(Crate{.angle = start, .angular_velocity = w})}), 3);
  const double t = trace.duration(), angle = start + w * t;
  return Judgement()
      .read("angle after 3 s", "rad", trace.last(0).angle, angle, lab.rounding(angle, t))
      .read("spin after 3 s", "rad/s", trace.last(0).angular_velocity, w, lab.rounding(w, t))
      .proven_if(
          trace.last(0).angular_velocity > 0.01 * w && trace.last(0).angular_velocity < 0.999 * w,
          "spin_damped",
          "The spin gets smaller, and nothing slows it here: leave out what multiplies it in each step.")
      .mistake("wrapped", {angle - 2 * std::numbers::pi},
               "The angle is wrapped at half a turn: it should count whole turns.")
      .mistake("degrees", {angle * kDegrees}, "The angle is in degrees: it should be in radians.")
      .mistake("degrees", {start + w * t * kDegrees},
               "The angle grows by degrees: it should grow by w dt, in radians.")
      .mistake("degrees", {start + w * t / kDegrees},
               "The spin is read as degrees a second: it is radians a second.")
      .mistake("turns_backwards", {start - w * t},
               "It turns the wrong way: angles grow counter-clockwise, y up.")
      .mistake("does_not_turn", {start}, "The angle never changes: add w dt to it.")
      .mistake("first_angle_ignored", {w * t}, "The initial angle is ignored: take \"angle\" from the scene.")
      .finding();
}

// Pushes for 0.1 s at `point` of a box at angle `angle`, away from the origin.
Trace pushed(const Lab& lab, double angle, Vec2d force, Vec2d point) {
  Scene scene = scene_of("push", {}, {make(Crate{.position = {5, 3}, .angle = angle, .mass = 2})});
  PointForce law = push("box", force, point);
  law.duration = 0.1;
  scene.forces.emplace_back(law);
  return lab.run(scene, 0.5);
}

constexpr double kPushed = 0.1;           // s
constexpr double kPushInertia = 1.0 / 3;  // 2 kg, 1 m by 1 m

// Returns the relative error of the push's duration: an engine may apply it for up to one step more or less.
double share_of_push(const Lab& lab) { return lab.dt() / kPushed + 0.01; }

Finding central_force(const Lab& lab) {
  const Vec2d force{3, 4};
  const Trace trace = pushed(lab, 0, force, {});
  const double w_by_world = (5 * force.y - 3 * force.x) * kPushed / kPushInertia, v = force.x * kPushed / 2;
  return Judgement()
      .read("spin", "rad/s", trace.last(0).angular_velocity, 0, 1e-6)
      .read("vx", "m/s", trace.last(0).velocity.x, v, v * share_of_push(lab))
      .mistake("lever_from_origin", {w_by_world, kAny}, kLever)
      .mistake("lever_from_origin", {-w_by_world, kAny}, kLever)
      .mistake("force_ignored", {0, 0}, "The force does nothing.")
      .finding();
}

Finding corner_force(const Lab& lab) {
  const Trace corner = pushed(lab, 0, {0, 1}, {0.5, 0.5});
  const Trace turned = pushed(lab, std::numbers::pi / 2, {1, 0}, {0.5, 0});
  const double w = 0.5 * kPushed / kPushInertia, tolerance = w * share_of_push(lab);
  // At an angle and a point that make all products of r x F different.
  const double angle = 0.7;
  const Vec2d force{0.9, -0.6}, point{0.5, 0.2};
  const double oblique =
      cross(Rotation<double>{std::cos(angle), std::sin(angle)} * point, force) * kPushed / kPushInertia;
  const Trace tilted = pushed(lab, angle, force, point);
  const Spin own = by_a_force_of_the_box(lab);
  return Judgement()
      .read("spin by a push at the corner", "rad/s", corner.last(0).angular_velocity, w, tolerance)
      .read("spin of a box that stands at 90 degrees", "rad/s", turned.last(0).angular_velocity, -w,
            tolerance)
      .read("spin of a box that stands at 0.7 rad", "rad/s", tilted.last(0).angular_velocity, oblique,
            std::abs(oblique) * share_of_push(lab))
      .read("spin by a force that turns with the box", "rad/s", own.is, own.due, 0.02 * std::abs(own.due))
      .mistake("torque_backwards", {-w, w, -oblique},
               "It spins the wrong way: the torque is rx Fy - ry Fx; r x F, not F x r.")
      .mistake("point_not_turned", {w, 0, cross(point, force) * kPushed / kPushInertia},
               "The point does not turn with the box: turn \"point\" by the body's angle, then take r x F.")
      .mistake("point_ignored", {0, 0, 0},
               "A push at the corner does not spin the box: add the torque r x F.")
      .mistake("dot_for_cross", {w, w}, "The torque is computed as r . F: it is r x F = rx Fy - ry Fx.")
      .mistake("inertia_sixth", {w / 2, -w / 2},
               "Twice too slow: is the inertia 1/6? It is m (w^2 + h^2)/12.")
      .mistake("inertia_half", {2 * w, -2 * w},
               "Twice too fast: is one side left out? It is m (w^2 + h^2)/12.")
      .finding();
}

constexpr const char* kUpright =
    "\"shapes\":[\"circle\",\"box\"] and \"features\":[\"contacts\",\"fixed_rotation\"]: boxes that do not "
    "turn";

Body upright(Crate crate) {
  Body body = make(crate);
  body.fixed_rotation = true;
  return body;
}

// Lets two boxes of 2 kg and 1 kg with fixed rotation collide along x, at different heights.
Finding upright_boxes_collide(const Lab& lab) {
  // At restitution 1, a second collision restores the initial velocities.
  const double u = 2, heavy = 2, light = 1, e = 0.7, j = (1 + e) * u / (1 / heavy + 1 / light);
  const Body a = upright({.name = "a",
                          .position = {-2.01, 0.2},
                          .velocity = {u, 0},
                          .mass = heavy,
                          .width = 0.6,
                          .height = 1,
                          .restitution = e});
  const Body b = upright(
      {.name = "b", .position = {0, 0}, .mass = light, .width = 0.8, .height = 0.9, .restitution = e});
  const Trace trace = lab.run(scene_of("upright", {}, {a, b}), 1.5);
  const double spin =
      std::max(std::abs(trace.last(0).angular_velocity), std::abs(trace.last(1).angular_velocity));
  const double after_a = u - j / heavy, after_b = j / light;
  const auto gap = [](const auto& s) { return s[1].position.x - s[0].position.x - (0.6 + 0.8) / 2; };
  return Judgement()
      .read("vx of 2 kg", "m/s", trace.last(0).velocity.x, after_a, 0.002 * u)
      .read("vx of 1 kg", "m/s", trace.last(1).velocity.x, after_b, 0.002 * u)
      .read("vy of 1 kg", "m/s", trace.last(1).velocity.y, 0, 0.002 * u)
      .read("largest spin", "rad/s", spin, 0, 1e-9)
      .proven_if(pushed_too_far(trace, lab.dt(), gap), "pushed_too_far", kPushedTooFar)
      .mistake("no_collision", {u, 0, 0, 0},
               "The boxes go through each other: they overlap if they do so along x and along y.")
      .proven_if(spin > 1e-9, "fixed_rotation_ignored",
                 "A box turns, and the scene says \"fixed_rotation\": its inverse inertia is 0.")
      .mistake_if(std::abs(trace.last(1).velocity.y) > 0.002 * u, "normal_between_centres",
                  "The boxes push each other up and down as well: the normal is the axis of least overlap, x "
                  "or y, not "
                  "the line of centres.")
      .mistake("masses_ignored", {u * (1 - e) / 2, u * (1 + e) / 2, 0, 0},
               "They leave as equal masses do: the masses are not used.")
      .finding();
}

constexpr const char* kLargestOverlap =
    "The box goes through, or is moved out at the side: the normal is the axis with the least overlap, here "
    "y, not the "
    "one with the most.";

// Drops a box with fixed rotation on the end of a platform: its overlap along y is smaller than that along x.
Finding least_overlap(const Lab& lab) {
  const double v = 2, e = 0.7, x = 2.1, start = 1.51, top = (1 + 0.6) / 2;
  const Body platform = fixed(make(Crate{.name = "platform", .width = 4, .height = 1, .restitution = e}));
  const Body box =
      upright({.position = {x, start}, .velocity = {0, -v}, .width = 0.8, .height = 0.6, .restitution = e});
  const Trace trace = lab.run(scene_of("edge", {}, {box, platform}), 1);
  const double t = trace.duration();
  // Position of a box that was moved by the whole overlap along x.
  const double beside = (4 + 0.8) / 2;
  const bool out_at_the_side =
      std::abs(trace.last(0).position.x - beside) < 0.01 && std::abs(trace.last(0).velocity.x) < 0.002 * v;
  const auto gap = [&](const auto& s) { return s[0].position.y - top; };
  // If a box has sunk in until its overlap along y is the larger one, it is right to move it out at the side.
  bool sinks_first = false;
  for (const auto& states : trace.states) {
    if (std::abs(states[0].position.x - x) > 1e-6) break;
    sinks_first = -gap(states) > beside - x;
  }
  return Judgement()
      .read("vx after landing on the edge", "m/s", trace.last(0).velocity.x, 0, 0.002 * v)
      .read("vy after landing on the edge", "m/s", trace.last(0).velocity.y, e * v, 0.002 * v)
      .read("x of the box", "m", trace.last(0).position.x, x, 0.01)
      .read("y of the box", "m", trace.last(0).position.y, top + e * v * (t - (start - top) / v),
            3 * v * lab.dt())
      .proven_if(!out_at_the_side && pushed_too_far(trace, lab.dt(), gap), "pushed_too_far", kPushedTooFar)
      .mistake_if(trace.still(0), "starts_at_rest",
                  "The box never moves: add v dt to the position; v begins with the scene's \"velocity\".")
      .proven_if(out_at_the_side && !sinks_first, "largest_overlap", kLargestOverlap)
      .mistake_if(
          std::abs(trace.last(0).velocity.x) > 0.01 * v, "normal_between_centres",
          "The box is thrown sideways: the normal is the axis of least overlap, here y, not the line of "
          "centres.")
      .mistake_if(!sinks_first && std::abs(trace.last(0).position.x - x) > 0.01, "largest_overlap",
                  kLargestOverlap)
      .mistake("largest_overlap", {0, -v, kAny}, kLargestOverlap)
      .finding();
}

// Comes last in the chapter, so that a mistake in forces at points is named by the checks before.
Finding corner_spring(const Lab& lab) {
  const Spin spring = by_a_spring(lab);
  return Judgement()
      .read("spin of a box that a damped spring pulls at a corner", "rad/s", spring.is, spring.due,
            0.12 * std::abs(spring.due + 3))
      .finding();
}

}  // namespace

Chapter rotation_and_boxes() {
  return {.number = 4,
          .title = "Rotation and boxes",
          .page = "4-rotation-and-boxes.md",
          .checks = {
              {"torque_spins", "a torque spins a box by torque/I a second", kTorque, torque_spins},
              {"shapes_have_inertia", "thin boxes and discs have their own inertia", kTorque,
               shapes_have_inertia},
              {"angle_in_radians", "angles in radians, whole turns and all", kBox, angle_in_radians},
              {"central_force", "a push at the centre does not spin a box", kPush, central_force},
              {"corner_force", "a push at the corner spins a box", kPush, corner_force},
              {"upright_boxes_collide", "boxes that do not turn collide along one axis", kUpright,
               upright_boxes_collide},
              {"least_overlap", "the normal is the axis of least overlap", kUpright, least_overlap},
              {"ball_hits_rod", "a ball that hits a rod's end moves and spins it", kContacts, ball_hits_rod},
              {"lands_flat", "a box lands flat and bounces flat", kContacts, lands_flat},
              {"slides", "friction slows a sliding box by mu g", kContacts, slides},
              {"box_rests", "a box rests on the ground", kContacts, box_rests},
              {"turned_box", "a ball bounces off the sides of a turned box", kContacts, turned_box},
              {"discs_rub", "a disc that spins turns another", kContacts, discs_rub},
              {"corner_spring", "a damped spring at a corner spins a box", kPush, corner_spring}}};
}

}  // namespace plumb::course
