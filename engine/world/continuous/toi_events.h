#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/geometry/aabb.h"
#include "engine/world/continuous/swept_boxes.h"
#include "engine/world/continuous/swept_pair.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/step.h"

/// Finds the first impact of a flight within the step. Only for continuous.cpp.
namespace plumb {

/// Tests which bodies a body passes fast. Stores the terms that do not depend on the other body.
template <class Real>
class FastPassing {
 public:
  FastPassing(const WorldData<Real>& w, int body)
      : w_(w),
        moved_(w.motion[body].moved),
        turned_(turned(body)),
        least_(Real(tuning::kFastShare) * w.bodies[body].half_width) {}

  /// Returns true if two bodies move fast relative to each other, so that one could pass through the other.
  bool passes(int other) const {
    const Vec2<Real> way = w_.motion[other].moved - moved_;
    return std::abs(way.x) + std::abs(way.y) + (turned_ + turned(other)) > least_;
  }
  /// Returns true if another body may be an obstacle: it is fast relative to this one, or its motion differs
  /// from the solver's.
  bool may_be_blocked_by(int other) const {
    if (passes(other)) return true;
    const SweptBody* met = flight_in(w_, other);
    return met != nullptr && met->changed;
  }

 private:
  Real turned(int body) const { return std::abs(w_.motion[body].turned) * w_.extents[body]; }

  const WorldData<Real>& w_;
  Vec2<Real> moved_;
  Real turned_, least_;
};

/// Returns an AABB of the body's motion until the step's end. An arc leaves its chord, passed at the same
/// rate, by at most arm angle^2 / 8, and by no more than two arms.
template <class Real>
Aabb<Real> way_of(const WorldData<Real>& w, const SweptBody& flight) {
  const Vec2<Real> start = flight.start_at(flight.from).template as<Real>(),
                   end = flight.start_at(1).template as<Real>();
  const double arc = length(flight.arm) * std::min(flight.turn * flight.turn / 8, 2.0);
  const Real aside = static_cast<Real>(std::abs(flight.curve.x) + std::abs(flight.curve.y) + arc);
  return merged(Aabb<Real>{start, start}, Aabb<Real>{end, end}).grown(w.extents[flight.body] + aside);
}

/// Returns the solver's constraint of a contact, or null if it had none.
template <class Real>
const ContactConstraint<Real>* constraint_in(const WorldData<Real>& w, const ContactRecord& contact) {
  if (contact.home != ContactHome::Graph) return nullptr;
  return &w.graph.at({contact.colour, contact.index});
}

template <class Real>
const ContactConstraint<Real>* constraint_between(const WorldData<Real>& w, int shape, int other) {
  const int body = w.shapes[shape].body, other_body = w.shapes[other].body;
  const ContactConstraint<Real>* found = nullptr;
  const auto is_theirs = [&](const ContactRecord& contact) {
    if ((contact.shape_a != shape || contact.shape_b != other) &&
        (contact.shape_a != other || contact.shape_b != shape))
      return false;
    found = constraint_in(w, contact);
    return true;
  };
  any_between(w.contacts, w.bodies[body].first_contact, w.bodies[other_body].first_contact, body, other_body,
              is_theirs);
  return found;
}

/// Replaces the first impact by a pair's impact if that is earlier.
template <class Real>
void push_toi_event(const WorldData<Real>& w, const Way& way, const SweptPair<Real>& pair, ToiEvent& first) {
  const double fraction = fraction_of_impact(w, way, pair);
  if (fraction < first.fraction)
    first.fraction = fraction, first.shape = pair.shape, first.other = pair.other;
}

/// Finds the first impact of a body whose obstacles all have a contact with it. Computes its trajectory only
/// when an obstacle may be in the path.
template <class Real>
void meet_pairs(const WorldData<Real>& w, const SweptBody& flight, double from, ImpactSearch& search,
                ToiEvent& first) {
  const int body = flight.body;
  const FastPassing<Real> passing(w, body);
  const SweptBoxes<Real> boxes(w, flight, search.dt);
  std::optional<Way> way;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    const bool is_a = (edge & 1) == 0;
    if (!flight.expected && !passing.may_be_blocked_by(is_a ? contact.body_b : contact.body_a)) return;
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    if (boxes.are_clear(shape, other)) return;
    if (!way) way.emplace(flight, from, search);
    push_toi_event(w, *way, {shape, other, constraint_in(w, contact), false, true}, first);
  });
}

/// Returns true if the same body pushes both along.
template <class Real>
bool go_together(const WorldData<Real>& w, const SweptBody& flight, int other) {
  if (flight.carrier == kNone) return false;
  if (flight.carrier == other) return true;
  const SweptBody* met = flight_in(w, other);
  return met != nullptr && met->carrier == flight.carrier;
}

/// Finds the first impact by queries of the trees: after an impact the solver has no contacts along the new
/// trajectory.
template <class Real>
void meet_all(const WorldData<Real>& w, const Way& way, ToiEvent& first) {
  const int body = way.flight.body;
  const bool as_solved = !way.flight.changed;
  const bool in_contact = as_solved || (way.flight.lifts > 0 && way.flight.impacts == 0);
  const Aabb<Real> swept = way_of(w, way.flight);
  const FastPassing<Real> passing(w, body);
  const SweptBoxes<Real> boxes(w, way.flight, way.search.dt);
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = seen_by(w.shapes[shape].filter);
    if (w.forms[shape].sensor || mask == 0) continue;
    const auto visit = [&](int other, int) {
      const int other_body = w.shapes[other].body;
      if (!may_meet(w, shape, other) || go_together(w, way.flight, other_body)) return true;
      if (as_solved && !way.flight.expected && !passing.may_be_blocked_by(other_body)) return true;
      if (boxes.are_clear(shape, other)) return true;
      const auto* const contact = in_contact ? constraint_between(w, shape, other) : nullptr;
      push_toi_event(w, way, {shape, other, contact, false, true}, first);
      return true;
    };
    w.static_tree.query(swept, mask, visit);
    w.dynamic_tree.query(swept, mask, visit);
  }
}

/// Stores the current version of the other body's trajectory.
template <class Real>
ToiEvent as_it_is(const WorldData<Real>& w, ToiEvent found) {
  if (found.other == kNone) return found;
  if (const SweptBody* other = flight_in(w, w.shapes[found.other].body)) found.other_version = other->version;
  return found;
}

/// Returns the first impact of a flight from a fraction of the step on.
template <class Real>
ToiEvent first_toi_event(const WorldData<Real>& w, int place, double from, ImpactSearch& search) {
  const SweptBody& flight = w.scratch.swept_bodies[place];
  ToiEvent first{.flight = place, .version = flight.version};
  if (!w.is_dynamic(flight.body)) return first;
  if (flight.covered && !flight.changed) {
    meet_pairs(w, flight, from, search, first);
  } else {
    meet_all(w, Way(flight, from, search), first);
  }
  return as_it_is(w, first);
}

}  // namespace plumb
