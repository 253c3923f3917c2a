#include "engine/world/snapshot_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/encoding/encoding.h"
#include "engine/world/snapshot/world_members.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

template <Packed T>
bool is_finite(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    return true;
  } else if constexpr (std::is_bounded_array_v<T>) {
    return std::all_of(std::begin(value), std::end(value), [](const auto& each) { return is_finite(each); });
  } else {
    return Members<T>::with(value, [](const auto&... each) { return (is_finite(each) && ...); });
  }
}

template <class T>
bool all_finite(const std::vector<T>& all) {
  return std::all_of(all.begin(), all.end(), [](const T& each) { return is_finite(each); });
}

bool is_in_range(double length) { return std::abs(length) <= kMaxPosition; }

template <class Real>
bool is_in_range(Vec2<Real> v) {
  return is_in_range(static_cast<double>(v.x)) && is_in_range(static_cast<double>(v.y));
}

template <class Real>
bool is_in_range(const Aabb<Real>& box) {
  return is_in_range(box.lower) && is_in_range(box.upper);
}

// Marks each number once: `mark` returns false for a number that is out of range or already marked.
class Marks {
 public:
  explicit Marks(int size) : marks_(static_cast<std::size_t>(size), 0) {}
  bool mark(int i) {
    if (i < 0 || i >= static_cast<int>(marks_.size()) || marks_[i]) return false;
    marks_[i] = 1;
    ++count_;
    return true;
  }
  int count() const { return count_; }
  bool has(int i) const { return marks_[i] != 0; }

 private:
  std::vector<char> marks_;
  int count_ = 0;
};

template <class Real>
class Check {
 public:
  explicit Check(const WorldData<Real>& w) : w_(w) {}

  void run() const {
    check_numbers();
    check_slots(w_.bodies), check_slots(w_.body_extras), check_slots(w_.shapes), check_slots(w_.chains),
        check_slots(w_.contacts), check_slots(w_.joints);
    check_sizes();
    check_uncommon();
    check_shape_lists();
    check_corners();
    for (int shape = 0; shape < w_.shapes.size(); ++shape) {
      if (w_.shapes.used(shape)) check_shape(shape);
    }
    check_trees();
    check_lists();
    check_awake();
    check_quarantine();
    check_mass_changes();
    for (int contact = 0; contact < w_.contacts.size(); ++contact) {
      if (w_.contacts.used(contact)) check_contact(contact);
    }
    check_contact_counts();
    check_joints();
    check_edges(w_.contacts, &BodyRecord<Real>::first_contact);
    check_edges(w_.joints, &BodyRecord<Real>::first_joint);
    check_constraints();
  }

 private:
  static void require(bool holds, const char* field, const char* problem) {
    plumb::require(holds, "snapshot", field, problem);
  }

  void check_numbers() const {
    const auto [corners, free] = w_.corners.parts();
    bool finite = is_finite(w_.settings) && is_finite(w_.time) && is_finite(w_.last_h) &&
                  is_finite(w_.impulse_h) && all_finite(w_.motion) && all_finite(w_.rotation) &&
                  all_finite(w_.position) && all_finite(w_.extents) && all_finite(w_.forms) &&
                  all_finite(w_.tight_aabbs) && all_finite(corners) && all_finite(w_.sleeping_contacts) &&
                  all_finite(std::get<0>(w_.loads.parts())) &&
                  all_finite(std::get<0>(w_.position_compensation.parts())) &&
                  all_finite(std::get<0>(w_.rest_displacements.parts())) && all_finite_uncommon() &&
                  all_finite(std::get<0>(w_.bodies.parts())) && all_finite(std::get<0>(w_.shapes.parts())) &&
                  all_finite(std::get<0>(w_.joints.parts()));
    for (int c = 0; c <= w_.graph.kColours; ++c) finite = finite && all_finite(w_.graph.colour(c));
    require(finite, "state", "holds numbers that are not finite");
    require(w_.steps >= 0 && w_.time >= 0 && w_.last_h >= 0 && w_.impulse_h >= 0 && w_.last_substeps >= 0,
            "time", "is negative");
    // A step is asked for 1000 substeps at most, and takes 16 times as many at most (step.cpp).
    require(w_.last_substeps <= 16000, "time", "has too many substeps");
    require(w_.last_h <= kLargestNumber && w_.impulse_h <= kLargestNumber, "time",
            "has steps that are longer than a world's");
    require(w_.steps <= kMaxSteps, "steps", "are more than a world takes");
    validate(w_.settings);
    check_lengths();
  }

