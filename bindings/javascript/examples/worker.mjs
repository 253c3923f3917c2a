// plumb as an engine behind the process protocol (docs/protocol.md):
// plumb compare --engine-command "mine=node worker.mjs". Scenes run in a World, in double.
import readline from "node:readline";
import {World} from "plumb-physics";

const kHello = {
  protocol: 1, name: "plumb from JavaScript", version: "0.1.0", precision: "double",
  summary: "plumb's world in WebAssembly",
  method: {scheme: "soft_step", order: 2, epsilon: 2.220446049250313e-16, substeps: 4},
  shapes: ["circle", "box"], joints: ["revolute", "distance"], forces: ["linear_drag", "torque"],
  features: ["contacts", "filters", "kinematic", "fixed_rotation"],
};
const point = ([x, y]) => ({x, y});
const inertias = {
  circle: ({radius}) => radius * radius / 2,
  box: ({width, height}) => (width * width + height * height) / 12,
};

function shapeOf({type, position, angle, friction, restitution, filter, ...geometry}) {
  const sides = type === "circle" ? {radius: geometry.radius} : {width: geometry.width, height: geometry.height};
  return {[type]: sides, position: point(position), angle, friction, restitution, filter};
}

function bodyOf(body) {
  const made = {name: body.name, type: body.type, position: point(body.position), angle: body.angle,
    velocity: point(body.velocity), angularVelocity: body.angular_velocity, shapes: body.shapes.map(shapeOf)};
  if (body.type !== "dynamic") return made;
  const [shape] = body.shapes;
  const inertia = body.inertia ?? (shape ? body.mass * inertias[shape.type](shape) : 0);
  return {...made, mass: {mass: body.mass, inertia: inertia || 1}, lockRotation: body.fixed_rotation || !inertia};
}

class Run {
  constructor(scene, {dt, substeps = 4}) {
    const rules = scene.contact_rules;
    this.world = new World({precision: "double", gravity: point(scene.gravity), sleeping: false,
      combineFriction: rules.friction, combineRestitution: rules.restitution});
    this.dt = dt;
    this.substeps = substeps;
    this.forces = scene.forces;
    this.bodies = new Map(scene.bodies.map((body) => [body.name, this.world.createBody(bodyOf(body))]));
    this.count = scene.bodies.length;
    for (const joint of scene.joints) {
      const [a, b] = [joint.body_a, joint.body_b].map((name) => this.body(name));
      this.world.createJoint(a, b, joint.type, {anchorA: point(joint.anchor_a), anchorB: point(joint.anchor_b),
        collide: joint.collide, ...(joint.type === "distance" ? {length: joint.length} : {})});
    }
  }
  /// The body of a name, or one that stays where it is for "world".
  body(name) {
    if (name === "world" && !this.bodies.has(name)) this.bodies.set(name, this.world.createBody({type: "static"}));
    return this.bodies.get(name);
  }
  step() {
    const {time} = this.world;
    for (const {type, body: name, coefficient = 0, angular_coefficient: angular = 0, torque, start, duration} of this.forces) {
      const body = this.body(name);
      if (type === "torque") {
        if (time >= start && (duration === undefined || time < start + duration)) body.applyTorque(torque);
      } else {
        const {x, y} = body.velocity;
        body.applyForce({x: -coefficient * x, y: -coefficient * y});
        body.applyTorque(-angular * body.angularVelocity);
      }
    }
    this.world.step(this.dt, this.substeps);
  }
  states() {
    const {poses} = this.world, {velocities} = this.world;
    return Array.from({length: this.count}, (_, i) =>
      [...poses.subarray(3 * i, 3 * i + 3), ...velocities.subarray(3 * i, 3 * i + 3)]);
  }
}

let run = null;
function* answer(request) {
  if (request.request === "hello") {
    yield kHello;
  } else if (request.request === "load") {
    run?.world.destroy();
    run = null;
    if (request.scene.contact_rules.restitution_threshold > 0)
      return yield {unsupported: "a World's own threshold follows from gravity and the step"};
    run = new Run(request.scene, request.settings);
    yield {effective_settings: {dt: run.dt, substeps: run.substeps, sleeping: "off"}};
  } else {
    let spent = 0;
    for (let sample = 0; sample < request.samples; ++sample) {
      const before = performance.now();
      for (let i = 0; i < request.every; ++i) run.step();
      spent += performance.now() - before;
      yield {t: run.world.time, states: run.states()};
    }
    yield {done: true, ns: Math.round(1e6 * spent)};
  }
}

for await (const line of readline.createInterface({input: process.stdin})) {
  const request = JSON.parse(line);
  if (request.request === "quit") break;
  try {
    for (const reply of answer(request)) process.stdout.write(`${JSON.stringify(reply)}\n`);
  } catch (error) {
    process.stdout.write(`${JSON.stringify({error: {kind: "run", problem: error.message}})}\n`);
  }
}
process.exit();
