#include "reference/support/protocol.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/features.h"
#include "engine/scene/names.h"

namespace plumb::reference::protocol {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<Scheme, const char*>, 6> kSchemes{
    {{Scheme::ExplicitEuler, "explicit_euler"},
     {Scheme::SemiImplicitEuler, "semi_implicit_euler"},
     {Scheme::VelocityVerlet, "velocity_verlet"},
     {Scheme::RungeKutta4, "runge_kutta_4"},
     {Scheme::SoftStep, "soft_step"},
     {Scheme::Adaptive, "adaptive"}}};

constexpr std::array<std::pair<Error::Kind, const char*>, 6> kKinds{
    {{Error::Kind::Syntax, "syntax"},
     {Error::Kind::Value, "value"},
     {Error::Kind::Name, "name"},
     {Error::Kind::Unsupported, "unsupported"},
     {Error::Kind::Run, "run"},
     {Error::Kind::Io, "io"}}};

/// The member `name`, which must be there and hold a `Value`.
template <class Value>
Value member(const Json& message, const char* name) {
  if (!message.contains(name)) throw Malformed("it has no \"" + std::string(name) + "\"");
  try {
    return message[name].get<Value>();
  } catch (const Json::exception&) {
    throw Malformed("its \"" + std::string(name) + "\" is " + printable(message[name].dump()));
  }
}

template <class Value>
Value member(const Json& message, const char* name, Value fallback) {
  return message.contains(name) ? member<Value>(message, name) : fallback;
}

int whole_number_or(const Json& message, const char* name, int fallback) {
  return message.contains(name) ? protocol::whole_number(message, name) : fallback;
}

/// Returns a setting's value as text: strings unchanged, other values as JSON writes them.
std::string as_text(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// Maximum length of a list in an engine's hello: each entry is printed, checked and searched.
constexpr std::size_t kMostEntries = 1000;
/// Maximum length of a text shown to people, bytes.
constexpr std::size_t kMostText = 400;

/// Returns the list `name`, or an empty one if absent. Throws `Malformed` for more than `kMostEntries`.
Json list(const Json& message, const char* name) {
  Json out = member<Json>(message, name, Json::array());
  if (out.size() > kMostEntries)
    throw Malformed("its \"" + std::string(name) + "\" has " + std::to_string(out.size()) +
                    " entries; at most " + std::to_string(kMostEntries) + " are read");
  return out;
}

/// Returns `text` unchanged, because it may be sent back to the engine. Throws `Malformed` for control
/// characters.
std::string checked_word(const char* name, std::string text) {
  if (has_control_character(text))
    throw Malformed("its \"" + std::string(name) + "\" has control characters: " + plumb::quoted(text));
  return text;
}

/// Returns the text `name` in printable form, at most `kMostText` bytes of it.
std::string text_for_people(const Json& message, const char* name) {
  return printable(member<std::string>(message, name, ""), kMostText);
}

double finite_number(const Json& value, const char* what) {
  if (value.is_null()) throw NotFinite(std::string(what) + " is not finite");
  if (!value.is_number()) throw Malformed(std::string(what) + " is " + printable(value.dump()));
  const double out = value.get<double>();
  if (!std::isfinite(out)) throw NotFinite(std::string(what) + " is not finite");
  return out;
}

/// Highest order that a method may declare: beyond every method in use, of which extrapolation has the
/// highest.
constexpr int kHighestOrder = 20;
/// Largest unit roundoff: that of 16-bit numbers with 8 bits of mantissa is 0.0078.
constexpr double kLargestEpsilon = 0.01;

Method method_from_json(const Json& message) {
  const auto scheme = member<std::string>(message, "scheme");
  Method out;
  bool known = false;
  for (const auto& [value, name] : kSchemes) {
    if (scheme != name) continue;
    out.scheme = value;
    known = true;
  }
  if (!known) {
    std::string names;
    for (const auto& [value, name] : kSchemes) names += (names.empty() ? "" : ", ") + std::string(name);
    throw Malformed("its \"scheme\" is " + plumb::quoted(scheme) + ", and not one of " + names);
  }
  out.order = whole_number(message, "order");
  if (out.order < 0 || out.order > kHighestOrder)
    throw Malformed("its \"order\" is " + std::to_string(out.order) + ", not 0 to " +
                    std::to_string(kHighestOrder));
  out.epsilon = member<double>(message, "epsilon");
  if (!(out.epsilon > 0 && out.epsilon <= kLargestEpsilon))
    throw Malformed("its \"epsilon\" is " + shortest(out.epsilon) + ", not above 0 and at most " +
                    shortest(kLargestEpsilon));
  return out;
}

int substeps_from_json(const Json& method) {
  const int out = whole_number_or(method, "substeps", 1);
  if (out < 1) throw Malformed("its \"substeps\" is " + std::to_string(out));
  return out;
}

Json method_json(const Method& method, int substeps) {
  Json out;
  for (const auto& [value, name] : kSchemes) {
    if (value == method.scheme) out["scheme"] = name;
  }
  out["order"] = method.order;
  out["epsilon"] = method.epsilon;
  out["substeps"] = substeps;
  return out;
}

/// Returns the member of a line that is not JSON in which a number is not finite: the spellings in Python,
/// JavaScript and C of numbers that JSON cannot express.
std::optional<std::string> member_not_finite(std::string_view line) {
  if (!line.starts_with('{')) return {};
  std::string_view text, name;  // the last text, and the last one before a colon
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ':') name = text;
    for (const std::string_view word : {"NaN", "nan", "Infinity", "inf"})
      if (line.substr(i).starts_with(word)) return std::string(name);
    if (line[i] != '"') continue;
    const std::size_t start = i + 1;
    for (++i; i < line.size() && line[i] != '"'; ++i)
      if (line[i] == '\\') ++i;
    text = line.substr(start, std::min(i, line.size()) - start);
  }
  return {};
}

