#include "engine/realtime/watch_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "engine/forces/compile.h"
#include "engine/realtime/watch_bounds.h"

namespace plumb {
namespace {

/// Free flight is exact, as long as positions are fine enough: those of float are looked at.
template <class Real>
constexpr bool kFlightIsWatched = std::is_same_v<Real, float>;

bool is_moved(const Body& body) { return body.type == BodyType::Kinematic; }

template <class Real>
Pose<double> pose_of(const Bodies<Real>& bodies, int body) {
  if (body == kFixedFrame) return {};
  const Pose<Real>& pose = bodies.pose[body];
  return {pose.position.template as<double>(),
          {static_cast<double>(pose.rotation.c), static_cast<double>(pose.rotation.s)}};
}

}  // namespace

template <class Real>
EnergyWatch<Real>::EnergyWatch(const Scene& scene, const Bodies<Real>& bodies, bool contacts)
    : active_(contacts || !scene.joints.empty() || !scene.forces.empty() || kFlightIsWatched<Real>),
      falls_(contacts),
      tied_(!scene.joints.empty() || !scene.forces.empty() || contacts),
      jointed_(!scene.joints.empty()),
      gravity_(scene.gravity) {
  if (!scene.forces.empty()) note_laws(scene);
  active_ = active_ && std::none_of(scene.bodies.begin(), scene.bodies.end(), is_moved);
  if (!active_) return;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const Body& mover = scene.bodies[body];
    if (mover.type != BodyType::Dynamic) continue;
    double reach = 0;
    for (const Shape& shape : mover.shapes) reach = std::max(reach, reach_of(shape.geometry));
    movers_.push_back({static_cast<int>(body), mover.mass, inertia_of(mover), reach, Vec2d{}});
    if (falls_) standing_ += mover.mass * std::sqrt(length_squared(gravity_)) * reach;
  }
}

template <class Real>
void EnergyWatch<Real>::note_laws(const Scene& scene) {
  const LawCompiler<double> compiler(scene);
  const auto note = [&](const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    if constexpr (std::is_same_v<Law, SpringForce>) {
      springs_.push_back(compiler.compile(law));
      falls_ = falls_ || law.damping > 0;
    } else if constexpr (std::is_same_v<Law, AttractionForce>) {
      attractions_.push_back(compiler.compile(law));
    } else if constexpr (std::is_same_v<Law, LinearDrag> || std::is_same_v<Law, QuadraticDrag>) {
      falls_ = true;
    } else {
      active_ = false;
    }
  };
  for (const ForceLaw& law : scene.forces) std::visit(note, law);
}

template <class Real>
double EnergyWatch<Real>::kinetic(const Bodies<Real>& bodies) const {
  double twice = 0;
  for (const Mover& mover : movers_) {
    const Twist<Real>& twist = bodies.twist[mover.body];
    const double spin = static_cast<double>(twist.angular_velocity);
    twice += mover.mass * length_squared(twist.velocity.template as<double>()) + mover.inertia * spin * spin;
  }
  return twice / 2;
}

/// Of gravity from where bodies started: far from the origin nothing is lost in the sum.
template <class Real>
double EnergyWatch<Real>::potential(const Bodies<Real>& bodies) const {
  double sum = 0;
  for (const Mover& mover : movers_)
    sum -= mover.mass * dot(gravity_, bodies.pose[mover.body].position.template as<double>() - mover.start);
  for (const auto& spring : springs_)
    sum += spring.energy(pose_of(bodies, spring.a), pose_of(bodies, spring.b));
  for (const auto& pull : attractions_) sum += pull.energy(pose_of(bodies, pull.a), pose_of(bodies, pull.b));
  return sum;
}

template <class Real>
void EnergyWatch<Real>::begin(const Bodies<Real>& bodies) {
  if (!active_) return;
  const double g = std::sqrt(length_squared(gravity_));
  const double share = bounds::kRoundings * static_cast<double>(std::numeric_limits<Real>::epsilon());
  rounding_ = 0;
  for (Mover& mover : movers_) {
    mover.start = bodies.pose[mover.body].position.template as<double>();
    // Without joints, forces and contacts only the reach counts: nothing else detects rounding far away.
    const double way = mover.reach + (tied_ ? std::sqrt(length_squared(mover.start)) : 0);
    rounding_ += share * mover.mass * g * way;
  }
  moving_ = kinetic(bodies);
  // Stored energies are rounded too, as of springs that pull against each other.
  double stored = moving_;
  for (const auto& spring : springs_)
    stored += std::abs(spring.energy(pose_of(bodies, spring.a), pose_of(bodies, spring.b)));
  for (const auto& pull : attractions_)
    stored += std::abs(pull.energy(pose_of(bodies, pull.a), pose_of(bodies, pull.b)));
  rounding_ += share * stored;
  start_ = least_ = last_ = moving_ + potential(bodies);
  fresh_ = true;
}

template <class Real>
double EnergyWatch<Real>::change(const Bodies<Real>& bodies) {
  const double moving = kinetic(bodies);
  last_ = moving + potential(bodies);
  moving_ = std::max(moving_, moving);
  // Velocities that do not fit the joints are made to, which takes energy, and no fault of the method.
  if (fresh_ && jointed_ && last_ < start_) start_ = last_, moving_ = moving;
  fresh_ = false;
  double gained = last_ - (falls_ ? least_ : start_);
  // Bodies that have sunk within the bound may rise again; twice the reach is no less than the width.
  if (gained > 0) gained = std::max(gained - 2 * bounds::kSag * standing_, 0.0);
  least_ = std::min(least_, last_);
  if (!(std::abs(gained) > rounding_)) return 0;
  return gained / (moving_ + standing_);
}

template <class Real>
void EnergyWatch<Real>::write(SnapshotWriter& out) const {
  if (!active_) return;
  for (const Mover& mover : movers_) out.put(mover.start);
  for (const double value : {start_, least_, last_, moving_, rounding_}) out.put(value);
  out.put(static_cast<std::uint8_t>(fresh_));
}

template <class Real>
void EnergyWatch<Real>::read(SnapshotReader& in) {
  if (!active_) return;
  for (Mover& mover : movers_) mover.start = in.get<Vec2d>();
  for (double* const value : {&start_, &least_, &last_, &moving_, &rounding_}) *value = in.get<double>();
  fresh_ = in.get<std::uint8_t>() != 0;
}

template class EnergyWatch<float>;
template class EnergyWatch<double>;

}  // namespace plumb
