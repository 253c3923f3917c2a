#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/driver/driver.h"
#include "engine/driver/snapshot.h"
#include "engine/precise/dynamics/flight.h"
#include "engine/precise/dynamics/motion.h"
#include "engine/precise/event_search/conservative_advancement.h"
#include "engine/precise/event_search/events.h"
#include "engine/precise/event_search/motion_bounds.h"
#include "engine/precise/events/contact_candidate.h"
#include "engine/precise/events/impacts.h"
#include "engine/precise/events/stops.h"
#include "engine/precise/integration/smooth.h"

namespace plumb::precise {

/// Contacts of `Precise`, and limits and motors of joints. Between events, persistent ones are constraints of
/// the equations of motion; each event determines them anew. `stop` locates the first event of the last step
/// and cuts the step there. `settle` resolves impacts, and finds the contact modes (push, stick, slip or
/// open) by a complementarity problem in the accelerations.
class Contacts {
 public:
  Contacts(const Scene& scene, const Parts& parts, const Flight& flight, EquationsOfMotion& equations,
           EventFreeIntegrator& smooth);

  /// Returns true if no shapes may touch, and joints have neither limits nor motors.
  bool empty() const { return finder_.outlines().empty() && stops_.empty(); }

  /// Throws `Error` (Run) that names both bodies if shapes overlap by more than `share` of the scene's
  /// length. For bodies placed from outside.
  void refuse_overlaps(double share);

  /// Handles the event at the time of the motion. Also call it after forces jump and after changes from
  /// outside.
  void settle();
  bool settled() const { return settled_; }
  /// Determines the contact modes anew, for a reason that is not an event of the motion.
  void unsettle() {
    settled_ = false;
    record_.guard.reset();
    record_.met.reset();
  }

  /// Releases all contacts, limits and motors. Call it after bodies were changed from outside: closing joints
  /// would otherwise draw the bodies back to where they touched before.
  void let_go();

  /// Cuts the last step at its first event, after which `settle` is needed.
  void stop();

  /// A function of the state and of parameters that is zero where a step ended: the gap of a feature of two
  /// shapes or its rate, the gap of a limit, or a monitored quantity of a persistent contact.
  struct Guard {
    enum class Kind { Gap, Rate, Limit, Quantity };
    Kind kind = Kind::Gap;
    OutlinePair pair{};
    Feature feature{};
    std::uint64_t stop = 0;
    std::uint64_t patch = 0;
    int monitored = 0;  // `Quantity` of a contact
    int point = 0;
    bool operator==(const Guard&) const = default;
  };
  /// Record of the last `stop` and `settle`, for the code that follows the event with other states.
  struct Record {
    std::optional<Guard> guard;             ///< of the event at which the step ended
    std::optional<OutlinePair> met;         ///< shapes that met there; their features are among `touches`
    std::vector<ContactCandidate> touches;  ///< before the impacts
    bool impacts = false;                   ///< some touches were closing
    bool rests = false;                     ///< a Zeno cascade was brought to its limit
    bool paradox = false;                   ///< Painleve's paradox: an impulse other than that of an impact
    std::int64_t struck = 0;                ///< number of impacts that were resolved
  };
  const Record& record() const { return record_; }
  double near() const { return near_; }  ///< m: gaps below it count as touching
  bool holds(const OutlinePair& pair) const { return std::binary_search(held_.begin(), held_.end(), pair); }

  /// Copies the held contacts and stops, with their modes, from a run of another scene of the same structure;
  /// shapes and coefficients stay those of this scene. The functions below then follow the same events
  /// (contact_stop.cpp).
  void follow(const Contacts& other);
  /// Returns the value of a guard: m, m/s for a rate, or the unit of the monitored quantity.
  double guard_value(const Guard& guard, double time, std::span<const double> y);
  /// Returns the guards of held limits, forces and slips: where one is zero, a mode ends.
  std::vector<Guard> guards_of_modes() const;
  /// Resolves the impacts of `touches` at another state y: the same features, by this scene's coefficients.
  void impacts_at(double time, std::vector<ContactCandidate> touches, Compensated& y);

