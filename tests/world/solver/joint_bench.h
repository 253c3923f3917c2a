#pragma once

#include <cstddef>
#include <vector>

#include "engine/encoding/encoding.h"
#include "engine/math/trigonometry.h"
#include "engine/world/joint_solver/joint_set.h"

namespace plumb {

/// Bodies without shapes and the order of a substep: v += h a, warm start, solve, x += h v, relax.
template <class Real>
struct JointBench {
  std::vector<SolverBody<Real>> motion;
  std::vector<Rotation<Real>> rotation;
  std::vector<Vec2d> position;
  std::vector<double> angle;
  std::vector<Vec2<Real>> acceleration;
  std::vector<Real> angular_acceleration;
  JointSet<Real> joints;
  Vec2d gravity{};
  double hertz = 60, damping_ratio = 5;  ///< of rigid rows
  int substeps = 4;
  double last_h = 0;
  bool side_by_side = false;  ///< as a world solves them
  std::vector<char> apart;    ///< by joint: solved elsewhere

  /// A body by its inverse mass and inertia; it is static when both are 0.
  int body(Vec2d at, double inverse_mass, double inverse_inertia, double angle_at = 0) {
    motion.push_back({.inverse_mass = static_cast<Real>(inverse_mass),
                      .inverse_inertia = static_cast<Real>(inverse_inertia)});
    rotation.push_back(rotation_of(static_cast<Real>(angle_at)));
    position.push_back(at);
    angle.push_back(angle_at);
    acceleration.push_back({});
    angular_acceleration.push_back(0);
    return static_cast<int>(motion.size()) - 1;
  }
  bool dynamic(int body) const { return motion[body].inverse_mass + motion[body].inverse_inertia > 0; }
  int join(const JointKind& kind, int a, int b) {
    return joints.add(kind, a, b, {}, {}, dynamic(a), dynamic(b), bodies());
  }
  SolverBodies<Real> bodies() { return {motion.data(), rotation.data(), position.data()}; }

  void step(double dt) {
    const double h = dt / substeps;
    JointStep<Real> s;
    s.h = static_cast<Real>(h);
    s.inverse_h = static_cast<Real>(1 / h);
    s.inverse_dt = static_cast<Real>(1 / dt);
    s.softness = softness<Real>(hertz, damping_ratio, h);
    s.warm_start = last_h > 0 ? static_cast<Real>(h / last_h) : 1;
    last_h = h;
    LoopScheduler scheduler;
    if (side_by_side) {
      joints.prepare(bodies(), s, apart, &scheduler);
    } else {
      joints.prepare(bodies(), s);
    }
    for (int i = 0; i < substeps; ++i) {
      accelerate(s.h);
      joints.warm_start(bodies(), s);
      joints.solve(bodies(), s);
      move(s.h);
      joints.relax(bodies(), s);
    }
    if (side_by_side) joints.store_results(&scheduler), joints.finish(bodies(), &scheduler);
    finish();
  }
  void run(double time, double dt) {
    const int steps = static_cast<int>(time / dt + 0.5);
    for (int i = 0; i < steps; ++i) step(dt);
  }

 private:
  void accelerate(Real h) {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      SolverBody<Real>& m = motion[i];
      if (m.inverse_mass > 0) m.velocity += h * (acceleration[i] + gravity.as<Real>());
      m.angular_velocity += h * angular_acceleration[i];
    }
  }
  void move(Real h) {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      motion[i].delta_position += h * motion[i].velocity;
      motion[i].delta_angle += h * motion[i].angular_velocity;
      rotation[i] = rotation_of(static_cast<Real>(angle[i] + motion[i].delta_angle));
    }
  }
  void finish() {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      position[i] += motion[i].delta_position.template as<double>();
      angle[i] += motion[i].delta_angle;
      motion[i].delta_position = {};
      motion[i].delta_angle = 0;
    }
  }
};

/// Returns what a set of joints saves.
template <class Real>
std::vector<std::byte> bytes_of(const JointSet<Real>& joints) {
  std::vector<std::byte> bytes;
  Encoder out(bytes);
  joints.save(out);
  return bytes;
}

}  // namespace plumb
