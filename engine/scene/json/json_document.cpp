#include "engine/scene/json/json_document.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/core/text.h"

namespace plumb::json {
namespace {

/// The lexer's line numbers.
struct Cursor {
  int line = 1;        ///< of the next character
  int token_line = 1;  ///< of the last character that is not white space
};

/// Iterator over the text that counts lines. The lexer reads one character beyond a number, so the line of a
/// token is that of the last character that is not white space.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Cursor* cursor) : at_(at), cursor_(cursor) {}

  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    if (*at_ == '\n') {
      ++cursor_->line;
    } else if (*at_ != ' ' && *at_ != '\t' && *at_ != '\r') {
      cursor_->token_line = cursor_->line;
    }
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  Cursor* cursor_;
};

/// Returns the first member, in the order of the text, whose key has occurred before; nullptr if keys are
/// unique.
const Node* find_duplicate(const Node& object) {
  std::vector<const Node*> sorted;
  for (const Node& item : object.items) sorted.push_back(&item);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Node* a, const Node* b) { return a->key < b->key; });
  const Node* first = nullptr;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    // Members lie in one array, so the smaller address comes first in the text.
    if (sorted[i]->key == sorted[i - 1]->key && (first == nullptr || sorted[i] < first)) first = sorted[i];
  }
  return first;
}

/// Extracts "while parsing object key: unexpected '}'; expected string literal" from the library's
/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing object key -
/// ..."
std::string explain(std::string message) {
  constexpr std::string_view kIntroduction = "syntax error ";
  if (const auto at = message.find(kIntroduction); at != std::string::npos) {
    message.erase(0, at + kIntroduction.size());
  }
  if (const auto dash = message.find(" - "); dash != std::string::npos) message.replace(dash, 3, ": ");
  // A comma would be valid there too.
  for (const char bracket : {'}', ']'}) {
    const std::string expected = std::string("; expected '") + bracket + "'";
    if (message.ends_with(expected)) message.insert(message.size() - 3, "',' or ");
  }
  // The library quotes all text that it read last, up to megabytes, and puts the expected token after it.
  constexpr std::size_t kHead = 160, kTail = 80;
  if (message.size() > kHead + kTail) {
    message = printable(message, kHead) + " " + message.substr(message.size() - kTail);
  }
  return "is not JSON: " + printable(message, 2 * (kHead + kTail));
}

/// Builds the tree from the library's events. The functions return true to continue.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(Document& out, const Cursor& cursor) : out_(out), cursor_(cursor) {}

  bool null() override { return add(Kind::Null), true; }
  bool boolean(bool value) override { return add(Kind::Boolean).number = value ? 1 : 0, true; }
  bool number_integer(number_integer_t value) override {
    // Only numbers with a sign get here, so this zero was "-0".
    Node& node = add(Kind::Number);
    node.number = value == 0 ? -0.0 : static_cast<double>(value);
    node.bits = static_cast<std::uint64_t>(value);
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    Node& node = add(Kind::Number);
    node.number = static_cast<double>(value), node.bits = value;
    return true;
  }
  bool number_float(number_float_t value, const string_t& text) override {
    // Whole numbers that 64 bits cannot hold get here.
    Node& node = add(Kind::Number);
    node.number = value, node.beyond_64_bits = text.find_first_of(".eE") == string_t::npos;
    return true;
  }
  bool string(string_t& value) override { return add(Kind::String).text = std::move(value), true; }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(Kind::Object); }
  bool start_array(std::size_t) override { return open(Kind::Array); }
  bool key(string_t& value) override {
    key_ = std::move(value);
    key_line_ = cursor_.token_line;
    return true;
  }
  bool end_object() override {
    if (const Node* twice = find_duplicate(*open_.back())) {
      set_error(excerpt(*twice), "is given twice under this key", twice->key_line, Error::Kind::Syntax);
      out_.error->path.push_back(twice);
      return false;
    }
    open_.pop_back();
    return true;
  }
  bool end_array() override {
    open_.pop_back();
    return true;
  }

  bool parse_error(std::size_t, const std::string& token,
                   const nlohmann::detail::exception& exception) override {
    constexpr int kNumberOverflow = 406;
    if (exception.id == kNumberOverflow) {
      const Node& number = add(Kind::Number);
      set_error(printable(token), "must be a number that a double can hold: at most 1.8e308", number.line,
                Error::Kind::Value);
      out_.error->path.push_back(&number);
    } else {
      set_error("", explain(exception.what()), cursor_.token_line, Error::Kind::Syntax);
      out_.error->path.clear();
    }
    return false;
  }

 private:
  Node& add(Kind kind) {
    Node* node = &out_.root;
    if (!open_.empty()) node = &open_.back()->items.emplace_back();
    node->kind = kind;
    node->line = cursor_.token_line;
    node->key = std::exchange(key_, {});
    node->key_line = key_line_;
    return *node;
  }

  /// Pointers in `open_` stay valid. An array moves its items only when one is added, and at that time none
  /// of them is open.
  bool open(Kind kind) {
    open_.push_back(&add(kind));
    if (open_.size() <= kMaxNesting) return true;
    set_error("", "nests arrays and objects deeper than " + std::to_string(kMaxNesting), cursor_.token_line,
              Error::Kind::Syntax);
    out_.error->path.clear();
    return false;
  }

  void set_error(std::string value, std::string problem, int line, Error::Kind kind) {
    out_.error = {{open_.begin(), open_.end()}, std::move(value), std::move(problem), line, kind};
  }

  Document& out_;
  const Cursor& cursor_;
  std::vector<Node*> open_;  ///< arrays and objects that are not closed yet
  std::string key_;          ///< of the next value
  int key_line_ = 0;
};

