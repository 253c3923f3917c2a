// Refusals of the npm package, what hooks may do, and memory, in Node: node errors_test.mjs PACKAGE
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {readdirSync, readFileSync} from "node:fs";
import path from "node:path";
import test from "node:test";
import {pathToFileURL} from "node:url";
import {PlumbError, Rollback, World, folder, kG, near, overlapping, withGround} from "./fixture.mjs";

test("errors name the field and the value, and leave the world as it was", () => {
  const {world} = withGround();
  const before = world.fullHash();
  for (let i = 0; i < 2000; ++i) {
    assert.throws(() => world.createBody({shapes: [{circle: {radius: -0.5}}]}), (error) =>
      error instanceof PlumbError && error.kind === "InvalidValue" && error.field === "radius" && error.value === "-0.5");
  }
  assert.equal(world.fullHash(), before);
  assert.throws(() => world.createBody({colour: "red"}), /colour/);
  assert.throws(() => world.createBody({type: "fixed"}), /static, kinematic, dynamic/);
  assert.throws(() => world.createBody({position: [1, 2]}), /position/);
  assert.throws(() => world.createBody({shapes: [{}]}), /circle, box/);
  const dead = world.createBody();
  dead.destroy();
  assert.throws(() => dead.position, {kind: "UnknownName"});
  world.step();
});

test("a misspelt field is refused wherever it is given", () => {
  const world = new World(), other = new World();
  const a = world.createBody(), b = world.createBody({shapes: [{circle: {radius: 1}}]}), foreign = other.createBody();
  const refused = (field, work) => assert.throws(work, (error) => error instanceof PlumbError && error.field === field, field);
  refused("gravty", () => new World({gravty: {x: 0, y: 0}}));
  refused("bounce", () => { b.shapes[0].material = {bounce: 1}; });
  refused("size", () => b.createShape({box: {size: 1}}));
  refused("group_", () => { b.shapes[0].filter = {group_: 1}; });
  refused("anchor", () => world.createJoint(a, b, "revolute", {anchor: {x: 0, y: 0}}));
  refused("min", () => world.createJoint(a, b, "revolute", {limits: {min: 0}}));
  refused("frequency", () => world.createJoint(a, b, "weld", {linearSpring: {frequency: 2}}));
  refused("ignor", () => world.rayCast({x: 0, y: 5}, {x: 0, y: -9}, {ignor: a}));
  refused("slope", () => world.move({start: {x: 0, y: 0}, end: {x: 0, y: 1}, radius: 0.3}, {x: 0, y: 9}, {x: 0, y: 0},
    1 / 60, {slope: 1}));
  refused("mass", () => world.createBody({mass: 5}));  // it needs an inertia too
  refused("shapes", () => world.createBody({shapes: {circle: {radius: 1}}}));
  // The numbers of a body of another world would name one of this.
  refused("b", () => world.createJoint(a, foreign, "weld"));
  refused("ignore", () => world.nearest({x: 0, y: 0}, 1, {ignore: foreign}));
  assert.equal(world.counts.bodies, 2);
  assert.equal(world.counts.joints, 0);
});

test("worlds give their memory back", () => {
  for (let i = 0; i < 3000; ++i) {
    const {world} = withGround();
    world.step();
    world.destroy();
  }
});

