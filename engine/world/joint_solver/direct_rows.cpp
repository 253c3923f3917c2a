#include "engine/world/joint_solver/direct_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/small_turn.h"

namespace plumb {
namespace {

// Regularisation (CFM): added to the diagonal, as a fraction of it, so that redundant rows share their load.
// Smaller for large mass ratios, because there the smallest eigenvalues are a fraction 1 / ratio of the
// largest.
constexpr double kSharing = 1e-7;
// The same where kRigidTries have found no set of pressing rows. Redundant supports that are not level, such
// as those of a brick on two others, would brace against each other by more than their loads.
constexpr double kMoreSharing = 1e-4;
constexpr int kRigidTries = 3;
// Maximum number of times that rows are removed or come back before giving up.
constexpr int kTries = 10;
// Times that this may fail to make the wrong rows fewer before they are changed one by one.
constexpr int kPatience = 3;
// Velocity at which a removed row counts as entered, relative to the largest velocity asked for: rounding.
constexpr double kEntered = 1e-5;
// Maximum velocity that an impulse may cause along its own row, relative to the largest velocity asked for.
// Contradicting rows (a body pushed out of two walls at once) respond with up to 1 / kSharing. A load on a
// lighter body responds with the mass ratio, and has a higher limit.
constexpr double kContradiction = 1e5;
// For large velocities contradictions show in the residual: more than kMissed of the contacts' depenetration
// speed, and impulses kInVain times those asked for.
constexpr double kMissed = 0.1, kInVain = 1e3;
// Mass ratio above which both limits grow with it.
constexpr double kFarApart = 1e3;
// Number of one-sided rows above which both limits grow with (rows / kMany)^2. In a tower a velocity
// correction at the top is amplified by that much.
constexpr double kMany = 512;

// Returns J_r M^-1 J_s^T: the part of one body that both rows act on.
template <class Real>
double coupling(const BodyMotion<Real>& body, Vec2<Real> linear_r, Real angular_r, Vec2<Real> linear_s,
                Real angular_s) {
  return double(body.inverse_mass) * (double(linear_r.x) * linear_s.x + double(linear_r.y) * linear_s.y) +
         double(body.inverse_inertia) * angular_r * angular_s;
}

template <class Real>
double coupling(const BodyMotion<Real>* motion, const DirectRow<Real>& r, const DirectRow<Real>& s) {
  double sum = 0;
  if (r.a == s.a) sum += coupling(motion[r.a], r.linear_a, r.angular_a, s.linear_a, s.angular_a);
  if (r.a == s.b) sum += coupling(motion[r.a], r.linear_a, r.angular_a, s.linear_b, s.angular_b);
  if (r.b == s.a) sum += coupling(motion[r.b], r.linear_b, r.angular_b, s.linear_a, s.angular_a);
  if (r.b == s.b) sum += coupling(motion[r.b], r.linear_b, r.angular_b, s.linear_b, s.angular_b);
  return sum;
}

// Bodies that do not give way are only read: several islands may stand on one.
template <class Real>
void push(BodyMotion<Real>& motion, Vec2<Real> impulse, Real angular_impulse) {
  if (is_dynamic(motion)) motion.apply(impulse, angular_impulse);
}

template <class Real>
void move_body(BodyMotion<Real>& body, Rotation<Real>& rotation, Vec2<Real> push, Real turning_push) {
  body.moved += body.inverse_mass * push;
  const Real turn = body.inverse_inertia * turning_push;
  if (turn == 0) return;
  body.turned += turn;
  rotation = turned_by(rotation, turn);
}

}  // namespace

template <class Real>
double DirectRows<Real>::order(const BodyMotion<Real>* motion) {
  // Blocks are neighbours if they act on the same dynamic body.
  const int count = rows.empty() ? 0 : rows.back().block + 1;
  block_first_.assign(count + 1, 0);
  ends_.clear();
  for (int i = static_cast<int>(rows.size()) - 1; i >= 0; --i) block_first_[rows[i].block] = i;
  block_first_[count] = static_cast<int>(rows.size());
  for (int block = 0; block < count; ++block) {
    const DirectRow<Real>& row = rows[block_first_[block]];
    if (is_dynamic(motion[row.a])) ends_.emplace_back(row.a, block);
    if (is_dynamic(motion[row.b])) ends_.emplace_back(row.b, block);
  }
  std::sort(ends_.begin(), ends_.end());
  order_.find(count, ends_);

  sequence_.clear();
  place_.resize(rows.size());
  for (const int block : order_.sequence()) {
    for (int row = block_first_[block]; row < block_first_[block + 1]; ++row) {
      place_[row] = static_cast<int>(sequence_.size());
      sequence_.push_back(row);
    }
  }
  first_.resize(rows.size());
  for (int i = 0; i < static_cast<int>(sequence_.size()); ++i) {
    const int block = rows[sequence_[i]].block;
    int first = place_[block_first_[block]];
    for (const int other : order_.neighbours(block)) first = std::min(first, place_[block_first_[other]]);
    first_[i] = first;
  }
  return EnvelopeMatrix::cost(first_);
}

template <class Real>
void DirectRows<Real>::note_masses(const BodyMotion<Real>* motion) {
  Real least = std::numeric_limits<Real>::max(), most = 0;
  for (const DirectRow<Real>& row : rows) {
    for (const int body : {row.a, row.b}) {
      const Real inverse = motion[body].inverse_mass;
      if (inverse > 0) least = std::min(least, inverse), most = std::max(most, inverse);
    }
  }
  apart_ = most > 0 ? std::max(1.0, double(most) / double(least) / kFarApart) : 1;
  const auto of_contacts =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.one_sided; });
  const double many = static_cast<double>(of_contacts) / kMany;
  apart_ *= std::max(1.0, many * many);
}