  bool all_finite_uncommon() const {
    const auto& all = std::get<0>(w_.body_extras.parts());
    return std::all_of(all.begin(), all.end(), [](const BodyExtras<Real>& each) {
      return is_finite(each.gravity_scale) && is_finite(each.linear_damping) &&
             is_finite(each.angular_damping);
    });
  }

  // Checks that positions and sizes obey the limits of the calls that set them. Beyond these, AABBs would
  // become infinite a step later, and the world could be saved but not restored.
  void check_lengths() const {
    const auto all = [](const auto& list, const auto& lengths_of) {
      return std::all_of(list.begin(), list.end(), lengths_of);
    };
    const auto in_range = [](const auto&... each) { return (is_in_range(each) && ...); };
    // The part of a motion that is smaller than the rounding of positions.
    constexpr double kRounding = kMaxPosition * std::numeric_limits<double>::epsilon();
    const auto is_rounding = [](Vec2d v) { return std::abs(v.x) <= kRounding && std::abs(v.y) <= kRounding; };
    const bool bodies = all(std::get<0>(w_.position_compensation.parts()), is_rounding) &&
                        all(w_.position, in_range) && all(w_.extents, in_range) &&
                        all(std::get<0>(w_.bodies.parts()),
                            [&](const BodyRecord<Real>& each) { return in_range(each.angle, each.centre); });
    require(bodies, "bodies", "are farther off or larger than calls and steps allow");
    const bool shapes =
        all(w_.forms, [&](const ShapeForm<Real>& each) { return in_range(each.radius, each.extent); }) &&
        all(std::get<0>(w_.corners.parts()), [&](const Corner<Real>& each) { return in_range(each.point); });
    require(shapes, "shapes", "are larger than calls allow");
  }

  // Checks that each slot is either free and listed once, or in use.
  template <class T>
  void check_slots(const SlotMap<T>& all) const {
    const auto [items, generations, free] = all.parts();
    require(items.size() == generations.size(), "slots", "have no generations");
    Marks marks(all.size());
    for (const int index : free) {
      require(marks.mark(index) && !all.used(index), "free slots", "are not free");
    }
    for (int index = 0; index < all.size(); ++index) {
      if (all.used(index)) marks.mark(index);
    }
    require(marks.count() == all.size(), "free slots", "are not all listed");
  }

  void check_sizes() const {
    const auto is_by_body = [&](const auto& all) { return static_cast<int>(all.size()) == w_.bodies.size(); };
    const auto none_or_by_body = [&](const auto& list) {
      const auto& items = std::get<0>(list.parts());
      return items.empty() || is_by_body(items);
    };
    require(none_or_by_body(w_.loads) && none_or_by_body(w_.body_data) &&
                none_or_by_body(w_.position_compensation) && none_or_by_body(w_.rest_displacements) &&
                is_by_body(w_.motion) && is_by_body(w_.rotation) && is_by_body(w_.position) &&
                is_by_body(w_.extents) && is_by_body(w_.enlarged),
            "bodies", "are not as many everywhere");
    const std::size_t shapes = static_cast<std::size_t>(w_.shapes.size());
    const std::size_t data = std::get<0>(w_.shape_data.parts()).size();
    require(w_.forms.size() == shapes && w_.tight_aabbs.size() == shapes && (data == 0 || data == shapes),
            "shapes", "are not as many everywhere");
  }

  // Checks that each entry belongs to one body, with numbers that a call may set.
  void check_uncommon() const {
    Marks taken(w_.body_extras.size());
    for (int body = 0; body < w_.bodies.size(); ++body) {
      const int extras = w_.bodies[body].uncommon;
      require(extras == kNone || (w_.bodies.used(body) && taken.mark(extras) && w_.body_extras.used(extras)),
              "bodies", "share what is their own");
    }
    require(taken.count() == w_.body_extras.count(), "bodies", "have not all that is their own");
    for (const BodyExtras<Real>& each : std::get<0>(w_.body_extras.parts()))
      validate(BodyDefinition{.name = "snapshot",
                              .gravity_scale = each.gravity_scale,
                              .linear_damping = each.linear_damping,
                              .angular_damping = each.angular_damping});
  }