test("a law that fails leaves the world as it was; one that is not finite is quarantined", () => {
  const {world} = withGround();
  const ball = world.createBody({position: {x: 0, y: 5}, shapes: [{circle: {radius: 0.5}}]});
  world.step();
  const before = world.hash();
  assert.throws(() => world.applyLaw(() => { throw new RangeError("mine"); }, 1 / 60), /mine/);
  assert.throws(() => world.applyLaw(() => ({forc: {x: 0, y: 0}}), 1 / 60), {field: "forc"});
  assert.throws(() => world.applyWind({density: -1}, 1 / 60), {kind: "InvalidValue", value: "-1"});
  assert.throws(() => world.applyWater({depth: 1}, 1 / 60), {field: "depth"});
  assert.throws(() => world.applyAttraction({x: 0, y: 0}, {falloff: "cubic"}, 1 / 60), {field: "falloff"});
  assert.throws(() => world.explode({radius: 0}), {field: "radius"});
  assert.throws(() => world.applyLaw(() => {}, -1), {kind: "InvalidValue", field: "dt"});
  assert.equal(world.hash(), before);
  world.applyLaw(() => ({torque: NaN}), 1 / 60);
  assert.deepEqual(world.quarantined.map(({body, field, step}) => [body.equals(ball), field, step]), [[true, "torque", 2]]);
  ball.release();
  assert.deepEqual(world.quarantined, []);
});

test("numbers in messages are JavaScript's", () => {
  const world = new World();
  for (const [value, text] of [[-1e21, "-1e+21"], [-0.1, "-0.1"], [NaN, "nan"], [-Infinity, "-inf"]])
    assert.throws(() => world.createBody({shapes: [{circle: {radius: value}}]}), {value: text});
});

test("an error in a hook is thrown when its step is finished, and the world goes on", () => {
  for (const on of ["onFilter", "onPreSolve"]) {
    const {world} = overlapping(), saved = world.save(), rollback = new Rollback(world, 2);
    rollback.save();
    let asked = 0;
    world[on](() => { ++asked; throw new RangeError("mine"); });
    assert.throws(() => world.step(1 / 60, 4, 5), (error) => error instanceof RangeError && error.message === "mine", on);
    assert.deepEqual([world.stepCount, asked], [1, 1], on);  // of five: none after the error
    const other = overlapping().world;
    other.step();
    assert.equal(world.fullHash(), other.fullHash(), on);  // as if the hook had said yes
    world[on](null);
    world.step();
    rollback.backTo(0);
    world.restore(saved);
    world.step();
    assert.equal(world.hash(), other.hash(), on);
  }
});

test("an error of a step or a law leaves the world free, and a saved state comes back", () => {
  for (const condition of [false, true]) {
    const {world, a} = overlapping({quarantine: false});
    world.onPreSolve(() => true);
    const saved = world.save(), before = world.hash();
    assert.throws(() => world.applyLaw(() => ({force: {x: NaN, y: 0}}), 1 / 60), {kind: "InvalidValue", field: "force"});
    assert.equal(world.hash(), before);
    a.setMass({mass: 1e-12, inertia: 1e-12});
    for (let i = 0; i < 100; ++i) a.applyForce({x: 1e12, y: 0});
    assert.throws(() => world.step(1e12), {kind: "RunError"});
    if (condition) world.rayCast({x: -9, y: 0}, {x: 18, y: 0}, {condition: () => true});
    world.gravity = {x: 0, y: -1};
    world.restore(saved);
    assert.equal(world.hash(), before);
    world.step();
    assert.equal(world.stepCount, 1);
  }
});

test("a hook without a result keeps contacts; other results are refused", () => {
  const {world} = overlapping();
  world.onFilter(() => {}), world.onPreSolve(() => {});
  world.step();
  assert.equal(world.counts.touching, 1);
  for (const wrong of [null, 0, 1, "no"]) {
    world.onPreSolve(() => wrong);
    assert.throws(() => world.step(), {kind: "InvalidValue", field: "onPreSolve", value: String(wrong)});
  }
  assert.throws(() => world.onFilter(5), {field: "filter"});
  assert.throws(() => world.rayCast({x: 0, y: 5}, {x: 0, y: -9}, {condition: 5}), {field: "condition"});
});

