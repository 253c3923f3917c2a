#include "demos/window/screen.h"

#include <SDL.h>
#include <SDL_opengl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "engine/scene/error.h"

namespace plumb::window {
namespace {

constexpr Uint32 kFormat = SDL_PIXELFORMAT_RGB888;  // 0x00rrggbb, as `packed` without its alpha

// Returns true if drawing uses a graphics card instead of a software library.
bool has_card(const SDL_RendererInfo& info) {
  const std::string_view name = info.name;
  if ((info.flags & SDL_RENDERER_ACCELERATED) == 0) return false;
  if (!name.starts_with("opengl")) return true;
  using GetString = const GLubyte*(APIENTRY*)(GLenum);
  const auto get_string = reinterpret_cast<GetString>(SDL_GL_GetProcAddress("glGetString"));
  const GLubyte* text = get_string != nullptr ? get_string(GL_RENDERER) : nullptr;
  if (text == nullptr) return false;
  const std::string_view card = reinterpret_cast<const char*>(text);
  return !std::ranges::any_of(std::initializer_list<std::string_view>{"llvmpipe", "softpipe", "swrast"},
                              [&](std::string_view soft) { return card.find(soft) != card.npos; });
}

}  // namespace

void fail_without_window(const std::string& subject, const std::string& problem, const std::string& why) {
  throw Error(Error::Kind::Io, subject, "", "",
              fmt::format("{}: {}; without one: --headless --seconds T --screenshot FILE", problem, why));
}

void Screen::Destroy::operator()(SDL_Renderer* renderer) const { SDL_DestroyRenderer(renderer); }
void Screen::Destroy::operator()(SDL_Texture* texture) const { SDL_DestroyTexture(texture); }

Screen::Screen(SDL_Window* window, bool vsync) : window_(window) {
  Uint32 flags = SDL_RENDERER_ACCELERATED;
  if (vsync) flags |= SDL_RENDERER_PRESENTVSYNC;
  renderer_.reset(SDL_CreateRenderer(window, -1, flags));
  SDL_RendererInfo info{};
  if (renderer_ != nullptr && SDL_GetRendererInfo(renderer_.get(), &info) == 0 && has_card(info)) {
    vsync_ = (info.flags & SDL_RENDERER_PRESENTVSYNC) != 0;
    return;
  }
  renderer_.reset();
  // Keeps SDL from drawing the surface with the software library again.
  SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  if (SDL_GetWindowSurface(window) != nullptr) return;
  renderer_.reset(SDL_CreateRenderer(window, -1, 0));
  if (renderer_ == nullptr) fail_without_window("a window", "cannot be drawn to", SDL_GetError());
}

void Screen::show(const Canvas& canvas) {
  if (renderer_ == nullptr) return show_on_surface(canvas);
  if (texture_width_ != canvas.width() || texture_height_ != canvas.height()) {
    texture_width_ = canvas.width(), texture_height_ = canvas.height();
    texture_.reset(SDL_CreateTexture(renderer_.get(), kFormat, SDL_TEXTUREACCESS_STREAMING, texture_width_,
                                     texture_height_));
    if (texture_ == nullptr) fail_without_window("a window", "cannot be drawn to", SDL_GetError());
  }
  SDL_UpdateTexture(texture_.get(), nullptr, canvas.pixels().data(), canvas.width() * 4);
  SDL_RenderCopy(renderer_.get(), texture_.get(), nullptr, nullptr);
  SDL_RenderPresent(renderer_.get());
}

void Screen::show_on_surface(const Canvas& canvas) {
  SDL_Surface* surface = SDL_GetWindowSurface(window_);  // changes with the window's size
  if (surface == nullptr) fail_without_window("a window", "cannot be drawn to", SDL_GetError());
  SDL_LockSurface(surface);
  SDL_ConvertPixels(std::min(canvas.width(), surface->w), std::min(canvas.height(), surface->h), kFormat,
                    canvas.pixels().data(), canvas.width() * 4, surface->format->format, surface->pixels,
                    surface->pitch);
  SDL_UnlockSurface(surface);
  SDL_UpdateWindowSurface(window_);
}

}  // namespace plumb::window
