#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/course/student/world.h"

// Resolves contacts: by impulses along the normal, by friction, and by moving bodies apart.
namespace plumb::course {
namespace {

double length(Vec2d a) { return std::hypot(a.x, a.y); }

}  // namespace

double StudentWorld::restitution(const Touch& touch) const {
  const double a = bodies_[touch.a].body->shapes[0].restitution,
               b = bodies_[touch.b].body->shapes[0].restitution;
  const double e = std::max(a, b) * times("restitution");
  if (is("restitution_root")) return std::sqrt(e);
  if (is("restitution_of_one_less")) return 1 - e;
  if (is("restitution_minimum")) return std::min(a, b);
  if (is("restitution_mean")) return std::sqrt(a * b);
  if (is("restitution_sum")) return a + b;
  if (is("restitution_of_the_first")) return a;
  if (is("restitution_of_the_second")) return b;
  if (is("restitution_of_the_moving")) return bodies_[touch.a].inverse_mass > 0 ? a : b;
  if (is("restitution_of_the_static")) return bodies_[touch.a].inverse_mass > 0 ? b : a;
  if (is("restitution_squared")) return e * e;
  if (is("restitution_average")) return (a + b) / 2;
  if (is("restitution_product")) return a * b;
  if (is("always_elastic")) return 1;
  return is("restitution_zero") ? 0 : e;
}

// The arms of a contact, from the bodies' centres.
StudentWorld::Arms StudentWorld::arms_of(const Touch& touch) const {
  const Vec2d a = touch.point - bodies_[touch.a].position, b = touch.point - bodies_[touch.b].position;
  if (is("contact_arms_exchanged")) return {b, a};
  if (is("contact_first_arm_everywhere")) return {a, a};
  if (is("contact_second_arm_everywhere")) return {b, b};
  if (is("contact_arms_zero")) return {};
  return {a, b};
}

// The velocity of b's point relative to that of a.
Vec2d StudentWorld::relative_velocity(const Touch& touch) const {
  const auto at_point = [&](Vec2d velocity, double spin, Vec2d arm) {
    if (is("spin_not_in_velocity")) return velocity;
    if (is("point_velocity_flipped")) return velocity - cross(spin, arm);
    return velocity + times("w x r") * mixed("w x r", cross(spin, arm));
  };
  const Arms arms = arms_of(touch);
  const auto arm = [&](Vec2d own) { return is("contact_arm_from_origin") ? touch.point : own; };
  const auto r = edit_(Quantity::Arm, kContactRow, kInSpeed, std::array{arm(arms.a), arm(arms.b)},
                       {touch.point, touch.point});
  const auto [v, w] = moving(kContactRow, bodies_[touch.a], bodies_[touch.b]);
  const Vec2d a = at_point(v[0], w[0], r[0]), b = at_point(v[1], w[1], r[1]);
  const bool both = bodies_[touch.a].inverse_mass > 0 && bodies_[touch.b].inverse_mass > 0;
  if (is("velocity_of_the_first_only") && both) return -a;
  if (is("velocity_of_the_second_only") && both) return b;
  if (is("velocities_added")) return a + b;
  return b - a;
}

void StudentWorld::prepare(Touch& touch) const {
  const Vec2d coming =
      mixed("velocity before a bounce", mixed("velocity in a contact", relative_velocity(touch)));
  const Vec2d centres = bodies_[touch.b].velocity - bodies_[touch.a].velocity;
  const double closing = dot(is("bounce_of_centres") ? centres : coming, touch.normal);
  const double slow = is("threshold_too_high")     ? 3
                      : is("threshold_without_dt") ? 2 * length(scene_.gravity)
                                                   : 2 * length(scene_.gravity) * dt_;
  const bool fast = is("threshold_reversed")         ? closing < 0 && closing >= -slow
                    : is("threshold_of_whole_speed") ? closing < 0 && length(relative_velocity(touch)) > slow
                                                     : closing < -slow;
  if (fast || (is("never_rests") && closing < 0)) touch.bounce = -restitution(touch) * closing;
  if (is("closing_test_reversed_with_bounce"))
    touch.bounce = closing > slow ? -restitution(touch) * closing : 0;
  if (is("bounce_without_speed") && touch.bounce > 0) touch.bounce = restitution(touch);
  if (is("bounce_of_whole_speed") && touch.bounce > 0)
    touch.bounce = restitution(touch) * length(relative_velocity(touch));
  if (is("one_plus_twice") && touch.bounce > 0) touch.bounce -= closing;
  if (is("bounce_sign")) touch.bounce = -touch.bounce;
  if (is("one_plus_forgotten") && touch.bounce > 0) touch.bounce += closing;
  if (scales("share of an overlap in the bounce")) touch.bounce += factor_ * touch.depth / dt_;
}

void StudentWorld::apply_impulse(std::size_t a, std::size_t b, Vec2d arm_a, Vec2d arm_b, Vec2d impulse) {
  Rigid &first = bodies_[a], &second = bodies_[b];
  first.velocity -= first.inverse_mass * impulse;
  const double turn = times("spin by an impulse");
  first.spin -= turn * first.inverse_inertia * cross(arm_a, impulse);
  second.velocity += second.inverse_mass * impulse;
  second.spin += turn * second.inverse_inertia * cross(arm_b, impulse);
}

// Makes the mistakes that carry impulses from the last step over: they are applied and left out of the sums,
// or the other way round.
void StudentWorld::start_with_last_sums(std::vector<Touch>& found) {
  const bool rub = is("sums_applied_again_with_friction") || is("sums_kept_with_friction");
  const bool applied = is("sums_applied_again") || is("sums_applied_again_with_friction");
  if (!applied && !is("sums_kept") && !is("sums_kept_with_friction")) return;
  for (Touch& touch : found) {
    touch.of_pair = static_cast<int>(std::count_if(&found.front(), &touch, [&](const Touch& other) {
      return other.a == touch.a && other.b == touch.b;
    }));
    const auto last = std::find_if(last_found_.begin(), last_found_.end(), [&](const Touch& other) {
      return other.a == touch.a && other.b == touch.b && other.of_pair == touch.of_pair;
    });
    if (last == last_found_.end()) continue;
    const Vec2d n = touch.normal, t{-n.y, n.x};
    const auto [arm_a, arm_b] = arms_of(touch);
    if (applied)
      apply_impulse(touch.a, touch.b, arm_a, arm_b, last->sum * n + (rub ? last->sum_across : 0) * t);
    else
      touch.sum = last->sum, touch.sum_across = rub ? last->sum_across : 0;
  }
}

void StudentWorld::answer_all(std::vector<Touch>& found) {
  if (!is("both_corners_take_all")) {
    for (Touch& touch : found) {
      const bool parts = touch.sum == 0 && dot(relative_velocity(touch), touch.normal) > 0;
      if (is("parting_contact_ends_the_loop") && parts) break;
      answer(touch);
    }
    return;
  }
  const std::vector<Rigid> before = bodies_;
  std::vector<Rigid> after = bodies_;
  for (Touch& touch : found) {
    answer(touch);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      after[i].velocity += bodies_[i].velocity - before[i].velocity;
      after[i].spin += bodies_[i].spin - before[i].spin;
    }
    bodies_ = before;
  }
  bodies_ = after;
}