test("values of another type are refused by field and value", () => {
  const {world, a, b} = overlapping();
  const [shape] = a.shapes, before = world.fullHash();
  const refused = (field, value, work) => assert.throws(work, (error) => error instanceof PlumbError &&
    error.kind === "InvalidValue" && error.field === field && error.value === value, `${field} ${value}`);
  refused("group", "1.5", () => { shape.filter = {group: 1.5}; });
  refused("group", String(2 ** 40), () => { shape.filter = {group: 2 ** 40}; });
  refused("mask", "1.5", () => { shape.filter = {mask: 1.5}; });
  refused("userData", String(2n ** 64n), () => { a.userData = 2n ** 64n; });
  refused("userData", "1", () => { a.userData = "1"; });
  refused("userData", "0.5", () => world.createBody({userData: 0.5}));
  refused("angle", "true", () => { a.angle = true; });
  refused("angle", "1", () => world.createBody({angle: "1"}));
  refused("radius", "1", () => world.createBody({shapes: [{circle: {radius: "1"}}]}));
  refused("sensor", "1", () => { shape.sensor = 1; });
  refused("lockX", "yes", () => world.createBody({lockX: "yes"}));
  refused("name", "7", () => world.createBody({name: 7}));
  refused("mass", "undefined", () => a.setMass({inertia: 1}));
  refused("dt", "a", () => world.step("a"));
  refused("substeps", "1.5", () => world.step(1 / 60, 1.5));
  refused("count", "-1", () => world.step(1 / 60, 4, -1));
  refused("count", "2.7", () => world.step(1 / 60, 4, 2.7));
  refused("iterations", "2.5", () => { world.iterations = 2.5; });
  refused("a", "a Shape", () => world.createJoint(shape, b, "weld"));
  refused("ignore", "a Shape", () => world.nearest({x: 0, y: 0}, 1, {ignore: shape}));
  refused("hertz", "2", () => world.createJoint(a, b, "weld", {linearSpring: {hertz: "2"}}));
  refused("result", "5", () => world.applyLaw(() => 5, 1 / 60));
  refused("torque", "true", () => world.applyLaw(() => ({torque: true}), 1 / 60));
  refused("bytes", "abc", () => world.restore("abc"));
  refused("frames", "1.5", () => new Rollback(world, 1.5));
  refused("maxSlope", "1", () => world.move({start: {x: 0, y: 0}, end: {x: 0, y: 1}, radius: 0.3}, {x: 0, y: 9},
    {x: 0, y: 0}, 1 / 60, {maxSlope: "1"}));
  assert.equal(world.fullHash(), before);
  world.restore(world.save().buffer);
  shape.filter = {mask: -1, group: -(2 ** 31)};
  assert.deepEqual(shape.filter, {category: 1n, mask: 2n ** 64n - 1n, group: -(2 ** 31)});
});

test("a destroyed world says so", () => {
  const {world, a} = overlapping();
  const [shape] = a.shapes;
  world.destroy();
  world.destroy();
  for (const work of [() => world.step(), () => a.position, () => shape.density, () => new Rollback(world, 2)])
    assert.throws(work, {kind: "UnknownName", message: /destroyed/});
  assert.equal(a.valid, false);
});

test("refusals leave no memory behind, nor do worlds that their hooks know", async () => {
  const {world, a} = overlapping(), bytes = () => world.poses.buffer.byteLength;  // of the program's memory
  const refusals = [() => world.createBody({name: "a name of some length", shapes: [{circle: {radius: -1}}]}),
    () => a.createShape({box: {width: 1, height: NaN}}), () => world.step(-1), () => world.restore(new Uint8Array(99)),
    () => a.createChain({points: [{x: 0, y: 0}, {x: 0, y: 0}]}), () => { a.velocity = {x: NaN, y: 0}; }];
  for (const refusal of refusals) {
    const run = (count) => { for (let i = 0; i < count; ++i) assert.throws(refusal, PlumbError); };
    run(500);
    const start = bytes();
    run(20000);
    assert.ok(bytes() - start < 20000 * 8, `${refusal}: ${(bytes() - start) / 20000} bytes each`);
  }
  if (!globalThis.gc) return;
  const gone = Array.from({length: 20}, () => {
    const {world, a} = overlapping();
    world.onPreSolve(() => a.valid && world.time >= 0);
    world.step();
    return new WeakRef(world);
  });
  await new Promise((done) => setTimeout(done, 0));
  globalThis.gc();
  assert.ok(gone.filter((each) => each.deref() === undefined).length >= 19);
});

