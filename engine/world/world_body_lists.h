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
