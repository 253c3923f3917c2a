#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/motion.h"

// Equations of motion with persistent contacts. Joints are eliminated first, by their sparse system: R, the
// response of a contact's row, is M^-1 J^T plus the joints' reaction to it. The remaining system is small and
// dense,
//   C a + c = 0,   a = a0 + sum lambda_k R_k,   (C R) lambda = -(C a0 + c),
// with a0 the accelerations without contacts, C the normals and the tangents of sticking contacts. Friction
// of slipping contacts is tied to their normal force: R is the response of n - s mu t.
namespace plumb::precise {
namespace {

Row<double> sum(const Row<double>& a, double factor, const Row<double>& b) {
  Row<double> r = a;
  r.linear_a += factor * b.linear_a, r.linear_b += factor * b.linear_b;
  r.angular_a += factor * b.angular_a, r.angular_b += factor * b.angular_b;
  return r;
}

}  // namespace

void EquationsOfMotion::hold_contacts(std::vector<ActiveContact> patches) {
  assert(std::all_of(patches.begin(), patches.end(), [](const ActiveContact& patch) {
    return patch.a != nullptr && patch.b != nullptr && patch.count >= 1 && patch.count <= 2 &&
           std::abs(patch.mode) <= 1;
  }));
  patches_ = std::move(patches);
  for (const ActiveContact& patch : patches_) {
    for (const std::size_t body : {patch.a->body, patch.b->body}) {
      if (flight_.holds(body)) guides_.push_back(body);
    }
  }
  std::sort(guides_.begin(), guides_.end());
  guides_.erase(std::unique(guides_.begin(), guides_.end()), guides_.end());
}

/// Computes the responses of rows, at the poses of the last `place` and with the joints' last factorisation.
void EquationsOfMotion::find_response(std::vector<Row<double>> rows, ContactResponse& out) {
  out.rows = std::move(rows);
  const std::size_t bodies = poses_.size();
  out.of_a.resize(out.rows.size());
  out.of_b.resize(out.rows.size());
  out.all.assign(has_joints_ ? out.rows.size() * bodies : 0, {});
  const auto own = [&](int body, Vec2d linear, double angular) -> Twist<double> {
    if (body == kFixedFrame) return {};
    return {inverse_mass_[body] * linear, inverse_inertia_[body] * angular};
  };
  for (std::size_t k = 0; k < out.rows.size(); ++k) {
    const Row<double>& row = out.rows[k];
    out.of_a[k] = own(row.a, row.linear_a, row.angular_a);
    out.of_b[k] = own(row.b, row.linear_b, row.angular_b);
    if (!has_joints_) continue;
    const std::span<Twist<double>> all(out.all.data() + k * bodies, bodies);
    if (row.a != kFixedFrame) all[row.a] = out.of_a[k];
    if (row.b != kFixedFrame) all[row.b] = out.of_b[k];
    // The joints' reaction keeps the anchors' velocities: J dv = 0.
    for (std::size_t r = 0; r < rows_.size(); ++r) right_side_[r] = -row_speed(rows_[r], all);
    solve_joints();
    pull(all);
  }
}

double EquationsOfMotion::gain(const Row<double>& row, const ContactResponse& response, std::size_t k) const {
  const Twist<double> a = response.at(k, row.a, poses_.size()), b = response.at(k, row.b, poses_.size());
  return dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity + dot(row.linear_b, b.velocity) +
         row.angular_b * b.angular_velocity;
}

/// Computes the rates of the rows, row after row, by a unit of each response.
void EquationsOfMotion::find_gains(std::span<const Row<double>> rows, const ContactResponse& response,
                                   std::vector<double>& matrix) const {
  const std::size_t n = response.rows.size();
  matrix.assign(rows.size() * n, 0.0);
  if (has_joints_) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < n; ++k) matrix[i * n + k] = gain(rows[i], response, k);
    return;
  }
  // Without joints, a row is affected only by responses on its own bodies.
  std::vector<std::vector<std::size_t>> acting_on(poses_.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (const int body : {response.rows[k].a, response.rows[k].b})
      if (body != kFixedFrame) acting_on[static_cast<std::size_t>(body)].push_back(k);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const int body : {rows[i].a, rows[i].b}) {
      if (body == kFixedFrame) continue;
      for (const std::size_t k : acting_on[static_cast<std::size_t>(body)])
        matrix[i * n + k] = gain(rows[i], response, k);
    }
  }
}

