#pragma once

#include <memory>

#include "engine/driver/driver.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Returns a point near the scene if the scene lies so far from the origin that coordinates would lose
/// digits; otherwise zero.
Vec2d local_origin(const Scene& scene);

/// Returns the scene relative to `origin`, which is subtracted from all positions in the world's frame.
Scene relative_to(const Scene& scene, Vec2d origin);

/// Wraps the driver of a scene that is `relative_to` a point, so that it acts as a driver of the scene
/// itself.
class ShiftedOriginDriver final : public Driver {
 public:
  ShiftedOriginDriver(std::unique_ptr<Driver> driver, Vec2d origin)
      : driver_(std::move(driver)), origin_(origin) {}

  void step() override { driver_->step(); }
  double time() const override { return driver_->time(); }
  void read(std::span<BodyState> out) const override {
    driver_->read(out);
    for (BodyState& state : out) state.position += origin_;
  }
  void write(std::size_t body, const BodyState& state) override {
    BodyState shifted = state;
    shifted.position -= origin_;
    driver_->write(body, shifted);
  }
  std::vector<std::byte> save() const override { return driver_->save(); }
  void restore(std::span<const std::byte> snapshot) override { driver_->restore(snapshot); }
  Reactions reactions() override {
    Reactions found = driver_->reactions();
    for (JointReaction& joint : found.joints) joint.position += origin_;
    for (ContactReaction& contact : found.contacts) contact.position += origin_;
    return found;
  }
  std::vector<BodyState> sensitivities(std::size_t parameter) override {
    return driver_->sensitivities(parameter);
  }
  const Plan& plan() const override { return driver_->plan(); }
  void profile(bool on) override { driver_->profile(on); }
  Statistics statistics() const override { return driver_->statistics(); }

 private:
  std::unique_ptr<Driver> driver_;
  Vec2d origin_;
};

}  // namespace plumb::precise
