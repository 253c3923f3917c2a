#include "engine/realtime/realtime.h"

#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/realtime/direct_joints.h"
#include "engine/realtime/iterative_joints.h"
#include "engine/realtime/substeps.h"
#include "engine/realtime/watch_bounds.h"
#include "engine/scene/error.h"
#include "engine/scene/features.h"

namespace plumb {
namespace {

template <class Real>
Bodies<Real> compile_bodies(const Scene& scene) {
  Bodies<Real> out;
  for (const Body& body : scene.bodies) {
    const bool dynamic = body.type == BodyType::Dynamic;
    const double inertia = dynamic && !body.fixed_rotation ? inertia_of(body) : 0;
    out.inverse_mass.push_back(static_cast<Real>(dynamic ? 1 / body.mass : 0));
    out.inverse_inertia.push_back(static_cast<Real>(inertia > 0 ? 1 / inertia : 0));
  }
  out.pose.resize(scene.bodies.size());
  out.angle.resize(scene.bodies.size());
  out.twist.resize(scene.bodies.size());
  out.acceleration.resize(scene.bodies.size());
  return out;
}

template <class Real>
ContactSettings<Real> contact_settings(const Scene& scene, const Realtime& accuracy, const Plan& plan) {
  return {is_active(plan, RealtimeStage::Friction), accuracy.integrator == Integrator::VelocityVerlet,
          std::sqrt(length_squared(scene.gravity.as<Real>())),
          static_cast<Real>(scene.contact_rules.restitution_threshold)};
}

}  // namespace

template <class Real>
RealtimeDriver<Real>::RealtimeDriver(const Scene& scene, const Realtime& accuracy, bool every_stage)
    : accuracy_(accuracy),
      plan_(plan_realtime(scene, accuracy, every_stage)),
      bodies_(compile_bodies<Real>(scene)),
      gravity_(scene.gravity.as<Real>()),
      forces_(scene),
      contact_solver_(contact_settings<Real>(scene, accuracy, plan_)) {
  accuracy_.substeps = asked_substeps_ = plan_.substeps;
  for (const Body& body : scene.bodies) {
    names_.push_back(body.name);
    dynamic_.push_back(body.type == BodyType::Dynamic);
    fixed_rotation_.push_back(body.type == BodyType::Static || body.fixed_rotation);
  }
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    set_motion(body, initial_state(scene.bodies[body]));
    if (dynamic_[body]) bodies_.acceleration[body].velocity = gravity_;
  }
  remainder_.resize(bodies_.size());
  last_remainder_ = remainder_;
  last_pose_ = bodies_.pose;
  last_angle_ = bodies_.angle;
  last_twist_ = bodies_.twist;
  if (is_active(plan_, Forces)) wrenches_.resize(bodies_.size()), predicted_.resize(bodies_.size());
  if (contacts_active()) finder_ = std::make_unique<ContactFinder<Real>>(scene, bodies_);
  if (is_active(plan_, Restitution)) impacts_ = std::make_unique<ImpactStage<Real>>();
  // The Euler schemes promise nothing.
  if (is_active(plan_, Watch) && accuracy.integrator == Integrator::VelocityVerlet)
    watch_ = std::make_unique<plumb::Watch<Real>>(scene, names_, bodies_, contacts_active());
  Real lightest = 0, heaviest = std::numeric_limits<Real>::max();  // 1/kg
  for (const Real inverse : bodies_.inverse_mass)
    if (inverse > 0) lightest = std::max(lightest, inverse), heaviest = std::min(heaviest, inverse);
  masses_differ_ = contacts_active() && lightest > Real(constants::kHeavyLoad) * heaviest;
  if (!joints_active()) return;
  joint_count_ = static_cast<int>(scene.joints.size());
  if (accuracy.joint_solver == JointSolver::Direct) {
    joints_ = std::make_unique<DirectJoints<Real>>(scene, bodies_);
  } else {
    joints_ = std::make_unique<IterativeJoints<Real>>(scene, bodies_);
  }
}

template <class Real>
void RealtimeDriver<Real>::step() {
  last_pose_ = bodies_.pose, last_angle_ = bodies_.angle, last_twist_ = bodies_.twist;
  last_remainder_ = remainder_;
  detect(static_cast<Real>(accuracy_.dt));
  if (watch_) {
    if (watch_->starts_anew()) watch_->begin(bodies_, contacts_, shapes());
    plan_for_towers();
  }
  sweeps_ = sweeps_a_pass();
  if (impacts_) impacts_->begin_step(contacts_);
  const double h = accuracy_.dt / accuracy_.substeps;
  const double start = time();
  for (int substep = 0; substep < accuracy_.substeps; ++substep) {
    const double t = start + substep * h;
    switch (accuracy_.integrator) {
      case Integrator::VelocityVerlet:
        velocity_verlet(t, static_cast<Real>(h));
        break;
      case Integrator::SemiImplicitEuler:
        semi_implicit_euler(t, static_cast<Real>(h));
        break;
      case Integrator::ExplicitEuler:
        explicit_euler(t, static_cast<Real>(h));
        break;
    }
  }
  stage(Check, [&] { check(); });
  stage(Watch, [&] { watch(); });
  ++step_;
  statistics_.steps += accuracy_.substeps;
}

