#include "demos/window/rasteriser.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace plumb::window {
namespace {

// Corners are snapped to a grid of 1/16 px, so that edge functions are exact.
constexpr int kSub = 16;

// Swaps red and blue: ImGui has red in the lowest byte.
std::uint32_t swapped(std::uint32_t c) { return (c & 0xff00ff00u) | (c & 255) << 16 | (c >> 16 & 255); }

struct Clip {
  int left, top, right, bottom;
};

struct Texture {
  const unsigned char* alpha = nullptr;  // of the font texture; its colour is white
  int width = 0, height = 0;

  // Returns the bilinear interpolation, 0..255.
  float at(float u, float v) const {
    const float x = u * static_cast<float>(width) - 0.5f, y = v * static_cast<float>(height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y), fx = x - left, fy = y - top;
    const auto texel = [&](float column, float row) {
      const int i = std::clamp(static_cast<int>(column), 0, width - 1);
      const int j = std::clamp(static_cast<int>(row), 0, height - 1);
      return static_cast<float>(alpha[j * width + i]);
    };
    const float above = texel(left, top) * (1 - fx) + texel(left + 1, top) * fx;
    const float below = texel(left, top + 1) * (1 - fx) + texel(left + 1, top + 1) * fx;
    return above * (1 - fy) + below * fy;
  }
};

// Returns the floor of n / d, d > 0. The next function returns the ceiling.
long floor_of(long n, long d) { return n >= 0 ? n / d : -((-n + d - 1) / d); }
long ceil_of(long n, long d) { return -floor_of(-n, d); }

// Half plane to the left of the line from one corner to the next, in units of kSub: a x + b y + c >= least.
struct Edge {
  long a, b, c, least;
};

class Triangle {
 public:
  explicit Triangle(std::array<const ImDrawVert*, 3> corners) : corners_(corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      x_[i] = std::lround(corners_[i]->pos.x * kSub);
      y_[i] = std::lround(corners_[i]->pos.y * kSub);
    }
    area_ = (x_[1] - x_[0]) * (y_[2] - y_[0]) - (x_[2] - x_[0]) * (y_[1] - y_[0]);
    if (area_ < 0) {
      std::swap(corners_[1], corners_[2]);
      std::swap(x_[1], x_[2]);
      std::swap(y_[1], y_[2]);
      area_ = -area_;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const long dx = x_[j] - x_[i], dy = y_[j] - y_[i];
      // A centre on an edge belongs to the triangle below it or to its right.
      const bool owns = dy < 0 || (dy == 0 && dx > 0);
      edges_[i] = {-dy, dx, dy * x_[i] - dx * y_[i], owns ? 0 : 1};
    }
  }

  void paint(const Clip& clip, const Texture& texture, Canvas& canvas) const {
    if (area_ == 0) return;
    const auto [low, high] = std::ranges::minmax(y_);
    const long top = std::max<long>(clip.top, floor_of(low, kSub));
    const long bottom = std::min<long>(clip.bottom, ceil_of(high, kSub) + 1);
    const bool plain = is_plain();
    for (long y = top; y < bottom; ++y) {
      const long middle = y * kSub + kSub / 2;
      long first = clip.left, last = clip.right - 1;  // pixels
      for (const Edge& edge : edges_) {
        // The centre of pixel x is at kSub x + kSub / 2.
        const long at_zero = edge.a * (kSub / 2) + edge.b * middle + edge.c - edge.least,
                   slope = edge.a * kSub;
        if (slope > 0) {
          first = std::max(first, ceil_of(-at_zero, slope));
        } else if (slope < 0) {
          last = std::min(last, floor_of(at_zero, -slope));
        } else if (at_zero < 0) {
          last = first - 1;
        }
      }
      if (first > last) continue;
      std::uint32_t* row = &canvas.pixels()[static_cast<std::size_t>(y * canvas.width())];
      if (plain) {
        paint_plain(row, first, last);
      } else {
        paint_mixed(row, first, last, middle, texture);
      }
    }
  }

 private:
  // Returns true if there is a single colour and texture point, which is then the white one.
  bool is_plain() const {
    const ImDrawVert &p = *corners_[0], &q = *corners_[1], &r = *corners_[2];
    return p.col == q.col && p.col == r.col && p.uv.x == q.uv.x && p.uv.x == r.uv.x && p.uv.y == q.uv.y &&
           p.uv.y == r.uv.y;
  }

  void paint_plain(std::uint32_t* row, long first, long last) const {
    const std::uint32_t colour = swapped(corners_[0]->col), alpha = colour >> 24;
    if (alpha == 255) {
      std::fill(row + first, row + last + 1, colour);
    } else if (alpha > 0) {
      for (long x = first; x <= last; ++x) row[x] = blended(row[x], colour, alpha);
    }
  }

  void paint_mixed(std::uint32_t* row, long first, long last, long middle, const Texture& texture) const {
    const float whole = 1.0f / static_cast<float>(area_);
    for (long x = first; x <= last; ++x) {
      // A corner's weight is proportional to the area opposite to it.
      float weight[3];
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge& across = edges_[(i + 1) % 3];
        weight[i] =
            whole * static_cast<float>(across.a * (x * kSub + kSub / 2) + across.b * middle + across.c);
      }
      float u = 0, v = 0, channel[4] = {};
      for (std::size_t i = 0; i < 3; ++i) {
        u += weight[i] * corners_[i]->uv.x, v += weight[i] * corners_[i]->uv.y;
        for (std::size_t k = 0; k < 4; ++k)
          channel[k] += weight[i] * static_cast<float>(corners_[i]->col >> (8 * k) & 255);
      }
      const auto byte = [](float value) {
        return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 255.0f) + 0.5f);
      };
      const std::uint8_t alpha = byte(channel[3] * texture.at(u, v) / 255);
      if (alpha > 0)
        row[x] = blended(row[x], packed({byte(channel[0]), byte(channel[1]), byte(channel[2])}), alpha);
    }
  }

  std::array<const ImDrawVert*, 3> corners_;
  std::array<long, 3> x_{}, y_{};
  std::array<Edge, 3> edges_{};
  long area_ = 0;  // twice the area of the triangle, in 1/kSub^2 px^2
};

}  // namespace

void rasterise(const ImDrawData& data, ImFontAtlas& atlas, Canvas& canvas) {
  unsigned char* alpha = nullptr;
  Texture texture;
  atlas.GetTexDataAsAlpha8(&alpha, &texture.width, &texture.height);
  texture.alpha = alpha;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const Clip clip{std::max(static_cast<int>(command.ClipRect.x), 0),
                      std::max(static_cast<int>(command.ClipRect.y), 0),
                      std::min(static_cast<int>(command.ClipRect.z), canvas.width()),
                      std::min(static_cast<int>(command.ClipRect.w), canvas.height())};
      if (command.UserCallback != nullptr || clip.left >= clip.right || clip.top >= clip.bottom) continue;
      const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
      const ImDrawVert* vertex = list.VtxBuffer.Data + command.VtxOffset;
      for (unsigned i = 0; i + 2 < command.ElemCount; i += 3)
        Triangle({&vertex[index[i]], &vertex[index[i + 1]], &vertex[index[i + 2]]})
            .paint(clip, texture, canvas);
    }
  }
}

}  // namespace plumb::window
