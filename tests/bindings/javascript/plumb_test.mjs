// The npm package in Node: node plumb_test.mjs PACKAGE
import assert from "node:assert/strict";
import {readFileSync, statSync} from "node:fs";
import path from "node:path";
import test from "node:test";
import {gzipSync} from "node:zlib";
import {Body, Chain, Joint, Rollback, Shape, World, folder, kG, near, withGround} from "./fixture.mjs";

test("a body in free flight follows its parabola", () => {
  const world = new World({precision: "double"});
  const ball = world.createBody({position: {x: 0, y: 10}, velocity: {x: 2, y: 1}, shapes: [{circle: {radius: 0.5}}]});
  world.step(1 / 60, 4, 60);
  near(ball.position.x, 2, 1e-12);
  near(ball.position.y, 11 - kG / 2, 1e-12);
  near(ball.mass, Math.PI / 4, 1e-12);
});

test("arrays have the poses and velocities of all bodies", () => {
  const {world} = withGround();
  const gone = world.createBody({position: {x: 5, y: 5}});
  const stays = world.createBody({position: {x: -5, y: 7}, angle: 0.5, velocity: {x: 1, y: 2}, angularVelocity: 3});
  gone.destroy();
  assert.deepEqual([...world.poses], [0, -1, 0, -5, 7, 0.5]);
  assert.deepEqual([...world.velocities].slice(3), [1, 2, 3]);
  assert.ok(world.bodies[1].equals(stays));
  assert.equal(gone.valid, false);
  for (let i = 0; i < 3000; ++i) world.createBody({position: {x: i, y: 50}});
  assert.equal(world.poses.length, 3 * 3002);
});

test("a saved state goes on to the same hash; damaged ones are refused", () => {
  const {world} = withGround();
  for (let i = 0; i < 5; ++i) world.createBody({position: {x: 0.05 * i, y: 0.5 + i}, shapes: [{box: {width: 1, height: 1}}]});
  world.step(1 / 60, 4, 30);
  const saved = world.save();
  world.step(1 / 60, 4, 60);
  const end = world.fullHash();
  world.restore(saved);
  world.step(1 / 60, 4, 60);
  assert.equal(world.fullHash(), end);
  saved[saved.length >> 1] ^= 1;
  assert.throws(() => world.restore(saved), /snapshot/);
  assert.equal(world.fullHash(), end);
});

test("joints of every kind are made, read and changed", () => {
  const {world, ground} = withGround();
  const kinds = {distance: {length: 3}, revolute: {}, prismatic: {}, weld: {}, wheel: {spring: {hertz: 4}}, motor: {maxForce: 10},
    mouse: {maxForce: 10, targetPosition: {x: 0, y: 3}}, gear: {}, pulley: {groundA: {x: 0, y: 9}, groundB: {x: 1, y: 9}},
    ratchet: {}, friction: {maxForce: 1}};
  for (const [kind, definition] of Object.entries(kinds)) {
    const wheel = world.createBody({position: {x: 0, y: 3}, shapes: [{circle: {radius: 0.5}, filter: {mask: 0}}]});
    const joint = world.createJoint(ground, wheel, kind, definition);
    assert.ok(joint instanceof Joint && joint.valid, kind);
    joint.destroy();
    wheel.destroy();
  }
  const wheel = world.createBody({position: {x: 0, y: 3}, shapes: [{circle: {radius: 0.5}}]});
  const motor = (speed) => ({anchorA: {x: 0, y: 4}, motor: {speed, maxForce: 1000}});
  const joint = world.createJoint(ground, wheel, "revolute", motor(2));
  world.step(1 / 60, 4, 60);
  near(wheel.angularVelocity, 2, 1e-4);
  joint.change("revolute", motor(-1));
  world.step(1 / 60, 4, 60);
  near(wheel.angularVelocity, -1, 1e-4);
  near(joint.read().force, wheel.mass * kG, 1e-2);
  assert.throws(() => joint.stiffness());
  joint.change("revolute", {anchorA: {x: 0, y: 4}, spring: {hertz: 1, dampingRatio: 0.5}});
  const w = 2 * Math.PI, inertia = joint.stiffness().angular / w ** 2;
  near(joint.stiffness().angularDamping, inertia * w, 1e-6);
  assert.equal(joint.stiffness().linear, 0);
});