  // Checks that each body's list ends, and that every shape is in the list of its body.
  void check_shape_lists() const {
    Marks listed(w_.shapes.size());
    for (int body = 0; body < w_.bodies.size(); ++body) {
      if (!w_.bodies.used(body)) continue;
      const BodyRecord<Real>& record = w_.bodies[body];
      int before = kNone;
      for (int shape = record.first_shape; shape != kNone; shape = w_.shapes[shape].next) {
        require(listed.mark(shape) && w_.shapes.used(shape) && w_.shapes[shape].body == body &&
                    w_.shapes[shape].previous == before,
                "shapes", "are in the lists of other bodies");
        before = shape;
      }
    }
    require(listed.count() == w_.shapes.count(), "shapes", "belong to no body");
  }

  // Checks that every corner belongs to one run, and every run either to shapes with as many corners, or to
  // the free runs.
  void check_corners() const {
    const auto [all, free] = w_.corners.parts();
    Marks taken(static_cast<int>(all.size()));
    std::vector<int> run_at(all.size() + 1, 0);  // by first corner: length of the run
    const auto take = [&](int first, int count) {
      for (int i = 0; i < count; ++i) require(taken.mark(first + i), "corners", "belong to two shapes");
    };
    for (int shape = 0; shape < w_.shapes.size(); ++shape) {
      if (!w_.shapes.used(shape)) continue;
      const ShapeForm<Real>& form = w_.forms[shape];
      const bool valid_count =
          form.count >= 1 && form.count <= kMaxCorners && (!form.chain || form.count == 2);
      require(valid_count && form.corner >= 0 && form.corner <= static_cast<int>(all.size()), "corners",
              "of a shape are not there");
      int& run = run_at[form.corner];
      if (run == 0) take(form.corner, run = form.stored());
      require(run == form.stored(), "corners", "are shared by unlike shapes");
    }
    for (std::size_t count = 0; count < free.size(); ++count) {
      require(count <= kMaxCorners + 2 || free[count].empty(), "corners", "are free in too long runs");
      for (const int first : free[count]) {
        require(first >= 0 && first <= static_cast<int>(all.size()), "corners",
                "are free that are not there");
        take(first, static_cast<int>(count));
      }
    }
  }

  void check_shape(int shape) const {
    const ShapeRecord<Real>& record = w_.shapes[shape];
    const ShapeForm<Real>& form = w_.forms[shape];
    require(form.radius >= 0 && form.extent >= 0, "shapes", "are of negative size");
    validate("snapshot",
             Material{record.friction, record.restitution, record.rolling_resistance, record.surface_speed});
    require(form.chain == (record.chain != kNone), "chains", "have segments that are none");
    require(!form.chain || (record.chain >= 0 && record.chain < w_.chains.size() &&
                            w_.chains.used(record.chain) && w_.chains[record.chain].body == record.body),
            "chains", "are not there");
    if (is_out(record)) return require(record.proxy == kNone, "boxes", "are not out with their bodies");
    const DynamicTree<Real>& tree =
        w_.bodies[record.body].type == BodyType::Static ? w_.static_tree : w_.dynamic_tree;
    require(tree.holds(record.proxy) && tree.user(record.proxy) == shape, "boxes", "are not those of shapes");
    require(is_in_range(tree.box(record.proxy)), "boxes", "are farther off than calls and steps allow");
  }

  bool is_out(const ShapeRecord<Real>& record) const {
    return w_.bodies[record.body].quarantined || collides_with_nothing(record.filter);
  }

  void check_trees() const {
    int out = 0;
    for (int shape = 0; shape < w_.shapes.size(); ++shape) {
      if (w_.shapes.used(shape) && is_out(w_.shapes[shape])) ++out;
    }
    require(w_.static_tree.size() + w_.dynamic_tree.size() + out == w_.shapes.count(), "boxes",
            "are not as many as shapes");
  }

  // Checks that bodies in quarantine are listed, are static meanwhile, and have no contacts.
  void check_quarantine() const {
    Marks listed(w_.bodies.size());
    for (const QuarantinedBody& each : w_.quarantine) {
      require(has_body(each.body) && listed.mark(each.body), "quarantine", "lists bodies that are not there");
      const BodyRecord<Real>& record = w_.bodies[each.body];
      require(record.quarantined && record.type == BodyType::Static && record.first_contact == kNone,
              "quarantine", "lists bodies that are not in it");
    }
    int count = 0;
    for (int body = 0; body < w_.bodies.size(); ++body) {
      if (w_.bodies.used(body) && w_.bodies[body].quarantined) ++count;
    }
    require(count == listed.count(), "quarantine", "does not list all that is in it");
  }

  bool has_shape(int shape) const { return shape >= 0 && shape < w_.shapes.size() && w_.shapes.used(shape); }
  bool has_body(int body) const { return body >= 0 && body < w_.bodies.size() && w_.bodies.used(body); }
  bool has_joint(int joint) const { return joint >= 0 && joint < w_.joints.size() && w_.joints.used(joint); }

