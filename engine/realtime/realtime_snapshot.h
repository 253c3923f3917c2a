#pragma once

#include <vector>

#include "engine/driver/driver.h"
#include "engine/driver/snapshot.h"
#include "engine/realtime/contact.h"

namespace plumb {

template <class Real>
struct SavedMotion {
  Vec2<Real> position{}, remainder{};
  Real angle = 0;
  Twist<Real> twist{};
};

template <class Real>
struct SavedContactPoint {
  std::uint32_t feature = 0;
  ContactImpulse<Real> hold{}, relax{};
};

template <class Real>
struct SavedContact {
  PairKey pair = 0;
  int count = 0;
  bool impact = false;
  SavedContactPoint<Real> points[2];
};

/// All that a Realtime run's future depends on; the rest follows from the scene.
template <class Real>
struct SavedRealtime {
  std::int64_t step = 0;
  int substeps = 1;
  Statistics statistics{};
  std::vector<SavedMotion<Real>> motions;  ///< by body
  std::vector<Real> memory;                ///< of the joints
  std::vector<Aabb<Real>> boxes;           ///< by shape, or none
  std::vector<SavedContact<Real>> contacts;

  void write(SnapshotWriter& out) const {
    out.put(step), out.put(substeps);
    out.put(statistics);
    write_list(out, motions, [](SnapshotWriter& to, const SavedMotion<Real>& motion) {
      to.put(motion.position), to.put(motion.remainder), to.put(motion.angle);
      to.put(motion.twist.velocity), to.put(motion.twist.angular_velocity);
    });
    write_list(out, memory, [](SnapshotWriter& to, Real impulse) { to.put(impulse); });
    write_list(out, boxes,
               [](SnapshotWriter& to, const Aabb<Real>& box) { to.put(box.lower), to.put(box.upper); });
    write_list(out, contacts, [](SnapshotWriter& to, const SavedContact<Real>& contact) {
      to.put(contact.pair), to.put(contact.count), to.put(static_cast<std::uint8_t>(contact.impact));
      for (const SavedContactPoint<Real>& point : contact.points)
        to.put(point.feature), to.put(point.hold), to.put(point.relax);
    });
  }

  void read(SnapshotReader& in) {
    step = in.get<std::int64_t>(), substeps = in.get<int>();
    statistics = in.get<Statistics>();
    read_list(in, motions, [](SnapshotReader& from, SavedMotion<Real>& motion) {
      motion.position = from.get<Vec2<Real>>(), motion.remainder = from.get<Vec2<Real>>();
      motion.angle = from.get<Real>();
      motion.twist.velocity = from.get<Vec2<Real>>(), motion.twist.angular_velocity = from.get<Real>();
    });
    read_list(in, memory, [](SnapshotReader& from, Real& impulse) { impulse = from.get<Real>(); });
    read_list(in, boxes, [](SnapshotReader& from, Aabb<Real>& box) {
      box.lower = from.get<Vec2<Real>>(), box.upper = from.get<Vec2<Real>>();
    });
    read_list(in, contacts, [](SnapshotReader& from, SavedContact<Real>& contact) {
      contact.pair = from.get<PairKey>(), contact.count = from.get<int>();
      contact.impact = from.get<std::uint8_t>() != 0;
      from.expect(contact.count >= 0 && contact.count <= 2);
      for (SavedContactPoint<Real>& point : contact.points) {
        point.feature = from.get<std::uint32_t>();
        point.hold = from.get<ContactImpulse<Real>>(), point.relax = from.get<ContactImpulse<Real>>();
      }
    });
  }

 private:
  template <class T, class Put>
  static void write_list(SnapshotWriter& out, const std::vector<T>& list, Put put) {
    out.put(static_cast<std::uint64_t>(list.size()));
    for (const T& entry : list) put(out, entry);
  }
  template <class T, class Get>
  static void read_list(SnapshotReader& in, std::vector<T>& list, Get get) {
    list.resize(in.count(sizeof(Real)));
    for (T& entry : list) get(in, entry);
  }
};

}  // namespace plumb
