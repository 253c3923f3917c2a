#include "harness/hunt/picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/hunt/outline.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kSide = 480, kHead = 40;  // pixels

struct Window {
  Vec2d low{}, high{};

  Vec2d at(Vec2d p) const {
    const double scale = kSide / std::max(high.x - low.x, high.y - low.y);
    return {(p.x - low.x) * scale, kHead + (high.y - p.y) * scale};
  }
  double scale() const { return kSide / std::max(high.x - low.x, high.y - low.y); }
};

// Returns the bounds of the dynamic bodies at the start, with a margin: bodies that fly off leave the
// picture.
Window window_of(const Case& one) {
  Vec2d low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  for (const Body& body : one.scene.bodies) {
    if (body.type != BodyType::Dynamic) continue;
    low = {std::min(low.x, body.position.x), std::min(low.y, body.position.y)};
    high = {std::max(high.x, body.position.x), std::max(high.y, body.position.y)};
    for (const Shape& shape : body.shapes)
      for (const Outline& outline : outlines_of(shape)) {
        const Outline there = placed(outline, initial_state(body));
        low = {std::min(low.x, there.low.x), std::min(low.y, there.low.y)};
        high = {std::max(high.x, there.high.x), std::max(high.y, there.high.y)};
      }
  }
  if (!(low.x <= high.x)) low = {-1, -1}, high = {1, 1};
  const double most = std::max({high.x - low.x, high.y - low.y, 1e-9});
  const Vec2d middle = 0.5 * (low + high), half{most, most};
  return {middle - half, middle + half};
}

bool drawable(Vec2d p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::abs(p.x) < 1e5 && std::abs(p.y) < 1e5;
}

std::string drawn(const Window& window, const Outline& outline, const std::string& style) {
  std::string points;
  for (const Vec2d p : outline.core) {
    const Vec2d at = window.at(p);
    if (!drawable(at)) return "";
    points += fmt::format("{:.2f},{:.2f} ", at.x, at.y);
  }
  const double radius = outline.radius * window.scale();
  if (outline.core.size() == 1) {
    const Vec2d at = window.at(outline.core.front());
    return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n", at.x, at.y, radius, style);
  }
  return fmt::format("<polygon points=\"{}\" {} stroke-width=\"{:.2f}\" stroke-linejoin=\"round\"/>\n",
                     points, style, std::max(1.0, 2 * radius));
}

std::string bodies(const Case& one, const Window& window, const Sample& sample, const std::string& style) {
  std::string out;
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
    if (!sample.present[i]) continue;
    for (const Shape& shape : one.scene.bodies[i].shapes)
      for (const Outline& outline : outlines_of(shape))
        out += drawn(window, placed(outline, sample.states[i]), style);
  }
  return out;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace

std::string picture(const Case& one, const std::vector<Shown>& motions, const std::string& caption) {
  const Window window = window_of(one);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<text x=\"4\" "
      "y=\"14\">{2}</text>\n",
      kSide * static_cast<double>(motions.size()), kSide + kHead, escaped(caption));
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Motion& motion = motions[i].motion;
    out += fmt::format("<svg x=\"{}\" width=\"{}\" height=\"{}\">\n<text x=\"4\" y=\"32\">{}</text>\n",
                       kSide * static_cast<double>(i), kSide, kSide + kHead, escaped(motions[i].title));
    if (!motion.samples.empty()) {
      out +=
          bodies(one, window, motion.samples.front(), "fill=\"#ddd\" fill-opacity=\"0.6\" stroke=\"#999\"");
      for (std::size_t body = 0; body < one.scene.bodies.size(); ++body) {
        std::string points;
        for (const Sample& sample : motion.samples) {
          const Vec2d at = window.at(sample.states[body].position);
          if (!drawable(at)) break;
          points += fmt::format("{:.1f},{:.1f} ", at.x, at.y);
        }
        out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"#c60\"/>\n", points);
      }
      out += bodies(one, window, motion.samples.back(), "fill=\"#48c\" fill-opacity=\"0.5\" stroke=\"#125\"");
    }
    out += "</svg>\n";
  }
  return out + "</svg>\n";
}

}  // namespace plumb::harness::hunt
