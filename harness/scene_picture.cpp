#include "harness/scene_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "harness/report/markup.h"

namespace plumb::harness {
namespace {

using Poses = std::vector<BodyState>;

constexpr double kWide = 360, kHigh = 220, kMargin = 14;  // px
constexpr int kMoments = 73;       // points of a path, so that fast rotation gets a few for each turn
constexpr std::size_t kPaths = 8;  // paths of the bodies that move farthest; more would hide each other
constexpr double kStill = 1e-6;    // a smaller fraction of the picture does not count as motion
constexpr const char* kStyle = R"(
.back{fill:#fff}.still{fill:#d9d9d4;stroke:#8a8a84}.start{fill:none;stroke:#a0a0a8;stroke-dasharray:3 2}
.end{fill:#bcd3ec;stroke:#1c4f86}.path{fill:none;stroke:#c2571a}.rod{fill:none;stroke:#1c1c1a}
.law{fill:none;stroke:#2a8a5c;stroke-dasharray:2 2}
@media(prefers-color-scheme:dark){.back{fill:#16181a}.still{fill:#3a3d40;stroke:#85888b}.start{stroke:#7d8086}
.end{fill:#24466b;stroke:#9cc4f0}.path{stroke:#f0a267}.rod{stroke:#ecebe6}.law{stroke:#6fd3a3}}
)";

/// A box that grows around points, m.
struct Bounds {
  double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
  void add(Vec2d p, double around = 0) {
    x0 = std::min(x0, p.x - around), x1 = std::max(x1, p.x + around);
    y0 = std::min(y0, p.y - around), y1 = std::max(y1, p.y + around);
  }
  bool any() const { return x0 <= x1; }
};

Vec2d placed(const BodyState& pose, Vec2d local) {
  const double c = std::cos(pose.angle), s = std::sin(pose.angle);
  return {pose.position.x + c * local.x - s * local.y, pose.position.y + s * local.x + c * local.y};
}

/// A shape as a ring of corners in its body's frame, with the radius around them, m.
struct Outline {
  std::vector<Vec2d> corners;
  double radius = 0;
  bool closed = true;
};

Outline outline_of(const Shape& shape) {
  Outline out;
  const double c = std::cos(shape.angle), s = std::sin(shape.angle);
  const auto add = [&](Vec2d p) {
    out.corners.push_back({shape.position.x + c * p.x - s * p.y, shape.position.y + s * p.x + c * p.y});
  };
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    add({0, 0}), add({circle->radius, 0});  // the second point is the end of a spoke
    out.radius = circle->radius;
  } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
    const double x = box->width / 2, y = box->height / 2;
    for (const Vec2d p : {Vec2d{-x, -y}, Vec2d{x, -y}, Vec2d{x, y}, Vec2d{-x, y}}) add(p);
  } else if (const auto* capsule = std::get_if<Capsule>(&shape.geometry)) {
    add(capsule->start), add(capsule->end);
    out.radius = capsule->radius;
    out.closed = false;
  } else if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
    for (const Vec2d p : convex_corners(polygon->points)) add(p);
    out.radius = polygon->radius;
  } else if (const auto* segment = std::get_if<Segment>(&shape.geometry)) {
    add(segment->start), add(segment->end);
    out.closed = false;
  } else if (const auto* chain = std::get_if<Chain>(&shape.geometry)) {
    for (const Vec2d p : chain->points) add(p);
    out.closed = chain->closed;
  }
  return out;
}

/// The mapping from metres, y up, to pixels, y down.
struct View {
  double scale = 1, x = 0, y = 0;
  Vec2d at(Vec2d p) const { return {x + scale * p.x, y - scale * p.y}; }
  std::string text(Vec2d p) const {
    const Vec2d q = at(p);
    // Rounds to a tenth, avoids "-0", and stays within the coordinates that browsers draw.
    const auto tidy = [](double v) { return std::clamp(std::round(v * 10) / 10, -1e4, 1e4) + 0.0; };
    return fmt::format("{:g} {:g}", tidy(q.x), tidy(q.y));
  }
};

std::string line_through(const std::vector<Vec2d>& points, const View& view, const char* kind, bool closed) {
  std::string d;
  for (const Vec2d p : points) d += (d.empty() ? "M" : "L") + view.text(p);
  return fmt::format("<path class=\"{}\" d=\"{}{}\"/>\n", kind, d, closed ? "Z" : "");
}

std::string shape_svg(const Shape& shape, const BodyState& pose, const View& view, const char* kind) {
  const Outline outline = outline_of(shape);
  std::vector<Vec2d> corners;
  for (const Vec2d p : outline.corners) corners.push_back(placed(pose, p));
  if (std::holds_alternative<Circle>(shape.geometry)) {
    const Vec2d centre = view.at(corners[0]);
    return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", kind, centre.x,
                       centre.y, std::max(0.8, view.scale * outline.radius)) +
           line_through(corners, view, kind, false);
  }
  if (std::holds_alternative<Capsule>(shape.geometry)) {
    // A rounded box from end to end.
    const Vec2d along = corners[1] - corners[0];
    const double length = std::hypot(along.x, along.y), r = outline.radius;
    const Vec2d side = length > 0 ? Vec2d{-along.y / length * r, along.x / length * r} : Vec2d{0, r};
    const auto arc = [&](Vec2d to) {
      return fmt::format("A{0:.1f} {0:.1f} 0 0 0 {1}", view.scale * r, view.text(to));
    };
    return fmt::format("<path class=\"{}\" d=\"M{}L{}{}L{}{}Z\"/>\n", kind, view.text(corners[0] - side),
                       view.text(corners[1] - side), arc(corners[1] + side), view.text(corners[0] + side),
                       arc(corners[0] - side));
  }
  return line_through(corners, view, kind, outline.closed);
}

// Returns the states of all bodies at times from the start to the end; only the start if there is no truth.
std::vector<Poses> motion_of(const scenarios::Problem& problem) {
  Poses start;
  for (const Body& body : problem.scene.bodies) start.push_back(initial_state(body));
  std::vector<Poses> out{start};
  if (!problem.truth.exact) return out;
  for (int i = 1; i < kMoments; ++i) {
    out.push_back(start);
    problem.truth.exact(problem.duration * i / (kMoments - 1), out.back());
  }
  return out;
}

// Returns the view that contains all positions of moving bodies, with their shapes. The others count only if
// nothing moves.
View view_of(const Scene& scene, const std::vector<Poses>& motion) {
  Bounds bounds;
  const auto add = [&](std::size_t body, const BodyState& pose) {
    bounds.add(pose.position);
    for (const Shape& shape : scene.bodies[body].shapes) {
      const Outline outline = outline_of(shape);
      for (const Vec2d p : outline.corners) bounds.add(placed(pose, p), outline.radius);
    }
  };
  for (const Poses& poses : motion)
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (scene.bodies[i].type != BodyType::Static) add(i, poses[i]);
  if (!bounds.any())
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) add(i, motion.front()[i]);
  if (!bounds.any()) bounds.add({}, 1);
  const double wide = std::max(bounds.x1 - bounds.x0, 1e-9), high = std::max(bounds.y1 - bounds.y0, 1e-9);
  // If the motion is small or straight, the view has additional space: at least a fifth of its length.
  const double room = 0.1 * std::max(wide, high);
  View view;
  view.scale = std::min((kWide - 2 * kMargin) / (wide + 2 * room), (kHigh - 2 * kMargin) / (high + 2 * room));
  view.x = kWide / 2 - view.scale * (bounds.x0 + bounds.x1) / 2;
  view.y = kHigh / 2 + view.scale * (bounds.y0 + bounds.y1) / 2;
  return view;
}

std::optional<Vec2d> end_of(const Scene& scene, const Poses& poses, const std::string& name, Vec2d anchor) {
  if (name == kWorld) return anchor;
  const auto index = find_body(scene, name);
  if (!index) return std::nullopt;
  return placed(poses[*index], anchor);
}

// Lines between the ends of rods, springs and attractions.
std::string links_svg(const Scene& scene, const Poses& poses, const View& view) {
  std::string out;
  const auto link = [&](std::optional<Vec2d> a, std::optional<Vec2d> b, const char* kind) {
    if (a && b) out += line_through({*a, *b}, view, kind, false);
  };
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          if constexpr (requires { j.ground_a; }) {  // a pulley: its rope over both wheels
            link(end_of(scene, poses, j.body_a, j.anchor_a), j.ground_a, "rod");
            link(j.ground_a, j.ground_b, "rod");
            link(j.ground_b, end_of(scene, poses, j.body_b, j.anchor_b), "rod");
          } else if constexpr (requires { j.anchor_a; }) {
            link(end_of(scene, poses, j.body_a, j.anchor_a), end_of(scene, poses, j.body_b, j.anchor_b),
                 "rod");
          }
        },
        joint);
  }
  for (const ForceLaw& law : scene.forces) {
    if (const auto* spring = std::get_if<SpringForce>(&law)) {
      link(end_of(scene, poses, spring->body_a, spring->anchor_a),
           end_of(scene, poses, spring->body_b, spring->anchor_b), "law");
    } else if (const auto* pull = std::get_if<AttractionForce>(&law)) {
      link(end_of(scene, poses, pull->centre_body, pull->centre), end_of(scene, poses, pull->body, {}),
           "law");
    }
  }
  return out;
}

