#include "engine/precise/integration/stiff.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb::precise {
namespace {

/// Regularisation that fixes the free multipliers of dependent rows, relative to the response to a row's own
/// impulse.
constexpr double kRedundant = 1e-12;

}  // namespace

StiffMotion::StiffMotion(const Scene& scene, const ScenePartition& partition, EquationsOfMotion& equations)
    : equations_(equations),
      force_jacobian_(with_laws_on(scene, partition.integrated)),
      slot_(scene.bodies.size(), -1),
      rate_(equations.dimension()) {
  for (const std::size_t body : partition.integrated) {
    slot_[body] = static_cast<int>(inverse_mass_.size());
    inverse_mass_.push_back(equations.inverse_mass(body));
    inverse_inertia_.push_back(equations.inverse_inertia(body));
  }
}

void StiffMotion::linearise(double time, std::span<const double> y) {
  equations_.rate_with_rows(time, y, rate_);
  force_jacobian_.evaluate(time, equations_.poses(), equations_.twists(), blocks_);
  rows_.assign(equations_.rows().begin(), equations_.rows().end());
  add_tension();
  const BodiesView now = equations_.bodies_view();
  const GeneralJoints& others = equations_.general_joints();
  others.add_spring_blocks(now, blocks_);
  others.add_tension_blocks(now, equations_.multipliers().subspan(equations_.joints().row_count()), blocks_);
  if (!order_is_known()) find_order();
}

ForceBlock& StiffMotion::block(int on, int by) {
  blocks_.push_back({static_cast<std::size_t>(on), static_cast<std::size_t>(by)});
  return blocks_.back();
}

/// Adds joint forces with constant multipliers as laws of force. A revolute joint pushes with f at r_b and
/// with -f at r_a: the torques r x f change by -r . f as r turns. The force l u of a distance joint also
/// turns with its direction u. With s = (-u_y, u_x), perpendicular to it, and p = (s, r x s), the anchors'
/// motion along s, the change is l / d times p p^T.
void StiffMotion::add_tension() {
  const std::span<const double> multipliers = equations_.multipliers();
  const std::span<const Pose<double>> poses = equations_.poses();
  const auto lever = [&](int body, Vec2d arm, Vec2d force) {
    if (slot_of(body) >= 0) block(body, body).position[2][2] -= dot(arm, force);
  };
  const auto arm = [&](int body, Vec2d anchor) {
    return body == kFixedFrame ? anchor : poses[body].rotation * anchor;
  };
  std::size_t row = 0;
  for (const auto& joint : equations_.joints().revolute) {
    const Vec2d force{multipliers[row], multipliers[row + 1]};
    lever(joint.a, arm(joint.a, joint.anchor_a), -force);
    lever(joint.b, arm(joint.b, joint.anchor_b), force);
    row += 2;
  }
  for (const auto& joint : equations_.joints().distance) {
    const Row<double>& r = rows_[row];
    const Vec2d u = r.linear_b, across = perpendicular(u);
    const double force = multipliers[row], separation = r.residual + joint.length;
    const Vec2d arm_a = arm(joint.a, joint.anchor_a), arm_b = arm(joint.b, joint.anchor_b);
    lever(joint.a, arm_a, -force * u);
    lever(joint.b, arm_b, force * u);
    ++row;
    if (!(separation > 0)) continue;
    const double stiffness = force / separation;
    const int body[2] = {joint.a, joint.b};
    const double p[2][3] = {{-across.x, -across.y, -cross(arm_a, across)},
                            {across.x, across.y, cross(arm_b, across)}};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        if (slot_of(body[i]) < 0 || slot_of(body[j]) < 0) continue;
        ForceBlock& b = block(body[i], body[j]);
        for (int k = 0; k < 3; ++k) {
          for (int l = 0; l < 3; ++l) b.position[k][l] += stiffness * p[i][k] * p[j][l];
        }
      }
    }
  }
}

bool StiffMotion::order_is_known() const {
  if (body_offset_.empty() || ordered_rows_.size() != rows_.size() ||
      ordered_blocks_.size() != blocks_.size())
    return false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (ordered_rows_[i] != std::array{rows_[i].a, rows_[i].b}) return false;
  }
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const std::array pair{static_cast<int>(blocks_[i].on), static_cast<int>(blocks_[i].by)};
    if (ordered_blocks_[i] != pair) return false;
  }
  return true;
}

