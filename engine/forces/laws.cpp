#include "engine/forces/laws.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "engine/forces/compile.h"

namespace plumb {
namespace {

Pose<double> pose_of(const Pose<double>* poses, int body) {
  return body == kFixedFrame ? Pose<double>{} : poses[body];
}

Twist<double> twist_of(const Twist<double>* twists, int body) {
  return body == kFixedFrame ? Twist<double>{} : twists[body];
}

void add_to_two(const auto& law, Wrench<double>* out,
                const std::pair<Wrench<double>, Wrench<double>>& wrenches) {
  if (law.a != kFixedFrame) out[law.a] += wrenches.first;
  if (law.b != kFixedFrame) out[law.b] += wrenches.second;
}

}  // namespace

double active_fraction(double start, double duration, double t0, double t1) {
  const double end = start + duration;
  if (t0 >= t1) return t0 >= start && t0 < end ? 1 : 0;
  if (start <= t0 && end >= t1) return 1;
  const double overlap = std::min(end, t1) - std::max(start, t0);
  return overlap > 0 ? overlap / (t1 - t0) : 0;
}

Forces::Forces(const Scene& scene, bool (*wanted)(const ForceLaw&)) : acts_on_(scene.bodies.size(), 0) {
  const LawCompiler compiler(scene);
  for (const ForceLaw& law : scene.forces) {
    if (!wanted(law)) continue;
    for (const std::string_view name : ends_of(law)) {
      if (const int body = compiler.body_index(name); body != kFixedFrame) acts_on_[body] = 1;
    }
    std::visit(
        [&](const auto& l) {
          using Law = decltype(compiler.compile(l));
          std::get<std::vector<Law>>(laws_).push_back(compiler.compile(l));
        },
        law);
  }
}

bool Forces::empty() const {
  return std::apply([](const auto&... laws) { return (laws.empty() && ...); }, laws_);
}

bool Forces::acts_on(std::size_t body) const { return acts_on_[body] != 0; }

void Forces::add_time_independent(const Pose<double>* poses, const Twist<double>* twists,
                                  Wrench<double>* out) const {
  const auto on_one = [&](const auto& laws) {
    for (const auto& law : laws) out[law.body] += law.wrench(poses[law.body], twists[law.body]);
  };
  const auto on_two = [&](const auto& laws) {
    for (const auto& law : laws) {
      add_to_two(law, out,
                 law.wrenches(pose_of(poses, law.a), twist_of(twists, law.a), pose_of(poses, law.b),
                              twist_of(twists, law.b)));
    }
  };
  on_one(all<LinearDragLaw>());
  on_one(all<QuadraticDragLaw>());
  on_two(all<SpringForceLaw>());
  on_two(all<AttractionForceLaw>());
}

void Forces::add_switched(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                          Wrench<double>* out) const {
  const auto switched = [&](const auto& laws) {
    for (const auto& law : laws) {
      const double fraction = active_fraction(law.start, law.duration, t0, t1);
      if (fraction == 0) continue;
      out[law.body] += fraction * law.wrench(poses[law.body], twists[law.body]);
    }
  };
  switched(all<PointForceLaw>());
  switched(all<TorqueLaw>());
}

void Forces::add_sinusoidal(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                            Wrench<double>* out) const {
  for (const auto& law : all<SinusoidalForceLaw>()) {
    const double fraction = law.mean_sine(t0, t1);
    out[law.body] += fraction * law.wrench(poses[law.body], twists[law.body]);
  }
}

void Forces::add_formulas(double time, const Pose<double>* poses, const Twist<double>* twists,
                          Wrench<double>* out) const {
  for (const auto& law : all<FormulaForceLaw>())
    out[law.body] += law.wrench(time, poses[law.body], twists[law.body]);
  for (const auto& law : all<FormulaSpringLaw>()) {
    add_to_two(law, out,
               law.wrenches(time, pose_of(poses, law.a), twist_of(twists, law.a), pose_of(poses, law.b),
                            twist_of(twists, law.b)));
  }
}

void Forces::add(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                 Wrench<double>* out) const {
  add_time_independent(poses, twists, out);
  add_switched(t0, t1, poses, twists, out);
  add_sinusoidal(t0, t1, poses, twists, out);
  add_formulas(0.5 * (t0 + t1), poses, twists, out);
}

void Forces::add_at(double time, double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                    Wrench<double>* out) const {
  add_time_independent(poses, twists, out);
  add_switched(t0, t1, poses, twists, out);
  add_sinusoidal(time, time, poses, twists, out);
  add_formulas(time, poses, twists, out);
}

}  // namespace plumb
