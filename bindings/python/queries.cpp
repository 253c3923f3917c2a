#include "engine/world/queries.h"

#include <optional>

#include "bindings/python/considered.h"
#include "bindings/python/handles.h"
#include "engine/world/mover.h"

namespace plumb::python {
namespace {

using py::arg;

/// Adds a query of the world to its class: `query(world, filter, own arguments...)`, where `filter` is made
/// from the keyword arguments that all queries have in common. `Own` are the types of its own arguments.
template <class... Own, class Query, class... Names>
void bind_query(HeldWorldClass& type, const char* name, Query query, const char* about, Names&&... names) {
  type.def(
      name,
      [query](const WorldPointer& h, Own... own, std::optional<HeldBody> ignore, std::uint64_t category,
              std::uint64_t mask, Flag sensors, const std::optional<py::function>& condition) {
        const Considered considered(h, ignore, category, mask, sensors, condition);
        return query(h, considered.filter(), own...);
      },
      std::forward<Names>(names)..., py::kw_only(), arg("ignore") = py::none(),
      arg("category") = QueryFilter{}.category, arg("mask") = QueryFilter{}.mask, arg("sensors") = false,
      arg("condition") = py::none(), about);
}

py::dict hit_of(const WorldReference& held, const auto& hit) {
  return py::dict(arg("shape") = HeldShape{held, hit.shape}, arg("body") = HeldBody{held, hit.body},
                  arg("point") = hit.point, arg("normal") = hit.normal);
}

}  // namespace

void bind_queries(HeldWorldClass& world) {
  bind_query<Vec2d, Vec2d>(
      world, "ray_cast",
      [](const WorldPointer& h, const QueryFilter& filter, Vec2d origin, Vec2d translation) -> py::object {
        const auto hit = h->visit([&](auto& w) { return ray_cast_closest(w, origin, translation, filter); });
        if (!hit) return py::none();
        py::dict found = hit_of(h, *hit);
        found["fraction"] = hit->fraction;
        return found;
      },
      "The closest hit of a ray (m) as a dict of shape, body, point, normal and fraction, or None.",
      arg("origin"), arg("translation"));
  bind_query<Vec2d, Vec2d>(
      world, "ray_cast_all",
      [](const WorldPointer& h, const QueryFilter& filter, Vec2d origin, Vec2d translation) {
        std::vector<RayResult> hits;
        h->visit([&](auto& w) { ray_cast_all(w, origin, translation, filter, hits); });
        py::list all;
        for (const RayResult& hit : hits) {
          py::dict found = hit_of(h, hit);
          found["fraction"] = hit.fraction;
          all.append(found);
        }
        return all;
      },
      "All hits of a ray, by fraction.", arg("origin"), arg("translation"));
  bind_query<const ShapeGeometry&, Vec2d, double, Vec2d>(
      world, "cast_shape",
      [](const WorldPointer& h, const QueryFilter& filter, const ShapeGeometry& shape, Vec2d position,
         double angle, Vec2d translation) -> py::object {
        const auto hit = h->visit([&](auto& w) {
          return cast_shape_closest(w, QueryShape(shape), position, angle, translation, filter);
        });
        if (!hit) return py::none();
        py::dict found = hit_of(h, *hit);
        found["fraction"] = hit->fraction, found["overlapped"] = hit->overlapped;
        return found;
      },
      "First contact of a shape that moves by `translation`, m, or None.", arg("shape"), arg("position"),
      arg("angle"), arg("translation"));
  bind_query<const ShapeGeometry&, Vec2d, double>(
      world, "overlap_shape",
      [](const WorldPointer& h, const QueryFilter& filter, const ShapeGeometry& shape, Vec2d position,
         double angle) {
        std::vector<ShapeId> found;
        h->visit([&](auto& w) { overlap_shape(w, QueryShape(shape), position, angle, filter, found); });
        return handles(h, found);
      },
      "Shapes that overlap or touch a shape at a pose, m and rad.", arg("shape"), arg("position"),
      arg("angle") = 0.0);
  bind_query<Vec2d, Vec2d>(
      world, "overlap_box",
      [](const WorldPointer& h, const QueryFilter& filter, Vec2d lower, Vec2d upper) {
        std::vector<ShapeId> found;
        h->visit([&](auto& w) { overlap_box(w, Aabb<double>{lower, upper}, filter, found); });
        return handles(h, found);
      },
      "Shapes that overlap or touch a box, m.", arg("lower"), arg("upper"));
  bind_query<Vec2d>(
      world, "shapes_at",
      [](const WorldPointer& h, const QueryFilter& filter, Vec2d point) {
        std::vector<ShapeId> found;
        h->visit([&](auto& w) { shapes_at(w, point, filter, found); });
        return handles(h, found);
      },
      "Shapes that contain a point, m.", arg("point"));
  bind_query<Vec2d, double>(
      world, "nearest",
      [](const WorldPointer& h, const QueryFilter& filter, Vec2d point, double max_distance) -> py::object {
        const auto hit = h->visit([&](auto& w) { return nearest(w, point, max_distance, filter); });
        if (!hit) return py::none();
        py::dict found = hit_of(h, *hit);
        found["distance"] = hit->distance;
        return found;
      },
      "The shape whose surface is nearest, within max_distance, m, or None.", arg("point"),
      arg("max_distance"));
  world
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
          "move",
          [](const WorldPointer& h, const Capsule& capsule, Vec2d position, Vec2d velocity, double dt,
             Vec2d up, double max_slope, double step_height, double skin, double mass, double push_force,
             Flag push, const std::optional<HeldBody>& ignore, std::uint64_t category, std::uint64_t mask,
             const std::optional<py::function>& condition) {
            const Considered considered(h, ignore, category, mask, false, condition);
            const MoverOptions o{up, max_slope, step_height, skin, mass, push_force, considered.filter()};
            return h->visit([&](auto& w) {
              const MoverResult r = move(w, capsule, position, velocity, dt, o);
              if (push) apply_pushes(w, r);
              const bool stands = w.valid(r.ground);
              py::list hits;
              for (const MoverHit& hit : r.hits) {
                py::dict found = hit_of(h, hit);
                found["impulse"] = hit.impulse;
                hits.append(found);
              }
              const py::object ground = stands ? py::cast(HeldBody{h, r.ground}) : py::none();
              return py::dict(arg("position") = r.position, arg("velocity") = r.velocity,
                              arg("on_ground") = r.on_ground, arg("squeezed") = r.squeezed,
                              arg("ground_normal") = r.ground_normal, arg("ground") = ground,
                              arg("ground_velocity") = r.ground_velocity, arg("hits") = hits);
            });
          },
          arg("capsule"), arg("position"), arg("velocity"), arg("dt"), py::kw_only(), arg("up") = Vec2d{0, 1},
          arg("max_slope") = MoverOptions{}.max_slope, arg("step_height") = MoverOptions{}.step_height,
          arg("skin") = 0.0, arg("mass") = 0.0, arg("push_force") = MoverOptions{}.push_force,
          arg("push") = true, arg("ignore") = py::none(), arg("category") = QueryFilter{}.category,
          arg("mask") = QueryFilter{}.mask, arg("condition") = py::none(),
          "Moves a character, a capsule, by its velocity (m/s) for dt (s), stopped by bodies. Call it before "
          "the step. In the dict, `ground` is the body that it stands on, or None, and `hits` are the "
          "surfaces "
          "that stopped it, each a dict of shape, body, point, normal and impulse.");
}

}  // namespace plumb::python
