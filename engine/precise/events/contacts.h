#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/driver/driver.h"
#include "engine/driver/snapshot.h"
#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/event_search/conservative_advancement.h"
#include "engine/precise/event_search/motion_bounds.h"
#include "engine/precise/event_search/zero_crossing.h"
#include "engine/precise/events/contact_candidate.h"
#include "engine/precise/events/impacts.h"
#include "engine/precise/events/limits_and_motors.h"
#include "engine/precise/integration/integrator.h"

namespace plumb::precise {

/// Contacts of `Precise`, and limits and motors of joints. Between events, persistent ones are constraints of
/// the equations of motion; each event determines them anew. `truncate_at_event` ends the last step at its
/// first event. `resolve_event` resolves impacts, and finds the contact modes (push, stick, slip or open) by
/// a complementarity problem in the accelerations.
class Contacts {
 public:
  Contacts(const Scene& scene, const ScenePartition& partition, const BallisticMotion& ballistic,
           EquationsOfMotion& equations, EventFreeIntegrator& integrator);

  /// Returns true if no shapes may touch, and joints have neither limits nor motors.
  bool empty() const { return finder_.shapes().empty() && limits_and_motors_.empty(); }

  /// Throws `Error` (Run) that names both bodies if shapes overlap by more than `share` of the scene's
  /// length. For bodies placed from outside.
  void check_overlaps(double share);

  /// Resolves the event at the end of the last step. Also call it after forces jump and after changes from
  /// outside.
  void resolve_event();
  bool is_resolved() const { return resolved_; }
  /// Determines the contact modes anew, for a reason that is not an event of the motion.
  void invalidate() {
    resolved_ = false;
    record_.guard.reset();
    record_.new_pair.reset();
  }

  /// Releases all contacts, limits and motors. Call it after bodies were changed from outside: closing joints
  /// would otherwise pull the bodies back to where they touched before.
  void release();

  /// Ends the last step at its first event, after which `resolve_event` is needed.
  void truncate_at_event();

  /// A function of the state and of parameters that is zero where a step ended: the gap of a feature of two
  /// shapes or its rate, the gap of a limit, or a monitored quantity of a persistent contact.
  struct Guard {
    enum class Kind { Gap, Rate, Limit, Quantity };
    Kind kind = Kind::Gap;
    ShapePair pair{};
    Feature feature{};
    std::uint64_t limit_motor = 0;
    std::uint64_t patch = 0;
    int monitored = 0;  // `Quantity` of a contact
    int point = 0;
    bool operator==(const Guard&) const = default;
  };
  /// Record of the last event, for the code that repeats it with other states.
  struct Record {
    std::optional<Guard> guard;  ///< of the event at which the step ended
    std::optional<ShapePair>
        new_pair;  ///< shapes that came into contact; their features are among `candidates`
    std::vector<ContactCandidate> candidates;  ///< before the impacts
    bool impacts = false;                      ///< some candidates approached
    bool zeno = false;                         ///< a Zeno cascade was brought to its limit
    bool paradox = false;           ///< Painleve's paradox: an impulse other than that of an impact
    std::int64_t impact_count = 0;  ///< number of impacts that were resolved
  };
  const Record& record() const { return record_; }
  double gap_tolerance() const { return gap_tolerance_; }  ///< m: gaps below it count as touching
  bool has_contact(const ShapePair& pair) const {
    return std::binary_search(held_.begin(), held_.end(), pair);
  }

  /// Copies the held contacts, limits and motors, with their modes, from a run of another scene of the same
  /// structure; shapes and coefficients stay those of this scene. The functions below then follow the same
  /// events (event_location.cpp).
  void copy_modes(const Contacts& other);
  /// Returns the value of a guard: m, m/s for a rate, or the unit of the monitored quantity.
  double guard_value(const Guard& guard, double time, std::span<const double> y);
  /// Returns the guards of held limits, forces and slips: where one is zero, a mode ends.
  std::vector<Guard> guards_of_modes() const;
  /// Resolves the impacts of `candidates` at another state y: the same features, by this scene's
  /// coefficients.
  void impacts_at(double time, std::vector<ContactCandidate> candidates, Compensated& y);