// Makes the mistakes that set velocities without an impulse; returns false if none of them is made.
bool StudentWorld::answer_wrongly(Touch& touch, double closing) {
  Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const Vec2d n = touch.normal;
  if (is("both_turned") && closing < 0) {
    a.velocity = -a.velocity;
    return true;
  }
  if (is("velocity_sign_lost") && closing < 0) {
    Rigid& moves = a.inverse_mass > 0 ? a : b;
    const bool upright = std::abs(n.y) > std::abs(n.x);
    double& v = upright ? moves.velocity.y : moves.velocity.x;
    v = restitution(touch) * std::abs(v);
    return true;
  }
  if (is("stops_dead") && closing < 0) {
    a.velocity = b.velocity = {};
    return true;
  }
  if (is("wrong_axis") && closing < 0) {
    Vec2d& v = (a.inverse_mass > 0 ? a : b).velocity;
    (std::abs(n.y) > std::abs(n.x) ? v.x : v.y) *= -restitution(touch);
    touch.bounce = closing;
    return true;
  }
  if (is("whole_velocity_scaled") && closing < 0) {
    if (a.inverse_mass > 0) a.velocity *= -restitution(touch);
    if (b.inverse_mass > 0) b.velocity *= -restitution(touch);
    return true;
  }
  if ((is("only_vy_turned") || is("only_vx_turned")) && closing < 0) {
    for (Rigid* moves : {&a, &b}) {
      double& v = is("only_vy_turned") ? moves->velocity.y : moves->velocity.x;
      if (moves->inverse_mass > 0) v *= -restitution(touch);
    }
    return true;
  }
  if (is("turned_every_step")) {
    a.velocity -= (1 + restitution(touch)) * dot(a.velocity, n) * n;
    return true;
  }
  if (is("each_turned_by_itself") && a.inverse_mass > 0 && b.inverse_mass > 0) {
    if (closing >= 0) return true;
    const double turn = 1 + restitution(touch);
    if (const double speed = dot(a.velocity, n); speed > 0) a.velocity -= turn * speed * n;
    if (const double speed = dot(b.velocity, n); speed < 0) b.velocity -= turn * speed * n;
    return true;
  }
  if (is("each_turned") && closing < 0) {
    a.velocity -= 2 * dot(a.velocity, n) * n;
    b.velocity -= 2 * dot(b.velocity, n) * n;
    return true;
  }
  return false;
}

