#include "engine/scene/json/json_emitter.h"

#include <cmath>

#include "engine/core/text.h"

namespace plumb::json {

void Emitter::new_line() {
  out_ += '\n';
  out_.append(static_cast<std::size_t>(indent_) * levels_.size(), ' ');
}

void Emitter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) out_ += ',';
  if (level.block) {
    new_line();
  } else if (!level.empty && indent_ >= 0) {
    out_ += ' ';
  }
  level.empty = false;
}

void Emitter::begin(char bracket, Layout layout) {
  separate();
  out_ += bracket;
  levels_.push_back({.block = indent_ >= 0 && layout == Layout::Block});
}

void Emitter::end(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.block && !level.empty) new_line();
  out_ += bracket;
  constexpr std::size_t kPiece = 1 << 16;
  if (!sink_ || out_.size() < kPiece) return;
  sink_(out_);
  out_.clear();
}

void Emitter::key(std::string_view name) {
  string(name);
  out_ += indent_ >= 0 ? ": " : ":";
  after_key_ = true;
}

void Emitter::number(double value) {
  separate();
  failed_ = failed_ || !std::isfinite(value);
  out_ += shortest(value);
}

void Emitter::integer(std::int64_t value) {
  separate();
  out_ += std::to_string(value);
}

void Emitter::boolean(bool value) {
  separate();
  out_ += value ? "true" : "false";
}

void Emitter::string(std::string_view value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  separate();
  failed_ = failed_ || !is_utf8(value);
  out_ += '"';
  for (const char c : value) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out_ += '\\';
      out_ += c;
    } else if (byte < 0x20) {
      out_ += "\\u00";
      out_ += kDigits[byte >> 4];
      out_ += kDigits[byte & 15];
    } else {
      out_ += c;
    }
  }
  out_ += '"';
}

void Emitter::vector(Vec2d value) {
  begin('[', Layout::Inline);
  number(value.x);
  number(value.y);
  end(']');
}

}  // namespace plumb::json
