#include <algorithm>
#include <cmath>

#include "engine/precise/events/contacts.h"
#include "engine/precise/events/state_members.h"

// Saves and restores the held contacts and their modes.
namespace plumb::precise {
namespace {

/// Returns true if two shapes have the corners and the edge that a feature refers to.
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
    const ActiveContact& patch = equations_.active_contacts()[p];
    out.put(held_[p]);
    out.put(patch.friction);
    out.put(patch.sliding_friction);
    out.put(patch.mode);
    out.put(patch.count);
    out.put(patch.features);
    out.put(patch.normal_forces);
    out.put(patch.tangential_force);
  }
  out.put(static_cast<std::uint64_t>(touching_.size()));
  for (const ShapePair& pair : touching_) out.put(pair);
  out.put(static_cast<std::uint64_t>(passing_.size()));
  for (const ShapePair& pair : passing_) out.put(pair);
  out.put(gap_tolerance_);
  out.put(force_scale_);
  out.put(std::int64_t{resolved_});
  out.put(last_event_);
  out.put(events_at_once_);
  for (const EventCount& each : events_) out.put(each);
  // The guard of a settled event is obsolete: it may refer to contacts that are no longer held.
  const bool open = !resolved_;
  out.put(std::int64_t{open && record_.guard});
  out.put(open ? record_.guard.value_or(Guard{}) : Guard{});
  out.put(std::int64_t{open && record_.new_pair});
  out.put(open ? record_.new_pair.value_or(ShapePair{}) : ShapePair{});
  limits_and_motors_.save(out);
}

/// Returns true if everything that a guard refers to exists in this scene and its held contacts.
bool Contacts::is_valid(const Guard& guard, std::span<const ActiveContact> patches) const {
  const std::span<const FeatureShape> shapes = finder_.shapes();
  switch (guard.kind) {
    case Guard::Kind::Gap:
    case Guard::Kind::Rate:
      return guard.pair.a < shapes.size() && guard.pair.b < shapes.size() &&
             is_feature(guard.feature, shapes[guard.pair.a], shapes[guard.pair.b]);
    case Guard::Kind::Limit:
      return guard.limit_motor < limits_and_motors_.count();
    case Guard::Kind::Quantity:
      break;
    default:
      return false;
  }
  if (guard.monitored == static_cast<int>(Quantity::LimitMotor))
    return guard.limit_motor < limits_and_motors_.count();
  if (guard.patch >= patches.size() || guard.point < 0) return false;
  const int points = patches[guard.patch].count;
  switch (static_cast<Quantity>(guard.monitored)) {
    case Quantity::Force:
      return guard.point < points;
    case Quantity::Cone:
    case Quantity::Slip:
      return guard.point == 0;
    case Quantity::Range:
      return guard.point < FeatureLimits::kMaxCount * points;
    case Quantity::Height:
      return guard.point < FeatureLimits::kMaxCount;
    case Quantity::LimitMotor:
      break;
  }
  return false;
}

void Contacts::restore_record(SnapshotReader& in, std::span<const ActiveContact> patches) {
  const bool has_guard = in.get<std::int64_t>() != 0;
  const auto guard = in.get<Guard>();
  const bool has_met = in.get<std::int64_t>() != 0;
  const auto met = in.get<ShapePair>();
  const auto is_ours = [&](const ShapePair& pair) {
    const std::size_t count = finder_.shapes().size();
    return count == 0 ? pair == ShapePair{} : pair.a < count && pair.b < count;
  };
  in.expect(is_ours(met) && (!has_guard || is_valid(guard, patches)));
  record_ = {};
  if (has_guard) record_.guard = guard;
  if (has_met) record_.new_pair = met;
}

void Contacts::restore(SnapshotReader& in) {
  const auto pair = [&] {
    const auto read = in.get<ShapePair>();
    in.expect(read.a < finder_.shapes().size() && read.b < finder_.shapes().size());
    return read;
  };
  std::vector<ActiveContact> patches(in.count(sizeof(ShapePair)));
  held_.clear();
  for (ActiveContact& patch : patches) {
    held_.push_back(pair());
    patch.a = &finder_.shapes()[held_.back().a];
    patch.b = &finder_.shapes()[held_.back().b];
    patch.friction = in.get<double>();
    patch.sliding_friction = in.get<double>();
    patch.mode = in.get<int>();
    patch.count = in.get<int>();
    in.expect(patch.count >= 0 && patch.count <= 2);
    for (Feature& feature : patch.features) {
      feature = in.get<Feature>();
      in.expect(is_feature(feature, *patch.a, *patch.b));
    }
    for (double& force : patch.normal_forces) force = in.get<double>();
    patch.tangential_force = in.get<double>();
  }
  touching_.assign(in.count(sizeof(ShapePair)), {});
  for (ShapePair& each : touching_) each = pair();
  passing_.assign(in.count(sizeof(ShapePair)), {});
  for (ShapePair& each : passing_) each = pair();
  gap_tolerance_ = in.get<double>();
  force_scale_ = in.get<double>();
  resolved_ = in.get<std::int64_t>() != 0;
  last_event_ = in.get<double>();
  events_at_once_ = in.get<int>();
  for (EventCount& each : events_) each = in.get<EventCount>();
  restore_record(in, patches);
  equations_.set_contacts(std::move(patches));
  limits_and_motors_.restore(in);
}

}  // namespace plumb::precise