// Draws the paths of the bodies that go farthest.
std::string paths_svg(const Scene& scene, const std::vector<Poses>& motion, const View& view) {
  std::vector<std::pair<double, std::size_t>> lengths;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    double length = 0;
    for (std::size_t k = 1; k < motion.size(); ++k) {
      const Vec2d step = motion[k][i].position - motion[k - 1][i].position;
      length += std::hypot(step.x, step.y);
    }
    if (length * view.scale > kStill * kWide) lengths.emplace_back(-length, i);
  }
  std::ranges::stable_sort(lengths, [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string out;
  for (std::size_t n = 0; n < std::min(kPaths, lengths.size()); ++n) {
    std::vector<Vec2d> points;
    for (const Poses& poses : motion) points.push_back(poses[lengths[n].second].position);
    out += line_through(points, view, "path", false);
  }
  return out;
}

}  // namespace

std::string scene_picture(const scenarios::Problem& problem, const std::string& title) {
  const Scene& scene = problem.scene;
  const std::vector<Poses> motion = motion_of(problem);
  const View view = view_of(scene, motion);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
      "height=\"{1:g}\" "
      "role=\"img\">\n<title>{2}</title>\n<style>{3}</style>\n<rect class=\"back\" width=\"{0:g}\" "
      "height=\"{1:g}\"/>\n",
      kWide, kHigh, report::escaped(title), kStyle);
  const auto draw = [&](std::size_t body, const BodyState& pose, const char* kind) {
    for (const Shape& shape : scene.bodies[body].shapes) out += shape_svg(shape, pose, view, kind);
    if (!scene.bodies[body].shapes.empty()) return;
    const Vec2d centre = view.at(pose.position);
    out +=
        fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", kind, centre.x, centre.y);
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].type == BodyType::Static) draw(i, motion.front()[i], "still");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].type != BodyType::Static && motion.size() > 1) draw(i, motion.front()[i], "start");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].type != BodyType::Static) draw(i, motion.back()[i], "end");
  out += paths_svg(scene, motion, view);
  out += links_svg(scene, motion.back(), view);
  return out + "</svg>\n";
}

}  // namespace plumb::harness