/// More substeps where a tower stands that the sweeps of those asked for do not hold straight.
template <class Real>
void RealtimeDriver<Real>::plan_for_towers() {
  const auto sway = [&] {
    return watch_->sway(contacts_, accuracy_.dt / accuracy_.substeps, accuracy_.iterations);
  };
  const Sway now = sway();
  const double room = bounds::kSway - now.rounded;  // for what the sweeps leave
  if (now.all() <= bounds::kSway || room <= 0) return;
  // It falls with h^2.
  const double steady = room * (bounds::kSteadySway / bounds::kSway);
  const double needed = std::ceil(std::sqrt(now.swept / steady) * accuracy_.substeps);
  if (needed > std::min(bounds::kMostForTowers * asked_substeps_, double{kMostSubsteps})) return;
  accuracy_.substeps = plan_.substeps = static_cast<int>(needed);
  plan_.substeps_why = "a tower stands that fewer would let sway";
  sway();
}

/// Those asked for; more in the first step, which has no impulses to start from, and where loads need them.
template <class Real>
int RealtimeDriver<Real>::sweeps_a_pass() const {
  const double share = std::min(1.0, double{constants::kFullSubsteps} / accuracy_.substeps);
  const double cold = step_ == 0 ? share * constants::kColdSweeps : 1;
  const double loads = masses_differ_ ? share * sweeps_for_loads() : 0;
  const double most = std::numeric_limits<int>::max();
  return std::max(accuracy_.iterations,
                  static_cast<int>(std::clamp(cold * accuracy_.iterations, loads, most)));
}

/// A sweep leaves R / (R + 1) of the error of a load that rests on something R times lighter (the two
/// contacts' a12^2 / (a11 a22)): R sweeps a pass take it to 1/e, and what is left the next substeps' do.
template <class Real>
int RealtimeDriver<Real>::sweeps_for_loads() const {
  Real most = 0;
  int touching = 0;
  for (const Contact<Real>& contact : contacts_) {
    if (contact.count == 0) continue;
    ++touching;
    const bool b_above = dot(contact.normal, gravity_) < 0;
    const Real below = b_above ? contact.inverse_mass_a : contact.inverse_mass_b;
    const Real above = b_above ? contact.inverse_mass_b : contact.inverse_mass_a;
    if (above > 0 && below > Real(constants::kHeavyLoad) * above) most = std::max(most, below / above);
  }
  if (most == 0) return 0;
  return static_cast<int>(
      std::min(most, static_cast<Real>(constants::kLoadWork / (touching + joint_count_))));
}

template <class Real>
void RealtimeDriver<Real>::detect(Real dt) {
  stage(BroadPhase,
        [&] { contacts_changed_ = finder_->find_pairs(bodies_, dt, contacts_) || contacts_changed_; });
  stage(NarrowPhase, [&] { finder_->find_points(bodies_, dt, contacts_); });
}

/// a = g + F/m, alpha = torque/I.
template <class Real>
void RealtimeDriver<Real>::evaluate_forces(double t0, double t1, const std::vector<Twist<Real>>& twists) {
  std::fill(wrenches_.begin(), wrenches_.end(), Wrench<Real>{});
  forces_.add(t0, t1, bodies_.pose.data(), twists.data(), wrenches_.data());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (!dynamic_[body]) continue;
    bodies_.acceleration[body] = {gravity_ + bodies_.inverse_mass[body] * wrenches_[body].force,
                                  bodies_.inverse_inertia[body] * wrenches_[body].torque};
  }
  ++statistics_.evaluations;
}

template <class Real>
void RealtimeDriver<Real>::predict_velocities(Real duration) {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Twist<Real>& twist = bodies_.twist[body];
    const Twist<Real>& acceleration = bodies_.acceleration[body];
    predicted_[body] = {twist.velocity + duration * acceleration.velocity,
                        twist.angular_velocity + duration * acceleration.angular_velocity};
  }
}

template <class Real>
void RealtimeDriver<Real>::kick(Real duration) {
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    bodies_.twist[body].velocity += duration * bodies_.acceleration[body].velocity;
  if (!is_active(plan_, Turn)) return;
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    bodies_.twist[body].angular_velocity += duration * bodies_.acceleration[body].angular_velocity;
}

template <class Real>
void RealtimeDriver<Real>::drift(Real h) {
  stage(Drift, [&] {
    // Kahan compensation (1965): carries rounding errors to the next sum; far from the origin they would add
    // up.
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      const Vec2<Real> before = bodies_.pose[body].position;
      const Vec2<Real> way = h * bodies_.twist[body].velocity + remainder_[body];
      bodies_.pose[body].position = before + way;
      remainder_[body] = way - (bodies_.pose[body].position - before);
    }
  });
  stage(Turn, [&] {
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      const Real turn = h * bodies_.twist[body].angular_velocity;
      if (turn == 0) continue;
      bodies_.angle[body] += turn;
      bodies_.pose[body].rotation = rotation_of(bodies_.angle[body]);
    }
  });
}

