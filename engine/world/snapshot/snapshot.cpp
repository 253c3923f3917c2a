#include "engine/world/snapshot.h"

#include <bit>

#include "engine/encoding/encoding.h"
#include "engine/world/checksum.h"
#include "engine/world/snapshot/world_members.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/state/lock.h"

namespace plumb {
namespace {

// Version of the format. Increase it if the meaning of bytes changes while their sizes stay the same.
constexpr std::uint32_t kVersion = 11;

// "plumbsav" in little-endian order.
constexpr std::uint64_t kMagic = 0x766173626D756C70u;

constexpr char kSubject[] = "snapshot";

struct Header {
  std::uint64_t magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t layout = 0;  ///< of the records and the precision
  std::uint64_t size = 0;    ///< bytes after the header
  std::uint64_t sum = 0;     ///< checksum of these bytes
};

}  // namespace

PLUMB_MEMBERS(Header, magic, version, layout, size, sum)

namespace {

constexpr std::size_t kHeaderSize = packed_size<Header>();

// Returns a number that usually changes if the set of members changes, even if nobody increased the version.
template <class Real>
constexpr std::uint32_t layout() {
  std::uint32_t mixed = 0;
  for (const std::size_t size :
       {sizeof(Real), packed_size<WorldDefinition>(), packed_size<BodyRecord<Real>>(),
        packed_size<SolverBody<Real>>(), packed_size<ShapeForm<Real>>(), packed_size<ShapeRecord<Real>>(),
        packed_size<ContactRecord>(), packed_size<ContactConstraint<Real>>(), packed_size<JointRecord>()}) {
    mixed = mixed * 1021 + static_cast<std::uint32_t>(size);
  }
  return mixed;
}

class Save {
 public:
  explicit Save(std::vector<std::byte>& bytes) : out_(bytes) {}

  template <class T>
  void operator()(const T& value) {
    out_.put(value);
  }
  template <class T>
  void operator()(const SlotMap<T>& slots) {
    std::apply([&](const auto&... each) { (out_.put(each), ...); }, slots.parts());
  }
  template <class T>
  void operator()(const LazyArray<T>& list) {
    out_.put(std::get<0>(list.parts()));
  }
  template <class Real>
  void operator()(const CornerPool<Real>& corners) {
    std::apply([&](const auto&... each) { (out_.put(each), ...); }, corners.parts());
  }
  template <class Real>
  void operator()(const DynamicTree<Real>& tree) {
    tree.save(out_.bytes());
  }
  template <class Real>
  void operator()(const ContactGraph<Real>& graph) {
    for (int c = 0; c <= graph.kColours; ++c) out_.put(graph.colour(c));
  }
  template <class Real>
  void operator()(const JointSet<Real>& joints) {
    joints.save(out_);
  }
  // The pairs follow from the contacts.
  void operator()(const PairSet&) {}

 private:
  Encoder out_;
};

class Restore {
 public:
  explicit Restore(std::span<const std::byte> bytes) : in_(bytes, kSubject) {}

  template <class T>
  void operator()(T& value) {
    in_.get(value, "state");
  }
  template <class T>
  void operator()(SlotMap<T>& slots) {
    std::apply([&](auto&... each) { (in_.get(each, "slots"), ...); }, slots.parts());
  }
  template <class T>
  void operator()(LazyArray<T>& list) {
    in_.get(std::get<0>(list.parts()), "bodies");
  }
  template <class Real>
  void operator()(CornerPool<Real>& corners) {
    std::apply([&](auto&... each) { (in_.get(each, "corners"), ...); }, corners.parts());
  }
  template <class Real>
  void operator()(DynamicTree<Real>& tree) {
    tree.restore(in_.rest());
  }
  template <class Real>
  void operator()(ContactGraph<Real>& graph) {
    for (int c = 0; c <= graph.kColours; ++c) in_.get(graph.colour(c), "contacts");
  }
  template <class Real>
  void operator()(JointSet<Real>& joints) {
    joints.restore(in_);
  }
  void operator()(PairSet&) {}