/// Returns true if arrays and objects nest deeper than in any scene or message (64 levels). The JSON library
/// recurses for each level, so a line of brackets would overflow the stack.
bool nests_too_deep(std::string_view text) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_text = !in_text;
    } else if (!in_text && (c == '[' || c == '{')) {
      if (++depth > kDeepest) return true;
    } else if (!in_text && (c == ']' || c == '}')) {
      --depth;
    }
  }
  return false;
}

}  // namespace

int whole_number(const Json& message, const char* name) {
  const auto number = member<Json>(message, name);
  const double value = number.is_number() ? number.get<double>() : 0.5;
  // Converting a number beyond the range of int is undefined behaviour.
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
    throw Malformed("its \"" + std::string(name) + "\" is " + printable(number.dump()));
  return static_cast<int>(value);
}

Json to_json(const Hello& hello) {
  Json methods = Json::array();
  for (const OptionMethod& each : hello.methods) {
    methods.push_back({{"option", each.option},
                       {"value", each.value},
                       {"method", method_json(each.method, each.substeps)}});
  }
  Json options = Json::array();
  for (const Option& option : hello.options) {
    options.push_back({{"name", option.name}, {"fallback", option.fallback}, {"help", option.help}});
  }
  Json knobs = Json::array();
  for (const Knob& knob : hello.knobs)
    knobs.push_back({{"name", knob.name}, {"values", knob.values}, {"ordered", knob.ordered}});
  Json out{{"protocol", kVersion},
           {"name", hello.name},
           {"version", hello.version},
           {"precision", hello.precision},
           {"summary", hello.summary},
           {"method", method_json(hello.method, hello.substeps)},
           {"methods", methods},
           {"shapes", hello.shapes},
           {"joints", hello.joints},
           {"forces", hello.forces},
           {"features", hello.features},
           {"options", options},
           {"knobs", knobs}};
  if (!hello.limits.empty()) out["limits"] = hello.limits;
  return out;
}

