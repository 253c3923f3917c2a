#pragma once

#include <string>
#include <vector>

#include "app/trajectory_writer.h"
#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace plumb::app {

/// Prints the derivatives of all states by parameters at a run's samples. A parameter without a derivative is
/// left out from then on, with a notice that says why.
/// - Csv: t,parameter,body,x,y,angle,vx,vy,w: one line per parameter, body and sample;
/// - Json: one line per sample: {"t":..,"parameters":[{"name","bodies":[{"name","x",...,"w"}]}]}.
class SensitivityWriter {
 public:
  SensitivityWriter(const Scene& scene, std::vector<std::string> parameters, TrajectoryWriter::Format format);
  void write(const Simulation& run);

 private:
  const Scene& scene_;
  std::vector<std::string> parameters_;
  std::vector<char> ended_;  // by parameter: its end was announced
  TrajectoryWriter::Format format_;
};

}  // namespace plumb::app