/// Orders bodies breadth first from one with few neighbours (E. Cuthill, J. McKee 1969). Each body is
/// followed by the rows that it shares with later ones.
void StiffMotion::find_order() {
  const std::size_t bodies = inverse_mass_.size();
  std::vector<std::vector<int>> neighbours(bodies), rows_of(bodies);
  const auto connect = [&](int a, int b) {
    if (a < 0 || b < 0 || a == b) return;
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  ordered_rows_.clear(), ordered_blocks_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const int a = slot_of(rows_[i].a), b = slot_of(rows_[i].b);
    connect(a, b);
    for (const int slot : {a, b}) {
      if (slot >= 0) rows_of[slot].push_back(static_cast<int>(i));
    }
    ordered_rows_.push_back({rows_[i].a, rows_[i].b});
  }
  for (const ForceBlock& b : blocks_) {
    connect(slot_[b.on], slot_[b.by]);
    ordered_blocks_.push_back({static_cast<int>(b.on), static_cast<int>(b.by)});
  }
  for (std::vector<int>& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  std::vector<int> roots(bodies), queue;
  std::iota(roots.begin(), roots.end(), 0);
  std::stable_sort(roots.begin(), roots.end(),
                   [&](int a, int b) { return neighbours[a].size() < neighbours[b].size(); });
  std::vector<char> seen(bodies, 0);
  for (const int root : roots) {
    if (seen[root]) continue;
    seen[root] = 1;
    queue.push_back(root);
    for (std::size_t next = queue.size() - 1; next < queue.size(); ++next) {
      for (const int other : neighbours[queue[next]]) {
        if (seen[other]) continue;
        seen[other] = 1;
        queue.push_back(other);
      }
    }
  }
  constexpr std::size_t kUnset = static_cast<std::size_t>(-1);
  body_offset_.assign(bodies, 0);
  row_offset_.assign(rows_.size(), kUnset);
  std::size_t offset = 0;
  for (const int slot : queue) {
    body_offset_[slot] = offset;
    offset += 3;
    for (const int row : rows_of[slot]) {
      if (row_offset_[row] == kUnset) row_offset_[row] = offset++;
    }
  }
  for (std::size_t& row : row_offset_) {
    if (row == kUnset) row = offset++;  // a row between bodies that do not move
  }
  for (System& system : systems_) system.stages = 0;
}

/// Sets the size and the bandwidth of the matrix.
void StiffMotion::resize(System& system, int stages) const {
  std::size_t width = 3;
  const auto widen = [&](std::size_t a, std::size_t size_a, std::size_t b, std::size_t size_b) {
    width = std::max(width, a < b ? b + size_b - a : a + size_a - b);
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    for (const int slot : {slot_of(rows_[i].a), slot_of(rows_[i].b)}) {
      if (slot >= 0) widen(body_offset_[slot], 3, row_offset_[i], 1);
    }
  }
  for (const ForceBlock& b : blocks_) {
    if (slot_[b.on] >= 0 && slot_[b.by] >= 0)
      widen(body_offset_[slot_[b.on]], 3, body_offset_[slot_[b.by]], 3);
  }
  const std::size_t s = static_cast<std::size_t>(stages),
                    size = s * (3 * inverse_mass_.size() + rows_.size());
  const std::size_t band = std::min(s * width - 1, size - 1);
  system.stages = stages;
  system.matrix.reset(size, band, band);
  system.right_side.assign(size, 0);
}

bool StiffMotion::factor(Use use, std::span<const double> a, int stages, double h) {
  System& system = systems_[static_cast<int>(use)];
  if (system.stages != stages) resize(system, stages);
  system.a.assign(a.begin(), a.end());
  system.h = h;
  BandedLu& matrix = system.matrix;
  matrix.clear();
  const auto at = [&](std::size_t offset, int size, int stage, int i) {  // index of an unknown
    return static_cast<std::size_t>(stages) * offset + static_cast<std::size_t>(stage * size + i);
  };
  for (std::size_t slot = 0; slot < inverse_mass_.size(); ++slot) {
    for (int s = 0; s < stages; ++s) {
      for (int i = 0; i < 3; ++i)
        matrix.at(at(body_offset_[slot], 3, s, i), at(body_offset_[slot], 3, s, i)) = 1;
    }
  }
  for (const ForceBlock& b : blocks_) {
    const int on = slot_[b.on], by = slot_[b.by];
    if (on < 0 || by < 0) continue;
    for (int s = 0; s < stages; ++s) {
      for (int t = 0; t < stages; ++t) {
        double a_squared = 0;  // (A A)_st
        for (int k = 0; k < stages; ++k) a_squared += a[s * stages + k] * a[k * stages + t];
        for (int i = 0; i < 3; ++i) {
          const double inverse = i < 2 ? inverse_mass_[on] : inverse_inertia_[on];
          for (int j = 0; j < 3; ++j) {
            matrix.at(at(body_offset_[on], 3, s, i), at(body_offset_[by], 3, t, j)) -=
                inverse * (h * h * a_squared * b.position[i][j] + h * a[s * stages + t] * b.velocity[i][j]);
          }
        }
      }
    }
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    double own = 0;
    const auto side = [&](int body, Vec2d linear, double angular) {
      const int slot = slot_of(body);
      if (slot < 0) return;
      const double j[3] = {linear.x, linear.y, angular};
      for (int i = 0; i < 3; ++i) {
        const double inverse = i < 2 ? inverse_mass_[slot] : inverse_inertia_[slot];
        own += inverse * j[i] * j[i];
        for (int s = 0; s < stages; ++s) {
          const std::size_t row = at(row_offset_[r], 1, s, 0), body_at = at(body_offset_[slot], 3, s, i);
          matrix.at(body_at, row) -= inverse * j[i];
          matrix.at(row, body_at) += j[i];
        }
      }
    };
    side(rows_[r].a, rows_[r].linear_a, rows_[r].angular_a);
    side(rows_[r].b, rows_[r].linear_b, rows_[r].angular_b);
    for (int s = 0; s < stages; ++s) {
      const std::size_t row = at(row_offset_[r], 1, s, 0);
      matrix.at(row, row) += own > 0 ? kRedundant * own : 1;
    }
  }
  return matrix.factor();
}

void StiffMotion::solve(Use use, std::span<double> x) {
  System& system = systems_[static_cast<int>(use)];
  const int stages = system.stages;
  const std::size_t n = equations_.dimension();
  const double h = system.h;
  std::vector<double>& g = system.right_side;
  std::fill(g.begin(), g.end(), 0.0);
  // Change of positions that follows from the accelerations on the right side: u_j = r_q,j + h sum_k a_jk
  // r_v,k.
  displacement_.resize(stages * n);
  const auto move = [&] {
    for (int j = 0; j < stages; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        if (i % EquationsOfMotion::kPerBody >= 3) continue;
        double sum = x[j * n + i];
        for (int k = 0; k < stages; ++k) sum += h * system.a[j * stages + k] * x[k * n + i + 3];
        displacement_[j * n + i] = sum;
      }
    }
  };
  move();
  for (const ForceBlock& b : blocks_) {
    const int on = slot_[b.on], by = slot_[b.by];
    if (on < 0 || by < 0) continue;
    for (int j = 0; j < stages; ++j) {
      const double* q = &displacement_[j * n + EquationsOfMotion::kPerBody * by];
      const double* v = &x[j * n + EquationsOfMotion::kPerBody * by + 3];
      for (int i = 0; i < 3; ++i) {
        double force = 0;
        for (int k = 0; k < 3; ++k) force += b.position[i][k] * q[k] + b.velocity[i][k] * v[k];
        const double response = h * (i < 2 ? inverse_mass_[on] : inverse_inertia_[on]) * force;
        for (int s = 0; s < stages; ++s) {
          g[stages * body_offset_[on] + 3 * s + i] += system.a[s * stages + j] * response;
        }
      }
    }
  }
  system.matrix.solve(g);
  for (std::size_t slot = 0; slot < inverse_mass_.size(); ++slot) {
    for (int s = 0; s < stages; ++s) {
      for (int i = 0; i < 3; ++i) {
        x[s * n + EquationsOfMotion::kPerBody * slot + 3 + i] += g[stages * body_offset_[slot] + 3 * s + i];
      }
    }
  }
  move();
  for (int j = 0; j < stages; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      if (i % EquationsOfMotion::kPerBody < 3) x[j * n + i] = displacement_[j * n + i];
    }
  }
}

}  // namespace plumb::precise
