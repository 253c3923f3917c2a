#pragma once

#include <utility>
#include <vector>

#include "engine/forces/wrench.h"
#include "engine/linear_algebra/bounded_rows.h"
#include "engine/math/vec2.h"

namespace plumb {

/// A step of bodies connected by springs, by the energy-conserving method of discrete gradients (Gonzalez,
/// Journal of Nonlinear Science 6, 1996; Simo, Tarnow and Wong, Computer Methods in Applied Mechanics and
/// Engineering 100, 1992). Let d be the vector between the ends of a spring, l its length, and 0 and 1 the
/// start and the end of the step. Then the pull k (1 - 2 rest_length / (l0 + l1)) (d0 + d1) / 2 does work
/// equal to its loss of elastic energy exactly, however stiff the spring is and however far its bodies move
/// or rotate. All springs are solved together, by Newton's method with the restoring parts of the derivative:
/// along the line, across it, and of the lever arms. If that does not converge, the motion is moved towards
/// one that conserves energy.
class ElasticStep {
 public:
  /// A body at the start of the step.
  struct Body {
    Vec2d position{};            ///< m, of the centre of mass
    Vec2d inverse_mass{};        ///< 1/kg, along x and y: 0 along a locked axis
    double inverse_inertia = 0;  ///< 1/(kg m^2)
  };
  struct Spring {
    int a = 0, b = 0;         ///< indices that `add_body` returned
    Vec2d arm_a{}, arm_b{};   ///< m, from the centres of mass, in the world's axes
    double rest_length = 0;   ///< m
    double stiffness = 0;     ///< N/m
    double damping = 0;       ///< N s/m
    bool pulls_only = false;  ///< a rubber band: slack below its rest length
  };

  void clear();
  int add_body(const Body& body);
  void add(const Spring& spring) { springs_.push_back(spring); }
  const Body& body(int index) const { return bodies_[index]; }

  /// Sets a body's displacement (m) and rotation (rad) over the step without the springs.
  void set_free_motion(int body, Vec2d displacement, double rotation) {
    free_[body] = {displacement, rotation};
  }
  /// Computes the springs' mean wrenches over a step of `dt` s. They are not finite if no motion was found.
  void solve(double dt);
  const Wrench<double>& wrench(int body) const { return wrenches_[body]; }

 private:
  /// Displacement over the step.
  struct Motion {
    Vec2d displacement{};  ///< m
    double rotation = 0;   ///< rad
  };
  /// A spring over the step.
  struct Line {
    Vec2d arm_a{}, arm_b{};        ///< m, effective arms: with them torques do the pulls' work
    Vec2d axis{};                  ///< mean direction, of unit length
    Vec2d pull{};                  ///< N, on a
    double along = 0, across = 0;  ///< N/m, restoring derivative of the pull along the axis and across it
  };
  /// Group of bodies connected by springs. Energies are multiplied by dt^2 / 2, in kg m^2.
  struct Group {
    Vec2d mass{}, moment{};         ///< kg along x and y; these times the free motion, kg m
    bool needs_correction = false;  ///< its motion is corrected
    bool anchored = false;          ///< one of its bodies is not moved by forces
    double size = 0;                ///< energy at the start
    double gain = 0;                ///< energy that the motion adds
    double min_fraction = 0, max_fraction = 1,
           fraction = 0;  ///< fraction of the correction, and its bounds during the search
  };

  Vec2d line_before(const Spring& spring) const;
  Vec2d line_after(const Spring& spring) const;
  Motion moved_by(int body, double dt) const;
  double energy_of(int body, const Motion& motion) const;
  Line line_of(const Spring& spring, double dt) const;
  double evaluate(double dt);
  void make_rows(double dt);
  void order();
  void compute_scales(double dt);
  void compute_newton_step(double dt);
  void refine(double dt);
  double bound(double fraction) const;
  double newton(double dt);
  void find_groups(double dt);
  void compute_gains(double dt);
  void blend(double dt);
  int group_of(const Spring& spring) const;
  double damping_of(const Spring& spring) const;
  void conserve_energy(double dt);

  BoundedRows system_;
  std::vector<Body> bodies_;
  std::vector<Spring> springs_;
  std::vector<double> damping_;                            // by body: dt c / m of all its springs
  double rounding_ = 0;                                    // kg m^2, squared residual due to rounding
  std::vector<Wrench<double>> wrenches_;                   // by body
  std::vector<Motion> free_, moved_, step_, last_, best_;  // by body
  std::vector<Line> lines_;                                // by spring
  std::vector<std::pair<int, int>> connected_,
      ordered_;  // bodies of the springs, now and in the last order
  std::vector<int> sizes_;
  std::vector<int> group_of_;  // by body
  std::vector<Group> groups_;
};

}  // namespace plumb
