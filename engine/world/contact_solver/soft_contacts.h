#pragma once

#include <algorithm>
#include <vector>

#include "engine/core/loop_scheduler.h"
#include "engine/math/vector_width.h"
#include "engine/world/contact_solver/contact_block.h"
#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/contact_step.h"

namespace plumb {

/// Runs the passes over all contacts of a world, in the order of the constraint graph's colours. Within a
/// colour several contacts are solved in SIMD lanes, with the same bits as one after the other.
template <class Real>
class SoftContacts {
 public:
  /// Prepares the passes of a step: gathers contacts into blocks. Contacts that other code reads or changes
  /// before `finish` stay single: those that are rigid or marked in `excluded` (by record). Those with
  /// restitution may be read and changed between `scatter_restitution` and `gather_restitution`. `scheduler`
  /// shares the passes among threads, colour by colour.
  void prepare(ContactGraph<Real>& graph, const SolverBody<Real>* motion, const std::vector<char>& excluded,
               LoopScheduler& scheduler);

  /// Warm starting: applies the impulses of the last substep.
  void warm_start(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Solves normal impulses with a bias that removes overlaps softly and lets gaps close. This corrects
  /// positions.
  void solve(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Relaxation: solves normal impulses without bias, friction and rolling resistance. This corrects
  /// velocities.
  void relax(SolverBody<Real>* motion, const ContactStep<Real>& step);

  /// Writes back separations and impulses of the blocks that have contacts with restitution.
  void scatter_restitution();

  /// Reads these blocks again, which may have changed since `scatter_restitution`.
  void gather_restitution();

  /// Writes the impulses back to the contacts.
  void finish();

  /// Reads the impulses again, which may have changed since `finish`.
  void regather();

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
  struct ColourEnd {
    int blocks = 0, singles = 0;
    bool has_colour = true;  ///< false: its contacts share bodies, and are solved in order
  };

  /// Contacts of a colour that one thread sorts into blocks.
  struct Segment {
    ContactConstraint<Real>* first = nullptr;
    int count = 0;
    bool has_colour = true, ends_colour = true;
    ColourEnd start{};  ///< indices of its first block and of its first single contact
  };

  static constexpr int kKinds = 28;       ///< of contacts that share a block
  static constexpr int kSingle = kKinds;  ///< stands for single contacts
  static constexpr int kSegment = 1024;   ///< contacts; the last block of each kind may be partly filled

  /// Returns the kind of a contact.
  static int kind_of(const ContactConstraint<Real>& c, const SolverBody<Real>* motion,
                     const std::vector<char>& excluded);
  /// Sorts the contacts of a segment into blocks of one kind each, and single contacts.
  template <int kBytes, class AddBlock, class AddSingle>
  static void sort(const Segment& segment, const SolverBody<Real>* motion, const std::vector<char>& excluded,
                   const AddBlock& add_block, const AddSingle& add_single);
  /// Fills the blocks. Returns false if all contacts are single.
  template <int kBytes>
  bool gather(Blocks<kBytes>& blocks, const SolverBody<Real>* motion, const std::vector<char>& excluded);
  template <int kBytes, class Fill>
  void gather_shared(Blocks<kBytes>& blocks, const SolverBody<Real>* motion,
                     const std::vector<char>& excluded, const Fill& fill);
  template <class Pass, int kBytes>
  void run_colour(Blocks<kBytes>& blocks, ColourEnd from, ColourEnd to, SolverBody<Real>* motion,
                  const ContactStep<Real>& step);
  /// Does the same, on all threads if there is enough work.
  template <class Pass, int kBytes>
  void run_colour_shared(Blocks<kBytes>& blocks, ColourEnd from, ColourEnd to, SolverBody<Real>* motion,
                         const ContactStep<Real>& step);
  template <int kBytes>
  void scatter_restitution(Blocks<kBytes>& blocks);
  template <int kBytes>
  void gather_restitution(Blocks<kBytes>& blocks);
  template <class Pass>
  void run_pass(SolverBody<Real>* motion, const ContactStep<Real>& step);

  ContactGraph<Real>* graph_ = nullptr;
  LoopScheduler* scheduler_ = nullptr;
  VectorWidth width_ = VectorWidth::None;  ///< None: no blocks, all contacts are single
  std::vector<ColourEnd> colour_ends_;
  std::vector<Segment> segments_;
  std::vector<ContactConstraint<Real>*> singles_;
  Blocks<16> blocks16_;
  Blocks<32> blocks32_;
};

}  // namespace plumb
