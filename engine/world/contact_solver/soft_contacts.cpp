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
// A narrow register holds only two doubles, which saves little.
template <class Real>
constexpr std::size_t least_contacts(VectorWidth width) {
  return sizeof(Real) == 8 && width == VectorWidth::Bytes16 ? 64 : 16;
}

// Minimum number of contacts in a block: a single one costs less alone.
constexpr int kLeastLanes = 2;

// Number of blocks, and of single contacts, in a thread's task: 1 to 2 us of work. Joining a loop, or waiting
// for the last thread, takes about 0.3 us. So a colour that fits into one task is solved by one thread.
constexpr int kBlocksOfTask = 16, kAloneOfTask = 48;

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
  static constexpr bool kMoves = true;  ///< reads the bodies' displacements
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

// Non-dynamic bodies are only read: several contacts of a colour may share one.
template <class Pass, class Axes, class Real>
[[gnu::always_inline]] inline void run_alone(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                             const ContactStep<Real>& step, Axes free) {
  Pair<Real, SolverBody<Real>&, Axes> pair{motion[c.body_a], motion[c.body_b], c.normal, free};
  Pass::template run<Real>(pair, c, step);
  const bool both = c.hardness == ContactHardness::Soft;
  if (both || is_dynamic(pair.a)) pair.a.velocity = pair.va, pair.a.angular_velocity = pair.wa;
  if (both || is_dynamic(pair.b)) pair.b.velocity = pair.vb, pair.b.angular_velocity = pair.wb;
}

template <class Pass, class Real>
[[gnu::noinline]] void run_locked(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                  const ContactStep<Real>& step) {
  run_alone<Pass>(motion, c, step, FreeAxes{c.locks});
}

template <class Pass, class Real>
[[gnu::always_inline]] inline void run_alone(SolverBody<Real>* motion, ContactConstraint<Real>& c,
                                             const ContactStep<Real>& step) {
  if (c.locks != 0) [[unlikely]]
    return run_locked<Pass>(motion, c, step);
  run_alone<Pass>(motion, c, step, AllAxes{});
}

template <class Pass, class Number, class Real>
[[gnu::always_inline]] inline void run_blocks(SolverBody<Real>* motion, ContactBlock<Number>* block,
                                              const ContactBlock<Number>* end,
                                              const ContactStep<Real>& settings) {
  const ContactStep<Real> step = settings;  // a local copy: no pointer can change it
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
  static void gather(Block& block, const SolverBody<Real>* motion) { plumb::gather(block, motion); }
  static void gather_again(Block& block) { plumb::gather_again(block); }
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
  PLUMB_AVX2 static void gather_again(Block& block) { plumb::gather_again(block); }
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
                                                              const std::vector<char>& apart) {
  const bool stopped_rolling = !rolls(c) && c.rolling_impulse != 0;
  const bool stays_alone = c.hardness == ContactHardness::Rigid || stopped_rolling || c.locks != 0 ||
                           (!apart.empty() && apart[c.contact]);
  if (stays_alone) return kAlone;
  const int kind = (c.count == 2) + 2 * rolls(c);
  if (c.hardness == ContactHardness::Soft) return kind;
  return kind + (is_dynamic(motion[c.body_a]) ? 4 : is_dynamic(motion[c.body_b]) ? 8 : 12);
}

// Calls `add_block(contacts, count)` and `add_alone(contact)`.
template <class Real>
template <int kBytes, class AddBlock, class AddAlone>
[[gnu::always_inline]] inline void SoftContacts<Real>::sort(const Segment& segment,
                                                            const SolverBody<Real>* motion,
                                                            const std::vector<char>& apart,
                                                            const AddBlock& add_block,
                                                            const AddAlone& add_alone) {
  constexpr int kLanes = Block<kBytes>::kLanes;
  // Contacts of one kind: they may share a block.
  ContactConstraint<Real>* waiting[kKinds][kLanes];
  int counts[kKinds] = {};
  for (int i = 0; i < segment.count; ++i) {
    ContactConstraint<Real>& c = segment.first[i];
    const int kind = segment.has_colour ? kind_of(c, motion, apart) : kAlone;
    if (kind == kAlone) {
      add_alone(&c);
      continue;
    }
    waiting[kind][counts[kind]++] = &c;
    if (counts[kind] == kLanes) add_block(waiting[kind], kLanes), counts[kind] = 0;
  }
  for (int kind = 0; kind < kKinds; ++kind) {
    if (counts[kind] >= kLeastLanes) {
      add_block(waiting[kind], counts[kind]);
    } else {
      for (int i = 0; i < counts[kind]; ++i) add_alone(waiting[kind][i]);
    }
  }
}