Hello hello_from_json(const Json& message) {
  const int version = whole_number(message, "protocol");
  if (version != kVersion) {
    throw Malformed("it speaks version " + std::to_string(version) + " of the protocol, not " +
                    std::to_string(kVersion));
  }
  Hello out;
  out.name = printable(member<std::string>(message, "name"));
  out.version = printable(member<std::string>(message, "version"));
  out.precision = member<std::string>(message, "precision");
  if (out.precision != "float" && out.precision != "double") {
    throw Malformed("its \"precision\" is " + plumb::quoted(out.precision));
  }
  out.summary = text_for_people(message, "summary");
  out.limits = text_for_people(message, "limits");
  const Json method = member<Json>(message, "method");
  out.method = method_from_json(method);
  out.substeps = substeps_from_json(method);
  for (const Json& each : list(message, "methods")) {
    const Json chosen = member<Json>(each, "method");
    out.methods.push_back({checked_word("option", member<std::string>(each, "option")),
                           checked_word("value", as_text(member<Json>(each, "value"))),
                           method_from_json(chosen), substeps_from_json(chosen)});
  }
  using Names = std::vector<std::string>;
  out.shapes = member<Names>(message, "shapes");
  out.joints = member<Names>(message, "joints", Names{});
  out.forces = member<Names>(message, "forces", Names{});
  out.features = member<Names>(message, "features", Names{});
  for (const Json& option : list(message, "options")) {
    out.options.push_back({checked_word("name", member<std::string>(option, "name")),
                           checked_word("fallback", as_text(member<Json>(option, "fallback"))),
                           text_for_people(option, "help")});
  }
  for (const Json& knob : list(message, "knobs")) {
    if (list(knob, "values").empty()) throw Malformed("a knob of it has no \"values\"");
    Names values = member<Names>(knob, "values");
    for (const std::string& value : values) checked_word("values", value);
    out.knobs.push_back({checked_word("name", member<std::string>(knob, "name")), std::move(values),
                         member<bool>(knob, "ordered", true)});
  }
  return out;
}

Json to_json(const StepSettings& settings) {
  Json out{{"dt", settings.dt}};
  if (settings.substeps) out["substeps"] = *settings.substeps;
  if (settings.tolerance) out["tolerance"] = *settings.tolerance;
  out["options"] = settings.options;
  return out;
}

StepSettings settings_from_json(const Json& message) {
  StepSettings out;
  out.dt = member<double>(message, "dt");
  if (message.contains("substeps")) out.substeps = whole_number(message, "substeps");
  if (message.contains("tolerance")) out.tolerance = member<double>(message, "tolerance");
  const Json options = member<Json>(message, "options", Json::object());
  for (const auto& [name, value] : options.items()) out.options[name] = as_text(value);
  return out;
}

Json to_json(const Settings& effective) {
  Json out = Json::object();
  for (const auto& [name, value] : effective) out[name] = value;
  return out;
}

Settings effective_from_json(const Json& message) {
  if (!message.is_object()) throw Malformed("its \"effective_settings\" is " + printable(message.dump()));
  if (message.size() > kMostEntries)
    throw Malformed("its \"effective_settings\" has " + std::to_string(message.size()) +
                    " entries; at most " + std::to_string(kMostEntries) + " are read");
  Settings out;
  for (const auto& [name, value] : message.items()) {
    if (!value.is_string() && !value.is_number() && !value.is_boolean())
      throw Malformed("its setting " + plumb::quoted(name) + " is " + printable(value.dump(), kMostText) +
                      ", and not a string, a number or a boolean");
    out.emplace_back(printable(name), printable(as_text(value), kMostText));
  }
  return out;
}

Loaded loaded_from_json(const Json& message) {
  Loaded out;
  if (message.contains("unsupported")) {
    const Json& reason = message["unsupported"];
    if (!reason.is_string() || reason.get<std::string>().empty())
      throw Malformed("its \"unsupported\" is not a reason");
    out.unsupported = printable(reason.get<std::string>(), kMostText);
  } else if (message.contains("effective_settings")) {
    out.effective = effective_from_json(message["effective_settings"]);
  } else {
    throw Malformed("it has no \"effective_settings\"");
  }
  return out;
}

