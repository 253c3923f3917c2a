#include "tests/scene/schema.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "engine/core/text.h"

namespace plumb::test {
namespace {

using nlohmann::json;

/// One keyword of a schema against one value. Keywords pass values of types that they do not speak of.
class Keyword {
 public:
  Keyword(const json& root, const json& schema, const json& value)
      : root_(root), schema_(schema), value_(value) {}

  bool holds(const std::string& name, const json& rule) const {
    for (const char* note : {"$schema", "$defs", "title", "description", "default", "then"}) {
      if (name == note) return true;
    }
    if (name == "$ref") return under(root_.at(json::json_pointer(rule.get<std::string>().substr(1))));
    if (name == "type") return is(rule);
    if (name == "const") return value_ == rule;
    if (name == "enum") return std::count(rule.begin(), rule.end(), value_) > 0;
    if (name == "not") return !under(rule);
    if (name == "if") return !under(rule) || under(schema_.at("then"));
    if (name == "allOf") return count(rule) == rule.size();
    if (name == "anyOf") return count(rule) > 0;
    if (name == "oneOf") return count(rule) == 1;
    if (name == "minimum") return !value_.is_number() || value_ >= rule;
    if (name == "maximum") return !value_.is_number() || value_ <= rule;
    if (name == "minLength") return !value_.is_string() || value_.get<std::string>().size() >= rule;
    if (name == "minItems") return !value_.is_array() || value_.size() >= rule;
    if (name == "maxItems") return !value_.is_array() || value_.size() <= rule;
    if (name == "items") return items(rule);
    if (name == "required") return !value_.is_object() || required(rule);
    if (name == "properties") return !value_.is_object() || properties(rule);
    if (name == "additionalProperties") return !value_.is_object() || only_known();
    if (name == "pattern") return !value_.is_string() || matches(rule);
    throw std::invalid_argument("unknown keyword " + name);
  }

 private:
  bool under(const json& schema) const { return valid(root_, schema, value_); }

  bool is(const json& type) const {
    if (type == "object") return value_.is_object();
    if (type == "array") return value_.is_array();
    if (type == "string") return value_.is_string();
    if (type == "boolean") return value_.is_boolean();
    if (type == "number") return value_.is_number();
    if (type != "integer") throw std::invalid_argument("unknown type " + type.dump());
    return value_.is_number() && value_.get<double>() == std::floor(value_.get<double>());
  }

  std::size_t count(const json& schemas) const {
    return static_cast<std::size_t>(
        std::count_if(schemas.begin(), schemas.end(), [this](const json& schema) { return under(schema); }));
  }

  bool items(const json& schema) const {
    if (!value_.is_array()) return true;
    return std::all_of(value_.begin(), value_.end(),
                       [&](const json& item) { return valid(root_, schema, item); });
  }

  bool required(const json& names) const {
    return std::all_of(names.begin(), names.end(),
                       [this](const json& name) { return value_.contains(name.get<std::string>()); });
  }

  bool properties(const json& schemas) const {
    for (const auto& [name, schema] : schemas.items()) {
      if (value_.contains(name) && !valid(root_, schema, value_[name])) return false;
    }
    return true;
  }

  bool only_known() const {
    for (const auto& member : value_.items()) {
      if (!schema_.at("properties").contains(member.key())) return false;
    }
    return true;
  }

  bool matches(const json& pattern) const {
    if (pattern != "^[^\\u0000-\\u001f\\u007f-\\u009f]*$") throw std::invalid_argument("unknown pattern");
    return !has_control_character(value_.get<std::string>());
  }

  const json& root_;
  const json& schema_;
  const json& value_;
};

}  // namespace

bool valid(const json& root, const json& schema, const json& value) {
  const Keyword keyword(root, schema, value);
  for (const auto& [name, rule] : schema.items()) {
    if (!keyword.holds(name, rule)) return false;
  }
  return true;
}

}  // namespace plumb::test
