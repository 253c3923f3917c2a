#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "engine/world/state/contacts.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/world.h"

/// The members of BasicWorld that list a body's shapes, joints and contacts; world.cpp instantiates them.
namespace plumb {

template <class Real>
std::vector<ShapeId> BasicWorld<Real>::shapes(BodyId body) const {
  std::vector<ShapeId> all;
  for (int shape = data_->bodies[index_of(body)].first_shape; shape != kNone;
       shape = data_->shapes[shape].next) {
    all.push_back({static_cast<std::uint32_t>(shape), data_->shapes.generation(shape)});
  }
  std::reverse(all.begin(), all.end());  // the list starts with the newest
  return all;
}
template <class Real>
std::vector<JointId> BasicWorld<Real>::joints(BodyId body) const {
  std::vector<JointId> all;
  for_each_edge(data_->joints, data_->bodies[index_of(body)].first_joint, [&](int edge, const JointRecord&) {
    all.push_back({static_cast<std::uint32_t>(edge / 2), data_->joints.generation(edge / 2)});
  });
  std::reverse(all.begin(), all.end());
  return all;
}
template <class Real>
std::vector<ContactReading> BasicWorld<Real>::contacts(BodyId body) const {
  std::vector<ContactReading> all(contacts(body, std::span<ContactReading>{}));
  contacts(body, all);
  return all;
}
template <class Real>
std::size_t BasicWorld<Real>::contacts(BodyId body, std::span<ContactReading> out) const {
  std::size_t count = 0;
  for_each_edge(data_->contacts, data_->bodies[index_of(body)].first_contact,
                [&](int, const ContactRecord& contact) {
                  if (!has_points(contact)) return;
                  if (count < out.size())
                    out[count] = reading_of(*data_, contact, constraint_of(*data_, contact));
                  ++count;
                });
  return count;
}
template <class Real>
std::optional<ContactReading> BasicWorld<Real>::contact(ShapeId a, ShapeId b) const {
  WorldData<Real>& w = *data_;
  const int shape_a = index_of(a), shape_b = index_of(b);
  const int body_a = w.shapes[shape_a].body, body_b = w.shapes[shape_b].body;
  std::optional<ContactReading> found;
  if (!w.pairs.contains(shape_a, shape_b)) return found;
  any_between(w.contacts, w.bodies[body_a].first_contact, w.bodies[body_b].first_contact, body_a, body_b,
              [&](const ContactRecord& contact) {
                const bool is_theirs = (contact.shape_a == shape_a && contact.shape_b == shape_b) ||
                                       (contact.shape_a == shape_b && contact.shape_b == shape_a);
                if (is_theirs && has_points(contact))
                  found = reading_of(w, contact, constraint_of(w, contact));
                return is_theirs;
              });
  return found;
}
template <class Real>
std::size_t BasicWorld<Real>::contacts(std::span<ContactReading> out) const {
  WorldData<Real>& w = *data_;
  std::size_t count = 0;
  w.contacts.for_each([&](int, const ContactRecord& contact) {
    if (!has_points(contact)) return;
    if (count < out.size()) out[count] = reading_of(w, contact, constraint_of(w, contact));
    ++count;
  });
  return count;
}

}  // namespace plumb
