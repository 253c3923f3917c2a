#include "engine/world/rollback.h"

#include "bindings/python/handles.h"

namespace plumb::python {
namespace {

using py::arg;

/// The last states of a world, which it keeps alive.
class HeldRollback {
 public:
  HeldRollback(const WorldPointer& world, int frames)
      : world_(world), states_(world_->visit([&]<class Real>(BasicWorld<Real>& w) {
          return std::variant<Rollback<float>, Rollback<double> >(Rollback<Real>(w, frames));
        })) {}

  void save() {
    std::visit([](auto& states) { states.save(); }, states_);
  }
  void back_to(std::int64_t step) {
    world_->leave_views();
    std::visit([&](auto& states) { states.back_to(step); }, states_);
  }
  template <class Visit>
  void traverse(Visit&& visit) const {
    world_.traverse(visit);
  }
  template <class Read>
  auto read(Read&& read) const {
    return std::visit(std::forward<Read>(read), states_);
  }

 private:
  WorldReference world_;
  std::variant<Rollback<float>, Rollback<double> > states_;
};

}  // namespace

void bind_rollback(py::module_& module) {
  py::class_<HeldRollback>(module, "Rollback", traversed<HeldRollback>(),
                           "The last states of a world in memory, for inputs that arrive late: go back, and "
                           "take the steps since then again. Keeps up to `frames` states, 1 to 10000.")
      .def(py::init<const WorldPointer&, int>(), arg("world"), arg("frames"))
      .def(
          "save", [](HeldRollback& r) { r.save(); },
          "Saves the present state under its step count, instead of the oldest one if it is full.")
      .def("back_to", &HeldRollback::back_to, arg("step"),
           "Restores the state after `step` steps, and drops later ones.")
      .def(
          "holds",
          [](const HeldRollback& r, std::int64_t step) {
            return r.read([&](const auto& states) { return states.holds(step); });
          },
          arg("step"), "True if it has the state after `step` steps.")
      .def("__len__",
           [](const HeldRollback& r) { return r.read([](const auto& states) { return states.size(); }); })
      .def_property_readonly(
          "oldest",
          [](const HeldRollback& r) { return r.read([](const auto& states) { return states.oldest(); }); },
          "Step of the oldest state; -1: there is none.")
      .def_property_readonly(
          "latest",
          [](const HeldRollback& r) { return r.read([](const auto& states) { return states.latest(); }); },
          "Step of the latest state; -1: there is none.");
}

}  // namespace plumb::python