test("queries, events, contacts and hooks", () => {
  const {world, ground} = withGround();
  const box = world.createBody({position: {x: 0, y: 3}, shapes: [{box: {width: 1, height: 1}, hitEvents: true, preSolve: true}]});
  const down = [{x: 0, y: 10}, {x: 0, y: -20}];
  assert.ok(world.rayCast(...down).body.equals(box));
  near(world.rayCast(...down).fraction, 6.5 / 20, 1e-7);
  assert.ok(world.rayCast(...down, {ignore: box}).body.equals(ground));
  assert.equal(world.rayCast({x: 0, y: 10}, {x: 0, y: 5}), null);
  assert.equal(world.shapesAt({x: 0, y: 3})[0].index, box.shapes[0].index);
  assert.equal(world.overlapShape({circle: {radius: 0.2}}, {x: 0.6, y: 3}).length, 1);
  near(world.nearest({x: 0, y: 5}, 10).distance, 1.5, 1e-6);
  near(world.castShape({circle: {radius: 0.5}}, {x: 0, y: 10}, 0, {x: 0, y: -20}).fraction, 0.3, 1e-6);
  const hits = [], seen = [];
  world.onPreSolve((contact) => { seen.push(contact); return true; });
  for (let i = 0; i < 60; ++i) {
    world.step();
    hits.push(...world.events.hits);
  }
  assert.equal(hits.length, 1);
  near(hits[0].speed, Math.sqrt(2 * kG * 2.5), 0.15);
  assert.ok(seen.length > 0 && Math.abs(Math.abs(seen[0].normal.y) - 1) < 1e-6);
  assert.equal(world.contacts.length, 1);
  assert.equal(world.contacts[0].points.length, 2);
  world.onPreSolve(() => false);
  world.step(1 / 60, 4, 60);
  assert.ok(box.position.y < -2);
});

test("a character walks, chains carry, and shapes change", () => {
  const world = new World();
  const ground = world.createBody({type: "static"});
  const chain = ground.createChain({points: [{x: -10, y: 0}, {x: 0, y: 0}, {x: 10, y: 0}].reverse()});
  assert.ok(chain instanceof Chain);
  let at = {x: 0, y: 0.02};
  const capsule = {start: {x: 0, y: 0.3}, end: {x: 0, y: 1}, radius: 0.3};
  let moved;
  for (let i = 0; i < 30; ++i) {
    moved = world.move(capsule, at, {x: 3, y: -1}, 1 / 60);
    at = moved.position;
    world.step();
  }
  assert.ok(moved.onGround);
  near(at.x, 1.5, 1e-3);
  const ball = world.createBody({position: {x: -5, y: 0.5}, shapes: [{circle: {radius: 0.5}}]});
  const [shape] = ball.shapes;
  assert.ok(shape instanceof Shape && shape.body instanceof Body);
  shape.material = {restitution: 0.5};
  assert.equal(shape.material.restitution, 0.5);
  near(shape.material.friction, 0.6, 1e-7);
});