template <class Real>
void DirectRows<Real>::factorise(const BodyMotion<Real>* motion) {
  note_masses(motion);
  sharing_ = kSharing;
  factorise_again(motion);
}

template <class Real>
void DirectRows<Real>::factorise_again(const BodyMotion<Real>* motion) {
  const double sharing = sharing_ / apart_;
  matrix_.reset(first_);
  for (int i = 0; i < matrix_.size(); ++i) {
    const DirectRow<Real>& row = rows[sequence_[i]];
    if (!row.active) {
      matrix_.at(i, i) = 1;  // no coupling, and no impulse
      continue;
    }
    for (int j = first_[i]; j <= i; ++j) {
      const DirectRow<Real>& other = rows[sequence_[j]];
      if (other.active) matrix_.at(i, j) = coupling(motion, row, other);
    }
    matrix_.at(i, i) *= 1 + sharing;
  }
  matrix_.factorise();
}

template <class Real>
bool DirectRows<Real>::find(BodyMotion<Real>* motion, double push_speed) {
  x_.resize(rows.size());
  for (DirectRow<Real>& row : rows) row.taken = 0;
  bool out = std::any_of(rows.begin(), rows.end(), [](const auto& row) { return !row.active; });
  double asked = 0;
  int fewest = std::numeric_limits<int>::max(), patience = kPatience;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    asked = 0;
    for (int i = 0; i < matrix_.size(); ++i) {
      const DirectRow<Real>& row = rows[sequence_[i]];
      x_[i] = row.active ? -rate_of(motion, row) : 0;
      asked = std::max(asked, std::abs(x_[i]));
    }
    matrix_.solve(x_.data());
    // Block principal pivoting (Judice and Pires, 1994): rows that would pull leave, those that would be
    // entered come back, all at once while that makes them fewer, else the last one alone.
    int wrong = 0;
    DirectRow<Real>* last = nullptr;
    for (int i = 0; i < matrix_.size(); ++i) {
      DirectRow<Real>& row = rows[sequence_[i]];
      row.wrong = row.one_sided &&
                  (row.active ? double(*row.impulse) + x_[i] < 0
                              : out && rate_of(motion, row) + answer_of(motion, i) < -kEntered * asked);
      if (row.wrong) ++wrong, last = &row;
    }
    if (wrong == 0) break;
    if (attempt + 1 == kTries) {
      contradicted_ = contradicts(asked, push_speed);
      give_back(motion);
      return false;
    }
    if (wrong < fewest) {
      fewest = wrong, patience = kPatience;
    } else if (--patience < 0) {
      for (DirectRow<Real>& row : rows) row.wrong = &row == last;
    }
    for (DirectRow<Real>& row : rows) row.active = row.active != row.wrong;
    out = true;
    take_back(motion);
    if (attempt + 1 == kRigidTries) {
      sharing_ = kMoreSharing;
      fewest = std::numeric_limits<int>::max();
    }
    factorise_again(motion);
  }
  contradicted_ = contradicts(asked, push_speed);
  if (contradicted_) give_back(motion);
  return !contradicted_;
}

// Returns the velocity that a row misses, m/s: J v + bias.
template <class Real>
double DirectRows<Real>::rate_of(const BodyMotion<Real>* motion, const DirectRow<Real>& row) const {
  const BodyMotion<Real>&a = motion[row.a], &b = motion[row.b];
  return double(dot(row.linear_a, a.velocity) + row.angular_a * a.angular_velocity +
                dot(row.linear_b, b.velocity) + row.angular_b * b.angular_velocity + row.bias);
}

