#!/usr/bin/env node
// Times plumb beside box2d3-wasm and rapier2d-compat in this one process: the same scenes, the same steps, in turns.
//   node compare.mjs PACKAGE FOLDER [--check]
// FOLDER is where `npm install box2d3-wasm @dimforge/rapier2d-compat` was run. --check exits with 1 if plumb is behind in a
// scene of up to 200 bodies. All engines: float, 60 steps a second, 4 substeps (Rapier: 4 solver iterations), no sleep.
import path from "node:path";
import {createRequire} from "node:module";
import {pathToFileURL} from "node:url";

const [packed, folder, check] = process.argv.slice(2);
const resolve = createRequire(path.resolve(folder, "package.json")).resolve;
const load = (file) => import(pathToFileURL(file));
const {World} = await load(path.resolve(packed, "plumb.mjs"));
const box2d = await (await load(path.join(path.resolve(folder),
  "node_modules/box2d3-wasm/build/dist/es/compat/Box2D.compat.mjs"))).default();
const rapierFile = resolve("@dimforge/rapier2d-compat");
const loadedRapier = await load(rapierFile);
const rapier = loadedRapier.World ? loadedRapier : loadedRapier.default;
await rapier.init();

// Each engine: world(), box(world, fixed, x, y, width, height), circle, joint, step.
const engines = {
  plumb: {
    world: () => new World({sleeping: false}),
    add: (world, fixed, x, y, shape) => world.createBody({type: fixed ? "static" : "dynamic", position: {x, y}, shapes: [shape]}),
    box(world, fixed, x, y, width, height) { return this.add(world, fixed, x, y, {box: {width, height}}); },
    circle(world, x, y, radius) { return this.add(world, false, x, y, {circle: {radius}}); },
    hinge: (world, a, b, ax, bx) => world.createJoint(a, b, "revolute", {anchorA: {x: ax, y: 0}, anchorB: {x: bx, y: 0}}),
    step: (world) => world.step(1 / 60, 4),
  },
  box2d: {
    world() {
      const def = box2d.b2DefaultWorldDef();
      def.gravity = new box2d.b2Vec2(0, -9.81);
      def.enableSleep = false;
      return box2d.b2CreateWorld(def);
    },
    body(world, fixed, x, y) {
      const def = box2d.b2DefaultBodyDef();
      def.type = fixed ? box2d.b2BodyType.b2_staticBody : box2d.b2BodyType.b2_dynamicBody;
      def.position = new box2d.b2Vec2(x, y);
      return box2d.b2CreateBody(world, def);
    },
    box(world, fixed, x, y, width, height) {
      const id = this.body(world, fixed, x, y);
      box2d.b2CreatePolygonShape(id, box2d.b2DefaultShapeDef(), box2d.b2MakeBox(width / 2, height / 2));
      return id;
    },
    circle(world, x, y, radius) {
      const id = this.body(world, false, x, y), circle = new box2d.b2Circle();
      circle.center = new box2d.b2Vec2(0, 0);
      circle.radius = radius;
      box2d.b2CreateCircleShape(id, box2d.b2DefaultShapeDef(), circle);
      return id;
    },
    hinge(world, a, b, ax, bx) {
      const def = box2d.b2DefaultRevoluteJointDef(), base = def.base;
      const frame = (x) => {
        const out = new box2d.b2Transform();
        out.p = new box2d.b2Vec2(x, 0);
        out.q = box2d.b2MakeRot(0);
        return out;
      };
      base.bodyIdA = a, base.bodyIdB = b, base.localFrameA = frame(ax), base.localFrameB = frame(bx);
      def.base = base;
      box2d.b2CreateRevoluteJoint(world, def);
    },
    step: (world) => box2d.b2World_Step(world, 1 / 60, 4),
  },
  rapier: {
    world() {
      const world = new rapier.World({x: 0, y: -9.81});
      world.timestep = 1 / 60;
      return world;
    },
    body: (world, fixed, x, y) => world.createRigidBody(
      (fixed ? rapier.RigidBodyDesc.fixed() : rapier.RigidBodyDesc.dynamic()).setTranslation(x, y).setCanSleep(false)),
    box(world, fixed, x, y, width, height) {
      const body = this.body(world, fixed, x, y);
      world.createCollider(rapier.ColliderDesc.cuboid(width / 2, height / 2), body);
      return body;
    },
    circle(world, x, y, radius) {
      const body = this.body(world, false, x, y);
      world.createCollider(rapier.ColliderDesc.ball(radius), body);
      return body;
    },
    hinge(world, a, b, ax, bx) {
      const joint = rapier.JointData.revolute({x: ax, y: 0}, {x: bx, y: 0});
      world.createImpulseJoint(joint, a, b, true).setContactsEnabled?.(false);
    },
    step: (world) => world.step(),
  },
};

