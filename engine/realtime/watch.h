#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/snapshot.h"
#include "engine/realtime/contact.h"
#include "engine/realtime/tower.h"
#include "engine/realtime/watch_energy.h"
#include "engine/scene/error.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Looks after each step whether it kept what the fixed-step driver promises (`watch_bounds.h`): positions
/// are not rounded away, joints are closed, shapes do not lie in each other, nothing sinks, energy is not
/// made and, where nothing takes any, not lost. What was there at the start is no fault of the method: it may
/// not become more.
template <class Real>
class Watch {
 public:
  /// `names`, of the bodies, outlive it.
  Watch(const Scene& scene, const std::vector<std::string>& names, const Bodies<Real>& bodies, bool contacts);

  /// Somebody has moved bodies: the next step starts anew.
  void start_anew() { anew_ = true; }
  bool starts_anew() const { return anew_; }

  /// Tolerates violations present now, which the driver did not cause. Contacts must have been detected.
  void begin(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
             std::span<const SolidShape<Real>> shapes);

  /// How far the tallest tower would sway in substeps of `h`, s, with so many sweeps. `look` holds the last
  /// one to its bound.
  Sway sway(std::span<const Contact<Real>> contacts, double h, int sweeps);

  /// The first promise that is found broken; its problem says what was promised, and not after which step.
  std::optional<Error> look(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                            std::span<const SolidShape<Real>> shapes);

  void write(SnapshotWriter& out) const;
  void read(SnapshotReader& in);

 private:
  struct WatchedJoint {
    std::string name;
    int a = kFixedFrame, b = kFixedFrame;
    Vec2<Real> anchor_a{}, anchor_b{};  // m, in the bodies' frames
    Real length = 0;                    // m, of a rod
    Real span = 0;                      // m, the joint's own scale
    Real excess = 0;                    // m, open from the start
    int misses = 0;                     // steps in a row
  };
  struct DeepPair {
    PairKey pair = 0;
    Real depth = 0;  // m
    int misses = 0;
  };

  Real gap_of(const WatchedJoint& joint, const Bodies<Real>& bodies) const;
  std::optional<Error> look_at_positions(const Bodies<Real>& bodies) const;
  std::optional<Error> look_at_joints(const Bodies<Real>& bodies);
  std::optional<Error> look_at_overlaps(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                                        std::span<const SolidShape<Real>> shapes);
  std::optional<Error> look_at_sag();
  std::optional<Error> look_at_towers();
  std::optional<Error> look_at_energy(const Bodies<Real>& bodies);
  Real width_between(const Contact<Real>& contact, std::span<const SolidShape<Real>> shapes) const;
  bool lies_too_deep(PairKey pair, Real depth, Real bound);
  void note_sag(const Bodies<Real>& bodies, const Contact<Real>& contact, Real depth);
  void note_excess(const Bodies<Real>& bodies, std::span<const Contact<Real>> contacts,
                   std::span<const SolidShape<Real>> shapes);

  const std::vector<std::string>* names_;
  std::vector<char> dynamic_;  // by body
  std::vector<Real> width_;    // m, by body: of its narrowest shape
  std::vector<Real>
      farthest_;  // m, by body: from the origin, where positions are still fine enough; empty where none meet
  std::vector<WatchedJoint> joints_;
  std::vector<Real> excess_;            // m, by body, overlap from the start; empty where nothing overlapped
  std::vector<Real> deepest_;           // its next values
  std::vector<Real> sag_, sag_before_;  // of widths, by body
  std::vector<DeepPair> deep_, deep_before_;  // by pair
  std::vector<int> sag_misses_;               // by body
  int energy_misses_ = 0, drift_misses_ = 0, tower_misses_ = 0;
  TowerFinder<Real> towers_;
  Tower tallest_;
  Sway sway_;
  double gravity_ = 0;  // m/s^2
  Vec2<Real> up_{};
  EnergyWatch<Real> energy_;
  bool anew_ = true;
};

}  // namespace plumb
