#include "engine/world/replay.h"

#include "engine/encoding/encoding.h"
#include "engine/scene/error.h"
#include "engine/world/recording/definition_members.h"
#include "engine/world/recording/recorded_calls.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot/body_hash.h"

namespace plumb {
namespace {

// Type of a decoded argument, which owns the data that the argument refers to.
template <class T>
struct ArgumentStorage {
  using Type = std::remove_cvref_t<T>;
};
template <class T>
struct ArgumentStorage<std::span<const T>> {
  using Type = std::vector<T>;
};

template <class Real, class Result, class... Arguments>
void call(BasicWorld<Real>& world, Result (BasicWorld<Real>::*member)(Arguments...), Decoder& in) {
  std::tuple<typename ArgumentStorage<Arguments>::Type...> arguments;
  std::apply([&](auto&... each) { (in.get(each, "arguments"), ...); }, arguments);
  in.require(in.rest().empty(), "arguments", "are more than the call takes");
  std::apply([&](const auto&... each) { (world.*member)(each...); }, arguments);
}

template <class Real, std::size_t... kEach>
void dispatch(BasicWorld<Real>& world, std::size_t call_index, Decoder& in, std::index_sequence<kEach...>) {
  constexpr auto kCalls = world_calls<Real>();
  ((kEach == call_index ? call(world, std::get<kEach>(kCalls), in) : void()), ...);
}

// Returns the indices of bodies that are in only one of the lists, or have different hashes. Both lists
// ascend.
std::vector<int> differences(const std::vector<BodyHash>& a, const std::vector<BodyHash>& b) {
  std::vector<int> all;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool only_a = j == b.size() || (i < a.size() && a[i].body < b[j].body);
    const bool only_b = i == a.size() || (j < b.size() && b[j].body < a[i].body);
    if (only_a || only_b || a[i].hash != b[j].hash)
      all.push_back(static_cast<int>(only_b ? b[j].body : a[i].body));
    if (!only_b) ++i;
    if (!only_a) ++j;
  }
  return all;
}

}  // namespace

template <class Real>
Replay<Real>::Replay(const std::filesystem::path& file, std::function<bool(const ContactReading&)> hook)
    : file_(file, sizeof(Real)), hook_(std::move(hook)) {}

template <class Real>
bool Replay<Real>::step() {
  while (const auto record = file_.next()) {
    Decoder in(record->content, kRecording);
    switch (record->kind) {
      case RecordKind::Definition:
        world_ = BasicWorld<Real>(in.get<WorldDefinition>("definition"));
        break;
      case RecordKind::State:
        restore(world_, in.get<std::vector<std::byte>>("state"));
        break;
      case RecordKind::Hook:
        if (!in.get<bool>("hook")) {
          world_.on_pre_solve({});
        } else if (hook_) {
          world_.on_pre_solve(hook_);
        } else {
          add_message("a pre-solve hook was set in step " + std::to_string(world_.step_count() + 1) +
                      "; the replay has none");
        }
        break;
      case RecordKind::Call:
        replay_call(record->content);
        break;
      case RecordKind::Hash:
        compare(record->content);
        return true;
      default:
        throw Error(Error::Kind::Value, kRecording, "record", std::to_string(file_.count()),
                    "is of a kind that there is not");
    }
  }
  if (!file_.message().empty()) add_message(file_.message());
  return false;
}

template <class Real>
void Replay<Real>::replay_call(std::span<const std::byte> content) {
  Decoder in(content, kRecording);
  const std::size_t call_index = in.get<std::uint8_t>("call");
  in.require(call_index < kWorldCalls, "call", "is none that this program knows");
  ++report_.calls;
  if (call_index == static_cast<std::size_t>(WorldCall::Step)) ++report_.steps;
  try {
    dispatch(world_, call_index, in, std::make_index_sequence<kWorldCalls>{});
  } catch (const Error& error) {
    if (error.subject() == kRecording) throw;
    add_message(std::string("the call of ") + kWorldCallNames[call_index] + " in step " +
                std::to_string(world_.step_count() + 1) + " was refused: " + error.what());
  }
}

template <class Real>
void Replay<Real>::compare(std::span<const std::byte> content) {
  Decoder in(content, kRecording);
  const std::uint64_t recorded = in.get<std::uint64_t>("hash"), now = world_.hash();
  if (report_.first_difference) return;
  report_.recorded_hash = recorded, report_.hash = now;
  if (recorded == now) return;
  report_.first_difference = world_.step_count();
  if (!in.get<bool>("bodies")) return;
  const auto before = in.get<std::vector<BodyHash>>("bodies");
  for (std::size_t i = 0; i < before.size(); ++i) {
    in.require(before[i].body <= 0x7FFFFFFFu, "bodies", "names a body beyond 2^31 - 1; record it anew");
    in.require(i == 0 || before[i - 1].body < before[i].body, "bodies", "are not in order; record it anew");
  }
  std::vector<BodyHash> bodies;
  hash_awake_bodies(world_.data(), bodies);
  for (const int body : differences(before, bodies)) {
    BodyDifference difference{.body = {static_cast<std::uint32_t>(body), 0}};
    if (body < world_.data().bodies.size()) {
      difference.body.generation = world_.data().bodies.generation(body);
      difference.name = world_.data().extras_of(body).name;
    }
    report_.bodies.push_back(difference);
  }
}

// Keeps only the first message, which is the most relevant.
template <class Real>
void Replay<Real>::add_message(const std::string& message) {
  if (report_.message.empty()) report_.message = message;
}

template class Replay<float>;
template class Replay<double>;

}  // namespace plumb
