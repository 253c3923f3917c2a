#include <cstdint>
#include <new>
#include <string>
#include <vector>

#include "engine/core/hash.h"
#include "engine/precise/precise.h"
#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "engine/simulation/simulation.h"
#include "engine/simulation/world_driver.h"

namespace plumb {
namespace {

std::uint64_t identity_of(const Scene& scene, const Accuracy& accuracy,
                          const std::vector<std::string>& parameters) {
  Fnv1a out;
  out.add(hash(scene));
  for (const std::string& parameter : parameters) {
    for (const char letter : parameter) out.add(std::uint64_t{static_cast<unsigned char>(letter)});
    out.add(std::uint64_t{0});
  }
  out.add(std::uint64_t{accuracy.index()});
  if (const auto* precise = std::get_if<Precise>(&accuracy)) {
    out.add(precise->tolerance), out.add(precise->max_dt);
    out.add(static_cast<std::uint64_t>(precise->method));
    if (precise->estimate_error) out.add(std::uint64_t{1});
    return out.value();
  }
  const Realtime& realtime = std::get<Realtime>(accuracy);
  out.add(realtime.dt);
  for (const int number : {realtime.substeps, realtime.iterations, static_cast<int>(realtime.precision),
                           static_cast<int>(realtime.integrator), static_cast<int>(realtime.solver),
                           static_cast<int>(realtime.continuous), static_cast<int>(realtime.sleeping)})
    out.add(static_cast<std::uint64_t>(number));
  return out.value();
}

OwnedPointer<Driver> make_driver(const Scene& scene, const Accuracy& accuracy,
                                 const CompileOptions& options) {
  if (const auto* precise = std::get_if<Precise>(&accuracy))
    return OwnedPointer(make_precise_driver(scene, *precise, options).release());
  const Realtime& realtime = std::get<Realtime>(accuracy);
  if (realtime.precision == Precision::Float)
    return OwnedPointer<Driver>(new WorldDriver<float>(scene, realtime, options.every_stage));
  return OwnedPointer<Driver>(new WorldDriver<double>(scene, realtime, options.every_stage));
}

}  // namespace

Simulation compile(const Scene& scene, const Accuracy& accuracy, CompileOptions options) {
  validate(scene);
  validate(accuracy);
  if (!options.parameters.empty() && !std::holds_alternative<Precise>(accuracy))
    throw Error(Error::Kind::Unsupported, "realtime", "parameters", options.parameters.front(),
                "fixed steps have no derivatives; Precise has them");
  if (const std::string reason = unsupported(scene, accuracy); !reason.empty())
    throw Error(Error::Kind::Unsupported, "scene '" + scene.name + "'", "", "", reason);
  try {
    return {make_driver(scene, accuracy, options), scene.bodies.size(),
            identity_of(scene, accuracy, options.parameters)};
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::Run, "scene '" + scene.name + "'", "memory", "",
                "there is not enough of it for " + std::to_string(scene.bodies.size()) + " bodies");
  }
}

std::string unsupported(const Scene& scene, const Accuracy& accuracy) {
  if (const auto* precise = std::get_if<Precise>(&accuracy)) {
    const std::string reason = precise_unsupported(scene);
    const bool symplectic = precise->method == MotionMethod::Symplectic;
    return reason.empty() && symplectic ? symplectic_unsupported(scene) : reason;
  }
  return realtime_unsupported(scene, std::get<Realtime>(accuracy));
}

}  // namespace plumb