template <class Real>
template <int kBytes>
bool SoftContacts<Real>::gather(Blocks<kBytes>& blocks, const SolverBody<Real>* motion,
                                const std::vector<char>& apart) {
  using Constraint = ContactConstraint<Real>;
  constexpr int kLanes = Block<kBytes>::kLanes;
  blocks.count = 0, alone_.clear(), runs_.clear();
  runs_.reserve(ContactGraph<Real>::kColours + 1);
  ensure_capacity(alone_, graph_->size());
  const auto fill = [&](Block<kBytes>& block, Constraint* const* contacts, int count) {
    for (int i = 0; i < kLanes; ++i) block.contact[i] = contacts[std::min(i, count - 1)];
    Loops<Number<kBytes>, Real>::gather(block, motion);
  };
  if (crew_->shares()) {
    gather_shared(blocks, motion, apart, fill);
  } else {
    graph_->for_each_colour([&](std::vector<Constraint>& colour, bool has_colour) {
      const Segment whole{colour.data(), static_cast<int>(colour.size()), has_colour};
      sort<kBytes>(
          whole, motion, apart,
          [&](Constraint* const* contacts, int count) {
            if (blocks.count == static_cast<int>(blocks.list.size())) {
              ensure_capacity(blocks.list, blocks.list.size() + 1);
              blocks.list.emplace_back();
            }
            fill(blocks.list[blocks.count++], contacts, count);
          },
          [&](Constraint* c) { alone_.push_back(c); });
      runs_.push_back({blocks.count, static_cast<int>(alone_.size()), has_colour});
    });
  }
  return blocks.count > 0;
}

// Counts the blocks and single contacts of the segments of all colours, then fills each at its index.
template <class Real>
template <int kBytes, class Fill>
void SoftContacts<Real>::gather_shared(Blocks<kBytes>& blocks, const SolverBody<Real>* motion,
                                       const std::vector<char>& apart, const Fill& fill) {
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
  crew_->blocks(count, [&](int i) {
    Segment& segment = segments_[i];
    int of_kind[kKinds + 1] = {};
    for (int k = 0; k < segment.count; ++k)
      ++of_kind[segment.has_colour ? kind_of(segment.first[k], motion, apart) : kAlone];
    segment.place = {0, of_kind[kAlone]};
    for (int kind = 0; kind < kKinds; ++kind) {
      const int rest = of_kind[kind] % Block<kBytes>::kLanes, full = of_kind[kind] / Block<kBytes>::kLanes;
      segment.place.blocks += full + (rest >= kLeastLanes ? 1 : 0);
      segment.place.alone += rest >= kLeastLanes ? 0 : rest;
    }
  });
  Run next;
  for (Segment& segment : segments_) {
    const Run size = segment.place;
    segment.place = next;
    next.blocks += size.blocks, next.alone += size.alone;
    if (segment.ends_colour) runs_.push_back({next.blocks, next.alone, segment.has_colour});
  }
  blocks.count = next.blocks;
  ensure_capacity(blocks.list, static_cast<std::size_t>(next.blocks));
  if (static_cast<int>(blocks.list.size()) < next.blocks) blocks.list.resize(next.blocks);
  alone_.resize(next.alone);
  crew_->blocks(count, [&](int i) {
    Run at = segments_[i].place;
    sort<kBytes>(
        segments_[i], motion, apart,
        [&](Constraint* const* contacts, int lanes) { fill(blocks.list[at.blocks++], contacts, lanes); },
        [&](Constraint* c) { alone_[at.alone++] = c; });
  });
}

template <class Real>
void SoftContacts<Real>::begin(ContactGraph<Real>& graph, const SolverBody<Real>* motion,
                               const std::vector<char>& apart, Crew& crew) {
  graph_ = &graph, crew_ = &crew;
  width_ = graph.empty() ? VectorWidth::None : vector_width();
  if (width_ != VectorWidth::None && graph.size() < least_contacts<Real>(width_)) width_ = VectorWidth::None;
  with_blocks(width_, blocks16_, blocks32_, [&](auto& blocks) {
    if (!gather(blocks, motion, apart)) width_ = VectorWidth::None;
  });
}

template <class Real>
template <class Pass, int kBytes>
[[gnu::always_inline]] inline void SoftContacts<Real>::run_colour(Blocks<kBytes>& blocks, Run from, Run to,
                                                                  SolverBody<Real>* motion,
                                                                  const ContactStep<Real>& step) {
  Block<kBytes>* const list = blocks.list.data();
  if (from.blocks < to.blocks)
    Loops<Number<kBytes>, Real>::template run<Pass>(motion, list + from.blocks, list + to.blocks, step);
  for (int i = from.alone; i < to.alone; ++i) run_alone<Pass>(motion, *alone_[i], step);
}

