#pragma once

#include <algorithm>
#include <vector>

#include "engine/core/crew.h"
#include "engine/math/vector_width.h"
#include "engine/world/contact_solver/contact_block.h"
#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/contact_step.h"

namespace plumb {

/// The passes over all contacts of a world, in the order of the constraint graph's colours. Within a colour
/// several contacts are solved in SIMD lanes, with the same bits as one after the other.
template <class Real>
class SoftContacts {
 public:
  /// Prepares the passes of a step: gathers contacts into blocks. Contacts that other code reads or changes
  /// before `finish` stay single: rigid, or marked in `apart` (by record). Those with restitution may be read
  /// and changed between `show_bounces` and `take_bounces`. `crew` shares the passes, colour by colour.
  void begin(ContactGraph<Real>& graph, const SolverBody<Real>* motion, const std::vector<char>& apart,
             Crew& crew);

  /// Warm starting: applies the impulses of the last substep.
  void warm_start(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Solves normal impulses with a bias that removes overlaps softly and lets gaps close. This corrects
  /// positions.
  void solve(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Relaxation: solves normal impulses without bias, friction and rolling resistance. This corrects
  /// velocities.
  void relax(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Writes back separations and impulses of the blocks that have contacts with restitution.
  void show_bounces();

  /// Reads these blocks again, which may have changed since `show_bounces`.
  void take_bounces();

  /// Writes the impulses back to the contacts.
  void finish();

 private:
  /// Numbers of lanes, in one or two registers: at least four, because records are moved by four numbers.
  template <int kBytes>
  using Number = Lanes<Real, std::max(4, static_cast<int>(kBytes / sizeof(Real))), kBytes>;
  template <int kBytes>
  using Block = ContactBlock<Number<kBytes>>;

  /// Blocks in reused memory.
  template <int kBytes>
  struct Blocks {
    std::vector<Block<kBytes>> list;
    int count = 0;
  };

  /// End of a colour's blocks and of its single contacts; they begin at the end of the previous colour's.
  struct Run {
    int blocks = 0, alone = 0;
    bool has_colour = true;  ///< false: its contacts share bodies, and are solved in order
  };

  /// Contacts of a colour that one thread sorts into blocks.
  struct Segment {
    ContactConstraint<Real>* first = nullptr;
    int count = 0;
    bool has_colour = true, ends_colour = true;
    Run place{};  ///< indices of its first block and of its first single contact
  };

  static constexpr int kKinds = 16;      ///< of contacts that share a block
  static constexpr int kAlone = kKinds;  ///< stands for single contacts
  static constexpr int kSegment = 1024;  ///< contacts; the last block of each kind may be partly filled

  /// Returns the kind of a contact.
  static int kind_of(const ContactConstraint<Real>& c, const SolverBody<Real>* motion,
                     const std::vector<char>& apart);
  /// Sorts the contacts of a segment into blocks of one kind each, and those that stay alone.
  template <int kBytes, class AddBlock, class AddAlone>
  static void sort(const Segment& segment, const SolverBody<Real>* motion, const std::vector<char>& apart,
                   const AddBlock& add_block, const AddAlone& add_alone);
  /// Fills the blocks. Returns false if all contacts are alone.
  template <int kBytes>
  bool gather(Blocks<kBytes>& blocks, const SolverBody<Real>* motion, const std::vector<char>& apart);
  template <int kBytes, class Fill>
  void gather_shared(Blocks<kBytes>& blocks, const SolverBody<Real>* motion, const std::vector<char>& apart,
                     const Fill& fill);
  template <class Pass, int kBytes>
  void run_colour(Blocks<kBytes>& blocks, Run from, Run to, SolverBody<Real>* motion,
                  const ContactStep<Real>& step);
  /// Does the same, on all threads if it pays.
  template <class Pass, int kBytes>
  void share_colour(Blocks<kBytes>& blocks, Run from, Run to, SolverBody<Real>* motion,
                    const ContactStep<Real>& step);
  template <int kBytes>
  void show_bounces(Blocks<kBytes>& blocks);
  template <int kBytes>
  void take_bounces(Blocks<kBytes>& blocks);
  template <class Pass>
  void sweep(SolverBody<Real>* motion, const ContactStep<Real>& step);

  ContactGraph<Real>* graph_ = nullptr;
  Crew* crew_ = nullptr;
  VectorWidth width_ = VectorWidth::None;  ///< None: no blocks, all contacts are alone
  std::vector<Run> runs_;
  std::vector<Segment> segments_;
  std::vector<ContactConstraint<Real>*> alone_;
  Blocks<16> blocks16_;
  Blocks<32> blocks32_;
};

}  // namespace plumb
