#include "engine/forces/force_jacobian.h"

#include <cmath>
#include <span>
#include <tuple>
#include <type_traits>
#include <variant>

#include "engine/forces/compile.h"
#include "engine/forces/laws.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

/// One end of a law: a body's index (or `kFixedFrame`), its pose and its motion.
struct End {
  int body = kFixedFrame;
  Pose<double> pose{};
  Twist<double> twist{};
};

/// A 2 x 2 matrix by its columns.
struct Matrix {
  Vec2d x{}, y{};
  friend Matrix operator+(Matrix a, Matrix b) { return {a.x + b.x, a.y + b.y}; }
  friend Matrix operator*(double s, Matrix a) { return {s * a.x, s * a.y}; }
  friend Vec2d operator*(Matrix a, Vec2d v) { return v.x * a.x + v.y * a.y; }
};

Matrix outer(Vec2d a, Vec2d b) { return {b.x * a, b.y * a}; }

/// Derivatives of a force f on one point (-f on another) that depends on the vector d from the one to the
/// other and on its rate w.
struct Coupling {
  Vec2d arms[2]{};  ///< m, of the points, from the centres of mass in the world's axes
  Vec2d force{};    ///< N, f
  Matrix by_offset{}, by_rate{};
};

void set_column(double (&block)[3][3], int column, Vec2d force, double torque) {
  block[0][column] = force.x, block[1][column] = force.y, block[2][column] = torque;
}

/// Adds the blocks of one law.
struct Derivative {
  double time;
  End ends[2];
  std::vector<ForceBlock>& out;

  ForceBlock& block(int on, int by) const {
    out.push_back({static_cast<std::size_t>(on), static_cast<std::size_t>(by)});
    return out.back();
  }
  ForceBlock& block() const { return block(ends[0].body, ends[0].body); }

  // F = -c v, T = -c_r w.
  void operator()(const LinearDrag& law) const {
    ForceBlock& b = block();
    b.velocity[0][0] = b.velocity[1][1] = -law.coefficient;
    b.velocity[2][2] = -law.angular_coefficient;
  }

  // F = -c |v| v: dF/dv = -c (|v| 1 + v v^T / |v|).
  void operator()(const QuadraticDrag& law) const {
    ForceBlock& b = block();
    const Vec2d v = ends[0].twist.velocity;
    const double speed = std::sqrt(length_squared(v)), c = law.coefficient;
    if (speed == 0) return;
    b.velocity[0][0] = -c * (speed + v.x * v.x / speed);
    b.velocity[1][1] = -c * (speed + v.y * v.y / speed);
    b.velocity[0][1] = b.velocity[1][0] = -c * v.x * v.y / speed;
  }

  // In the body's frame F turns with the body and its torque is constant; in the world's F is constant, and r
  // x F changes by (z x r) x F = -r . F.
  void operator()(const PointForce& law) const {
    ForceBlock& b = block();
    const Rotation<double> turn = ends[0].pose.rotation;
    const double fraction = active_fraction(law.start, law.duration, time, time);
    if (law.frame == Frame::Body) {
      const Vec2d turned = fraction * perpendicular(turn * law.force);
      b.position[0][2] = turned.x;
      b.position[1][2] = turned.y;
    } else {
      b.position[2][2] = -fraction * dot(turn * law.point, law.force);
    }
  }

  void operator()(const Torque&) const {}

  void operator()(const SinusoidalForce& law) const {
    const double sine = rotation_of(law.angular_frequency * time + law.phase).s;
    block().position[2][2] = -sine * dot(ends[0].pose.rotation * law.point, law.amplitude);
  }

  void operator()(const SpringForce& law) const {
    add_axial_force(law, [&](double length, double closing) {
      return Tension{law.stiffness * (length - law.rest_length) + law.damping * closing, law.stiffness,
                     law.damping};
    });
  }

  // f = mu m d / r^(n + 1): df/dd = mu m / r^(n + 1) (1 - (n + 1) u u^T).
  void operator()(const AttractionForce& law, double mass) const {
    Coupling c{.arms = {{}, ends[1].pose.rotation * law.centre}};
    const Vec2d offset = place(1, c.arms[1]) - place(0, c.arms[0]);
    const double distance = std::sqrt(length_squared(offset));
    if (distance > 0) {
      const double pull = law.strength * mass * whole_power(distance, -law.exponent - 1);
      const Vec2d u = (1 / distance) * offset;
      c.force = pull * offset;
      c.by_offset = pull * (outer(perpendicular(u), perpendicular(u)) + -law.exponent * outer(u, u));
    }
    couple(c);
  }

  // Each column from the formulas' derivatives along one coordinate; the torque r x F also changes as r
  // turns.
  void operator()(const FormulaForceLaw& law) const {
    ForceBlock& b = block();
    const FormulaForceLaw::Variables now = law.variables(time, ends[0].pose, ends[0].twist);
    const Vec2d arm = ends[0].pose.rotation * law.point;
    for (int k = 0; k < 6; ++k) {
      Jet values[std::tuple_size_v<FormulaForceLaw::Variables>];
      for (std::size_t i = 0; i < now.size(); ++i) values[i] = {now[i], i == 1 + std::size_t(k) ? 1.0 : 0.0};
      const std::span<const Jet> along(values);
      const Jet x = law.x.at(along), y = law.y.at(along), torque = law.torque.at(along);
      const Vec2d change{x.first, y.first};
      double turning = torque.first + cross(arm, change);
      if (k == 2) turning -= dot(arm, Vec2d{x.value, y.value});
      set_column(k < 3 ? b.position : b.velocity, k % 3, change, turning);
    }
  }

