#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/forces/wrench.h"
#include "engine/world/queries/transformed_shape.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/state/validate.h"
#include "engine/world/world.h"

/// Common part of force laws: selects the bodies, and applies the forces.
namespace plumb {

struct BodyWrench {
  int body = 0;
  Wrench<double> wrench{};
};

/// List of wrenches that keeps its memory from call to call. Uses may be nested.
class WrenchList {
 public:
  WrenchList() : items_(std::move(cache())) { items_.clear(); }
  ~WrenchList() {
    if (items_.capacity() > cache().capacity()) cache() = std::move(items_);
  }
  WrenchList(const WrenchList&) = delete;
  WrenchList& operator=(const WrenchList&) = delete;

  void add(int body, const Wrench<double>& wrench) { items_.push_back({body, wrench}); }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }

 private:
  static std::vector<BodyWrench>& cache() {
    thread_local std::vector<BodyWrench> list;
    return list;
  }
  std::vector<BodyWrench> items_;
};

/// Throws Error (Value) with the body's name or handle; `field` is the quantity that is not finite.
[[noreturn]] void report_not_finite(const std::string& name, int body, const char* field);

/// Returns true if force and torque are finite and within the world's limits.
inline bool is_sound(const Wrench<double>& wrench) {
  const auto fits = [](double x) { return std::abs(x) <= kLargestNumber; };
  return fits(wrench.force.x) && fits(wrench.force.y) && fits(wrench.torque);
}

template <class Real>
void require_finite_wrench(const WorldData<Real>& w, int body, const Wrench<double>& wrench,
                           const char* field) {
  if (!is_sound(wrench)) report_not_finite(w.extras_of(body).name, body, field);
}

/// Quarantines a body whose wrench has a component that is not finite or beyond 1e12.
template <class Real>
void quarantine_pushed(WorldData<Real>& w, int body, const Wrench<double>& wrench) {
  const auto fits = [](double x) { return std::abs(x) <= kLargestNumber; };
  if (!fits(wrench.force.x)) return quarantine_body(w, body, BadField::Force, wrench.force.x);
  if (!fits(wrench.force.y)) return quarantine_body(w, body, BadField::Force, wrench.force.y);
  quarantine_body(w, body, BadField::Torque, wrench.torque);
}

/// Returns the fraction s of a step after which position-dependent forces are evaluated, such that springs
/// neither gain nor lose energy. Under a constant acceleration a, a step leads to x + dt v + c dt^2 a. In
/// free flight c = 1/2; for bodies in contact c = (1 + 1/n)/2 with n substeps. With the force at x + s dt v,
/// phase-space area is conserved for s = 1 - c. For comparison: with s = 1/2 in contact, a spring of omega dt
/// = 1/6 would lose three quarters of its energy in ten periods. Assumes that the next step has as many
/// substeps as the last.
template <class Real>
double evaluation_fraction(const WorldData<Real>& w, int body, double dt) {
  const BodyRecord<Real>& record = w.bodies[body];
  if (record.type != BodyType::Dynamic) return 0.5;
  const bool flies_exactly = w.settings.solver == Solver::SoftSteps || w.settings.solver == Solver::Direct;
  bool by_substeps = !flies_exactly;
  for (int edge = record.first_contact; edge != kNone && !by_substeps;) {
    const ContactRecord& contact = w.contacts[edge / 2];
    by_substeps = contact.home == ContactHome::Graph;
    edge = contact.next[edge & 1];
  }
  if (!by_substeps) return 0.5;
  constexpr double kUsualSubsteps = 4;
  const double substeps = w.last_h > 0 ? std::max(1.0, std::round(dt / w.last_h)) : kUsualSubsteps;
  return 0.5 * (1 - 1 / substeps);
}

/// Wakes a pushed body, and resets its sleep timer.
template <class Real>
void wake_pushed(WorldData<Real>& w, int body) {
  if (!w.bodies[body].awake) {
    wake_body(w, body);
    w.bodies[body].sleep_time = 0;
  }
}

/// Calls `visit(body)` for the dynamic bodies that a law acts on.
template <class Real, class Visit>
void for_each_law_body(WorldData<Real>& w, bool wakes, Visit&& visit) {
  if (!wakes) {
    for (const int body : w.awake) {
      if (w.is_dynamic(body)) visit(body);
    }
    return;
  }
  w.bodies.for_each([&](int body, const BodyRecord<Real>& record) {
    if (record.type == BodyType::Dynamic) visit(body);
  });
}

/// Adds the wrenches to the loads of the next step. First quarantines bodies whose wrench is not finite or
/// beyond the limits.
template <class Real>
void add_wrenches(WorldData<Real>& w, const WrenchList& list) {
  for (const BodyWrench& item : list) {
    if (!is_sound(item.wrench)) quarantine_pushed(w, item.body, item.wrench);
  }
  for (const BodyWrench& item : list) {
    if (item.wrench.force == Vec2d{} && item.wrench.torque == 0) continue;
    if (w.bodies[item.body].quarantined) continue;
    wake_pushed(w, item.body);
    Load<Real>& load = w.loads.at(item.body, w.bodies.size());
    load.force += item.wrench.force.template as<Real>();
    load.torque += static_cast<Real>(item.wrench.torque);
  }
}

/// Adds `wrench_of(body)` for each body that a law acts on.
template <class Real, class Law>
void apply_to_bodies(WorldData<Real>& w, bool wakes, Law&& wrench_of) {
  WrenchList list;
  for_each_law_body(w, wakes, [&](int body) { list.add(body, wrench_of(body)); });
  add_wrenches(w, list);
}

/// Returns a drag wrench, scaled down so that it at most stops the relative motion within `dt`: its power
/// decreases by W M^-1 W dt in the step, and must not change sign. `power` (W) is that of the wrench for the
/// motion that it opposes.
template <class Real>
Wrench<double> bounded_drag(const SolverBody<Real>& motion, const Wrench<double>& wrench, double power,
                            double dt) {
  const double loss = dt * (static_cast<double>(motion.inverse_mass) * length_squared(wrench.force) +
                            static_cast<double>(motion.inverse_inertia) * wrench.torque * wrench.torque);
  return loss > power ? (power / loss) * wrench : wrench;
}

/// Copy of a shape in double, rotated by `turn`, with its body's centre of mass at `offset` (m).
class LawShape {
 public:
  template <class Real>
  LawShape(const WorldData<Real>& w, int shape, Rotation<double> rotation, Vec2d offset)
      : count_(w.forms[shape].count), radius_(static_cast<double>(w.forms[shape].radius)) {
    const Convex<Real> local = w.convex(shape);
    for (int i = 0; i < count_; ++i) {
      corners_[i] = {offset + rotation * local.corners[i].point.template as<double>(),
                     rotation * local.corners[i].normal.template as<double>()};
    }
  }
  Convex<double> convex() const { return {corners_, count_, radius_}; }

 private:
  Corner<double> corners_[kMaxCorners];
  int count_;
  double radius_;
};

/// Calls `visit(shape)` for those of the body's shapes on which fluids and blasts act.
template <class Real, class Visit>
void for_each_solid_shape(const WorldData<Real>& w, int body, Visit&& visit) {
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    if (!w.forms[shape].sensor && !w.forms[shape].chain) visit(shape);
  }
}

}  // namespace plumb
