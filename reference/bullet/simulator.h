#pragma once

#include <memory>
#include <string>

#include "engine/scene/scene.h"
#include "reference/simulator.h"

namespace plumb::reference {

/// `StepSettings` with Bullet's options read.
struct BulletSettings {
  int substeps = 1;
  double substep = 0;        ///< s
  int iterations = 10;       ///< sweeps over all constraints a substep
  double joint_erp = 0.2;    ///< share of a joint's gap that a substep corrects
  double contact_erp = 0.2;  ///< share of a penetration that a substep corrects
};

/// `scene` in a btDiscreteDynamicsWorld that is held to the plane z = 0. `engine` is what errors call it.
std::unique_ptr<Simulator> make_bullet_simulator(std::string engine, const Scene& scene,
                                                 const BulletSettings& settings);

}  // namespace plumb::reference
