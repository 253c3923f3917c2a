#include "app/sensitivity_writer.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "app/output.h"
#include "engine/core/text.h"
#include "engine/driver/sensitivity.h"

namespace plumb::app {

SensitivityWriter::SensitivityWriter(const Scene& scene, std::vector<std::string> parameters,
                                     TrajectoryWriter::Format format)
    : scene_(scene), parameters_(std::move(parameters)), ended_(parameters_.size()), format_(format) {
  if (format == TrajectoryWriter::Format::Csv) print("t,parameter,body,x,y,angle,vx,vy,w\n");
}

void SensitivityWriter::write(const Simulation& run) {
  using Format = TrajectoryWriter::Format;
  const bool csv = format_ == Format::Csv;
  const std::string time = shortest(run.time());
  std::string text = csv ? "" : "{\"t\":" + time + ",\"parameters\":[";
  bool first_parameter = true;
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    std::vector<BodyState> by;
    try {
      by = run.sensitivities(j);
    } catch (const NotDifferentiable& error) {
      if (!std::exchange(ended_[j], 1)) notice(error.what());
      continue;
    }
    if (!csv) {
      text += (first_parameter ? "{\"name\":" : ",{\"name\":") + nlohmann::json(parameters_[j]).dump() +
              ",\"bodies\":[";
    }
    first_parameter = false;
    for (std::size_t i = 0; i < by.size(); ++i) {
      constexpr const char* kNames[] = {"x", "y", "angle", "vx", "vy", "w"};
      const BodyState& s = by[i];
      const double values[] = {s.position.x, s.position.y, s.angle,
                               s.velocity.x, s.velocity.y, s.angular_velocity};
      if (csv) {
        text += time + "," + csv_text(parameters_[j]) + "," + csv_text(scene_.bodies[i].name);
        for (const double value : values) text += "," + shortest(value);
        text += "\n";
      } else {
        text += (i == 0 ? "{\"name\":" : ",{\"name\":") + nlohmann::json(scene_.bodies[i].name).dump();
        for (std::size_t k = 0; k < 6; ++k)
          text += std::string(",\"") + kNames[k] + "\":" + shortest(values[k]);
        text += "}";
      }
    }
    if (!csv) text += "]}";
  }
  print(csv ? text : text + "]}\n");
}

}  // namespace plumb::app
