#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/course/student/edit.h"
#include "harness/course/student/student.h"
#include "reference/backend.h"

namespace plumb::course {

/// The name of a mistake or a quantity. Names are compared by a hash, because each step compares many.
struct Name {
  std::uint64_t hash;

  consteval Name(const char* text) : hash(of(text)) {}  // NOLINT: for literals
  static constexpr std::uint64_t of(std::string_view text) {
    std::uint64_t out = 14695981039346656037u;
    for (const char c : text) out = (out ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return out;
  }
};

struct Rigid {
  Vec2d position, velocity, force;
  Vec2d before = velocity;  ///< velocity at the start of the step
  double angle = 0, spin = 0, torque = 0;
  double inverse_mass = 0, inverse_inertia = 0;
  double spin_before = 0;  ///< before the step's torques
  double turns = 1;        ///< factor on the rotation angle from the body's frame to the world's
  bool touched = false;    ///< had a contact in the last step
  double sum = 0;          ///< N s, of the contacts that share a sum by mistake
  const Body* body = nullptr;

  Rotation<double> rotation() const;
  Vec2d to_world(Vec2d local) const { return rotation() * local; }
  Vec2d velocity_at(Vec2d arm) const { return velocity + cross(spin, arm); }
};

struct Touch {
  std::size_t a = 0, b = 0;
  Vec2d point, normal;  ///< from a to b
  double depth = 0, bounce = 0, sum = 0, sum_across = 0;
  double last = 0;  ///< normal impulse of the last iteration
  int of_pair = 0;  ///< number among the contacts of its two bodies
};

/// Quantities of joints that are computed once and used again later: a mistake as text,
/// "stale:arms:when:rows".
struct Stale {
  enum Part : unsigned { kFirstArm = 1, kSecondArm = 2, kDirection = 4 };
  enum When { kNever, kFirstStep, kStepBefore };
  unsigned parts = 0, rows = 0;
  When when = kNever;
};

/// The learner's world, and the mistakes in it.
class StudentWorld {
 public:
  /// `mistake` is one of: a name; a quantity and the factor by which it is wrong ("radius*0.5"); a vector and
  /// what replaces its x and y ("drag@x,x", "drag@y,-x", "drag@0,y", "drag@|x|,y"); points and how they are
  /// rotated ("a
  /// force's point~backwards"); a law and what its force changes ("drag>position by dt"); a quantity and the
  /// body whose quantity stands for that of all ("mass in F/m#the first"); an edit as text (edit.h). Made in
  /// one component only, a mistake ends with " in x only" or " in y only". `scheme` is semi-implicit Euler,
  /// explicit Euler or velocity Verlet.
  StudentWorld(const Scene& scene, double dt, std::string mistake,
               reference::Scheme scheme = reference::Scheme::SemiImplicitEuler, const Manner& manner = {});

  void step();
  double time() const { return static_cast<double>(steps_) * dt_; }
  std::vector<BodyState> states() const;

