#include "engine/forces/evaluate.h"

#include <variant>

#include "engine/forces/compile.h"
#include "engine/forces/laws.h"
#include "engine/math/trigonometry.h"

namespace plumb {

Wrench<double> evaluate(const ForceLaw& law, const BodyState& state, double t0, double t1) {
  const Pose<double> pose{state.position, rotation_of(state.angle)};
  const Twist<double> twist{state.velocity, state.angular_velocity};
  return std::visit(
      [&](const auto& l) {
        const auto compiled = compile_law<double>(l, 0);
        const Wrench<double> wrench = compiled.wrench(pose, twist);
        if constexpr (requires { compiled.start; }) {
          return active_share(compiled.start, compiled.duration, t0, t1) * wrench;
        } else {
          return wrench;
        }
      },
      law);
}

}  // namespace plumb