/// Runs a program that imports the package as `p` in a process of its own, whose memory is as small as at its start.
function fresh(program) {
  const source = `import * as p from ${JSON.stringify(String(pathToFileURL(path.join(folder, "plumb.mjs"))))}; ${program}`;
  return execFileSync(process.execPath, ["--input-type=module", "-"], {encoding: "utf8", input: source});
}

test("calls for which memory grows give the same in a fresh process", () => {
  const {world} = withGround();
  for (let i = 0; i < 2000; ++i) world.createBody({position: {x: 3 * i, y: 9}, name: `body ${i}`});
  const saved = Buffer.from(world.save()).toString("base64"), points = "Array.from({length: 3000}, (_, i) => ({x: i, y: 0}))";
  assert.ok(saved.length > 30e3);
  const programs = {
    restore: `const w = new p.World(); w.restore(Buffer.from("${saved}", "base64")); console.log(w.fullHash());`,
    save: `const w = new p.World(); for (let i = 0; i < 20000; ++i) { w.createBody(); if (i % 500 === 0) w.save(); }
      console.log(w.save().length > 30e3);`,
    bodies: `const w = new p.World(); let ok = true;
      for (let i = 1; i < 9000; ++i) { w.createBody(); if (i % 9 === 0) ok &&= w.bodies.length === i; } console.log(ok);`,
    arrays: `const w = new p.World(); let ok = true; for (let i = 1; i < 9000; ++i) { w.createBody({position: {x: i, y: 0}});
      if (i % 9 === 0) ok &&= w.poses[3 * i - 3] === i && w.velocities.length === 3 * i; } console.log(ok);`,
    name: `const w = new p.World(), name = "n".repeat(3e6); console.log(w.createBody({name}).name === name);`,
    "set name": `const b = new p.World().createBody(), name = "n".repeat(3e6); b.name = name; console.log(b.name === name);`,
    chain: `const b = new p.World().createBody({type: "static"}); console.log(b.createChain({points: ${points}}).segments.length);`,
  };
  const wanted = {restore: world.fullHash(), chain: "2999"};
  for (const [name, program] of Object.entries(programs)) assert.equal(fresh(program).trim(), wanted[name] ?? "true", name);
});

test("the memory's buffer is read in one place, after the calls that may move it", () => {
  const parts = readdirSync(folder).filter((name) => name.endsWith(".mjs") && name !== "plumb.wasm.mjs");
  assert.ok(parts.length > 5);
  const all = parts.map((name) => readFileSync(path.join(folder, name), "utf8")).join("\n");
  assert.equal(all.match(/memory\.buffer|calls\.memory\b/g).length, 1);
});

test("a world that asks a hook cannot be destroyed or changed in it", () => {
  const ways = {
    onFilter: (world, ask) => { world.onFilter(ask), world.step(); },
    onPreSolve: (world, ask) => { world.onPreSolve(ask), world.step(); },
    condition: (world, ask) => world.rayCast({x: -9, y: 0}, {x: 20, y: 0}, {condition: ask}),
    law: (world, ask) => world.applyLaw(ask, 1 / 60),
    draw: (world, ask) => world.draw({circle: ask}),
  };
  for (const [name, way] of Object.entries(ways)) {
    const {world, a, b} = overlapping(), before = world.fullHash();
    let asked = 0;
    const refused = (work) => assert.throws(work, {name: "PlumbError", kind: "Unsupported"}, name);
    way(world, () => {
      ++asked;
      refused(() => world.destroy());
      refused(() => world.createBody());
      refused(() => b.destroy());
      refused(() => { a.velocity = {x: 1, y: 0}; });
      assert.ok(a.valid && a.position.x === 0 && world.counts.bodies === 2);
    });
    assert.ok(asked > 0, name);
    if (!name.startsWith("on")) assert.equal(world.fullHash(), before, name);
    world.onFilter(null), world.onPreSolve(null);
    world.step();
    world.createBody();
    world.destroy();
    assert.equal(a.valid, false);
  }
});

