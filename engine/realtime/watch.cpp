#include "engine/realtime/watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/joints/joints.h"
#include "engine/realtime/watch_bounds.h"

namespace plumb {
namespace {

constexpr const char* kAdvice = "; a smaller dt, more substeps or 'plumb-world' may do better";

template <class Real>
Real width_of(const SolidShape<Real>& shape) {
  return 2 * (shape.kind == ShapeKind::Circle ? shape.radius : std::min(shape.half.x, shape.half.y));
}

/// How deep the shapes lie in each other; below zero, how far apart they are.
template <class Real>
Real depth_of(const Contact<Real>& contact) {
  Real depth = -contact.points[0].separation;
  if (contact.count > 1) depth = std::max(depth, -contact.points[1].separation);
  return depth;
}

/// How far rounding may have moved two bodies towards each other, m.
template <class Real>
Real rounding_of(const Contact<Real>& contact, const Bodies<Real>& bodies) {
  Real far = 0;
  for (const int body : {contact.a, contact.b}) {
    const Vec2<Real> position = bodies.pose[body].position;
    far += std::max(std::abs(position.x), std::abs(position.y));
  }
  return std::numeric_limits<Real>::epsilon() / 2 * far;
}

std::string figure_of(double value, const char* unit) { return shortest(value) + unit; }

template <class Real>
Error broken(const std::string& subject, const char* field, Real value, Real bound, const char* unit,
             const std::string& promise) {
  return {Error::Kind::Run, subject, field, figure_of(static_cast<double>(value), unit),
          promise + " " + figure_of(static_cast<double>(bound), unit) + kAdvice};
}

/// Lower towers stand at any step that what rests allows.
constexpr std::size_t kLeastTower = 6;

/// Returns true if a value of `times` its bound is to be reported; `misses` counts consecutive violations.
bool lasts(double times, int& misses) {
  misses = times > 1 ? std::min(misses + 1, bounds::kLasting) : 0;
  return misses >= bounds::kLasting || times > bounds::kAtOnce;
}

/// Counts a step that misses a bound, or that is one for the better. True when `most` steps have missed it.
bool mounts(bool better, int most, int& misses) {
  most *= bounds::kRecurrence;
  misses = better ? std::max(misses - 1, 0) : std::min(misses + bounds::kRecurrence, most);
  return misses >= most;
}

/// Of an overlap or sag that is `now` and was `before`; above `at_once` there is no waiting.
template <class Real>
bool stays(Real now, Real before, double bound, double at_once, int& misses) {
  const bool better = now <= Real(bound) || now < Real(bounds::kDissolving) * before;
  return mounts(better, bounds::kSettling, misses) || now > Real(at_once);
}

}  // namespace

template <class Real>
Watch<Real>::Watch(const Scene& scene, const std::vector<std::string>& names, const Bodies<Real>& bodies,
                   bool contacts)
    : names_(&names), energy_(scene, bodies, contacts) {
  constexpr Real kFar = std::numeric_limits<Real>::max();
  std::vector<Real> size(bodies.size(), 0);
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const Body& of = scene.bodies[body];
    dynamic_.push_back(of.type == BodyType::Dynamic);
    Real width = kFar, reach = 0;
    for (const Shape& shape : of.shapes) {
      reach = std::max(reach, static_cast<Real>(reach_of(shape.geometry)));
    }
    width_.push_back(width);
    const Real spread = std::sqrt(static_cast<Real>(inertia_of(of) / (dynamic_[body] ? of.mass : 1)));
    size[body] = std::max(reach, spread);
    // Rounding is half of epsilon |x|.
    farthest_.push_back(reach > 0 && dynamic_[body]
                            ? Real(2 * bounds::kRounding) * 2 * reach / std::numeric_limits<Real>::epsilon()
                            : kFar);
  }
  for (const SolidShape<Real>& shape : compile_shapes<Real>(scene))
    width_[shape.body] = std::min(width_[shape.body], width_of(shape));
  if (contacts && !(scene.gravity == Vec2d{})) {
    const double g = std::sqrt(length_squared(scene.gravity));
    up_ = ((-1 / g) * scene.gravity).as<Real>();
    gravity_ = g;
    sag_.resize(bodies.size()), sag_before_.resize(bodies.size()), sag_misses_.resize(bodies.size());
  }
  const auto moving = std::count(dynamic_.begin(), dynamic_.end(), char{1});
  if (scene.joints.empty() && (!contacts || moving < 2)) farthest_.clear();
  const Joints<Real> joints = compile_joints<Real>(scene);
  const auto add = [&](const auto& joint, const std::string& name, Real length) {
    WatchedJoint watched{name, joint.a, joint.b, joint.anchor_a, joint.anchor_b, length, length};
    const auto widen = [&](int body, Vec2<Real> anchor) {
      if (body == kFixedFrame || !dynamic_[body]) return;
      watched.span = std::max({watched.span, size[body], std::sqrt(length_squared(anchor))});
    };
    widen(joint.a, joint.anchor_a), widen(joint.b, joint.anchor_b);
    joints_.push_back(watched);
  };
  std::size_t hinge = 0, rod = 0;
  for (const Joint& joint : scene.joints) {
    const std::string name = std::visit([](const auto& j) { return j.name; }, joint);
    if (std::holds_alternative<RevoluteJoint>(joint)) add(joints.revolute[hinge++], name, Real{0});
    if (std::holds_alternative<DistanceJoint>(joint)) {
      add(joints.distance[rod], name, joints.distance[rod].length);
      ++rod;
    }
  }
}

