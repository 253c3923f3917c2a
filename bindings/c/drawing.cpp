#include <atomic>
#include <cmath>
#include <cstring>

#include "bindings/c/handle.h"
#include "engine/core/text.h"
#include "engine/world/debug_draw.h"
#include "engine/world/world_data.h"
#ifndef PLUMB_NO_FILES
#include "engine/world/svg_draw.h"
#endif

using namespace plumb::c;
using plumb::BasicWorld;
using plumb::DrawRole;
using plumb::Error;
using plumb::PastPoses;
using plumb::Vec2d;

/// Poses of a world of either precision; empty until they are kept.
struct plumb_past_poses {
  std::variant<std::monostate, PastPoses<float>, PastPoses<double>> poses{};
  mutable std::atomic<int> drawings = 0;  ///< that read them now
};

namespace {

/// Calls the functions of a C program.
class Drawing : public plumb::DebugDraw {
 public:
  explicit Drawing(const plumb_debug_draw& to) : to_(to) {}

  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override {
    if (to_.polygon == nullptr) return;
    corners_.clear();
    for (const Vec2d corner : corners) corners_.push_back(out(corner));
    to_.polygon(corners_.data(), corners_.size(), radius, as(role), to_.context);
  }
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override {
    if (to_.circle != nullptr) to_.circle(out(centre), radius, out(axis), as(role), to_.context);
  }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override {
    if (to_.capsule != nullptr) to_.capsule(out(start), out(end), radius, as(role), to_.context);
  }
  void segment(Vec2d start, Vec2d end, DrawRole role) override {
    if (to_.segment != nullptr) to_.segment(out(start), out(end), as(role), to_.context);
  }
  void point(Vec2d point, DrawRole role) override {
    if (to_.point != nullptr) to_.point(out(point), as(role), to_.context);
  }
  void text(Vec2d point, std::string_view text, DrawRole role) override {
    if (to_.text == nullptr) return;
    text_ = text;
    to_.text(out(point), text_.c_str(), as(role), to_.context);
  }

 private:
  static plumb_draw_role as(DrawRole role) { return static_cast<plumb_draw_role>(role); }

  const plumb_debug_draw& to_;
  std::vector<plumb_vec2> corners_{};
  std::string text_{};
};
static_assert(static_cast<int>(DrawRole::Name) == PLUMB_DRAW_NAME &&
              static_cast<int>(DrawRole::JointLine) == PLUMB_DRAW_JOINT);

plumb::DrawOptions options_of(const plumb_draw_options* options) {
  const plumb_draw_options o = options != nullptr ? *options : plumb_default_draw();
  plumb::DrawOptions result;
  result.shapes = o.shapes, result.joints = o.joints, result.contacts = o.contacts;
  result.normals = o.normals, result.impulses = o.impulses, result.boxes = o.boxes;
  result.centres = o.centres, result.names = o.names;
  result.normal_length = o.normal_length, result.impulse_length = o.impulse_length;
  if (o.bounded) result.bounds = {in(o.bounds.lower), in(o.bounds.upper)};
  return result;
}

/// Returns the poses kept of a world in `Real`; null if none are. Throws Error (Value) for the other
/// precision's.
template <class Real>
const PastPoses<Real>* kept_poses(const plumb_past_poses* past) {
  const auto& poses = require(past, "past poses").poses;
  if (std::holds_alternative<std::monostate>(poses)) return nullptr;
  if (const auto* found = std::get_if<PastPoses<Real>>(&poses)) return found;
  throw Error(Error::Kind::Value, "past poses", "precision", "", "are of a world of another precision");
}

/// Throws Error (Unsupported) while a drawing reads the poses: functions that draw must not change them.
void require_unused(const plumb_past_poses& past) {
  if (past.drawings == 0) return;
  throw Error(Error::Kind::Unsupported, "past poses", "", "",
              "cannot be changed while a drawing reads them; do it afterwards");
}

/// Counts a drawing that reads the poses.
class Reading {
 public:
  explicit Reading(const plumb_past_poses& past) : past_(past) { ++past_.drawings; }
  ~Reading() { --past_.drawings; }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

