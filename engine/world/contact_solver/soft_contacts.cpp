#include "engine/world/contact_solver/soft_contacts.h"

#include <algorithm>
#include <cstddef>

#include "engine/core/capacity.h"
#include "engine/math/widest_register.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/contact_solver/lane_bodies.h"

namespace plumb {
namespace {

// Minimum number of contacts in a world for which blocks are built: gathering fewer costs more than it saves.
// A narrow register holds only two doubles, which saves less.
template <class Real>
constexpr std::size_t min_contacts(VectorWidth width) {
  return sizeof(Real) == 8 && width == VectorWidth::Bytes16 ? 64 : 16;
}

// Minimum number of contacts in a block: a single contact costs less without one.
constexpr int kMinLanes = 2;

// Number of blocks, and of single contacts, in a thread's task: 1 to 2 us of work. Joining a loop, or waiting
// for the last thread, takes about 0.3 us. So a colour that fits into one task is solved by one thread.
constexpr int kBlocksPerTask = 16, kSinglesPerTask = 48;

struct WarmStart {
  static constexpr bool kReadsDisplacement = false;
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    if (step.warm_start != 1) scale_impulses(c, step.warm_start);
    warm_start_contact<Number>(pair, c);
  }
};
struct Solve {
  static constexpr bool kReadsDisplacement = false;
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    solve_contact<Number>(pair, c, step);
  }
};
struct Relax {
  static constexpr bool kReadsDisplacement = true;
  template <class Number, class Pair, class Contact, class Real>
  [[gnu::always_inline]] static void run(Pair& pair, Contact& c, const ContactStep<Real>& step) {
    relax_contact<Number>(pair, c, step);
  }
};

// Calls `act` with the blocks in use, if any.
template <class Narrow, class Wide, class Act>
[[gnu::always_inline]] inline void with_blocks(VectorWidth width, Narrow& blocks16, Wide& blocks32,
                                               const Act& act) {
  if constexpr (kWidestRegister >= 32)
    if (width == VectorWidth::Bytes32) return act(blocks32);
  if constexpr (kWidestRegister >= 16)
    if (width == VectorWidth::Bytes16) act(blocks16);
}

// Non-dynamic bodies are only read, because several contacts of a colour may share one.
template <class Pass, class Axes, class Real>
[[gnu::always_inline]] inline void run_single(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                              const ContactStep<Real>& step, Axes free) {
  BodyPair<Real, SolverBody<Real>&, Axes> pair{motion[c.body_a], motion[c.body_b], c.normal, free};
  Pass::template run<Real>(pair, c, step);
  const bool both = c.hardness == ContactHardness::Soft;
  if (both || is_dynamic(pair.a)) pair.a.velocity = pair.va, pair.a.angular_velocity = pair.wa;
  if (both || is_dynamic(pair.b)) pair.b.velocity = pair.vb, pair.b.angular_velocity = pair.wb;
}

template <class Pass, class Real>
[[gnu::noinline]] void run_locked(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                  const ContactStep<Real>& step) {
  run_single<Pass>(motion, c, step, FreeAxes<Real>(motion[c.body_a], motion[c.body_b], c));
}

template <class Pass, class Real>
[[gnu::always_inline]] inline void run_single(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                              const ContactStep<Real>& step) {
  if (c.locks != 0) [[unlikely]]
    return run_locked<Pass>(motion, c, step);
  run_single<Pass>(motion, c, step, AllAxes{});
}

template <class Pass, class Number, class Real>
[[gnu::always_inline]] inline void run_blocks(SolverBody<Real>* motion, ContactBlock<Number>* block,
                                              const ContactBlock<Number>* end,
                                              const ContactStep<Real>& settings) {
  const ContactStep<Real> step = settings;  // a local copy: no pointer can change it
  for (; block != end; ++block) {
    const LaneBodies<Number> a(motion, block->offset_a, block->inverse_mass_a, block->inverse_inertia_a,
                               Pass::kReadsDisplacement);
    const LaneBodies<Number> b(motion, block->offset_b, block->inverse_mass_b, block->inverse_inertia_b,
                               Pass::kReadsDisplacement);
    BodyPair<Number, const LaneBodies<Number>&> pair{a, b, block->normal};
    Pass::template run<Number>(pair, *block, step);
    if (block->is_dynamic_a) a.store(pair.va, pair.wa);
    if (block->is_dynamic_b) b.store(pair.vb, pair.wb);
  }
}

