//! package: box2d3-wasm
//! version: 5.2.0
//! summary: Box2D v3, compiled to WebAssembly: soft contacts in substeps
import { pathToFileURL } from "node:url";
import { fileOf, outOfTheBox, serve, versionOf } from "./support/serve.mjs";
import { combine, contactRules, inertiaOf, mayTouch } from "./support/scene.mjs";

const kEntry = fileOf("box2d3-wasm", "build/dist/es/compat/Box2D.compat.mjs");
const B = await (await import(pathToFileURL(kEntry).href)).default();
const at = ([x, y]) => new B.b2Vec2(x, y);

function addShape(id, shape) {
  const def = B.b2DefaultShapeDef();
  def.density = 0;
  def.updateBodyMass = false;
  def.material.friction = shape.friction;
  def.material.restitution = shape.restitution;
  const { category, mask, group } = shape.filter;
  def.filter.categoryBits = category >>> 0;
  def.filter.maskBits = mask >>> 0;
  def.filter.groupIndex = group;
  if (shape.type === "circle") {
    const circle = new B.b2Circle();
    circle.center = at(shape.position);
    circle.radius = shape.radius;
    return B.b2CreateCircleShape(id, def, circle);
  }
  const box = B.b2MakeOffsetBox(shape.width / 2, shape.height / 2, at(shape.position), B.b2MakeRot(shape.angle));
  return B.b2CreatePolygonShape(id, def, box);
}

function addBody(world, body) {
  const def = B.b2DefaultBodyDef();
  def.type = B.b2BodyType["b2_" + body.type + "Body"];
  def.position = at(body.position);
  def.rotation = B.b2MakeRot(body.angle);
  def.linearVelocity = at(body.velocity);
  def.angularVelocity = body.angular_velocity;
  def.gravityScale = body.gravity_scale;
  def.enableSleep = outOfTheBox;
  def.allowFastRotation = !outOfTheBox;
  if (body.fixed_rotation) {
    const locks = new B.b2MotionLocks();
    locks.linearX = locks.linearY = false;
    locks.angularZ = true;
    def.motionLocks = locks;
  }
  const id = B.b2CreateBody(world, def);
  for (const shape of body.shapes) addShape(id, shape);
  if (body.type === "dynamic") {
    const data = new B.b2MassData();
    data.mass = body.mass;
    data.center = at([0, 0]);
    data.rotationalInertia = inertiaOf(body);
    B.b2Body_SetMassData(id, data);
  }
  return id;
}

function frame(anchor) {
  const out = new B.b2Transform();
  out.p = at(anchor);
  out.q = B.b2MakeRot(0);
  return out;
}

function addJoint(world, joint, a, b) {
  const distance = joint.type === "distance";
  const def = distance ? B.b2DefaultDistanceJointDef() : B.b2DefaultRevoluteJointDef();
  const base = def.base;
  base.bodyIdA = a;
  base.bodyIdB = b;
  base.localFrameA = frame(joint.anchor_a);
  base.localFrameB = frame(joint.anchor_b);
  base.collideConnected = joint.collide;
  def.base = base;
  if (distance) def.length = joint.length;
  return distance ? B.b2CreateDistanceJoint(world, def) : B.b2CreateRevoluteJoint(world, def);
}

// Box2D v3 takes one rule for all pairs as a callback: a function of the coefficients alone.
function equalise(world, scene) {
  const { friction, restitution } = scene.contact_rules;
  B.b2World_SetFrictionCallback(world, (a, _ma, b) => combine(friction, a, b));
  B.b2World_SetRestitutionCallback(world, (a, _ma, b) => combine(restitution, a, b));
}

let kept = null;

function create(scene, settings) {
  const def = B.b2DefaultWorldDef();
  def.gravity = at(scene.gravity);
  def.enableSleep = outOfTheBox;
  if (!outOfTheBox) {
    def.restitutionThreshold = scene.contact_rules.restitution_threshold;
    def.maximumLinearSpeed = 1e5;
  }
  if (kept) B.b2DestroyWorld(kept);
  const world = kept = B.b2CreateWorld(def);
  const usual = scene.contact_rules.friction === "geometric_mean" && scene.contact_rules.restitution === "maximum";
  if (!outOfTheBox && !usual) equalise(world, scene);
  const bodies = scene.bodies.map((body) => addBody(world, body));
  const ground = B.b2CreateBody(world, B.b2DefaultBodyDef());
  const called = (name) => name === "world" ? ground : bodies[scene.bodies.findIndex((body) => body.name === name)];
  for (const joint of scene.joints) addJoint(world, joint, called(joint.body_a), called(joint.body_b));
  const inner = Number(settings.options.soft_substeps);
  return {
    wraps: true,
    effective: { soft_substeps: inner, sleeping: outOfTheBox ? "on" : "off",
                 restitution_threshold: B.b2World_GetRestitutionThreshold(world) + " m/s", contact_hertz: 30,
                 ...(outOfTheBox ? { contact_rules: "friction geometric mean, restitution maximum" } : contactRules(scene)) },
    step() { B.b2World_Step(world, settings.substep, inner); },
    state(i) {
      const p = B.b2Body_GetWorldCenterOfMass(bodies[i]), v = B.b2Body_GetLinearVelocity(bodies[i]);
      const q = B.b2Body_GetRotation(bodies[i]);
      const out = [p.x, p.y, Math.atan2(q.s, q.c), v.x, v.y, B.b2Body_GetAngularVelocity(bodies[i])];
      p.delete?.(); v.delete?.(); q.delete?.();
      return out;
    },
    push(i, x, y, torque) {
      B.b2Body_ApplyForceToCenter(bodies[i], at([x, y]), true);
      B.b2Body_ApplyTorque(bodies[i], torque, true);
    },
  };
}

serve({
  name: "box2d3", version: versionOf("box2d3-wasm"), precision: "float", summary: "Box2D v3 in WebAssembly", scheme: "soft_step", innerSubsteps: 4,
  limits: "Box2D v3 solves contacts and joints as soft constraints of 30 and 60 Hz in 4 substeps, leaves a slop of 5 mm, and " +
    "applies restitution at the end of the step.",
  joints: ["revolute", "distance"], features: ["contacts", "filters", "kinematic", "fixed_rotation"],
  options: [{ name: "soft_substeps", fallback: "4", help: "Box2D substeps per step" }],
  create,
});
