#include "harness/thresholds/catalogue.h"

#include "engine/core/suggest.h"
#include "engine/scene/error.h"

namespace plumb::harness::thresholds {

const std::vector<Threshold>& all() {
  static const std::vector<Threshold> thresholds{
      ramp_friction(),   steep_ramp_friction(), toppling_angle(), toppling_push(), overhang(),
      overhang_of_two(), arch_thickness(),      heavy_on_light(), heavy_tip(),     spring_force(),
      spring_joint(),    stopped_bullet(),      free_speed(),     free_spin()};
  return thresholds;
}

const Threshold& find(std::string_view name) {
  std::vector<std::string> names;
  for (const Threshold& threshold : all()) {
    if (threshold.name == name) return threshold;
    names.push_back(threshold.name);
  }
  throw Error(Error::Kind::Name, "threshold", "", std::string(name),
              "there is no such threshold" + did_you_mean(name, names));
}

}  // namespace plumb::harness::thresholds
