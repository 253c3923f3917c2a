//! cmake: include(ode/library.cmake)
//! link: plumb_ode
//! guest: yes
//! missing: ODE was not found; install libode-dev and build again

// The Open Dynamics Engine in double, kept in the plane by one Plane2D joint per body. The contacts of a step
// are one linear complementarity problem, solved exactly.
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/core/text.h"
#include "reference/backend.h"
#include "reference/bullet/turns.h"
#include "reference/guests.h"
#include "reference/support/applied_forces.h"
#include "reference/support/plain_scene.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr int kMostContacts =
    8;  // contacts of a pair of shapes; two boxes have four corners of one face, at two depths

struct OdeSettings {
  int substeps = 1;
  double substep = 0;  ///< s
  double erp = 0.2, cfm = 1e-10;
  bool quick = false;
  bool equalised = true;
};

// The library must be set up once per process.
void start_ode() {
  static const bool started = dInitODE2(0) != 0;
  static_cast<void>(started);
}

class OdeSimulator final : public Simulator {
 public:
  OdeSimulator(const Scene& scene, const OdeSettings& settings)
      : scene_(scene), settings_(settings), forces_(scene_) {
    start_ode();
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    group_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, scene_.gravity.x, scene_.gravity.y, 0);
    dWorldSetAutoDisableFlag(world_, 0);
    if (settings.equalised) {
      dWorldSetERP(world_, settings.erp);
      dWorldSetCFM(world_, settings.cfm);
    }
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(scene_.bodies[i]);
    for (const Joint& joint : scene_.joints) std::visit([this](const auto& j) { add_joint(j); }, joint);
  }

  ~OdeSimulator() override {
    dJointGroupDestroy(group_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) substep();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(done_) * settings_.substep; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) out[i] = state_of(i);
  }

 private:
  void substep() {
    const double from = time(), to = static_cast<double>(done_ + 1) * settings_.substep;
    forces_.apply(
        from, to, [this](std::size_t body) { return state_of(body); },
        [this](std::size_t body, const Wrench<double>& wrench) {
          dBodyAddForce(bodies_[body], wrench.force.x, wrench.force.y, 0);
          dBodyAddTorque(bodies_[body], 0, 0, wrench.torque);
        });
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (bodies_[i] == nullptr || body.type != BodyType::Dynamic || body.gravity_scale == 1) continue;
      const Vec2d pull = body.mass * (body.gravity_scale - 1) * scene_.gravity;
      dBodyAddForce(bodies_[i], pull.x, pull.y, 0);
    }
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID a, dGeomID b) { static_cast<OdeSimulator*>(self)->near(a, b); });
    if (settings_.quick) {
      dWorldQuickStep(world_, settings_.substep);
    } else {
      dWorldStep(world_, settings_.substep);
    }
    dJointGroupEmpty(group_);
    ++done_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (bodies_[i] == nullptr) continue;
      // Removes the rotation out of the plane that rounding causes, as ODE's manual advises for Plane2D.
      const dReal* q = dBodyGetQuaternion(bodies_[i]);
      const double norm = std::hypot(q[0], q[3]);
      const dReal flat[4] = {q[0] / norm, 0, 0, q[3] / norm};
      dBodySetQuaternion(bodies_[i], flat);
      const dReal* w = dBodyGetAngularVel(bodies_[i]);
      dBodySetAngularVel(bodies_[i], 0, 0, w[2]);
      const dReal* rotation = dBodyGetRotation(bodies_[i]);
      turns_[i].update(rotation[0], rotation[4]);
    }
  }

  void near(dGeomID a, dGeomID b) {
    dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == body_b) return;
    const auto& shape_a = *static_cast<const Shape*>(dGeomGetData(a));
    const auto& shape_b = *static_cast<const Shape*>(dGeomGetData(b));
    if (!may_touch(shape_a.filter, shape_b.filter)) return;
    for (const auto& [one, other] : apart_)
      if ((one == body_a && other == body_b) || (one == body_b && other == body_a)) return;
    std::array<dContact, kMostContacts> contacts{};
    const int count = dCollide(a, b, kMostContacts, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      dContact& contact = contacts[static_cast<std::size_t>(i)];
      const dReal x = contact.geom.normal[0], y = contact.geom.normal[1];
      if (std::abs(contact.geom.normal[2]) > 0.5)
        continue;  // a face of a slab parallel to the plane: not part of the 2D scene
      const ContactRules& rules = scene_.contact_rules;
      contact.surface.mode = dContactFDir1 | dContactMu2 | dContactBounce | dContactApprox1_1;
      contact.surface.mu = combine(rules.friction, shape_a.friction, shape_b.friction);
      contact.surface.mu2 = 0;
      contact.surface.bounce = combine(rules.restitution, shape_a.restitution, shape_b.restitution);
      contact.surface.bounce_vel = rules.restitution_threshold;
      contact.fdir1[0] = -y;
      contact.fdir1[1] = x;
      contact.fdir1[2] = 0;
      dJointAttach(dJointCreateContact(world_, group_, &contact), body_a, body_b);
    }
  }

  BodyState state_of(std::size_t i) const {
    if (bodies_[i] == nullptr) return initial_state(scene_.bodies[i]);
    const dReal *p = dBodyGetPosition(bodies_[i]), *v = dBodyGetLinearVel(bodies_[i]);
    return {.position = {p[0], p[1]},
            .angle = turns_[i].angle(),
            .velocity = {v[0], v[1]},
            .angular_velocity = dBodyGetAngularVel(bodies_[i])[2]};
  }

  void add_body(const Body& body) {
    dBodyID out = nullptr;  // a static body is only geometry
    if (body.type != BodyType::Static) {
      out = dBodyCreate(world_);
      dBodySetPosition(out, body.position.x, body.position.y, 0);
      dMatrix3 rotation;
      dRFromAxisAndAngle(rotation, 0, 0, 1, body.angle);
      dBodySetRotation(out, rotation);
      dBodySetLinearVel(out, body.velocity.x, body.velocity.y, 0);
      dBodySetAngularVel(out, 0, 0, body.angular_velocity);
      dBodySetFiniteRotationMode(out, 1);  // integrates the step's rotation exactly, not to first order
      dBodySetFiniteRotationAxis(out, 0, 0, 1);
      if (body.type == BodyType::Kinematic) dBodySetKinematic(out);
    }
    if (body.type == BodyType::Dynamic) {
      dMass mass;
      const double inertia = body.fixed_rotation ? body.mass : inertia_of(body);
      dMassSetParameters(&mass, body.mass, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
      dBodySetMass(out, &mass);
      dJointID plane = dJointCreatePlane2D(world_, nullptr);
      dJointAttach(plane, out, nullptr);
      if (body.fixed_rotation) {  // a motor that keeps the angular velocity at zero
        dJointSetPlane2DAngleParam(plane, dParamVel, 0);
        dJointSetPlane2DAngleParam(plane, dParamFMax, dInfinity);
      }
    }
    bodies_.push_back(out);
    turns_.emplace_back(body.angle, std::cos(body.angle), std::sin(body.angle));
    for (const Shape& shape : body.shapes) add_shape(out, body, shape);
  }

  void add_shape(dBodyID body, const Body& of, const Shape& shape) {
    const auto* circle = std::get_if<Circle>(&shape.geometry);
    const auto* box = std::get_if<Box>(&shape.geometry);
    dGeomID out = circle != nullptr
                      ? dCreateSphere(space_, circle->radius)
                      : dCreateBox(space_, box->width, box->height, std::min(box->width, box->height));
    dGeomSetData(out, const_cast<Shape*>(&shape));
    dMatrix3 rotation;
    if (body != nullptr) {
      dGeomSetBody(out, body);
      dRFromAxisAndAngle(rotation, 0, 0, 1, shape.angle);
      dGeomSetOffsetPosition(out, shape.position.x, shape.position.y, 0);
      dGeomSetOffsetRotation(out, rotation);
      return;
    }
    const Vec2d place = anchor_in_world(scene_, of.name, shape.position);
    dRFromAxisAndAngle(rotation, 0, 0, 1, of.angle + shape.angle);
    dGeomSetPosition(out, place.x, place.y, 0);
    dGeomSetRotation(out, rotation);
  }

  dBodyID body_called(const std::string& name) {
    const auto index = find_body(scene_, name);
    return index ? bodies_[*index] : nullptr;
  }

  // ODE's joints have one place in the world, so a joint that starts open cannot be created.
  void add_joint(const RevoluteJoint& joint) {
    dBodyID a = body_called(joint.body_a), b = body_called(joint.body_b);
    dJointID out = dJointCreateBall(world_, nullptr);
    dJointAttach(out, b, a);
    const Vec2d place = anchor_in_world(scene_, joint.body_b, joint.anchor_b);
    dJointSetBallAnchor(out, place.x, place.y, 0);
    if (!joint.collide) apart_.emplace_back(a, b);
  }
  void add_joint(const DistanceJoint& joint) {
    dBodyID a = body_called(joint.body_a), b = body_called(joint.body_b);
    const Vec2d at_a = anchor_in_world(scene_, joint.body_a, joint.anchor_a);
    const Vec2d at_b = anchor_in_world(scene_, joint.body_b, joint.anchor_b);
    dJointID out = dJointCreateDBall(world_, nullptr);
    dJointAttach(out, a == nullptr ? b : a, a == nullptr ? a : b);
    if (a == nullptr) {
      dJointSetDBallAnchor1(out, at_b.x, at_b.y, 0);
      dJointSetDBallAnchor2(out, at_a.x, at_a.y, 0);
    } else {
      dJointSetDBallAnchor1(out, at_a.x, at_a.y, 0);
      dJointSetDBallAnchor2(out, at_b.x, at_b.y, 0);
    }
    dJointSetDBallDistance(out, joint.length);
    if (!joint.collide) apart_.emplace_back(a, b);
  }
  template <class Other>
  void add_joint(const Other&) {}  // refused

  Scene scene_;  // geometry points at its shapes
  OdeSettings settings_;
  AppliedForces forces_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID group_ = nullptr;
  std::vector<dBodyID> bodies_;
  std::vector<TurnCounter> turns_;
  std::vector<std::pair<dBodyID, dBodyID>> apart_;  // jointed bodies that do not touch
  std::int64_t done_ = 0;
};

