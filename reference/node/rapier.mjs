//! package: @dimforge/rapier2d-compat
//! version: 0.19.3
//! summary: Rapier 2D, compiled to WebAssembly: soft constraints swept by the substep
import { fileOf, outOfTheBox, requireFrom, serve, versionOf } from "./support/serve.mjs";
import { contactRules, filtersFit, inertiaOf } from "./support/scene.mjs";

const kPackage = "@dimforge/rapier2d-compat";
const RAPIER = await loadRapier();

// Old versions are CommonJS only; new ones have a module too.
async function loadRapier() {
  const found = requireFrom(kPackage);
  await found.init();
  return found;
}

// Rapier has no geometric mean, but the product of square roots is one.
const kRules = { geometric_mean: "Multiply", product: "Multiply", maximum: "Max", minimum: "Min", average: "Average" };
const rule = (name) => RAPIER.CoefficientCombineRule[kRules[name]];
const share = (name, value) => name === "geometric_mean" ? Math.sqrt(value) : value;
const at = ([x, y]) => ({ x, y });

function whyNot(scene) {
  if (!filtersFit(scene, 16)) return "Rapier has 16 bits for filters, and no groups";
  return "";
}

function addShape(world, scene, body, shape) {
  const description = shape.type === "circle" ? RAPIER.ColliderDesc.ball(shape.radius)
    : RAPIER.ColliderDesc.cuboid(shape.width / 2, shape.height / 2);
  const { friction, restitution } = scene.contact_rules, { category, mask } = shape.filter;
  description.setTranslation(...shape.position).setRotation(shape.angle).setDensity(0)
    .setCollisionGroups(((category << 16) | (mask & 0xffff)) >>> 0);
  description.setFriction(outOfTheBox ? shape.friction : share(friction, shape.friction))
    .setRestitution(outOfTheBox ? shape.restitution : share(restitution, shape.restitution));
  if (!outOfTheBox) description.setFrictionCombineRule(rule(friction)).setRestitutionCombineRule(rule(restitution));
  world.createCollider(description, body);
}

function addBody(world, scene, body) {
  const make = { dynamic: "dynamic", static: "fixed", kinematic: "kinematicVelocityBased" }[body.type];
  const description = RAPIER.RigidBodyDesc[make]().setTranslation(...body.position).setRotation(body.angle)
    .setLinvel(...body.velocity).setAngvel(body.angular_velocity).setGravityScale(body.gravity_scale)
    .setCanSleep(outOfTheBox);
  if (body.type === "dynamic") description.setAdditionalMassProperties(body.mass, { x: 0, y: 0 }, inertiaOf(body));
  if (body.fixed_rotation) description.lockRotations();
  const out = world.createRigidBody(description);
  for (const shape of body.shapes) addShape(world, scene, out, shape);
  return out;
}

function create(scene, settings) {
  const reason = whyNot(scene);
  if (reason) return reason;
  const world = new RAPIER.World(at(scene.gravity));
  world.timestep = settings.substep;
  if (settings.options.solver_iterations !== "") world.numSolverIterations = Number(settings.options.solver_iterations);
  const bodies = scene.bodies.map((body) => addBody(world, scene, body));
  const ground = world.createRigidBody(RAPIER.RigidBodyDesc.fixed());
  const called = (name) => name === "world" ? ground : bodies[scene.bodies.findIndex((body) => body.name === name)];
  for (const joint of scene.joints) {
    const data = RAPIER.JointData.revolute(at(joint.anchor_a), at(joint.anchor_b));
    const made = world.createImpulseJoint(data, called(joint.body_a), called(joint.body_b), true);
    made.setContactsEnabled?.(joint.collide);
  }
  const pushed = new Set();
  return {
    wraps: true,
    effective: { solver_iterations: world.numSolverIterations ?? "the engine's", sleeping: outOfTheBox ? "on" : "off",
                 damping: "none", ...(outOfTheBox ? { contact_rules: "average" } : contactRules(scene)),
                 length_unit: world.lengthUnit ?? 1 },
    step() {
      world.step();
      for (const body of pushed) { body.resetForces(false); body.resetTorques(false); }
      pushed.clear();
    },
    state(i) {
      const p = bodies[i].translation(), v = bodies[i].linvel();
      return [p.x, p.y, bodies[i].rotation(), v.x, v.y, bodies[i].angvel()];
    },
    push(i, x, y, torque) {
      bodies[i].addForce({ x, y }, true);
      bodies[i].addTorque(torque, true);
      pushed.add(bodies[i]);
    },
    free() { world.free(); },
  };
}

// Since 0.12 a step has its own substeps, as many as there are solver iterations.
const version = versionOf(kPackage);
const [major, minor] = version.split(".").map(Number);
const inner = major > 0 || minor >= 12;

serve({
  name: "rapier", version, innerSubsteps: inner ? 4 : 1, scheme: inner ? "soft_step" : "semi_implicit_euler", precision: "float", summary: "Rapier 2D in WebAssembly",
  limits: "Rapier solves contacts and joints as soft constraints with a few iterations per step, and does not place impacts " +
    "within the step. Loads and impacts that pass through several bodies are resolved only in part.",
  joints: ["revolute"], features: ["contacts", "filters", "kinematic", "fixed_rotation"],
  options: [{ name: "solver_iterations", fallback: "", help: "iterations per step (default: the version's own)" }],
  create,
});
