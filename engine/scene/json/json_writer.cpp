#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/core/hash.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/json/json_emitter.h"
#include "engine/scene/scene_fields.h"
#include "engine/scene/subject.h"
#include "engine/scene/validate.h"

namespace plumb {
namespace {

/// Writes the fields that it visits.
class Writer {
 public:
  explicit Writer(int indent) : out_(indent) {}
  explicit Writer(json::Emitter::Sink sink) : out_(-1, std::move(sink)) {}

  void scene(const Scene& scene) {
    out_.begin('{');
    out_.key("plumb_scene"), out_.integer(1);
    all_fields(scene, *this);
    out_.end('}');
  }

  bool failed() const { return failed_ || out_.failed(); }
  std::string take() { return out_.take(); }

  void operator()(std::string_view key, double value, const FieldRule& rule) {
    if (value != rule.none) out_.key(key), out_.number(value);
  }
  void operator()(std::string_view key, bool value, const FieldRule&) { out_.key(key), out_.boolean(value); }
  void operator()(std::string_view key, Vec2d value, const FieldRule&) { out_.key(key), out_.vector(value); }
  /// Writes bits as a signed number, so that a mask of all bits is -1: readers with doubles would round 2^64
  /// - 1.
  void operator()(std::string_view key, std::uint64_t bits, const FieldRule&) {
    out_.key(key), out_.integer(static_cast<std::int64_t>(bits));
  }
  void operator()(std::string_view key, std::int32_t value, const WholeRule&) {
    out_.key(key), out_.integer(value);
  }
  template <class Enum>
  void operator()(std::string_view key, Enum value, const ChoiceRule& rule) {
    const auto index = static_cast<std::size_t>(value);
    if (rule.first_is_none && index == 0) return;
    failed_ = failed_ || index >= rule.names.size();
    text(key, index < rule.names.size() ? rule.names[index] : std::string_view("?"));
  }
  void operator()(std::string_view key, const std::string& name, const auto&) { text(key, name); }
  void operator()(std::string_view key, const std::string& formula, const FormulaRule& rule) {
    if (!rule.or_none || !formula.empty()) text(key, formula);
  }
  void operator()(std::string_view key, std::tuple<const std::string&, const std::string&> formulas,
                  const FormulaRule&) {
    out_.key(key);
    out_.begin('[', Layout::Inline);
    out_.string(std::get<0>(formulas));
    out_.string(std::get<1>(formulas));
    out_.end(']');
  }
  void operator()(std::string_view key, const std::vector<Vec2d>& points, const FieldRule&) {
    out_.key(key);
    out_.begin('[', Layout::Inline);
    for (const Vec2d point : points) out_.vector(point);
    out_.end(']');
  }
  template <class T>
  void operator()(std::string_view key, const std::optional<T>& value, const FieldRule& rule) {
    if (value) (*this)(key, *value, rule);
  }

  template <class T>
  void operator()(std::string_view key, const T& value, const FieldRule& rule) {
    if constexpr (std::is_same_v<T, PrescribedMotion>)
      if (value.empty()) return;
    out_.key(key);
    out_.begin('{', std::is_same_v<T, ContactRules> ? Layout::Block : Layout::Inline);
    inner_fields(value, rule, *this);
    out_.end('}');
  }

  template <class T>
  void operator()(std::string_view key, const std::vector<T>& parts, const ListRule& rule) {
    if (rule.empty_is_none && parts.empty()) return;
    out_.key(key);
    out_.begin('[');
    for (const T& part : parts) {
      out_.begin('{');
      type(part);
      all_fields(part, *this);
      out_.end('}');
    }
    out_.end(']');
  }

 private:
  using Layout = json::Emitter::Layout;

  void text(std::string_view key, std::string_view value) { out_.key(key), out_.string(value); }
  void type(const Shape& shape) { text("type", kGeometryNames[shape.geometry.index()]); }
  void type(const Joint& joint) { text("type", kJointNames[joint.index()]); }
  void type(const ForceLaw& law) { text("type", kForceNames[law.index()]); }
  void type(const auto&) {}

  json::Emitter out_;
  bool failed_ = false;
};

// Writes a scene, and returns what the writer has not handed on.
std::string write(const Scene& scene, Writer& writer) {
  writer.scene(scene);
  if (writer.failed()) {
    validate(scene);  // throws with the name of the offending value
    throw Error(Error::Kind::Value, scene_subject(scene.name), "", "", "holds something that JSON cannot");
  }
  return writer.take();
}

}  // namespace

std::string to_json(const Scene& scene, int indent) {
  Writer writer(indent);
  return write(scene, writer);
}

std::uint64_t hash(const Scene& scene) {
  Fnv1a hash;
  const auto add = [&](std::string_view text) {
    for (const char c : text) hash.add(std::uint64_t{static_cast<unsigned char>(c)});
  };
  Writer writer(add);
  add(write(scene, writer));
  return hash.value();
}

}  // namespace plumb