test("a law's force acts on the body that it was asked for", () => {
  const world = new World({gravity: {x: 0, y: 0}}), ball = {shapes: [{circle: {radius: 0.5}}]};
  const [first, second] = [0, 5].map((x) => world.createBody({...ball, position: {x, y: 0}}));
  assert.throws(() => world.applyLaw(({body}) => {
    if (body.equals(first)) first.destroy();
    return {force: {x: body.equals(second) ? 1 : 9, y: 0}};
  }, 1 / 60), {kind: "Unsupported"});
  world.step();
  assert.deepEqual([first.valid, first.velocity.x, second.velocity.x], [true, 0, 0]);
});

test("hooks are asked by every call that may ask them", () => {
  const {world, a, b} = overlapping();
  let asked = 0;
  world.onFilter(() => { ++asked; throw new RangeError("mine"); });
  const [shape] = a.shapes;
  const calls = [() => { shape.filter = {mask: 3}; }, () => { a.enabled = false; }, () => { a.enabled = true; },
    () => { a.type = "static"; }, () => { a.type = "dynamic"; }, () => a.createShape({circle: {radius: 2}}),
    () => { b.position = {x: 0.5, y: 0}; }, () => { shape.sensor = true; }, () => { shape.sensor = false; }, () => world.step()];
  for (const call of calls) {
    try {
      call();
    } catch (error) {
      assert.ok(error instanceof RangeError, `${call}: ${error}`);
    }
  }
  assert.ok(asked > 0);
});

test("unknown and read-only properties of objects are refused by name", () => {
  const {world, a, b} = overlapping();
  const [shape] = a.shapes, joint = world.createJoint(a, b, "weld"), rollback = new Rollback(world, 2);
  const chain = world.createBody({type: "static"}).createChain({points: [{x: 9, y: 0}, {x: 8, y: 0}, {x: 7, y: 0}]});
  const before = world.fullHash();
  for (const object of [world, a, shape, joint, chain, rollback]) {
    assert.throws(() => { object.colour = "red"; }, {name: "PlumbError", kind: "UnknownName", field: "colour", value: "red"});
    assert.equal(object.colour, undefined);
  }
  assert.throws(() => { a.colour = 1; }, /not a property of a Body; can be set: position, angle, velocity/);
  assert.throws(() => { world.self = {world}; }, {field: "self"});
  for (const [object, name] of [[world, "time"], [world, "bodies"], [a, "mass"], [shape, "body"], [joint, "kind"], [chain, "valid"],
    [rollback, "size"]])
    assert.throws(() => { object[name] = 1; }, {name: "PlumbError", kind: "Unsupported", field: name});
  for (const name of ["index", "generation", "world"]) {
    assert.throws(() => { a[name] = 1; }, (error) => error instanceof TypeError && error.message.includes(name));
    assert.throws(() => { delete a[name]; }, TypeError);
  }
  assert.equal(world.fullHash(), before);
  assert.ok(world instanceof Object && a instanceof Object);
  class Level extends World { score = 7; }  // fields of one's own are declared
  assert.equal(new Level().score, 7);
});