template <class Real>
Real Watch<Real>::gap_of(const WatchedJoint& joint, const Bodies<Real>& bodies) const {
  // The difference of positions first: far from the origin their sum with the arms would be rounded.
  Vec2<Real> way = joint.b == kFixedFrame ? joint.anchor_b : bodies.pose[joint.b].position;
  way -= joint.a == kFixedFrame ? joint.anchor_a : bodies.pose[joint.a].position;
  if (joint.b != kFixedFrame) way += bodies.pose[joint.b].rotation * joint.anchor_b;
  if (joint.a != kFixedFrame) way -= bodies.pose[joint.a].rotation * joint.anchor_a;
  const Real distance = std::sqrt(length_squared(way));
  return joint.length > 0 ? std::abs(distance - joint.length) : distance;
}

template <class Real>
void Watch<Real>::begin(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                        std::span<const SolidShape<Real>> shapes) {
  anew_ = false;
  for (WatchedJoint& joint : joints_) joint.excess = gap_of(joint, bodies);
  excess_.clear();
  note_excess(bodies, contacts, shapes);
  std::fill(sag_.begin(), sag_.end(), Real{0});
  std::fill(sag_misses_.begin(), sag_misses_.end(), 0);
  for (WatchedJoint& joint : joints_) joint.misses = 0;
  deep_.clear();
  energy_misses_ = drift_misses_ = tower_misses_ = 0;
  energy_.begin(bodies);
}

/// Bodies that lie in others from the start, and how deep: what rounding brings about is no choice of the
/// scene's.
template <class Real>
void Watch<Real>::note_excess(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                              std::span<const SolidShape<Real>> shapes) {
  deepest_.clear();
  for (const Contact<Real>& contact : contacts) {
    if (contact.count == 0) continue;
    const Real depth = depth_of(contact) - rounding_of(contact, bodies);
    if (!(depth > Real(bounds::kOverlap) * width_between(contact, shapes))) continue;
    deepest_.resize(names_->size(), 0);
    for (const int body : {contact.a, contact.b})
      if (dynamic_[body]) deepest_[body] = std::max(deepest_[body], depth);
  }
  if (!excess_.empty() && !deepest_.empty())
    for (std::size_t body = 0; body < deepest_.size(); ++body)
      deepest_[body] = std::min(deepest_[body], excess_[body]);
  excess_.swap(deepest_);
}

/// Checks positions of bodies that can collide or are jointed; the energy check suffices for isolated ones.
template <class Real>
std::optional<Error> Watch<Real>::look_at_positions(const Bodies<Real>& bodies) const {
  for (std::size_t body = 0; body < farthest_.size(); ++body) {
    const Vec2<Real> position = bodies.pose[body].position;
    const Real far = std::max(std::abs(position.x), std::abs(position.y));
    if (far <= farthest_[body]) continue;
    return Error(
        Error::Kind::Run, "body '" + (*names_)[body] + "'", "position",
        shortest(static_cast<double>(far)) + " m",
        "is rounded by more than four times the body's own size; double precision or 'plumb-world' is "
        "finer");
  }
  return {};
}

