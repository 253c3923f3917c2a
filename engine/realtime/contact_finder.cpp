#include "engine/realtime/contact_finder.h"

#include <algorithm>
#include <cmath>

#include "engine/realtime/constants.h"

namespace plumb {

template <class Real>
ContactFinder<Real>::ContactFinder(const Scene& scene, const Bodies<Real>& bodies)
    : rules_(scene), shapes_(compile_shapes<Real>(scene)), broad_(static_cast<int>(shapes_.size())) {
  first_shape_.push_back(0);
  for (const Body& body : scene.bodies) {
    first_shape_.push_back(first_shape_.back() + static_cast<int>(body.shapes.size()));
    moves_.push_back(body.type != BodyType::Static);
  }
  for (std::size_t body = 0; body < bodies.size(); ++body) touch(static_cast<int>(body));
}

/// The way that the body may go in `dt`, forces included.
template <class Real>
void ContactFinder<Real>::place(int shape, const Bodies<Real>& bodies, Real dt) {
  const SolidShape<Real>& solid = shapes_[shape];
  const Twist<Real>& twist = bodies.twist[solid.body];
  Aabb<Real> swept = bounds_of(solid, plumb::place(solid, bodies.pose[solid.body]));
  const Vec2<Real> way = dt * twist.velocity;
  swept = merged(swept, Aabb<Real>{swept.lower + way, swept.upper + way});
  const Real arm =
      std::sqrt(length_squared(solid.center)) + (solid.kind == ShapeKind::Box ? solid.reach : Real{0});
  const Real turn = std::min(std::abs(twist.angular_velocity) * dt, Real{2}) * arm;
  const Real gain = dt * dt * std::sqrt(length_squared(bodies.acceleration[solid.body].velocity));
  broad_.place(shape, swept.grown(turn + gain), Real(constants::kBoxMargin) * solid.reach);
}

template <class Real>
Contact<Real> ContactFinder<Real>::make_contact(PairKey pair, const Bodies<Real>& bodies) const {
  const int first = first_of(pair), second = second_of(pair);
  const SolidShape<Real>&a = shapes_[first], &b = shapes_[second];
  Contact<Real> out;
  out.pair = pair;
  out.a = a.body;
  out.b = b.body;
  out.inverse_mass_a = bodies.inverse_mass[a.body];
  out.inverse_mass_b = bodies.inverse_mass[b.body];
  out.inverse_inertia_a = bodies.inverse_inertia[a.body];
  out.inverse_inertia_b = bodies.inverse_inertia[b.body];
  out.friction = static_cast<Real>(rules_.friction(first, second));
  out.restitution = static_cast<Real>(rules_.restitution(first, second));
  out.reach = std::min(a.reach, b.reach);
  out.two_boxes = a.kind == ShapeKind::Box && b.kind == ShapeKind::Box;
  return out;
}

/// How far apart points still matter: the shapes may come together within `dt`.
template <class Real>
Real ContactFinder<Real>::reach_of(const Contact<Real>& contact, const Bodies<Real>& bodies, Real dt) const {
  const Twist<Real>&a = bodies.twist[contact.a], &b = bodies.twist[contact.b];
  const SolidShape<Real>&shape_a = shapes_[first_of(contact.pair)],
        &shape_b = shapes_[second_of(contact.pair)];
  const Real turning =
      std::abs(a.angular_velocity) * (std::sqrt(length_squared(shape_a.center)) + shape_a.reach) +
      std::abs(b.angular_velocity) * (std::sqrt(length_squared(shape_b.center)) + shape_b.reach);
  const Real speed = std::sqrt(length_squared(b.velocity - a.velocity)) + turning;
  return Real(constants::kContactMargin) * contact.reach + Real(constants::kApproachReserve) * dt * speed;
}

template <class Real>
bool ContactFinder<Real>::find_pairs(const Bodies<Real>& bodies, Real dt,
                                     std::vector<Contact<Real>>& contacts) {
  for (std::size_t body = 0; body < moves_.size(); ++body)
    for (int shape = first_shape_[body]; moves_[body] && shape < first_shape_[body + 1]; ++shape)
      place(shape, bodies, dt);
  for (const int body : touched_)
    for (int shape = first_shape_[body]; shape < first_shape_[body + 1]; ++shape) place(shape, bodies, dt);
  touched_.clear();

  const auto by_pair = [](const Contact<Real>& x, const Contact<Real>& y) { return x.pair < y.pair; };
  if (!std::is_sorted(contacts.begin(), contacts.end(), by_pair))
    std::sort(contacts.begin(), contacts.end(), by_pair);
  found_.clear();
  broad_.search([this](int a, int b) { return rules_.may_touch(a, b); }, found_);
  const auto is_known = [&](PairKey pair) {
    const auto at =
        std::lower_bound(contacts.begin(), contacts.end(), pair,
                         [](const Contact<Real>& contact, PairKey key) { return contact.pair < key; });
    return at != contacts.end() && at->pair == pair;
  };
  std::erase_if(found_, is_known);
  const bool dropped = std::erase_if(contacts, [this](const Contact<Real>& contact) {
                         return !broad_.overlap(contact.pair);
                       }) > 0;
  if (found_.empty()) return dropped;

  merged_.clear();
  auto old = contacts.begin();
  for (const PairKey pair : found_) {
    for (; old != contacts.end() && old->pair < pair; ++old) merged_.push_back(*old);
    merged_.push_back(make_contact(pair, bodies));
  }
  merged_.insert(merged_.end(), old, contacts.end());
  contacts.swap(merged_);
  return true;
}

template <class Real>
void ContactFinder<Real>::find_points(const Bodies<Real>& bodies, Real dt,
                                      std::vector<Contact<Real>>& contacts) const {
  for (Contact<Real>& contact : contacts)
    detect<Real>(contact, shapes_, bodies.pose[contact.a], bodies.pose[contact.b],
                 reach_of(contact, bodies, dt));
}

template <class Real>
bool ContactFinder<Real>::extend(int body, const Bodies<Real>& bodies, Real dt,
                                 std::vector<Contact<Real>>& contacts) {
  for (int shape = first_shape_[body]; shape < first_shape_[body + 1]; ++shape) place(shape, bodies, dt);
  found_.clear();
  broad_.search([this](int a, int b) { return rules_.may_touch(a, b); }, found_);
  if (found_.empty()) return false;
  const std::size_t before = contacts.size();
  for (const PairKey pair : found_) {
    const auto same = [pair](const Contact<Real>& contact) { return contact.pair == pair; };
    if (std::any_of(contacts.begin(), contacts.end(), same)) continue;
    contacts.push_back(make_contact(pair, bodies));
    Contact<Real>& contact = contacts.back();
    detect<Real>(contact, shapes_, bodies.pose[contact.a], bodies.pose[contact.b],
                 reach_of(contact, bodies, dt));
  }
  return contacts.size() > before;
}

template <class Real>
std::vector<Aabb<Real>> ContactFinder<Real>::boxes() const {
  std::vector<Aabb<Real>> out;
  for (int shape = 0; shape < static_cast<int>(shapes_.size()) && broad_.holds(shape); ++shape)
    out.push_back(broad_.box(shape));
  return out;
}

template <class Real>
void ContactFinder<Real>::put_boxes(std::span<const Aabb<Real>> boxes) {
  broad_ = BroadPhase<Real>(static_cast<int>(shapes_.size()));
  for (std::size_t shape = 0; shape < boxes.size(); ++shape)
    broad_.put(static_cast<int>(shape), boxes[shape]);
  touched_.clear();
  for (std::size_t body = 0; body < moves_.size(); ++body) touch(static_cast<int>(body));
}

template class ContactFinder<float>;
template class ContactFinder<double>;

}  // namespace plumb