// The loops over blocks, for registers that all processors have, and for those of AVX2.
template <class Number, class Real>
struct Loops {
  using Block = ContactBlock<Number>;
  static void gather(Block& block, const SolverBody<Real>* motion) { plumb::gather(block, motion); }
  static void regather(Block& block) { plumb::regather(block); }
  static void scatter(Block* block, const Block* end) {
    for (; block != end; ++block) plumb::scatter(*block);
  }
  template <class Pass>
  static void run(SolverBody<Real>* motion, Block* block, const Block* end, const ContactStep<Real>& step) {
    run_blocks<Pass>(motion, block, end, step);
  }
};
template <class Real, int kLanes>
struct Loops<Lanes<Real, kLanes, 32>, Real> {
  using Block = ContactBlock<Lanes<Real, kLanes, 32>>;
  PLUMB_AVX2 static void gather(Block& block, const SolverBody<Real>* motion) {
    plumb::gather(block, motion);
  }
  PLUMB_AVX2 static void regather(Block& block) { plumb::regather(block); }
  PLUMB_AVX2 static void scatter(Block* block, const Block* end) {
    for (; block != end; ++block) plumb::scatter(*block);
  }
  template <class Pass>
  PLUMB_AVX2 static void run(SolverBody<Real>* motion, Block* block, const Block* end,
                             const ContactStep<Real>& step) {
    run_blocks<Pass>(motion, block, end, step);
  }
};

}  // namespace

template <class Real>
[[gnu::always_inline]] inline int SoftContacts<Real>::kind_of(const ContactConstraint<Real>& c,
                                                              const SolverBody<Real>* motion,
                                                              const std::vector<char>& excluded) {
  const bool stopped_rolling = !rolls(c) && c.rolling_impulse != 0;
  const bool is_single =
      is_rigid(c) || stopped_rolling || c.locks != 0 || (!excluded.empty() && excluded[c.contact]);
  if (is_single) return kSingle;
  const int kind = (c.count == 2) + 2 * rolls(c);
  if (c.hardness == ContactHardness::Soft) return kind;
  return kind + (is_driven(c) ? 12 : 0) +
         (is_dynamic(motion[c.body_a])   ? 4
          : is_dynamic(motion[c.body_b]) ? 8
                                         : 12);
}

// Calls `add_block(contacts, count)` and `add_single(contact)`.
template <class Real>
template <int kBytes, class AddBlock, class AddSingle>
[[gnu::always_inline]] inline void SoftContacts<Real>::sort(const Segment& segment,
                                                            const SolverBody<Real>* motion,
                                                            const std::vector<char>& excluded,
                                                            const AddBlock& add_block,
                                                            const AddSingle& add_single) {
  constexpr int kLanes = Block<kBytes>::kLanes;
  // Contacts that wait for a full block, by kind.
  ContactConstraint<Real>* waiting[kKinds][kLanes];
  int counts[kKinds] = {};
  for (int i = 0; i < segment.count; ++i) {
    ContactConstraint<Real>& c = segment.first[i];
    const int kind = segment.has_colour ? kind_of(c, motion, excluded) : kSingle;
    if (kind == kSingle) {
      add_single(&c);
      continue;
    }
    waiting[kind][counts[kind]++] = &c;
    if (counts[kind] == kLanes) add_block(waiting[kind], kLanes), counts[kind] = 0;
  }
  for (int kind = 0; kind < kKinds; ++kind) {
    if (counts[kind] >= kMinLanes) {
      add_block(waiting[kind], counts[kind]);
    } else {
      for (int i = 0; i < counts[kind]; ++i) add_single(waiting[kind][i]);
    }
  }
}

template <class Real>
template <int kBytes>
bool SoftContacts<Real>::gather(Blocks<kBytes>& blocks, const SolverBody<Real>* motion,
                                const std::vector<char>& excluded) {
  using Constraint = ContactConstraint<Real>;
  constexpr int kLanes = Block<kBytes>::kLanes;
  blocks.count = 0, singles_.clear(), colour_ends_.clear();
  colour_ends_.reserve(ContactGraph<Real>::kColours + 1);
  ensure_capacity(singles_, graph_->size());
  const auto fill = [&](Block<kBytes>& block, Constraint* const* contacts, int count) {
    for (int i = 0; i < kLanes; ++i) block.contact[i] = contacts[std::min(i, count - 1)];
    Loops<Number<kBytes>, Real>::gather(block, motion);
  };
  if (scheduler_->shares()) {
    gather_shared(blocks, motion, excluded, fill);
  } else {
    graph_->for_each_colour([&](std::vector<Constraint>& colour, bool has_colour) {
      const Segment whole{colour.data(), static_cast<int>(colour.size()), has_colour};
      sort<kBytes>(
          whole, motion, excluded,
          [&](Constraint* const* contacts, int count) {
            if (blocks.count == static_cast<int>(blocks.list.size())) {
              ensure_capacity(blocks.list, blocks.list.size() + 1);
              blocks.list.emplace_back();
            }
            fill(blocks.list[blocks.count++], contacts, count);
          },
          [&](Constraint* c) { singles_.push_back(c); });
      colour_ends_.push_back({blocks.count, static_cast<int>(singles_.size()), has_colour});
    });
  }
  return blocks.count > 0;
}

