#include "engine/world/recorder.h"

#include <utility>

#include "engine/encoding/encoding.h"
#include "engine/world/recording/definition_members.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot/body_hash.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/validate.h"

namespace plumb {

template <class Real>
RecordedWorld<Real>::RecordedWorld(const std::filesystem::path& file, const WorldDefinition& definition,
                                   RecordOptions options)
    : world_(definition), options_(options), file_(file, sizeof(Real)) {
  Encoder(file_.begin(RecordKind::Definition)).put(definition);
  file_.commit();
  file_.flush();
}

template <class Real>
RecordedWorld<Real>::RecordedWorld(const std::filesystem::path& file, BasicWorld<Real>&& world,
                                   RecordOptions options)
    : world_(std::move(world)), options_(options), file_(file, sizeof(Real)) {
  record_state();
}

// Records a call after it succeeded: a rejected call changes nothing and is not recorded.
template <class Real>
template <WorldCall kCall, class... Arguments>
auto RecordedWorld<Real>::call(const Arguments&... arguments) {
  constexpr auto kMember = std::get<static_cast<std::size_t>(kCall)>(world_calls<Real>());
  if constexpr (kCall == WorldCall::Step) {
    record_step(arguments...);
  } else {
    Encoder record(file_.begin(RecordKind::Call));
    record.put(static_cast<std::uint8_t>(kCall));
    (record.put(arguments), ...);
    if constexpr (std::is_void_v<decltype((world_.*kMember)(arguments...))>) {
      (world_.*kMember)(arguments...);
      file_.commit();
    } else {
      const auto handle = (world_.*kMember)(arguments...);
      file_.commit();
      return handle;
    }
  }
}

template <class Real>
void RecordedWorld<Real>::record_state() {
  const std::vector<std::byte> snapshot = save(world_);
  Encoder(file_.begin(RecordKind::State)).put(snapshot);
  file_.commit();
  file_.flush();
}

template <class Real>
void RecordedWorld<Real>::record_hash() {
  std::vector<BodyHash> bodies;
  if (options_.bodies) hash_awake_bodies(world_.data(), bodies);
  Encoder record(file_.begin(RecordKind::Hash));
  record.put(world_.hash());
  record.put(options_.bodies);
  if (options_.bodies) record.put(bodies);
  file_.commit();
  file_.flush();
}

// Records a step before it is made, so that the recording contains a step that fails. A step that is rejected
// at once is not recorded.
template <class Real>
void RecordedWorld<Real>::record_step(double dt, int substeps) {
  require_unlocked(world_.data());
  if (!(dt >= kSmallestNumber && dt <= kLargestNumber) || substeps < 1 || substeps > 1000)
    return world_.step(dt, substeps);
  Encoder record(file_.begin(RecordKind::Call));
  record.put(static_cast<std::uint8_t>(WorldCall::Step));
  record.put(dt), record.put(substeps);
  file_.commit();
  file_.flush();
  world_.step(dt, substeps);
  record_hash();
}

template <class Real>
void RecordedWorld<Real>::on_pre_solve(std::function<bool(const ContactReading&)> hook) {
  const bool is_set = static_cast<bool>(hook);
  world_.on_pre_solve(std::move(hook));
  Encoder(file_.begin(RecordKind::Hook)).put(is_set);
  file_.commit();
}

template <class Real>
void RecordedWorld<Real>::restore(std::span<const std::byte> snapshot) {
  plumb::restore(world_, snapshot);
  record_state();
}

template <class Real>
void RecordedWorld<Real>::edit(const std::function<void(BasicWorld<Real>&)>& change) {
  change(world_);
  record_state();
}

template <class Real>
BodyId RecordedWorld<Real>::create_body(const BodyDefinition& definition,
                                        std::span<const ShapeDefinition> shapes, std::vector<ShapeId>& made) {
  const BodyId body = create_body(definition, shapes);
  made = world_.shapes(body);
  return body;
}

// Defines the members for the calls, which have one to four arguments.
#define PLUMB_RECORD_1(id, name, result, A) \
  template <class Real>                     \
  result RecordedWorld<Real>::name(A a) {   \
    return call<WorldCall::id>(a);          \
  }
#define PLUMB_RECORD_2(id, name, result, A, B) \
  template <class Real>                        \
  result RecordedWorld<Real>::name(A a, B b) { \
    return call<WorldCall::id>(a, b);          \
  }
#define PLUMB_RECORD_3(id, name, result, A, B, C)   \
  template <class Real>                             \
  result RecordedWorld<Real>::name(A a, B b, C c) { \
    return call<WorldCall::id>(a, b, c);            \
  }
#define PLUMB_RECORD_4(id, name, result, A, B, C, D)     \
  template <class Real>                                  \
  result RecordedWorld<Real>::name(A a, B b, C c, D d) { \
    return call<WorldCall::id>(a, b, c, d);              \
  }
#define PLUMB_FIFTH(a, b, c, d, fifth, ...) fifth
#define PLUMB_RECORD(id, name, result, ...)                                                  \
  PLUMB_FIFTH(__VA_ARGS__, PLUMB_RECORD_4, PLUMB_RECORD_3, PLUMB_RECORD_2, PLUMB_RECORD_1, ) \
  (id, name, result, __VA_ARGS__)
PLUMB_WORLD_CALLS(PLUMB_RECORD)

template class RecordedWorld<float>;
template class RecordedWorld<double>;

}  // namespace plumb
