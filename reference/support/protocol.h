#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/error.h"
#include "engine/scene/scene.h"
#include "reference/backend.h"

/// The messages of docs/protocol.md, as both sides read and write them.
namespace plumb::reference::protocol {

inline constexpr int kVersion = 1;

/// Kind of the error that reports a state that is not finite.
inline constexpr const char* kDiverged = "diverged";

/// An engine's method and substeps for one value of an option.
struct OptionMethod {
  std::string option, value;
  Method method;
  int substeps = 1;
};

/// The answer to "hello": an engine's description of itself.
struct Hello {
  std::string name, version, precision, summary;
  Method method;
  int substeps = 1;                     ///< per step, if the settings do not say
  std::vector<OptionMethod> methods{};  ///< for option values that change the method
  std::vector<std::string> shapes, joints, forces, features;
  std::vector<Option> options;
  std::vector<Knob> knobs{};
  std::string limits{};  ///< known reasons for its misses, as a sentence
};

/// The answer to "load".
struct Loaded {
  std::string unsupported{};  ///< why the engine cannot run the scene; empty if it can
  Settings effective{};
};

/// A message other than the expected one; `what()` gives the reason.
class Malformed : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A state that is not finite.
class NotFinite : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

nlohmann::ordered_json to_json(const Hello& hello);
Hello hello_from_json(const nlohmann::ordered_json& message);

nlohmann::ordered_json to_json(const StepSettings& settings);
StepSettings settings_from_json(const nlohmann::ordered_json& message);

nlohmann::ordered_json to_json(const Settings& effective);
Settings effective_from_json(const nlohmann::ordered_json& message);
Loaded loaded_from_json(const nlohmann::ordered_json& message);

/// Reads the line after the last sample: the engine's ns. Throws `Malformed`.
double done_from_json(const nlohmann::ordered_json& message);

/// Converts an error to and from its parts; a bare string is read as a problem. Throws `NotFinite` for one of
/// kind `kDiverged`.
nlohmann::ordered_json to_json(const Error& error);
Error error_from_json(const nlohmann::ordered_json& message, const std::string& engine);

/// Returns one sample: {"t":..,"states":[[x,y,angle,vx,vy,w],..]}, on one line. Throws `NotFinite`.
std::string sample_line(double time, std::span<const BodyState> states);

/// Reads a sample of `out.size()` bodies and returns its time. Throws `Malformed` or `NotFinite`.
double sample_from_json(const nlohmann::ordered_json& message, std::span<BodyState> out);

/// Returns the member `name`. Throws `Malformed` unless it is a whole number that fits into an int.
int whole_number(const nlohmann::ordered_json& message, const char* name);

/// Parses a line into a JSON object. Throws `Malformed`, also if it nests too deep, or `NotFinite` if it has
/// a NaN or an infinity.
nlohmann::ordered_json parse_line(std::string_view line);

/// Returns a feature that `scene` needs and the engine of `hello` lacks; empty if there is none.
std::string missing_capability(const Scene& scene, const Hello& hello);

}  // namespace plumb::reference::protocol