// Counts the blocks and single contacts of the segments of all colours, then fills each at its index.
template <class Real>
template <int kBytes, class Fill>
void SoftContacts<Real>::gather_shared(Blocks<kBytes>& blocks, const SolverBody<Real>* motion,
                                       const std::vector<char>& excluded, const Fill& fill) {
  using Constraint = ContactConstraint<Real>;
  segments_.clear();
  graph_->for_each_colour([&](std::vector<Constraint>& colour, bool has_colour) {
    const int count = static_cast<int>(colour.size());
    // Contacts without a colour are solved in order, so they are not sorted.
    for (int first = 0; first < count; first += kSegment)
      append(segments_, Segment{colour.data() + first, std::min(kSegment, count - first), has_colour,
                                first + kSegment >= count});
  });
  const int count = static_cast<int>(segments_.size());
  scheduler_->blocks(count, [&](int i) {
    Segment& segment = segments_[i];
    int kind_counts[kKinds + 1] = {};
    for (int k = 0; k < segment.count; ++k)
      ++kind_counts[segment.has_colour ? kind_of(segment.first[k], motion, excluded) : kSingle];
    segment.start = {0, kind_counts[kSingle]};
    for (int kind = 0; kind < kKinds; ++kind) {
      const int rest = kind_counts[kind] % Block<kBytes>::kLanes,
                full = kind_counts[kind] / Block<kBytes>::kLanes;
      segment.start.blocks += full + (rest >= kMinLanes ? 1 : 0);
      segment.start.singles += rest >= kMinLanes ? 0 : rest;
    }
  });
  ColourEnd next;
  for (Segment& segment : segments_) {
    const ColourEnd size = segment.start;
    segment.start = next;
    next.blocks += size.blocks, next.singles += size.singles;
    if (segment.ends_colour) colour_ends_.push_back({next.blocks, next.singles, segment.has_colour});
  }
  blocks.count = next.blocks;
  ensure_capacity(blocks.list, static_cast<std::size_t>(next.blocks));
  if (static_cast<int>(blocks.list.size()) < next.blocks) blocks.list.resize(next.blocks);
  singles_.resize(next.singles);
  scheduler_->blocks(count, [&](int i) {
    ColourEnd at = segments_[i].start;
    sort<kBytes>(
        segments_[i], motion, excluded,
        [&](Constraint* const* contacts, int lanes) { fill(blocks.list[at.blocks++], contacts, lanes); },
        [&](Constraint* c) { singles_[at.singles++] = c; });
  });
}

template <class Real>
void SoftContacts<Real>::prepare(ContactGraph<Real>& graph, const SolverBody<Real>* motion,
                                 const std::vector<char>& excluded, LoopScheduler& scheduler) {
  graph_ = &graph, scheduler_ = &scheduler;
  width_ = graph.empty() ? VectorWidth::None : vector_width();
  if (width_ != VectorWidth::None && graph.size() < min_contacts<Real>(width_)) width_ = VectorWidth::None;
  with_blocks(width_, blocks16_, blocks32_, [&](auto& blocks) {
    if (!gather(blocks, motion, excluded)) width_ = VectorWidth::None;
  });
}

template <class Real>
template <class Pass, int kBytes>
[[gnu::always_inline]] inline void SoftContacts<Real>::run_colour(Blocks<kBytes>& blocks, ColourEnd from,
                                                                  ColourEnd to, SolverBody<Real>* motion,
                                                                  const ContactStep<Real>& step) {
  Block<kBytes>* const list = blocks.list.data();
  if (from.blocks < to.blocks)
    Loops<Number<kBytes>, Real>::template run<Pass>(motion, list + from.blocks, list + to.blocks, step);
  for (int i = from.singles; i < to.singles; ++i) run_single<Pass>(motion, *singles_[i], step);
}

