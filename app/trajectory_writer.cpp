#include "app/trajectory_writer.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "app/output.h"
#include "engine/core/text.h"

namespace plumb::app {
namespace {

// Returns null for a non-finite value, which JSON cannot hold.
std::string json_number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

}  // namespace

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

TrajectoryWriter::TrajectoryWriter(const Scene& scene, Format format) : scene_(scene), format_(format) {
  if (format == Format::Csv) print("t,body,x,y,angle,vx,vy,w\n");
}

void TrajectoryWriter::write(double time, std::span<const BodyState> states) const {
  format_ == Format::Csv ? write_csv(time, states) : write_json(time, states);
}

void TrajectoryWriter::write_csv(double time, std::span<const BodyState> states) const {
  std::string text;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& s = states[i];
    text += shortest(time) + "," + csv_text(scene_.bodies[i].name);
    for (const double value :
         {s.position.x, s.position.y, s.angle, s.velocity.x, s.velocity.y, s.angular_velocity})
      text += "," + shortest(value);
    text += "\n";
  }
  print(text);
}

void TrajectoryWriter::write_json(double time, std::span<const BodyState> states) const {
  std::string text = "{\"t\":" + shortest(time) + ",\"bodies\":[";
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& s = states[i];
    text += (i == 0 ? "{\"name\":" : ",{\"name\":") + nlohmann::json(scene_.bodies[i].name).dump();
    text += ",\"x\":" + json_number(s.position.x) + ",\"y\":" + json_number(s.position.y);
    text += ",\"angle\":" + json_number(s.angle) + ",\"vx\":" + json_number(s.velocity.x);
    text += ",\"vy\":" + json_number(s.velocity.y) + ",\"w\":" + json_number(s.angular_velocity) + "}";
  }
  print(text + "]}\n");
}

}  // namespace plumb::app
