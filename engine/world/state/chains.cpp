#include "engine/world/state/bodies.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/mass.h"
#include "engine/world/state/new_shape.h"
#include "engine/world/state/sleeping.h"

namespace plumb {

template <class Real>
int add_chain(WorldData<Real>& w, int body, const ChainDefinition& definition) {
  const int count = static_cast<int>(definition.points.size());
  std::vector<NewShape<Real>> segments;
  for (int i = 0; i < (definition.closed ? count : count - 1); ++i)
    segments.push_back(prepare_segment<Real>(definition, i));
  ChainRecord record{body, {}};
  record.shapes.reserve(segments.size());
  w.chains.reserve_more(1);
  reserve_shapes<Real>(w, w.bodies[body].type, segments);
  wake_body(w, body);
  record_mass_change(w, body);
  const int chain = w.chains.add(std::move(record));
  for (NewShape<Real>& segment : segments) {
    segment.record.chain = chain;
    const int shape = insert_shape(w, body, segment);
    grow_extents(w, body, shape);
    w.chains[chain].shapes.push_back(shape);
  }
  for (const int shape : w.chains[chain].shapes) create_proxy(w, shape);
  for (const int shape : w.chains[chain].shapes) wake_touched(w, shape);
  return chain;
}

template <class Real>
void destroy_contacts_of_chain(WorldData<Real>& w, int chain) {
  const int body = w.chains[chain].body;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    const bool own_is_a = (edge & 1) == 0;
    if (w.shapes[own_is_a ? contact.shape_a : contact.shape_b].chain != chain) return;
    if (contact.home == ContactHome::Sleeping) wake_body(w, own_is_a ? contact.body_b : contact.body_a);
    destroy_contact(w, edge / 2);
  });
}

template <class Real>
void erase_chain(WorldData<Real>& w, int chain) {
  for (const int shape : w.chains[chain].shapes) erase_shape(w, shape);
  w.chains.remove(chain);
}

template <class Real>
void remove_chain(WorldData<Real>& w, int chain) {
  const int body = w.chains[chain].body;
  wake_body(w, body);
  record_mass_change(w, body);
  destroy_contacts_of_chain(w, chain);
  erase_chain(w, chain);
}

#define PLUMB_FOR(Real)                                                  \
  template int add_chain(WorldData<Real>&, int, const ChainDefinition&); \
  template void erase_chain(WorldData<Real>&, int);                      \
  template void remove_chain(WorldData<Real>&, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
