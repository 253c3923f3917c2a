#include <cmath>
#include <string>

#include "engine/core/text.h"
#include "engine/realtime/realtime.h"
#include "engine/realtime/realtime_snapshot.h"
#include "engine/realtime/substeps.h"
#include "engine/scene/error.h"

namespace plumb {

template <class Real>
double RealtimeDriver<Real>::time() const {
  return static_cast<double>(step_) * accuracy_.dt;
}

template <class Real>
void RealtimeDriver<Real>::read(std::span<BodyState> out) const {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    // + 0 makes a negative zero positive: which of the two a sum gave is no part of the state.
    const Vec2d zero{};
    out[body].position = bodies_.pose[body].position.template as<double>() + zero;
    out[body].angle = static_cast<double>(bodies_.angle[body]) + 0.0;
    out[body].velocity = bodies_.twist[body].velocity.template as<double>() + zero;
    out[body].angular_velocity = static_cast<double>(bodies_.twist[body].angular_velocity) + 0.0;
  }
}

template <class Real>
void RealtimeDriver<Real>::set_motion(std::size_t body, const BodyState& state) {
  bodies_.angle[body] = static_cast<Real>(state.angle);
  bodies_.pose[body] = {state.position.as<Real>(), rotation_of(bodies_.angle[body])};
  bodies_.twist[body] = {state.velocity.as<Real>(),
                         fixed_rotation_[body] ? Real{0} : static_cast<Real>(state.angular_velocity)};
}

template <class Real>
void RealtimeDriver<Real>::write(std::size_t body, const BodyState& state) {
  set_motion(body, state);
  remainder_[body] = {};
  if (watch_) watch_->start_anew();
  if (bodies_.twist[body].angular_velocity != 0 && !is_active(plan_, Turn)) {
    Stage& turn = plan_.stages[static_cast<std::size_t>(Turn)];
    turn.active = true;
    turn.why = "body '" + names_[body] + "' was set spinning";
  }
  if (finder_) finder_->touch(static_cast<int>(body));
  for (Contact<Real>& contact : contacts_) {
    if (contact.a != static_cast<int>(body) && contact.b != static_cast<int>(body)) continue;
    contact.impact = contact.placed = false;
    for (ContactPoint<Real>& point : contact.points) point.hold = point.relax = {};
  }
  if (joints_) joints_->forget();
}

/// No NaN leaves the engine: a step that made one is taken back.
template <class Real>
void RealtimeDriver<Real>::check() {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const Pose<Real>& pose = bodies_.pose[body];
    const Twist<Real>& twist = bodies_.twist[body];
    const std::pair<const char*, Real> parts[] = {

        {"position x", pose.position.x},  {"position y", pose.position.y},
        {"angle", bodies_.angle[body]},   {"velocity x", twist.velocity.x},
        {"velocity y", twist.velocity.y}, {"angular velocity", twist.angular_velocity}};
    for (const auto& [field, value] : parts) {
      if (std::isfinite(value)) continue;
      roll_back();
      throw Error(Error::Kind::Run, "body '" + names_[body] + "'", field,
                  shortest(static_cast<double>(value)),
                  "not finite after " + after_this_step() + ". A smaller dt may help");
    }
  }
}

/// A step that broke a promise is taken back, or noted.
template <class Real>
void RealtimeDriver<Real>::watch() {
  if (!watch_ || doubt_) return;
  const std::optional<Error> found = watch_->look(bodies_, contacts_, shapes());
  if (!found) return;
  const Error error(found->kind(), found->subject(), found->field(), found->value(),
                    found->problem() + ". After " + after_this_step());
  if (accuracy_.on_doubt == OnDoubt::Report) {
    doubt_ = error;
    return;
  }
  roll_back();
  throw error;
}

template <class Real>
std::string RealtimeDriver<Real>::after_this_step() const {
  return "step " + std::to_string(step_ + 1) +
         " (t = " + shortest(static_cast<double>(step_ + 1) * accuracy_.dt) +
         " s); the world is left as it was before that step";
}

/// Allocates nothing.
template <class Real>
void RealtimeDriver<Real>::put_back_motion() {
  bodies_.pose = last_pose_;
  bodies_.angle = last_angle_;
  bodies_.twist = last_twist_;
  remainder_ = last_remainder_;
}

template <class Real>
void RealtimeDriver<Real>::roll_back() {
  put_back_motion();
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    if (finder_) finder_->touch(static_cast<int>(body));
  for (Contact<Real>& contact : contacts_) {
    contact.impact = contact.bounced = contact.placed = false;
    for (ContactPoint<Real>& point : contact.points) point.hold = point.relax = {};
  }
  if (joints_) joints_->forget();
}