function pyramid(e, world, rows) {
  e.box(world, true, 0, -1, 100, 2);
  for (let row = 0; row < rows; ++row)
    for (let i = 0; i < rows - row; ++i) e.box(world, false, i + row / 2 - rows / 2, row + 0.5, 1, 1);
}
function heap(e, world, count) {
  e.box(world, true, 0, -1, 22, 2), e.box(world, true, -11, 20, 1, 50), e.box(world, true, 11, 20, 1, 50);
  for (let i = 0; i < count; ++i) {
    const x = -9 + (i % 10) * 1.9 + 0.1 * Math.floor(i / 10) % 1, y = 1 + 1.1 * Math.floor(i / 10);
    if (i % 2) e.circle(world, x, y, 0.5); else e.box(world, false, x, y, 0.9, 0.9);
  }
}
function chains(e, world, count, links) {
  for (let i = 0; i < count; ++i) {
    let last = e.box(world, true, 0, 5 * i, 0.2, 0.2);
    for (let k = 0; k < links; ++k) {
      const link = e.box(world, false, 0.5 + k, 5 * i, 0.8, 0.2);
      e.hinge(world, last, link, k === 0 ? 0 : 0.5, -0.5);
      last = link;
    }
  }
}
const scenes = {
  "stack of 10 boxes": [10, (e, world) => {
    e.box(world, true, 0, -1, 100, 2);
    for (let i = 0; i < 10; ++i) e.box(world, false, 0, i + 0.5, 1, 1);
  }],
  "pyramid of 55 boxes": [55, (e, world) => pyramid(e, world, 10)],
  "pyramid of 190 boxes": [190, (e, world) => pyramid(e, world, 19)],
  "heap of 100 boxes and discs": [100, (e, world) => heap(e, world, 100)],
  "heap of 200 boxes and discs": [200, (e, world) => heap(e, world, 200)],
  "10 chains of 10 links": [100, (e, world) => chains(e, world, 10, 10)],
  "200 discs in free flight": [200, (e, world) => {
    for (let i = 0; i < 200; ++i) e.circle(world, 3 * (i % 20), 3 * Math.floor(i / 20), 0.5);
  }],
  "heap of 1000 boxes and discs": [1000, (e, world) => heap(e, world, 1000)],
};

const kWarm = 120, kBlocks = 60, kSteps = 5;
let behind = 0;
console.log("us a step, the quietest of 60 blocks in turns; ratio: theirs / ours");
for (const [name, [bodies, build]] of Object.entries(scenes)) {
  const runs = Object.entries(engines).map(([of, e]) => {
    const world = e.world();
    build(e, world);
    for (let i = 0; i < kWarm; ++i) e.step(world);
    return {of, e, world, best: Infinity};
  });
  for (let block = 0; block < kBlocks; ++block) {
    for (const run of runs) {
      const start = process.hrtime.bigint();
      for (let i = 0; i < kSteps; ++i) run.e.step(run.world);
      run.best = Math.min(run.best, Number(process.hrtime.bigint() - start) / 1000 / kSteps);
    }
  }
  const [ours, ...theirs] = runs;
  const parts = theirs.map(({of, best}) => `${of} ${best.toFixed(1)} (${(best / ours.best).toFixed(2)})`);
  const better = theirs.every(({best}) => best >= ours.best);
  if (!better && bodies <= 200) ++behind;
  console.log(`${name.padEnd(30)} plumb ${ours.best.toFixed(1)}, ${parts.join(", ")}${better ? "" : "  behind"}`);
  ours.world.destroy();
}
console.log(`${behind} scenes of up to 200 bodies in which plumb is behind`);
if (check === "--check" && behind > 0) process.exit(1);
