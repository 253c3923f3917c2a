// plumb's world for JavaScript: the .cpp files beside it list the calls, plumb.d.ts the types and units. Works in browsers and in
// Node; needs no threads, no special headers and no files beside it.
import {PlumbError, bodyOf, filterOf, flag, geometryOf, jointOf, kNames, knownMass, knownMaterial, knownMover, listed,
  materialOf, named, own, pair, queryOf, shapeOf, thresholdsOf, worldOf} from "./plumb.definitions.mjs";
import packed from "./plumb.wasm.mjs";

export {PlumbError};

// ---- The program ----------------------------------------------------------------------------------------------------

async function unpack() {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const kKinds = ["SyntaxError", "InvalidValue", "UnknownName", "Unsupported", "RunError", "FileError"];
const kNoSystem = 52;  // WASI's ENOSYS: there are no files and no processes
const hooks = new Map(), filters = new Map();  // of worlds, by their address

const imports = {
  plumb: {
    fail(kind, ...parts) {
      throw new PlumbError(kKinds[kind] ?? "InternalError", ...parts.map(text));
    },
    pre_solve(world) {
      return hooks.get(world)(readContact()) === false ? 0 : 1;
    },
    filter(world) {
      const n = new Float64Array(calls.memory.buffer, calls.numbers(4), 4);
      const a = new Shape(hooked, n[0], n[1]), b = new Shape(hooked, n[2], n[3]);
      return filters.get(world)(a, b) === false ? 0 : 1;
    },
  },
  wasi_snapshot_preview1: new Proxy({
    clock_time_get(_clock, _precision, out) {
      new DataView(calls.memory.buffer).setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
  }, {get: (all, name) => all[name] ?? (() => kNoSystem)}),
};
const module = await WebAssembly.compile(await unpack());
const calls = (await WebAssembly.instantiate(module, {
  plumb: imports.plumb,
  wasi_snapshot_preview1: Object.fromEntries(WebAssembly.Module.imports(module)
    .filter((each) => each.module === "wasi_snapshot_preview1")
    .map(({name}) => [name, imports.wasi_snapshot_preview1[name]])),
})).exports;
calls._initialize();

const decoder = new TextDecoder(), encoder = new TextEncoder();
function text(place) {
  const bytes = new Uint8Array(calls.memory.buffer);
  return decoder.decode(bytes.slice(place, bytes.indexOf(0, place)));
}

// A call that fails leaves the program by an exception: its stack is put back here.
function guarded(call) {
  const stack = calls.__stack_pointer.value;
  try {
    return call();
  } catch (error) {
    calls.__stack_pointer.value = stack;
    throw error;
  }
}
/// Calls the function `name` of the engine, after writing `input` where it is looked for.
function call(name, args = [], input = null) {
  return guarded(() => {
    if (input !== null) {
      const place = calls.numbers(input.length);
      new Float64Array(calls.memory.buffer, place, input.length).set(input);
    }
    return calls[name](...args);
  });
}
/// The numbers that the last call left.
function result(place) {
  return new Float64Array(calls.memory.buffer, place, calls.number_count());
}
function point(numbers, at = 0) {
  return {x: numbers[at], y: numbers[at + 1]};
}
function box(numbers) {
  return {lower: point(numbers), upper: point(numbers, 2)};
}

const kContact = 17;  // numbers of a contact
function contactAt(world, n, at) {
  const points = [];
  for (let i = 0; i < n[at + 6]; ++i) {
    const first = at + 7 + 4 * i;
    points.push({point: point(n, first), separation: n[first + 2], impulse: n[first + 3]});
  }
  return {shapeA: new Shape(world, n[at], n[at + 1]), shapeB: new Shape(world, n[at + 2], n[at + 3]),
    normal: point(n, at + 4), points, approach: n[at + 15], stepImpulse: n[at + 16]};
}
let hooked = null;  // the world whose hook is being called
function readContact() {
  return contactAt(hooked, new Float64Array(calls.memory.buffer, calls.numbers(kContact), kContact), 0);
}

// ---- Objects --------------------------------------------------------------------------------------------------------

class Handle {
  constructor(world, index, generation) {
    this.world = world;
    this.index = index;
    this.generation = generation;
  }
  equals(other) {
    return other instanceof this.constructor && other.world === this.world && other.index === this.index &&
      other.generation === this.generation;
  }
  _call(name, ...args) {
    return call(name, [this.world._address, this.index, this.generation, ...args]);
  }
}
const handles = (Type, world, numbers) =>
  Array.from({length: numbers.length / 2}, (_, i) => new Type(world, numbers[2 * i], numbers[2 * i + 1]));

export class Body extends Handle {
  get valid() { return this._call("body_valid") !== 0; }
  get position() { return point(result(this._call("body_position"))); }
  set position(p) { this._call("body_set_pose", ...pair(p), this.angle); }
  get centre() { return point(result(this._call("body_centre"))); }
  get angle() { return this._call("body_angle"); }
  set angle(value) { this._call("body_set_pose", ...pair(this.position), value); }
  get velocity() { return point(result(this._call("body_velocity"))); }
  set velocity(v) { this._call("body_set_velocity", ...pair(v, "velocity")); }
  get angularVelocity() { return this._call("body_angular_velocity"); }
  set angularVelocity(value) { this._call("body_set_angular_velocity", value); }
  get type() { return kNames.type[this._call("body_type")]; }
  set type(name) { this._call("body_set_type", named("type", name)); }
  get mass() { return this._call("body_mass"); }
  get inertia() { return this._call("body_inertia"); }
  get gravityScale() { return this._call("body_gravity_scale"); }
  set gravityScale(value) { this._call("body_set_gravity_scale", value); }
  get linearDamping() { return this._call("body_linear_damping"); }
  set linearDamping(value) { this._call("body_set_damping", value, this.angularDamping); }
  get angularDamping() { return this._call("body_angular_damping"); }
  set angularDamping(value) { this._call("body_set_damping", this.linearDamping, value); }
  get awake() { return this._call("body_awake") !== 0; }
  set awake(on) { this._call("body_set_awake", flag(on)); }
  set maySleep(on) { this._call("body_set_may_sleep", flag(on)); }
  get userData() { return BigInt.asUintN(64, this._call("body_user_data")); }
  set userData(data) { this._call("body_set_user_data", BigInt.asUintN(64, BigInt(data))); }
  get name() { return text(this._call("body_name")); }
  set name(name) {
    const letters = encoder.encode(name);
    new Uint8Array(calls.memory.buffer, calls.bytes(letters.length), letters.length).set(letters);
    this._call("body_set_name");
  }
  get continuous() { return this._call("body_continuous") !== 0; }
  set continuous(on) { this._call("body_set_continuous", flag(on)); }
  get enabled() { return this._call("body_enabled") !== 0; }
  set enabled(on) { this._call("body_set_enabled", flag(on)); }
  get box() { return box(result(this._call("body_box"))); }
  get quarantined() { return this._call("body_quarantined") !== 0; }
  get shapes() { return handles(Shape, this.world, result(this._call("body_shapes"))); }

  setPose(position, angle) { this._call("body_set_pose", ...pair(position), angle); }
  setMass(given) {
    const {mass, inertia, centre = {x: 0, y: 0}} = knownMass(given);
    this._call("body_set_mass", mass, ...pair(centre, "centre"), inertia);
  }
  useDensities() { this._call("body_use_densities"); }
  setLocks({x = false, y = false, rotation = false}) { this._call("body_set_locks", flag(x), flag(y), flag(rotation)); }
  moveTowards(position, angle, dt) { this._call("body_move_towards", ...pair(position), angle, dt); }
  applyForce(force, at = null) {
    if (at === null) this._call("body_apply_force", ...pair(force, "force"));
    else this._call("body_apply_force_at", ...pair(force, "force"), ...pair(at, "point"));
  }
  applyTorque(torque) { this._call("body_apply_torque", torque); }
  applyImpulse(impulse, at = null) {
    if (at === null) this._call("body_apply_impulse", ...pair(impulse, "impulse"));
    else this._call("body_apply_impulse_at", ...pair(impulse, "impulse"), ...pair(at, "point"));
  }
  applyAngularImpulse(impulse) { this._call("body_apply_angular_impulse", impulse); }
  createShape(shape) {
    const made = result(call("shape_create", [this.world._address, this.index, this.generation], shapeOf(shape)));
    return new Shape(this.world, made[0], made[1]);
  }
  createChain({points, closed = false, filter, ...material}) {
    const input = [flag(closed), ...materialOf(knownMaterial(material)), ...filterOf(filter),
      listed(points, "points").length, ...points.flatMap((p) => pair(p, "points"))];
    const made = result(call("chain_create", [this.world._address, this.index, this.generation], input));
    return new Chain(this.world, made[0], made[1]);
  }
  release() { this._call("body_release"); }
  destroy() { this._call("body_destroy"); }
}

export class Shape extends Handle {
  get valid() { return this._call("shape_valid") !== 0; }
  get body() {
    const n = result(this._call("shape_body"));
    return new Body(this.world, n[0], n[1]);
  }
  get userData() { return BigInt.asUintN(64, this._call("shape_user_data")); }
  set userData(data) { this._call("shape_set_user_data", BigInt.asUintN(64, BigInt(data))); }
  get density() { return this._call("shape_density"); }
  set density(value) { this._call("shape_set_density", value); }
  get sensor() { return this._call("shape_sensor") !== 0; }
  set sensor(on) { this._call("shape_set_sensor", flag(on)); }
  set hitEvents(on) { this._call("shape_set_hit_events", flag(on)); }
  set preSolve(on) { this._call("shape_set_pre_solve", flag(on)); }
  get box() { return box(result(this._call("shape_box"))); }
  rayCast(origin, translation) {
    const hit = result(this._call("shape_ray_cast", ...pair(origin, "origin"), ...pair(translation, "translation")));
    if (hit.length === 0) return null;
    const at = {x: origin.x + hit[2] * translation.x, y: origin.y + hit[2] * translation.y};
    return {point: at, normal: point(hit), fraction: hit[2]};
  }
  contains(at) { return this._call("shape_contains", ...pair(at, "point")) !== 0; }
  get material() {
    const [friction, restitution, rollingResistance, surfaceSpeed] = result(this._call("shape_material"));
    return {friction, restitution, rollingResistance, surfaceSpeed};
  }
  set material(m) {
    const input = materialOf({...this.material, ...knownMaterial(m)});
    call("shape_set_material", [this.world._address, this.index, this.generation], input);
  }
  set filter(f) { call("shape_set_filter", [this.world._address, this.index, this.generation], filterOf(f)); }
  get overlapping() { return handles(Shape, this.world, result(this._call("shape_overlapping"))); }
  destroy() { this._call("shape_destroy"); }
}

export class Chain extends Handle {
  destroy() { this._call("chain_destroy"); }
}

export class Joint extends Handle {
  get valid() { return this._call("joint_valid") !== 0; }
  change(kind, definition = {}) {
    call("joint_change", [this.world._address, this.index, this.generation], jointOf(kind, definition));
  }
  read() {
    const [force, torque, linearError, angularError, angle, translation, length] = result(this._call("joint_read"));
    return {force, torque, linearError, angularError, angle, translation, length};
  }
  setLoadEvents({force = 0, torque = 0}) { this._call("joint_set_load_events", force, torque); }
  destroy() { this._call("joint_destroy"); }
}

const collected = new FinalizationRegistry((address) => {
  hooks.delete(address), filters.delete(address);
  calls.world_destroy(address);
});

export class World {
  constructor(definition = {}) {
    this._address = call("world_create", [], worldOf(definition));
    collected.register(this, this._address, this);
  }
  /// Frees the world's memory now; without it that happens when the object is collected.
  destroy() {
    collected.unregister(this);
    hooks.delete(this._address), filters.delete(this._address);
    calls.world_destroy(this._address);
    this._address = 0;
  }

  step(dt = 1 / 60, substeps = 4, count = 1) {
    const before = hooked;
    hooked = this;
    try {
      call("world_step", [this._address, dt, substeps, count]);
    } finally {
      hooked = before;
    }
  }
  get time() { return call("world_time", [this._address]); }
  /// 16 hexadecimal digits, the same as of a native program that makes the same calls.
  hash() { return hex(call("world_hash", [this._address])); }
  fullHash() { return hex(call("world_full_hash", [this._address])); }
  get gravity() { return point(result(call("world_gravity", [this._address]))); }
  set gravity(g) { call("world_set_gravity", [this._address, ...pair(g, "gravity")]); }
  set sleeping(on) { call("world_set_sleeping", [this._address, flag(on)]); }
  set continuous(on) { call("world_set_continuous", [this._address, flag(on)]); }
  set solver(name) { call("world_set_solver", [this._address, named("solver", name)]); }
  get thresholds() {
    const [hit, bounce, sleep] = result(call("world_thresholds", [this._address]));
    return {hit, bounce, sleep};
  }
  set thresholds(t) { call("world_set_thresholds", [this._address], thresholdsOf(t)); }
  set profiling(on) { call("world_set_profiling", [this._address, flag(on)]); }
  get profile() {
    const [broadPhase, narrowPhase, solver, finalize, continuous, events, sleep, steps] =
      result(call("world_profile", [this._address]));
    return {broadPhase, narrowPhase, solver, finalize, continuous, events, sleep, steps};
  }
  get counts() {
    const [bodies, awake, shapes, contacts, touching, joints] = result(call("world_counts", [this._address]));
    return {bodies, awake, shapes, contacts, touching, joints};
  }

  createBody(definition = {}) {
    const name = encoder.encode(definition.name ?? "");
    const input = bodyOf(definition), place = calls.bytes(name.length);
    new Uint8Array(calls.memory.buffer, place, name.length).set(name);
    const made = result(call("body_create", [this._address], input));
    return new Body(this, made[0], made[1]);
  }
  createJoint(a, b, kind, definition = {}) {
    own(this, a, "a"), own(this, b, "b");
    const made = result(call("joint_create", [this._address, a.index, a.generation, b.index, b.generation],
      jointOf(kind, definition)));
    return new Joint(this, made[0], made[1]);
  }

  get bodies() {
    const n = new Uint32Array(calls.memory.buffer, call("world_bodies", [this._address]),
      2 * calls.body_count(this._address));
    return handles(Body, this, n);
  }
  get poses() { return this.#array("world_poses"); }
  get velocities() { return this.#array("world_velocities"); }
  #array(name) {
    const place = call(name, [this._address]);
    return new Float64Array(calls.memory.buffer, place, 3 * calls.body_count(this._address));
  }

  get contacts() {
    const n = result(call("world_contacts", [this._address])).slice();
    return Array.from({length: n.length / kContact}, (_, i) => contactAt(this, n, i * kContact));
  }
  get events() {
    const n = result(call("world_events", [this._address])).slice();
    let at = 10;
    const list = (count, width, make) => Array.from({length: count}, () => {
      const made = make(at);
      at += width;
      return made;
    });
    const shape = (i) => new Shape(this, n[i], n[i + 1]), body = (i) => new Body(this, n[i], n[i + 1]);
    const touch = (i) => ({shapeA: shape(i), shapeB: shape(i + 2)});
    const sensed = (i) => ({sensor: shape(i), visitor: shape(i + 2)});
    return {
      begin: list(n[0], 4, touch),
      end: list(n[1], 4, touch),
      hits: list(n[2], 10, (i) => ({...touch(i), point: point(n, i + 4), normal: point(n, i + 6), speed: n[i + 8],
        impulse: n[i + 9]})),
      sensorBegin: list(n[3], 4, sensed),
      sensorEnd: list(n[4], 4, sensed),
      broken: list(n[5], 2, (i) => new Joint(this, n[i], n[i + 1])),
      fellAsleep: list(n[6], 2, body),
      woke: list(n[7], 2, body),
      quarantined: list(n[8], 2, body),
      loaded: list(n[9], 4, (i) => ({joint: new Joint(this, n[i], n[i + 1]), force: n[i + 2], torque: n[i + 3]})),
    };
  }
  onPreSolve(hook) {
    if (hook) hooks.set(this._address, hook);
    else hooks.delete(this._address);
    call("world_on_pre_solve", [this._address, flag(hook)]);
  }
  onFilter(filter) {
    if (filter) filters.set(this._address, filter);
    else filters.delete(this._address);
    call("world_on_filter", [this._address, flag(filter)]);
  }

  save() {
    const size = call("world_save", [this._address]);
    return new Uint8Array(calls.memory.buffer, calls.bytes(size), size).slice();
  }
  restore(bytes) {
    new Uint8Array(calls.memory.buffer, calls.bytes(bytes.length), bytes.length).set(bytes);
    call("world_restore", [this._address]);
  }

  rayCast(origin, translation, filter) {
    return this.#hit(call("ray_cast", [this._address],
      [...pair(origin, "origin"), ...pair(translation, "translation"), ...queryOf(this, filter)]), "fraction");
  }
  castShape(shape, position, angle, translation, filter) {
    const input = [...geometryOf(shape), ...pair(position), angle, ...pair(translation, "translation"),
      ...queryOf(this, filter)];
    return this.#hit(call("cast_shape", [this._address], input), "fraction");
  }
  overlapShape(shape, position, angle = 0, filter = {}) {
    const input = [...geometryOf(shape), ...pair(position), angle, ...queryOf(this, filter)];
    return handles(Shape, this, result(call("overlap_shape", [this._address], input)));
  }
  shapesAt(at, filter) {
    return handles(Shape, this, result(call("shapes_at", [this._address], [...pair(at, "point"), ...queryOf(this, filter)])));
  }
  nearest(at, maxDistance, filter) {
    return this.#hit(call("nearest", [this._address], [...pair(at, "point"), maxDistance, ...queryOf(this, filter)]), "distance");
  }
  move(capsule, position, velocity, dt, options = {}) {
    const {up = {x: 0, y: 1}, maxSlope = 0.8, stepHeight = 0.3, skin = 0, mass = 0, pushForce = 1e12, push = true,
      filter} = knownMover(options);
    const n = result(call("move", [this._address, flag(push)], [...geometryOf({capsule}), ...pair(position),
      ...pair(velocity, "velocity"), dt, ...pair(up, "up"), maxSlope, stepHeight, skin, mass, pushForce,
      ...queryOf(this, filter)]));
    return {position: point(n), velocity: point(n, 2), onGround: n[4] !== 0, squeezed: n[5] !== 0,
      groundNormal: point(n, 6), ground: new Body(this, n[8], n[9]), groundVelocity: point(n, 10)};
  }
  #hit(place, last) {
    const n = result(place);
    if (n.length === 0) return null;
    return {shape: new Shape(this, n[0], n[1]), body: new Body(this, n[2], n[3]), point: point(n, 4),
      normal: point(n, 6), [last]: n[8]};
  }
}

function hex(bits) {
  return BigInt.asUintN(64, bits).toString(16).padStart(16, "0");
}
