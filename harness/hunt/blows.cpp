// Judges impacts, friction, motors and limits in small scenes of its own, whose results are known in closed
// form, or by integrating an impact in many small parts (Routh's method).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/simulation/simulation.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {
namespace {

/// Velocities of a body at the point that strikes a floor, up and to the right.
struct Blow {
  double mass = 1, inertia = 1;
  Vec2d arm{};  // m, from the centre
  Vec2d velocity{};
  double spin = 0;

  double up() const { return velocity.y + spin * arm.x; }
  double along() const { return velocity.x - spin * arm.y; }
  double energy() const { return 0.5 * mass * dot(velocity, velocity) + 0.5 * inertia * spin * spin; }
  void push(double normal, double tangent) {
    velocity += (1 / mass) * Vec2d{tangent, normal};
    spin += (arm.x * normal - arm.y * tangent) / inertia;
  }
};

/// Follows an impact in many small parts (Routh), with Coulomb's friction in each.
Blow struck(Blow at, const ContactRules& rules, double e, double mu) {
  constexpr int kParts = 20000;
  const double start = std::abs(at.up()), slip = at.along(), before = at.energy();
  const double nn = 1 / at.mass + at.arm.x * at.arm.x / at.inertia, nt = -at.arm.x * at.arm.y / at.inertia,
               tt = 1 / at.mass + at.arm.y * at.arm.y / at.inertia;
  const double part = start / nn / kParts;
  const double way = slip > 0 ? 1 : -1;
  bool stopped = slip == 0;
  double normal = 0, tangent = 0, work = 0, compression = 0, taken = 0;
  bool pressed = false;
  for (int i = 0; i < 200 * kParts; ++i) {
    if (!pressed && at.up() >= 0) pressed = true, compression = normal, taken = -work, work = 0;
    if (pressed && rules.impact == ImpactRule::Poisson && normal >= (1 + e) * compression) break;
    if (pressed && rules.impact == ImpactRule::Stronge && work >= e * e * taken) break;
    double friction = -way * mu, own = part;
    if (stopped) {
      const double sticks = -nt / tt, later = mu * rules.friction_after_stop;
      friction = std::clamp(sticks, -later, later);
    }
    const double from = at.up();
    Blow then = at;
    then.push(own, friction * own);
    if (!stopped && then.along() * way <= 0) {
      // Ends this part at the impulse at which the slip stops.
      own *= at.along() / (at.along() - then.along());
      stopped = true;
    }
    at.push(own, friction * own);
    normal += own, tangent += friction * own;
    work += 0.5 * own * (from + at.up());
  }
  if (rules.tangential_restitution > 0 && stopped && std::abs(at.along()) < 1e-6 * std::abs(slip)) {
    // Largest fraction of the requested restitution that friction, the gap and the energy permit.
    double low = 0, high = rules.tangential_restitution * std::abs(slip) / tt;
    const auto allowed = [&](double more) {
      Blow then = at;
      then.push(0, -way * more);
      return std::abs(tangent - way * more) <=
                 std::max(mu, mu * rules.friction_after_stop) * normal + 1e-12 &&
             then.up() >= 0 && then.energy() <= before;
    };
    if (allowed(high)) low = high;
    for (int i = 0; i < 60 && low < high; ++i)
      if (const double middle = 0.5 * (low + high); allowed(middle))
        low = middle;
      else
        high = middle;
    at.push(0, -way * low);
  }
  return at;
}

// Drops a box on a floor, on a corner or flat, and compares the velocities after the impact with the law of
// its scene. A World is judged only with restitution: without it, impacts are left to the step's solver.
std::string blown(Random& random, const Accuracy& accuracy) {
  const bool precise = std::holds_alternative<Precise>(accuracy);
  const double s = random.ladder(0.2, 5), wide = s, high = s * random.within(0.2, 1),
               mass = random.ladder(0.1, 10);
  const double mu = random.pick({0.0, 0.1, 0.3, 0.6, 1.0}), e = random.within(precise ? 0 : 0.1, 1),
               gap = (precise ? 1e-7 : 1e-2) * s;
  const bool flat = random.chance(0.3);
  const double angle = flat ? 0 : random.within(0.15, 1.4);
  const double c = std::cos(angle), sn = std::sin(angle);
  const double speed = random.within(0.5, 3) * s;
  Scene scene{.name = "blow", .gravity = {0, 0}};
  ContactRules& rules = scene.contact_rules;
  if (precise) {
    rules.impact =
        random.pick({ImpactRule::Newton, ImpactRule::Poisson, ImpactRule::Stronge, ImpactRule::Stronge});
    if (rules.impact != ImpactRule::Newton && random.chance(0.5))
      rules.friction_after_stop = random.pick({0.0, 0.5, 0.75});
    if (rules.impact != ImpactRule::Newton && random.chance(0.4))
      rules.tangential_restitution = random.pick({0.3, 0.7, 1.0});
    if (random.chance(0.3)) rules.yield_speed = 0.2 * speed;
  }
  scene.bodies.push_back({.name = "floor",
                          .type = BodyType::Static,
                          .position = {0, -5 * s},
                          .shapes = {{.geometry = Box{40 * s, 10 * s}, .friction = mu, .restitution = e}}});
  // Arm from the centre to the lowest of the four corners.
  const Vec2d corner = flat ? Vec2d{random.pick({-0.5, 0.5}) * wide, -high / 2} : Vec2d{-wide / 2, -high / 2};
  const Vec2d arm = flat ? corner : Vec2d{c * corner.x - sn * corner.y, sn * corner.x + c * corner.y};
  Body box{.name = "box",
           .position = {-arm.x, gap - arm.y},
           .angle = angle,
           .mass = mass,
           .shapes = {{.geometry = Box{wide, high}, .friction = mu, .restitution = e}}};
  box.velocity = {random.within(-2, 2) * speed, -speed};
  const bool level = flat && random.chance(0.5);  // both corners together
  // A World resolves impacts within a step. Without spin the box strikes with its initial angle.
  box.angular_velocity = level || !precise ? 0 : random.within(-1, 1) * speed / s;
  Blow blow{mass, inertia_of(box), arm, box.velocity, box.angular_velocity};
  scene.bodies.push_back(box);
  if (level && mu != 0) return {};
  if (level) blow.arm.x = 0;
  const double closing = -blow.up();
  if (closing < 0.1 * speed) return {};
  // The other corner of a flat box must open before and after.
  Blow other = blow;
  other.arm.x = -arm.x;
  if (flat && !level && other.up() < 0.05 * speed) return {};
  const double restitution = rules.yield_speed > 0 && closing > rules.yield_speed
                                 ? e * std::pow(closing / rules.yield_speed, -0.25)
                                 : e;
  Blow right = blow;
  if (rules.impact == ImpactRule::Newton) {
    const double nn = 1 / mass + blow.arm.x * blow.arm.x / blow.inertia,
                 nt = -blow.arm.x * arm.y / blow.inertia, tt = 1 / mass + arm.y * arm.y / blow.inertia,
                 wanted = (1 + restitution) * closing;
    const double slip = blow.along(), determinant = nn * tt - nt * nt;
    double normal = (wanted * tt + slip * nt) / determinant,
           tangent = -(wanted * nt + slip * nn) / determinant;
    if (std::abs(tangent) > mu * normal) {
      // Friction opposes the slip or, at zero slip, the sliding that it cannot prevent.
      const double share = (slip != 0 ? slip < 0 : tangent > 0) ? mu : -mu;
      normal = wanted / (nn + share * nt), tangent = share * normal;
      right.push(normal, tangent);
      if (normal < 0 || right.along() * slip < 0) return {};  // reversed: another branch of the law
      right = blow;
    }
    right.push(normal, tangent);
    if (right.energy() > blow.energy() * (1 - 1e-9)) return {};  // scaled down: not judged here
  } else {
    right = struck(blow, rules, restitution, mu);
  }
  other.velocity = right.velocity, other.spin = right.spin;
  if (flat && !level && other.up() < 0.05 * speed) return {};
  const double dt = (precise ? 1e-4 : 0.02) * s / speed;
  // Another corner may be struck before the step ends.
  for (const Vec2d each : {Vec2d{-wide / 2, -high / 2}, Vec2d{wide / 2, -high / 2}, Vec2d{wide / 2, high / 2},
                           Vec2d{-wide / 2, high / 2}}) {
    const Vec2d at{c * each.x - sn * each.y, sn * each.x + c * each.y};
    const double height = at.y - arm.y, rate = right.velocity.y + right.spin * at.x;
    if (height > 1e-9 * s && height + 2 * dt * std::min(rate, box.velocity.y) < 0) return {};
  }
  Accuracy own = accuracy;
  if (auto* realtime = std::get_if<Realtime>(&own))
    realtime->dt = dt;
  else
    own = Precise{.max_dt = dt};
  Simulation run = compile(scene, own);
  const Vec2d before = run.state(1).velocity;
  for (int i = 0; i < 20 && run.state(1).velocity == before; ++i) run.step();
  if (run.state(1).velocity == before) return {};
  const BodyState found = run.state(1);
  const double off =
      length(found.velocity - right.velocity) + s * std::abs(found.angular_velocity - right.spin);
  // A World's impacts in flight are exact to rounding; Routh's method here has finite parts.
  const auto* realtime = std::get_if<Realtime>(&accuracy);
  const double share = realtime == nullptr ? 4e-3 : realtime->precision == Precision::Double ? 1e-9 : 2e-4;
  if (off > share * (length(box.velocity) + s * std::abs(box.angular_velocity)))
    return fmt::format(
        "a box that strikes a floor rebounds with {:.5g}, {:.5g} m/s and {:.5g} rad/s, not {:.5g}, {:.5g} "
        "and {:.5g} (law {}, e {:.3g}, mu {:.3g})",
        found.velocity.x, found.velocity.y, found.angular_velocity, right.velocity.x, right.velocity.y,
        right.spin, static_cast<int>(rules.impact), restitution, mu);
  return {};
}

// Checks that a block on a floor or a slope slides with its kinetic friction, and starts only above the limit
// of static friction.
std::string slid(Random& random) {
  const double s = random.ladder(0.2, 5), mu = random.within(0.1, 0.8), share = random.within(0.3, 1),
               g = 9.81;
  const double slope = random.chance(0.5) ? 0 : random.within(0.1, 0.9),
               v = random.pick({0.0, 1.0}) * random.within(1, 4);
  Scene scene{.name = "slide", .gravity = {g * std::sin(slope), -g * std::cos(slope)}};
  scene.contact_rules.friction_while_sliding = share;
  scene.bodies = {{.name = "floor",
                   .type = BodyType::Static,
                   .position = {0, -s},
                   .shapes = {{.geometry = Box{400 * s, 2 * s}, .friction = mu}}},
                  {.name = "block",
                   .position = {0, 0.1 * s},
                   .velocity = {v, 0},
                   .mass = 2,
                   .shapes = {{.geometry = Box{2 * s, 0.2 * s}, .friction = mu}}}};
  const double pull = g * std::sin(slope), hold = mu * g * std::cos(slope);
  if (std::abs(pull - hold) < 0.01 * g || std::abs(pull - share * hold) < 0.01 * g) return {};
  const double t = 0.4;
  double right = 0;
  if (v == 0) {
    right = pull > hold ? (pull - share * hold) * t : 0;
  } else {
    const double a = pull - share * hold;
    right = v + a * t;
    if (right < 0) right = pull > hold ? (pull - share * hold) * (t + v / a) : 0;
  }
  Simulation run = compile(scene, Precise{.max_dt = t});
  run.step();
  const double found = run.state(1).velocity.x;
  if (std::abs(found - right) > 1e-6 * (v + g * t))
    return fmt::format(
        "a sliding block has {:.7g} m/s after {} s, not {:.7g} (mu {:.3g}, kinetic friction {:.3g} of it, "
        "slope {:.3g} rad)",
        found, t, right, mu, share, slope);
  return {};
}

// Checks that a motor holds its speed against less than its torque in both directions, and that a limit stops
// a hinge that reaches it.
std::string driven_hinge(Random& random) {
  const double s = random.ladder(0.2, 5), most = random.ladder(1, 100), w = random.pick({0.0, 1.0, -2.0});
  const double load = most * random.pick({-1.5, -0.9, -0.3, 0.3, 0.9, 1.5});
  Scene scene{.name = "motor", .gravity = {0, 0}};
  scene.bodies = {
      {.name = "bar", .angular_velocity = w, .mass = 2, .shapes = {{.geometry = Box{s, 0.2 * s}}}}};
  scene.joints = {RevoluteJoint{
      .name = "hinge", .body_a = std::string(kWorld), .body_b = "bar", .motor = Motor{w, most}}};
  scene.forces = {Torque{.body = "bar", .torque = load}};
  const double t = 0.2, excess = std::abs(load) > most ? load - std::copysign(most, load) : 0;
  const double right = w + excess * t / inertia_of(scene.bodies.front());
  Simulation run = compile(scene, Precise{.max_dt = t});
  run.step();
  const double found = run.state(0).angular_velocity;
  if (std::abs(found - right) > 1e-6 * (std::abs(right) + 1))
    return fmt::format(
        "a motor of {:.4g} rad/s and {:.4g} N m under a load of {:.4g} N m turns at {:.7g} rad/s, not {:.7g}",
        w, most, load, found, right);
  // A bar whose weight holds it at a limit, and a ball that falls on its end.
  const double e = random.within(0, 1), speed = random.within(1, 5), radius = 0.1 * s;
  Scene stop{.name = "stop"};
  stop.bodies = {{.name = "bar",
                  .position = {s / 2, 0},
                  .mass = 2,
                  .shapes = {{.geometry = Box{s, 0.2 * s}, .friction = 0, .restitution = e}}},
                 {.name = "ball",
                  .position = {0.8 * s, 0.1 * s + radius + 1e-6 * s},
                  .velocity = {0, -speed},
                  .mass = 1,
                  .shapes = {{.geometry = Circle{radius}, .friction = 0, .restitution = e}}}};
  stop.joints = {RevoluteJoint{.name = "hinge",
                               .body_a = std::string(kWorld),
                               .body_b = "bar",
                               .anchor_b = {-s / 2, 0},
                               .limits = Range{0, 1}}};
  Simulation falls = compile(stop, Precise{.max_dt = 1e-4 * s / speed});
  for (int i = 0; i < 20 && falls.statistics().impacts == 0; ++i) falls.step();
  if (falls.statistics().impacts == 0 || e < 0.05) return {};
  const double up = falls.state(1).velocity.y, turns = falls.state(0).angular_velocity;
  if (std::abs(up - e * speed) > 0.01 * speed || std::abs(turns) * s > 0.01 * speed)
    return fmt::format(
        "a ball that hits a bar at its joint limit with {:.4g} m/s rebounds with {:.5g} m/s, not {:.5g}",
        speed, up, e * speed);
  return {};
}

}  // namespace

Verdict blows(const Case& one, const Engine&, const Motion&) {
  const std::string what = checked_apart([&] {
    Random random(one.seed, one.index + 67);
    std::string wrong;
    for (int i = 0; i < 3 && wrong.empty(); ++i) {
      wrong = blown(random, Precise{});
      for (const auto& draw : {slid, driven_hinge})
        if (wrong.empty()) wrong = draw(random);
    }
    return wrong;
  });
  if (what.empty()) return {};
  return Objection{.law = "blows",
                   .judge = "blows",
                   .what = what,
                   .right = "impacts, friction, motors and limits obey the laws of the scene"};
}

Verdict strikes(const Case& one, const Engine& engine, const Motion&) {
  Random random(one.seed, one.index + 71);
  std::string wrong;
  const Precision precision = engine.kind == Engine::Kind::World ? Precision::Float : Precision::Double;
  for (int i = 0; i < 3 && wrong.empty(); ++i)
    wrong = blown(random, Realtime{.substeps = one.substeps, .precision = precision});
  if (wrong.empty()) return {};
  return Objection{.law = "strikes",
                   .judge = "strikes",
                   .what = wrong,
                   .right = "an impact on a corner has the restitution and friction of its surfaces"};
}

}  // namespace plumb::harness::hunt
