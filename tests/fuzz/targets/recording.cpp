// Files that claim to be recordings: replaying one ends, or throws a typed error, and does the same again.
// Bytes alone hardly ever get past the checksums: in most runs the input is the records, and the rest is put
// around them.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/encoding/encoding.h"
#include "engine/scene/error.h"
#include "engine/world/checksum.h"
#include "engine/world/recording/definition_members.h"
#include "engine/world/recording/recorded_calls.h"
#include "engine/world/recording/recording_file.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "tests/fuzz/support/patches.h"
#include "tests/fuzz/support/require.h"
#include "tests/fuzz/support/world_parts.h"
#include "tests/fuzz/support/world_player.h"

namespace plumb::fuzz {
namespace {

using Bytes = std::vector<std::byte>;

/// A file in memory alone.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : number_(memfd_create("recording", 0)) {
    require(number_ >= 0, "there is room for a file in memory");
    const auto written = write(number_, bytes.data(), bytes.size());
    require(written == static_cast<ssize_t>(bytes.size()), "the file in memory takes what is written");
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(number_); }
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_;
};

// Bytes that a writer puts before the first record.
template <class Real>
Bytes file_header() {
  const MemoryFile file({});
  { const RecordingWriter writer(file.path(), sizeof(Real)); }
  Bytes header(64);
  const int number = static_cast<int>(std::stoi(file.path().filename().string()));
  header.resize(static_cast<std::size_t>(pread(number, header.data(), header.size(), 0)));
  return header;
}

void append_record(Bytes& file, const Bytes& record) {
  Encoder out(file);
  out.put(static_cast<std::uint32_t>(record.size()));
  out.put(static_cast<std::uint32_t>(checksum(record)));
  file.insert(file.end(), record.begin(), record.end());
}

template <class Real>
Bytes snapshot_of_recipe(std::span<const std::uint8_t> bytes) {
  ByteSource recipe(bytes);
  WorldPlayer<Real> player(recipe);
  player.play();
  return save(player.world());
}

// Calls whose arguments are more than a few numbers, as a recorder writes them.
void put_call(Bytes& record, ByteSource& in) {
  Encoder out(record);
  const auto call = [&](WorldCall which) { out.put(static_cast<std::uint8_t>(which)); };
  const auto body = [&] { return BodyId{in.byte(), in.byte() % 4u}; };
  switch (in.below(6)) {
    case 0:
      call(WorldCall::Step);
      out.put(in.number(0, 0.1)), out.put(1 + in.below(8));
      break;
    case 1:
      call(WorldCall::CreateBodyWithShape);
      out.put(draw_body(in)), out.put(draw_shape(in));
      break;
    case 2:
      call(WorldCall::CreateShape);
      out.put(body()), out.put(draw_shape(in));
      break;
    case 3:
      call(WorldCall::CreateChain);
      out.put(body()), out.put(draw_chain(in));
      break;
    case 4:
      call(WorldCall::CreateJoint);
      out.put(body()), out.put(body()), out.put(draw_joint(in));
      break;
    default:
      call(WorldCall::Change);
      out.put(JointId{in.byte(), in.byte() % 4u}), out.put(draw_joint(in).kind);
  }
}

constexpr int kRecipe = 130, kCall = 131;

Bytes begin_record(RecordKind kind) { return {static_cast<std::byte>(kind)}; }

// Each record: its kind, its length, its bytes. Two kinds more than files have: a state whose bytes are the
// recipe of a world, and a call drawn from its bytes.
template <class Real>
Bytes framed(ByteSource& in) {
  static const Bytes header = file_header<Real>();
  Bytes file = header;
  while (!in.empty()) {
    const int kind = in.byte();
    const auto content = in.take(in.byte());
    Bytes record;
    if (kind == kRecipe) {
      record = begin_record(RecordKind::State);
      Encoder(record).put(snapshot_of_recipe<Real>(content));
    } else if (kind >= kCall) {
      record = begin_record(RecordKind::Call);
      ByteSource arguments(content);
      put_call(record, arguments);
    } else {
      record.push_back(static_cast<std::byte>(kind % 8));
      for (const std::uint8_t byte : content) record.push_back(std::byte{byte});
    }
    append_record(file, record);
  }
  return file;
}

// Calls of a world that has no bodies yet, each drawn from its bytes, and damaged by what is left of them: no
// step is taken, so that very many are read.
template <class Real>
Bytes damaged_calls(ByteSource& in) {
  static const Bytes header = file_header<Real>();
  Bytes file = header;
  while (!in.empty()) {
    ByteSource arguments(in.take(in.byte()));
    Bytes record = begin_record(RecordKind::Call);
    put_call(record, arguments);
    patch(record, arguments);
    append_record(file, record);
  }
  return file;
}

struct Outcome {
  std::string error;
  std::uint64_t hash = 0;
  std::int64_t steps = 0;
  std::string message;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

template <class Real>
Outcome replay_once(const std::filesystem::path& path) {
  Outcome outcome;
  try {
    Replay<Real> replay(path, [](const ContactReading&) { return true; });
    while (replay.step()) {
    }
    outcome.hash = replay.world().hash();
    outcome.steps = replay.report().steps;
    outcome.message = replay.report().message;
  } catch (const Error& error) {
    require(error.kind() == Error::Kind::Value, "a recording is refused for its values");
    outcome.error = error.what();
  }
  return outcome;
}

template <class Real>
void replay_twice(const Bytes& bytes) {
  const MemoryFile file(bytes);
  require(replay_once<Real>(file.path()) == replay_once<Real>(file.path()),
          "a recording is replayed the same way twice");
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb::fuzz;
  ByteSource in({data, size});
  const int kind = in.byte() % 8;
  if (kind < 2) {
    replay_twice<float>(framed<float>(in));
  } else if (kind < 4) {
    replay_twice<double>(framed<double>(in));
  } else if (kind < 7) {
    replay_twice<float>(damaged_calls<float>(in));
  } else {
    Bytes bytes(in.rest().size());
    if (!bytes.empty()) std::memcpy(bytes.data(), in.rest().data(), bytes.size());
    replay_twice<float>(bytes);
  }
  return 0;
}
