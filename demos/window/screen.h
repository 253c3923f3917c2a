#pragma once

#include <memory>
#include <string>

#include "demos/window/canvas.h"

struct SDL_Window;
struct SDL_Renderer;
struct SDL_Texture;

namespace plumb::window {

/// Shows a canvas in a window: by the graphics card if there is one. Otherwise passes the pixels to the
/// window system, which is faster than software rendering.
class Screen {
 public:
  /// Throws Error (Io) if nothing can be shown.
  Screen(SDL_Window* window, bool vsync);

  /// Returns true if `show` waits for vertical sync.
  bool vsync() const { return vsync_; }
  /// Shows a canvas of the window's size.
  void show(const Canvas& canvas);

 private:
  struct Destroy {
    void operator()(SDL_Renderer* renderer) const;
    void operator()(SDL_Texture* texture) const;
  };
  void show_on_surface(const Canvas& canvas);

  SDL_Window* window_;
  std::unique_ptr<SDL_Renderer, Destroy> renderer_;
  std::unique_ptr<SDL_Texture, Destroy> texture_;
  int texture_width_ = 0, texture_height_ = 0;
  bool vsync_ = false;
};

/// Throws Error (Io) that explains how to run without a window.
[[noreturn]] void fail_without_window(const std::string& subject, const std::string& problem,
                                      const std::string& why);

}  // namespace plumb::window
