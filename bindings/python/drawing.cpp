#include "engine/world/debug_draw.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bindings/python/handles.h"
#include "engine/core/text.h"

namespace plumb::python {
namespace {

using py::arg;

constexpr std::array kRoles{"static", "kinematic", "awake", "asleep", "sensor", "contact",
                            "normal", "impulse",   "box",   "centre", "joint",  "name"};
static_assert(kRoles.size() == static_cast<std::size_t>(DrawRole::Name) + 1);
constexpr std::array kItems{"polygon", "circle", "capsule", "segment", "point", "text"};

/// Calls the functions that a Python object has; leaves out those that it does not.
class Drawing : public DebugDraw {
 public:
  explicit Drawing(const py::object& to) {
    bool any = false;
    for (std::size_t i = 0; i < kItems.size(); ++i) {
      functions_[i] = py::getattr(to, kItems[i], py::none());
      if (functions_[i].is_none()) continue;
      if (PyCallable_Check(functions_[i].ptr()) == 0)
        throw py::type_error(std::string(kItems[i]) + " of what draws is " +
                             std::string(py::str(py::repr(functions_[i]))) + ": must be a function");
      any = true;
    }
    if (!any)
      throw py::type_error(
          "what draws has none of the functions polygon, circle, capsule, segment, point, text");
  }

  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override {
    if (!functions_[0].is_none())
      functions_[0](std::vector<Vec2d>(corners.begin(), corners.end()), radius, name_of(role));
  }
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override {
    if (!functions_[1].is_none()) functions_[1](centre, radius, axis, name_of(role));
  }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override {
    if (!functions_[2].is_none()) functions_[2](start, end, radius, name_of(role));
  }
  void segment(Vec2d start, Vec2d end, DrawRole role) override {
    if (!functions_[3].is_none()) functions_[3](start, end, name_of(role));
  }
  void point(Vec2d point, DrawRole role) override {
    if (!functions_[4].is_none()) functions_[4](point, name_of(role));
  }
  // Names of bodies may be any bytes.
  void text(Vec2d point, std::string_view text, DrawRole role) override {
    if (functions_[5].is_none()) return;
    const auto size = static_cast<py::ssize_t>(text.size());
    const py::object shown =
        py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(text.data(), size, "replace"));
    if (!shown) throw py::error_already_set();
    functions_[5](point, shown, name_of(role));
  }

 private:
  static const char* name_of(DrawRole role) { return kRoles[static_cast<std::size_t>(role)]; }
  std::array<py::object, kItems.size()> functions_;
};

void require_fraction(double fraction) {
  if (std::isfinite(fraction)) return;
  throw Error(Error::Kind::Value, "past poses", "fraction", shortest(fraction),
              "must be a number: 0 for the kept poses, 1 for the present ones");
}

/// Poses of a world before its last step; the world stays as long as they do.
class HeldPastPoses {
 public:
  explicit HeldPastPoses(const WorldPointer& world) : world_(world) { keep(); }
  void keep() {
    world_->visit([&]<class Real>(BasicWorld<Real>& w) {
      if (!std::holds_alternative<PastPoses<Real>>(poses_)) poses_.template emplace<PastPoses<Real>>();
      std::get<PastPoses<Real>>(poses_).keep(w);
    });
  }
  py::array_t<double> at(double fraction) const {
    require_fraction(fraction);
    return world_->visit([&]<class Real>(BasicWorld<Real>& w) {
      const auto& bodies = w.data().bodies;
      py::array_t<double> out({static_cast<py::ssize_t>(bodies.size()), py::ssize_t{3}});
      double* row = out.mutable_data();
      for (int body = 0; body < bodies.size(); ++body, row += 3) {
        BodyPose pose{{std::nan(""), std::nan("")}, std::nan("")};
        const BodyId id{static_cast<std::uint32_t>(body), bodies.generation(body)};
        if (bodies.used(body)) pose = std::get<PastPoses<Real>>(poses_).pose_between(w, id, fraction);
        row[0] = pose.position.x, row[1] = pose.position.y, row[2] = pose.angle;
      }
      return out;
    });
  }
  template <class Real>
  const PastPoses<Real>& of(const WorldPointer& world) const {
    if (!(world_ == world)) throw Error(Error::Kind::Value, "world", "past", "", "is of another world");
    return std::get<PastPoses<Real>>(poses_);
  }
  template <class Visit>
  void traverse(Visit&& visit) const {
    world_.traverse(visit);
  }

 private:
  WorldReference world_;
  std::variant<PastPoses<float>, PastPoses<double>> poses_;
};

void draw_to(const WorldPointer& h, const py::object& to, const HeldPastPoses* past, double fraction,
             const DrawOptions& options) {
  Drawing drawing(to);
  require_fraction(fraction);
  h->visit([&]<class Real>(BasicWorld<Real>& w) {
    if (past == nullptr) return draw(w, drawing, options);
    draw(w, past->of<Real>(h), fraction, drawing, options);
  });
}

}  // namespace

void bind_drawing(py::module_& module, HeldWorldClass& world) {
  const DrawOptions d;
  py::class_<HeldPastPoses>(module, "PastPoses", traversed<HeldPastPoses>(),
                            "Poses of a world before its last step, for frames that come at other times than "
                            "steps: keep them before each step, and draw between them and the present ones.")
      .def(py::init<const WorldPointer&>(), arg("world"))
      .def("keep", &HeldPastPoses::keep, "Keeps the present poses.")
      .def("at", &HeldPastPoses::at, arg("fraction"),
           "x and y of the origins (m) and angles (rad) at `fraction` from the kept poses (0) to the present "
           "ones (1), (n, 3), like World.poses. A body created since has its present pose.");
  world.def(
      "draw",
      [](const WorldPointer& h, const py::object& to, Flag shapes, Flag joints, Flag contacts, Flag normals,
         Flag impulses, Flag boxes, Flag centres, Flag names, double normal_length, double impulse_length,
         const std::optional<std::pair<Vec2d, Vec2d>>& bounds, const HeldPastPoses* past, double fraction) {
        DrawOptions o{shapes,  joints, contacts,      normals,        impulses, boxes,
                      centres, names,  normal_length, impulse_length, {}};
        if (bounds) o.bounds = {bounds->first, bounds->second};
        draw_to(h, to, past, fraction, o);
      },
      arg("to"), py::kw_only(), arg("shapes") = d.shapes, arg("joints") = d.joints,
      arg("contacts") = d.contacts, arg("normals") = d.normals, arg("impulses") = d.impulses,
      arg("boxes") = d.boxes, arg("centres") = d.centres, arg("names") = d.names,
      arg("normal_length") = d.normal_length, arg("impulse_length") = d.impulse_length,
      arg("bounds") = py::none(), arg("past") = py::none(), arg("fraction") = 1.0,
      "Calls the functions that `to` has for each item: polygon(corners, radius, role), circle(centre, "
      "radius, "
      "axis, role), capsule(start, end, radius, role), segment(start, end, role), point(point, role) and "
      "text(point, text, role). role: 'static', 'kinematic', 'awake', 'asleep' or 'sensor' of shapes, "
      "'contact', 'normal', 'impulse', 'box', 'centre', 'joint', 'name'. They may read the world, not change "
      "it. normal_length: m; impulse_length: m per N s; bounds: (lower, upper), m; past: a PastPoses, from "
      "which (0) to the present poses (1) `fraction` counts.");
}

}  // namespace plumb::python