test("bodies and shapes are changed after they were made, and asked alone", () => {
  const {world} = withGround();
  const body = world.createBody({position: {x: 0, y: 3}, shapes: [{box: {width: 1, height: 1}}]});
  const [shape] = body.shapes;
  body.name = "crate", body.userData = 7, shape.userData = 2n ** 63n, shape.density = 4;
  assert.deepEqual([body.name, body.userData, shape.userData, body.mass, shape.density], ["crate", 7n, 2n ** 63n, 4, 4]);
  assert.deepEqual(body.box, {lower: {x: -0.5, y: 2.5}, upper: {x: 0.5, y: 3.5}});
  assert.deepEqual(shape.box, body.box);
  assert.deepEqual(shape.rayCast({x: 0, y: 10}, {x: 0, y: -10}), {point: {x: 0, y: 3.5}, normal: {x: 0, y: 1}, fraction: 0.65});
  assert.equal(shape.rayCast({x: 2, y: 10}, {x: 0, y: -10}), null);
  assert.ok(shape.contains({x: 0.4, y: 3.4}) && !shape.contains({x: 0.6, y: 3}));
  body.enabled = false;
  for (let i = 0; i < 10; ++i) world.step();
  assert.ok(body.position.y === 3 && !body.enabled);
  body.enabled = true;
  shape.hitEvents = true;
  let hits = 0;
  for (let i = 0; i < 60; ++i) {
    world.step();
    hits += world.events.hits.length;
  }
  assert.equal(hits, 1);
  shape.sensor = true;
  assert.ok(shape.sensor);
});

test("the geometry of a shape is replaced, and all else stays", () => {
  const {world, ground} = withGround();
  const body = world.createBody({position: {x: 0, y: 0.5}, shapes: [{box: {width: 1, height: 1}, density: 2, hitEvents: true}]});
  const [shape] = body.shapes, [floor] = ground.shapes;
  for (let i = 0; i < 90; ++i) world.step();
  shape.setGeometry({capsule: {start: {x: 0, y: 0}, end: {x: 1, y: 0}, radius: 0.5}}, {x: 0, y: 1});
  assert.ok(shape.valid && shape.hitEvents && body.awake);
  assert.deepEqual(shape.definition.capsule, {start: {x: 0, y: 1}, end: {x: 1, y: 1}, radius: 0.5});
  near(body.mass, 2 * (1 + Math.PI / 4), 1e-5);
  floor.setGeometry({polygon: {points: [{x: -20, y: 0}, {x: 20, y: 0}, {x: 0, y: -3}]}}, {x: 0, y: 0.25}, 0);
  assert.deepEqual(floor.box.upper, {x: 20, y: -0.75});
  const before = world.fullHash();
  assert.throws(() => shape.setGeometry({box: {width: 1, height: -1}}), {kind: "InvalidValue", field: "height"});
  assert.throws(() => shape.setGeometry({circle: {radius: 1}}, {x: NaN, y: 0}), {field: "position"});
  assert.throws(() => shape.setGeometry({ball: 1}), {kind: "InvalidValue", field: "shape"});
  assert.throws(() => shape.setGeometry({circle: {radius: 1}}, undefined, "1"), {field: "angle"});
  assert.equal(world.fullHash(), before);
});

test("segments of a chain have their own materials", () => {
  const world = new World(), ground = world.createBody({type: "static"});
  const points = [{x: 4, y: 0}, {x: 0, y: 0}, {x: -4, y: 0}];
  const materials = [{friction: 0, restitution: 0.5, rollingResistance: 0, surfaceSpeed: 0},
    {friction: 0.75, restitution: 0, rollingResistance: 0, surfaceSpeed: 2}];
  const chain = ground.createChain({points, materials});
  assert.deepEqual(chain.segments.map((segment) => segment.material), materials);
  assert.deepEqual(chain.definition.materials, materials);
  assert.deepEqual(chain.definition.points, points);
  const again = ground.createChain(chain.definition);
  assert.deepEqual(again.definition, chain.definition);
  const even = ground.createChain({points, friction: 0.25, closed: true});
  assert.deepEqual([even.definition.friction, even.definition.closed, even.definition.materials], [0.25, true, undefined]);
  assert.throws(() => ground.createChain({points, materials: materials.slice(1)}), {kind: "InvalidValue", field: "materials"});
  assert.throws(() => ground.createChain({points, materials: [{}, {frition: 1}]}), {kind: "UnknownName", field: "frition"});
  assert.throws(() => chain.segments[0].setGeometry({circle: {radius: 1}}), {kind: "InvalidValue", field: "handle"});
});