 private:
  bool is(Name mistake) const { return mistake.hash == mistake_hash_; }
  void advance();
  void take_step();
  int sweeps() const;
  void write_sweep_state(const std::vector<Touch>& found, std::vector<double>& out) const;
  void answer_touches(bool with_joints);
  void answer_joints();
  void move_and_project(bool moves);
  void correct_all(int sweeps);
  void close_joints();
  bool holds(const Joint& joint) const;
  std::vector<BodyState> truly() const;  ///< the current states, even if the engine reports others
  bool scales(Name quantity) const { return quantity.hash == scaled_hash_; }
  double times(Name quantity) const { return scales(quantity) ? factor_ : 1; }
  Vec2d mixed(Name quantity, Vec2d v) const;  ///< the vector with x and y replaced as in the mistake
  void read_mistake(const std::string& mistake);
  Vec2d turned(Name what, const Rigid& body, Vec2d local) const;
  std::array<Vec2d, 4> corner_signs() const;
  Name part_of_box(const Rigid& body, Name part) const;
  Vec2d side(const Rigid& body, Vec2d local) const;
  Vec2d corner(const Rigid& body, Vec2d local) const;
  void act(Name law, Rigid& body, Vec2d force);
  double shown(double angle) const;
  double radius(const Rigid& body) const;
  Box box(const Rigid& body) const;
  double inertia(const Body& body) const;
  const Rigid& another(Name quantity, const Rigid& body) const;
  double mass(const Body& body) const;
  void gather_forces();
  void apply(const ForceLaw& law, bool first, bool last);
  void accelerate();
  void move();
  std::vector<Touch> touches() const;
  template <class Touches>
  void each_pair(const Touches& touches) const;  ///< `touches(a, b)` returns true if the two touch
  void touch(std::size_t a, std::size_t b, std::vector<Touch>& out) const;
  void touch_circles(std::size_t a, std::size_t b, std::vector<Touch>& out) const;
  void touch_circle_box(std::size_t circle, std::size_t box, std::vector<Touch>& out) const;
  void touch_corners(std::size_t box, std::size_t corners, std::vector<Touch>& out) const;
  void touch_boxes(std::size_t a, std::size_t b, std::vector<Touch>& out) const;
  double apart_along(double along) const;
  double extent(const Rigid& body, Vec2d axis, bool in_overlap) const;
  struct Face {
    std::size_t box = 0;
    Vec2d normal;  ///< from a to b
    double overlap = 0;
    bool of_width = false;  ///< the axis is the box's own x
  };
  std::optional<Face> nearest_face(std::size_t a, std::size_t b) const;
  bool left_out(std::size_t a, std::size_t b) const;
  bool ends_the_loop(std::size_t a, std::size_t b) const;
  bool bounds_apart(std::size_t a, std::size_t b) const;
  Vec2d bounds(const Rigid& body) const;
  double restitution(const Touch& touch) const;
  Vec2d relative_velocity(const Touch& touch) const;
  void prepare(Touch& touch) const;
  bool answer_wrongly(Touch& touch, double closing);
  double& sum_of(Touch& touch);
  void answer(Touch& touch);
  void rub(Touch& touch);
  void answer_all(std::vector<Touch>& found);
  void start_with_last_sums(std::vector<Touch>& found);
  void push_out();
  void push_out(const std::vector<Touch>& found);
  void solve(const Joint& joint);
  void correct(const Joint& joint);
  void correct_along(const Joint& joint, Vec2d axis);
  struct Arms {
    Vec2d a, b;
  };
  Arms arms_of(const Touch& touch) const;
  double speed_apart(Row row, const Rigid& a, const Rigid& b, Arms arms, Arms raw, Vec2d n) const;
  double edited_mass(Row row, const Rigid& a, const Rigid& b, Arms arms, Arms raw, Vec2d n) const;
  struct Eases {
    std::array<double, 2> mass, inertia;  ///< inverse, of both bodies
  };
  struct Moving {
    std::array<Vec2d, 2> velocity;
    std::array<double, 2> spin;
  };
  Moving moving(Row row, const Rigid& a, const Rigid& b) const;
  Eases eases(Row row, Place place, const Rigid& a, const Rigid& b) const;
  void change(Row row, Rigid& a, Rigid& b, Arms arms, Arms raw, Vec2d impulse);
  void apply_impulse(std::size_t a, std::size_t b, Vec2d arm_a, Vec2d arm_b, Vec2d impulse);

  struct Ends {
    std::size_t a, b;
    Vec2d arm_a, arm_b, gap;
    Vec2d raw_a, raw_b;  ///< the anchors before they are rotated
  };
  Ends ends(const Joint& joint, Row row) const;
  bool joined(std::size_t a, std::size_t b) const;
  void keep_arms();
  void keep_held();
  struct Held {
    Vec2d arm_a, arm_b, along;
  };
  Held held(const Joint& joint, Row row, const Held& now) const;
  bool opens(const Touch& touch) const;

  Scene scene_;
  double dt_;
  std::string mistake_;
  std::uint64_t mistake_hash_ = 0, scaled_hash_ = 0, mixed_hash_ = 0;
  double factor_ = 1;
  Edit edit_;
  std::uint64_t turned_hash_ = 0, turned_how_ = 0;    ///< quantity whose points are rotated wrongly, and how
  std::uint64_t acting_hash_ = 0, acting_how_ = 0;    ///< which law acts wrongly, and on what
  std::uint64_t others_hash_ = 0, others_whose_ = 0;  ///< quantity of another body, and of which one
  std::array<Vec2d, 2> axes_;            ///< directions that give the x and the y of a mixed vector
  std::array<int, 2> sign_of_{};         ///< 1 or -1 if the x or the y of a mixed vector always has this sign
  std::unique_ptr<StudentWorld> right_;  ///< makes no mistake; takes the other component of each step
  bool mistaken_in_x_ = false;
  reference::Scheme scheme_;
  Manner manner_;
  bool touched_ = false;  ///< there was a contact
  std::map<std::pair<std::size_t, std::size_t>, double> pair_sums_;
  std::vector<Touch> last_found_;  ///< the contacts of the last step with their sums, kept by mistake
  long steps_ = 0;
  std::vector<BodyState> before_step_;              ///< the states before the last step
  std::vector<Rigid> bodies_;                       ///< bodies of the scene, then the fixed world
  std::vector<std::pair<Vec2d, Vec2d>> kept_arms_;  ///< of each joint, before the bodies moved
  Stale stale_;
  std::vector<Held> held_, held_next_;            ///< of each joint, from earlier
  std::vector<std::array<std::size_t, 2>> ends_;  ///< indices of the two bodies of each joint
};

}  // namespace plumb::course
