// A physics engine to start from: one ball that falls and bounces off walls. Run it through the course with
//
//     plumb check -- node docs/course/starters/ball.js
//
// plumb sends one JSON object a line, and wants one back: docs/protocol.md. Chapter 1 passes; the rest is yours.
const readline = require("readline");

const hello = {
  protocol: 1, name: "ball", version: "1", precision: "double",
  method: { scheme: "semi_implicit_euler", order: 1, epsilon: 2.220446049250313e-16 },
  shapes: ["circle", "box"], features: ["contacts"], joints: [], forces: [],
};

// What this engine cannot do about a scene; empty where it can.
function whyNot(scene) {
  const moving = scene.bodies.filter((body) => body.type === "dynamic");
  if (moving.length !== 1) return "only one body may move: go on with chapter 2";
  for (const body of scene.bodies) {
    for (const shape of body.shapes) {
      if (shape.type !== (body === moving[0] ? "circle" : "box"))
        return "the ball is a circle, and all else is boxes that stand still: go on with chapter 3";
      if (body.angle || shape.angle || shape.friction) return "nothing is tilted or rough: go on with chapter 4";
    }
  }
  return "";
}

class Engine {
  load(scene, settings) {
    this.dt = settings.dt;
    this.steps = 0;
    this.gravity = scene.gravity;
    this.bodies = scene.bodies;
    this.ball = this.bodies.find((body) => body.type === "dynamic");
    this.walls = this.bodies.filter((body) => body !== this.ball);
  }

  step() {
    const { position, velocity } = this.ball;
    for (const axis of [0, 1]) {
      velocity[axis] += this.gravity[axis] * this.dt; // the velocity first,
      position[axis] += velocity[axis] * this.dt; // then the position with the new velocity
    }
    for (const wall of this.walls) for (const shape of wall.shapes) this.bounce(wall, shape);
    this.steps += 1;
  }

  bounce(wall, box) {
    const { position, velocity } = this.ball;
    const circle = this.ball.shapes[0];
    const centre = [0, 1].map((axis) => wall.position[axis] + box.position[axis]);
    const half = [box.width / 2, box.height / 2];
    // The point of the box that is nearest to the ball's centre, and the way from there to the centre.
    const nearest = [0, 1].map((axis) =>
      Math.min(Math.max(position[axis], centre[axis] - half[axis]), centre[axis] + half[axis]));
    const way = [position[0] - nearest[0], position[1] - nearest[1]];
    const distance = Math.hypot(way[0], way[1]);
    if (distance >= circle.radius || distance === 0) return;
    const normal = [way[0] / distance, way[1] / distance];
    for (const axis of [0, 1]) position[axis] += normal[axis] * (circle.radius - distance); // out of the wall
    const closing = velocity[0] * normal[0] + velocity[1] * normal[1];
    if (closing >= 0) return; // it moves away already
    let bounciness = Math.max(circle.restitution, box.restitution);
    const pull = Math.hypot(this.gravity[0], this.gravity[1]);
    if (-closing <= 2 * pull * this.dt) bounciness = 0; // no more than what gravity added: it rests
    for (const axis of [0, 1]) velocity[axis] -= (1 + bounciness) * closing * normal[axis];
  }

  states() {
    return this.bodies.map((body) => [
      ...body.position, body.angle + body.angular_velocity * this.steps * this.dt,
      ...body.velocity, body.angular_velocity,
    ]);
  }
}

const engine = new Engine();
const send = (message) => process.stdout.write(JSON.stringify(message) + "\n");

readline.createInterface({ input: process.stdin }).on("line", (line) => {
  const message = JSON.parse(line);
  if (message.request === "hello") {
    send(hello);
  } else if (message.request === "load") {
    const reason = whyNot(message.scene);
    if (reason) return send({ unsupported: reason });
    engine.load(message.scene, message.settings);
    send({ effective_settings: { dt: engine.dt, resting_speed: "2 g dt" } });
  } else if (message.request === "run") {
    let spent = 0;
    for (let sample = 0; sample < message.samples; ++sample) {
      const start = process.hrtime.bigint();
      for (let step = 0; step < message.every; ++step) engine.step();
      spent += Number(process.hrtime.bigint() - start);
      send({ t: engine.steps * engine.dt, states: engine.states() });
    }
    send({ done: true, ns: spent });
  } else if (message.request === "quit") {
    process.exit(0);
  }
});
