// The window itself, on a display of its own, with the events of a mouse and a keyboard sent to it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <thread>

#include "demos/core/registry.h"
#include "demos/window/camera.h"
#include "demos/window/theme.h"
#include "demos/window/ui.h"
#include "tests/app/program.h"
#include "tests/window/pictures.h"

namespace plumb::window {
namespace {

constexpr int kWidth = 1000, kHeight = 640;
constexpr double kQuick = 0.7;  // s, in which a quiet machine shows the window

bool is_there(const char* command) {
  return std::system((std::string("command -v ") + command + " >/dev/null").c_str()) == 0;
}

// An X server without a screen, for as long as the test runs.
class Display {
 public:
  Display() {
    int ends[2];
    if (pipe(ends) != 0) return;
    server_ = fork();
    if (server_ == 0) {
      close(ends[0]);
      const std::string number = std::to_string(ends[1]);
      const int nothing = open("/dev/null", O_WRONLY);
      dup2(nothing, STDERR_FILENO);
      execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1200x800x24", "-nolisten", "tcp",
             "-noreset", "-r", nullptr);
      _exit(127);
    }
    close(ends[1]);
    // To the end of the line: a server that cannot write it dies.
    std::string number;
    for (char c = 0; read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    if (!number.empty()) name_ = ":" + number;
    close(ends[0]);
  }
  ~Display() {
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;
  const std::string& name() const { return name_; }

 private:
  pid_t server_ = -1;
  std::string name_;
};

class RealWindow : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* command : {"Xvfb", "xdotool"})
      if (!is_there(command)) GTEST_SKIP() << command << " is not installed: no window was tried";
    display_.emplace();
    ASSERT_FALSE(display_->name().empty()) << "Xvfb does not start";
    setenv("DISPLAY", display_->name().c_str(), 1);
    setenv("SDL_VIDEODRIVER", "x11", 1);
    setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    // Memory that the libraries of windows keep until the end is not the demos'.
    setenv("ASAN_OPTIONS", "detect_leaks=0", 0);
  }

  // Starts a demo, paused, and waits for its window.
  void start(const std::string& demo) {
    folder_.write("script", "0 key p\n");
    camera_.resize(kWidth, kHeight);
    camera_.fit(demos::make(demo)->view(), Ui::kPanelWidth);
    program_ = std::thread([this, demo] {
      ran_ = app::plumb({"demo", demo, "--width", std::to_string(kWidth), "--height", std::to_string(kHeight),
                         "--script", folder_.path("script"), "--seconds", "60", "--report", "--screenshot",
                         folder_.path("end.png")});
    });
    const auto begin = std::chrono::steady_clock::now();
    // A search meets windows that come and go while the program starts.
    for (int tries = 0; id_.empty() && tries < 100; ++tries) {
      wait(0.1);
      shell("xdotool search --onlyvisible --name '^plumb: ' > " + folder_.path("id"));
      const auto ids = app::lines_of(folder_.read("id"));
      if (!ids.empty()) id_ = ids.front();
    }
    ASSERT_FALSE(id_.empty()) << "no window appeared";
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    slowness_ = std::clamp(took.count() / kQuick, 1.0, 10.0);
    shell("xdotool windowfocus " + id_);
    wait(0.3);
  }

  // Escape quits it.
  void finish() {
    shell("xdotool key Escape");
    program_.join();
  }
  void TearDown() override {
    if (program_.joinable()) finish();
  }

  void move(Vec2d point) {
    const Vec2d pixel = camera_.to_pixel(point);
    shell("xdotool mousemove --window " + id_ + " " + std::to_string(static_cast<int>(pixel.x)) + " " +
          std::to_string(static_cast<int>(pixel.y)));
    wait(0.1);
  }
  void press() { shell("xdotool mousedown 1"), wait(0.1); }
  void release() { shell("xdotool mouseup 1"), wait(0.1); }
  void key(const std::string& name) { shell("xdotool key " + name), wait(0.1); }

  // The middle of the topmost slider's knob.
  Vec2d first_knob(const std::string& demo) {
    app::plumb({"demo", demo, "--headless", "--seconds", "0", "--width", std::to_string(kWidth), "--height",
                std::to_string(kHeight), "--screenshot", folder_.path("start.png")});
    const Canvas picture = read_png(folder_.path("start.png"));
    const auto knob = [](Colour colour) { return colour == Colour{45, 90, 149}; };
    int top = 0;
    const auto in_row = [&](int y) {
      for (int x = 0; x < static_cast<int>(Ui::kPanelWidth); ++x)
        if (knob(picture.at(x, y))) return x;
      return -1;
    };
    while (top < kHeight - 1 && in_row(top) < 0) ++top;
    return {1.0 * in_row(top + 2) + 3, 1.0 * top + 6};
  }

