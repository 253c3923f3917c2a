#include "engine/forces/laws.h"

#include <algorithm>
#include <map>
#include <string_view>
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
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) index.emplace(scene.bodies[i].name, i);

  struct Sorter {
    Forces& forces;
    std::size_t body;
    void operator()(const LinearDrag& law) const {
      forces.linear_drags_.push_back(compile_law<Real>(law, body));
    }
    void operator()(const QuadraticDrag& law) const {
      forces.quadratic_drags_.push_back(compile_law<Real>(law, body));
    }
    void operator()(const PointForce& law) const {
      forces.point_forces_.push_back(compile_law<Real>(law, body));
    }
    void operator()(const Torque& law) const { forces.torques_.push_back(compile_law<Real>(law, body)); }
  };
  for (const ForceLaw& law : scene.forces) {
    const std::size_t body =
        index.at(std::visit([](const auto& l) -> std::string_view { return l.body; }, law));
    acts_on_[body] = 1;
    std::visit(Sorter{*this, body}, law);
  }
}

template <class Real>
bool Forces<Real>::empty() const {
  return linear_drags_.empty() && quadratic_drags_.empty() && point_forces_.empty() && torques_.empty();
}

template <class Real>
bool Forces<Real>::acts_on(std::size_t body) const {
  return acts_on_[body] != 0;
}

template <class Real>
void Forces<Real>::add(double t0, double t1, const Pose<Real>* poses, const Twist<Real>* twists,
                       Wrench<Real>* out) const {
  const auto steady = [&](const auto& laws) {
    for (const auto& law : laws) out[law.body] += law.wrench(poses[law.body], twists[law.body]);
  };
  const auto switched = [&](const auto& laws) {
    for (const auto& law : laws) {
      const double share = active_share(law.start, law.duration, t0, t1);
      if (share == 0) continue;
      out[law.body] += static_cast<Real>(share) * law.wrench(poses[law.body], twists[law.body]);
    }
  };
  steady(linear_drags_);
  steady(quadratic_drags_);
  switched(point_forces_);
  switched(torques_);
}

template class Forces<float>;
template class Forces<double>;

}  // namespace plumb
