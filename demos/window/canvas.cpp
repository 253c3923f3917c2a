#include "demos/window/canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::window {
namespace {

constexpr int kMostCorners = 64;

// Interval from `first` to `last`; empty if last < first.
struct Interval {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();
  void reach(double x) {
    first = std::min(first, x);
    last = std::max(last, x);
  }
};

// Convex hull of some corners, with the distance to it.
class Hull {
 public:
  Hull(std::span<const Vec2d> corners, bool sharp) : count_(static_cast<int>(corners.size())), sharp_(sharp) {
    double area = 0;
    for (int i = 0; i < count_; ++i) area += cross(corners[i], corners[(i + 1) % count_]);
    for (int i = 0; i < count_; ++i) corners_[i] = corners[area < 0 ? count_ - 1 - i : i];
    for (int i = 0; i < count_; ++i) {
      const Vec2d along = corners_[(i + 1) % count_] - corners_[i];
      const double size = std::sqrt(length_squared(along));
      normals_[i] = size > 0 ? Vec2d{along.y / size, -along.x / size} : Vec2d{};
    }
  }

  // Returns the distance in px, negative inside. If `sharp`, the edges extend beyond the corners until they
  // meet.
  double distance(Vec2d point) const {
    if (count_ > 2) {
      double highest = -std::numeric_limits<double>::infinity();
      for (int i = 0; i < count_; ++i) highest = std::max(highest, dot(normals_[i], point - corners_[i]));
      if (highest <= 0 || sharp_) return highest;
    }
    if (count_ == 1) return std::sqrt(length_squared(point - corners_[0]));
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < (count_ == 2 ? 1 : count_); ++i) {
      const Vec2d along = corners_[(i + 1) % count_] - corners_[i];
      const double square = dot(along, along);
      const Vec2d from = point - corners_[i];
      const double t = square > 0 ? std::clamp(dot(from, along) / square, 0.0, 1.0) : 0;
      nearest = std::min(nearest, length_squared(from - t * along));
    }
    return std::sqrt(nearest);
  }

  // Returns the part of row `y` within `offset` of the hull. With a negative offset, the part that is at
  // least that deep inside.
  Interval row(double y, double offset) const {
    if (offset < 0) return inner_row(y, -offset);
    Interval out;
    for (int i = 0; i < count_; ++i) {
      const double up = y - corners_[i].y, square = offset * offset - up * up;
      if (square >= 0) {
        const double half = std::sqrt(square);
        out.reach(corners_[i].x - half);
        out.reach(corners_[i].x + half);
      }
      if (count_ == 1) break;
      for (const double side : {offset, -offset}) {
        if (side != offset && count_ > 2) continue;  // a segment has two sides
        const Vec2d a = corners_[i] + side * normals_[i], b = corners_[(i + 1) % count_] + side * normals_[i];
        if ((a.y <= y) != (b.y <= y)) out.reach(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
      }
    }
    return out;
  }

  Interval height(double offset) const {
    Interval out;
    for (int i = 0; i < count_; ++i) {
      out.reach(corners_[i].y - offset);
      out.reach(corners_[i].y + offset);
    }
    return out;
  }

 private:
  Interval inner_row(double y, double depth) const {
    if (count_ < 3) return {};
    Interval out{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int i = 0; i < count_; ++i) {
      // normal . (point - corner) <= -depth
      const Vec2d n = normals_[i];
      const double left = -depth - n.y * (y - corners_[i].y);
      if (n.x > 0) {
        out.last = std::min(out.last, corners_[i].x + left / n.x);
      } else if (n.x < 0) {
        out.first = std::max(out.first, corners_[i].x + left / n.x);
      } else if (left < 0) {
        return {};
      }
    }
    return out;
  }

  int count_;
  bool sharp_;
  Vec2d corners_[kMostCorners], normals_[kMostCorners];
};

// Returns the colour of a pixel at `distance` px from the shape's edge (negative: inside).
std::uint32_t at_edge(std::uint32_t under, double distance, const Paint& paint) {
  const auto cover = [](double d) { return std::clamp(0.5 - d, 0.0, 1.0); };
  const double filled = cover(distance + paint.line_width);
  const double lined = cover(distance) - filled;
  const double fill = filled * paint.fill.a, line = lined * paint.line.a, alpha = fill + line;
  if (alpha < 0.5) return under;
  const auto opacity = static_cast<std::uint32_t>(alpha + 0.5);
  if (fill == 0) return blended(under, packed(paint.line), opacity);
  if (line == 0) return blended(under, packed(paint.fill), opacity);
  const auto mixed = [&](double f, double l) {
    return static_cast<std::uint8_t>((fill * f + line * l) / alpha + 0.5);
  };
  const Colour over{mixed(paint.fill.r, paint.line.r), mixed(paint.fill.g, paint.line.g),
                    mixed(paint.fill.b, paint.line.b)};
  return blended(under, packed(over), opacity);
}

// Pixels of a row of `width` with centres in an interval: [first, last).
struct Span {
  int first = 0, last = 0;
};
Span pixels_in(const Interval& interval, int width) {
  if (!(interval.first <= interval.last)) return {};
  return {static_cast<int>(std::clamp(std::ceil(interval.first - 0.5), 0.0, 1.0 * width)),
          static_cast<int>(std::clamp(std::floor(interval.last - 0.5) + 1, 0.0, 1.0 * width))};
}

}  // namespace

void Canvas::resize(int width, int height) {
  width_ = std::max(width, 1), height_ = std::max(height, 1);
  pixels_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0xff000000u);
}

void Canvas::clear(Colour colour) { std::ranges::fill(pixels_, packed(colour) | 0xff000000u); }

Colour Canvas::at(int x, int y) const {
  return unpacked(
      pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
}

void Canvas::paint(std::span<const Vec2d> corners, double radius, const Paint& paint) {
  if (corners.empty() || corners.size() > kMostCorners) return;
  for (const Vec2d& corner : corners)
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) return;
  const Hull hull(corners, radius == 0);
  const Span rows = pixels_in(hull.height(radius + 0.5), height_);
  const std::uint32_t fill = packed(paint.fill);
  for (int y = rows.first; y < rows.last; ++y) {
    std::uint32_t* row = &pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_)];
    const double middle = y + 0.5;
    const Span outer = pixels_in(hull.row(middle, radius + 0.5), width_);
    // Pixels that are only fill. If there are none, an empty span at the end of the row.
    Span inner = pixels_in(hull.row(middle, radius - paint.line_width - 0.5), width_);
    if (inner.first >= inner.last) inner = {outer.last, outer.last};
    const auto edge = [&](int x) {
      row[x] = at_edge(row[x], hull.distance({x + 0.5, middle}) - radius, paint);
    };
    for (int x = outer.first; x < std::min(inner.first, outer.last); ++x) edge(x);
    if (paint.fill.a == 255) {
      std::fill(row + inner.first, row + inner.last, fill);
    } else if (paint.fill.a > 0) {
      for (int x = inner.first; x < inner.last; ++x) row[x] = blended(row[x], fill, paint.fill.a);
    }
    for (int x = std::max(inner.last, outer.first); x < outer.last; ++x) edge(x);
  }
}

}  // namespace plumb::window