template <class Real>
template <class Pass, int kBytes>
[[gnu::noinline]] void SoftContacts<Real>::share_colour(Blocks<kBytes>& blocks, Run from, Run to,
                                                        SolverBody<Real>* motion,
                                                        const ContactStep<Real>& step) {
  const int of_blocks = (to.blocks - from.blocks + kBlocksOfTask - 1) / kBlocksOfTask,
            of_alone = (to.alone - from.alone + kAloneOfTask - 1) / kAloneOfTask;
  if (!to.has_colour || of_blocks + of_alone < 2) return run_colour<Pass>(blocks, from, to, motion, step);
  crew_->blocks(of_blocks + of_alone, [&](int task) {
    Run first = from, last = from;
    if (task < of_blocks) {
      first.blocks += task * kBlocksOfTask;
      last.blocks = std::min(first.blocks + kBlocksOfTask, to.blocks);
    } else {
      first.alone += (task - of_blocks) * kAloneOfTask;
      last.alone = std::min(first.alone + kAloneOfTask, to.alone);
    }
    run_colour<Pass>(blocks, first, last, motion, step);
  });
}

template <class Real>
template <class Pass>
[[gnu::noinline]] void SoftContacts<Real>::sweep(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (width_ == VectorWidth::None) {
    graph_->for_each_colour([&](std::vector<ContactConstraint<Real>>& colour, bool has_colour) {
      const int count = static_cast<int>(colour.size());
      crew_->ranges(count, has_colour ? kAloneOfTask : count, [&](int first, int last) {
        for (int i = first; i < last; ++i) run_alone<Pass>(motion, colour[i], step);
      });
    });
    return;
  }
  const bool shares = crew_->shares();
  with_blocks(
      width_, blocks16_, blocks32_, [&](auto& blocks) __attribute__((always_inline)) {
        Run done;
        for (const Run& to : runs_) {
          if (shares) {
            share_colour<Pass>(blocks, done, to, motion, step);
          } else {
            run_colour<Pass>(blocks, done, to, motion, step);
          }
          done = to;
        }
      });
}

template <class Real>
void SoftContacts<Real>::warm_start(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<WarmStart>(motion, step);
}

template <class Real>
void SoftContacts<Real>::solve(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<Solve>(motion, step);
}

template <class Real>
void SoftContacts<Real>::relax(SolverBody<Real>* motion, const ContactStep<Real>& step) {
  if (!graph_->empty()) sweep<Relax>(motion, step);
}

template <class Real>
template <int kBytes>
void SoftContacts<Real>::show_bounces(Blocks<kBytes>& blocks) {
  crew_->ranges(blocks.count, kBlocksOfTask, [&](int first, int last) {
    for (Block<kBytes>* block = blocks.list.data() + first; block != blocks.list.data() + last; ++block)
      if (block->bounces) Loops<Number<kBytes>, Real>::scatter(block, block + 1);
  });
}

template <class Real>
void SoftContacts<Real>::show_bounces() {
  with_blocks(width_, blocks16_, blocks32_, [this](auto& blocks) { this->show_bounces(blocks); });
}

template <class Real>
template <int kBytes>
void SoftContacts<Real>::take_bounces(Blocks<kBytes>& blocks) {
  crew_->ranges(blocks.count, kBlocksOfTask, [&](int first, int last) {
    for (Block<kBytes>* block = blocks.list.data() + first; block != blocks.list.data() + last; ++block)
      if (block->bounces) Loops<Number<kBytes>, Real>::gather_again(*block);
  });
}

template <class Real>
void SoftContacts<Real>::take_bounces() {
  with_blocks(width_, blocks16_, blocks32_, [this](auto& blocks) { this->take_bounces(blocks); });
}

template <class Real>
void SoftContacts<Real>::finish() {
  const auto scatter = []<class Lane>(ContactBlock<Lane>* first, const ContactBlock<Lane>* last) {
    Loops<Lane, Real>::scatter(first, last);
  };
  with_blocks(width_, blocks16_, blocks32_, [&](auto& blocks) {
    crew_->ranges(blocks.count, kBlocksOfTask, [&](int first, int last) {
      scatter(blocks.list.data() + first, blocks.list.data() + last);
    });
  });
}

template class SoftContacts<float>;
template class SoftContacts<double>;

}  // namespace plumb