class OdeBackend final : public Backend {
 public:
  explicit OdeBackend(bool equalised) : equalised_(equalised) {}

  std::string_view name() const override { return equalised_ ? "ode" : "ode-default"; }
  std::string_view summary() const override {
    return equalised_ ? "ODE: contacts as one exact complementarity problem; settings equalised"
                      : "ODE: the quick step, with its default settings";
  }
  Identity identity() const override {
    return {.version = PLUMB_ODE_VERSION,
            .precision = "double",
            .guest = true,
            .limits =
                "ODE removes a fifth of an overlap or gap per step (ERP), its contacts yield by its CFM, and "
                "it finds an impact only once the shapes overlap."};
  }

  std::vector<Option> options() const override {
    std::vector<Option> out{
        {"solver", equalised_ ? "exact" : "quick", "exact (dWorldStep) or quick (20 iterations)"}};
    if (equalised_) {
      out.push_back({"erp", "0.2", "fraction of an error that a step removes (ERP)"});
      out.push_back({"cfm", "1e-10", "compliance of constraints (CFM), 1/kg s"});
    }
    return out;
  }
  std::vector<Knob> knobs() const override { return {{"solver", {"quick", "exact"}, true}}; }

  Method method(const StepSettings& settings) const override {
    return {.scheme = Scheme::SemiImplicitEuler,
            .order = 1,
            .substep = read_settings(settings).substep,
            .epsilon = std::numeric_limits<double>::epsilon()};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    for (const Body& body : scene.bodies) {
      if (const std::string reason = missing(body); !reason.empty())
        return "body " + plumb::quoted(body.name) + ": " + reason;
      if (std::string reason = not_circles_and_boxes(body); !reason.empty()) return reason;
    }
    if (std::string reason = not_plain_joints(scene); !reason.empty()) return reason;
    for (const Joint& joint : scene.joints)
      if (const auto* hinge = std::get_if<RevoluteJoint>(&joint);
          hinge != nullptr && starts_open(scene, *hinge))
        return "ODE's joints start closed";
    return out_of_range(scene, kDoubleRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const OdeSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"solver", chosen.quick ? "quick" : "exact"},
                 {"erp", shortest(chosen.erp)},
                 {"cfm", shortest(chosen.cfm)},
                 {"plane", "a Plane2D joint a body; shapes are spheres and slabs"},
                 {"sleeping", "off"},
                 {"inertia", "the scene's"},
                 {"filters", "the scene's"}};
    append_contact_rules(out, scene);
    out.insert(out.end(), {{"forces", "at the start of each substep"}, {"precision", "double"}});
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<OdeSimulator>(scene, read_settings(settings));
  }

 private:
  static std::string missing(const Body& body) {
    if (body.lock_x || body.lock_y) return "locked axes are not mapped";
    if (body.linear_damping != 0 || body.angular_damping != 0)
      return "ODE's damping is a fraction per step, not a rate";
    for (const Shape& shape : body.shapes) {
      if (shape.rolling_resistance != 0 || shape.surface_speed != 0)
        return "rolling resistance and surface speeds are not mapped";
    }
    return "";
  }

  // Returns true if the hinge's anchors are farther apart than the rounding of a scene within a kilometre.
  static bool starts_open(const Scene& scene, const RevoluteJoint& hinge) {
    const Vec2d gap = anchor_in_world(scene, hinge.body_a, hinge.anchor_a) -
                      anchor_in_world(scene, hinge.body_b, hinge.anchor_b);
    constexpr double kClosed = 1e-9;  // m
    return std::hypot(gap.x, gap.y) > kClosed;
  }

  OdeSettings read_settings(const StepSettings& settings) const {
    check_steps(name(), settings, Stepping::Fixed);
    const OptionReader given(name(), settings, options());
    OdeSettings out;
    out.substeps = settings.substeps.value_or(1);
    out.substep = settings.dt / out.substeps;
    out.quick = given.choice<bool>("solver", {{"exact", false}, {"quick", true}});
    out.equalised = equalised_;
    if (!equalised_) {
      out.cfm = 1e-10;  // ODE's own value in double
      return out;
    }
    out.erp = given.number("erp", 0);
    out.cfm = given.number("cfm", 0);
    return out;
  }

  bool equalised_;
};

const GuestRegistration equalised{std::make_unique<OdeBackend>(true)};
const GuestRegistration out_of_the_box{std::make_unique<OdeBackend>(false)};

}  // namespace
}  // namespace plumb::reference
