//! package: matter-js
//! version: 0.20.0
//! summary: matter-js in JavaScript: Verlet steps, positions and velocities swept
import { outOfTheBox, requireFrom, serve, versionOf } from "./support/serve.mjs";
import { combine, contactRules, inertiaOf, mayTouch } from "./support/scene.mjs";

const Matter = requireFrom("matter-js");
const { Bodies, Body, Constraint, Composite, Engine, Events } = Matter;
const kScale = 100; // pixels per metre: matter's slop and thresholds are in pixels
const kFrame = 60; // 1/s: velocities are in pixels per frame, whatever the step is

const joined = new Set();
const pair = (a, b) => Math.min(a, b) + " " + Math.max(a, b);
Matter.Detector.canCollide = (a, b) => mayTouch(a.filter, b.filter) && !joined.has(pair(a.index, b.index));

function whyNot(scene) {
  for (const body of scene.bodies) {
    if (body.gravity_scale !== 1) return "matter-js has one gravity for all bodies";
    if (body.shapes.length > 1) return "bodies of several shapes are not mapped: matter-js moves their origin";
    for (const shape of body.shapes)
      if (shape.position.some((x) => x !== 0) || shape.angle !== 0) return "shapes off their body's origin are not mapped";
  }
  return "";
}

function addBody(body, index) {
  const [x, y] = body.position.map((p) => p * kScale), shape = body.shapes[0];
  const options = { isStatic: body.type === "static", angle: 0, sleepThreshold: 60 };
  if (shape) Object.assign(options, { friction: shape.friction, restitution: shape.restitution,
                                      collisionFilter: { index, filter: shape.filter, shape } });
  else options.collisionFilter = { index, filter: { group: 0, category: 0, mask: 0 } };
  if (!outOfTheBox) Object.assign(options, { frictionAir: 0, frictionStatic: 1 });
  const out = !shape || shape.type === "circle" ? Bodies.circle(x, y, kScale * (shape?.radius ?? 0.01), options)
    : Bodies.rectangle(x, y, kScale * shape.width, kScale * shape.height, options);
  Body.setAngle(out, body.angle);
  if (body.type !== "dynamic") return out;
  Body.setMass(out, body.mass);
  Body.setInertia(out, body.fixed_rotation ? Infinity : inertiaOf(body) * kScale ** 2);
  Body.setVelocity(out, { x: body.velocity[0] * kScale / kFrame, y: body.velocity[1] * kScale / kFrame });
  Body.setAngularVelocity(out, body.angular_velocity / kFrame);
  return out;
}

const turned = ([x, y], angle) => ({ x: kScale * (Math.cos(angle) * x - Math.sin(angle) * y),
                                     y: kScale * (Math.sin(angle) * x + Math.cos(angle) * y) });

function create(scene, settings) {
  const reason = whyNot(scene);
  if (reason) return reason;
  joined.clear();
  const rules = scene.contact_rules;
  const engine = Engine.create({ enableSleeping: false });
  engine.gravity = { x: scene.gravity[0] * kScale, y: scene.gravity[1] * kScale, scale: 1e-6 };
  engine.positionIterations = Number(settings.options.position_iterations);
  engine.velocityIterations = Number(settings.options.velocity_iterations);
  engine.constraintIterations = Number(settings.options.constraint_iterations);
  const bodies = scene.bodies.map(addBody);
  Composite.add(engine.world, bodies);
  const find = (name) => scene.bodies.findIndex((body) => body.name === name);
  for (const joint of scene.joints) {
    const a = find(joint.body_a), b = find(joint.body_b), ends = {};
    if (!joint.collide) joined.add(pair(a, b));
    ends.pointA = turned(joint.anchor_a, a < 0 ? 0 : scene.bodies[a].angle);
    ends.pointB = turned(joint.anchor_b, b < 0 ? 0 : scene.bodies[b].angle);
    if (a >= 0) ends.bodyA = bodies[a];
    if (b >= 0) ends.bodyB = bodies[b];
    Composite.add(engine.world, Constraint.create({ ...ends, stiffness: 1, length: joint.type === "distance" ? joint.length * kScale : 0 }));
  }
  if (!outOfTheBox) {
    const equalise = ({ pairs }) => {
      for (const each of pairs) {
        // Uses the scene's friction, because matter-js gives every static body a friction of 1.
        const a = each.collision.parentA.collisionFilter.shape, b = each.collision.parentB.collisionFilter.shape;
        each.friction = combine(rules.friction, a.friction, b.friction);
        each.restitution = combine(rules.restitution, a.restitution, b.restitution);
      }
    };
    Events.on(engine, "collisionStart", equalise);
    Events.on(engine, "collisionActive", equalise);
  }
  return {
    effective: { position_iterations: engine.positionIterations, velocity_iterations: engine.velocityIterations,
                 constraint_iterations: engine.constraintIterations, scale: kScale + " pixels a metre", sleeping: "off",
                 friction_air: outOfTheBox ? 0.01 : 0,
                 ...(outOfTheBox ? { contact_rules: "friction minimum, restitution maximum" } : contactRules(scene)),
                 slop: "0.05 pixels", circles: "polygons of up to 26 sides" },
    step() { Engine.update(engine, 1000 * settings.substep); },
    state(i) {
      const body = bodies[i], v = Body.getVelocity(body);
      return [body.position.x / kScale, body.position.y / kScale, body.angle, v.x * kFrame / kScale, v.y * kFrame / kScale,
              Body.getAngularVelocity(body) * kFrame];
    },
    push(i, x, y, torque) {
      bodies[i].force.x += x * kScale * 1e-6;
      bodies[i].force.y += y * kScale * 1e-6;
      bodies[i].torque += torque * kScale ** 2 * 1e-6;
    },
  };
}

serve({
  name: "matter", version: versionOf("matter-js"), precision: "double", summary: "matter-js in JavaScript",
  limits: "matter-js approximates circles by polygons, drops restitution below 2 pixels per frame, has its own rule of " +
    "friction, and closes joints by a few position iterations per step, which changes the energy.",
  joints: ["revolute", "distance"], features: ["contacts", "filters", "fixed_rotation"],
  options: [{ name: "position_iterations", fallback: "6", help: "position iterations per substep" },
            { name: "velocity_iterations", fallback: "4", help: "velocity iterations per substep" },
            { name: "constraint_iterations", fallback: "2", help: "sweeps over constraints a substep" }],
  create,
});