// Returns the sum of impulses that a contact's impulse is added to: its own, or one of several contacts.
double& StudentWorld::sum_of(Touch& touch) {
  if (is("sum_of_the_first_body")) return bodies_[touch.a].sum;
  if (is("sum_of_the_second_body")) return bodies_[touch.b].sum;
  if (is("sum_of_the_earlier_body")) return bodies_[std::min(touch.a, touch.b)].sum;
  if (is("sum_of_the_later_body")) return bodies_[std::max(touch.a, touch.b)].sum;
  if (is("sum_of_the_pair")) return pair_sums_[std::minmax(touch.a, touch.b)];
  return is("sum_of_all_contacts") ? bodies_.back().sum : touch.sum;
}

void StudentWorld::answer(Touch& touch) {
  Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const Vec2d n = touch.normal;
  const auto [arm_a, arm_b] = arms_of(touch);
  const double closing =
      dot(mixed("velocity in an impulse", mixed("velocity in a contact", relative_velocity(touch))), n);
  if (is("static_bodies_not_answered") && (a.inverse_mass == 0 || b.inverse_mass == 0)) return;
  if (is("bounce_each_sweep")) touch.bounce = -restitution(touch) * closing;
  if (is("ignores_slow") && closing > -4 * length(scene_.gravity) * dt_) return;
  if (answer_wrongly(touch, closing)) return;
  const auto in_mass =
      edit_(Quantity::Arm, kContactRow, kInMass, std::array{arm_a, arm_b}, {touch.point, touch.point});
  double spin_a = cross(in_mass[0], n), spin_b = cross(in_mass[1], n);
  const bool heavy_only = is("effective_mass_without_rotation") || is("no_rotation");
  const auto [masses, inertias] = eases(kContactRow, kInMass, a, b);
  double k = masses[0] + masses[1];
  if (is("effective_mass_of_the_first_arm")) spin_b = spin_a;
  if (is("effective_mass_of_the_second_arm")) spin_a = spin_b;
  if (is("first_inverse_mass_only")) k = a.inverse_mass > 0 ? a.inverse_mass : k;
  if (is("second_inverse_mass_only")) k = b.inverse_mass > 0 ? b.inverse_mass : k;
  if (is("first_inverse_mass_for_both") && a.inverse_mass > 0) k = 2 * a.inverse_mass;
  if (is("second_inverse_mass_for_both") && b.inverse_mass > 0) k = 2 * b.inverse_mass;
  if (is("first_inverse_mass_twice")) k += a.inverse_mass;
  if (is("second_inverse_mass_twice")) k += b.inverse_mass;
  if (is("lever_not_squared"))
    k += a.inverse_inertia * std::abs(spin_a) + b.inverse_inertia * std::abs(spin_b);
  else if (is("effective_mass_with_lever_only"))
    k += spin_a * spin_a + spin_b * spin_b;
  else if (!heavy_only)
    k += times("rotation in an effective mass") *
         (inertias[0] * spin_a * spin_a + inertias[1] * spin_b * spin_b);
  if (is("masses_in_place_of_inverses_of_moving"))
    k = (a.inverse_mass > 0 ? 1 / a.inverse_mass : 0) + (b.inverse_mass > 0 ? 1 / b.inverse_mass : 0);
  if (is("masses_in_place_of_inverses")) k = 1 / a.inverse_mass + 1 / b.inverse_mass;
  if (is("effective_mass_forgotten")) k = 1;
  if (is("effective_mass_multiplied")) k = 1 / k;
  if (is("masses_ignored")) k = (a.inverse_mass > 0) + (b.inverse_mass > 0);
  const auto in_change =
      edit_(Quantity::Arm, kContactRow, kInChange, std::array{arm_a, arm_b}, {touch.point, touch.point});
  spin_a = cross(in_change[0], n), spin_b = cross(in_change[1], n);
  double j = times("impulse of a contact") * (touch.bounce - closing) / k;
  double& total = sum_of(touch);
  const auto new_sum = [&](double change) {
    if (is("each_push_clamped")) return total + std::max(0.0, change);
    if (is("closing_test_reversed") || is("closing_test_reversed_with_bounce"))
      return std::min(0.0, total + change);
    return is("no_test_of_parting") ? total + change : std::max(0.0, total + change);
  };
  const double before = total, sum = new_sum(j);
  j = is("whole_sum_applied") ? sum : sum - before;
  const auto [changes, turns] = eases(kContactRow, kInChange, a, b);
  double share_a = changes[0], share_b = changes[1];
  if (is("inverse_mass_forgotten") || is("masses_ignored")) {
    share_a = share_a > 0;
    share_b = share_b > 0;
  }
  const bool both_move = share_a > 0 && share_b > 0;
  if (is("masses_swapped") || (is("masses_swapped_of_moving") && both_move)) std::swap(share_a, share_b);
  if (is("one_body_only")) share_b = 0;
  if (is("other_body_only")) share_a = 0;
  if (is("inverse_mass_of_the_first")) share_b = share_a > 0 && share_b > 0 ? share_a : share_b;
  if (is("inverse_mass_of_the_second")) share_a = share_a > 0 && share_b > 0 ? share_b : share_a;
  if (is("inverse_mass_mean") && share_a > 0 && share_b > 0) share_a = share_b = (share_a + share_b) / 2;
  if (is("multiplied_by_mass")) {
    share_a = share_a > 0 ? 1 / share_a : 0;
    share_b = share_b > 0 ? 1 / share_b : 0;
  }
  if (is("same_direction_for_both")) share_a = -share_a;
  if (is("no_rotation")) spin_a = spin_b = 0;
  if (is("r_cross_n_flipped")) spin_a = -spin_a, spin_b = -spin_b;
  if (is("first_never_spins") || is("spin_not_changed")) spin_a = 0;
  if (is("second_never_spins") || is("spin_not_changed")) spin_b = 0;
  if (is("second_arm_for_both") || is("arms_swapped")) spin_a = cross(arm_b, n);
  if (is("first_arm_for_both") || is("arms_swapped")) spin_b = cross(arm_a, n);
  if (is("second_sees_new_velocity") || is("first_sees_new_velocity")) {
    const bool first_now = is("second_sees_new_velocity");
    const auto apply_to_first = [&](double push) {
      a.velocity -= a.inverse_mass * push * n;
      a.spin -= a.inverse_inertia * spin_a * push;
    };
    const auto apply_to_second = [&](double push) {
      b.velocity += b.inverse_mass * push * n;
      b.spin += b.inverse_inertia * spin_b * push;
    };
    first_now ? apply_to_first(j) : apply_to_second(j);
    const double again = new_sum((touch.bounce - dot(relative_velocity(touch), n)) / k) - before;
    first_now ? apply_to_second(again) : apply_to_first(again);
    touch.sum = total = sum;
    return rub(touch);
  }
  touch.sum = total = sum;
  touch.last = j;
  Vec2d push = j * n;
  if (is("along_wall_changed") && j > 0 && touch.sum == j) {
    Rigid& moves = a.inverse_mass > 0 ? a : b;
    const Vec2d along{-n.y, n.x};
    moves.velocity -= (1 - restitution(touch)) * dot(moves.velocity, along) * along;
  }
  if (is("impulse_backwards")) push = -push;
  if (is("whole_velocity") && j > 0)
    push = length(a.velocity - b.velocity) / k * 2.0 / length(a.velocity - b.velocity) *
           (a.velocity - b.velocity);
  push = mixed("impulse of a contact", push);
  a.velocity -= share_a * mixed("impulse on the first", push);
  b.velocity += share_b * mixed("impulse on the second", push);
  const auto turns_by = [&](const Rigid& body, double own) {
    if (is("spin_by_inverse_mass")) return body.inverse_mass;
    if (is("spin_by_inverse_mass_of_turning")) return own > 0 ? body.inverse_mass : 0;
    return is("spin_by_impulse_alone") && body.inverse_inertia > 0 ? 1 : own;
  };
  const double turn = times("spin by an impulse");
  a.spin -= turn * turns_by(a, turns[0]) * spin_a * j;
  b.spin += turn * turns_by(b, turns[1]) * spin_b * j;
  rub(touch);
}

