#include "harness/course/pendulum.h"

#include <cmath>

#include <fmt/format.h>

#include "harness/course/scenes.h"

namespace plumb::course {

std::optional<double> period_of(const std::vector<double>& zeros) {
  if (zeros.size() < 3) return std::nullopt;
  const std::size_t last = zeros.size() - 1 - (zeros.size() - 1) % 2;
  return 2 * (zeros[last] - zeros[0]) / static_cast<double>(last);
}

std::optional<double> stiffness_of_joints(const Lab& lab, bool hinge) {
  constexpr double kGravity = 9.81, kLength = 1;
  const auto sag = [&](double mass) {
    Scene scene = scene_of("weight on a joint", {0, -kGravity},
                           {make(Ball{.position = {0, -kLength}, .mass = mass, .radius = 0.1})});
    if (hinge) {
      RevoluteJoint joint;
      joint.body_a = kWorld;
      joint.body_b = "ball";
      joint.anchor_b = {0, kLength};
      scene.joints.emplace_back(joint);
    } else {
      DistanceJoint joint;
      joint.body_a = kWorld;
      joint.body_b = "ball";
      joint.length = kLength;
      scene.joints.emplace_back(joint);
    }
    const Trace trace = lab.run(scene, 3);
    double sum = 0, count = 0;  // over the last two seconds: a spring swings about its sag
    for (std::size_t k = 0; k < trace.states.size(); ++k)
      if (trace.times[k] > 1) sum += -kLength - trace.states[k][0].position.y, ++count;
    return sum / count;
  };
  // Dampers may carry a part of the weight that does not depend on the mass.
  const double first = sag(1), second = sag(2), more = second - first;
  if (!(more > 1e-4) || !(std::abs(sag(3) - second - more) < 0.05 * more)) return std::nullopt;
  return kGravity / more;
}

std::string spring_text(double stiffness) {
  return fmt::format(
      "Joints give way in proportion to the weight on them, as springs of {:.3g} N/m: a joint is not a stiff "
      "spring. Find the impulse that makes its speed zero, -dC/dt over the effective mass, and correct the "
      "rest in the positions.",
      stiffness);
}

double period_ratio(double amplitude) {
  double a = 1, g = std::cos(amplitude / 2);
  for (int i = 0; i < 6; ++i) {
    const double mean = (a + g) / 2;
    g = std::sqrt(a * g);
    a = mean;
  }
  return 1 / a;
}

}  // namespace plumb::course
