#include "engine/scene/json/json_fields.h"

#include <algorithm>
#include <cmath>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/json/json_place.h"

namespace plumb::json {
namespace {

/// Returns "'circle' or 'box'".
std::string alternatives(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? " or " : ", ";
    out += plumb::quoted(names[i]);
  }
  return out;
}

}  // namespace

std::vector<const Node*> View::path() const {
  std::vector<const Node*> out;
  for (const View* view = this; view != nullptr; view = view->parent_) out.push_back(view->node_);
  std::reverse(out.begin(), out.end());
  return out;
}

void View::fail(Error::Kind kind, const std::string& problem) const { fail_at(node_->line, kind, problem); }

void View::fail_at(int line, Error::Kind kind, const std::string& problem) const {
  const Naming naming = naming_of(path());
  const bool name = kind == Error::Kind::Name && node_->kind == Kind::String;
  throw Error(kind, naming.subject, naming.field, name ? printable(node_->text) : excerpt(*node_), problem,
              line);
}

double number(const View& view) {
  if (view.node().kind != Kind::Number) view.fail(Error::Kind::Syntax, "must be a number");
  return view.node().number;
}

bool boolean(const View& view) {
  if (view.node().kind != Kind::Boolean) view.fail(Error::Kind::Syntax, "must be true or false");
  return view.node().number != 0;
}

std::string string(const View& view) {
  if (view.node().kind != Kind::String) view.fail(Error::Kind::Syntax, "must be a string");
  return view.node().text;
}

Vec2d vector(const View& view) {
  constexpr auto kProblem = "must be [x, y], two numbers";
  const std::vector<Node>& items = view.node().items;
  if (view.node().kind != Kind::Array || items.size() != 2) view.fail(Error::Kind::Syntax, kProblem);
  for (const Node& item : items) {
    if (item.kind != Kind::Number) view.fail_at(item.line, Error::Kind::Syntax, kProblem);
  }
  return {items[0].number, items[1].number};
}

double integer(const View& view, double lowest, double highest) {
  const double value = number(view);
  if (value >= lowest && value <= highest && value == std::floor(value)) return value;
  view.fail(Error::Kind::Value,
            "must be a whole number from " + shortest(lowest) + " to " + shortest(highest));
}

std::uint64_t bits(const View& view) {
  const double value = number(view);
  if (value == 0 || view.node().bits != 0) return view.node().bits;
  // Written with a fraction or an exponent, as 4.0 or 1e3.
  constexpr double kLowest = -9223372036854775808.0, kEnd = 18446744073709551616.0;
  if (view.node().beyond_64_bits || !(value >= kLowest && value < kEnd) || value != std::floor(value))
    view.fail(Error::Kind::Value, "must be a whole number from -2^63 to 2^64 - 1");
  return value < 0 ? static_cast<std::uint64_t>(static_cast<std::int64_t>(value))
                   : static_cast<std::uint64_t>(value);
}

std::size_t choice(const View& view, std::span<const std::string_view> names) {
  const std::vector<std::string> known(names.begin(), names.end());
  const auto found = std::find(known.begin(), known.end(), string(view));
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  view.fail(Error::Kind::Name, "must be " + alternatives(known) + did_you_mean(view.node().text, known));
}

Fields::Fields(const View& view, std::string_view what, const Keys& keys) : view_(view), what_(what) {
  if (view.node().kind != Kind::Object) view.fail(Error::Kind::Syntax, "must be an object {...}");
  for (const Node& item : view.node().items) {
    if (std::find(keys.begin(), keys.end(), item.key) != keys.end()) continue;
    const std::vector<std::string> known(keys.begin(), keys.end());
    View(item, view)
        .fail_at(item.key_line, Error::Kind::Syntax,
                 "is not a field of " + std::string(what) + did_you_mean(item.key, known));
  }
}

View Fields::required(std::string_view key) const {
  if (const Node* member = view_.node().find(key)) return View(*member, view_);
  const Naming naming = naming_of(view_.path());
  const std::string field = naming.field.empty() ? std::string(key) : naming.field + "." + std::string(key);
  throw Error(Error::Kind::Syntax, naming.subject, field, "absent", "must be given for " + std::string(what_),
              view_.node().line);
}

}  // namespace plumb::json