template <class Real>
void RealtimeDriver<Real>::resolve_impacts(Real h) {
  if (contacts_changed_) impacts_->index(contacts_, bodies_.size());
  contacts_changed_ = false;
  // A body that an impact has sped up may reach others in any of the substeps until the next detection.
  const auto found = [&](int body, Real) {
    return finder_->extend(body, bodies_, static_cast<Real>(accuracy_.dt), contacts_);
  };
  statistics_.impacts +=
      impacts_->resolve(contacts_, finder_->shapes(), bodies_, contact_solver_, joints_.get(), h, found);
}

/// Impulses before the bodies move: contacts and joints in turn, joints last.
template <class Real>
void RealtimeDriver<Real>::hold(Real h) {
  stage(JointHold, [&] { joints_->begin_hold(bodies_, h); });
  stage(ContactHold, [&] { contact_solver_.begin_hold(contacts_, finder_->shapes(), bodies_, h); });
  const bool touching = contacts_active() && !contact_solver_.idle();
  const bool iterated = joints_active() && (touching || accuracy_.joint_solver == JointSolver::Iterative);
  for (int i = 0; i < sweeps_ && (touching || iterated); ++i) {
    stage(ContactHold, [&] { contact_solver_.sweep_hold(contacts_, bodies_); });
    if (iterated) stage(JointHold, [&] { joints_->sweep_hold(bodies_, h); });
  }
  stage(JointHold, [&] { joints_->finish_hold(bodies_, h); });
}

template <class Real>
void RealtimeDriver<Real>::push_out(Real h) {
  stage(PushOut, [&] {
    const bool pushed = contact_solver_.push_out(contacts_, finder_->shapes(), bodies_, h);
    const bool rigid =
        accuracy_.integrator == Integrator::VelocityVerlet;  // the Euler steppers have their feedback
    if (pushed && joints_ && rigid) joints_->settle(bodies_);
  });
}

/// Impulses after the bodies have moved, that make velocities fit the new positions.
template <class Real>
void RealtimeDriver<Real>::relax(Real h) {
  stage(JointRelax, [&] { joints_->begin_relax(bodies_); });
  stage(ContactRelax, [&] { contact_solver_.begin_relax(contacts_, finder_->shapes(), bodies_, h); });
  const bool touching = contacts_active() && !contact_solver_.idle();
  const int rounds = touching || accuracy_.joint_solver == JointSolver::Iterative ? sweeps_ : 1;
  for (int i = 0; i < rounds; ++i) {
    if (touching) stage(ContactRelax, [&] { contact_solver_.sweep_relax(contacts_, bodies_); });
    stage(JointRelax, [&] { joints_->sweep_relax(bodies_); });
  }
}

/// The Euler steppers' impulses: one pass on velocities with feedback of gaps and overlaps.
template <class Real>
void RealtimeDriver<Real>::collide(Real h) {
  stage(JointHold, [&] { joints_->begin_follow(bodies_, h); });
  stage(ContactHold, [&] {
    contact_solver_.begin_collide(contacts_, finder_->shapes(), bodies_, h, is_active(plan_, Restitution));
  });
  for (int i = 0; i < sweeps_; ++i) {
    stage(ContactHold, [&] { contact_solver_.sweep_hold(contacts_, bodies_); });
    stage(JointHold, [&] { joints_->sweep_follow(bodies_); });
  }
}

template <class Real>
void RealtimeDriver<Real>::profile(bool on) {
  if (on && !profiling_)
    for (Stage& entry : plan_.stages) entry.nanoseconds = 0;
  profiling_ = on;
}

template class RealtimeDriver<float>;
template class RealtimeDriver<double>;

std::string realtime_unsupported(const Scene& scene, const Realtime& accuracy) {
  if (const std::string feature = unusual_feature(scene); !feature.empty())
    return feature + ", which Realtime does not have; 'plumb-world' runs it";
  const SubstepPlan substeps = plan_substeps(scene, accuracy, false);
  if (substeps.count > std::max(kMostNeeded, accuracy.substeps))
    return substeps.why +
           ", too fast for fixed steps of this dt; 'plumb-world' and 'plumb-precise' may run it";
  if (accuracy.precision != Precision::Float) return "";
  constexpr double kMost = std::numeric_limits<float>::max(), kLeast = std::numeric_limits<float>::min();
  const auto fits = [](double value) {
    return value == 0 || (std::abs(value) <= kMost && std::abs(value) >= kLeast);
  };
  for (const Body& body : scene.bodies) {
    const double inertia = body.type == BodyType::Dynamic ? inertia_of(body) : 0;
    const bool moves = body.type == BodyType::Dynamic;
    if (std::abs(body.position.x) > kMost || std::abs(body.position.y) > kMost ||
        std::abs(body.velocity.x) > kMost || std::abs(body.velocity.y) > kMost ||
        std::abs(body.angular_velocity) > kMost || (moves && !fits(1 / body.mass)) ||
        (inertia > 0 && !fits(1 / inertia)))
      return "body '" + body.name + "' has values beyond the range of float";
  }
  return "";
}

}  // namespace plumb