  // Checks the lists of shapes and joints: chains, sensors, moved shapes, joints with load limits.
  void check_lists() const {
    Marks in_chain(w_.shapes.size());
    int segments = 0, sensors = 0;
    for (int chain = 0; chain < w_.chains.size(); ++chain) {
      if (!w_.chains.used(chain)) continue;
      for (const int shape : w_.chains[chain].shapes) {
        require(has_shape(shape) && w_.shapes[shape].chain == chain && in_chain.mark(shape), "chains",
                "list shapes that are not theirs");
      }
    }
    for (int shape = 0; shape < w_.shapes.size(); ++shape) {
      if (!w_.shapes.used(shape)) continue;
      if (w_.forms[shape].chain) ++segments;
      if (w_.forms[shape].sensor) ++sensors;
    }
    require(in_chain.count() == segments, "chains", "do not list all their segments");
    Marks sensed(w_.shapes.size()), limited(w_.joints.size());
    for (const SensorRecord& sensor : w_.sensors) {
      require(has_shape(sensor.shape) && w_.forms[sensor.shape].sensor && sensed.mark(sensor.shape),
              "sensors", "are not shapes that sense");
    }
    require(sensed.count() == sensors, "sensors", "do not list all shapes that sense");
    for (const int shape : w_.move_buffer) {
      require(shape >= 0 && shape < w_.shapes.size(), "shapes", "moved that are not there");
    }
    for (const int joint : w_.load_limited_joints) {
      require(has_joint(joint) && limited.mark(joint), "joints", "have limits that are not there");
    }
  }

  // Checks that bodies whose mass is to be computed are listed. The mass of a static body may be unknown.
  void check_mass_changes() const {
    Marks listed(w_.bodies.size());
    for (const int body : w_.mass_changed_bodies)
      require(has_body(body) && listed.mark(body), "bodies", "whose shapes changed are not there");
    int count = 0;
    for (int body = 0; body < w_.bodies.size(); ++body) {
      if (!w_.bodies.used(body)) continue;
      const BodyRecord<Real>& record = w_.bodies[body];
      // Steps keep the length of rotations at 1 by one iteration of Newton's method, which diverges if the
      // length is far from 1.
      const Rotation<Real> q = w_.rotation[body];
      require(std::abs(q.c * q.c + q.s * q.s - 1) < Real(0.01), "bodies",
              "have rotations of another length than 1");
      if (record.half_width < 0)
        ++count, require(listed.has(body), "bodies", "whose shapes changed are not listed");
      require(record.mass >= 0 || own_type(w_, body) == BodyType::Static || record.half_width < 0, "bodies",
              "have a negative mass");
      require(w_.motion[body].inverse_mass >= 0 && w_.motion[body].inverse_inertia >= 0, "bodies",
              "have a negative inverse mass or inertia");
    }
    require(count == listed.count(), "bodies", "whose shapes changed are not listed");
  }

  void check_awake() const {
    Marks listed(w_.bodies.size());
    for (std::size_t i = 0; i < w_.awake.size(); ++i) {
      const int body = w_.awake[i];
      require(has_body(body) && listed.mark(body), "awake bodies", "are not there");
      const BodyRecord<Real>& record = w_.bodies[body];
      require(record.awake && record.type != BodyType::Static && record.awake_index == static_cast<int>(i),
              "awake bodies", "say otherwise");
    }
    int count = 0;
    for (int body = 0; body < w_.bodies.size(); ++body) {
      if (w_.bodies.used(body) && w_.bodies[body].awake) ++count;
    }
    require(count == listed.count(), "awake bodies", "are not all listed");
  }

  template <class Record>
  void check_ends(const Record& record, const char* field) const {
    require(has_body(record.body_a) && has_body(record.body_b) && record.body_a != record.body_b, field,
            "are between bodies that are not there");
  }

  static bool fits(const ContactRecord& record, const ContactConstraint<Real>& c, int contact) {
    return c.contact == contact && c.body_a == record.body_a && c.body_b == record.body_b && c.count <= 2;
  }

