#pragma once

#include "app/trajectory_writer.h"
#include "engine/driver/driver.h"
#include "engine/scene/scene.h"

namespace plumb::app {

/// Prints the forces of joints and contacts at a run's samples: the force on body b, at a point in the
/// world's frame; a joint's torque is about that point.
/// - Csv: t,kind,joint,body_a,body_b,x,y,fx,fy,torque: one line per joint and one per contact point;
/// - Json: one line per sample: {"t":..,"joints":[{"name","x","y","fx","fy","torque"}],
///   "contacts":[{"body_a","body_b","x","y","fx","fy"}]}.
class ForceWriter {
 public:
  ForceWriter(const Scene& scene, TrajectoryWriter::Format format);
  void write(double time, const Reactions& forces) const;

 private:
  void write_csv(double time, const Reactions& forces) const;
  void write_json(double time, const Reactions& forces) const;

  const Scene& scene_;
  TrajectoryWriter::Format format_;
};

}  // namespace plumb::app
