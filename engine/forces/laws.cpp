#include "engine/forces/laws.h"

#include <algorithm>
#include <variant>

#include "engine/forces/compile.h"

namespace plumb {

double active_share(double start, double duration, double t0, double t1) {
  const double end = start + duration;
  if (t0 >= t1) return t0 >= start && t0 < end ? 1 : 0;
  if (start <= t0 && end >= t1) return 1;
  const double overlap = std::min(end, t1) - std::max(start, t0);
  return overlap > 0 ? overlap / (t1 - t0) : 0;
}

template <class Real>
Forces<Real>::Forces(const Scene& scene) : acts_on_(scene.bodies.size(), 0) {
  struct Sorter {
    Forces& to;
    const LawCompiler<Real>& compiler;
    void operator()(const LinearDrag& law) const { to.linear_drags_.push_back(compiler.compile(law)); }
    void operator()(const QuadraticDrag& law) const { to.quadratic_drags_.push_back(compiler.compile(law)); }
    void operator()(const PointForce& law) const { to.point_forces_.push_back(compiler.compile(law)); }
    void operator()(const Torque& law) const { to.torques_.push_back(compiler.compile(law)); }
    void operator()(const SpringForce& law) const { to.springs_.push_back(compiler.compile(law)); }
    void operator()(const AttractionForce& law) const { to.attractions_.push_back(compiler.compile(law)); }
    void operator()(const SinusoidalForce& law) const {
      to.sinusoidal_forces_.push_back(compiler.compile(law));
    }
    void operator()(const FormulaForce& law) const { to.formula_forces_.push_back(compiler.compile(law)); }
    void operator()(const FormulaSpring& law) const { to.formula_springs_.push_back(compiler.compile(law)); }
  };
  const LawCompiler<Real> compiler(scene);
  for (const ForceLaw& law : scene.forces) {
    for (const std::string_view name : ends_of(law)) {
      if (const int body = compiler.end(name); body != kFixedFrame) acts_on_[body] = 1;
    }
    std::visit(Sorter{*this, compiler}, law);
  }
}

template <class Real>
bool Forces<Real>::empty() const {
  return linear_drags_.empty() && quadratic_drags_.empty() && point_forces_.empty() && torques_.empty() &&
         springs_.empty() && attractions_.empty() && sinusoidal_forces_.empty() && formula_forces_.empty() &&
         formula_springs_.empty();
}

template <class Real>
bool Forces<Real>::acts_on(std::size_t body) const {
  return acts_on_[body] != 0;
}

template <class Real>
void Forces<Real>::add_steady(const Pose<Real>* poses, const Twist<Real>* twists, Wrench<Real>* out) const {
  const auto on_one = [&](const auto& laws) {
    for (const auto& law : laws) out[law.body] += law.wrench(poses[law.body], twists[law.body]);
  };
  const Pose<Real> fixed_pose{};
  const Twist<Real> no_motion{};
  const auto on_two = [&](const auto& laws) {
    for (const auto& law : laws) {
      const bool has_a = law.a != kFixedFrame, has_b = law.b != kFixedFrame;
      const auto [on_a, on_b] =
          law.wrenches(has_a ? poses[law.a] : fixed_pose, has_a ? twists[law.a] : no_motion,
                       has_b ? poses[law.b] : fixed_pose, has_b ? twists[law.b] : no_motion);
      if (has_a) out[law.a] += on_a;
      if (has_b) out[law.b] += on_b;
    }
  };
  on_one(linear_drags_);
  on_one(quadratic_drags_);
  on_two(springs_);
  on_two(attractions_);
}

template <class Real>
void Forces<Real>::add_switched(double t0, double t1, const Pose<Real>* poses, const Twist<Real>* twists,
                                Wrench<Real>* out) const {
  const auto switched = [&](const auto& laws) {
    for (const auto& law : laws) {
      const double share = active_share(law.start, law.duration, t0, t1);
      if (share == 0) continue;
      out[law.body] += static_cast<Real>(share) * law.wrench(poses[law.body], twists[law.body]);
    }
  };
  switched(point_forces_);
  switched(torques_);
}

template <class Real>
void Forces<Real>::add_swinging(double t0, double t1, const Pose<Real>* poses, const Twist<Real>* twists,
                                Wrench<Real>* out) const {
  for (const auto& law : sinusoidal_forces_) {
    const Real share = static_cast<Real>(law.mean_sine(t0, t1));
    out[law.body] += share * law.wrench(poses[law.body], twists[law.body]);
  }
}

template <class Real>
void Forces<Real>::add_formulas(double time, const Pose<Real>* poses, const Twist<Real>* twists,
                                Wrench<Real>* out) const {
  const auto pose = [&](int body) -> Pose<double> {
    if (body == kFixedFrame) return {};
    const Pose<Real>& p = poses[body];
    return {p.position.template as<double>(),
            {static_cast<double>(p.rotation.c), static_cast<double>(p.rotation.s)}};
  };
  const auto twist = [&](int body) -> Twist<double> {
    if (body == kFixedFrame) return {};
    return {twists[body].velocity.template as<double>(), static_cast<double>(twists[body].angular_velocity)};
  };
  const auto add = [&](int body, const Wrench<double>& wrench) {
    if (body != kFixedFrame)
      out[body] += Wrench<Real>{wrench.force.template as<Real>(), static_cast<Real>(wrench.torque)};
  };
  for (const FormulaForceLaw& law : formula_forces_) {
    const int body = static_cast<int>(law.body);
    add(body, law.wrench(time, pose(body), twist(body)));
  }
  for (const FormulaSpringLaw& law : formula_springs_) {
    const auto [on_a, on_b] = law.wrenches(time, pose(law.a), twist(law.a), pose(law.b), twist(law.b));
    add(law.a, on_a);
    add(law.b, on_b);
  }
}

template <class Real>
void Forces<Real>::add(double t0, double t1, const Pose<Real>* poses, const Twist<Real>* twists,
                       Wrench<Real>* out) const {
  add_steady(poses, twists, out);
  add_switched(t0, t1, poses, twists, out);
  add_swinging(t0, t1, poses, twists, out);
  add_formulas(0.5 * (t0 + t1), poses, twists, out);
}

template <class Real>
void Forces<Real>::add_at(double time, double t0, double t1, const Pose<Real>* poses,
                          const Twist<Real>* twists, Wrench<Real>* out) const {
  add_steady(poses, twists, out);
  add_switched(t0, t1, poses, twists, out);
  add_swinging(time, time, poses, twists, out);
  add_formulas(time, poses, twists, out);
}

template class Forces<float>;
template class Forces<double>;

}  // namespace plumb
