#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "demos/window/run.h"
#include "demos/window/screen.h"
#include "demos/window/stage.h"

namespace plumb::window {
namespace {

constexpr double kFrame = 1000.0 / 60;  // ms

struct Destroy {
  void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
};

struct Video {
  Video() {
    SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
    if (SDL_Init(SDL_INIT_VIDEO) != 0) fail_without_window("the display", "cannot be used", SDL_GetError());
    // Without a display SDL chooses a driver that shows nothing.
    const std::string driver = SDL_GetCurrentVideoDriver();
    const bool nowhere = driver == "offscreen" || driver == "dummy" || driver == "evdev";
    if (!nowhere || SDL_getenv("SDL_VIDEODRIVER") != nullptr) return;
    SDL_Quit();
    fail_without_window("the display", "is not there", "neither DISPLAY nor WAYLAND_DISPLAY is set");
  }
  ~Video() { SDL_Quit(); }
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; });
  return text;
}

std::string name_of(const SDL_Keysym& key) {
  if (key.sym == SDLK_RETURN || key.sym == SDLK_KP_ENTER) return "enter";
  return lower(SDL_GetKeyName(key.sym));
}

// A window that shows a canvas and translates events to the player's actions.
class Window {
 public:
  Window(Player& player, const Options& options, bool vsync) : player_(player), stage_(player, options) {
    window_.reset(SDL_CreateWindow("plumb", SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, options.width,
                                   options.height, SDL_WINDOW_RESIZABLE));
    if (window_ == nullptr) fail_without_window("a window", "cannot be opened", SDL_GetError());
    screen_.emplace(window_.get(), vsync);
    fit_canvas();
    SDL_StartTextInput();
  }

  bool vsync() const { return screen_->vsync(); }
  Stage& stage() { return stage_; }

  // Returns false if the player quits.
  bool handle_events() {
    input_.wheel = 0;
    typed_.clear();
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0)
      if (!handle(event)) return false;
    return true;
  }

  void draw(double seconds) {
    input_.seconds = seconds;
    input_.text = typed_;
    input_.control_key = (SDL_GetModState() & KMOD_CTRL) != 0;
    stage_.frame(input_);
    // A click that began and ended between two frames counts for one frame.
    input_.left = left_down_;
    if (title_ != player_.demo().about().name) {
      title_ = player_.demo().about().name;
      SDL_SetWindowTitle(window_.get(), ("plumb: " + title_).c_str());
    }
  }

  void show() { screen_->show(stage_.canvas); }

 private:
  void fit_canvas() {
    int width = 0, height = 0;
    SDL_GetWindowSize(window_.get(), &width, &height);
    stage_.canvas.resize(width, height);
  }

  bool handle(const SDL_Event& event) {
    switch (event.type) {
      case SDL_QUIT:
        return false;
      case SDL_WINDOWEVENT:
        if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) fit_canvas();
        break;
      case SDL_MOUSEBUTTONDOWN:
      case SDL_MOUSEBUTTONUP:
        handle_button(event.button);
        break;
      case SDL_MOUSEMOTION:
        handle_motion(event.motion);
        break;
      case SDL_MOUSEWHEEL:
        input_.wheel += event.wheel.preciseY;
        if (over_world(input_.pointer.x)) player_.zoom(input_.pointer, zoom_factor(event.wheel.preciseY));
        break;
      case SDL_TEXTINPUT:
        return handle_text(event.text.text);
      case SDL_KEYDOWN:
      case SDL_KEYUP:
        return handle_key(event.key);
      default:
        break;
    }
    return true;
  }

  void handle_button(const SDL_MouseButtonEvent& button) {
    const bool down = button.state == SDL_PRESSED;
    input_.pointer = {1.0 * button.x, 1.0 * button.y};
    const bool ours = over_world(button.x);
    const Vec2d point = player_.camera.to_world(input_.pointer);
    if (button.button == SDL_BUTTON_LEFT) {
      left_down_ = down;
      if (down) input_.left = true;
      if (!down) {
        player_.release(point);
      } else if (ours) {
        player_.press(point);
      }
    } else if (button.button == SDL_BUTTON_RIGHT) {
      input_.right = down;
      panning_ = down && ours;
    }
    // Receive motion outside the window while a button is down.
    SDL_CaptureMouse(player_.pressed() || panning_ ? SDL_TRUE : SDL_FALSE);
  }

  bool over_world(double x) const {
    const double width = stage_.canvas.width();
    return (!player_.panel || x >= Ui::kPanelWidth) && (!player_.code || x < width - Ui::code_width(width));
  }

  void handle_motion(const SDL_MouseMotionEvent& motion) {
    input_.pointer = {1.0 * motion.x, 1.0 * motion.y};
    if (panning_) player_.pan({1.0 * motion.xrel, 1.0 * motion.yrel});
    const Vec2d point = player_.camera.to_world(input_.pointer);
    if (player_.pressed()) {
      player_.drag(point);
    } else if (!panning_ && over_world(motion.x)) {
      player_.hover(point);
    }
  }

  // Handles characters, as the keyboard layout gives them.
  bool handle_text(const char* text) {
    if (stage_.ui.wants_keys()) {
      typed_ += text;
      return true;
    }
    return !stage_.carry_out(player_.key(lower(text)));
  }

  bool handle_key(const SDL_KeyboardEvent& event) {
    const std::string name = name_of(event.keysym);
    const bool down = event.state == SDL_PRESSED;
    stage_.ui.edit_key(name, down && stage_.ui.wants_keys());
    // Single characters arrive as text events.
    if (!down || event.repeat != 0 || stage_.ui.wants_keys() || name.size() < 2) return true;
    return !stage_.carry_out(player_.key(name));
  }

  Player& player_;
  Stage stage_;
  std::unique_ptr<SDL_Window, Destroy> window_;
  std::optional<Screen> screen_;
  PanelInput input_;
  std::string typed_, title_;
  bool panning_ = false, left_down_ = false;
};

void measure(Player& player, Window& window, int frames) {
  FrameTimes times;
  while (times.count() < static_cast<std::size_t>(frames) && window.handle_events()) {
    const double start = now_ms(), processor = processor_ms();
    player.advance(kFrame / 1000);
    const double stepped = now_ms();
    window.draw(kFrame / 1000);
    const double drawn = now_ms();
    window.show();
    times.add({stepped - start, drawn - stepped, now_ms() - drawn, processor_ms() - processor});
  }
  fmt::print("{}", times.report());
}

}  // namespace

void run_in_window(Player& player, const Options& options) {
  const Video video;
  Window window(player, options, options.measured_frames == 0);
  if (options.measured_frames > 0) return measure(player, window, options.measured_frames);
  const double start = now_ms();
  double last = start;
  while (window.handle_events()) {
    const double now = now_ms(), shown = (now - start) / 1000;
    if (window.stage().follow_script(shown)) break;
    player.advance((now - last) / 1000);
    window.draw((now - last) / 1000);
    // A mean over about ten frames can be read.
    const double took = now_ms() - now;
    player.frame_ms += (player.frame_ms > 0 ? 0.1 : 1) * (took - player.frame_ms);
    window.show();
    last = now;
    if (options.seconds >= 0 && shown >= options.seconds) break;
    const double left = kFrame - (now_ms() - now);
    if (!window.vsync() && left > 1) SDL_Delay(static_cast<Uint32>(left));
  }
  if (!options.screenshot.empty()) window.stage().take_picture(options.screenshot);
}

}  // namespace plumb::window