/// Returns the problem if the text contains foreign bytes (a byte order mark, invalid UTF-8), else an empty
/// string. Sets `at` to its position.
std::string find_foreign_bytes(std::string_view text, std::size_t& at) {
  at = 0;
  if (text.size() > kMaxTextSize) {
    return "is too long: " + std::to_string(text.size()) + " bytes where " + std::to_string(kMaxTextSize) +
           " are allowed";
  }
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return "is empty: a JSON object is expected";
  if (text.starts_with("\xEF\xBB\xBF")) return "starts with a byte order mark: save it as UTF-8 without one";
  if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE")) return "is UTF-16: save it as UTF-8";
  at = text.find('\0');
  return at == std::string_view::npos ? "" : "is not JSON: it holds a zero byte";
}

void append_excerpt(std::string& out, const Node& node, std::size_t limit) {
  if (out.size() > limit) return;
  if (node.kind == Kind::Null) out += "null";
  if (node.kind == Kind::Boolean) out += node.number != 0 ? "true" : "false";
  if (node.kind == Kind::Number) out += shortest(node.number);
  if (node.kind == Kind::String) out += "\"" + node.text.substr(0, limit + 4) + "\"";
  if (node.kind != Kind::Array && node.kind != Kind::Object) return;
  const bool array = node.kind == Kind::Array;
  out += array ? '[' : '{';
  for (const Node& item : node.items) {
    if (&item != &node.items.front()) out += ", ";
    if (!array) out += "\"" + item.key.substr(0, limit) + "\": ";
    append_excerpt(out, item, limit);
    if (out.size() > limit) return;
  }
  out += array ? ']' : '}';
}

}  // namespace

const Node* Node::find(std::string_view name) const {
  if (kind != Kind::Object) return nullptr;
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Node& item) { return item.key == name; });
  return found == items.end() ? nullptr : &*found;
}

void parse(std::string_view text, Document& out) {
  out = {};
  std::size_t at = 0;
  if (std::string problem = find_foreign_bytes(text, at); !problem.empty()) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    out.error = {{}, "", std::move(problem), static_cast<int>(line), Error::Kind::Syntax};
    return;
  }
  Cursor cursor;
  Builder builder(out, cursor);
  nlohmann::json::sax_parse(CountingIterator(text.data(), &cursor),
                            CountingIterator(text.data() + text.size(), &cursor), &builder);
}

std::string excerpt(const Node& node) {
  constexpr std::size_t kLimit = 60;
  std::string out;
  append_excerpt(out, node, kLimit);
  return printable(out, kLimit);
}

}  // namespace plumb::json
