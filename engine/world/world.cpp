#include "engine/world/world.h"

#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/islands/direct_islands.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/state/bodies.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/state/validate.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/step/step.h"
#include "engine/world/world_bodies.h"
#include "engine/world/world_body_lists.h"
#include "engine/world/world_shapes.h"

namespace plumb {
namespace {

[[noreturn]] void throw_invalid_handle(const char* what, std::uint32_t index, std::uint32_t generation) {
  const bool never = index == 0xFFFFFFFFu;
  throw Error(Error::Kind::Name, what, "handle",
              never ? "none" : std::to_string(index) + " of generation " + std::to_string(generation),
              never ? "names nothing" : "names something that was destroyed, or is of another world");
}

// Changes the number or the source of a world's threads by calling `set`.
template <class Real, class Set>
void set_scheduler(WorldData<Real>& w, const Set& set) {
  try {
    set(w.scheduler);
  } catch (const std::system_error& error) {
    throw Error(Error::Kind::Run, "world", "threads", "", std::string("cannot be started: ") + error.what());
  }
}

}  // namespace

template <class Real>
BasicWorld<Real>::BasicWorld(const WorldDefinition& definition) : data_(OwnedPointer(new WorldData<Real>)) {
  validate(definition);
  data_->settings = definition;
  data_->settings.threads = 1;  // the scheduler stores the number
  set_scheduler(*data_, [&](LoopScheduler& scheduler) { scheduler.set_threads(definition.threads); });
}
// If a callback destroys the world, the running call takes over its data and deletes them.
template <class Real>
BasicWorld<Real>::~BasicWorld() {
  if (data_.moved_away() || (!data_->stepping && data_->active_callbacks == 0)) return;
  data_->abandoned = true;
  (void)data_.release();
}
template <class Real>
BasicWorld<Real>::BasicWorld(BasicWorld&&) noexcept = default;
template <class Real>
BasicWorld<Real>& BasicWorld<Real>::operator=(BasicWorld&& other) {
  if (!data_.moved_away()) require_unlocked(*data_);
  data_ = std::move(other.data_);
  return *this;
}

template <class Real>
void BasicWorld<Real>::throw_moved_from() {
  throw Error(Error::Kind::Name, "world", "", "", "was moved to another variable; use that one");
}
template <class Real>
WorldData<Real>& BasicWorld<Real>::data() {
  return *data_;
}
template <class Real>
const WorldData<Real>& BasicWorld<Real>::data() const {
  return *data_;
}

template <class Real>
void BasicWorld<Real>::step(double dt, int substeps) {
  unlocked(*this);
  require_positive("step", "dt", dt);
  if (substeps < 1 || substeps > 1000) {
    throw Error(Error::Kind::Value, "step", "substeps", std::to_string(substeps),
                "must be a number from 1 to 1000");
  }
  if (data_->steps >= kMaxSteps) {
    throw Error(Error::Kind::Run, "world", "steps", std::to_string(data_->steps),
                "are as many as can be counted; go on in a new world");
  }
  step_world(*data_, dt, substeps);
#ifdef PLUMB_VALIDATE
  check_state(*data_);
#endif
}

template <class Real>
double BasicWorld<Real>::time() const {
  return data().time;
}
template <class Real>
std::int64_t BasicWorld<Real>::step_count() const {
  return data().steps;
}
template <class Real>
const Events& BasicWorld<Real>::events() const {
  return data().events;
}

template <class Real>
void BasicWorld<Real>::set_gravity(Vec2d gravity) {
  unlocked(*this);
  require_finite("world", "gravity", gravity);
  data_->settings.gravity = gravity;
  wake_all();
}
template <class Real>
Vec2d BasicWorld<Real>::gravity() const {
  return data().settings.gravity;
}
template <class Real>
void BasicWorld<Real>::set_sleeping(bool on) {
  unlocked(*this);
  data_->rest_displacements.reserve(data_->bodies.size(), on);
  data_->settings.sleeping = on;
  if (!on) wake_all();
}
template <class Real>
void BasicWorld<Real>::set_continuous(bool on) {
  unlocked(*this);
  data_->settings.continuous = on;
}

template <class Real>
void BasicWorld<Real>::set_solver(Solver solver) {
  unlocked(*this);
  WorldDefinition changed = data_->settings;
  changed.solver = solver;
  validate(changed);
  if (solver != data_->settings.solver) {
    wake_all();
    hand_over_all(*data_);
  }
  data_->settings = changed;
  data_->topology_changed = true;
}
template <class Real>
Solver BasicWorld<Real>::solver() const {
  return data().settings.solver;
}
template <class Real>
void BasicWorld<Real>::set_iterations(int iterations) {
  unlocked(*this);
  WorldDefinition changed = data_->settings;
  changed.iterations = iterations;
  validate(changed);
  if (iterations != data_->settings.iterations) wake_all();
  data_->settings = changed;
}
template <class Real>
int BasicWorld<Real>::iterations() const {
  return data().settings.iterations;
}
template <class Real>
void BasicWorld<Real>::set_direct_islands(bool on) {
  unlocked(*this);
  if (on == data_->settings.direct_islands) return;
  wake_all();
  hand_over_all(*data_);
  data_->settings.direct_islands = on;
  data_->topology_changed = true;
}

template <class Real>
void BasicWorld<Real>::set_thresholds(const Thresholds& thresholds) {
  unlocked(*this);
  WorldDefinition changed = data_->settings;
  changed.thresholds = thresholds;
  validate(changed);
  if (thresholds != data_->settings.thresholds) wake_all();
  data_->settings.thresholds = thresholds;
}
template <class Real>
Thresholds BasicWorld<Real>::thresholds() const {
  return data().settings.thresholds;
}

template <class Real>
void BasicWorld<Real>::set_profiling(bool on) {
  unlocked(*this).profiled = on;
  if (on) data_->profile = {};
}
template <class Real>
const WorldProfile& BasicWorld<Real>::profile() const {
  return data().profile;
}

template <class Real>
void BasicWorld<Real>::set_threads(int threads) {
  unlocked(*this);
  require_threads(threads);
  set_scheduler(*data_, [&](LoopScheduler& scheduler) { scheduler.set_threads(threads); });
}
template <class Real>
int BasicWorld<Real>::threads() const {
  return data().scheduler.threads();
}
template <class Real>
void BasicWorld<Real>::set_task_system(const TaskSystem& tasks) {
  unlocked(*this);
  if ((tasks.start == nullptr) != (tasks.finish == nullptr)) {
    throw Error(Error::Kind::Value, "task system", tasks.start == nullptr ? "start" : "finish", "null",
                "must be given: both functions, or none for the world's own pool");
  }
  set_scheduler(*data_, [&](LoopScheduler& scheduler) { scheduler.set_tasks(tasks); });
}

template <class Real>
void BasicWorld<Real>::set_quarantine(bool on) {
  unlocked(*this);
  data_->settings.quarantine = on;
}
template <class Real>
std::vector<QuarantineEvent> BasicWorld<Real>::quarantined() const {
  std::vector<QuarantineEvent> all;
  for (const QuarantinedBody& each : data().quarantine) {
    if (each.why.field != BadField::None) all.push_back(each.why);
  }
  return all;
}
template <class Real>
bool BasicWorld<Real>::quarantined(BodyId body) const {
  const int index = index_of(body);
  return data_->bodies[index].quarantined && quarantine_of(*data_, index).why.field != BadField::None;
}
template <class Real>
void BasicWorld<Real>::release(BodyId body) {
  unlocked(*this);
  const int index = index_of(body);
  if (!quarantined(body)) return;
  apply_mass_changes(*data_);
  release_body(*data_, index);
}

template <class Real>
WorldCounts BasicWorld<Real>::counts() const {
  const WorldData<Real>& w = data();
  return {w.bodies.count(),
          static_cast<int>(w.awake.size()),
          w.shapes.count(),
          w.contacts.count(),
          static_cast<int>(w.graph.size() + w.sleeping_contacts.size()),
          w.joints.count()};
}

template <class Real>
void BasicWorld<Real>::on_pre_solve(std::function<bool(const ContactReading&)> hook) {
  unlocked(*this);
  wake_pre_solve_contacts();
  if (!hook) {
    data_->pre_solve = nullptr;
    return;
  }
  // The data outlive the hook, and stay in place when the world is moved.
  WorldData<Real>* w = &*data_;
  data_->pre_solve = [w, hook = std::move(hook)](const ContactRecord& contact,
                                                 const ContactConstraint<Real>& constraint) {
    return hook(reading_of(*w, contact, constraint));
  };
}

template <class Real>
void BasicWorld<Real>::on_filter(std::function<bool(ShapeId, ShapeId)> filter) {
  unlocked(*this);
  if (!filter) {
    data_->filter = nullptr;
    return;
  }
  const WorldData<Real>* w = &*data_;
  data_->filter = [w, filter = std::move(filter)](int a, int b) {
    const auto id = [&](int shape) {
      return ShapeId{static_cast<std::uint32_t>(shape), w->shapes.generation(shape)};
    };
    return filter(id(a), id(b));
  };
}

template <class Real>
void BasicWorld<Real>::combine_with(CombineFunction friction, CombineFunction restitution) {
  unlocked(*this);
  data_->friction_rule = friction, data_->restitution_rule = restitution;
}

template <class Real>
std::uint64_t BasicWorld<Real>::hash() const {
  const WorldData<Real>& w = data();
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
int BasicWorld<Real>::index_of(BodyId body) const {
  if (!data().bodies.holds(body.index, body.generation))
    throw_invalid_handle("body", body.index, body.generation);
  return static_cast<int>(body.index);
}
template <class Real>
int BasicWorld<Real>::index_of(ShapeId shape) const {
  if (!data().shapes.holds(shape.index, shape.generation))
    throw_invalid_handle("shape", shape.index, shape.generation);
  return static_cast<int>(shape.index);
}
template <class Real>
int BasicWorld<Real>::index_of(JointId joint) const {
  if (!data().joints.holds(joint.index, joint.generation))
    throw_invalid_handle("joint", joint.index, joint.generation);
  return static_cast<int>(joint.index);
}
template <class Real>
int BasicWorld<Real>::index_of(ChainId chain) const {
  if (!data().chains.holds(chain.index, chain.generation))
    throw_invalid_handle("chain", chain.index, chain.generation);
  return static_cast<int>(chain.index);
}

template <class Real>
void BasicWorld<Real>::wake_all() {
  data_->bodies.for_each([&](int body, BodyRecord<Real>&) { wake_body(*data_, body); });
}

// Wakes sleeping bodies with a contact that has a pre-solve hook.
template <class Real>
void BasicWorld<Real>::wake_pre_solve_contacts() {
  data_->contacts.for_each([&](int, const ContactRecord& contact) {
    if (contact.pre_solve && contact.home == ContactHome::Sleeping)
      wake_body(*data_, contact.body_a), wake_body(*data_, contact.body_b);
  });
}

template class BasicWorld<float>;
template class BasicWorld<double>;

}  // namespace plumb
