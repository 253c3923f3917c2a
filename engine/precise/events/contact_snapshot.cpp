#include <algorithm>
#include <cmath>

#include "engine/precise/events/contacts.h"
#include "engine/precise/events/state_members.h"

// Saves and restores the held contacts and their modes.
namespace plumb::precise {
namespace {

/// Returns true if two outlines have the corners and the edge that a feature refers to.
bool is_feature(const Feature& f, const FeatureShape& a, const FeatureShape& b) {
  if (f.a < 0 || f.a >= a.count() || f.b < 0 || f.b >= b.count()) return false;
  switch (f.kind) {
    case Feature::Kind::Corners:
      return true;
    case Feature::Kind::CornerOfB:
      return f.a < a.edges();
    case Feature::Kind::CornerOfA:
      return f.b < b.edges();
  }
  return false;
}

}  // namespace

void Contacts::save(SnapshotWriter& out) const {
  out.put(static_cast<std::uint64_t>(held_.size()));
  for (std::size_t p = 0; p < held_.size(); ++p) {
    const ActiveContact& patch = equations_.held()[p];
    out.put(held_[p]);
    out.put(patch.friction);
    out.put(patch.sliding_friction);
    out.put(patch.mode);
    out.put(patch.count);
    out.put(patch.features);
    out.put(patch.pushes);
    out.put(patch.grip);
  }
  out.put(static_cast<std::uint64_t>(touching_.size()));
  for (const OutlinePair& pair : touching_) out.put(pair);
  out.put(static_cast<std::uint64_t>(passing_.size()));
  for (const OutlinePair& pair : passing_) out.put(pair);
  out.put(near_);
  out.put(force_scale_);
  out.put(std::int64_t{settled_});
  out.put(last_event_);
  out.put(events_at_once_);
  for (const EventCount& each : events_) out.put(each);
  // The guard of a settled event is obsolete: it may refer to contacts that are no longer held.
  const bool open = !settled_;
  out.put(std::int64_t{open && record_.guard});
  out.put(open ? record_.guard.value_or(Guard{}) : Guard{});
  out.put(std::int64_t{open && record_.met});
  out.put(open ? record_.met.value_or(OutlinePair{}) : OutlinePair{});
  stops_.save(out);
}

/// Returns true if everything that a guard refers to exists in this scene and its held contacts.
bool Contacts::fits(const Guard& guard, std::span<const ActiveContact> patches) const {
  const std::span<const FeatureShape> outlines = finder_.outlines();
  switch (guard.kind) {
    case Guard::Kind::Gap:
    case Guard::Kind::Rate:
      return guard.pair.a < outlines.size() && guard.pair.b < outlines.size() &&
             is_feature(guard.feature, outlines[guard.pair.a], outlines[guard.pair.b]);
    case Guard::Kind::Limit:
      return guard.stop < stops_.count();
    case Guard::Kind::Quantity:
      break;
    default:
      return false;
  }
  if (guard.monitored == static_cast<int>(Quantity::Stop)) return guard.stop < stops_.count();
  if (guard.patch >= patches.size() || guard.point < 0) return false;
  const int points = patches[guard.patch].count;
  switch (static_cast<Quantity>(guard.monitored)) {
    case Quantity::Force:
      return guard.point < points;
    case Quantity::Cone:
    case Quantity::Slip:
      return guard.point == 0;
    case Quantity::Range:
      return guard.point < Limits::kMost * points;
    case Quantity::Height:
      return guard.point < Limits::kMost;
    case Quantity::Stop:
      break;
  }
  return false;
}

void Contacts::restore_record(SnapshotReader& in, std::span<const ActiveContact> patches) {
  const bool has_guard = in.get<std::int64_t>() != 0;
  const auto guard = in.get<Guard>();
  const bool has_met = in.get<std::int64_t>() != 0;
  const auto met = in.get<OutlinePair>();
  const auto is_ours = [&](const OutlinePair& pair) {
    const std::size_t outlines = finder_.outlines().size();
    return outlines == 0 ? pair == OutlinePair{} : pair.a < outlines && pair.b < outlines;
  };
  in.expect(is_ours(met) && (!has_guard || fits(guard, patches)));
  record_ = {};
  if (has_guard) record_.guard = guard;
  if (has_met) record_.met = met;
}

void Contacts::restore(SnapshotReader& in) {
  const auto pair = [&] {
    const auto read = in.get<OutlinePair>();
    in.expect(read.a < finder_.outlines().size() && read.b < finder_.outlines().size());
    return read;
  };
  std::vector<ActiveContact> patches(in.count(sizeof(OutlinePair)));
  held_.clear();
  for (ActiveContact& patch : patches) {
    held_.push_back(pair());
    patch.a = &finder_.outlines()[held_.back().a];
    patch.b = &finder_.outlines()[held_.back().b];
    patch.friction = in.get<double>();
    patch.sliding_friction = in.get<double>();
    patch.mode = in.get<int>();
    patch.count = in.get<int>();
    in.expect(patch.count >= 0 && patch.count <= 2);
    for (Feature& feature : patch.features) {
      feature = in.get<Feature>();
      in.expect(is_feature(feature, *patch.a, *patch.b));
    }
    for (double& force : patch.pushes) force = in.get<double>();
    patch.grip = in.get<double>();
  }
  touching_.assign(in.count(sizeof(OutlinePair)), {});
  for (OutlinePair& each : touching_) each = pair();
  passing_.assign(in.count(sizeof(OutlinePair)), {});
  for (OutlinePair& each : passing_) each = pair();
  near_ = in.get<double>();
  force_scale_ = in.get<double>();
  settled_ = in.get<std::int64_t>() != 0;
  last_event_ = in.get<double>();
  events_at_once_ = in.get<int>();
  for (EventCount& each : events_) each = in.get<EventCount>();
  restore_record(in, patches);
  equations_.hold_contacts(std::move(patches));
  stops_.restore(in);
}

}  // namespace plumb::precise
