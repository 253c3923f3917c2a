#include "bench/field/parcel.h"

#include <nlohmann/json.hpp>

namespace plumb::field {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Counts, bodies, shapes, joints, touching)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Quality, finite, near, overlapping, deepest, mean_depth, worst_joint,
                                   mean_joint, worst_limit, kinetic_energy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Speed, rms, max)

std::string pack(const Measurement& found, bool first) {
  nlohmann::json out{
      {"failure", found.failure}, {"step_seconds", found.step_seconds}, {"cpu_share", found.cpu_share}};
  if (!first || !found.failure.empty()) return out.dump();
  out["settings"] = found.settings;
  out["asked"] = found.asked;
  out["counted"] = found.counted;
  out["continuous"] = found.continuous;
  out["quality"] = found.quality;
  out["speed"] = found.speed;
  if (found.height) out["height"] = *found.height;
  out["escaped"] = found.escaped;
  out["bytes_a_body"] = found.bytes_a_body;
  out["allocations_a_step"] = found.allocations_a_step;
  out["stages"] = found.stages;
  return out.dump();
}

void unpack(const std::string& text, Measurement& out) {
  const nlohmann::json found = nlohmann::json::parse(text);
  found.at("failure").get_to(out.failure);
  for (const double seconds : found.at("step_seconds")) out.step_seconds.push_back(seconds);
  for (const double share : found.at("cpu_share")) out.cpu_share.push_back(share);
  if (!found.contains("quality")) return;
  found.at("settings").get_to(out.settings);
  found.at("asked").get_to(out.asked);
  found.at("counted").get_to(out.counted);
  found.at("continuous").get_to(out.continuous);
  found.at("quality").get_to(out.quality);
  found.at("speed").get_to(out.speed);
  if (found.contains("height")) out.height = found.at("height").get<double>();
  found.at("escaped").get_to(out.escaped);
  found.at("bytes_a_body").get_to(out.bytes_a_body);
  found.at("allocations_a_step").get_to(out.allocations_a_step);
  found.at("stages").get_to(out.stages);
}

}  // namespace plumb::field
