#include "engine/world/queries.h"

#include <optional>

#include "bindings/python/handles.h"
#include "engine/world/mover.h"

namespace plumb::python {
namespace {

using py::arg;

/// Returns a filter of a query; `ignore` is a body of `world` or None.
QueryFilter filter_of(const WorldPointer& world, const std::optional<HeldBody>& ignore,
                      std::uint64_t category, std::uint64_t mask, bool sensors) {
  QueryFilter filter;
  filter.category = category, filter.mask = mask, filter.sensors = sensors;
  if (ignore) filter.ignore = id_in(world, *ignore, "ignore");
  return filter;
}

py::dict hit_of(const WorldPointer& held, const auto& hit) {
  return py::dict(arg("shape") = HeldShape{held, hit.shape}, arg("body") = HeldBody{held, hit.body},
                  arg("point") = hit.point, arg("normal") = hit.normal);
}

}  // namespace

void bind_queries(HeldWorldClass& world) {
  world
      .def(
          "ray_cast",
          [](const WorldPointer& h, Vec2d origin, Vec2d translation, std::optional<HeldBody> ignore,
             std::uint64_t category, std::uint64_t mask, bool sensors) -> py::object {
            const auto hit = h->visit([&](auto& w) {
              return ray_cast_closest(w, origin, translation, filter_of(h, ignore, category, mask, sensors));
            });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["fraction"] = hit->fraction;
            return found;
          },
          arg("origin"), arg("translation"), py::kw_only(), arg("ignore") = py::none(),
          arg("category") = QueryFilter{}.category, arg("mask") = QueryFilter{}.mask, arg("sensors") = false,
          "The closest hit of a ray (m) as a dict of shape, body, point, normal and fraction, or None.")
      .def(
          "ray_cast_all",
          [](const WorldPointer& h, Vec2d origin, Vec2d translation) {
            std::vector<RayResult> hits;
            h->visit([&](auto& w) { ray_cast_all(w, origin, translation, {}, hits); });
            py::list all;
            for (const RayResult& hit : hits) {
              py::dict found = hit_of(h, hit);
              found["fraction"] = hit.fraction;
              all.append(found);
            }
            return all;
          },
          arg("origin"), arg("translation"), "All hits of a ray, by fraction.")
      .def(
          "ray_casts",
          [](HeldWorld& h, const py::array_t<double, py::array::c_style | py::array::forcecast>& rays) {
            if (rays.ndim() != 2 || rays.shape(1) != 4)
              throw Error(Error::Kind::Value, "rays", "shape", "another one",
                          "must be (n, 4): origin and translation, m");
            py::array_t<double> fractions(rays.shape(0));
            h.visit([&](auto& w) {
              for (py::ssize_t i = 0; i < rays.shape(0); ++i) {
                const double* ray = rays.data(i, 0);
                const auto hit = ray_cast_closest(w, {ray[0], ray[1]}, {ray[2], ray[3]});
                *fractions.mutable_data(i) = hit ? hit->fraction : 1;
              }
            });
            return fractions;
          },
          arg("rays"),
          "Fractions at which rays hit, 1 for none: rays is (n, 4), origins and translations, m.")
      .def(
          "cast_shape",
          [](const WorldPointer& h, const ShapeGeometry& shape, Vec2d position, double angle,
             Vec2d translation, std::optional<HeldBody> ignore) -> py::object {
            const auto hit = h->visit([&](auto& w) {
              return cast_shape_closest(
                  w, QueryShape(shape), position, angle, translation,
                  filter_of(h, ignore, QueryFilter{}.category, QueryFilter{}.mask, false));
            });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["fraction"] = hit->fraction, found["overlapped"] = hit->overlapped;
            return found;
          },
          arg("shape"), arg("position"), arg("angle"), arg("translation"), py::kw_only(),
          arg("ignore") = py::none(), "First contact of a shape that moves by `translation`, m, or None.")
      .def(
          "overlap_shape",
          [](const WorldPointer& h, const ShapeGeometry& shape, Vec2d position, double angle) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { overlap_shape(w, QueryShape(shape), position, angle, {}, found); });
            return handles(h, found);
          },
          arg("shape"), arg("position"), arg("angle") = 0.0)
      .def(
          "overlap_box",
          [](const WorldPointer& h, Vec2d lower, Vec2d upper) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { overlap_box(w, Aabb<double>{lower, upper}, {}, found); });
            return handles(h, found);
          },
          arg("lower"), arg("upper"))
      .def(
          "shapes_at",
          [](const WorldPointer& h, Vec2d point) {
            std::vector<ShapeId> found;
            h->visit([&](auto& w) { shapes_at(w, point, {}, found); });
            return handles(h, found);
          },
          arg("point"))
      .def(
          "nearest",
          [](const WorldPointer& h, Vec2d point, double max_distance) -> py::object {
            const auto hit = h->visit([&](auto& w) { return nearest(w, point, max_distance); });
            if (!hit) return py::none();
            py::dict found = hit_of(h, *hit);
            found["distance"] = hit->distance;
            return found;
          },
          arg("point"), arg("max_distance"),
          "The shape whose surface is nearest, within max_distance, m, or None.")
      .def(
          "move",
          [](const WorldPointer& h, const Capsule& capsule, Vec2d position, Vec2d velocity, double dt,
             Vec2d up, double max_slope, double step_height, double skin, double mass, double push_force,
             bool push) {
            const MoverOptions o{up, max_slope, step_height, skin, mass, push_force, {}};
            return h->visit([&](auto& w) {
              const MoverResult r = move(w, capsule, position, velocity, dt, o);
              if (push) apply_pushes(w, r);
              return py::dict(arg("position") = r.position, arg("velocity") = r.velocity,
                              arg("on_ground") = r.on_ground, arg("squeezed") = r.squeezed,
                              arg("ground_normal") = r.ground_normal, arg("ground") = HeldBody{h, r.ground},
                              arg("ground_velocity") = r.ground_velocity);
            });
          },
          arg("capsule"), arg("position"), arg("velocity"), arg("dt"), py::kw_only(), arg("up") = Vec2d{0, 1},
          arg("max_slope") = MoverOptions{}.max_slope, arg("step_height") = MoverOptions{}.step_height,
          arg("skin") = 0.0, arg("mass") = 0.0, arg("push_force") = MoverOptions{}.push_force,
          arg("push") = true,
          "Moves a character, a capsule, by its velocity (m/s) for dt (s), stopped by bodies. Call it before "
          "the step.");
}

}  // namespace plumb::python
