// Checks of chapter 4 on contacts of rotating bodies: rods, boxes on a side or a corner, discs with friction.
#include "harness/course/turning_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "harness/course/scenes.h"
#include "harness/course/turning_scenes.h"

namespace plumb::course {
namespace {

constexpr double kGravity = 9.81;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr const char* kFlipped =
    "The rod spins the wrong way: r x n is flipped. w changes by (rx jy - ry jx)/I, r from the centre to the "
    "contact.";
constexpr const char* kBothCorners =
    "Both corners get the whole impulse, computed from the same velocity: solve one corner after the other, "
    "each from "
    "the velocity that the last one left, several times, and keep each corner's sum of impulses from "
    "becoming "
    "negative.";

Body ground(double restitution, double friction) {
  return fixed(make(Crate{.name = "ground",
                          .position = {0, -1},
                          .width = 20,
                          .height = 2,
                          .restitution = restitution,
                          .friction = friction}));
}

// Returns the ratio of the speed to that in the previous step, if it is constant and below 1 in most steps.
std::optional<double> slowed_by_ratio(const Trace& trace) {
  const std::size_t n = trace.states.size(), middle = n / 2;
  const auto ratio = [&](std::size_t k) {
    return trace.states[k][0].velocity.x / trace.states[k - 1][0].velocity.x;
  };
  const double kept = ratio(middle);
  if (!(kept > 0 && kept < 1 - 1e-6)) return std::nullopt;
  for (std::size_t k = n / 4; k < n; ++k)
    if (std::abs(ratio(k) - kept) > 1e-3 * (1 - kept)) return std::nullopt;
  return kept;
}

}  // namespace

Finding ball_hits_rod(const Lab& lab) {
  const double v = 2, arm = 0.8, m = 1, rod_mass = 3, width = 0.2, height = 2;
  const double inertia = rod_mass * (width * width + height * height) / 12;
  const auto meet = [&](Vec2d at, bool rod_first = false) {
    const Body ball =
        make(Ball{.position = at + Vec2d{-0.8, arm}, .velocity = {v, 0}, .mass = m, .radius = 0.2});
    const Body rod =
        make(Crate{.name = "rod", .position = at, .mass = rod_mass, .width = width, .height = height});
    return lab.run(scene_of("rod", {}, rod_first ? std::vector{rod, ball} : std::vector{ball, rod}), 0.6);
  };
  // Rods so light that the lever arm dominates the effective mass: iterations do not repair an impulse
  // computed without it. On the long rod, an arm that is not squared is as wrong as none.
  struct LightRod {
    double mass, height, reach;
  };
  constexpr LightRod kLight{0.3, 2, 0.9}, kLong{0.1, 10, 4.8};
  const auto due = [&](const LightRod& rod) {
    const double eases = 12 / (rod.mass * (width * width + rod.height * rod.height));
    return v - 2 * v / (1 / m + 1 / rod.mass + rod.reach * rod.reach * eases) / m;
  };
  const auto hits = [&](const LightRod& rod) {
    const Body ball = make(Ball{.position = {-0.8, rod.reach}, .velocity = {v, 0}, .mass = m, .radius = 0.2});
    const Body crate = make(Crate{.name = "rod", .mass = rod.mass, .width = width, .height = rod.height});
    const Trace run = lab.run(scene_of("light rod", {}, {ball, crate}), 0.6);
    return std::clamp(run.last(0).velocity.x, -2 * v, 2 * v);
  };
  const Spin turned = hit_by_a_turning_rod(lab);
  const Trace trace = meet({3, -2});
  const double linear = 1 / m + 1 / rod_mass, k = linear + arm * arm / inertia;
  const double j = 2 * v / k, rigid = 2 * v / linear, w = -arm * j / inertia;
  Judgement judgement;
  judgement.read("vx of the ball", "m/s", trace.last(0).velocity.x, v - j / m, 0.002 * v)
      .read("vx of the rod", "m/s", trace.last(1).velocity.x, j / rod_mass, 0.002 * v)
      .read("spin of the rod", "rad/s", trace.last(1).angular_velocity, w, 0.005 * std::abs(w))
      .read("spin of the rod if it comes first in the scene", "rad/s",
            meet({3, -2}, true).last(0).angular_velocity, w, 0.005 * std::abs(w))
      .read("vx of the ball after it hits a rod of 0.3 kg, at most twice as fast", "m/s", hits(kLight),
            due(kLight), 0.005 * v)
      .read("vx of the ball after it hits a rod of 10 m and 0.1 kg, at most twice as fast", "m/s",
            hits(kLong), due(kLong), 0.005 * v)
      .read("vx of a ball at rest that a turning rod hits", "m/s", turned.is, turned.due, 0.1 * turned.due);
  if (judgement.good()) return judgement.finding();
  const auto off = [&](const Trace& t) { return std::abs(t.last(1).angular_velocity - w); };
  const double off_at_origin = off(meet({}));
  const bool right_at_origin = off_at_origin < 0.02 * std::abs(w) && 5 * off_at_origin < off(trace);
  // A rod that rotates about its centre at 2 rad/s, its end moving towards a ball at rest.
  const auto turns_into_ball = [&] {
    Body rod = make(Crate{.name = "rod", .mass = rod_mass, .width = width, .height = height});
    rod.angular_velocity = -2;
    const Body ball = make(Ball{.position = {0.4, arm}, .mass = m, .radius = 0.2});
    return lab.run(scene_of("turning rod", {}, {ball, rod}), 0.3).last(0).velocity.x;
  };
  const bool passes = trace.last(0).velocity.x != v && std::abs(turns_into_ball()) < 1e-9;
  // Two boxes that collide off-centre: each has a lever arm, while that of a ball is along the normal.
  const auto boxes_spin = [&] {
    const Trace t = lab.run(
        scene_of(
            "two boxes", {},
            {make(Crate{.name = "a", .position = {-1, 0.5}, .velocity = {v, 0}, .width = 0.6, .height = 0.6}),
             make(Crate{.name = "b", .mass = rod_mass, .width = 0.4, .height = 1.2})}),
        0.6);
    return std::min(std::abs(t.last(0).angular_velocity), std::abs(t.last(1).angular_velocity)) > 1e-3;
  };
  const bool ball_spins_none = std::abs(trace.last(1).angular_velocity) < 1e-9;
  const bool arm_of_the_ball = trace.last(0).velocity.x != v && ball_spins_none && boxes_spin();
  return judgement.mistake_if(right_at_origin, "lever_from_origin", kLever)
      .mistake_if(
          arm_of_the_ball, "arm_of_the_other",
          "A ball does not spin the rod, and a box would: the rod's impulse acts at the ball's arm. Each "
          "body has its own r, from its centre to the point.")
      .mistake_if(
          passes, "point_velocity",
          "A rod that turns into a ball at rest does not push it: the speed at which two close is that "
          "of their points, v + w x r, which is (vx - w ry, vy + w rx).")
      .mistake("r_cross_n_flipped", {v - j / m, j / rod_mass, -w}, kFlipped)
      .otherwise_if(trace.last(1).angular_velocity > -0.2 * w, "r_cross_n_flipped", kFlipped)
      .mistake(
          "no_rotation", {v - rigid / m, rigid / rod_mass, 0},
          "The rod does not spin: an impulse off the centre changes w by r x j/I, and the effective mass has "
          "(r x n)^2/I.")
      .mistake("effective_mass_without_rotation", {v - rigid / m, rigid / rod_mass, -arm * rigid / inertia},
               "The impulse is too strong and energy grows: the effective mass lacks (r x n)^2/I.")
      .mistake("spin_not_changed", {v - j / m, j / rod_mass, 0},
               "The impulse never changes the spin: add r x j/I to w.")
      .mistake("lever_not_squared", {kAny, kAny, -arm * 2 * v / (linear + arm / inertia) / inertia},
               "The effective mass has (r x n)/I: square r x n.")
      .mistake("no_collision", {v, 0, 0}, "The ball goes through the rod.")
      .finding();
}

// Changes of velocity, m/s, of a ball and a box that pass a rod which is upright by then, and lay across
// their way at the start. If the rod does not turn, they hit it. Rounding then decides nothing: their
// distances to it are not a whole number of steps, and differ, and no step moves the ball's centre into the
// rod.
struct Passes {
  double ball, box;
};

Passes pass_a_turning_rod(const Lab& lab) {
  const Vec2d box_from{0.8, 6.03}, ball_from{-0.8, -5.96}, v{0, -6};
  const double tilt = 0.3, turn = std::numbers::pi / 2 - tilt;  // rad, in a second
  const Body rod =
      make(Crate{.name = "rod", .angle = tilt, .angular_velocity = turn, .width = 2, .height = 0.2});
  const Body box =
      make(Crate{.name = "passer", .position = box_from, .velocity = v, .width = 0.4, .height = 0.4});
  const Body ball = make(Ball{.position = ball_from, .velocity = -v, .radius = 0.2});
  const Trace trace = lab.run(scene_of("passing a rod", {}, {rod, box, ball}), 1.2);
  const auto change = [&](std::size_t of) {
    const Vec2d off = trace.last(of).velocity - trace.first(of).velocity;
    return std::hypot(off.x, off.y);
  };
  return {change(2), change(1)};
}

// Throws a ball at a long and at a short side of a static box rotated by 15 degrees. In the box's frame, only
// the velocity along the side's normal changes.
Finding turned_box(const Lab& lab) {
  const double angle = 15 / kDegrees, e = 0.6, v = 2.3, along = 0.5, r = 0.3;
  const Rotation<double> q{std::cos(angle), std::sin(angle)};
  const Vec2d at{0.5, -0.3};
  // The distance to a side must not be a whole number of steps, otherwise rounding decides in which step the
  // ball hits it.
  const auto thrown = [&](Vec2d from, Vec2d velocity) {
    const Body ball =
        make(Ball{.position = at + q * from, .velocity = q * velocity, .radius = r, .restitution = e});
    const Body box =
        fixed(make(Crate{.position = at, .angle = angle, .width = 2, .height = 1, .restitution = 0}));
    const BodyState end = lab.run(scene_of("turned box", {}, {ball, box}), 1).last(0);
    return q.inverse() * end.velocity;
  };
  const Vec2d over_long = thrown({0.3, 1.42}, {-along, -v}), over_short = thrown({-1.92, -0.1}, {v, along});
  const double tolerance = 0.002 * v;
  const Passes passes = pass_a_turning_rod(lab);
  const Rebound corner = off_a_corner(lab), end = off_a_rods_end(lab);
  return Judgement()
      .read("speed away from the long side", "m/s", over_long.y, e * v, tolerance)
      .read("speed along the long side", "m/s", over_long.x, -along, tolerance)
      .read("speed away from the short side", "m/s", -over_short.x, e * v, tolerance)
      .read("speed along the short side", "m/s", over_short.y, along, tolerance)
      .read("change of velocity of a ball that passes a rod which has turned", "m/s", passes.ball, 0, 0.01)
      .read("change of velocity of a box that passes it", "m/s", passes.box, 0, 0.01)
      .read("speed away from a corner", "m/s", corner.back, 1, 0.02)
      .read("deepest in a corner", "m", corner.deep, 0, 3 * lab.dt())
      .read("speed away from the end of a rod", "m/s", end.back, 1, 0.02)
      .read("deepest in the end of a rod", "m", end.deep, 0, 3 * lab.dt())
      .mistake("no_collision", {-v, -along, -v, along}, "The ball goes through the box.")
      .finding();
}

constexpr double kDrop = 1.2, kTilt = 30;  // m and degrees, of the square that lands on a corner

// Lands a square on a corner, so that only the corner's arm r can rotate it: the corner leaves the ground
// with e v.
BodyState on_corner(const Lab& lab, double v, double e, double side, bool ground_first) {
  const Body box = make(Crate{.position = {0.3, kDrop},
                              .velocity = {0, -v},
                              .angle = (ground_first ? -kTilt : kTilt) / kDegrees,
                              .mass = 2,
                              .width = side,
                              .height = side,
                              .restitution = e});
  const auto bodies = ground_first ? std::vector{ground(e, 0), box} : std::vector{box, ground(e, 0)};
  return lab.run(scene_of("corner", {}, bodies), 0.7).last(ground_first ? 1 : 0);
}

// A square of mass m and side s has I = m s^2/6. The inverse effective mass at its corner is 1/m + (s/2)^2/I
// = 2.5/m.
Finding lands_flat(const Lab& lab) {
  const double v = 2, e = 0.5, side = 0.8;
  const Body box = make(Crate{.position = {0.3, 1.2},
                              .velocity = {0, -v},
                              .mass = 2,
                              .width = side,
                              .height = side,
                              .restitution = e});
  const Trace trace = lab.run(scene_of("flat", {}, {box, ground(e, 0)}), 0.8);
  // A push at one corner of a tall box lifts the other corner as well, so part of the first corner's impulse
  // must be removed again.
  const Body tall = make(Crate{
      .position = {0.3, 2}, .velocity = {0, -v}, .mass = 2, .width = 0.6, .height = 2, .restitution = 0});
  const Trace standing = lab.run(scene_of("tall", {}, {tall, ground(0, 0)}), 0.8);
  const auto right = [&](const Trace& landing) {
    return std::abs(landing.last(0).velocity.y - e * v) <= 0.005 * v &&
           std::abs(landing.last(0).angular_velocity) <= 0.02;
  };
  const BodyState corner = on_corner(lab, v, e, side, false), second = on_corner(lab, v, e, side, true);
  const double eases = 6 / (box.mass * side * side), to_corner = side / std::sqrt(2.0);
  struct Hit {
    double vy, spin;  // after the box has landed on its corner
  };
  const auto hit = [&](double turned) {  // rad
    const double arm = to_corner * std::cos((225 + kTilt) / kDegrees + turned);
    const double j = (1 + e) * v / (1 / box.mass + arm * arm * eases);
    return Hit{j / box.mass - v, arm * j * eases};
  };
  // A step may correct the overlap that it finds at the corner before the impulse acts, which rotates the
  // box. With 1/60 s the overlap is 13 mm; correcting it rotates the box by 0.015 rad, and the spin changes
  // by 3.7 %. With a smaller tolerance, engines that do so would fail; with twice this tolerance, an inertia
  // that is 8 % off would pass.
  const double way = v * (lab.substep() > 0 ? lab.substep() : lab.dt());
  const double fall = kDrop - to_corner * std::cos((45 - kTilt) / kDegrees);
  const double overlap = way * std::ceil(fall / way) - fall;
  const double arm = to_corner * std::cos((225 + kTilt) / kDegrees);
  const double turned = arm * eases * overlap / (1 / box.mass + arm * arm * eases);
  const Hit due = hit(0), late[] = {hit(turned), hit(-turned)};
  double off_vy = 0.005 * v, off_spin = 0.005 * std::abs(due.spin);
  for (const Hit& each : late) {
    off_vy = std::max(off_vy, std::abs(each.vy - due.vy));
    off_spin = std::max(off_spin, std::abs(each.spin - due.spin));
  }
  // On ground of the box's own width there is nothing to clip.
  const auto lands_on_its_width = [&] {
    Body narrow = ground(e, 0);
    narrow.position.x = box.position.x;
    narrow.shapes.front().geometry = Box{side, 2};
    return right(lab.run(scene_of("narrow", {}, {box, narrow}), 0.8));
  };
  // On wide ground whose centre is below the box, contact points between the centres are right, and points at
  // the ends of the ground are as wrong as elsewhere.
  const auto lands_on_its_centre = [&] {
    Body centred = ground(e, 0);
    centred.position.x = box.position.x;
    return right(lab.run(scene_of("centred", {}, {box, centred}), 0.8));
  };
  const bool not_clipped = !right(trace) && !trace.still(0) && trace.last(0).velocity.y > -0.99 * v &&
                           trace.last(0).angular_velocity != 0 && lands_on_its_width() &&
                           !lands_on_its_centre();
  return Judgement()
      .read("vy after landing", "m/s", trace.last(0).velocity.y, e * v, 0.005 * v)
      .read("spin after landing", "rad/s", trace.last(0).angular_velocity, 0, 0.02)
      .read("spin of a tall box after landing", "rad/s", standing.last(0).angular_velocity, 0, 0.02)
      .read("vy after landing on a corner", "m/s", corner.velocity.y, due.vy, off_vy)
      .read("spin after landing on a corner", "rad/s", corner.angular_velocity, due.spin, off_spin)
      .read("spin after landing on the other corner, if the ground comes first in the scene", "rad/s",
            second.angular_velocity, -due.spin, off_spin)
      .mistake_if(trace.still(0), "starts_at_rest",
                  "The box never moves: add v dt to the position; v begins with the scene's \"velocity\".")
      .proven_if(not_clipped, "not_clipped",
                 "The box lands flat on ground of its own width and tips on wider ground: clip the side that "
                 "lands at both ends of the face, so that contact points lie on both bodies.")
      .mistake("no_collision", {-v, 0}, "The box goes through the ground.")
      .mistake("restitution_ignored", {0, 0}, "The box does not bounce: restitution is not used for boxes.")
      .mistake("always_elastic", {v, 0},
               "The box bounces as fast as it came: restitution is not used for boxes.")
      .mistake("both_corners_take_all", {-v + 2 * (1 + e) * v / 2.5, 0}, kBothCorners)
      .mistake("both_corners_take_all", {-v + 2 * (1 + e) * v, 0}, kBothCorners)
      .mistake_if(
          right(trace) && std::abs(standing.last(0).angular_velocity) > 0.02, "sum_not_kept",
          "A square lands flat and a tall box tips: one corner's impulse was too strong and is not taken "
          "back. Keep the sum of each contact's impulses from becoming negative, not each impulse by "
          "itself, and go over the contacts several times.")
      .mistake_if(std::abs(trace.last(0).angular_velocity) > 0.02, "one_corner",
                  "It spins after a flat landing: only one corner gets an impulse, or each only once. A flat "
                  "landing has two "
                  "contact points; go over them several times.")
      .finding();
}

// Slides a flat box at 5 m/s. The coefficients 0.2 and 0.45 make 0.3 as their geometric mean.
Finding slides(const Lab& lab) {
  const double v = 5, width = 2, height = 0.2, mu_box = 0.2, mu_ground = 0.45, t = 1;
  const Body box = make(Crate{.position = {0, height / 2},
                              .velocity = {v, 0},
                              .mass = 2,
                              .width = width,
                              .height = height,
                              .restitution = 0,
                              .friction = mu_box});
  const auto after = [&](double seconds) {
    return lab.run(scene_of("slide", {0, -kGravity}, {box, ground(0, mu_ground)}), seconds);
  };
  const Trace sliding = after(t), stopped = after(3);
  Body to_left = box;
  to_left.velocity.x = -v;
  const Trace left = lab.run(scene_of("slide left", {0, -kGravity}, {ground(0, mu_ground), to_left}), t);
  const auto with = [&](double mu) { return v - mu * kGravity * t; };
  const double mu = std::sqrt(mu_box * mu_ground), x = v * v / (2 * mu * kGravity);
  const double late = 3 * mu * kGravity * lab.dt();  // contact may begin, and end, some steps late
  const std::optional<double> ratio = slowed_by_ratio(sliding);
  const double early = sliding.times[sliding.times.size() / 4];
  const double acts = (v - sliding.states[sliding.times.size() / 4][0].velocity.x) / (kGravity * early);
  const auto rule = [](const char* name) {
    return fmt::format("{}: \"contact_rules\" says geometric_mean, the root of their product.", name);
  };
  return Judgement()
      .read("vx after 1 s", "m/s", sliding.last(0).velocity.x, with(mu), late)
      .read("vx after 3 s", "m/s", stopped.last(0).velocity.x, 0, 0.02)
      .read("distance", "m", stopped.last(0).position.x, x, 3 * v * lab.dt())
      .read("vx after 1 s of a box that slides to the left, on ground that comes first in the scene", "m/s",
            left.last(1).velocity.x, -with(mu), late)
      .mistake_if(sliding.last(0).velocity.x > v + late, "friction_backwards",
                  "Friction speeds the box up: it acts against the sliding velocity along the tangent.")
      .mistake(
          "friction_ignored", {v, v, 3 * v},
          "The box does not slow down: friction is not used, or its limit becomes 0. The sum of friction's "
          "impulses in a step is at most mu times the sum of the impulses along the normal, not times the "
          "last of them.")
      .mistake(
          "friction_unlimited", {0, 0, 0},
          "The box stops at once: the impulse of friction is at most mu times the impulse along the normal.")
      .mistake("friction_backwards", {kAny, kAny, -x}, "Friction pushes the box back: it can only stop it.")
      .mistake("friction_product", {with(mu_box * mu_ground), kAny, kAny},
               rule("The coefficients are multiplied"))
      .mistake("friction_average", {with((mu_box + mu_ground) / 2), kAny, kAny},
               rule("The coefficients are averaged"))
      .mistake("friction_minimum", {with(mu_box), kAny, kAny},
               rule("The smaller coefficient, the box's, is taken"))
      .mistake("friction_maximum", {with(mu_ground), kAny, kAny},
               rule("The larger coefficient, the ground's, is taken"))
      .mistake("friction_sum",
               {std::max(0.0, with(mu_box + mu_ground)), kAny, v * v / (2 * kGravity * (mu_box + mu_ground))},
               rule("The coefficients are added"))
      .proven_if(
          ratio.has_value(), "friction_as_damping",
          fmt::format("Friction multiplies the speed by {:.6g} in each step: it does not depend on the "
                      "speed. Its impulse is at most mu times the one along the normal.",
                      ratio.value_or(1)))
      .symptom_if(std::abs(acts - mu) > 0.05 * mu,
                  fmt::format("The box is slowed as by a coefficient of {:.3g}, and the rule gives {:.3g}.",
                              acts, mu))
      .mistake(
          "friction_twice", {with(2 * mu), kAny, kAny},
          "Friction is twice too strong: each of two contact points is limited by the impulse at that point.")
      .finding();
}

Finding box_rests(const Lab& lab) {
  const double side = 0.8;
  const Body box = make(Crate{.position = {0, side / 2 + 0.3},
                              .mass = 2,
                              .width = side,
                              .height = side,
                              .restitution = 0,
                              .friction = 0.5});
  const Trace trace = lab.run(scene_of("rest", {0, -kGravity}, {box, ground(0, 0.5)}), 4);
  // A plank 2 m wide stands across a pillar of 1.2 m, on a slope: its centre is above 0.54 m of the pillar's
  // 0.6 m.
  const auto on_pillar = [&](bool pillar_first) {
    constexpr double kSlope = 1.35, kHeight = 0.8;
    const Body plank = make(
        Crate{.position = {0, kHeight / 2}, .width = 2, .height = kHeight, .restitution = 0, .friction = 2});
    Body pillar = ground(0, 2);
    pillar.shapes.front().geometry = Box{1.2, 2};
    const auto bodies = pillar_first ? std::vector{pillar, plank} : std::vector{plank, pillar};
    const Vec2d gravity{kSlope * kGravity, -kGravity};
    return lab.run(scene_of("pillar", gravity, bodies), 1).last(pillar_first ? 1 : 0).angle;
  };
  const Tilt right = tips_over_an_end(lab, 1, true), left = tips_over_an_end(lab, -1, true),
             right_below = tips_over_an_end(lab, 1, false), left_below = tips_over_an_end(lab, -1, false);
  const BodyState& end = trace.last(0);
  // Falls by g dt^2 in a step without a contact; what one end of the pillar keeps of it longer than the other
  // tilts the plank.
  const double tilt = 0.02 * lab.coarseness();
  const double sunk = side / 2 - end.position.y, tolerance = kGravity * lab.dt() * lab.dt() + 0.03 * side;
  return Judgement()
      .read("sunk after 4 s", "m", sunk, 0, tolerance)
      .read("angle", "rad", end.angle, 0, 0.02)
      .read("vy", "m/s", end.velocity.y, 0, 2 * kGravity * lab.dt())
      .read("slid", "m", end.position.x, 0, 0.02)
      .read("angle of a plank that stands on a pillar", "rad", on_pillar(false), 0, tilt)
      .read("angle of a plank on a pillar that comes first in the scene", "rad", on_pillar(true), 0, tilt)
      .read("angle of a plank whose centre is to the right of a pillar that comes first", "rad", right.is,
            right.due, right.tolerance)
      .read("angle of a plank whose centre is to the left of a pillar that comes first", "rad", left.is,
            left.due, left.tolerance)
      .read("angle of a plank whose centre is to the right of a pillar", "rad", right_below.is,
            right_below.due, right_below.tolerance)
      .read("angle of a plank whose centre is to the left of a pillar", "rad", left_below.is, left_below.due,
            left_below.tolerance)
      .mistake_if(trace.still(0), "no_gravity", "It hangs in the air: gravity pulls at it.")
      .mistake_if(sunk > side, "falls_through", "The box falls through the ground.")
      .mistake_if(std::abs(end.angle) > 0.02, "one_corner",
                  "The box tips on flat ground: both of its lower corners must be contacts.")
      .mistake_if(sunk > tolerance, "sinks",
                  "The box sinks: correct its position by a share of the overlap each step.")
      .symptom_if(-sunk > tolerance, "The box does not settle.")
      .finding();
}

// Lets a disc that spins meet another head-on. The impulse along the tangent stops the sliding of their rims,
// as between wheels: it is less than mu times the one along the normal.
Finding discs_rub(const Lab& lab) {
  const double v = 1, w = 4, ra = 0.5, rb = 0.4, ma = 2, mb = 1, e = 0.5;
  const double ia = ma * ra * ra / 2, ib = mb * rb * rb / 2;
  const double across = w * ra / (1 / ma + 1 / mb + ra * ra / ia + rb * rb / ib);
  // At an angle, the normal and the tangent have no component in common.
  const double angle = 35 / kDegrees;
  const Rotation<double> q{std::cos(angle), std::sin(angle)};
  Body a = make(Ball{.name = "a",
                     .position = q * Vec2d{-1, 0},
                     .velocity = q * Vec2d{v, 0},
                     .mass = ma,
                     .radius = ra,
                     .restitution = e});
  Body b =
      make(Ball{.name = "b", .position = q * Vec2d{0.41, 0}, .mass = mb, .radius = rb, .restitution = e});
  a.angular_velocity = w;
  a.shapes.front().friction = b.shapes.front().friction = 1;
  const Trace trace = lab.run(scene_of("discs", {}, {a, b}), 1);
  const double j = (1 + e) * v / (1 / ma + 1 / mb);
  // A contact that is found a step late has a depth of one step's displacement, which changes an arm.
  const double share = 2 * v * lab.dt() / rb + 0.01;
  const Vec2d va = q.inverse() * trace.last(0).velocity, vb = q.inverse() * trace.last(1).velocity;
  const double spin_a = w - ra * across / ia, spin_b = -rb * across / ib;
  return Judgement()
      .read("the second along the approach", "m/s", vb.x, j / mb, share * j / mb)
      .read("the first across the approach", "m/s", va.y, -across / ma, share * across / ma)
      .read("the second across the approach", "m/s", vb.y, across / mb, share * across / mb)
      .read("spin of the first", "rad/s", trace.last(0).angular_velocity, spin_a, share * (w - spin_a))
      .read("spin of the second", "rad/s", trace.last(1).angular_velocity, spin_b, share * -spin_b)
      .mistake("friction_ignored", {j / mb, 0, 0, w, 0},
               "The discs do not rub: friction is not used for circles.")
      .finding();
}

}  // namespace plumb::course