// Friction: along the tangent, at most mu times the sum of the impulses along the normal.
void StudentWorld::rub(Touch& touch) {
  Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
  const double mu_a = a.body->shapes[0].friction, mu_b = b.body->shapes[0].friction;
  double mu = times("friction") * std::sqrt(mu_a * mu_b);
  if (is("friction_product")) mu = mu_a * mu_b;
  if (is("friction_average")) mu = (mu_a + mu_b) / 2;
  if (is("friction_sum")) mu = mu_a + mu_b;
  if (is("friction_minimum")) mu = std::min(mu_a, mu_b);
  if (is("friction_maximum")) mu = std::max(mu_a, mu_b);
  const double e_a = a.body->shapes[0].restitution, e_b = b.body->shapes[0].restitution;
  if (is("friction_by_restitution")) mu = std::sqrt(e_a * e_b);
  if (is("friction_by_restitution_of_its_rule")) mu = std::max(e_a, e_b);
  if (is("friction_of_the_first")) mu = mu_a;
  if (is("friction_of_the_second")) mu = mu_b;
  if (is("friction_without_mu")) mu = 1;
  // With a coefficient of 0, friction acts only if the mistake leaves one side without a limit.
  const bool above_only = is("friction_limited_above_only"), below_only = is("friction_limited_below_only");
  if ((mu == 0 && !above_only && !below_only && !is("friction_unlimited_everywhere")) ||
      is("friction_ignored"))
    return;
  const Vec2d across{-touch.normal.y, touch.normal.x};
  Vec2d t = mixed("direction of friction", mixed("tangent", across));
  if (is("tangent_not_unit") || is("tangent_not_unit_in_mass")) {
    const Vec2d v = relative_velocity(touch);
    t = v - dot(v, touch.normal) * touch.normal;
  }
  const auto [arm_a, arm_b] = arms_of(touch);
  const Arms raw{touch.point, touch.point};
  const double spin_a = cross(arm_a, t), spin_b = cross(arm_b, t);
  const Vec2d in_mass = is("friction_by_mass_of_normal")                  ? touch.normal
                        : is("tangent_not_unit_in_mass") && dot(t, t) > 0 ? t
                                                                          : mixed("tangent", across);
  double k = edited_mass(kFrictionRow, a, b, {arm_a, arm_b}, raw, in_mass);
  if (is("friction_lever_not_squared"))
    k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * spin_a + b.inverse_inertia * spin_b;
  if (is("friction_without_rotation")) k = a.inverse_mass + b.inverse_mass;
  const bool centre_a = is("sliding_of_centres") || is("sliding_of_the_first_centre");
  const bool centre_b = is("sliding_of_centres") || is("sliding_of_the_second_centre");
  const double sliding =
      speed_apart(kFrictionRow, a, b, {centre_a ? Vec2d{} : arm_a, centre_b ? Vec2d{} : arm_b}, raw, t);
  const bool unlimited = is("friction_unlimited") || is("friction_unlimited_everywhere");
  double most = unlimited ? 1e9 : mu * touch.sum;
  if (is("friction_without_normal")) most = mu;
  if (is("friction_by_weight"))
    most = mu * length(scene_.gravity) * dt_ / (b.inverse_mass > 0 ? b.inverse_mass : a.inverse_mass);
  if (is("friction_without_mu")) most = touch.sum;
  if (is("friction_limit_times_dt")) most *= dt_;
  if (is("friction_by_last_impulse")) most = mu * std::abs(touch.last);
  most *= times("limit of friction");
  const double against = times("impulse of friction") * (is("friction_backwards") ? -sliding : sliding);
  double sum = std::clamp(touch.sum_across - against / k, -most, most);
  if (above_only || is("rough_limited_above_only")) sum = std::min(touch.sum_across - against / k, most);
  if (below_only || is("rough_limited_below_only")) sum = std::max(touch.sum_across - against / k, -most);
  if (is("friction_bounds_exchanged")) sum = most;
  if (is("friction_at_its_limit")) sum = sliding > 0 ? -most : sliding < 0 ? most : 0;
  if (is("friction_each_limited")) sum = touch.sum_across + std::clamp(-against / k, -most, most);
  const double before = std::exchange(touch.sum_across, sum);
  const double j = is("whole_friction_sum_applied") ? sum : sum - before;
  Vec2d turns_a = is("second_arm_for_both") || is("arms_swapped") ? arm_b : arm_a;
  Vec2d turns_b = is("first_arm_for_both") || is("arms_swapped") ? arm_a : arm_b;
  if (is("friction_never_spins") || is("friction_spins_the_second_only")) turns_a = {};
  if (is("friction_never_spins") || is("friction_spins_the_first_only")) turns_b = {};
  change(kFrictionRow, a, b, {turns_a, turns_b}, raw, j * t);
}

