#pragma once

#include <algorithm>
#include <vector>

#include "engine/math/vector_width.h"
#include "engine/world/contact_solver/contact_block.h"
#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/contact_step.h"

namespace plumb {

/// The passes over all contacts of a world, in the order of the constraint graph's colours. Within a colour
/// several contacts are solved side by side, with the same bits as one after the other.
template <class Real>
class SoftContacts {
 public:
  /// Prepares the passes of a step: gathers contacts into blocks. Those that something else reads or changes
  /// until `finish` stay alone: with restitution, rigid, or marked in `apart` (by record).
  void begin(ContactGraph<Real>& graph, const BodyMotion<Real>* motion, const std::vector<char>& apart);

  /// Warm starts: applies the impulses of the last substep, which are nearly those needed now.
  void warm_start(BodyMotion<Real>* motion, const ContactStep<Real>& step);

  /// Solves normal impulses with a bias that removes overlaps softly and lets gaps close: corrects positions.
  void solve(BodyMotion<Real>* motion, const ContactStep<Real>& step);

  /// Solves normal impulses without bias, friction and rolling resistance: corrects velocities.
  void relax(BodyMotion<Real>* motion, const ContactStep<Real>& step);

  /// Writes the impulses back to the contacts.
  void finish();

 private:
  /// Numbers in a register, or in two: at least four, as the records have that are moved there.
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

  /// A colour's blocks and its contacts that are alone: where they end. They begin where the last colour's
  /// end.
  struct Run {
    int blocks = 0, alone = 0;
  };

  /// Fills the blocks. Returns false if all contacts are alone.
  template <int kBytes>
  bool gather(Blocks<kBytes>& blocks, const BodyMotion<Real>* motion, const std::vector<char>& apart);
  template <class Pass, int kBytes>
  void run_colour(Blocks<kBytes>& blocks, Run from, Run to, BodyMotion<Real>* motion,
                  const ContactStep<Real>& step);
  template <class Pass>
  void sweep(BodyMotion<Real>* motion, const ContactStep<Real>& step);

  ContactGraph<Real>* graph_ = nullptr;
  VectorWidth width_ = VectorWidth::None;  ///< None: no blocks, all contacts are alone
  std::vector<Run> runs_;
  std::vector<ContactConstraint<Real>*> alone_;
  Blocks<16> blocks16_;
  Blocks<32> blocks32_;
};

}  // namespace plumb
