#include "engine/precise/body_laws.h"

namespace plumb::precise {

Scene with_body_laws(Scene scene) {
  for (Body& body : scene.bodies) {
    if (body.type == BodyType::Dynamic) {
      const Vec2d lift = ((body.gravity_scale - 1) * body.mass) * scene.gravity;
      if (lift != Vec2d{}) scene.forces.push_back(PointForce{.body = body.name, .force = lift});
      if (body.linear_damping != 0 || body.angular_damping != 0)
        scene.forces.push_back(LinearDrag{.body = body.name,
                                          .coefficient = body.linear_damping * body.mass,
                                          .angular_coefficient = body.angular_damping * inertia_of(body)});
    }
    body.gravity_scale = 1;
    body.linear_damping = body.angular_damping = 0;
  }
  return scene;
}

}  // namespace plumb::precise
