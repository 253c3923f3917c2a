#pragma once

#include "bindings/python/conversion.h"

/// Takes part in Python's garbage collection: hooks refer to the objects that refer to their world, so counts
/// of references alone would never free them.
namespace plumb::python {

/// Returns the C++ object in a Python object; null while it is not constructed.
template <class Type>
Type* constructed(PyObject* self) {
  auto* const instance = reinterpret_cast<py::detail::instance*>(self);
  if (!instance->simple_layout && instance->nonsimple.values_and_holders == nullptr) return nullptr;
  py::detail::value_and_holder holder = instance->get_value_and_holder();
  return holder && holder.holder_constructed() ? holder.value_ptr<Type>() : nullptr;
}

/// Refuses an object that `__new__` made and `__init__` did not.
[[noreturn]] inline void refuse_uninitialised() {
  throw py::type_error("the object was not initialised: call its class instead of __new__");
}

/// Makes a class's objects visible to the collector: `Type::traverse(visit)` calls `visit(object)` for each
/// Python object that it refers to.
template <class Type>
void let_traverse(PyTypeObject& type) {
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    const Type* const it = constructed<Type>(self);
    if (it == nullptr) return 0;
    int stopped = 0;
    it->traverse([&](const py::object& each) {
      if (stopped == 0 && each) stopped = visit(each.ptr(), arg);
    });
    return stopped;
  };
  type.tp_dealloc = [](PyObject* self) {
    PyObject_GC_UnTrack(self);
    py::detail::pybind11_object_dealloc(self);
  };
}

/// For classes whose references cannot be taken away: other objects of a cycle are cleared.
template <class Type>
py::custom_type_setup traversed() {
  return py::custom_type_setup([](PyHeapTypeObject* type) { let_traverse<Type>(type->ht_type); });
}

/// For classes with `Type::clear()`, which drops the references.
template <class Type>
py::custom_type_setup collected() {
  return py::custom_type_setup([](PyHeapTypeObject* type) {
    let_traverse<Type>(type->ht_type);
    type->ht_type.tp_clear = [](PyObject* self) {
      if (Type* const it = constructed<Type>(self)) it->clear();
      return 0;
    };
  });
}

}  // namespace plumb::python
