#include "engine/joints/kind_of.h"

#include <string_view>
#include <type_traits>
#include <variant>

#include "engine/scene/joint_fields.h"

namespace plumb {
namespace {

template <class J, class Visit>
void each_field(J& joint, const Visit& visit) {
  anchor_fields(joint, visit);
  own_fields(joint, visit);
}

/// Copies the fields of a joint that bear the same names.
template <class Definition, class J>
void take(Definition& definition, const J& joint) {
  each_field(definition, [&]<class T>(std::string_view name, T& to, const FieldRule&) {
    each_field(joint, [&]<class U>(std::string_view other, const U& from, const FieldRule&) {
      if constexpr (std::is_same_v<T, U>)
        if (name == other) to = from;
    });
  });
}

template <std::size_t kKind = 0>
JointKind make(const auto& joint) {
  using Definition = std::variant_alternative_t<kKind, JointKind>;
  if constexpr (Is<decltype(joint), typename Definition::SceneJoint>) {
    Definition definition;
    take(definition, joint);
    return definition;
  } else {
    return make<kKind + 1>(joint);
  }
}

}  // namespace

JointKind kind_of(const Joint& joint) {
  return std::visit([](const auto& j) { return make(j); }, joint);
}

}  // namespace plumb