test("what draw cannot call is refused", () => {
  const {world} = overlapping();
  for (const wrong of [null, undefined, 5, "circle", () => {}]) assert.throws(() => world.draw(wrong), {name: "PlumbError", field: "to"});
  assert.throws(() => world.draw({polygn() {}}), {kind: "UnknownName", field: "polygn"});
  assert.throws(() => world.draw({circle: 5}), {kind: "InvalidValue", field: "circle", value: "5"});
  assert.throws(() => world.draw({}, {bounds: {lower: {x: 0, y: 0}}}), {field: "upper"});
  assert.throws(() => world.draw({circle() { throw new RangeError("mine"); }}), /mine/);
  const drawn = [];
  class Canvas {
    colours = {awake: "blue"};
    circle(centre, radius, axis, role) { drawn.push(this.colours[role]); }
    clear() {}
  }
  world.draw(new Canvas());
  assert.deepEqual(drawn, ["blue", "blue"]);
  world.step();
});

test("queries and drawings that are refused leave the world free", () => {
  const {world, a} = overlapping(), bad = {x: NaN, y: 0}, good = {x: 1, y: 0}, disc = {circle: {radius: 1}};
  const capsule = {start: {x: 0, y: 0}, end: {x: 0, y: 1}, radius: 0.3}, gone = world.createBody();
  gone.destroy();
  for (const filter of [{}, {condition: () => true}, {ignore: gone}]) {
    const at = filter.ignore ? good : bad;
    const refusals = [() => world.rayCast(at, good, filter), () => world.rayCastAll(at, good, filter),
      () => world.castShape(disc, at, 0, good, filter), () => world.overlapShape(disc, at, 0, filter),
      () => world.overlapBox({lower: at, upper: good}, filter), () => world.shapesAt(at, filter),
      () => world.nearest(at, 1, filter), () => world.move(capsule, at, good, 1 / 60, {filter}),
      () => world.explode({centre: bad, cover: filter, occlusion: true}),
      () => world.draw({}, {bounds: {lower: bad, upper: good}, contacts: true})];
    for (const refusal of refusals) {
      try {
        refusal();
      } catch (error) {
        assert.ok(error instanceof PlumbError, `${error}`);
      }
      a.velocity = {x: 0, y: 0};  // refused while the world is locked
    }
  }
});

test("ranges are those that are true", () => {
  const {world, a} = overlapping();
  const says = (work, field, range) => assert.throws(work, (error) => error.field === field && error.message.includes(range));
  for (const substeps of [1.5, 0, 1001]) says(() => world.step(1 / 60, substeps), "substeps", "from 1 to 1000");
  for (const iterations of [1.5, 0, 1001]) says(() => { world.iterations = iterations; }, "iterations", "from 1 to 1000");
  says(() => new World({iterations: 1.5}), "iterations", "from 1 to 1000");
  says(() => new Rollback(world, 10001), "frames", "from 1 to 10000");
  for (const wrong of ["w", null, {}, a]) says(() => new Rollback(wrong, 2), "world", "must be a World");
  says(() => { a.locks = {X: true}; }, "X", "the locks");
  says(() => { a.locks = null; }, "locks", "must be {x, y, rotation}");
  says(() => world.overlapBox(null), "box", "must be {lower, upper}");
  says(() => world.overlapBox({lower: {x: 0, y: 0}, uper: {x: 1, y: 1}}), "uper", "a box");
  says(() => world.createJoint(a, a.world.createBody(), "weld").setLoadEvents({forc: 1}), "forc", "the loads");
});

test("members that are left out stay as they are", () => {
  const {world, a} = overlapping({thresholds: {hit: 1, bounce: 2}});
  world.thresholds = {sleep: 3};
  assert.deepEqual(world.thresholds, {hit: 1, bounce: 2, sleep: 3});
  a.locks = {y: true};
  a.locks = {rotation: true};
  assert.deepEqual(a.locks, {x: false, y: true, rotation: true});
  a.setLocks({y: false});
  assert.deepEqual(a.locks, {x: false, y: false, rotation: true});
});