  /// Counts of the events so far.
  const std::array<EventCount, kContactEvents>& events() const { return events_; }
  std::int64_t impacts() const { return events_[static_cast<std::size_t>(ContactEvent::Impact)].count; }

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  /// Quantities of persistent contacts that are monitored for events.
  enum class Quantity { Force, Cone, Slip, Range, Height, LimitMotor };
  struct Monitored {
    Quantity quantity{};
    std::size_t patch = 0;
    int point = 0;
    Feature feature{};  // of a height: the other corner
    std::size_t limit_motor = 0;
  };
  struct Event {
    double time = 0;
    Quantity quantity{};
    std::optional<ShapePair> new_pair;  // shapes that come into contact
    std::optional<std::pair<std::size_t, Feature>>
        corner_contact;                // a held patch, and a corner that reaches its edge
    std::optional<std::size_t> limit;  // of a joint, when reached
    Monitored monitored{};             // if a monitored quantity changed sign
  };

  void update_states() { update_states(integrator_.time(), integrator_.state().value()); }
  void update_states(double time, std::span<const double> y);
  void record_cause(const Event& event);
  void restore_record(SnapshotReader& in, std::span<const ActiveContact> patches);
  bool is_valid(const Guard& guard, std::span<const ActiveContact> patches) const;
  void count(ContactEvent event, double time, std::int64_t times = 1);

  // Parts of `resolve_event`.
  void find_grazes(std::vector<ContactCandidate>& candidates);
  void resolve_impacts(std::vector<ContactCandidate>& candidates);
  std::vector<std::array<double, 2>> closing_accelerations(std::span<const ContactCandidate> candidates);
  bool is_held(const ContactCandidate& candidate, int point) const;
  enum class Decision { Done, Again };
  Decision solve_modes(std::vector<ContactCandidate>& candidates);
  static bool start_sliding(std::span<const ContactCandidate> candidates, ContactProblem& problem,
                            const CoulombSolution& solution);
  CoulombSolution solve(CoulombProblem& problem, std::span<const MotorAtSpeed> motors);
  void activate(std::span<const ContactCandidate> candidates, const ContactProblem& problem,
                const CoulombSolution& solution);
  void apply_limits_and_motors(std::span<const ContactCandidate> candidates,
                               std::span<const MotorAtSpeed> motors, const ContactProblem& problem,
                               const CoulombSolution& solution);
  bool resolve_zeno_contacts(std::vector<ContactCandidate>& candidates);
  std::vector<Twist<double>> accelerations();

  // Parts of `truncate_at_event`.
  std::optional<Event> first_toi_event(double until);
  std::optional<Event> first_mode_change(double until);
  int samples_until(double until) const;
  void list_monitored();
  void evaluate(double time, std::span<double> values);
  void refine(const Event& event);
  void refine_limit(std::size_t limit);
  void monitor_contacts();
  template <class MotionOf>
  double contact_value(const Monitored& monitored, const ContactForces& forces, std::size_t first,
                       const MotionOf& motion_of) const;

  const BallisticMotion& ballistic_;
  EquationsOfMotion& equations_;
  EventFreeIntegrator& integrator_;
  ContactFinder finder_;
  ImpactSolver impact_solver_;
  LimitsAndMotors limits_and_motors_;
  StepMotionBounds bounds_;
  ConservativeAdvancement search_;
  std::vector<BodyState> states_;  // by body, at the motion's time
  double gap_tolerance_ = 0;       // m: gaps below it count as touching
  double fastest_force_ = 0;       // rad/s, the largest of time-periodic forces
  bool resolved_ = false;

  std::vector<ShapePair> held_;      // the pairs of active_contacts(), in the same order
  std::vector<ShapePair> touching_;  // touching but not held; ascending
  std::vector<ShapePair> passing_;   // touching where a chain does not push; ascending
  std::vector<Monitored> monitored_;
  std::vector<double> tolerance_;
  double force_scale_ = 0;
  Compensated sample_;
  std::vector<double> rate_, limit_motor_values_;

  Record record_;
  std::array<EventCount, kContactEvents> events_{};
  double last_event_ = -1;
  int events_at_once_ = 0;
};

}  // namespace plumb::precise
