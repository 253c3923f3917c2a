#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/realtime/contact_solver.h"
#include "engine/realtime/impact.h"
#include "engine/realtime/joint_method.h"

namespace plumb {

/// Finds the impacts of a substep in the order of their times, and resolves each at its own time. Bodies in
/// contact pass impacts on in turn.
///
/// A jump dv at time t displaces the body by dv (h - t) at the end of the substep. So does dv from the start
/// of the substep, if the start position is x - dv t. Hence each impact changes v by dv and x by -dv t, and
/// later stages need no other data.
template <class Real>
class ImpactStage {
 public:
  /// Rebuilds the lists of contacts by body, after contacts changed.
  void index(const std::vector<Contact<Real>>& contacts, std::size_t bodies);

  /// Called before the first substep of a step.
  void begin_step(const std::vector<Contact<Real>>& contacts);

  /// Calls `found(body, t)` for each body whose motion changed at `t`; it may append contacts, and then
  /// returns true. Returns the number of impacts.
  int resolve(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
              Bodies<Real>& bodies, const ContactSolver<Real>& solver, JointMethod<Real>* joints, Real h,
              const std::function<bool(int, Real)>& found);

 private:
  struct Event {
    Real time = 0;
    int contact = 0;
    std::uint32_t version = 0;
  };

  // Maximum number of impacts, and of impacts at the time of the previous one.
  struct Allowance {
    std::int64_t impacts = 0, at_once = 0;
  };
  static Allowance allowance_of(const std::vector<Contact<Real>>& contacts);

  struct Call;  // data of one call of `resolve`

  void predict(Call& call, int index, Real from);
  bool strike(Call& call, int index, Real t);
  bool passes_on(const Call& call, const Contact<Real>& contact) const;
  Impact<Real> pose(Call& call, const Contact<Real>& contact, Real t,
                    const ContactPoint<Real>* (&touching)[2]);
  void jump_by(const Contact<Real>& contact, const ContactPoint<Real>& point, Vec2<Real> impulse);
  void clear_jump(const Call& call, const Contact<Real>& contact);
  void shift(Bodies<Real>& bodies, int body, Real t) const;

  Allowance allowance_;                  // remaining in the step
  std::vector<Event> events_;            // a heap, earliest first
  std::vector<std::uint32_t> version_;   // by contact: events of an older version are stale
  std::vector<int> first_, contact_of_;  // contacts of body i: contact_of_[first_[i] .. first_[i + 1])
  std::vector<Twist<Real>> jump_;        // by body
  std::vector<int> struck_;              // bodies that the present impact moves
};

}  // namespace plumb
