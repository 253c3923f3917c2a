// A Scene in Bullet. Compiled twice: with btScalar = float and = double.
#include "reference/bullet/simulator.h"

#include <BulletCollision/CollisionDispatch/btBox2dBox2dCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "engine/math/trigonometry.h"
#include "reference/bullet/distance_joint.h"
#include "reference/bullet/turns.h"
#include "reference/support/applied_forces.h"

namespace plumb::reference {
namespace {

btVector3 to_bullet(Vec2d v) { return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), 0}; }

btTransform to_bullet(Vec2d position, double angle) {
  const Rotation<double> q = rotation_of(angle);
  const auto c = static_cast<btScalar>(q.c), s = static_cast<btScalar>(q.s);
  return btTransform(btMatrix3x3(c, -s, 0, s, c, 0, 0, 0, 1), to_bullet(position));
}

Vec2d from_bullet(const btVector3& v) { return {static_cast<double>(v.x()), static_cast<double>(v.y())}; }

// Bullet's callbacks are global functions, so user pointers give them the scene's shapes and the scene.
// A compound has none, because it is not a shape of the scene.
const Shape* shape_of(const btCollisionShape* shape) {
  return static_cast<const Shape*>(shape->getUserPointer());
}
const Scene& scene_of(const btCollisionObject* body) {
  return *static_cast<const Scene*>(body->getUserPointer());
}

bool shapes_may_touch(const btCollisionShape* a, const btCollisionShape* b) {
  const Shape *one = shape_of(a), *other = shape_of(b);
  return one == nullptr || other == nullptr || may_touch(one->filter, other->filter);
}

bool set_contact_coefficients(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                              const btCollisionObjectWrapper* b, int, int) {
  const ContactRules& rules = scene_of(a->getCollisionObject()).contact_rules;
  const Shape& one = *shape_of(a->getCollisionShape());
  const Shape& other = *shape_of(b->getCollisionShape());
  point.m_combinedFriction = static_cast<btScalar>(combine(rules.friction, one.friction, other.friction));
  point.m_combinedRestitution =
      static_cast<btScalar>(combine(rules.restitution, one.restitution, other.restitution));
  return true;
}

bool install_callbacks() {
  gContactAddedCallback = set_contact_coefficients;
  gCompoundChildShapePairCallback = shapes_may_touch;
  gCompoundCompoundChildShapePairCallback = shapes_may_touch;
  return true;
}

/// Filters out pairs of bodies that have no two shapes that may touch; `shapes_may_touch` filters shapes.
class FilterOfScene final : public btOverlapFilterCallback {
 public:
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const auto& one = *static_cast<const btCollisionObject*>(a->m_clientObject);
    const auto& other = *static_cast<const btCollisionObject*>(b->m_clientObject);
    if (one.isStaticOrKinematicObject() && other.isStaticOrKinematicObject()) return false;
    const std::vector<Shape>& shapes = shapes_of(one);
    const std::vector<Shape>& others = shapes_of(other);
    for (const Shape& shape : shapes) {
      for (const Shape& each : others) {
        if (may_touch(shape.filter, each.filter)) return true;
      }
    }
    return false;
  }

 private:
  static const std::vector<Shape>& shapes_of(const btCollisionObject& object) {
    return scene_of(&object).bodies[static_cast<std::size_t>(object.getUserIndex())].shapes;
  }
};

/// Bullet's parts, in the order in which they depend on each other.
struct Machinery {
  Machinery() {
    dispatcher.registerCollisionCreateFunc(BOX_2D_SHAPE_PROXYTYPE, BOX_2D_SHAPE_PROXYTYPE, &boxes);
    broad_phase.getOverlappingPairCache()->setOverlapFilterCallback(&filter);
    static const bool installed = install_callbacks();
    static_cast<void>(installed);
  }

  btDefaultCollisionConfiguration configuration;
  btBox2dBox2dCollisionAlgorithm::CreateFunc boxes;
  FilterOfScene filter;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broad_phase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broad_phase, &solver, &configuration};
};

