#pragma once

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "engine/math/vec2.h"
#include "engine/scene/error.h"

namespace pybind11::detail {

/// A vector is a pair of numbers in Python: a tuple when returned, any sequence of two when passed.
template <>
struct type_caster<plumb::Vec2d> {
  PYBIND11_TYPE_CASTER(plumb::Vec2d, const_name("tuple[float, float]"));

  bool load(handle source, bool) {
    if (!PySequence_Check(source.ptr()) || PySequence_Size(source.ptr()) != 2) {
      PyErr_Clear();
      return false;
    }
    double parts[2];
    for (int i = 0; i < 2; ++i) {
      const object part = reinterpret_steal<object>(PySequence_GetItem(source.ptr(), i));
      parts[i] = part ? PyFloat_AsDouble(part.ptr()) : 0;
      if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        return false;
      }
    }
    value = {parts[0], parts[1]};
    return true;
  }
  static handle cast(plumb::Vec2d v, return_value_policy, handle) { return make_tuple(v.x, v.y).release(); }
};

}  // namespace pybind11::detail

namespace plumb::python {

namespace py = pybind11;

/// An argument that is True or False, of Python or numpy: as a bool, pybind11 takes numbers and None too.
struct Flag {
  bool on = false;
  operator bool() const { return on; }
};

/// Views the bytes of any object that has some: bytes, bytearray, memoryview, an array.
class Bytes {
 public:
  explicit Bytes(const py::buffer& given) {
    if (PyObject_GetBuffer(given.ptr(), &view_, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  }
  ~Bytes() { PyBuffer_Release(&view_); }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  std::span<const std::byte> all() const {
    return {static_cast<const std::byte*>(view_.buf), static_cast<std::size_t>(view_.len)};
  }

 private:
  Py_buffer view_{};
};

}  // namespace plumb::python

namespace pybind11::detail {

template <>
struct type_caster<plumb::python::Flag> {
  PYBIND11_TYPE_CASTER(plumb::python::Flag, const_name("bool"));

  bool load(handle source, bool) {
    const std::string_view type = Py_TYPE(source.ptr())->tp_name;
    if (!PyBool_Check(source.ptr()) && type != "numpy.bool_" && type != "numpy.bool") return false;
    value.on = PyObject_IsTrue(source.ptr()) == 1;
    return true;
  }
  static handle cast(plumb::python::Flag flag, return_value_policy, handle) {
    return bool_(flag.on).release();
  }
};

}  // namespace pybind11::detail

namespace plumb::python {

/// Returns the enumerator called `name`. Throws Error (Name) that lists the names.
template <class Enum, std::size_t kCount>
Enum named(const std::array<const char*, kCount>& names, const std::string& name, const char* field) {
  std::string all;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (name == names[i]) return static_cast<Enum>(i);
    all += std::string(i > 0 ? ", " : "") + names[i];
  }
  throw Error(Error::Kind::Name, "", field, name, "must be one of " + all);
}
template <class Enum, std::size_t kCount>
std::string name_in(const std::array<const char*, kCount>& names, Enum value) {
  return names[static_cast<std::size_t>(value)];
}

/// Converts what a function of the user returned. Throws TypeError that says what `function` must return.
template <class Result>
Result returned(const py::object& value, const char* function, const char* wanted) {
  py::detail::make_caster<Result> result;
  if (!value.is_none() && result.load(value, true)) return py::detail::cast_op<Result>(result);
  throw py::type_error(std::string(function) + " must return " + wanted + ", not " +
                       std::string(py::str(py::repr(value))));
}

/// Throws Error (Value) for a number below `least`.
inline void require_count(const char* subject, const char* field, int value, int least) {
  if (value >= least) return;
  throw Error(Error::Kind::Value, subject, field, std::to_string(value),
              "must be " + std::to_string(least) + " or more");
}

inline constexpr std::array kPrecisions{"float", "double"};
inline constexpr std::array kBodyTypes{"static", "kinematic", "dynamic"};
inline constexpr std::array kCombines{"geometric_mean", "product", "maximum", "minimum", "average"};
inline constexpr std::array kSolvers{"soft_steps", "sequential_impulses", "jakobsen", "xpbd", "direct"};
inline constexpr std::array kIntegrators{"velocity_verlet", "semi_implicit_euler", "explicit_euler"};

void bind_errors();
void bind_definitions(py::module_& module);
void bind_joint_kinds(py::module_& module);
void bind_world(py::module_& module);
void bind_simulation(py::module_& module);
/// Makes functions name the argument that they refuse.
void explain_wrong_arguments(const py::module_& module);

}  // namespace plumb::python