  void check_contact(int contact) const {
    const ContactRecord& record = w_.contacts[contact];
    check_ends(record, "contacts");
    require(has_shape(record.shape_a) && has_shape(record.shape_b) &&
                w_.shapes[record.shape_a].body == record.body_a &&
                w_.shapes[record.shape_b].body == record.body_b,
            "contacts", "are between shapes that are not there");
    const auto is_in = [&](const auto& list) {
      return record.index >= 0 && record.index < static_cast<int>(list.size());
    };
    bool indexed = true;
    if (record.home == ContactHome::NonTouching) {
      indexed = is_in(w_.nontouching_contacts) && w_.nontouching_contacts[record.index] == contact;
    } else if (record.home == ContactHome::Sleeping) {
      indexed = is_in(w_.sleeping_contacts) && fits(record, w_.sleeping_contacts[record.index], contact);
    } else if (record.home == ContactHome::Graph) {
      indexed = record.colour >= 0 && record.colour <= w_.graph.kColours &&
                is_in(w_.graph.colour(record.colour)) &&
                fits(record, w_.graph.at({record.colour, record.index}), contact);
    }
    require(indexed, "contacts", "are not where they say");
  }

  // Checks that every index belongs to one contact: the counts agree, and no two contacts have the same
  // index.
  void check_contact_counts() const {
    std::size_t count[4] = {};
    for (int contact = 0; contact < w_.contacts.size(); ++contact) {
      if (w_.contacts.used(contact)) ++count[static_cast<int>(w_.contacts[contact].home)];
    }
    require(count[static_cast<int>(ContactHome::NonTouching)] == w_.nontouching_contacts.size() &&
                count[static_cast<int>(ContactHome::Graph)] == w_.graph.size() &&
                count[static_cast<int>(ContactHome::Sleeping)] == w_.sleeping_contacts.size(),
            "contacts", "are not as many as their places");
  }

  void check_joints() const {
    for (int joint = 0; joint < w_.joints.size(); ++joint) {
      if (!w_.joints.used(joint)) continue;
      const JointRecord& record = w_.joints[joint];
      check_ends(record, "joints");
      require(w_.joint_set.contains(record.slot) && w_.joint_set.active(record.slot) == record.active &&
                  w_.joint_set.bodies(record.slot) == std::pair{record.body_a, record.body_b},
              "joints", "are not those that are solved");
      require(!record.active || w_.joint_set.dynamic(record.slot) ==
                                    std::pair{w_.is_dynamic(record.body_a), w_.is_dynamic(record.body_b)},
              "joints", "hold bodies of another type");
      require(!record.active || !has_quarantined_body(w_, record), "joints", "hold what is in quarantine");
    }
    require(w_.joint_set.count() == w_.joints.count(), "joints", "are not as many as are solved");
  }

  // Checks that each body's list ends, and that both ends of every contact or joint are in the list of their
  // body.
  template <class Items>
  void check_edges(const Items& items, int BodyRecord<Real>::*first) const {
    Marks listed(2 * items.size());
    for (int body = 0; body < w_.bodies.size(); ++body) {
      if (!w_.bodies.used(body)) continue;
      int before = kNone;
      for (int edge = w_.bodies[body].*first; edge != kNone;) {
        require(listed.mark(edge) && items.used(edge / 2), "lists of contacts or joints", "run in circles");
        const auto& item = items[edge / 2];
        const int side = edge & 1;
        require((side == 0 ? item.body_a : item.body_b) == body && item.previous[side] == before,
                "lists of contacts or joints", "are torn");
        before = edge;
        edge = item.next[side];
      }
    }
    require(listed.count() == 2 * items.count(), "lists of contacts or joints", "are not complete");
  }

  void check_constraints() const {
    std::vector<int> count(static_cast<std::size_t>(w_.bodies.size()), 0);
    const auto add = [&](const auto& record) { ++count[record.body_a], ++count[record.body_b]; };
    for (int contact = 0; contact < w_.contacts.size(); ++contact) {
      if (!w_.contacts.used(contact)) continue;
      const ContactRecord& record = w_.contacts[contact];
      if (record.home == ContactHome::Graph || record.home == ContactHome::Sleeping) add(record);
    }
    for (int joint = 0; joint < w_.joints.size(); ++joint) {
      if (w_.joints.used(joint) && !has_quarantined_body(w_, w_.joints[joint])) add(w_.joints[joint]);
    }
    for (int body = 0; body < w_.bodies.size(); ++body) {
      require(!w_.bodies.used(body) || w_.bodies[body].constraints == count[body], "bodies",
              "are held by another number of constraints than they say");
    }
  }

  const WorldData<Real>& w_;
};

}  // namespace

template <class Real>
void check_state(const WorldData<Real>& w) {
  Check<Real>(w).run();
}

template void check_state(const WorldData<float>&);
template void check_state(const WorldData<double>&);

}  // namespace plumb