  void finish() { in_.require(in_.rest().empty(), "size", "is larger than what it should hold"); }

 private:
  Decoder in_;
};

// Returns the bytes after the header; throws unless they are exactly as written.
std::span<const std::byte> content_of(std::span<const std::byte> bytes, std::uint32_t expected_layout) {
  Decoder in(bytes, kSubject);
  const Header header = in.get<Header>("header");
  in.require(header.magic == kMagic, "header", "is not that of a snapshot of a world");
  in.require(header.version == kVersion, "version", "is another one than this program's");
  in.require(header.layout == expected_layout, "precision",
             "or the layout of the records is another one than this world's");
  in.require(header.size == in.rest().size(), "size", "is not what was written: bytes are missing or added");
  in.require(header.sum == checksum(in.rest()), "checksum", "does not fit: bytes were changed");
  return in.rest();
}

template <class Real>
void add_pairs(WorldData<Real>& w) {
  w.pairs.reserve(w.contacts.count());
  w.contacts.for_each(
      [&](int, const ContactRecord& contact) { w.pairs.insert(contact.shape_a, contact.shape_b); });
}

template <class Real>
void count_corner_uses(WorldData<Real>& w) {
  w.shapes.for_each([&](int shape, const ShapeRecord<Real>&) {
    const ShapeForm<Real>& form = w.forms[shape];
    require(w.corners.count_use(form.corner, form.stored()), kSubject, "corners", "are stored twice");
  });
}

}  // namespace

template <class Real>
void save(const BasicWorld<Real>& world, std::vector<std::byte>& bytes) {
  static_assert(std::endian::native == std::endian::little);
  require_between_steps(world.data());
  bytes.clear();
  bytes.resize(kHeaderSize);
  Save write(bytes);
  std::apply([&](const auto&... each) { (write(each), ...); }, state_of(world.data()));

  const std::span<const std::byte> content = std::span(bytes).subspan(kHeaderSize);
  const Header header{.layout = layout<Real>(), .size = content.size(), .sum = checksum(content)};
  std::byte* to = bytes.data();
  Encoder::pack(to, header);
}

template <class Real>
std::vector<std::byte> save(const BasicWorld<Real>& world) {
  std::vector<std::byte> bytes;
  save(world, bytes);
  return bytes;
}

template <class Real>
void restore(BasicWorld<Real>& world, std::span<const std::byte> bytes) {
  unlocked(world);
  Restore read(content_of(bytes, layout<Real>()));
  WorldData<Real> fresh;
  std::apply([&](auto&... each) { (read(each), ...); }, state_of(fresh));
  read.finish();
  check_state(fresh);
  require(fresh.graph.rebuild_bodies([&](int body) { return fresh.is_dynamic(body); }), kSubject, "contacts",
          "of one colour share a body");
  add_pairs(fresh);
  count_corner_uses(fresh);
  // Reserve the free lists now, because destroying objects later must not allocate.
  fresh.bodies.reserve_more(0), fresh.body_extras.reserve_more(0), fresh.shapes.reserve_more(0);
  fresh.chains.reserve_more(0), fresh.contacts.reserve_more(0), fresh.joints.reserve_more(0);
  fresh.static_tree.reserve_more(0), fresh.dynamic_tree.reserve_more(0);
  // Nothing throws from here on. The hook and scratch memory are kept.
  const auto from = state_of(fresh), to = state_of(world.data());
  [&]<std::size_t... kEach>(std::index_sequence<kEach...>) {
    (std::swap(std::get<kEach>(from), std::get<kEach>(to)), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(from)>>{});
  world.data().topology_changed = true;
}

#define PLUMB_FOR(Real)                                                 \
  template std::vector<std::byte> save(const BasicWorld<Real>&);        \
  template void save(const BasicWorld<Real>&, std::vector<std::byte>&); \
  template void restore(BasicWorld<Real>&, std::span<const std::byte>);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