/// Allocates nothing.
template <class Real>
void RealtimeDriver<Real>::abandon_step() {
  put_back_motion();
}

template <class Real>
std::vector<std::byte> RealtimeDriver<Real>::save() const {
  SavedRealtime<Real> saved;
  saved.step = step_;
  saved.substeps = accuracy_.substeps;
  saved.statistics = statistics_;
  for (std::size_t body = 0; body < bodies_.size(); ++body)
    saved.motions.push_back(
        {bodies_.pose[body].position, remainder_[body], bodies_.angle[body], bodies_.twist[body]});
  if (joints_) saved.memory.assign(joints_->memory().begin(), joints_->memory().end());
  if (finder_) saved.boxes = finder_->boxes();
  for (const Contact<Real>& contact : contacts_) {
    SavedContact<Real>& entry = saved.contacts.emplace_back();
    entry = {contact.pair, contact.count, contact.impact, {}};
    for (int i = 0; i < contact.count; ++i)
      entry.points[i] = {contact.points[i].feature, contact.points[i].hold, contact.points[i].relax};
  }
  SnapshotWriter out;
  saved.write(out);
  if (watch_) watch_->write(out);
  return out.bytes();
}

template <class Real>
void RealtimeDriver<Real>::restore(std::span<const std::byte> snapshot) {
  SavedRealtime<Real> saved;
  SnapshotReader in(snapshot);
  saved.read(in);
  in.expect(saved.motions.size() == bodies_.size());
  in.expect(saved.substeps >= 1 && saved.substeps <= kMostSubsteps);
  in.expect(saved.memory.size() == (joints_ ? joints_->memory().size() : 0));
  const std::size_t shapes = finder_ ? finder_->shapes().size() : 0;
  in.expect(saved.boxes.empty() || saved.boxes.size() == shapes);
  for (const SavedContact<Real>& contact : saved.contacts)
    in.expect(static_cast<std::size_t>(second_of(contact.pair)) < shapes &&
              first_of(contact.pair) < second_of(contact.pair));
  std::unique_ptr<plumb::Watch<Real>> watched =
      watch_ ? std::make_unique<plumb::Watch<Real>>(*watch_) : nullptr;
  if (watched) watched->read(in);
  in.expect_end();
  // Nothing has been changed up to here, and nothing can fail from here on.
  watch_ = std::move(watched);
  doubt_.reset();
  step_ = saved.step;
  accuracy_.substeps = plan_.substeps = saved.substeps;
  statistics_ = saved.statistics;
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const SavedMotion<Real>& motion = saved.motions[body];
    bodies_.angle[body] = motion.angle;
    bodies_.pose[body] = {motion.position, rotation_of(motion.angle)};
    bodies_.twist[body] = motion.twist;
    remainder_[body] = motion.remainder;
    if (motion.twist.angular_velocity != 0) plan_.stages[static_cast<std::size_t>(Turn)].active = true;
  }
  if (joints_) {
    joints_->forget();
    std::copy(saved.memory.begin(), saved.memory.end(), joints_->memory().begin());
  }
  contacts_.clear();
  contacts_changed_ = true;
  if (!finder_) return;
  finder_->put_boxes(saved.boxes);
  for (const SavedContact<Real>& entry : saved.contacts) {
    Contact<Real> contact = finder_->make_contact(entry.pair, bodies_);
    contact.count = entry.count;
    contact.impact = entry.impact;
    for (int i = 0; i < 2; ++i) {
      contact.points[i].feature = entry.points[i].feature;
      contact.points[i].hold = entry.points[i].hold;
      contact.points[i].relax = entry.points[i].relax;
    }
    contacts_.push_back(contact);
  }
}

#define PLUMB_INSTANTIATE(Real)                                                  \
  template double RealtimeDriver<Real>::time() const;                            \
  template void RealtimeDriver<Real>::read(std::span<BodyState>) const;          \
  template void RealtimeDriver<Real>::write(std::size_t, const BodyState&);      \
  template void RealtimeDriver<Real>::set_motion(std::size_t, const BodyState&); \
  template void RealtimeDriver<Real>::check();                                   \
  template void RealtimeDriver<Real>::abandon_step();                            \
  template void RealtimeDriver<Real>::watch();                                   \
  template void RealtimeDriver<Real>::roll_back();                               \
  template std::vector<std::byte> RealtimeDriver<Real>::save() const;            \
  template void RealtimeDriver<Real>::restore(std::span<const std::byte>);
PLUMB_INSTANTIATE(float)
PLUMB_INSTANTIATE(double)
#undef PLUMB_INSTANTIATE

}  // namespace plumb
