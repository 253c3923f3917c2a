#include "engine/world/world.h"

#include <cstring>
#include <string>

#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/bodies.h"
#include "engine/world/contact_reading.h"
#include "engine/world/islands.h"
#include "engine/world/quarantine.h"
#include "engine/world/step.h"
#include "engine/world/validate.h"
#include "engine/world/world_bodies.h"
#include "engine/world/world_shapes.h"

namespace plumb {
namespace {

[[noreturn]] void report_gone(const char* what, std::uint32_t index, std::uint32_t generation) {
  const bool never = index == 0xFFFFFFFFu;
  throw Error(Error::Kind::Name, what, "handle",
              never ? "none" : std::to_string(index) + " of generation " + std::to_string(generation),
              never ? "names nothing" : "names something that was destroyed, or is of another world");
}

}  // namespace

template <class Real>
BasicWorld<Real>::BasicWorld(const WorldDefinition& definition) : data_(std::make_unique<WorldData<Real>>()) {
  validate(definition);
  data_->settings = definition;
}
template <class Real>
BasicWorld<Real>::~BasicWorld() = default;
template <class Real>
BasicWorld<Real>::BasicWorld(BasicWorld&&) noexcept = default;
template <class Real>
BasicWorld<Real>& BasicWorld<Real>::operator=(BasicWorld&&) noexcept = default;

template <class Real>
void BasicWorld<Real>::step(double dt, int substeps) {
  require_positive("step", "dt", dt);
  if (substeps < 1 || substeps > 1000) {
    throw Error(Error::Kind::Value, "step", "substeps", std::to_string(substeps),
                "must be a number from 1 to 1000");
  }
  step_world(*data_, dt, substeps);
}

template <class Real>
double BasicWorld<Real>::time() const {
  return data_->time;
}
template <class Real>
std::int64_t BasicWorld<Real>::step_count() const {
  return data_->steps;
}
template <class Real>
const Events& BasicWorld<Real>::events() const {
  return data_->events;
}

template <class Real>
void BasicWorld<Real>::set_gravity(Vec2d gravity) {
  require_finite("world", "gravity", gravity);
  data_->settings.gravity = gravity;
  data_->bodies.for_each([&](int body, BodyRecord<Real>&) { wake_body(*data_, body); });
}
template <class Real>
Vec2d BasicWorld<Real>::gravity() const {
  return data_->settings.gravity;
}
template <class Real>
void BasicWorld<Real>::set_sleeping(bool on) {
  data_->settings.sleeping = on;
  if (on) return;
  data_->bodies.for_each([&](int body, BodyRecord<Real>&) { wake_body(*data_, body); });
}
template <class Real>
void BasicWorld<Real>::set_continuous(bool on) {
  data_->settings.continuous = on;
}

template <class Real>
void BasicWorld<Real>::set_solver(Solver solver) {
  WorldDefinition changed = data_->settings;
  changed.solver = solver;
  validate(changed);
  data_->settings = changed;
  data_->ties_changed = true;
}
template <class Real>
Solver BasicWorld<Real>::solver() const {
  return data_->settings.solver;
}
template <class Real>
void BasicWorld<Real>::set_iterations(int iterations) {
  WorldDefinition changed = data_->settings;
  changed.iterations = iterations;
  validate(changed);
  data_->settings = changed;
}
template <class Real>
int BasicWorld<Real>::iterations() const {
  return data_->settings.iterations;
}
template <class Real>
void BasicWorld<Real>::set_direct_islands(bool on) {
  data_->settings.direct_islands = on;
}

template <class Real>
void BasicWorld<Real>::set_quarantine(bool on) {
  data_->settings.quarantine = on;
}
template <class Real>
std::vector<QuarantineEvent> BasicWorld<Real>::quarantined() const {
  std::vector<QuarantineEvent> all;
  for (const QuarantinedBody& each : data_->quarantine) all.push_back(each.why);
  return all;
}
template <class Real>
bool BasicWorld<Real>::quarantined(BodyId body) const {
  return data_->bodies[place(body)].quarantined;
}
template <class Real>
void BasicWorld<Real>::release(BodyId body) {
  const int index = place(body);
  if (data_->bodies[index].quarantined) release_body(*data_, index);
}

template <class Real>
WorldCounts BasicWorld<Real>::counts() const {
  const WorldData<Real>& w = *data_;
  return {w.bodies.count(),
          static_cast<int>(w.awake.size()),
          w.shapes.count(),
          w.contacts.count(),
          static_cast<int>(w.graph.size() + w.parked.size()),
          w.joints.count()};
}

template <class Real>
void BasicWorld<Real>::on_pre_solve(std::function<bool(const ContactReading&)> hook) {
  if (!hook) {
    data_->pre_solve = nullptr;
    return;
  }
  // The data outlives the hook, and stays where it is when the world is moved.
  WorldData<Real>* w = data_.get();
  data_->pre_solve = [w, hook = std::move(hook)](int contact, ContactConstraint<Real>& constraint) {
    return hook(reading_of(*w, w->contacts[contact], constraint));
  };
}

template <class Real>
void BasicWorld<Real>::combine_with(CombineFunction friction, CombineFunction restitution) {
  data_->friction_rule = friction, data_->restitution_rule = restitution;
}

template <class Real>
std::uint64_t BasicWorld<Real>::hash() const {
  const WorldData<Real>& w = *data_;
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto mix = [&](const auto& value) {
    unsigned char bytes[sizeof(value)];
    std::memcpy(bytes, &value, sizeof(value));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001B3u;
  };
  for (int body = 0; body < w.bodies.size(); ++body) {
    if (!w.bodies.used(body)) continue;
    mix(w.position[body]), mix(w.bodies[body].angle), mix(w.rotation[body]);
    mix(w.motion[body].velocity), mix(w.motion[body].angular_velocity);
  }
  return hash;
}

template <class Real>
int BasicWorld<Real>::place(BodyId body) const {
  if (!data_->bodies.holds(body.index, body.generation)) report_gone("body", body.index, body.generation);
  return static_cast<int>(body.index);
}
template <class Real>
int BasicWorld<Real>::place(ShapeId shape) const {
  if (!data_->shapes.holds(shape.index, shape.generation))
    report_gone("shape", shape.index, shape.generation);
  return static_cast<int>(shape.index);
}
template <class Real>
int BasicWorld<Real>::place(JointId joint) const {
  if (!data_->joints.holds(joint.index, joint.generation))
    report_gone("joint", joint.index, joint.generation);
  return static_cast<int>(joint.index);
}
template <class Real>
int BasicWorld<Real>::place(ChainId chain) const {
  if (!data_->chains.holds(chain.index, chain.generation))
    report_gone("chain", chain.index, chain.generation);
  return static_cast<int>(chain.index);
}

template class BasicWorld<float>;
template class BasicWorld<double>;

}  // namespace plumb