template <class Real>
std::optional<Error> Watch<Real>::look_at_joints(const Bodies<Real>& bodies) {
  for (WatchedJoint& joint : joints_) {
    const Real gap = gap_of(joint, bodies), bound = Real(bounds::kGap) * joint.span + joint.excess;
    if (lasts(static_cast<double>(gap / bound), joint.misses))
      return broken("joint '" + joint.name + "'", "gap", gap, bound, " m", "it was to stay within");
    joint.excess = std::min(joint.excess, gap);
  }
  return {};
}

/// The narrower one of what moves: a thin ground is no reason to be stricter with what stands on it.
template <class Real>
Real Watch<Real>::width_between(const Contact<Real>& contact,
                                std::span<const SolidShape<Real>> shapes) const {
  Real width = std::numeric_limits<Real>::max();
  for (const int place : {first_of(contact.pair), second_of(contact.pair)})
    if (dynamic_[shapes[place].body]) width = std::min(width, width_of(shapes[place]));
  return width;
}

/// Updates the sag of the upper body: the lower one's plus the penetration, as a fraction of the wider one's
/// width (a pebble on a tower has not sunk by its own size). Of two dynamic bodies the one with the higher
/// centre stands on the other: a cage stands on its ground, not by its lid on its content.
template <class Real>
void Watch<Real>::note_sag(const Bodies<Real>& bodies, const Contact<Real>& contact, Real depth) {
  const Real upward = dot(contact.normal, up_);
  if (std::abs(upward) <= Real(0.5)) return;
  const int lower = upward > 0 ? contact.a : contact.b, upper = upward > 0 ? contact.b : contact.a;
  const Vec2<Real> way = bodies.pose[upper].position - bodies.pose[lower].position;
  if (!dynamic_[upper] || (dynamic_[lower] && !(dot(way, up_) > 0))) return;
  const Real width = dynamic_[lower] ? std::max(width_[lower], width_[upper]) : width_[upper];
  sag_[upper] = std::max(sag_[upper], sag_before_[lower] + depth / width);
}

template <class Real>
bool Watch<Real>::lies_too_deep(PairKey pair, Real depth, Real bound) {
  DeepPair now{pair, 0, 0};
  // Contacts come in the order of their pairs, and so do these.
  const auto before = std::lower_bound(deep_before_.begin(), deep_before_.end(), pair,
                                       [](const DeepPair& deep, PairKey key) { return deep.pair < key; });
  if (before != deep_before_.end() && before->pair == pair) now = *before;
  if (depth <= bound && now.misses == 0) return false;
  const bool said = stays(depth, now.depth, static_cast<double>(bound),
                          bounds::kAtOnce * static_cast<double>(bound), now.misses);
  now.depth = depth;
  if (now.misses > 0) deep_.push_back(now);
  return said;
}

template <class Real>
std::optional<Error> Watch<Real>::look_at_overlaps(const Bodies<Real>& bodies,
                                                   std::span<const Contact<Real>> contacts,
                                                   std::span<const SolidShape<Real>> shapes) {
  deep_.swap(deep_before_);
  deep_.clear();
  sag_.swap(sag_before_);
  std::fill(sag_.begin(), sag_.end(), Real{0});
  for (const Contact<Real>& contact : contacts) {
    if (contact.count == 0) continue;
    Real depth = depth_of(contact);
    if (depth < 0) continue;
    if (!sag_.empty()) note_sag(bodies, contact, depth);
    Real bound = Real(bounds::kOverlap) * width_between(contact, shapes);
    if (!excess_.empty()) bound += std::max(excess_[contact.a], excess_[contact.b]);
    depth += rounding_of(contact, bodies);
    if ((depth > bound || !deep_before_.empty()) && lies_too_deep(contact.pair, depth, bound))
      return broken("body '" + (*names_)[contact.a] + "'", "overlap", depth, bound, " m",
                    "with body '" + (*names_)[contact.b] + "'; it was to stay within");
  }
  return {};
}

template <class Real>
std::optional<Error> Watch<Real>::look_at_sag() {
  for (std::size_t body = 0; body < sag_.size(); ++body) {
    if (!stays(sag_[body], sag_before_[body], bounds::kSag, bounds::kSunk, sag_misses_[body])) continue;
    return broken("body '" + (*names_)[body] + "'", "sag", sag_[body], Real(bounds::kSag), " of the width",
                  "with all that it stands on; it was to stay within");
  }
  return {};
}