 private:
  const plumb_past_poses& past_;
};

void require_fraction(double fraction) {
  if (std::isfinite(fraction)) return;
  throw Error(Error::Kind::Value, "past poses", "fraction", plumb::shortest(fraction),
              "must be a number: 0 for the kept poses, 1 for the present ones");
}

/// Returns the pose of the body's origin.
template <class Real>
plumb_pose pose_between(const BasicWorld<Real>& w, const PastPoses<Real>* past, plumb::BodyId body,
                        double fraction) {
  if (past == nullptr) return {out(w.position(body)), w.angle(body)};
  const plumb::BodyPose pose = past->pose_between(w, body, fraction);
  return {out(pose.position), pose.angle};
}

}  // namespace

plumb_past_poses* plumb_past_poses_create(void) {
  return checked_or<plumb_past_poses*>(nullptr, [] { return new plumb_past_poses; });
}
void plumb_past_poses_destroy(plumb_past_poses* past) {
  if (past == nullptr) return;
  checked([&] {
    require_unused(*past);
    delete past;
  });
}
plumb_status plumb_past_poses_keep(plumb_past_poses* past, const plumb_world* world) {
  return read_checked(world, [&]<class Real>(const BasicWorld<Real>& w) {
    require_unused(require(past, "past poses"));
    auto& poses = past->poses;
    if (!std::holds_alternative<PastPoses<Real>>(poses)) poses.template emplace<PastPoses<Real>>();
    std::get<PastPoses<Real>>(poses).keep(w);
  });
}
size_t plumb_past_poses_between(const plumb_past_poses* past, const plumb_world* world, double fraction,
                                plumb_pose* to, size_t capacity) {
  return read_or<size_t>(0, world, [&]<class Real>(const BasicWorld<Real>& w) {
    const PastPoses<Real>* poses = kept_poses<Real>(past);
    require_fraction(fraction);
    if (capacity > 0) require(to, "out");
    const std::vector<plumb::BodyId> bodies = w.bodies();
    for (size_t i = 0; i < bodies.size() && i < capacity; ++i)
      to[i] = pose_between(w, poses, bodies[i], fraction);
    return bodies.size();
  });
}

plumb_draw_options plumb_default_draw(void) {
  const plumb::DrawOptions d;
  plumb_draw_options result{};
  result.shapes = d.shapes, result.joints = d.joints;
  result.normal_length = d.normal_length, result.impulse_length = d.impulse_length;
  return result;
}
plumb_status plumb_world_draw(const plumb_world* world, const plumb_debug_draw* draw,
                              const plumb_draw_options* options) {
  return read_checked(world, [&](const auto& w) {
    Drawing drawing(require(draw, "draw"));
    plumb::draw(w, drawing, options_of(options));
  });
}
plumb_status plumb_world_draw_between(const plumb_world* world, const plumb_past_poses* past, double fraction,
                                      const plumb_debug_draw* draw, const plumb_draw_options* options) {
  return read_checked(world, [&]<class Real>(const BasicWorld<Real>& w) {
    Drawing drawing(require(draw, "draw"));
    const PastPoses<Real>* poses = kept_poses<Real>(past);
    require_fraction(fraction);
    const Reading reading(*past);
    if (poses == nullptr) return plumb::draw(w, drawing, options_of(options));
    plumb::draw(w, *poses, fraction, drawing, options_of(options));
  });
}

#ifndef PLUMB_NO_FILES
size_t plumb_world_svg(const plumb_world* world, const plumb_draw_options* options, int width, char* to,
                       size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) {
    if (capacity > 0) require(to, "out");
    if (width < 1)
      throw Error(Error::Kind::Value, "picture", "width", std::to_string(width), "must be at least 1 pixel");
    const plumb::DrawOptions drawn = options_of(options);
    if (drawn.bounds &&
        !(drawn.bounds->lower.x < drawn.bounds->upper.x && drawn.bounds->lower.y < drawn.bounds->upper.y))
      throw Error(Error::Kind::Value, "picture", "bounds", "", "must have a width and a height");
    plumb::SvgDraw picture;
    plumb::draw(w, picture, drawn);
    const std::string text = drawn.bounds ? picture.picture(*drawn.bounds, width) : picture.picture(width);
    if (capacity > text.size()) std::memcpy(to, text.c_str(), text.size() + 1);
    return text.size() + 1;
  });
}
#endif
