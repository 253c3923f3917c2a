#pragma once

#include <memory>

#include "engine/scene/scene.h"
#include "reference/simulator.h"

namespace plumb::reference {

/// `StepSettings` with Bullet's options read.
struct BulletSettings {
  int substeps = 1;
  double substep = 0;        ///< s
  int iterations = 10;       ///< iterations over all constraints per substep
  double joint_erp = 0.2;    ///< fraction of a joint's gap that a substep corrects
  double contact_erp = 0.2;  ///< fraction of a penetration that a substep corrects
  bool speculative = false;  ///< contacts act before shapes touch
};

/// Creates `scene` in a btDiscreteDynamicsWorld that is constrained to the plane z = 0.
std::unique_ptr<Simulator> make_bullet_simulator(const Scene& scene, const BulletSettings& settings);

}  // namespace plumb::reference
