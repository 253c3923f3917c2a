#include "engine/forces/potential.h"

#include <variant>

#include "engine/forces/compile.h"
#include "engine/math/trigonometry.h"

namespace plumb {

double potential_energy(const Scene& scene, std::span<const BodyState> states) {
  if (scene.forces.empty()) return 0;
  const LawCompiler compiler(scene);
  const auto pose = [&](int body) -> Pose<double> {
    if (body == kFixedFrame) return {};
    const BodyState& state = states[static_cast<std::size_t>(body)];
    return {state.position, rotation_of(state.angle)};
  };
  double sum = 0;
  for (const ForceLaw& law : scene.forces) {
    sum += std::visit(
        [&](const auto& l) -> double {
          const auto compiled = compiler.compile(l);
          if constexpr (requires { compiled.energy(pose(0), pose(0)); }) {
            return compiled.energy(pose(compiled.a), pose(compiled.b));
          } else {
            return 0;
          }
        },
        law);
  }
  return sum;
}

}  // namespace plumb
