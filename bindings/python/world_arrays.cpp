#include <cstring>
#include <memory>

#include "bindings/python/arrays.h"
#include "bindings/python/handles.h"

namespace plumb::python {
namespace {

using py::arg;

/// Returns the object that keeps viewed memory alive: one for all arrays that are there at a time.
py::object base_of(HeldWorld& held) {
  using Owner = std::shared_ptr<ViewedMemory>;
  if (const std::shared_ptr<ViewedMemory> memory = held.viewed.lock())
    return py::reinterpret_borrow<py::object>(static_cast<PyObject*>(memory->base));
  const auto memory = std::make_shared<ViewedMemory>();
  py::object base =
      py::capsule(new Owner(memory), [](void* pointer) { delete static_cast<Owner*>(pointer); });
  memory->base = base.ptr();
  held.viewed = memory;
  return base;
}

/// Returns an array that views `count` items of `width` numbers at `first`, `stride` bytes apart.
template <class Number>
py::array view(HeldWorld& held, const Number* first, std::size_t count, std::size_t stride, int width) {
  static const Number kNothing[2] = {};
  const auto items = static_cast<py::ssize_t>(count), apart = static_cast<py::ssize_t>(stride);
  const py::array::ShapeContainer shape =
      width > 1 ? py::array::ShapeContainer{items, py::ssize_t{width}} : py::array::ShapeContainer{items};
  const py::array::StridesContainer strides =
      width > 1 ? py::array::StridesContainer{apart, static_cast<py::ssize_t>(sizeof(Number))}
                : py::array::StridesContainer{apart};
  py::array array(py::dtype::of<Number>(), shape, strides, first != nullptr ? first : kNothing,
                  base_of(held));
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// A contact as numpy has it.
struct ContactRow {
  std::uint32_t body_a, body_b;
  std::uint32_t shape_a, shape_b;
  std::int32_t count;
  std::int32_t unused;
  double normal[2];
  double points[2][2];
  double separations[2];
  double impulses[2];
  double step_impulse;
};

py::array_t<ContactRow> contacts_of(HeldWorld& held) {
  std::vector<ContactRow> all;
  held.visit([&](auto& w) {
    std::vector<ContactReading> readings(w.contacts(std::span<ContactReading>{}));
    w.contacts(readings);
    for (const ContactReading& c : readings) {
      ContactRow row{w.body(c.shape_a).index,
                     w.body(c.shape_b).index,
                     c.shape_a.index,
                     c.shape_b.index,
                     c.count,
                     0,
                     {c.normal.x, c.normal.y},
                     {},
                     {},
                     {},
                     c.step_impulse};
      for (int i = 0; i < c.count; ++i) {
        row.points[i][0] = c.points[i].x, row.points[i][1] = c.points[i].y;
        row.separations[i] = c.separations[i], row.impulses[i] = c.impulses[i];
      }
      all.push_back(row);
    }
  });
  py::array_t<ContactRow> out(static_cast<py::ssize_t>(all.size()));
  if (!all.empty()) std::memcpy(out.mutable_data(), all.data(), all.size() * sizeof(ContactRow));
  return out;
}

}  // namespace

void bind_arrays(HeldWorldClass& world) {
  PYBIND11_NUMPY_DTYPE(ContactRow, body_a, body_b, shape_a, shape_b, count, normal, points, separations,
                       impulses, step_impulse);
  world
      .def_property_readonly(
          "centres",
          [](HeldWorld& h) {
            return h.visit([&](auto& w) {
              const auto& all = w.data().position;
              return view(h, all.empty() ? static_cast<const double*>(nullptr) : &all[0].x, all.size(),
                          sizeof(Vec2d), 2);
            });
          },
          "m, centres of mass; a view, (n, 2)")
      .def_property_readonly(
          "angles",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              auto& all = std::get<0>(w.data().bodies.parts());
              return view(h, all.empty() ? static_cast<const double*>(nullptr) : &all[0].angle, all.size(),
                          sizeof(BodyRecord<Real>), 1);
            });
          },
          "rad; a view, (n,)")
      .def_property_readonly(
          "velocities",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              const auto& all = w.data().motion;
              return view(h, all.empty() ? static_cast<const Real*>(nullptr) : &all[0].velocity.x, all.size(),
                          sizeof(SolverBody<Real>), 2);
            });
          },
          "m/s, of the centres of mass; a view, (n, 2), in the world's precision")
      .def_property_readonly(
          "angular_velocities",
          [](HeldWorld& h) {
            return h.visit([&]<class Real>(BasicWorld<Real>& w) {
              const auto& all = w.data().motion;
              return view(h, all.empty() ? static_cast<const Real*>(nullptr) : &all[0].angular_velocity,
                          all.size(), sizeof(SolverBody<Real>), 1);
            });
          },
          "rad/s; a view, (n,), in the world's precision")
      .def_property_readonly(
          "poses",
          [](HeldWorld& h) {
            return h.visit([](auto& w) {
              py::array_t<double> out({static_cast<py::ssize_t>(w.data().bodies.size()), py::ssize_t{3}});
              write_poses(w, out.mutable_data());
              return out;
            });
          },
          "x and y of the origins, m, and angles, rad; a copy, (n, 3); NaN for destroyed bodies")
      .def_property_readonly(
          "used",
          [](HeldWorld& h) {
            return h.visit([](auto& w) {
              const auto& bodies = w.data().bodies;
              py::array_t<bool> used(bodies.size());
              for (int i = 0; i < bodies.size(); ++i) used.mutable_data()[i] = bodies.used(i);
              return used;
            });
          },
          "False for rows of destroyed bodies; a copy, (n,)")
      .def_property_readonly(
          "contacts", &contacts_of,
          "All contacts with points: body_a, body_b, shape_a, shape_b (indices), count, "
          "normal, points (m), separations "
          "(m), impulses (N s, of the last substep), step_impulse (N s, of the whole step, for shapes with "
          "hit_events or pre_solve); a structured array, a copy")
      .def(
          "apply_forces",
          [](HeldWorld& h, const py::array_t<double, py::array::c_style | py::array::forcecast>& forces) {
            h.visit([&](auto& w) {
              const auto& bodies = w.data().bodies;
              if (forces.ndim() != 2 || forces.shape(0) != bodies.size() ||
                  (forces.shape(1) != 2 && forces.shape(1) != 3)) {
                throw Error(Error::Kind::Value, "world", "forces", "an array of another shape",
                            "must have a row for each of the " + std::to_string(bodies.size()) +
                                " body indices, of 2 or 3 numbers");
              }
              const auto width = forces.shape(1);
              const double* row = forces.data();
              for (int body = 0; body < bodies.size(); ++body, row += width) {
                const double torque = width == 3 ? row[2] : 0;
                if (!bodies.used(body) || (row[0] == 0 && row[1] == 0 && torque == 0)) continue;
                const BodyId id{static_cast<std::uint32_t>(body), bodies.generation(body)};
                w.apply_force(id, Vec2d{row[0], row[1]});
                if (torque != 0) w.apply_torque(id, torque);
              }
            });
          },
          arg("forces"),
          "Applies a force (N) to each body during the next step: (n, 2), or (n, 3) with torques (N m).");
}

}  // namespace plumb::python
