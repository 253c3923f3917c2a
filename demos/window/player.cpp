#include "demos/window/player.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "demos/core/source.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"

namespace plumb::window {
namespace {

constexpr std::array kKeys = {
    CommandKey{"p", Command::Pause, "P", "pause, go on"},
    CommandKey{"o", Command::Step, "O", "one step"},
    CommandKey{"b", Command::Back, "B", "one step back"},
    CommandKey{"r", Command::Restart, "R", "restart"},
    CommandKey{"s", Command::Slow, "S", "slow motion"},
    CommandKey{"[", Command::Previous, "[", "previous demo"},
    CommandKey{"]", Command::Next, "]", "next demo"},
    CommandKey{"tab", Command::Panel, "Tab", "this panel"},
    CommandKey{"v", Command::Code, "V", "the code of the demo"},
    CommandKey{"w", Command::Scene, "W", "write this state as a scene (JSON)"},
    CommandKey{"home", Command::Home, "Home", "show everything"},
    CommandKey{"f12", Command::Picture, "F12", "this frame as a PNG file"},
    CommandKey{"escape", Command::Quit, "Esc", "quit"},
};

}  // namespace

std::span<const CommandKey> command_keys() { return kKeys; }

Player::Player(std::vector<Item> items, std::size_t first) : items_(std::move(items)) { open(first); }

void Player::open(std::size_t place) {
  show_ = items_.at(place).make();  // throws before the old one is replaced
  place_ = place;
  pressed_ = false;
  message.clear();
  history_.clear();
  series_.clear();
  const std::string& name = demo().about().name;
  code_text_ = demos::source_of(name);
  if (!code_text_.empty()) {
    code_text_ = "// demos/core/" + name + ".cpp\n" + code_text_;
  } else if (const std::optional<Scene> scene = demo().scene()) {
    code_text_ = to_json(*scene);
  } else {
    code_text_ = "There is no code of this demo here.";
  }
  remember();
  home();
}

void Player::choose(std::size_t place) {
  guarded([&] { open(place); });
}

std::optional<Command> Player::key(std::string_view name) {
  const auto found = std::ranges::find(kKeys, name, &CommandKey::key);
  if (found == kKeys.end()) {
    if (name.size() == 1) guarded([&] { demo().key(name.front()); });
    return {};
  }
  switch (found->command) {
    case Command::Pause:
      paused = !paused;
      break;
    case Command::Step:
      step();
      break;
    case Command::Back:
      back();
      break;
    case Command::Restart:
      restart();
      break;
    case Command::Slow:
      slow = !slow;
      break;
    case Command::Previous:
      choose((place_ + items_.size() - 1) % items_.size());
      break;
    case Command::Next:
      choose((place_ + 1) % items_.size());
      break;
    case Command::Panel:
      panel = !panel;
      break;
    case Command::Home:
      home();
      break;
    case Command::Code:
      code = !code;
      break;
    case Command::Picture:
    case Command::Scene:
    case Command::Quit:
      break;
  }
  return found->command;
}

template <class Act>
void Player::guarded(Act&& act) {
  try {
    act();
  } catch (const Error& error) {
    if (strict) throw;
    message = error.what();
    if (error.kind() == Error::Kind::Run) paused = true;
  }
}

void Player::press(Vec2d point) {
  if (pressed_) return;
  pressed_ = true;
  guarded([&] { demo().press(point); });
}

void Player::drag(Vec2d point) {
  if (pressed_) guarded([&] { demo().drag(point); });
}

void Player::release(Vec2d point) {
  if (!pressed_) return;
  pressed_ = false;
  guarded([&] { demo().release(point); });
}

void Player::hover(Vec2d point) {
  guarded([&] { demo().hover(point); });
}

void Player::set(std::string_view control, double value) {
  guarded([&] {
    demo().set(control, value);
    sample();
  });
}

void Player::advance(double seconds) {
  if (paused) return;
  guarded([&] {
    if (demo().advance(slow ? kSlow * seconds : seconds) > 0) remember();
  });
  follow(seconds);
}

void Player::step() {
  paused = true;
  guarded([&] {
    demo().step_once();
    remember();
  });
}

bool Player::back() {
  paused = true;
  const std::span<const std::byte> state = history_.back();
  if (state.empty()) {
    message = "no earlier state is remembered";
    return false;
  }
  pressed_ = false;
  guarded([&] {
    demo().restore(state);
    sample();
  });
  return true;
}

void Player::restart() {
  pressed_ = false;
  message.clear();
  guarded([&] {
    demo().restart();
    history_.clear();
    series_.clear();
    remember();
  });
}

void Player::remember() {
  history_.push(demo().save());
  sample();
}

void Player::sample() {
  std::vector<demos::Figure> figures = demo().figures();
  if (companion() != nullptr) {
    for (const demos::Figure& figure : companion()->figures(demo())) figures.push_back(figure);
  }
  for (const demos::Figure& figure : figures) {
    auto found = std::ranges::find(series_, figure.name, &Series::name);
    if (found == series_.end()) {
      series_.emplace_back(std::string(figure.name), std::string(figure.unit));
      found = series_.end() - 1;
    }
    found->add(demo().time(), figure.value);
  }
}

void Player::resize(int width, int height, double panel_width, double code_width) {
  if (width == width_ && height == height_ && panel_width == panel_width_ && code_width == code_width_ &&
      panel == panel_was_ && code == code_was_)
    return;
  width_ = width, height_ = height, panel_width_ = panel_width, code_width_ = code_width;
  panel_was_ = panel, code_was_ = code;
  camera.resize(width, height);
  if (at_home_) fit();
}

void Player::fit() { camera.fit(shown_, panel ? panel_width_ : 0, code ? code_width_ : 0); }

void Player::home() {
  shown_ = demo().shown();
  at_home_ = true;
  fit();
}

// Moves to the target with a time constant of a quarter of a second, so that a jump of a body does not make
// the picture jump. Under a pressed pointer the picture stays fixed, or the pointer would pull what it moves
// along with the picture.
void Player::follow(double seconds) {
  constexpr double kCalm = 0.25;  // s
  if (!at_home_ || pressed_) return;
  const Aabb<double> wanted = demo().shown();
  const double share = 1 - std::exp(-seconds / kCalm);
  shown_.lower += share * (wanted.lower - shown_.lower);
  shown_.upper += share * (wanted.upper - shown_.upper);
  fit();
}

void Player::zoom(Vec2d pixel, double factor) {
  camera.zoom(pixel, factor);
  at_home_ = false;
}

void Player::pan(Vec2d pixels) {
  camera.pan(pixels);
  at_home_ = false;
}

}  // namespace plumb::window