  void operator()(const FormulaSpringLaw& law) const {
    add_axial_force(law, [&](double length, double closing) {
      const Jet by_length[] = {time, {length, 1}, closing}, by_rate[] = {time, length, {closing, 1}};
      const Jet tension = law.tension.at(std::span<const Jet>(by_length));
      return Tension{tension.value, tension.first, law.tension.at(std::span<const Jet>(by_rate)).first};
    });
  }

  /// A tension, N, and its derivatives by the length, N/m, and by its rate, N s/m.
  struct Tension {
    double value, by_length, by_rate;
  };

  // f = T u with u = d/l, T of l and u.w, k and c its derivatives:
  // df/dd = k u u^T + T/l (1 - u u^T) + c/l u (w - (u.w) u)^T, df/dw = c u u^T.
  template <class Law, class TensionAt>
  void add_axial_force(const Law& law, const TensionAt& tension_at) const {
    Coupling c{.arms = {ends[0].pose.rotation * law.anchor_a, ends[1].pose.rotation * law.anchor_b}};
    const Vec2d offset = place(1, c.arms[1]) - place(0, c.arms[0]);
    const double length = std::sqrt(length_squared(offset));
    if (length > 0) {
      const Vec2d u = (1 / length) * offset, rate = velocity(1, c.arms[1]) - velocity(0, c.arms[0]);
      const double closing = dot(u, rate);
      const Tension tension = tension_at(length, closing);
      c.force = tension.value * u;
      c.by_offset = tension.by_length * outer(u, u) +
                    (tension.value / length) * outer(perpendicular(u), perpendicular(u)) +
                    (tension.by_rate / length) * outer(u, rate - closing * u);
      c.by_rate = tension.by_rate * outer(u, u);
    }
    couple(c);
  }

  Vec2d place(int end, Vec2d arm) const { return ends[end].pose.position + arm; }
  Vec2d velocity(int end, Vec2d arm) const {
    return ends[end].twist.velocity + cross(ends[end].twist.angular_velocity, arm);
  }

  /// d changes with the ends' positions and by z x r as they turn; w with their velocities and, as they turn,
  /// by z x (omega z x r) = -omega r. Torques r x f also change with r: by (z x r) x f = -r . f.
  void couple(const Coupling& c) const {
    for (const int on : {0, 1}) {
      for (const int by : {0, 1}) {
        if (ends[on].body == kFixedFrame || ends[by].body == kFixedFrame) continue;
        ForceBlock& b = block(ends[on].body, ends[by].body);
        const double sign = on == by ? -1 : 1;  // of dd/dx times the sign of the force
        const Vec2d arm = c.arms[by], lever = perpendicular(arm);
        const auto column = [&](double(&block)[3][3], int i, Vec2d change) {
          set_column(block, i, sign * change, sign * cross(c.arms[on], change));
        };
        column(b.position, 0, c.by_offset.x);
        column(b.position, 1, c.by_offset.y);
        column(b.position, 2, c.by_offset * lever - ends[by].twist.angular_velocity * (c.by_rate * arm));
        column(b.velocity, 0, c.by_rate.x);
        column(b.velocity, 1, c.by_rate.y);
        column(b.velocity, 2, c.by_rate * lever);
        if (on == by) b.position[2][2] -= (on == 0 ? 1 : -1) * dot(arm, c.force);
      }
    }
  }
};

}  // namespace

ForceJacobian::ForceJacobian(const Scene& scene) {
  for (const ForceLaw& law : scene.forces) {
    Law entry{law};
    const auto names = ends_of(law);
    for (const int end : {0, 1}) {
      if (const auto body = find_body(scene, names[end])) entry.bodies[end] = static_cast<int>(*body);
    }
    if (entry.bodies[0] != kFixedFrame) entry.mass = scene.bodies[entry.bodies[0]].mass;
    const LawCompiler compiler(scene);
    if (const auto* force = std::get_if<FormulaForce>(&law)) entry.force = compiler.compile(*force);
    if (const auto* spring = std::get_if<FormulaSpring>(&law)) entry.spring = compiler.compile(*spring);
    laws_.push_back(entry);
  }
}

void ForceJacobian::evaluate(double time, std::span<const Pose<double>> poses,
                             std::span<const Twist<double>> twists, std::vector<ForceBlock>& out) const {
  out.clear();
  for (const Law& law : laws_) {
    Derivative derivative{time, {}, out};
    for (const int end : {0, 1}) {
      const int body = law.bodies[end];
      if (body != kFixedFrame) derivative.ends[end] = {body, poses[body], twists[body]};
    }
    std::visit(
        [&](const auto& l) {
          using Kind = std::remove_cvref_t<decltype(l)>;
          if constexpr (std::is_same_v<Kind, FormulaForce>) {
            derivative(law.force);
          } else if constexpr (std::is_same_v<Kind, FormulaSpring>) {
            derivative(law.spring);
          } else if constexpr (requires { derivative(l, law.mass); }) {
            derivative(l, law.mass);
          } else {
            derivative(l);
          }
        },
        law.law);
  }
}

}  // namespace plumb