template <class Real>
Sway Watch<Real>::sway(std::span<const Contact<Real>> contacts, double h, int sweeps) {
  tallest_ = {}, sway_ = {};
  if (sag_.empty() || contacts.size() < kLeastTower) return sway_;
  tallest_ = towers_.tallest(contacts, dynamic_, width_, up_);
  if (tallest_.levels == 0) return sway_;
  const double fall = gravity_ * h * h / static_cast<double>(tallest_.width);
  sway_ = {.swept = sway_of(tallest_.levels, fall, sweeps),
           .rounded = sway_by_rounding(tallest_.levels, std::numeric_limits<Real>::epsilon())};
  return sway_;
}

template <class Real>
std::optional<Error> Watch<Real>::look_at_towers() {
  if (!lasts(sway_.all() / bounds::kSway, tower_misses_)) return {};
  return broken(
      "body '" + (*names_)[tallest_.top] + "'", "sway", sway_.all(), bounds::kSway, " of its width",
      "is to be expected on a tower of " + std::to_string(tallest_.levels) + "; it was to stay within");
}

template <class Real>
std::optional<Error> Watch<Real>::look_at_energy(const Bodies<Real>& bodies) {
  if (!energy_.active()) return {};
  const double change = energy_.change(bodies);
  const bool sunk = std::any_of(sag_.begin(), sag_.end(), [](Real sag) { return sag > Real(bounds::kSag); });
  if (!excess_.empty() || sunk) energy_.forgive();
  const double wrong = energy_.falls() ? change : std::abs(change);
  const auto broken_by = [&](double bound, const char* promise) {
    return broken("the scene", change > 0 ? "energy gained" : "energy lost", std::abs(change), bound,
                  " of what was in motion", promise);
  };
  drift_misses_ =
      !energy_.falls() && wrong > bounds::kDrift ? std::min(drift_misses_ + 1, bounds::kDriftSteps) : 0;
  if (drift_misses_ >= bounds::kDriftSteps)
    return broken_by(bounds::kDrift, "has gone by degrees; it was to stay within");
  if (!mounts(!(wrong > bounds::kEnergy), bounds::kLasting, energy_misses_) &&
      !(wrong > bounds::kAtOnce * bounds::kEnergy))
    return {};
  return broken_by(bounds::kEnergy, "it was to stay within");
}

template <class Real>
std::optional<Error> Watch<Real>::look(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                                       std::span<const SolidShape<Real>> shapes) {
  if (auto found = look_at_positions(bodies)) return found;
  if (auto found = look_at_joints(bodies)) return found;
  if (auto found = look_at_overlaps(bodies, contacts, shapes)) return found;
  if (auto found = look_at_sag()) return found;
  if (auto found = look_at_towers()) return found;
  if (!excess_.empty()) note_excess(bodies, contacts, shapes);
  return look_at_energy(bodies);
}

template <class Real>
void Watch<Real>::write(SnapshotWriter& out) const {
  out.put(static_cast<std::uint8_t>(anew_));
  for (const WatchedJoint& joint : joints_) out.put(joint.excess), out.put(joint.misses);
  out.put(static_cast<std::uint8_t>(excess_.empty()));
  for (const Real excess : excess_) out.put(excess);
  for (const Real sag : sag_) out.put(sag);
  for (const int misses : sag_misses_) out.put(misses);
  out.put(static_cast<std::uint64_t>(deep_.size()));
  // Field by field: what pads them is not state.
  for (const DeepPair& deep : deep_) out.put(deep.pair), out.put(deep.depth), out.put(deep.misses);
  for (const int misses : {energy_misses_, drift_misses_, tower_misses_}) out.put(misses);
  energy_.write(out);
}

template <class Real>
void Watch<Real>::read(SnapshotReader& in) {
  anew_ = in.get<std::uint8_t>() != 0;
  for (WatchedJoint& joint : joints_) joint.excess = in.get<Real>(), joint.misses = in.get<int>();
  excess_.resize(in.get<std::uint8_t>() != 0 ? 0 : names_->size());
  for (Real& excess : excess_) excess = in.get<Real>();
  for (Real& sag : sag_) sag = in.get<Real>();
  for (int& misses : sag_misses_) misses = in.get<int>();
  deep_.resize(in.count(sizeof(PairKey) + sizeof(Real) + sizeof(int)));
  for (DeepPair& deep : deep_) {
    deep.pair = in.get<PairKey>(), deep.depth = in.get<Real>();
    deep.misses = in.get<int>();
  }
  for (int* const misses : {&energy_misses_, &drift_misses_, &tower_misses_}) *misses = in.get<int>();
  energy_.read(in);
}

template class Watch<float>;
template class Watch<double>;

}  // namespace plumb
