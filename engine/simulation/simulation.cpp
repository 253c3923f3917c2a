#include "engine/simulation/simulation.h"

#include <cmath>
#include <cstring>
#include <new>
#include <string>

#include "engine/core/hash.h"
#include "engine/core/text.h"
#include "engine/driver/snapshot.h"
#include "engine/scene/check.h"
#include "engine/scene/error.h"

namespace plumb {
namespace {

std::uint64_t sum_of_bytes(std::span<const std::byte> bytes) {
  Fnv1a hash;
  for (const std::byte byte : bytes) hash.add(static_cast<std::uint64_t>(byte));
  return hash.value();
}

void require_body(std::size_t body, std::size_t count) {
  if (body < count) return;
  throw Error(Error::Kind::Value, "world", "body", std::to_string(body),
              "there are " + std::to_string(count) + " bodies");
}

/// Checks a number against the limit that applies to a scene's numbers.
void require_number(const std::string& subject, const char* field, double value) {
  if (std::abs(value) <= kLargest) return;
  throw Error(Error::Kind::Value, subject, field, shortest(value),
              "must be a number of at most " + shortest(kLargest) + " in magnitude");
}

/// The header of every snapshot.
struct SnapshotHeader {
  char magic[8] = {'p', 'l', 'u', 'm', 'b', 's', '0', '2'};
  std::uint64_t identity = 0;
  std::uint64_t size = 0;      // bytes that follow
  std::uint64_t checksum = 0;  // of those bytes
};

}  // namespace

PLUMB_MEMBERS(SnapshotHeader, magic, identity, size, checksum)

Simulation::Simulation(OwnedPointer<Driver> driver, std::size_t body_count, std::uint64_t identity)
    : driver_(std::move(driver)), body_count_(body_count), identity_(identity) {}

void Simulation::step(int count) {
  if (count < 0)
    throw Error(Error::Kind::Value, "simulation", "count", std::to_string(count), "must not be negative");
  if (abandoned_)
    throw Error(Error::Kind::Run, "simulation", "memory", "",
                "there was not enough of it for an earlier step; compile the scene anew");
  try {
    for (int i = 0; i < count; ++i) driver_->step();
  } catch (const std::bad_alloc&) {
    abandoned_ = true;
    driver_->abandon_step();
    throw Error(Error::Kind::Run, "simulation", "memory", "",
                "there is not enough of it for a step; fewer bodies, or fewer that touch, need less");
  }
}

double Simulation::time() const { return driver_->time(); }
std::size_t Simulation::body_count() const { return body_count_; }

BodyState Simulation::state(std::size_t body) const {
  require_body(body, body_count_);
  std::vector<BodyState> states(body_count_);
  driver_->read(states);
  return states[body];
}

void Simulation::read(std::span<BodyState> out) const {
  if (out.size() != body_count_)
    throw Error(Error::Kind::Value, "world", "read", std::to_string(out.size()),
                "the array must have one element a body: " + std::to_string(body_count_));
  driver_->read(out);
}

void Simulation::set_state(std::size_t body, const BodyState& state) {
  require_body(body, body_count_);
  const std::string subject = "body " + std::to_string(body);
  require_number(subject, "position", state.position.x),
      require_number(subject, "position", state.position.y);
  require_number(subject, "angle", state.angle);
  require_number(subject, "velocity", state.velocity.x),
      require_number(subject, "velocity", state.velocity.y);
  require_number(subject, "angular_velocity", state.angular_velocity);
  driver_->write(body, state);
}

Reactions Simulation::forces() const { return driver_->reactions(); }

std::vector<BodyState> Simulation::sensitivities(std::size_t parameter) const {
  return driver_->sensitivities(parameter);
}

std::uint64_t Simulation::hash() const {
  std::vector<BodyState> states(body_count_);
  driver_->read(states);
  Fnv1a hash;
  for (const BodyState& state : states)
    for (const double value : {state.position.x, state.position.y, state.angle, state.velocity.x,
                               state.velocity.y, state.angular_velocity})
      hash.add(value);
  hash.add(driver_->time());
  return hash.value();
}

std::vector<std::byte> Simulation::save() const {
  const std::vector<std::byte> payload = driver_->save();
  SnapshotHeader header;
  header.identity = identity_;
  header.size = payload.size();
  header.checksum = sum_of_bytes(payload);
  std::vector<std::byte> bytes;
  Encoder(bytes).put(header);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

void Simulation::restore(std::span<const std::byte> snapshot) {
  SnapshotReader in(snapshot);
  const auto header = in.get<SnapshotHeader>();
  const std::span<const std::byte> payload = in.rest();
  const auto refuse = [](const char* problem) {
    throw Error(Error::Kind::Value, "snapshot", "", "", problem);
  };
  if (std::memcmp(header.magic, SnapshotHeader{}.magic, sizeof header.magic) != 0)
    refuse("it is not one of plumb's");
  if (header.identity != identity_) refuse("it is of another scene or other settings");
  if (header.size != payload.size()) refuse("it has the wrong length");
  if (header.checksum != sum_of_bytes(payload)) refuse("its bytes have been changed");
  driver_->restore(payload);
}

const Plan& Simulation::plan() const { return driver_->plan(); }
void Simulation::profile(bool on) { driver_->profile(on); }
Statistics Simulation::statistics() const { return driver_->statistics(); }
const Error* Simulation::violation() const { return driver_->violation(); }

}  // namespace plumb