test("the contact of a begin event is found by its shapes", () => {
  const {world, ground} = withGround();
  const ball = world.createBody({position: {x: 0, y: 0.6}, shapes: [{circle: {radius: 0.5}, hitEvents: true}]});
  const [shape] = ball.shapes, [floor] = ground.shapes;
  assert.equal(shape.contact(floor), null);
  let begun = 0;
  for (let i = 0; i < 30; ++i) {
    world.step();
    for (const {shapeA, shapeB} of world.events.begin) {
      const contact = shapeA.contact(shapeB);
      assert.deepEqual(shapeB.contact(shapeA), contact);
      assert.ok(contact.stepImpulse > 0 && contact.points.length === 1);
      near(contact.points[0].point.y, 0, 0.02);
      ++begun;
    }
  }
  assert.equal(begun, 1);
  assert.throws(() => shape.contact(ball), {field: "other"});
  assert.throws(() => shape.contact(new World().createBody({shapes: [{circle: {radius: 1}}]}).shapes[0]), /of another world/);
});

test("the package is small, and its types name what it exports", () => {
  const files = JSON.parse(readFileSync(path.join(folder, "package.json"))).files;
  const size = files.reduce((sum, file) => sum + gzipSync(readFileSync(path.join(folder, file))).length, 0);
  console.log(`the package is ${Math.round(size / 1000)} kB compressed, ${Math.round(statSync(path.join(folder, "plumb.wasm.mjs")).size / 1000)} kB as a file`);
  assert.ok(size < 700e3, `${size} bytes`);
  const types = readFileSync(path.join(folder, "plumb.d.ts"), "utf8");
  for (const [name, Type] of Object.entries({World, Body, Shape, Chain, Joint, Rollback})) {
    const block = types.match(new RegExp(`class ${name}(?: extends \\w+)? \\{([^]*?)\\n\\}`))[1];
    const declared = new Set([...block.matchAll(/^ {2}(?:readonly |[gs]et )?(\w+)[(:?]/gm)].map((match) => match[1]));
    declared.delete("constructor");
    const real = Object.getOwnPropertyNames(Type.prototype).filter((each) => each !== "constructor" && !each.startsWith("_"));
    assert.deepEqual([...declared].sort(), real.sort(), name);
  }
});

test("games set their own rules", () => {
  const world = new World({thresholds: {hit: 0.5}});
  assert.deepEqual(world.thresholds, {hit: 0.5, bounce: -1, sleep: -1});
  const ground = world.createBody({type: "static", position: {x: 0, y: -1}, shapes: [{box: {width: 40, height: 2}}]});
  const ghostly = 1n << 40n;
  const crate = world.createBody({position: {x: 0, y: 1.5}, shapes: [{box: {width: 1, height: 1}, hitEvents: true}]});
  const ghost = world.createBody({position: {x: 3, y: 1.5}, continuous: false,
    shapes: [{box: {width: 1, height: 1}, filter: {category: ghostly}}]});
  const asked = [];
  world.onFilter((a, b) => {
    asked.push(a.body.index, b.body.index);
    return !a.body.equals(ghost) && !b.body.equals(ghost);
  });
  const lamp = world.createBody({position: {x: -9, y: 7}, shapes: [{circle: {radius: 0.5}}]});
  const joint = world.createJoint(ground, lamp, "distance", {anchorA: {x: -9, y: 9}, length: 1, reportForce: 5});
  const hits = [], loads = [];
  for (let i = 0; i < 90; ++i) {
    world.step();
    hits.push(...world.events.hits);
    loads.push(...world.events.loaded);
  }
  assert.ok(asked.includes(ghost.index));
  assert.ok(ghost.position.y < -3);
  near(crate.position.y, 0.5, 0.01);
  near(hits[0].impulse, Math.sqrt(2 * kG), 0.5);
  assert.ok(loads.length > 0 && loads.every((load) => load.joint.equals(joint) && load.force > 5));
  near(world.contacts.find((c) => c.stepImpulse > 0).stepImpulse, kG / 60, 1e-3);
  assert.equal(world.rayCast({x: 0, y: 5}, {x: 0, y: -9}, {mask: ghostly}), null);
  assert.equal(crate.continuous, true);
  assert.equal(ghost.continuous, false);
  joint.setLoadEvents({});
  world.onFilter(null);
  world.thresholds = {sleep: 2};
  world.step();
  assert.deepEqual(world.events.loaded, []);
});

test("what was set reads back", () => {
  const given = {precision: "double", gravity: {x: 1, y: 2}, combineFriction: "product", combineRestitution: "average",
    sleeping: false, continuous: false, solver: "xpbd", integrator: "explicit_euler", iterations: 7, directIslands: false,
    quarantine: false, thresholds: {hit: 1, bounce: 2, sleep: 3}};
  const world = new World(given);
  assert.deepEqual(world.definition, given);
  world.sleeping = world.continuous = world.directIslands = world.quarantine = true;
  world.solver = "direct", world.iterations = 9;
  assert.deepEqual([world.sleeping, world.continuous, world.directIslands, world.quarantine, world.solver, world.iterations],
    [true, true, true, true, "direct", 9]);

  const filter = {category: 1n << 63n, mask: 6n, group: -2};
  const body = world.createBody({maySleep: false, lockY: true, angularVelocity: 2,
    shapes: [{capsule: {start: {x: 0, y: 0}, end: {x: 2, y: 0}, radius: 0.5}, position: {x: 1, y: 0}, filter, preSolve: true}]});
  assert.equal(body.maySleep, false);
  assert.deepEqual(body.locks, {x: false, y: true, rotation: false});
  near(body.velocityAt({x: body.centre.x, y: 1}).x - body.velocity.x, -2 * (1 - body.centre.y), 1e-12);
  body.locks = {rotation: true};
  body.maySleep = true;
  assert.deepEqual([body.locks, body.maySleep], [{x: false, y: true, rotation: true}, true]);
  const [shape] = body.shapes;
  assert.deepEqual(shape.filter, filter);
  assert.deepEqual([shape.hitEvents, shape.preSolve, shape.chain], [false, true, null]);
  const {capsule, density, filter: same} = shape.definition;
  assert.deepEqual([capsule, density, same], [{start: {x: 1, y: 0}, end: {x: 3, y: 0}, radius: 0.5}, 1, filter]);
  assert.equal(body.createShape(shape.definition).definition.capsule.end.x, 3);
  assert.equal(body.worldPoint({x: 1, y: 2}).y, 2);
  assert.equal(body.localPoint({x: 1, y: 2}).x, 1);

  const ground = world.createBody({type: "static"});
  const chain = ground.createChain({points: [{x: 5, y: 0}, {x: 0, y: 0}, {x: -5, y: 0}], hitEvents: true, userData: 4});
  assert.ok(chain.valid && chain.body.equals(ground));
  assert.equal(chain.segments.length, 2);
  assert.ok(chain.segments[0].chain.equals(chain) && chain.segments[0].hitEvents && chain.segments[0].userData === 4n);

  const definition = {anchorA: {x: 1, y: 2}, limits: {lower: -1, upper: 2}, motor: {speed: 3, maxForce: 4}, reportForce: 5};
  const joint = world.createJoint(ground, body, "revolute", {...definition, userData: 6});
  assert.equal(joint.kind, "revolute");
  assert.ok(joint.bodies[0].equals(ground) && joint.bodies[1].equals(body) && body.joints[0].equals(joint));
  for (const [field, value] of Object.entries(definition)) assert.deepEqual(joint.definition[field], value, field);
  assert.deepEqual([joint.definition.spring, joint.userData], [undefined, 6n]);
  joint.change(joint.kind, joint.definition);  // what is read can be given back
  joint.userData = 7n;
  assert.equal(joint.userData, 7n);
  world.step();
  assert.equal(world.stepCount, 1);
  assert.ok(world.moved.some((each) => each.equals(body)));
});

test("queries ask a condition, and list all they find", () => {
  const {world} = withGround();
  const boxes = [1, 3, 5].map((y) => world.createBody({position: {x: 0, y}, shapes: [{box: {width: 1, height: 1}}]}));
  const down = [{x: 0, y: 10}, {x: 0, y: -20}];
  assert.deepEqual(world.rayCastAll(...down).map((hit) => hit.body.position.y), [5, 3, 1, -1]);
  const condition = (shape) => !shape.body.equals(boxes[2]);
  assert.ok(world.rayCast(...down, {condition}).body.equals(boxes[1]));
  assert.equal(world.overlapBox({lower: {x: -1, y: 0.2}, upper: {x: 1, y: 4}}).length, 2);
  assert.equal(world.overlapBox({lower: {x: -1, y: 0.2}, upper: {x: 1, y: 6}}, {condition}).length, 2);
  near(world.distance(boxes[0].shapes[0], boxes[1].shapes[0]).distance, 1, 1e-6);
  assert.throws(() => world.rayCast(...down, {condition() { throw new RangeError("mine"); }}), /mine/);
  world.step();  // the query has ended: the world may be changed
  world.step(1 / 60, 4, 60);
  assert.equal(boxes[0].contacts.length, 2);
});

test("force laws act as their formulas say", () => {
  const world = new World({precision: "double", gravity: {x: 0, y: 0}});
  const ball = () => world.createBody({velocity: {x: 2, y: 0}, mass: {mass: 2, inertia: 1}});
  const run = (count, law) => {
    for (let i = 0; i < count; ++i) {
      law();
      world.step();
    }
  };
  let one = ball();
  run(60, () => world.applyLinearDrag({linear: 3}, 1 / 60));
  near(one.velocity.x, 2 * Math.exp(-1.5), 1e-12);
  one.destroy(), one = ball();
  run(60, () => world.applyQuadraticDrag(0.5, 1 / 60));  // v = v0 / (1 + c v0 t / m)
  near(one.velocity.x, 2 / 1.5, 1e-4);
  one.destroy(), one = ball();
  run(60, () => world.applyLaw(({mass, velocity}) => ({force: {x: 0, y: mass * velocity.x}}), 1 / 60));
  near(one.velocity.y, 2, 1e-12);
  one.destroy(), one = ball();
  // From x = 0: v / w cos(a / 2) sin(i a), cos a = 1 - (w dt)^2 / 2, with a spring's force at the middle of each step.
  run(60, () => world.applyLaw(({mass, centre}) => ({force: {x: -4 * mass * centre.x, y: 0}}), 1 / 60));
  const a = Math.acos(1 - 0.5 * 4 / 60 ** 2);
  near(one.position.x, Math.cos(a / 2) * Math.sin(60 * a), 1e-12);
  one.destroy(), one = ball();
  run(60, () => world.applyAttraction({x: 0, y: 0}, {strength: Math.PI ** 2, falloff: "linear"}, 1 / 60));
  near(one.velocity.x, -2, 1e-2);  // half a period of sqrt(strength)
  one.destroy(), one = ball();
  const sun = world.createBody({position: {x: 0, y: 4}, mass: {mass: 2, inertia: 1}});
  run(60, () => world.applyAttraction(sun, {strength: 5}, 1 / 60));
  near(one.velocity.x + sun.velocity.x, 2, 1e-12);
  assert.ok(one.velocity.y > 0 && sun.velocity.y < 0);
  run(1, () => world.applySpring(one, {x: 0, y: 0}, sun, {x: 0, y: 0}, {stiffness: 1, restLength: 99}, 1 / 60));
  near(one.velocity.y + sun.velocity.y, 0, 1e-12);

  const {world: pool} = withGround();
  const raft = pool.createBody({position: {x: 0, y: 3}, shapes: [{box: {width: 1, height: 1}}]});
  for (let i = 0; i < 900; ++i) {
    pool.applyWater({level: 3, density: 2, linearDrag: 5, angularDrag: 5}, 1 / 60, {wakes: true});
    pool.step();
  }
  near(raft.position.y, 3, 1e-3);  // half of it is under water
  pool.explode({centre: {x: 0, y: 1}, radius: 9, impulse: 10, cover: {ignore: raft}});
  assert.ok(raft.velocity.y > 1);
  pool.applyWind({velocity: {x: 9, y: 0}}, 1 / 60);
  pool.step();
  assert.ok(raft.velocity.x > 0);
});

test("a world goes back in memory and takes a late input", () => {
  const {world} = withGround();
  const player = world.createBody({position: {x: 0, y: 3}, shapes: [{box: {width: 1, height: 1}}]});
  const rollback = new Rollback(world, 8);
  assert.deepEqual([rollback.oldest, rollback.latest, rollback.size], [-1, -1, 0]);
  for (let i = 0; i < 20; ++i) {
    rollback.save();
    world.step();
  }
  assert.deepEqual([rollback.oldest, rollback.latest, rollback.size], [12, 19, 8]);
  const end = world.fullHash();
  assert.throws(() => rollback.backTo(3), {kind: "InvalidValue", value: "3"});
  assert.ok(rollback.holds(14) && !rollback.holds(3));
  rollback.backTo(14);
  world.step(1 / 60, 4, 6);
  assert.equal(world.fullHash(), end);
  rollback.backTo(14);
  player.applyImpulse({x: 2, y: 0});
  world.step(1 / 60, 4, 6);
  near(player.position.x, 0.2, 1e-6);
  assert.throws(() => new Rollback(world, 0), {field: "frames"});
  rollback.destroy();
  assert.throws(() => rollback.save(), {kind: "UnknownName"});
});

test("a world draws itself", () => {
  const {world, ground} = withGround();
  const crate = world.createBody({name: "caf\u00e9", position: {x: 0, y: 0.5}, shapes: [{box: {width: 1, height: 1}}]});
  const lamp = world.createBody({position: {x: 3, y: 4}, shapes: [{circle: {radius: 0.5}},
    {capsule: {start: {x: 0, y: 0}, end: {x: 1, y: 0}, radius: 0.25}}]});
  world.createJoint(ground, lamp, "distance", {anchorA: {x: 3, y: 8}, length: 3});
  world.step();
  const seen = [], keep = (what) => (...parts) => seen.push([what, ...parts]);
  const to = Object.fromEntries(["polygon", "circle", "capsule", "segment", "point", "text"].map((what) => [what, keep(what)]));
  world.draw(to);
  const kinds = () => seen.map(([what, ...parts]) => `${what} ${parts.at(-1)}`);
  assert.deepEqual(kinds().slice(0, 4), ["polygon static", "polygon awake", "capsule awake", "circle awake"]);
  assert.ok(kinds().includes("segment joint"));
  const corners = seen[0][1];
  assert.deepEqual(corners.map(({x, y}) => [x, y]).sort(), [[-20, -2], [-20, 0], [20, -2], [20, 0]]);
  near(seen[3][1].y, lamp.position.y, 1e-6);
  seen.length = 0;
  world.draw(to, {shapes: false, joints: false, names: true, contacts: true, centres: true});
  assert.ok(seen.some(([what, , name]) => what === "text" && name === "caf\u00e9"));
  assert.equal(seen.filter(([what, , role]) => what === "point" && role === "contact").length, 2);
  seen.length = 0;
  world.draw(to, {bounds: {lower: {x: 2, y: 2}, upper: {x: 9, y: 9}}, joints: false});
  assert.deepEqual(kinds(), ["capsule awake", "circle awake"]);
  seen.length = 0;
  world.draw({circle: to.circle});
  assert.deepEqual(kinds(), ["circle awake"]);
  assert.throws(() => world.draw(to, {colour: 1}), {field: "colour"});
  assert.ok(crate.valid);
});