// Returns the velocity that the impulses found cause along the row at a place, m/s.
template <class Real>
double DirectRows<Real>::answer_of(const BodyMotion<Real>* motion, int place) const {
  const DirectRow<Real>& row = rows[sequence_[place]];
  double sum = 0;
  const auto add = [&](int other) {
    const DirectRow<Real>& from = rows[sequence_[other]];
    if (from.active) sum += coupling(motion, row, from) * x_[other];
  };
  for (int i = first_[place]; i < place; ++i) add(i);
  for (int i = place + 1; i < matrix_.size(); ++i)
    if (first_[i] <= place) add(i);
  return sum;
}

// Takes back the impulses of the removed rows.
template <class Real>
void DirectRows<Real>::take_back(BodyMotion<Real>* motion) {
  for (int i = 0; i < matrix_.size(); ++i) {
    DirectRow<Real>& row = rows[sequence_[i]];
    if (row.active || *row.impulse == 0) continue;
    row.taken = *row.impulse;
    push(motion[row.a], -row.taken * row.linear_a, -row.taken * row.angular_a);
    push(motion[row.b], -row.taken * row.linear_b, -row.taken * row.angular_b);
    *row.impulse = 0;
  }
}

// Applies them again, so that what is solved by iterations instead keeps its load.
template <class Real>
void DirectRows<Real>::give_back(BodyMotion<Real>* motion) {
  for (DirectRow<Real>& row : rows) {
    if (row.taken == 0) continue;
    push(motion[row.a], row.taken * row.linear_a, row.taken * row.angular_a);
    push(motion[row.b], row.taken * row.linear_b, row.taken * row.angular_b);
    *row.impulse += row.taken;
    row.taken = 0;
  }
}

template <class Real>
bool DirectRows<Real>::contradicts(double asked, double push_speed) const {
  // The residual of a row is kSharing / apart_ of the velocity that its impulse causes by itself.
  const double most =
      std::min(kContradiction * asked, std::max(kInVain * asked, kMissed / kSharing * push_speed));
  for (int i = 0; i < matrix_.size(); ++i) {
    if (std::abs(x_[i]) * matrix_.at(i, i) > most * apart_) return true;
  }
  return false;
}

template <class Real>
bool DirectRows<Real>::correct() {
  x_.resize(rows.size());
  double asked = 0;
  for (int i = 0; i < matrix_.size(); ++i) {
    const DirectRow<Real>& row = rows[sequence_[i]];
    x_[i] = row.active ? -double(row.gap) : 0;
    asked = std::max(asked, std::abs(x_[i]));
  }
  matrix_.solve(x_.data());
  return !contradicts(asked, std::numeric_limits<double>::infinity());
}

// Sums each body's impulses before its velocity is rounded. Between a heavy load and the ground the impulses
// on a light body are large and nearly cancel.
template <class Real>
void DirectRows<Real>::apply(BodyMotion<Real>* motion) {
  for (std::size_t end = 0; end < ends_.size();) {
    const int body = ends_[end].first;
    Vec2d push{};
    double turning = 0;
    for (; end < ends_.size() && ends_[end].first == body; ++end) {
      const int block = ends_[end].second;
      for (int i = block_first_[block]; i < block_first_[block + 1]; ++i) {
        const DirectRow<Real>& row = rows[i];
        if (!row.active) continue;
        const double impulse = x_[place_[i]];
        const bool is_a = row.a == body;
        push += impulse * (is_a ? row.linear_a : row.linear_b).template as<double>();
        turning += impulse * static_cast<double>(is_a ? row.angular_a : row.angular_b);
      }
    }
    BodyMotion<Real>& moving = motion[body];
    if (!is_dynamic(moving)) continue;  // other islands may stand on it too
    moving.velocity =
        (moving.velocity.template as<double>() + double(moving.inverse_mass) * push).template as<Real>();
    moving.angular_velocity =
        static_cast<Real>(double(moving.angular_velocity) + double(moving.inverse_inertia) * turning);
  }
  for (int i = 0; i < matrix_.size(); ++i) {
    const DirectRow<Real>& row = rows[sequence_[i]];
    if (row.active) *row.impulse += static_cast<Real>(x_[i]);
  }
}

template <class Real>
void DirectRows<Real>::move(BodyMotion<Real>* motion, Rotation<Real>* rotation) const {
  for (int i = 0; i < matrix_.size(); ++i) {
    const DirectRow<Real>& row = rows[sequence_[i]];
    const Real push = static_cast<Real>(x_[i]);
    if (push == 0) continue;
    move_body(motion[row.a], rotation[row.a], push * row.linear_a, push * row.angular_a);
    move_body(motion[row.b], rotation[row.b], push * row.linear_b, push * row.angular_b);
  }
}

template class DirectRows<float>;
template class DirectRows<double>;

}  // namespace plumb
