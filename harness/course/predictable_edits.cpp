#include <array>
#include <utility>

#include <fmt/format.h>

#include "harness/course/predictable.h"
#include "harness/course/student/edit.h"

// The edits of formulas (student/edit.h): each quantity of a body, in each place, with each replacement.
namespace plumb::course {
namespace {

struct Rows {
  unsigned rows;
  const char* chapters;
  const char* what;
};

constexpr Rows kRows[] = {
    {kContactRow, "34", "a contact's impulse"},
    {kFrictionRow, "4", "friction"},
    {kContactRow | kFrictionRow, "4", "a contact's impulse and its friction"},
    {kOverlapRow, "34", "the correction of an overlap"},
    {kContactRow | kFrictionRow | kOverlapRow, "34", "contacts, their friction and their correction"},
    {kJointRow, "5", "a joint's impulse"},
    {kCorrectionRow, "5", "the correction of a joint's positions"},
    {kJointRow | kCorrectionRow, "5", "a joint's impulse and the correction of its positions"},
    {kContactRow | kFrictionRow | kOverlapRow | kJointRow | kCorrectionRow, "5", "contacts and joints"},
};

struct Places {
  unsigned places;
  const char* what;
};

constexpr Places kSpeed{kInSpeed, "the speed of the two points in"}, kMass{kInMass, "the effective mass of"},
    kChange{kInChange, "what changes the two bodies in"},
    kMassAndChange{kInMass | kInChange, "the masses of"},
    kGap{kInGap, "the gap C = (xb + rb) - (xa + ra) of"},
    kEverywhere{kInSpeed | kInMass | kInChange, "all of"};

struct Kind {
  Quantity quantity;
  const char *name, *what, *right;
  std::vector<Places> places;
  std::vector<std::pair<Instead, const char*>> instead;
};

std::vector<Kind> kinds() {
  constexpr const char *kOthers = "is the other body's", *kZero = "is left out",
                       *kMinus = "has the wrong sign";
  return {
      {Quantity::Arm,
       "wrong_arm",
       "the arm",
       "each body has its own r, from its centre to the point, turned with it",
       {kSpeed, kMass, kChange, kEverywhere, kGap},
       {{Instead::Others, kOthers},
        {Instead::Zero, kZero},
        {Instead::Minus, kMinus},
        {Instead::Raw, "is the point itself, not seen from the body's centre or not turned with the body"}}},
      {Quantity::InverseMass,
       "wrong_mass",
       "the inverse mass",
       "each body has its own 1/m, 0 if it is static",
       {kMass, kChange, kMassAndChange},
       {{Instead::Others, kOthers},
        {Instead::Zero, kZero},
        {Instead::One, "is 1"},
        {Instead::Inverse, "is the mass"},
        {Instead::Finite, "is 1, if that is static, as if it had 1 kg"},
        {Instead::Raw, "is the inverse inertia"}}},
      {Quantity::InverseInertia,
       "wrong_inertia",
       "the inverse inertia",
       "each body has its own 1/I, 0 if it cannot turn",
       {kMass, kChange, kMassAndChange},
       {{Instead::Others, kOthers},
        {Instead::Zero, kZero},
        {Instead::One, "is 1"},
        {Instead::Inverse, "is the inertia"},
        {Instead::Finite, "is 1, if that cannot turn"},
        {Instead::Raw, "is the inverse mass"}}},
      {Quantity::Velocity,
       "wrong_velocity",
       "the velocity",
       "it is (vb + wb x rb) - (va + wa x ra)",
       {kSpeed},
       {{Instead::Others, kOthers}, {Instead::Zero, kZero}, {Instead::Minus, kMinus}}},
      {Quantity::PointVelocity,
       "wrong_velocity",
       "the velocity of the point",
       "it is (vb + wb x rb) - (va + wa x ra)",
       {kSpeed},
       {{Instead::Others, kOthers}, {Instead::Zero, kZero}, {Instead::Minus, kMinus}}},
      {Quantity::Spin,
       "wrong_spin",
       "the spin",
       "it is (vb + wb x rb) - (va + wa x ra)",
       {kSpeed},
       {{Instead::Others, kOthers}, {Instead::Zero, kZero}, {Instead::Minus, kMinus}}},
  };
}

constexpr std::array<const char*, 4> kBodies{"", "the first body", "the second body", "both bodies"};
constexpr unsigned kBoth = 3;

// Returns false for edits that change nothing (the minus of a squared quantity; speeds where there are none),
// and for those that repeat another edit. An arm appears only in products with the spin and with the inverse
// inertia, so leaving the arm out, or changing its sign, equals doing so with the other factor.
bool matters(const Rows& rows, const Places& places, const Kind& kind, Instead instead) {
  constexpr unsigned kJoints = kJointRow | kCorrectionRow;
  if (places.places == kInGap) return (rows.rows & ~kJoints) == 0;
  const bool positions = (rows.rows & ~(kOverlapRow | kCorrectionRow)) == 0;
  if (positions && (places.places & ~kInSpeed) == 0) return false;
  if (kind.quantity != Quantity::Arm) return true;
  if (instead == Instead::Minus) return places.places != kInMass && places.places != kInSpeed;
  return instead != Instead::Zero || places.places == kEverywhere.places;
}

// Returns a name for an edit by its effect, if other mistakes have the same effect. Iterations repair a wrong
// effective mass, so an edit of the change alone moves bodies like one of all masses.
const char* name_of(const Rows& rows, const Places& places, const Kind& kind, Instead instead,
                    unsigned bodies) {
  const bool both = bodies == kBoth, in_change = (places.places & kInChange) != 0;
  const bool contacts = (rows.rows & (kJointRow | kCorrectionRow)) == 0;
  const bool joints = (rows.rows & (kContactRow | kFrictionRow | kOverlapRow)) == 0;
  switch (kind.quantity) {
    case Quantity::Arm:
      if (instead == Instead::Others) return "arm_of_the_other";
      if (instead == Instead::Minus && places.places == kInChange) return "r_cross_n_flipped";
      if (instead == Instead::Raw && contacts) return "lever_from_origin";
      if (instead == Instead::Raw && joints) return "anchor_not_turned";
      return kind.name;
    case Quantity::InverseMass:
      if (instead == Instead::Finite) return "static_has_mass";
      if (!in_change) return "masses_wrong";
      if (instead == Instead::Zero && !both) return "one_body_only";
      if (instead == Instead::Others && both && places.places == kInChange) return "masses_swapped";
      if (instead == Instead::One && both)
        return places.places == kInChange ? "inverse_mass_forgotten" : "masses_ignored";
      return kind.name;
    case Quantity::InverseInertia:
      if (instead == Instead::Finite) return "static_has_mass";
      if (instead == Instead::Zero && !in_change) return "effective_mass_without_rotation";
      if (instead == Instead::Zero && !both) return "one_body_never_spins";
      if (instead == Instead::Zero) return places.places == kInChange ? "spin_not_changed" : "no_rotation";
      if (in_change && (instead == Instead::One || instead == Instead::Raw)) return "inertia_forgotten";
      return kind.name;
    case Quantity::Velocity:
    case Quantity::PointVelocity:
      // The speed of the points is then reversed, in whatever direction each of them moves.
      if (both && kind.quantity == Quantity::PointVelocity && rows.rows == kFrictionRow &&
          instead != Instead::Zero)
        return "friction_backwards";
      return both ? kind.name : "relative_velocity";
    default:
      return instead == Instead::Others ? kind.name : "point_velocity";
  }
}

}  // namespace

std::vector<Predictable> mistakes_of_edits() {
  std::vector<Predictable> out;
  for (const Rows& rows : kRows)
    for (const Kind& kind : kinds())
      for (const Places& places : kind.places)
        for (const auto& [instead, says] : kind.instead)
          for (unsigned bodies = 1; bodies <= kBoth; ++bodies) {
            if (!matters(rows, places, kind, instead)) continue;
            const Edit edit{kind.quantity, rows.rows, places.places, bodies, instead};
            out.push_back({edit.text(), name_of(rows, places, kind, instead, bodies), rows.chapters,
                           fmt::format("In {} {}, {} of {} {}: {}.", places.what, rows.what, kind.what,
                                       kBodies[bodies], says, kind.right),
                           true, true});
          }
  return out;
}

}  // namespace plumb::course
