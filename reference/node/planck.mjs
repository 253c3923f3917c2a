//! package: planck
//! version: 1.4.2
//! summary: planck, Box2D 2 in JavaScript: sequential impulses
import { outOfTheBox, requireFrom, serve, versionOf } from "./support/serve.mjs";
import { combine, contactRules, inertiaOf, mayTouch } from "./support/scene.mjs";

const planck = requireFrom("planck");
const at = ([x, y]) => new planck.Vec2(x, y);

// The scene's filters decide instead of Box2D's own.
if (!outOfTheBox) {
  planck.Fixture.prototype.shouldCollide = function (other) { return mayTouch(this.getUserData().filter, other.getUserData().filter); };
  Object.assign(planck.Settings, { maxTranslation: 1e6, maxRotation: 1e6 }); // no clamps on speeds
}

function addShape(out, shape) {
  const geometry = shape.type === "circle" ? new planck.Circle(at(shape.position), shape.radius)
    : new planck.Box(shape.width / 2, shape.height / 2, at(shape.position), shape.angle);
  const { group, category, mask } = shape.filter;
  out.createFixture({ shape: geometry, density: 0, friction: shape.friction, restitution: shape.restitution, userData: shape,
                      filterGroupIndex: group, filterCategoryBits: category & 0xffff, filterMaskBits: mask & 0xffff });
}

function addBody(world, body) {
  const out = world.createBody({
    type: body.type, position: at(body.position), angle: body.angle, linearVelocity: at(body.velocity),
    angularVelocity: body.angular_velocity, fixedRotation: body.fixed_rotation, gravityScale: body.gravity_scale,
    allowSleep: outOfTheBox,
  });
  for (const shape of body.shapes) addShape(out, shape);
  if (body.type === "dynamic") out.setMassData({ mass: body.mass, center: at([0, 0]), I: inertiaOf(body) });
  return out;
}

function addJoint(world, joint, a, b) {
  const common = { collideConnected: joint.collide, localAnchorA: at(joint.anchor_a), localAnchorB: at(joint.anchor_b),
                   bodyA: a, bodyB: b };
  if (joint.type === "distance") return world.createJoint(new planck.DistanceJoint({ ...common, length: joint.length }));
  return world.createJoint(new planck.RevoluteJoint({ ...common, referenceAngle: b.getAngle() - a.getAngle() }));
}

function create(scene, settings) {
  const rules = scene.contact_rules;
  if (!outOfTheBox) planck.Settings.velocityThreshold = rules.restitution_threshold;
  const world = new planck.World({ gravity: at(scene.gravity), allowSleep: outOfTheBox });
  const bodies = scene.bodies.map((body) => addBody(world, body));
  const ground = world.createBody();
  const called = (name) => name === "world" ? ground : bodies[scene.bodies.findIndex((body) => body.name === name)];
  for (const joint of scene.joints) addJoint(world, joint, called(joint.body_a), called(joint.body_b));
  if (!outOfTheBox)
    world.on("begin-contact", (contact) => {
      const a = contact.getFixtureA().getUserData(), b = contact.getFixtureB().getUserData();
      contact.setFriction(combine(rules.friction, a.friction, b.friction));
      contact.setRestitution(combine(rules.restitution, a.restitution, b.restitution));
    });
  const velocity = Number(settings.options.velocity_iterations), position = Number(settings.options.position_iterations);
  return {
    effective: { velocity_iterations: velocity, position_iterations: position, sleeping: outOfTheBox ? "on" : "off",
                 ...(outOfTheBox ? { contact_rules: "friction geometric mean, restitution maximum" } : contactRules(scene)),
                 restitution_threshold: planck.Settings.velocityThreshold + " m/s", linear_slop: planck.Settings.linearSlop + " m",
                 max_translation: planck.Settings.maxTranslation + " m a substep" },
    step() { world.step(settings.substep, velocity, position); },
    state(i) {
      const p = bodies[i].getWorldCenter(), v = bodies[i].getLinearVelocity();
      return [p.x, p.y, bodies[i].getAngle(), v.x, v.y, bodies[i].getAngularVelocity()];
    },
    push(i, x, y, torque) {
      bodies[i].applyForceToCenter(at([x, y]), true);
      bodies[i].applyTorque(torque, true);
    },
  };
}

serve({
  name: "planck", version: versionOf("planck"), precision: "double", summary: "planck in JavaScript",
  limits: "planck is Box2D 2: it makes 8 iterations per step, polygons have a skin of 1 cm and contacts a slop of 5 mm, and " +
    "impacts are found at the end of the step.",
  joints: ["revolute", "distance"], features: ["contacts", "filters", "kinematic", "fixed_rotation"],
  options: [{ name: "velocity_iterations", fallback: "8", help: "velocity iterations per substep" },
            { name: "position_iterations", fallback: "3", help: "position iterations per substep" }],
  create,
});
