// Lines that an engine might write, as plumb reads them: each is taken, or refused as not being what is due;
// what is taken can be written again and reads back the same.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/error.h"
#include "reference/support/protocol.h"
#include "tests/fuzz/support/require.h"

namespace plumb::fuzz {
namespace {

namespace protocol = reference::protocol;
using Json = nlohmann::ordered_json;

void read_hello(const Json& line) {
  const protocol::Hello hello = protocol::hello_from_json(line);
  const Json again = protocol::to_json(hello);
  require(protocol::to_json(protocol::hello_from_json(again)) == again, "a hello that is written reads back");
  require(hello.substeps >= 1 && hello.method.order >= 0 && hello.method.epsilon > 0,
          "a hello that is taken has a method");
  protocol::missing_capability(Scene{.name = "fuzz", .bodies = {Body{.name = "ball"}}}, hello);
}

void read_load(const Json& line) {
  const protocol::Loaded loaded = protocol::loaded_from_json(line);
  const Json again = protocol::to_json(loaded.effective);
  require(loaded.unsupported.empty() || loaded.effective.empty(),
          "a scene that does not run has no settings");
  protocol::effective_from_json(again);
}

void read_sample(const Json& line) {
  std::vector<BodyState> states(2);
  const double time = protocol::sample_from_json(line, states);
  std::vector<BodyState> again(2);
  const double same = protocol::sample_from_json(Json::parse(protocol::sample_line(time, states)), again);
  require(same == time && again == states, "a sample that is written reads back");
}

void read_settings(const Json& line) {
  const reference::StepSettings settings = protocol::settings_from_json(line);
  if (!std::isfinite(settings.dt) || !std::isfinite(settings.tolerance.value_or(1))) return;
  const Json again = protocol::to_json(settings);
  require(protocol::to_json(protocol::settings_from_json(again)) == again,
          "settings that are written read back");
}

// One line, as what is due in the order of a conversation.
void read_line(std::string_view text, std::size_t which) {
  try {
    const Json line = protocol::parse_line(text);
    if (line.contains("error")) throw protocol::error_from_json(line["error"], "fuzz");
    if (which == 0) read_hello(line);
    if (which == 1) read_load(line);
    if (which == 2 || which == 3) read_sample(line);
    if (which == 4) require(protocol::done_from_json(line) >= 0, "a run takes no negative time");
    if (which == 5) read_settings(line);
  } catch (const protocol::Malformed& problem) {
    require(problem.what()[0] != '\0', "what is wrong with a line is said");
  } catch (const protocol::NotFinite&) {
  } catch (const Error& error) {
    const Json again = protocol::to_json(error);
    require(Json::parse(again.dump()) == again, "an engine's error can be written");
  }
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  std::size_t which = 0;
  for (std::size_t begin = 0; begin < text.size(); ++which) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    plumb::fuzz::read_line(text.substr(begin, end - begin), which % 6);
    begin = end + 1;
  }
  return 0;
}
