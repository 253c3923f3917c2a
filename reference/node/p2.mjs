//! package: p2-es
//! version: 1.2.3
//! summary: p2 in JavaScript: constraints as stiff springs (SPOOK), solved by Gauss-Seidel
import { outOfTheBox, requireFrom, serve, versionOf } from "./support/serve.mjs";
import { combine, contactRules, filtersFit, inertiaOf } from "./support/scene.mjs";

const p2 = requireFrom("p2-es");

function addBody(body, materialOf) {
  const out = new p2.Body({
    mass: body.type === "dynamic" ? body.mass : 0, position: [...body.position], angle: body.angle, velocity: [...body.velocity],
    angularVelocity: body.angular_velocity, fixedRotation: body.fixed_rotation, gravityScale: body.gravity_scale,
    type: { dynamic: p2.Body.DYNAMIC, static: p2.Body.STATIC, kinematic: p2.Body.KINEMATIC }[body.type],
    ...(outOfTheBox ? {} : { damping: 0, angularDamping: 0 }),
  });
  for (const shape of body.shapes) {
    const geometry = shape.type === "circle" ? new p2.Circle({ radius: shape.radius })
      : new p2.Box({ width: shape.width, height: shape.height });
    geometry.collisionGroup = shape.filter.category;
    geometry.collisionMask = shape.filter.mask;
    geometry.material = materialOf(shape);
    out.addShape(geometry, [...shape.position], shape.angle);
  }
  if (body.type === "dynamic" && !body.fixed_rotation) {
    out.inertia = inertiaOf(body);
    out.invInertia = out.invInertiaSolve = 1 / out.inertia;
  }
  return out;
}

// A contact's coefficients are those of two materials, so creates one material per pair of coefficients.
function materials(scene, world) {
  const known = new Map();
  const { friction, restitution } = scene.contact_rules;
  return (shape) => {
    const key = shape.friction + " " + shape.restitution;
    if (!known.has(key)) {
      known.set(key, { material: new p2.Material(), shape });
      for (const other of known.values())
        world.addContactMaterial(new p2.ContactMaterial(known.get(key).material, other.material, {
          friction: combine(friction, shape.friction, other.shape.friction),
          restitution: combine(restitution, shape.restitution, other.shape.restitution),
        }));
    }
    return known.get(key).material;
  };
}

function create(scene, settings) {
  if (!filtersFit(scene, 31)) return "p2 has no filter groups";
  const world = new p2.World({ gravity: [...scene.gravity] });
  world.sleepMode = p2.World.NO_SLEEPING;
  world.solver.iterations = Number(settings.options.iterations);
  if (!outOfTheBox) {
    world.solver.tolerance = 0;
    world.solver.frictionIterations = 0;
  }
  const materialOf = materials(scene, world);
  const bodies = scene.bodies.map((body) => addBody(body, materialOf));
  for (const body of bodies) world.addBody(body);
  const ground = new p2.Body();
  world.addBody(ground);
  const called = (name) => name === "world" ? ground : bodies[scene.bodies.findIndex((body) => body.name === name)];
  for (const joint of scene.joints) {
    const a = called(joint.body_a), b = called(joint.body_b), collideConnected = joint.collide;
    world.addConstraint(joint.type === "distance"
      ? new p2.DistanceConstraint(a, b, { distance: joint.length, localAnchorA: joint.anchor_a, localAnchorB: joint.anchor_b, collideConnected })
      : new p2.RevoluteConstraint(a, b, { localPivotA: joint.anchor_a, localPivotB: joint.anchor_b, collideConnected }));
  }
  return {
    effective: { iterations: world.solver.iterations, stiffness: 1e6, relaxation: 4, sleeping: "off",
                 damping: outOfTheBox ? 0.1 : 0, ...contactRules(scene) },
    step() { world.step(settings.substep); },
    state(i) {
      const body = bodies[i];
      return [body.position[0], body.position[1], body.angle, body.velocity[0], body.velocity[1], body.angularVelocity];
    },
    push(i, x, y, torque) {
      bodies[i].force[0] += x;
      bodies[i].force[1] += y;
      bodies[i].angularForce += torque;
    },
  };
}

serve({
  name: "p2", version: versionOf("p2-es"), precision: "float", summary: "p2 in JavaScript",
  limits: "p2 solves contacts and joints as soft constraints that yield under load, and limits friction by an estimate of " +
    "the weight, not by the contact's normal force.",
  joints: ["revolute", "distance"], features: ["contacts", "filters", "kinematic", "fixed_rotation"],
  options: [{ name: "iterations", fallback: "10", help: "iterations per substep" }],
  create,
});
