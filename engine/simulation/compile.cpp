#include <bit>
#include <new>
#include <string>

#include "engine/precise/precise.h"
#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "engine/simulation/simulation.h"
#include "engine/simulation/world_driver.h"

namespace plumb {
namespace {

/// Mixes a word into a 64-bit hash (FNV-1a's step).
std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) { return (hash ^ word) * 0x100000001b3ull; }

std::uint64_t identity_of(const Scene& scene, const Accuracy& accuracy) {
  std::uint64_t out = mixed(hash(scene), accuracy.index());
  if (const auto* precise = std::get_if<Precise>(&accuracy)) {
    out = mixed(out, std::bit_cast<std::uint64_t>(precise->tolerance));
    out = mixed(out, std::bit_cast<std::uint64_t>(precise->max_dt));
    out = mixed(out, static_cast<std::uint64_t>(precise->method));
    return precise->estimate_error ? mixed(out, 1) : out;
  }
  const Realtime& realtime = std::get<Realtime>(accuracy);
  out = mixed(out, std::bit_cast<std::uint64_t>(realtime.dt));
  for (const int number : {realtime.substeps, realtime.iterations, static_cast<int>(realtime.precision),
                           static_cast<int>(realtime.integrator), static_cast<int>(realtime.solver),
                           static_cast<int>(realtime.continuous), static_cast<int>(realtime.sleeping)})
    out = mixed(out, static_cast<std::uint64_t>(number));
  return out;
}

std::unique_ptr<Driver> make_driver(const Scene& scene, const Accuracy& accuracy,
                                    const CompileOptions& options) {
  if (const auto* precise = std::get_if<Precise>(&accuracy))
    return make_precise_driver(scene, *precise, options);
  const Realtime& realtime = std::get<Realtime>(accuracy);
  if (realtime.precision == Precision::Float)
    return std::make_unique<WorldDriver<float>>(scene, realtime, options.every_stage);
  return std::make_unique<WorldDriver<double>>(scene, realtime, options.every_stage);
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
    std::uint64_t identity = identity_of(scene, accuracy);
    for (const std::string& parameter : options.parameters) {
      for (const char letter : parameter) identity = mixed(identity, static_cast<unsigned char>(letter));
      identity = mixed(identity, 0);
    }
    return {make_driver(scene, accuracy, options), scene.bodies.size(), identity};
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