class BulletSimulator final : public Simulator {
 public:
  BulletSimulator(const Scene& scene, const BulletSettings& settings)
      : scene_(scene), settings_(settings), forces_(scene_) {
    configure(machinery_.world.getSolverInfo());
    machinery_.world.setGravity(to_bullet(scene_.gravity));
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i);
    for (const Joint& joint : scene_.joints) std::visit([this](const auto& j) { add_joint(j); }, joint);
  }

  ~BulletSimulator() override {
    for (const auto& joint : joints_) machinery_.world.removeConstraint(joint.get());
    for (const auto& body : bodies_) machinery_.world.removeRigidBody(body.get());
  }

  double advance(int steps) override {
    const auto h = static_cast<btScalar>(settings_.substep);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) {
      apply_forces();
      move_kinematic_bodies();
      machinery_.world.stepSimulation(h, 0);
      ++substeps_done_;
      count_turns();
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(substeps_done_) * settings_.substep; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = state_of(i);
  }

 private:
  void configure(btContactSolverInfo& info) const {
    info.m_numIterations = settings_.iterations;
    info.m_erp = static_cast<btScalar>(settings_.joint_erp);
    info.m_erp2 = static_cast<btScalar>(settings_.contact_erp);
    info.m_restitutionVelocityThreshold = static_cast<btScalar>(scene_.contact_rules.restitution_threshold);
    // By default, penetrations of up to 4 cm are resolved by adding velocity, which remains.
    info.m_splitImpulse = 1;
    info.m_splitImpulsePenetrationThreshold = 0;
    info.m_linearSlop = 0;
  }

  std::unique_ptr<btCollisionShape> make_shape(const Shape& shape) const {
    std::unique_ptr<btCollisionShape> out;
    if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
      out = std::make_unique<btSphereShape>(static_cast<btScalar>(circle->radius));
    } else {
      const Box& box = std::get<Box>(shape.geometry);
      out = std::make_unique<btBox2dShape>(to_bullet({box.width / 2, box.height / 2}));
      out->setMargin(0);
    }
    out->setUserPointer(const_cast<Shape*>(&shape));
    return out;
  }

  /// Returns a body's shapes as one shape: an empty shape, the only shape if that is centred, or a compound.
  btCollisionShape* add_shapes(const Body& body) {
    if (body.shapes.empty()) {
      shapes_.push_back(std::make_unique<btEmptyShape>());
      return shapes_.back().get();
    }
    const Shape& first = body.shapes[0];
    if (body.shapes.size() == 1 && first.position == Vec2d{} && first.angle == 0) {
      shapes_.push_back(make_shape(first));
      return shapes_.back().get();
    }
    auto compound = std::make_unique<btCompoundShape>();
    for (const Shape& shape : body.shapes) {
      shapes_.push_back(make_shape(shape));
      compound->addChildShape(to_bullet(shape.position, shape.angle), shapes_.back().get());
    }
    shapes_.push_back(std::move(compound));
    return shapes_.back().get();
  }

  void add_body(std::size_t index) {
    const Body& body = scene_.bodies[index];
    const bool dynamic = body.type == BodyType::Dynamic;
    const auto mass = static_cast<btScalar>(dynamic ? body.mass : 0);
    // Bullet reads zeros as infinite inertia, so that nothing rotates out of the plane.
    const btVector3 inertia(0, 0, static_cast<btScalar>(inertia_of(body)));
    auto out = std::make_unique<btRigidBody>(mass, nullptr, add_shapes(body), inertia);
    out->setWorldTransform(to_bullet(body.position, body.angle));
    out->setInterpolationWorldTransform(out->getWorldTransform());
    out->updateInertiaTensor();
    out->setLinearVelocity(to_bullet(body.velocity));
    out->setAngularVelocity({0, 0, static_cast<btScalar>(body.angular_velocity)});
    out->setLinearFactor({1, 1, 0});
    out->setAngularFactor({0, 0, 1});
    out->setDamping(0, 0);
    out->setFlags(0);  // no gyroscopic forces: there are none in the plane
    out->setActivationState(DISABLE_DEACTIVATION);
    out->setCollisionFlags(out->getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    // Disables speculative contacts: Bullet subtracts their approach speed from the rebound.
    if (!settings_.speculative) out->setContactProcessingThreshold(0);
    out->setUserPointer(&scene_);
    out->setUserIndex(static_cast<int>(index));
    if (body.type == BodyType::Kinematic) {
      out->setCollisionFlags((out->getCollisionFlags() & ~btCollisionObject::CF_STATIC_OBJECT) |
                             btCollisionObject::CF_KINEMATIC_OBJECT);
      kinematic_.push_back(index);
    }
    machinery_.world.addRigidBody(out.get());
    turns_.push_back(rotation_counter(*out, body.angle));
    if (body.type != BodyType::Static && !body.fixed_rotation) turning_.push_back(index);
    bodies_.push_back(std::move(out));
  }

  static TurnCounter rotation_counter(const btRigidBody& body, double angle) {
    const btMatrix3x3& basis = body.getWorldTransform().getBasis();
    return {angle, static_cast<double>(basis[0][0]), static_cast<double>(basis[1][0])};
  }

  btRigidBody& body_called(const std::string& name) {
    if (const auto index = find_body(scene_, name)) return *bodies_[*index];
    return fixed_frame_;
  }

  void add_joint(const RevoluteJoint& joint) {
    // btHingeConstraint would add two rows against rotation out of the plane: same gaps, more work.
    add(std::make_unique<btPoint2PointConstraint>(body_called(joint.body_a), body_called(joint.body_b),
                                                  to_bullet(joint.anchor_a), to_bullet(joint.anchor_b)),
        joint.collide);
  }

  void add_joint(const DistanceJoint& joint) {
    add(std::make_unique<BulletDistanceJoint>(body_called(joint.body_a), body_called(joint.body_b),
                                              to_bullet(joint.anchor_a), to_bullet(joint.anchor_b),
                                              static_cast<btScalar>(joint.length)),
        joint.collide);
  }

  void add_joint(const auto&) {}  // not one that `unsupported` lets through

  void add(std::unique_ptr<btTypedConstraint> joint, bool collide) {
    machinery_.world.addConstraint(joint.get(), !collide);
    joints_.push_back(std::move(joint));
  }

  BodyState state_of(std::size_t index) const {
    const btRigidBody& body = *bodies_[index];
    return {.position = from_bullet(body.getWorldTransform().getOrigin()),
            .angle = turns_[index].angle(),
            .velocity = from_bullet(body.getLinearVelocity()),
            .angular_velocity = static_cast<double>(body.getAngularVelocity().z())};
  }

  // Evaluates forces at the step's start and keeps them constant during the step, as users of Bullet do.
  void apply_forces() {
    const double start = time(), end = static_cast<double>(substeps_done_ + 1) * settings_.substep;
    forces_.apply(
        start, end, [&](std::size_t body) { return state_of(body); },
        [&](std::size_t body, const Wrench<double>& wrench) {
          bodies_[body]->applyCentralForce(to_bullet(wrench.force));
          bodies_[body]->applyTorque({0, 0, static_cast<btScalar>(wrench.torque)});
        });
  }

  // Sets the pose at the step's end, from which Bullet derives a kinematic body's velocity.
  void move_kinematic_bodies() {
    const double end = static_cast<double>(substeps_done_ + 1) * settings_.substep;
    for (const std::size_t index : kinematic_) {
      const Body& body = scene_.bodies[index];
      bodies_[index]->setWorldTransform(
          to_bullet(body.position + end * body.velocity, body.angle + end * body.angular_velocity));
    }
  }

  // Counted in the measured time, because a game that needs whole turns must count them as well.
  void count_turns() {
    for (const std::size_t index : turning_) {
      const btMatrix3x3& basis = bodies_[index]->getWorldTransform().getBasis();
      turns_[index].update(static_cast<double>(basis[0][0]), static_cast<double>(basis[1][0]));
    }
  }

  Scene scene_;  // shapes and bodies point at it
  BulletSettings settings_;
  AppliedForces forces_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  btEmptyShape no_shape_;
  btRigidBody fixed_frame_{0, nullptr, &no_shape_};
  Machinery machinery_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<TurnCounter> turns_;
  std::vector<std::size_t> kinematic_, turning_;
  std::int64_t substeps_done_ = 0;
};

}  // namespace

std::unique_ptr<Simulator> make_bullet_simulator(const Scene& scene, const BulletSettings& settings) {
  return std::make_unique<BulletSimulator>(scene, settings);
}

}  // namespace plumb::reference