template <class Real>
template <class Pass, int kBytes>
[[gnu::noinline]] void SoftContacts<Real>::run_colour_shared(Blocks<kBytes>& blocks, ColourEnd from,
                                                             ColourEnd to, SolverBody<Real>* motion,
                                                             const ContactStep<Real>& step) {
  const int block_tasks = (to.blocks - from.blocks + kBlocksPerTask - 1) / kBlocksPerTask,
            single_tasks = (to.singles - from.singles + kSinglesPerTask - 1) / kSinglesPerTask;
  if (!to.has_colour || block_tasks + single_tasks < 2)
    return run_colour<Pass>(blocks, from, to, motion, step);
  scheduler_->blocks(block_tasks + single_tasks, [&](int task) {
    ColourEnd first = from, last = from;
    if (task < block_tasks) {
      first.blocks += task * kBlocksPerTask;
      last.blocks = std::min(first.blocks + kBlocksPerTask, to.blocks);
    } else {
      first.singles += (task - block_tasks) * kSinglesPerTask;
      last.singles = std::min(first.singles + kSinglesPerTask, to.singles);
    }
    run_colour<Pass>(blocks, first, last, motion, step);
  });
}

template <class Real>
template <class Pass>
[[gnu::noinline]] void SoftContacts<Real>::run_pass(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (width_ == VectorWidth::None) {
    graph_->for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool has_colour) {
      const int count = static_cast<int>(colour.size());
      scheduler_->ranges(count, has_colour ? kSinglesPerTask : count, [&](int first, int last) {
        for (int i = first; i < last; ++i) run_single<Pass>(motion, colour[i], step);
      });
    });
    return;
  }
  const bool shares = scheduler_->shares();
  with_blocks(
      width_, blocks16_, blocks32_, [&](auto& blocks) __attribute__((always_inline)) {
        ColourEnd done;
        for (const ColourEnd& to : colour_ends_) {
          if (shares) {
            run_colour_shared<Pass>(blocks, done, to, motion, step);
          } else {
            run_colour<Pass>(blocks, done, to, motion, step);
          }
          done = to;
        }
      });
}

template <class Real>
void SoftContacts<Real>::warm_start(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) run_pass<WarmStart>(motion, step);
}

template <class Real>
void SoftContacts<Real>::solve(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) run_pass<Solve>(motion, step);
}

template <class Real>
void SoftContacts<Real>::relax(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) run_pass<Relax>(motion, step);
}

template <class Real>
template <int kBytes>
void SoftContacts<Real>::scatter_restitution(Blocks<kBytes>& blocks) {
  scheduler_->ranges(blocks.count, kBlocksPerTask, [&](int first, int last) {
    for (Block<kBytes>* block = blocks.list.data() + first; block != blocks.list.data() + last; ++block)
      if (block->bounces) Loops<Number<kBytes>, Real>::scatter(block, block + 1);
  });
}

template <class Real>
void SoftContacts<Real>::scatter_restitution() {
  with_blocks(width_, blocks16_, blocks32_, [this](auto& blocks) { this->scatter_restitution(blocks); });
}

template <class Real>
template <int kBytes>
void SoftContacts<Real>::gather_restitution(Blocks<kBytes>& blocks) {
  scheduler_->ranges(blocks.count, kBlocksPerTask, [&](int first, int last) {
    for (Block<kBytes>* block = blocks.list.data() + first; block != blocks.list.data() + last; ++block)
      if (block->bounces) Loops<Number<kBytes>, Real>::regather(*block);
  });
}

template <class Real>
void SoftContacts<Real>::gather_restitution() {
  with_blocks(width_, blocks16_, blocks32_, [this](auto& blocks) { this->gather_restitution(blocks); });
}

template <class Real>
void SoftContacts<Real>::finish() {
  const auto scatter = []<class Lane>(ContactBlock<Lane>* first, const ContactBlock<Lane>* last) {
    Loops<Lane, Real>::scatter(first, last);
  };
  with_blocks(width_, blocks16_, blocks32_, [&](auto& blocks) {
    scheduler_->ranges(blocks.count, kBlocksPerTask, [&](int first, int last) {
      scatter(blocks.list.data() + first, blocks.list.data() + last);
    });
  });
}

template <class Real>
void SoftContacts<Real>::regather() {
  const auto regather_all = []<class Lane>(ContactBlock<Lane>* first, const ContactBlock<Lane>* last) {
    for (; first != last; ++first) Loops<Lane, Real>::regather(*first);
  };
  with_blocks(width_, blocks16_, blocks32_, [&](auto& blocks) {
    scheduler_->ranges(blocks.count, kBlocksPerTask, [&](int first, int last) {
      regather_all(blocks.list.data() + first, blocks.list.data() + last);
    });
  });
}

template class SoftContacts<float>;
template class SoftContacts<double>;

}  // namespace plumb
