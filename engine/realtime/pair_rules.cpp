#include <algorithm>
#include <map>

#include "engine/realtime/contact_finder.h"

namespace plumb {

PairRules::PairRules(const Scene& scene) : rules_(scene.contact_rules) {
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    dynamic_.push_back(scene.bodies[body].type == BodyType::Dynamic);
    for (const Shape& shape : scene.bodies[body].shapes) {
      shapes_.push_back(shape);
      body_of_.push_back(static_cast<int>(body));
    }
  }
  std::map<std::string_view, int> index;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    index.emplace(scene.bodies[body].name, static_cast<int>(body));
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          const auto a = index.find(j.body_a), b = index.find(j.body_b);
          if (!j.collide && a != index.end() && b != index.end())
            excluded_.push_back(pair_key(a->second, b->second));
        },
        joint);
  }
  std::sort(excluded_.begin(), excluded_.end());
}

bool PairRules::may_touch(int shape, int other) const {
  const int a = body_of_[shape], b = body_of_[other];
  if (a == b || !(dynamic_[a] || dynamic_[b])) return false;
  if (!plumb::may_touch(shapes_[shape].filter, shapes_[other].filter)) return false;
  return !std::binary_search(excluded_.begin(), excluded_.end(), pair_key(a, b));
}

double PairRules::friction(int shape, int other) const {
  return combine(rules_.friction, shapes_[shape].friction, shapes_[other].friction);
}

double PairRules::restitution(int shape, int other) const {
  return combine(rules_.restitution, shapes_[shape].restitution, shapes_[other].restitution);
}

}  // namespace plumb
