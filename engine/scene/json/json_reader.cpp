#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/json/json_document.h"
#include "engine/scene/json/json_fields.h"
#include "engine/scene/json/json_place.h"
#include "engine/scene/scene_fields.h"

namespace plumb {
namespace {

using json::Fields;
using json::View;

/// Names, for messages, of the types that have fields.
template <class T>
constexpr std::string_view kThing = "";
template <>
constexpr std::string_view kThing<Spring> = "a spring";
template <>
constexpr std::string_view kThing<Motor> = "a motor";
template <>
constexpr std::string_view kThing<Range> = "a range";
template <>
constexpr std::string_view kThing<Filter> = "a filter";
template <>
constexpr std::string_view kThing<PrescribedMotion> = "a motion";
template <>
constexpr std::string_view kThing<ContactRules> = "contact_rules";
template <>
constexpr std::string_view kThing<Body> = "a body";
template <>
constexpr std::string_view kThing<Drive> = "a drive";

/// Adds the name of each field that it visits to a list.
class AddKeys {
 public:
  explicit AddKeys(Fields::Keys& keys) : keys_(keys) {}
  void operator()(std::string_view key, const auto&, const auto&) const { keys_.push_back(key); }

 private:
  Fields::Keys& keys_;
};

/// Reads a formula: text, or a number instead.
std::string formula(const View& view) {
  if (view.node().kind == json::Kind::Number) {
    const double value = json::number(view);
    if (!(std::abs(value) <= kLargest))
      view.fail(Error::Kind::Value, "must be at most " + shortest(kLargest) + " in magnitude");
    return shortest(value);
  }
  std::string text = json::string(view);
  if (text.empty()) view.fail(Error::Kind::Syntax, "is not a formula: it is empty");
  return text;
}

/// Reads each field that it visits if the field is present or required.
class Reader {
 public:
  explicit Reader(const Fields& fields) : fields_(fields) {}

  template <class T, class Rule>
  void operator()(std::string_view key, T&& out, const Rule& rule) const {
    if (rule.required || fields_.has(key)) read(fields_.required(key), out, rule);
  }

 private:
  static void read(const View& view, double& out, const FieldRule&) { out = json::number(view); }
  static void read(const View& view, bool& out, const FieldRule&) { out = json::boolean(view); }
  static void read(const View& view, Vec2d& out, const FieldRule&) { out = json::vector(view); }
  static void read(const View& view, std::uint64_t& out, const FieldRule&) { out = json::bits(view); }
  static void read(const View& view, std::int32_t& out, const WholeRule& rule) {
    out = static_cast<std::int32_t>(json::integer(view, rule.lowest, rule.highest));
  }
  template <class Enum>
  static void read(const View& view, Enum& out, const ChoiceRule& rule) {
    out = static_cast<Enum>(json::choice(view, rule.names));
  }
  template <class Rule>
  static void read(const View& view, std::string& out, const Rule&) {
    out = std::is_same_v<Rule, FormulaRule> ? formula(view) : json::string(view);
  }
  static void read(const View& view, const std::tuple<std::string&, std::string&>& out, const FormulaRule&) {
    if (view.node().kind != json::Kind::Array || view.node().items.size() != 2)
      view.fail(Error::Kind::Syntax, "must be two formulas [x, y]");
    std::get<0>(out) = formula(View(view.node().items[0], view));
    std::get<1>(out) = formula(View(view.node().items[1], view));
  }
  static void read(const View& view, std::vector<Vec2d>& out, const FieldRule&) {
    json::each(view, "must be a list of points [[x, y], ...]",
               [&](const View& point) { out.push_back(json::vector(point)); });
  }
  template <class T>
  static void read(const View& view, std::optional<T>& out, const FieldRule& rule) {
    read(view, out.emplace(), rule);
  }

  template <class T>
  static void read(const View& view, T& out, const FieldRule& rule) {
    Fields::Keys keys;
    inner_fields(out, rule, AddKeys(keys));
    inner_fields(out, rule, Reader(Fields(view, kThing<T>, keys)));
  }

  template <class T>
  static void read(const View& view, std::vector<T>& out, const ListRule&) {
    json::each(view, "must be a list [...]", [&](const View& item) { read_part(item, out.emplace_back()); });
  }

  template <class T>
  static void read_part(const View& view, T& out) {
    Fields::Keys keys;
    all_fields(out, AddKeys(keys));
    const Fields fields(view, kThing<T>, keys);
    all_fields(out, Reader(fields));
    if constexpr (std::is_same_v<T, Body>) {
      if (out.type == BodyType::Dynamic && !fields.has("mass"))
        out.mass = mass_by_density(out).value_or(out.mass);
    }
  }
  static void read_part(const View& view, Shape& out) {
    read_kind(view, out, out.geometry, "shape", "", kGeometryNames);
  }
  static void read_part(const View& view, Joint& out) {
    read_kind(view, out, out, "joint", " joint", kJointNames);
  }
  static void read_part(const View& view, ForceLaw& out) {
    read_kind(view, out, out, "force", "", kForceNames);
  }

  /// Reads a part whose "type" selects the alternative of `kind`. The variant `kind` is the part itself or a
  /// member of it.
  template <class Part, class... Kinds>
  static void read_kind(const View& view, Part& out, std::variant<Kinds...>& kind, const std::string& noun,
                        const std::string& ending, std::span<const std::string_view> names) {
    const auto keys_of = [&](const std::variant<Kinds...>& of) {
      Fields::Keys keys{"type"};
      kind = of;
      all_fields(out, AddKeys(keys));
      return keys;
    };
    // The keys of all kinds are allowed at first, so that a mistyped "type" is reported as such.
    static const std::vector<std::variant<Kinds...>> kKinds{Kinds{}...};
    static const Fields::Keys kAny = [&] {
      Fields::Keys any;
      for (const auto& each : kKinds) {
        for (const std::string_view key : keys_of(each))
          if (std::find(any.begin(), any.end(), key) == any.end()) any.push_back(key);
      }
      return any;
    }();
    const std::size_t type = json::choice(Fields(view, "a " + noun, kAny).required("type"), names);
    const std::string thing =
        (names[type].starts_with('a') ? "an " : "a ") + std::string(names[type]) + ending;
    const Fields fields(view, thing, keys_of(kKinds[type]));
    all_fields(out, Reader(fields));
  }

  const Fields& fields_;
};

void read_version(const Fields& fields) {
  if (!fields.has("plumb_scene")) return;
  const View version = fields.required("plumb_scene");
  if (json::number(version) != 1) {
    version.fail(Error::Kind::Unsupported,
                 "must be 1, the version of the scene format that this plumb reads");
  }
}

Scene read_scene(const View& view) {
  Scene scene;
  Fields::Keys keys{"plumb_scene"};
  all_fields(scene, AddKeys(keys));
  const Fields fields(view, "a scene", keys);
  read_version(fields);
  all_fields(scene, Reader(fields));
  return scene;
}

}  // namespace

Scene scene_from_json(std::string_view text) {
  json::Document document;
  json::parse(text, document);
  if (document.error) {
    json::ParseError& error = *document.error;
    const auto [subject, field] = json::naming_of(error.path);
    throw Error(error.kind, subject, field, std::move(error.value), std::move(error.problem), error.line);
  }
  Scene scene = read_scene(View(document.root));
  SceneLocation location;
  try {
    check(scene, location);
  } catch (const Error& error) {
    throw error.at_line(json::line_of(document.root, location, error.field()));
  }
  return scene;
}

}  // namespace plumb
