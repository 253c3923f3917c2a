#pragma once

#include <vector>

#include "engine/driver/snapshot.h"
#include "engine/forces/attraction_force.h"
#include "engine/forces/spring_force.h"
#include "engine/realtime/bodies.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Keeps account of a run's energy, where the scene says what may become of it: with joints, springs,
/// attractions and gravity alone it stays; contacts, drag and dampers may only take some. Forces that depend
/// on time and bodies that are moved bring in what they like: then there is no account.
template <class Real>
class EnergyWatch {
 public:
  EnergyWatch(const Scene& scene, const Bodies<Real>& bodies, bool contacts);

  bool active() const { return active_; }

  /// The energy is counted from here on.
  void begin(const Bodies<Real>& bodies);

  /// Returns the energy gained, or lost (< 0) where nothing dissipates, as a fraction of the maximum in
  /// motion; 0 within rounding.
  double change(const Bodies<Real>& bodies);

  /// Accepts the present energy as not caused by the method; gains count from it.
  void forgive() { least_ = last_; }

  /// Returns true if something may dissipate energy.
  bool falls() const { return falls_; }

  void write(SnapshotWriter& out) const;
  void read(SnapshotReader& in);

 private:
  struct Mover {
    int body = 0;
    double mass = 0, inertia = 0;  // kg, kg m^2
    double reach = 0;              // m, of its shapes
    Vec2d start{};                 // m
  };

  void note_laws(const Scene& scene);
  double kinetic(const Bodies<Real>& bodies) const;
  double potential(const Bodies<Real>& bodies) const;

  bool active_ = false, falls_ = false, tied_ = false, jointed_ = false;
  bool fresh_ = false;  // the next step is the first one
  Vec2d gravity_{};
  std::vector<Mover> movers_;
  std::vector<SpringForceLaw<double>> springs_;
  std::vector<AttractionForceLaw<double>> attractions_;
  double start_ = 0, least_ = 0, last_ = 0, moving_ = 0;  // J
  double rounding_ = 0;                                   // J
  double standing_ = 0;  // J, with contacts: what lifts all by their own size
};

}  // namespace plumb
