#include "engine/joints/joints.h"

#include <map>
#include <string_view>

namespace plumb {
namespace {

template <class T>
T of_body(std::span<const T> values, int body) {
  return body == kFixedFrame ? T{} : values[static_cast<std::size_t>(body)];
}

}  // namespace

template <class Real>
void Joints<Real>::rows(std::span<const Pose<Real>> poses, std::span<const Twist<Real>> twists,
                        std::span<Row<Real>> out) const {
  Row<Real>* next = out.data();
  const auto all_of = [&](const auto& joints) {
    for (const auto& joint : joints) {
      joint.rows(of_body(poses, joint.a), of_body(poses, joint.b), of_body(twists, joint.a),
                 of_body(twists, joint.b), next);
      next += joint.kRows;
    }
  };
  all_of(revolute);
  all_of(distance);
}

template <class Real>
Joints<Real> compile_joints(const Scene& scene) {
  std::map<std::string_view, int> index{{kWorld, kFixedFrame}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    index.emplace(scene.bodies[i].name, static_cast<int>(i));
  }
  Joints<Real> joints;
  for (const Joint& joint : scene.joints) {
    if (const auto* hinge = std::get_if<RevoluteJoint>(&joint)) {
      joints.revolute.push_back({index.at(hinge->body_a), index.at(hinge->body_b), hinge->anchor_a.as<Real>(),
                                 hinge->anchor_b.as<Real>()});
    } else if (const auto* rod = std::get_if<DistanceJoint>(&joint); rod && !rod->spring && !rod->range) {
      joints.distance.push_back({index.at(rod->body_a), index.at(rod->body_b), rod->anchor_a.as<Real>(),
                                 rod->anchor_b.as<Real>(), static_cast<Real>(rod->length)});
    }
  }
  return joints;
}

template struct Joints<float>;
template struct Joints<double>;
template Joints<float> compile_joints(const Scene& scene);
template Joints<double> compile_joints(const Scene& scene);

}  // namespace plumb
