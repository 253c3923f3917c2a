#pragma once

#include "app/trajectory_writer.h"
#include "engine/scene/scene.h"
#include "engine/simulation/driver.h"

namespace plumb::app {

/// Prints the forces of joints and contacts of a run's samples: what acts on body b, at a point in the
/// world's frame; a joint's torque is about that point.
/// - Csv: t,kind,joint,body_a,body_b,x,y,fx,fy,torque: a line a joint and a line a point of contact;
/// - Json: a line a sample: {"t":..,"joints":[{"name","x","y","fx","fy","torque"}],
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