void EquationsOfMotion::add_response(const ContactResponse& response, std::span<const double> impulses,
                                     std::span<Twist<double>> motion) const {
  for (std::size_t k = 0; k < response.rows.size(); ++k) {
    if (impulses[k] == 0) continue;
    const auto add = [&](std::size_t body, const Twist<double>& change) {
      motion[body].velocity += impulses[k] * change.velocity;
      motion[body].angular_velocity += impulses[k] * change.angular_velocity;
    };
    if (response.all.empty()) {
      if (response.rows[k].a != kFixedFrame)
        add(static_cast<std::size_t>(response.rows[k].a), response.of_a[k]);
      if (response.rows[k].b != kFixedFrame)
        add(static_cast<std::size_t>(response.rows[k].b), response.of_b[k]);
    } else {
      for (const std::size_t body : bodies_) add(body, response.all[k * poses_.size() + body]);
    }
  }
}

/// Computes the rows of the active contacts and the matrix C R, and factorises it. With `forces`, responses
/// include the friction of slipping contacts; otherwise they are along the rows themselves, as projections
/// need.
void EquationsOfMotion::linearise_contacts(bool forces) {
  constraints_.clear();
  std::vector<Row<double>> pushes, tangents;
  points_ = 0;
  for (const ActiveContact& patch : patches_) {
    for (int i = 0; i < patch.count; ++i) {
      const std::size_t a = patch.a->body, b = patch.b->body;
      const ContactRows rows =
          rows_of(patch.features[i], *patch.a, poses_[a], twists_[a], *patch.b, poses_[b], twists_[b]);
      constraints_.push_back(rows.normal);
      const bool rubs = forces && patch.rubs();
      pushes.push_back(rubs ? sum(rows.normal, -patch.mode * patch.sliding_friction, rows.tangent)
                            : rows.normal);
      if (i == 0 && patch.sticks()) tangents.push_back(rows.tangent);
      ++points_;
    }
  }
  if (held_stops_ > 0) {
    const std::span<const Row<double>> rows = stop_rows();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (stop_modes_[k] == StopMode::Held) tangents.push_back(rows[k]);
    }
  }
  constraints_.insert(constraints_.end(), tangents.begin(), tangents.end());
  pushes.insert(pushes.end(), tangents.begin(), tangents.end());
  find_response(std::move(pushes), active_response_);

  const std::size_t n = constraints_.size();
  std::vector<double> matrix;
  scale_.assign(n, 1.0);
  find_gains(constraints_, active_response_, matrix);
  for (std::size_t i = 0; i < n; ++i) {
    const double own = std::abs(matrix[i * n + i]);
    if (own > 0) scale_[i] = 1 / std::sqrt(own);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) matrix[i * n + k] *= scale_[i] * scale_[k];
  }
  contact_system_.factor(n, matrix, 1e-11);
}

/// Solves (C R) lambda = right_side for the contacts in place.
void EquationsOfMotion::solve_contacts(std::span<double> right_side) {
  for (std::size_t i = 0; i < right_side.size(); ++i) right_side[i] *= scale_[i];
  contact_system_.solve_refined(right_side);
  for (std::size_t i = 0; i < right_side.size(); ++i) right_side[i] *= scale_[i];
}

/// Returns the forces that the active contacts had when their modes were decided, by row.
std::vector<double> EquationsOfMotion::decided_forces() const {
  std::vector<double> forces;
  for (const ActiveContact& patch : patches_)
    forces.insert(forces.end(), patch.pushes, patch.pushes + patch.count);
  for (const ActiveContact& patch : patches_) {
    if (patch.sticks()) forces.push_back(patch.grip);
  }
  assert(forces.size() <= constraints_.size());
  forces.resize(constraints_.size(), 0.0);  // held stops
  return forces;
}

/// Adds the accelerations by contacts to those without them.
void EquationsOfMotion::press(std::span<Twist<double>> accelerations) {
  linearise_contacts(true);
  // Forces of redundant contacts are not unique: keep those from the time when the modes were decided, and
  // add the change since then.
  const std::vector<double> decided = decided_forces();
  add_response(active_response_, decided, accelerations);
  contact_side_.resize(constraints_.size());
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    contact_side_[i] = -(row_speed(constraints_[i], accelerations) + constraints_[i].bias_acceleration);
  }
  std::size_t place = constraints_.size() - held_stops_;
  for (std::size_t k = 0; held_stops_ > 0 && k < stop_modes_.size(); ++k) {
    if (stop_modes_[k] == StopMode::Held)
      contact_side_[place++] += kind_joints_.stops()[k].speed_at(time_).first;
  }
  solve_contacts(contact_side_);
  add_response(active_response_, contact_side_, accelerations);
  for (std::size_t i = 0; i < constraints_.size(); ++i) contact_side_[i] += decided[i];

  contact_forces_.normal.assign(contact_side_.begin(),
                                contact_side_.begin() + static_cast<std::ptrdiff_t>(points_));
  contact_forces_.tangent.clear();
  std::size_t point = 0, stuck = points_;
  for (const ActiveContact& patch : patches_) {
    double normal = 0;
    for (int i = 0; i < patch.count; ++i) normal += contact_side_[point++];
    contact_forces_.tangent.push_back(patch.sticks() ? contact_side_[stuck++]
                                                     : -patch.mode * patch.sliding_friction * normal);
  }
  contact_forces_.stop.assign(contact_side_.begin() + static_cast<std::ptrdiff_t>(stuck),
                              contact_side_.end());
}

