#include "demos/window/script.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "engine/core/suggest.h"
#include "engine/scene/error.h"

namespace plumb::window {
namespace {

using Kind = Deed::Kind;

// Arguments of a command: a point, a number, a text up to the end of the line.
struct Syntax {
  std::string_view word;
  Kind kind;
  bool point, number, text;
};
constexpr std::array kSyntax = {
    Syntax{"press", Kind::Press, true, false, false},     Syntax{"drag", Kind::Drag, true, false, false},
    Syntax{"release", Kind::Release, true, false, false}, Syntax{"hover", Kind::Hover, true, false, false},
    Syntax{"key", Kind::Key, false, false, true},         Syntax{"set", Kind::Set, false, false, true},
    Syntax{"show", Kind::Show, false, false, true},       Syntax{"wheel", Kind::Wheel, true, true, false},
    Syntax{"picture", Kind::Picture, false, false, true}, Syntax{"scene", Kind::Scene, false, false, true},
};

struct Option {
  std::string_view name;
  bool& (*of)(Player& player);
};
constexpr std::array kOptions = {
    Option{"contacts", [](Player& player) -> bool& { return player.options.contacts; }},
    Option{"normals", [](Player& player) -> bool& { return player.options.normals; }},
    Option{"impulses", [](Player& player) -> bool& { return player.options.impulses; }},
    Option{"boxes", [](Player& player) -> bool& { return player.options.boxes; }},
    Option{"centres", [](Player& player) -> bool& { return player.options.centres; }},
    Option{"joints", [](Player& player) -> bool& { return player.options.joints; }},
    Option{"names", [](Player& player) -> bool& { return player.options.names; }},
    Option{"velocities", [](Player& player) -> bool& { return player.motion.velocities; }},
    Option{"forces", [](Player& player) -> bool& { return player.motion.forces; }},
    Option{"masses", [](Player& player) -> bool& { return player.motion.masses; }},
    Option{"code", [](Player& player) -> bool& { return player.code; }},
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view next_word(std::string_view& rest) {
  rest = trimmed(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest = trimmed(rest.substr(word.size()));
  return word;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return {};
  return value;
}

// Parses one line of a script; throws on errors.
class Line {
 public:
  Line(std::string_view text, const std::string& file, int number)
      : rest_(text), file_(file), number_(number) {}

  Deed deed() {
    Deed out;
    out.time = number("a time in s");
    if (out.time < 0) fail("the time is negative");
    const std::string word(next_word(rest_));
    const auto* const syntax = std::ranges::find(kSyntax, word, &Syntax::word);
    if (syntax == kSyntax.end()) {
      std::vector<std::string> words;
      for (const Syntax& each : kSyntax) words.emplace_back(each.word);
      fail("'" + word + "' is no command" + did_you_mean(word, words));
    }
    out.kind = syntax->kind;
    if (syntax->point) {
      out.point.x = number("x in m");
      out.point.y = number("y in m");
    }
    if (syntax->number) out.turns = number("how many turns");
    if (syntax->text) {
      out.text = rest_;
      if (rest_.empty()) fail("'" + word + "' lacks what it is for");
    } else if (!rest_.empty()) {
      fail("'" + std::string(rest_) + "' is too much");
    }
    return out;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(Error::Kind::Syntax, "script '" + file_ + "'", "", "", problem, number_);
  }

 private:
  double number(const std::string& what) {
    const std::string word(next_word(rest_));
    const std::optional<double> value = number_of(word);
    if (!value) fail(what + " is expected, not '" + word + "'");
    return *value;
  }

  std::string_view rest_;
  const std::string& file_;
  int number_;
};

}  // namespace

std::vector<Deed> parse_script(std::string_view text, const std::string& file) {
  std::vector<Deed> deeds;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view whole = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(whole.size() + 1, text.size()));
    const std::string_view content = trimmed(whole);
    if (content.empty() || content.front() == '#') continue;
    Line line(content, file, number);
    deeds.push_back(line.deed());
    if (deeds.size() > 1 && deeds.back().time < deeds[deeds.size() - 2].time)
      line.fail("this is earlier than the line before");
  }
  return deeds;
}

void assign(demos::Demo& demo, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos)
    throw Error(Error::Kind::Syntax, "setting '" + std::string(assignment) + "'", "", "",
                "is not of the form NAME=VALUE");
  const std::string_view name = trimmed(assignment.substr(0, equals));
  const std::string_view value = trimmed(assignment.substr(equals + 1));
  const demos::Control& control = demo.control(name);
  if (const std::optional<double> number = number_of(value)) return demo.set(name, *number);
  if (control.kind == demos::Control::Kind::Switch && (value == "on" || value == "off"))
    return demo.set(name, value == "on" ? 1.0 : 0.0);
  demo.set(name, value);
}

void show(Player& player, std::string_view name) {
  const auto* const found = std::ranges::find(kOptions, name, &Option::name);
  if (found == kOptions.end()) {
    std::vector<std::string> names;
    std::string all;
    for (const Option& option : kOptions) {
      names.emplace_back(option.name);
      all += (all.empty() ? "" : ", ") + names.back();
    }
    throw Error(Error::Kind::Name, "drawing '" + std::string(name) + "'", "", "",
                "is none of " + all + did_you_mean(name, names));
  }
  found->of(player) = true;
}

double zoom_factor(double turns) { return std::pow(1.15, turns); }

std::optional<Command> act(Player& player, const Deed& deed) {
  switch (deed.kind) {
    case Kind::Press:
      player.press(deed.point);
      break;
    case Kind::Drag:
      player.drag(deed.point);
      break;
    case Kind::Release:
      player.release(deed.point);
      break;
    case Kind::Hover:
      player.hover(deed.point);
      break;
    case Kind::Key:
      return player.key(deed.text);
    case Kind::Set:
      assign(player.demo(), deed.text);
      break;
    case Kind::Show:
      show(player, deed.text);
      break;
    case Kind::Wheel:
      player.zoom(player.camera.to_pixel(deed.point), zoom_factor(deed.turns));
      break;
    case Kind::Picture:
      return Command::Picture;
    case Kind::Scene:
      return Command::Scene;
  }
  return {};
}

}  // namespace plumb::window
