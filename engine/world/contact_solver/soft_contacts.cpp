#include "engine/world/contact_solver/soft_contacts.h"

#include <algorithm>
#include <cstddef>

#include "engine/core/room.h"
#include "engine/world/contact_solver/contact_passes.h"

#if defined(__x86_64__) || defined(__i386__)
#define PLUMB_AVX2 [[gnu::target("avx2")]]
#else
#define PLUMB_AVX2
#endif

namespace plumb {
namespace {

// Fewest contacts of a world for which blocks are built: gathering fewer costs more than it saves. A narrow
// register has two doubles, and saves little.
template <class Real>
constexpr std::size_t least_contacts(VectorWidth width) {
  return sizeof(Real) == 8 && width == VectorWidth::Bytes16 ? 64 : 16;
}

// Fewest contacts in a block: one alone costs less.
constexpr int kLeastLanes = 2;

struct WarmStart {
  static constexpr bool kMoves = false;
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    if (step.warm_start != 1) scale_impulses(c, step.warm_start);
    warm_start_contact<Number>(pair, c);
  }
};
struct Solve {
  static constexpr bool kMoves = false;
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    solve_contact<Number>(pair, c, step);
  }
};
struct Relax {
  static constexpr bool kMoves = true;  ///< reads how far the bodies have moved
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    relax_contact<Number>(pair, c, step);
  }
};

// Bodies that do not give way are only read: several contacts of a colour may share one.
template <class Pass, class Real>
[[gnu::always_inline]] inline void run_alone(BodyMotion<Real>* motion, ContactConstraint<Real>& c,
                                             const ContactStep<Real>& step) {
  Pair<Real, BodyMotion<Real>&> pair{motion[c.body_a], motion[c.body_b], c.normal};
  Pass::template run<Real>(pair, c, step);
  const bool both = c.hardness == ContactHardness::Soft;
  if (both || is_dynamic(pair.a)) pair.a.velocity = pair.va, pair.a.angular_velocity = pair.wa;
  if (both || is_dynamic(pair.b)) pair.b.velocity = pair.vb, pair.b.angular_velocity = pair.wb;
}

/// The bodies a, or the bodies b, of a block.
template <class Number>
struct LaneBodies {
  using Real = typename Number::Number;

  BodyMotion<Real>* motion;
  const std::uint32_t (&place)[Number::kLanes];
  const Number &inverse_mass, &inverse_inertia;
  Vec2<Number> velocity{}, moved{};
  Number angular_velocity = 0, turned = 0;

  [[gnu::always_inline]] LaneBodies(BodyMotion<Real>* bodies, const std::uint32_t (&places)[Number::kLanes],
                                    const Number& mass, const Number& inertia, bool moves)
      : motion(bodies), place(places), inverse_mass(mass), inverse_inertia(inertia) {
    static_assert(sizeof(BodyMotion<Real>) == 8 * sizeof(Real) && offsetof(BodyMotion<Real>, velocity) == 0 &&
                  offsetof(BodyMotion<Real>, turned) == 5 * sizeof(Real));
    Number first[4], last[4];
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 0); }, first);
    velocity = {first[0], first[1]}, angular_velocity = first[2], moved.x = first[3];
    if (!moves) return;
    load_records<true>(
        [&](int i) __attribute__((always_inline)) { return row(i, 4); }, last);
    moved.y = last[0], turned = last[1];
  }

  [[gnu::always_inline]] void store(const Vec2<Number>& v, const Number& w) const {
    store_records<true>([&](int i) __attribute__((always_inline)) { return row(i, 0); },
                        {v.x, v.y, w, moved.x});
  }

 private:
  [[gnu::always_inline]] Real* row(int lane, int number) const {
    return reinterpret_cast<Real*>(reinterpret_cast<char*>(motion) + std::size_t{8} * place[lane]) + number;
  }
};

template <class Pass, class Number, class Real>
[[gnu::always_inline]] inline void run_blocks(BodyMotion<Real>* motion, ContactBlock<Number>* block,
                                              const ContactBlock<Number>* end,
                                              const ContactStep<Real>& settings) {
  const ContactStep<Real> step = settings;  // a copy, which no other pointer reaches
  for (; block != end; ++block) {
    const LaneBodies<Number> a(motion, block->place_a, block->inverse_mass_a, block->inverse_inertia_a,
                               Pass::kMoves);
    const LaneBodies<Number> b(motion, block->place_b, block->inverse_mass_b, block->inverse_inertia_b,
                               Pass::kMoves);
    Pair<Number, const LaneBodies<Number>&> pair{a, b, block->normal};
    Pass::template run<Number>(pair, *block, step);
    if (block->gives_way_a) a.store(pair.va, pair.wa);
    if (block->gives_way_b) b.store(pair.vb, pair.wb);
  }
}

// The loops over blocks, for registers that all processors have, and for those of AVX2.
template <class Number, class Real>
struct Loops {
  using Block = ContactBlock<Number>;
  static void gather(Block& block, const BodyMotion<Real>* motion) { plumb::gather(block, motion); }
  static void scatter(Block* block, const Block* end) {
    for (; block != end; ++block) plumb::scatter(*block);
  }
  template <class Pass>
  static void run(BodyMotion<Real>* motion, Block* block, const Block* end, const ContactStep<Real>& step) {
    run_blocks<Pass>(motion, block, end, step);
  }
};
template <class Real, int kLanes>
struct Loops<Lanes<Real, kLanes, 32>, Real> {
  using Block = ContactBlock<Lanes<Real, kLanes, 32>>;
  PLUMB_AVX2 static void gather(Block& block, const BodyMotion<Real>* motion) {
    plumb::gather(block, motion);
  }
  PLUMB_AVX2 static void scatter(Block* block, const Block* end) {
    for (; block != end; ++block) plumb::scatter(*block);
  }
  template <class Pass>
  PLUMB_AVX2 static void run(BodyMotion<Real>* motion, Block* block, const Block* end,
                             const ContactStep<Real>& step) {
    run_blocks<Pass>(motion, block, end, step);
  }
};

}  // namespace

