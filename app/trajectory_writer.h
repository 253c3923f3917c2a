#pragma once

#include <span>
#include <string>

#include "engine/scene/scene.h"

namespace plumb::app {

/// Returns a field of CSV, quoted if necessary.
std::string csv_text(const std::string& text);

/// Prints a run's samples. Numbers are the shortest that read back to the same bits.
class TrajectoryWriter {
 public:
  enum class Format {
    Csv,   ///< t,body,x,y,angle,vx,vy,w: one line per body and sample
    Json,  ///< one line per sample: {"t":..,"bodies":[{"name","x","y","angle","vx","vy","w"}]}
  };

  /// Prints the column names if the format has them.
  TrajectoryWriter(const Scene& scene, Format format);
  void write(double time, std::span<const BodyState> states) const;

 private:
  void write_csv(double time, std::span<const BodyState> states) const;
  void write_json(double time, std::span<const BodyState> states) const;

  const Scene& scene_;
  Format format_;
};

}  // namespace plumb::app
