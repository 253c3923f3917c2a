#include "engine/world/svg_draw.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/text.h"

namespace plumb {
namespace {

struct Style {
  std::string_view name, rules;
};

// By role. Stroke widths do not scale.
constexpr Style kStyles[] = {
    {"static", "fill:#d9d9d2;stroke:#6b6b63"},
    {"kinematic", "fill:#cfd8ea;stroke:#3f5f9f"},
    {"awake", "fill:#f3d9b8;stroke:#b05a10"},
    {"asleep", "fill:#e3e3ee;stroke:#8a8aa5"},
    {"sensor", "fill:#4caf50;fill-opacity:0.15;stroke:#2e7d32;stroke-dasharray:4 3"},
    {"contact", "stroke:#c62828;stroke-width:5"},
    {"normal", "stroke:#c62828"},
    {"impulse", "stroke:#ad1457;stroke-width:2.5"},
    {"box", "fill:none;stroke:#9c27b0;stroke-width:0.6"},
    {"centre", "stroke:#000000"},
    {"joint", "stroke:#00838f;stroke-width:1.6"},
    {"name", "fill:#222222;stroke:none"},
    {"highlight", "fill:#ffeb3b;fill-opacity:0.7;stroke:#f57f17"},
    {"force", "fill:none;stroke:#2e7d32;stroke-width:2"},
    {"aim", "fill:none;stroke:#555555;stroke-dasharray:6 4"},
    {"trail", "fill:none;stroke:#9e9e9e;stroke-width:0.8"},
    {"velocity", "fill:none;stroke:#1e58c8;stroke-width:2"},
};

constexpr int kDigits = 6;

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, kDigits).ptr;
  return {text, end};
}

// In SVG y points down.
std::string pair(Vec2d v) { return number(v.x) + " " + number(v.y == 0 ? 0 : -v.y); }

std::string open(std::string_view element, DrawRole role) {
  return "<" + std::string(element) + " class=\"" + std::string(name_of(role)) + "\" ";
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char each : printable(text)) {
    switch (each) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += each;
    }
  }
  return out;
}

// Returns the unit normal to the right of the direction from a to b.
Vec2d right_of(Vec2d a, Vec2d b) {
  const Vec2d edge = b - a;
  const double length = std::sqrt(length_squared(edge));
  return length > 0 ? (1 / length) * Vec2d{edge.y, -edge.x} : Vec2d{0, -1};
}

}  // namespace

std::string_view name_of(DrawRole role) { return kStyles[static_cast<std::size_t>(role)].name; }

void SvgDraw::extend_bounds(Vec2d point, double radius) {
  const Aabb<double> box{point - Vec2d{radius, radius}, point + Vec2d{radius, radius}};
  bounds_ = empty_ ? box : merged(bounds_, box);
  empty_ = false;
}

// Draws each edge moved outwards, and an arc about each corner.
void SvgDraw::polygon(std::span<const Vec2d> corners, double radius, DrawRole role) {
  const std::size_t count = corners.size();
  const std::string arc = " A" + number(radius) + " " + number(radius) + " 0 0 0 ";
  std::string path;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2d here = corners[i], next = corners[(i + 1) % count];
    const Vec2d out = radius * right_of(here, next);
    extend_bounds(here, radius);
    path += i == 0 ? "M" : radius > 0 ? arc : " L";
    path += pair(here + out);
    if (radius > 0) path += " L" + pair(next + out);
  }
  if (radius > 0 && count > 0)
    path += arc + pair(corners[0] + radius * right_of(corners[0], corners[1 % count]));
  body_ += open("path", role) + "d=\"" + path + " Z\"/>\n";
}

void SvgDraw::circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) {
  extend_bounds(centre, radius);
  body_ += open("circle", role) + "cx=\"" + number(centre.x) + "\" cy=\"" + number(-centre.y) + "\" r=\"" +
           number(radius) + "\"/>\n";
  segment(centre, centre + radius * axis, role);
}

void SvgDraw::capsule(Vec2d start, Vec2d end, double radius, DrawRole role) {
  const Vec2d ends[] = {start, end};
  polygon(ends, radius, role);
}

void SvgDraw::segment(Vec2d start, Vec2d end, DrawRole role) {
  extend_bounds(start, 0), extend_bounds(end, 0);
  body_ += open("path", role) + "d=\"M" + pair(start) + " L" + pair(end) + "\"/>\n";
}

// Draws a line of length 0: its round ends make a dot of the stroke's width.
void SvgDraw::point(Vec2d point, DrawRole role) {
  extend_bounds(point, 0);
  body_ += open("path", role) + "style=\"stroke-width:5\" d=\"M" + pair(point) + " l0 0\"/>\n";
}

void SvgDraw::text(Vec2d point, std::string_view text, DrawRole role) {
  extend_bounds(point, 0);
  body_ += open("text", role) + "x=\"" + number(point.x) + "\" y=\"" + number(-point.y) + "\">" +
           escaped(text) + "</text>\n";
}

std::string SvgDraw::picture(int width) const {
  const double size = std::max(bounds_.upper.x - bounds_.lower.x, bounds_.upper.y - bounds_.lower.y);
  return picture(bounds_.grown(size > 0 ? 0.03 * size : 1), width);
}

std::string SvgDraw::picture(const Aabb<double>& view, int width) const {
  const Vec2d size = view.upper - view.lower;
  const std::string box =
      number(view.lower.x) + " " + number(-view.upper.y) + " " + number(size.x) + " " + number(size.y);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(width) +
                    "\" height=\"" + number(std::ceil(width * size.y / size.x)) + "\" viewBox=\"" + box +
                    "\">\n<style>\npath,circle{vector-effect:non-scaling-stroke;stroke-width:1;"
                    "stroke-linecap:round;stroke-linejoin:round}\ntext{font:" +
                    number(14 * size.x / width) + "px sans-serif}\n";
  for (const Style& style : kStyles)
    out += "." + std::string(style.name) + "{" + std::string(style.rules) + "}\n";
  return out + "</style>\n" + body_ + "</svg>\n";
}

}  // namespace plumb
