#include "engine/scene/json/json_joints.h"

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/scene/joint_fields.h"
#include "engine/scene/names.h"

namespace plumb::json {
namespace {

Spring read_spring(const View& view, Spring spring) {
  const Fields fields(view, "a spring", {"hertz", "damping_ratio"});
  spring.hertz = number(fields.required("hertz"));
  fields.read("damping_ratio", spring.damping_ratio);
  return spring;
}

Range read_range(const View& view) {
  const Fields fields(view, "a range", {"lower", "upper"});
  Range range;
  fields.read("lower", range.lower);
  fields.read("upper", range.upper);
  return range;
}

Motor read_motor(const View& view) {
  const Fields fields(view, "a motor", {"speed", "max_force"});
  Motor motor;
  fields.read("speed", motor.speed);
  motor.max_force = number(fields.required("max_force"));
  return motor;
}

/// Reads each field it is called with.
class Reader {
 public:
  explicit Reader(const Fields& fields) : fields_(fields) {}

  template <class T>
  void operator()(std::string_view key, T& out, const FieldRule& rule) const {
    if (!rule.required && !fields_.has(key)) return;
    const View view = fields_.required(key);
    if constexpr (std::is_same_v<T, Spring>) {
      out = read_spring(view, out);
    } else if constexpr (std::is_same_v<T, std::optional<Spring>>) {
      out = read_spring(view, {});
    } else if constexpr (std::is_same_v<T, std::optional<Range>>) {
      out = read_range(view);
    } else if constexpr (std::is_same_v<T, std::optional<Motor>>) {
      out = read_motor(view);
    } else if constexpr (std::is_same_v<T, bool>) {
      out = boolean(view);
    } else if constexpr (std::is_same_v<T, Vec2d>) {
      out = vector(view);
    } else {
      out = number(view);
    }
  }

 private:
  const Fields& fields_;
};

template <class J>
void visit_all(J& joint, auto&& visit) {
  anchor_fields(joint, visit);
  own_fields(joint, visit);
  last_fields(joint, visit);
}

template <class J>
Fields::Keys keys_of() {
  Fields::Keys keys{"type", "name", "body_a", "body_b"};
  J joint;
  visit_all(joint, [&](std::string_view key, auto&, const FieldRule&) { keys.push_back(key); });
  return keys;
}

template <class J>
Joint read_as(const View& view, std::string_view kind) {
  const std::string what = "a " + std::string(kind) + " joint";
  const Fields fields(view, what, keys_of<J>());
  J joint;
  joint.name = string(fields.required("name"));
  joint.body_a = string(fields.required("body_a"));
  joint.body_b = string(fields.required("body_b"));
  visit_all(joint, Reader(fields));
  return joint;
}

/// One reader per kind, and the keys of all kinds together, so that a mistyped "type" is reported as such.
template <class... Kinds>
struct AnyJoint;
template <class... Kinds>
struct AnyJoint<std::variant<Kinds...>> {
  using Read = Joint (*)(const View&, std::string_view);
  static constexpr Read kReaders[] = {read_as<Kinds>...};

  static Fields::Keys keys() {
    Fields::Keys all;
    const auto add = [&](const Fields::Keys& keys) {
      for (const std::string_view key : keys)
        if (std::find(all.begin(), all.end(), key) == all.end()) all.push_back(key);
    };
    (add(keys_of<Kinds>()), ...);
    return all;
  }
};

}  // namespace

Joint read_joint(const View& view) {
  static const Fields::Keys kAll = AnyJoint<Joint>::keys();
  const std::size_t kind = choice(Fields(view, "a joint", kAll).required("type"), kJointNames);
  return AnyJoint<Joint>::kReaders[kind](view, kJointNames[kind]);
}

}  // namespace plumb::json