template <class Real>
template <int kBytes>
bool SoftContacts<Real>::gather(Blocks<kBytes>& blocks, const BodyMotion<Real>* motion,
                                const std::vector<char>& apart) {
  using Constraint = ContactConstraint<Real>;
  constexpr int kLanes = Block<kBytes>::kLanes, kKinds = 16;
  blocks.count = 0, alone_.clear(), runs_.clear();
  runs_.reserve(ContactGraph<Real>::kColours + 1);
  ensure_room(alone_, graph_->size());
  // Contacts of one kind: they may share a block.
  Constraint* waiting[kKinds][kLanes];
  int counts[kKinds] = {};
  const auto flush = [&](int kind) {
    if (blocks.count == static_cast<int>(blocks.list.size())) {
      ensure_room(blocks.list, blocks.list.size() + 1);
      blocks.list.emplace_back();
    }
    Block<kBytes>& block = blocks.list[blocks.count++];
    for (int i = 0; i < kLanes; ++i) block.contact[i] = waiting[kind][std::min(i, counts[kind] - 1)];
    Loops<Number<kBytes>, Real>::gather(block, motion);
    counts[kind] = 0;
  };
  const auto stays_alone = [&](const Constraint& c) {
    const bool stopped_rolling = !rolls(c) && c.rolling_impulse != 0;
    return c.hardness == ContactHardness::Rigid || c.restitution > 0 || stopped_rolling ||
           (!apart.empty() && apart[c.contact]);
  };
  graph_->for_each_colour([&](std::vector<Constraint>& colour, bool has_colour) {
    for (Constraint& c : colour) {
      if (!has_colour || stays_alone(c)) {
        alone_.push_back(&c);
        continue;
      }
      int kind = (c.count == 2) + 2 * rolls(c);
      if (c.hardness != ContactHardness::Soft)
        kind += is_dynamic(motion[c.body_a]) ? 4 : is_dynamic(motion[c.body_b]) ? 8 : 12;
      waiting[kind][counts[kind]++] = &c;
      if (counts[kind] == kLanes) flush(kind);
    }
    for (int kind = 0; kind < kKinds; ++kind) {
      if (counts[kind] >= kLeastLanes) flush(kind);
      for (int i = 0; i < counts[kind]; ++i) alone_.push_back(waiting[kind][i]);
      counts[kind] = 0;
    }
    runs_.push_back({blocks.count, static_cast<int>(alone_.size())});
  });
  return blocks.count > 0;
}

template <class Real>
void SoftContacts<Real>::begin(ContactGraph<Real>& graph, const BodyMotion<Real>* motion,
                               const std::vector<char>& apart) {
  graph_ = &graph;
  width_ = graph.empty() ? VectorWidth::None : vector_width();
  if (width_ != VectorWidth::None && graph.size() < least_contacts<Real>(width_)) width_ = VectorWidth::None;
  if (width_ == VectorWidth::Bytes16 && !gather(blocks16_, motion, apart)) width_ = VectorWidth::None;
  if (width_ == VectorWidth::Bytes32 && !gather(blocks32_, motion, apart)) width_ = VectorWidth::None;
}

template <class Real>
template <class Pass, int kBytes>
void SoftContacts<Real>::run_colour(Blocks<kBytes>& blocks, Run from, Run to, BodyMotion<Real>* motion,
                                    const ContactStep<Real>& step) {
  Block<kBytes>* const list = blocks.list.data();
  if (from.blocks < to.blocks)
    Loops<Number<kBytes>, Real>::template run<Pass>(motion, list + from.blocks, list + to.blocks, step);
  for (int i = from.alone; i < to.alone; ++i) run_alone<Pass>(motion, *alone_[i], step);
}

template <class Real>
template <class Pass>
[[gnu::noinline]] void SoftContacts<Real>::sweep(BodyMotion<Real>* motion, const ContactStep<Real>& step) {
  if (width_ == VectorWidth::None) {
    graph_->for_each([&](ContactConstraint<Real>& c) { run_alone<Pass>(motion, c, step); });
    return;
  }
  Run done;
  for (const Run& to : runs_) {
    if (width_ == VectorWidth::Bytes32) {
      run_colour<Pass>(blocks32_, done, to, motion, step);
    } else {
      run_colour<Pass>(blocks16_, done, to, motion, step);
    }
    done = to;
  }
}

template <class Real>
void SoftContacts<Real>::warm_start(BodyMotion<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<WarmStart>(motion, step);
}

template <class Real>
void SoftContacts<Real>::solve(BodyMotion<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<Solve>(motion, step);
}

template <class Real>
void SoftContacts<Real>::relax(BodyMotion<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<Relax>(motion, step);
}

template <class Real>
void SoftContacts<Real>::finish() {
  const auto scatter = [](auto& blocks, auto loops) {
    loops.scatter(blocks.list.data(), blocks.list.data() + blocks.count);
  };
  if (width_ == VectorWidth::Bytes16) scatter(blocks16_, Loops<Number<16>, Real>());
  if (width_ == VectorWidth::Bytes32) scatter(blocks32_, Loops<Number<32>, Real>());
}

template class SoftContacts<float>;
template class SoftContacts<double>;

}  // namespace plumb
