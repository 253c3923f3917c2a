#include "reference/support/applied_forces.h"

namespace plumb::reference {

std::vector<AppliedForce> applied_forces(const Scene& scene) {
  std::vector<AppliedForce> out;
  for (const ForceLaw& law : scene.forces) {
    const std::string& name = std::visit([](const auto& l) -> const std::string& { return l.body; }, law);
    if (const auto body = find_body(scene, name)) out.push_back({*body, law});
  }
  return out;
}

}  // namespace plumb::reference