  // Drags from one pixel to another in a row.
  void slide(int y, int from, int to) {
    const auto at = [&](int x) {
      return " mousemove --window " + id_ + " " + std::to_string(x) + " " + std::to_string(y);
    };
    shell("xdotool" + at(from) + pause(0.2) + " mousedown 1" + pause(0.2) + at(to) + pause(0.2) +
          " mouseup 1" + pause(0.2));
  }

  int shell(const std::string& command) {
    return std::system(("timeout 20 " + command + " 2>/dev/null").c_str());
  }
  // A busy machine needs longer for everything, as it did for the window.
  void wait(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(slowness_ * seconds));
  }
  std::string pause(double seconds) const { return " sleep " + std::to_string(slowness_ * seconds); }

  // Of the pixels around a point, how many show a body that moves.
  long bodies_at(const Canvas& picture, Vec2d point, double reach) const {
    const Paint paint = Theme{}.paint(DrawRole::Awake);
    const Vec2d middle = camera_.to_pixel(point);
    const double size = reach * camera_.scale();
    long count = 0;
    for (int y = static_cast<int>(middle.y - size); y <= static_cast<int>(middle.y + size); ++y)
      for (int x = static_cast<int>(middle.x - size); x <= static_cast<int>(middle.x + size); ++x)
        if (picture.at(x, y) == paint.fill || picture.at(x, y) == paint.line) ++count;
    return count;
  }

  app::Folder folder_;
  std::optional<Display> display_;
  Camera camera_;
  std::thread program_;
  std::string id_;
  double slowness_ = 1;
  app::Ran ran_;
};

TEST_F(RealWindow, ADragCarriesTheRagdollAndEscapeQuits) {
  ASSERT_NO_FATAL_FAILURE(start("ragdoll"));
  const auto doll = demos::make("ragdoll");
  // Its hip stands at (1.5, 5); it is carried to the left, where nothing else is.
  const Vec2d from{1.5, 5.0}, to{-1.0, 3.5};
  move(from);
  press();
  key("p");
  for (int i = 1; i <= 10; ++i) move(from + (0.1 * i) * (to - from));
  wait(1.5);
  key("p");
  finish();
  EXPECT_EQ(ran_.code, 0) << ran_.err;
  const Canvas picture = read_png(folder_.path("end.png"));
  EXPECT_GT(bodies_at(picture, to, 0.5), 50) << ran_.out;
  EXPECT_EQ(bodies_at(picture, from, 0.5), 0) << ran_.out;
}

TEST_F(RealWindow, AClickFiresABall) {
  ASSERT_NO_FATAL_FAILURE(start("cannonballs"));
  move({20, 10});
  key("p");
  press();
  release();
  wait(0.3);
  finish();
  EXPECT_EQ(ran_.code, 0) << ran_.err;
  EXPECT_THAT(ran_.out, testing::ContainsRegex("\nballs: [1-9]")) << ran_.out;
}

// Three steps, one back; then the slider for gravity, dragged all the way to the left: from there on the ball
// flies straight. Its fall until then is that of two steps.
TEST_F(RealWindow, KeysAndThePanelWork) {
  ASSERT_NO_FATAL_FAILURE(start("bouncing_ball"));
  for (int i = 0; i < 3; ++i) key("o");
  key("b");
  const Vec2d knob = first_knob("bouncing_ball");
  slide(static_cast<int>(knob.y), static_cast<int>(knob.x), 2);
  for (int i = 0; i < 9; ++i) key("o");
  finish();
  EXPECT_EQ(ran_.code, 0) << ran_.err;
  EXPECT_THAT(ran_.out, testing::HasSubstr("steps  11\n"));
  const auto* const at = std::strstr(ran_.out.c_str(), "\nspeed: ");
  ASSERT_NE(at, nullptr) << ran_.out;
  // Its own way to the right, the fall of two steps, and damping of 0.1 a second.
  const double fall = 9.81 * 2 / 60;
  EXPECT_NEAR(std::atof(at + 8), std::hypot(2.5, fall), 0.05) << ran_.out;
}

// Control and a click, so short that it begins and ends within a frame, on the slider for gravity; without
// gravity the ball flies straight, at 2.5 m/s less the damping of 0.1 a second.
TEST_F(RealWindow, NumbersAreTyped) {
  ASSERT_NO_FATAL_FAILURE(start("bouncing_ball"));
  const std::string row = std::to_string(static_cast<int>(first_knob("bouncing_ball").y));
  shell("xdotool mousemove --window " + id_ + " 60 " + row + pause(0.3) + " keydown ctrl" + pause(0.2) +
        " click 1" + pause(0.3) + " keyup ctrl" + pause(0.2) + " type 0");
  wait(0.2);
  key("Return");
  for (int i = 0; i < 6; ++i) key("o");
  finish();
  EXPECT_EQ(ran_.code, 0) << ran_.err;
  EXPECT_THAT(ran_.out, testing::HasSubstr("steps  6\n"));
  EXPECT_THAT(ran_.out, testing::ContainsRegex("\nspeed: 2.4[78]")) << ran_.out;
}

}  // namespace
}  // namespace plumb::window