  /// Counts of the events so far.
  const std::array<EventCount, kContactEvents>& events() const { return events_; }
  std::int64_t impacts() const { return events_[static_cast<std::size_t>(ContactEvent::Impact)].count; }

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  /// Quantities of persistent contacts that are monitored for events.
  enum class Quantity { Force, Cone, Slip, Range, Height, Stop };
  struct Monitored {
    Quantity quantity{};
    std::size_t patch = 0;
    int point = 0;
    Feature feature{};  // of a height: the other corner
    std::size_t stop = 0;
  };
  struct Event {
    double time = 0;
    Quantity quantity{};
    std::optional<OutlinePair> meet;                      // shapes that come into contact
    std::optional<std::pair<std::size_t, Feature>> down;  // a held patch, and a corner that reaches its edge
    std::optional<std::size_t> limit;                     // of a joint, when reached
    Monitored monitored{};                                // if a monitored quantity changed sign
  };

  void look_at_states() { look_at_states(smooth_.time(), smooth_.state().value()); }
  void look_at_states(double time, std::span<const double> y);
  void note(const Event& event);
  void restore_record(SnapshotReader& in, std::span<const ActiveContact> patches);
  bool fits(const Guard& guard, std::span<const ActiveContact> patches) const;
  void count(ContactEvent event, double time, std::int64_t times = 1);

  // settle
  void find_grazes(std::vector<ContactCandidate>& touches);
  void resolve_impacts(std::vector<ContactCandidate>& touches);
  std::vector<std::array<double, 2>> pulls(std::span<const ContactCandidate> touches);
  bool is_held(const ContactCandidate& touch, int point) const;
  enum class Decision { Done, Again };
  Decision decide(std::vector<ContactCandidate>& touches);
  static bool start_sliding(std::span<const ContactCandidate> touches, TouchProblem& problem,
                            const CoulombSolution& solution);
  CoulombSolution solve(CoulombProblem& problem, std::span<const Brake> brakes);
  void activate(std::span<const ContactCandidate> touches, const TouchProblem& problem,
                const CoulombSolution& solution);
  void act_on_stops(std::span<const ContactCandidate> touches, std::span<const Brake> brakes,
                    const TouchProblem& problem, const CoulombSolution& solution);
  bool resolve_zeno_contacts(std::vector<ContactCandidate>& touches);
  std::vector<Twist<double>> accelerations();

  // stop
  std::optional<Event> first_toi_event(double until);
  std::optional<Event> first_change(double until);
  int samples_until(double until) const;
  void list_monitored();
  void evaluate(double time, std::span<double> values);
  void refine(const Event& event);
  void refine_limit(std::size_t limit);
  void watch_contacts();
  template <class Placed>
  double contact_value(const Monitored& monitored, const ContactForces& forces, std::size_t first,
                       const Placed& placed) const;

  const Flight& flight_;
  EquationsOfMotion& equations_;
  EventFreeIntegrator& smooth_;
  TouchFinder finder_;
  ImpactLaw law_;
  Stops stops_;
  StepMotionBounds paths_;
  ConservativeAdvancement search_;
  std::vector<BodyState> states_;  // by body, at the motion's time
  double near_ = 0;                // m: gaps below it count as touching
  double fastest_force_ = 0;       // rad/s, the largest of time-periodic forces
  bool settled_ = false;

  std::vector<OutlinePair> held_;      // the pairs of equations_.held(), in the same order
  std::vector<OutlinePair> touching_;  // touching but not held; ascending
  std::vector<OutlinePair> passing_;   // touching where a chain does not push; ascending
  std::vector<Monitored> monitored_;
  std::vector<double> tolerance_;
  double force_scale_ = 0;
  Compensated sample_;
  std::vector<double> rate_, stop_values_;

  Record record_;
  std::array<EventCount, kContactEvents> events_{};
  double last_event_ = -1;
  int events_at_once_ = 0;
};

}  // namespace plumb::precise
