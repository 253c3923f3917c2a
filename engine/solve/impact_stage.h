#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/solve/contact_solver.h"
#include "engine/solve/impact.h"
#include "engine/solve/joint_method.h"

namespace plumb {

/// Places the impacts of a substep in time, one after another in the order in which they happen, and resolves
/// each at its own instant: pairs that touch hit each other in turn.
///
/// A jump dv at time t moves a body's end of the substep by dv (h - t). That is also what the jump gives when
/// the body had been at x - dv t from the start: so each impact changes v by dv and x by -dv t, and what
/// comes after, in this substep or in its later stages, needs to know no more.
template <class Real>
class ImpactStage {
 public:
  /// The contacts by body, rebuilt when contacts change.
  void index(const std::vector<Contact<Real>>& contacts, std::size_t bodies);

  /// Before the first substep of a step.
  void begin_step(const std::vector<Contact<Real>>& contacts);

  /// `found(body, t)` is called for each body whose motion changed at `t`; it may append contacts, and then
  /// returns true. Returns how many impacts there were.
  int resolve(std::vector<Contact<Real>>& contacts, std::span<const SolidShape<Real>> shapes,
              Bodies<Real>& bodies, const ContactSolver<Real>& solver, JointMethod<Real>* joints, Real h,
              const std::function<bool(int, Real)>& found);

 private:
  struct Event {
    Real time = 0;
    int contact = 0;
    std::uint32_t version = 0;
  };

  // How many impacts there may be, and how many of them at the time of the one before.
  struct Allowance {
    std::int64_t impacts = 0, at_once = 0;
  };
  static Allowance allowance_of(const std::vector<Contact<Real>>& contacts);

  struct Call;  // what one call of `resolve` works on

  void predict(Call& call, int index, Real from);
  bool strike(Call& call, int index, Real t);
  bool passes_on(const Call& call, const Contact<Real>& contact) const;
  Impact<Real> pose(Call& call, const Contact<Real>& contact, Real t,
                    const ContactPoint<Real>* (&touching)[2]);
  void jump_by(const Contact<Real>& contact, const ContactPoint<Real>& point, Vec2<Real> impulse);
  void clear_jump(const Call& call, const Contact<Real>& contact);
  void shift(Bodies<Real>& bodies, int body, Real t) const;

  Allowance allowance_;                  // left of the step
  std::vector<Event> events_;            // a heap: the earliest first
  std::vector<std::uint32_t> version_;   // by contact: events of an older version are void
  std::vector<int> first_, contact_of_;  // contacts of body i: contact_of_[first_[i] .. first_[i + 1])
  std::vector<Twist<Real>> jump_;        // by body
  std::vector<int> struck_;              // bodies that the present impact moves
};

}  // namespace plumb
