#include <map>

#include "bindings/python/conversion.h"

namespace plumb::python {
namespace {

PyCFunctionWithKeywords call_bound = nullptr;  // pybind11's entry to all its functions

/// Names of properties by the function that sets them, which has no name itself.
std::map<PyObject*, std::string>& properties() {
  static auto& all = *new std::map<PyObject*, std::string>;  // never destroyed: Python is gone by then
  return all;
}

/// Calls a bound function. Where its arguments do not fit, the error names the one that does not, in place of
/// the function's whole signature.
PyObject* call_and_explain(PyObject* self, PyObject* args, PyObject* kwargs) {
  PyObject* const result = call_bound(self, args, kwargs);
  if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) return result;
  py::error_already_set thrown;  // takes the error
  try {
    const auto property = properties().find(self);
    const py::object text =
        py::module_::import("plumb._arguments")
            .attr("explain")(py::str(thrown.value()), py::handle(args),
                             kwargs != nullptr ? py::reinterpret_borrow<py::dict>(kwargs) : py::dict(),
                             property != properties().end() ? property->second : std::string());
    if (!text.is_none()) {
      PyErr_SetObject(PyExc_TypeError, text.ptr());
      return nullptr;
    }
  } catch (const py::error_already_set&) {  // say what pybind11 has to say
  }
  thrown.restore();
  return nullptr;
}

void explain_function(py::handle function, const std::string& property = {}) {
  if (!function) return;
  if (PyInstanceMethod_Check(function.ptr())) function = PyInstanceMethod_GET_FUNCTION(function.ptr());
  if (PyCFunction_Check(function.ptr()) == 0) return;
  auto* const object = reinterpret_cast<PyCFunctionObject*>(function.ptr());
  const auto entry =
      reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(object->m_ml->ml_meth));
  if (entry == call_and_explain || object->m_self == nullptr || PyCapsule_CheckExact(object->m_self) == 0)
    return;
  if (call_bound == nullptr) call_bound = entry;
  if (entry != call_bound) return;
  object->m_ml->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&call_and_explain));
  if (!property.empty()) properties()[object->m_self] = property;
}

}  // namespace

void explain_wrong_arguments(const py::module_& module) {
  for (const auto& [name, each] : py::dict(module.attr("__dict__"))) {
    explain_function(each);
    if (PyType_Check(each.ptr()) == 0) continue;
    for (const auto& [member, value] : py::dict(each.attr("__dict__"))) {
      py::handle function = value;
      if (PyObject_TypeCheck(function.ptr(), &PyProperty_Type) != 0) {
        explain_function(py::object(function.attr("fset")), std::string(py::str(member)));
        continue;
      }
      if (PyObject_TypeCheck(function.ptr(), &PyStaticMethod_Type) != 0) {
        explain_function(py::object(function.attr("__func__")));
        continue;
      }
      explain_function(function);
    }
  }
}

}  // namespace plumb::python
