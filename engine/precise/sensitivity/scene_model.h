#pragma once

#include <span>

#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/dynamics/scene_partition.h"
#include "engine/precise/events/contacts.h"
#include "engine/precise/integration/integrator.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// The laws of motion of one scene, with contact modes that are taken over from a run of another scene of the
/// same structure. As long as these modes are frozen, the laws are smooth functions of time and state.
struct SceneModel {
  SceneModel(const Scene& scene, const Precise& precise)
      : partition(partition_scene(scene)),
        ballistic(scene, partition),
        equations(scene, partition, ballistic, false, precise.tolerance),
        integrator(scene, partition, precise, equations),
        contacts(scene, partition, ballistic, equations, integrator),
        start(integrator.state()) {}
  SceneModel(const SceneModel&) = delete;
  SceneModel& operator=(const SceneModel&) = delete;

  void set_window(double time) { equations.set_window(time, time); }

  /// Closes the joints of a state and of its velocities, as at the start of a run.
  void close_joints(double time, Compensated& y) {
    equations.apply_hinge_impulses(time, y);
    equations.project(time, y);
  }

  ScenePartition partition;
  BallisticMotion ballistic;
  EquationsOfMotion equations;
  EventFreeIntegrator integrator;  // of the contacts; makes no steps
  Contacts contacts;
  Compensated start;  // the state of the integrated bodies at the start, joints not closed
};

}  // namespace plumb::precise