void EquationsOfMotion::hold_stops(std::vector<StopMode> modes) {
  stop_modes_ = std::move(modes);
  held_stops_ = pushing_stops_ = 0;
  for (const StopMode mode : stop_modes_) {
    held_stops_ += mode == StopMode::Held ? 1 : 0;
    pushing_stops_ += mode == StopMode::Forward || mode == StopMode::Backward ? 1 : 0;
  }
}

std::span<const Row<double>> EquationsOfMotion::stop_rows() {
  stop_rows_.resize(kind_joints_.stops().size());
  kind_joints_.stop_rows(bodies_now(), stop_rows_);
  return stop_rows_;
}

std::span<const Row<double>> EquationsOfMotion::stop_rows(double time, std::span<const double> y) {
  place(time, y);
  return stop_rows();
}

/// Adds the forces of saturated motors.
void EquationsOfMotion::add_motors() {
  const std::span<const Row<double>> rows = stop_rows();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (stop_modes_[k] != StopMode::Forward && stop_modes_[k] != StopMode::Backward) continue;
    const double most = kind_joints_.stops()[k].max_force;
    const double force = stop_modes_[k] == StopMode::Forward ? most : -most;
    const auto add = [&](int body, Vec2d linear, double angular) {
      if (body == kFixedFrame) return;
      wrenches_[body].force += force * linear;
      wrenches_[body].torque += force * angular;
    };
    add(rows[k].a, rows[k].linear_a, rows[k].angular_a);
    add(rows[k].b, rows[k].linear_b, rows[k].angular_b);
  }
}

/// Adds to `shift` the correction by which velocities (or, with `gaps`, positions) meet the active contacts.
void EquationsOfMotion::close_contacts(std::span<const Twist<double>> motion, bool gaps,
                                       std::span<Twist<double>> shift) {
  contact_side_.assign(constraints_.size(), 0.0);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    if (gaps) {
      contact_side_[i] = i < points_ ? -(constraints_[i].residual + row_speed(constraints_[i], shift))
                                     : -row_speed(constraints_[i], shift);
    } else {
      contact_side_[i] = -(row_speed(constraints_[i], motion) + row_speed(constraints_[i], shift));
    }
  }
  std::size_t place = constraints_.size() - held_stops_;
  for (std::size_t k = 0; held_stops_ > 0 && k < stop_modes_.size(); ++k) {
    if (stop_modes_[k] != StopMode::Held) continue;
    const GeneralJoints::Stop& stop = kind_joints_.stops()[k];
    if (gaps && stop.role == RowRole::Limit) contact_side_[place] -= constraints_[place].residual;
    if (!gaps && stop.role == RowRole::Motor) contact_side_[place] += stop.speed_at(time_).value;
    ++place;
  }
  solve_contacts(contact_side_);
  add_response(active_response_, contact_side_, shift);
}

const ContactForces& EquationsOfMotion::contact_forces(double time, std::span<const double> y) {
  scratch_.resize(y.size());
  rate(time, y, scratch_);
  return contact_forces_;
}

void EquationsOfMotion::respond(double time, std::span<const double> y, std::vector<Row<double>> rows,
                                ContactResponse& response, std::vector<double>& matrix) {
  place(time, y);
  if (has_joints_) linearise();
  find_response(std::move(rows), response);
  find_gains(response.rows, response, matrix);
}

void EquationsOfMotion::push(const ContactResponse& response, std::span<const double> impulses,
                             Compensated& y) const {
  std::vector<Twist<double>> change(poses_.size());
  add_response(response, impulses, change);
  kick(change, 1, y);
}

std::span<const Twist<double>> EquationsOfMotion::accelerations_without_contacts(double time,
                                                                                 std::span<const double> y) {
  std::vector<ActiveContact> held;
  std::size_t stops = 0;
  std::swap(held, patches_);
  std::swap(stops, held_stops_);
  scratch_.resize(y.size());
  rate(time, y, scratch_);
  std::swap(held, patches_);
  std::swap(stops, held_stops_);
  return accelerations_;
}

}  // namespace plumb::precise