void StudentWorld::push_out(const std::vector<Touch>& found) {
  if (is("correction_split_evenly")) {
    for (const Touch& touch : found) {
      const Vec2d push = manner_.share / 2 * std::max(0.0, touch.depth - manner_.slop) * touch.normal;
      bodies_[touch.a].position -= push;
      bodies_[touch.b].position += push;
    }
    return;
  }
  const double left = manner_.after_move ? 0 : manner_.slop;
  for (const Touch& touch : found) {
    const auto of_pair = std::count_if(found.begin(), found.end(), [&](const Touch& other) {
      return other.a == touch.a && other.b == touch.b;
    });
    const double part =
        (manner_.after_move ? 1 : manner_.share) / static_cast<double>(manner_.per_point ? of_pair : 1);
    Rigid &a = bodies_[touch.a], &b = bodies_[touch.b];
    const Vec2d zero{};
    const Arms arms =
        manner_.turning_push ? Arms{touch.point - a.position, touch.point - b.position} : Arms{zero, zero};
    const Arms raw = manner_.turning_push ? Arms{touch.point, touch.point} : Arms{zero, zero};
    const double inverse =
        is("correction_not_divided") ? 1 : edited_mass(kOverlapRow, a, b, arms, raw, touch.normal);
    const Vec2d push =
        mixed("push out of an overlap", part * std::max(0.0, touch.depth - left) / inverse * touch.normal);
    if (scales("share of an overlap that becomes velocity")) {
      const double faster = factor_ / (part * dt_);
      a.velocity -= faster * a.inverse_mass * push;
      b.velocity += faster * b.inverse_mass * push;
      continue;
    }
    const auto [mass, inertia] = eases(kOverlapRow, kInChange, a, b);
    double share_a = mass[0], share_b = mass[1];
    const bool both = share_a > 0 && share_b > 0;
    if (is("correction_shares_swapped") && both) std::swap(share_a, share_b);
    if (is("correction_of_the_first_only") && both) share_b = 0;
    if (is("correction_of_the_second_only") && both) share_a = 0;
    if (is("correction_without_masses") && both) share_a = share_b = share_a + share_b;
    if (is("correction_of_the_first_only_always")) share_b = 0;
    if (is("correction_of_the_second_only_always")) share_a = 0;
    const double f = times("correction of an overlap");
    const auto turned =
        edit_(Quantity::Arm, kOverlapRow, kInChange, std::array{arms.a, arms.b}, {raw.a, raw.b});
    a.position -= f * share_a * push;
    a.angle -= f * inertia[0] * cross(turned[0], push);
    b.position += f * share_b * push;
    b.angle += f * inertia[1] * cross(turned[1], push);
  }
}

}  // namespace plumb::course