double done_from_json(const Json& message) {
  if (!message.contains("done")) throw Malformed("it is not \"done\" after the last sample");
  const bool timed = message.contains("ns") && message["ns"].is_number();
  const double nanoseconds = timed ? message["ns"].get<double>() : -1;
  if (!(nanoseconds >= 0)) throw Malformed("its \"ns\" is not a time");
  return nanoseconds;
}

Json to_json(const Error& error) {
  Json out;
  for (const auto& [value, name] : kKinds) {
    if (value == error.kind()) out["kind"] = name;
  }
  out["subject"] = error.subject();
  out["field"] = error.field();
  out["value"] = error.value();
  out["problem"] = error.problem();
  return out;
}

Error error_from_json(const Json& message, const std::string& engine) {
  const std::string own_subject = "engine '" + engine + "'";
  if (!message.is_object()) {
    return {Error::Kind::Run, own_subject, "", "", printable(as_text(message), kMostText)};
  }
  Error::Kind kind = Error::Kind::Run;
  const auto given = member<std::string>(message, "kind", "run");
  if (given == kDiverged)
    throw NotFinite(printable(member<std::string>(message, "problem", "its state is not finite"), kMostText));
  for (const auto& [value, name] : kKinds) {
    if (given == name) kind = value;
  }
  return {kind, printable(member<std::string>(message, "subject", own_subject), kMostText),
          text_for_people(message, "field"), text_for_people(message, "value"),
          text_for_people(message, "problem")};
}

std::string sample_line(double time, std::span<const BodyState> states) {
  std::string out = "{\"t\":" + shortest(time) + ",\"states\":[";
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& s = states[i];
    const std::array<double, 6> row{s.position.x, s.position.y, s.angle,
                                    s.velocity.x, s.velocity.y, s.angular_velocity};
    out += i == 0 ? '[' : ',';
    if (i > 0) out += '[';
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (!std::isfinite(row[k]))
        throw NotFinite("the state of body " + std::to_string(i) + " is not finite");
      if (k > 0) out += ',';
      out += shortest(row[k]);
    }
    out += ']';
  }
  return out + "]}";
}

double sample_from_json(const Json& message, std::span<BodyState> out) {
  if (!message.contains("t")) throw Malformed("it has no \"t\"");
  const double time = finite_number(message["t"], "\"t\"");
  const Json states = member<Json>(message, "states");
  if (!states.is_array() || states.size() != out.size()) {
    throw Malformed("its \"states\" has " + std::to_string(states.is_array() ? states.size() : 0) +
                    " bodies where the scene has " + std::to_string(out.size()));
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Json& row = states[i];
    const std::string what = "the state of body " + std::to_string(i);
    if (!row.is_array() || row.size() != 6) {
      throw Malformed(what + " is not [x, y, angle, vx, vy, w]: " + printable(row.dump()));
    }
    std::array<double, 6> numbers;
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = finite_number(row[k], what.c_str());
    out[i] = {.position = {numbers[0], numbers[1]},
              .angle = numbers[2],
              .velocity = {numbers[3], numbers[4]},
              .angular_velocity = numbers[5]};
  }
  return time;
}

Json parse_line(std::string_view line) {
  if (nests_too_deep(line)) throw Malformed("it nests too deep: " + plumb::quoted(line));
  Json out;
  try {
    out = Json::parse(line);
  } catch (const Json::exception&) {
    if (const auto name = member_not_finite(line))
      throw NotFinite(*name == "states" ? "a state is not finite" : plumb::quoted(*name) + " is not finite");
    throw Malformed("it is not JSON: " + plumb::quoted(line));
  }
  if (!out.is_object()) throw Malformed("it is not a JSON object: " + plumb::quoted(line));
  return out;
}

}  // namespace plumb::reference::protocol
