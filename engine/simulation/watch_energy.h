#pragma once

#include <vector>

#include "engine/forces/attraction_force.h"
#include "engine/forces/spring_force.h"
#include "engine/scene/scene.h"
#include "engine/simulation/snapshot.h"
#include "engine/solve/bodies.h"

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

  /// What has been gained, or where nothing takes any lost (< 0), as a share of the most that was in motion;
  /// 0 while that is nothing beyond rounding.
  double change(const Bodies<Real>& bodies);

  /// What is there was not made by the method: gains count from it.
  void forgive() { least_ = last_; }

  /// Whether something may take energy.
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
