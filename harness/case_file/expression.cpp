#include "harness/case_file/expression.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <deque>
#include <numbers>
#include <utility>
#include <vector>

#ifdef PLUMB_WITH_MUPARSER
#include <muParser.h>
#endif

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::harness::case_file {
namespace {

constexpr const char* kComponents[] = {"x", "y", "angle", "vx", "vy", "w"};

double component_of(const BodyState& state, int component) {
  const double all[] = {state.position.x, state.position.y, state.angle,
                        state.velocity.x, state.velocity.y, state.angular_velocity};
  return all[component];
}

bool is_name(std::string_view text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; });
}

bool read_number(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  return failure == std::errc{} && stop == end;
}

Error problem(Error::Kind kind, const std::string& text, const std::string& what) {
  return {kind, "formula", "", printable(text), what};
}

#ifdef PLUMB_WITH_MUPARSER
double hypotenuse(double a, double b) { return std::hypot(a, b); }
double modulo(double a, double b) { return a - b * std::floor(a / b); }
double floor_of(double a) { return std::floor(a); }

mu::Parser make_parser() {
  mu::Parser parser;
  parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  parser.DefineFun("hypot", hypotenuse);
  parser.DefineFun("mod", modulo);
  parser.DefineFun("floor", floor_of);
  return parser;
}
#endif

}  // namespace

std::string formula_name(std::string_view name) {
  std::string out;
  for (const unsigned char c : name) out += std::isalnum(c) != 0 && c < 128 ? static_cast<char>(c) : '_';
  if (!out.empty() && std::isdigit(static_cast<unsigned char>(out.front())) != 0)
    out.insert(out.begin(), '_');
  return out;
}

Names::Names(const Scene& scene) {
  symbols_["t"] = {.kind = Kind::Time};
  symbols_["pi"] = {.value = std::numbers::pi};
  symbols_["gravity.x"] = {.value = scene.gravity.x};
  symbols_["gravity.y"] = {.value = scene.gravity.y};
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const std::string name = formula_name(scene.bodies[body].name) + ".";
    const BodyState start = initial_state(scene.bodies[body]);
    for (int component = 0; component < 6; ++component) {
      put(name + kComponents[component], {.kind = Kind::State, .body = body, .component = component});
      put(name + kComponents[component] + "0", {.value = component_of(start, component)});
    }
    if (scene.bodies[body].type != BodyType::Dynamic) continue;
    put(name + "mass", {.value = scene.bodies[body].mass});
    put(name + "inertia", {.value = inertia_of(scene.bodies[body])});
  }
  for (const Joint& joint : scene.joints)
    if (const auto* rod = std::get_if<DistanceJoint>(&joint); rod != nullptr && !rod->name.empty())
      put(formula_name(rod->name) + ".length", {.value = rod->length});
}

// Adds a name. If two objects of the scene have the same name in formulas, neither can be used.
void Names::put(const std::string& name, const Symbol& symbol) {
  const auto [place, fresh] = symbols_.try_emplace(name, symbol);
  if (!fresh) place->second.kind = Kind::Shared;
}

void Names::add(const std::string& name, double value) {
  if (!is_name(name))
    throw problem(Error::Kind::Name, name, "is not a name: use letters, digits and underscores");
  if (!symbols_.try_emplace(name, Symbol{.value = value}).second)
    throw problem(Error::Kind::Name, name, "is already the name of something else");
}

struct Expression::Parts {
  struct Used {
    Names::Symbol symbol;
    double value = 0;
  };
  std::deque<Used> used;  // the parser keeps their addresses
#ifdef PLUMB_WITH_MUPARSER
  mu::Parser parser;
#endif
  bool parsed = false;  // if false, returns the value of the first used name
};

Expression::Expression(const std::string& text, const Names& names) : parts_(std::make_shared<Parts>()) {
  const auto use = [&](const std::string& name) -> Parts::Used& {
    const auto found = names.symbols_.find(name);
    if (found == names.symbols_.end()) {
      std::vector<std::string> known;
      for (const auto& [other, symbol] : names.symbols_) known.push_back(other);
      throw problem(Error::Kind::Name, name, "is unknown here" + did_you_mean(name, known));
    }
    if (found->second.kind == Names::Kind::Shared)
      throw problem(Error::Kind::Name, name,
                    "is ambiguous: two parts of the scene have this name; rename one");
    return parts_->used.emplace_back(Parts::Used{found->second, found->second.value});
  };
  if (double value = 0; read_number(text, value)) {
    parts_->used.push_back({{.value = value}, value});
    return;
  }
  if (names.symbols_.contains(text)) {
    use(text);
    return;
  }
#ifdef PLUMB_WITH_MUPARSER
  try {
    parts_->parsed = true;
    parts_->parser = make_parser();
    parts_->parser.SetExpr(text);
    std::vector<std::string> variables;
    for (const auto& [name, address] : parts_->parser.GetUsedVar()) variables.push_back(name);
    for (const std::string& name : variables) parts_->parser.DefineVar(name, &use(name).value);
    parts_->parser.Eval();  // throws for the remaining kinds of errors
  } catch (const mu::Parser::exception_type& error) {
    throw problem(Error::Kind::Syntax, text, "is not a formula: " + printable(error.GetMsg(), 160));
  }
#else
  throw problem(Error::Kind::Unsupported, text,
                "is a formula, which needs muparser: install libmuparser-dev and build again");
#endif
}

double Expression::at(double time, std::span<const BodyState> states) const {
  for (Parts::Used& used : parts_->used) {
    if (used.symbol.kind == Names::Kind::Time) used.value = time;
    if (used.symbol.kind == Names::Kind::State)
      used.value = component_of(states[used.symbol.body], used.symbol.component);
  }
#ifdef PLUMB_WITH_MUPARSER
  if (parts_->parsed) return parts_->parser.Eval();
#endif
  return parts_->used.front().value;
}

bool Expression::varies() const {
  return std::any_of(parts_->used.begin(), parts_->used.end(),
                     [](const Parts::Used& used) { return used.symbol.kind != Names::Kind::Constant; });
}

}  // namespace plumb::harness::case_file
