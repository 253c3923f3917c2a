#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "engine/core/text.h"

/// JSON for the page; its texts are the program's own.
namespace plumb::web {

inline std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}
/// Returns null for a non-finite value.
inline std::string json_text(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

class JsonList {
 public:
  void add(std::string_view json) {
    if (!inside_.empty()) inside_ += ',';
    inside_ += json;
  }
  std::string text() const { return '[' + inside_ + ']'; }

 private:
  std::string inside_;
};

class JsonObject {
 public:
  JsonObject& add_json(std::string_view name, std::string_view json) {
    if (!inside_.empty()) inside_ += ',';
    inside_ += json_text(name);
    inside_ += ':';
    inside_ += json;
    return *this;
  }
  JsonObject& add(std::string_view name, const std::string& value) {
    return add_json(name, json_text(value));
  }
  JsonObject& add(std::string_view name, double value) { return add_json(name, json_text(value)); }
  std::string text() const { return '{' + inside_ + '}'; }

 private:
  std::string inside_;
};

}  // namespace plumb::web
