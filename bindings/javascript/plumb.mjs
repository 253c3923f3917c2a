// plumb's world for JavaScript: the .cpp files beside it list the calls, plumb.d.ts the types and units. Works in browsers and in
// Node; needs no threads, no special headers and no files beside it.
import {PlumbError, answered, attractionOf, bits, blastOf, bodyOf, boundsOf, bytesOf, called, chainOf, definitionOfJoint,
  definitionOfShape, definitionOfWorld, dragOf, drawOf, drawnTo, elasticOf, filterAt, filterOf, flag, geometryOf, jointOf,
  kNames, kRoles, knownLoads, knownLocks, knownMaterial, knownThresholds, lawOf, massOf, materialOf, moverOf, named, number,
  own, pair, queryOf, refuse, shapeOf, textOf, thresholdsOf, waterOf, whole, windOf, worldOf, wrenchOf}
  from "./plumb.definitions.mjs";
import packed from "./plumb.wasm.mjs";

export {PlumbError};

// ---- The program ----------------------------------------------------------------------------------------------------

async function unpack() {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const kKinds = ["SyntaxError", "InvalidValue", "UnknownName", "Unsupported", "RunError", "FileError"];
const kNoSystem = 52;  // WASI's ENOSYS: there are no files and no processes

const imports = {
  plumb: {
    fail(kind, ...parts) {
      throw new PlumbError(kKinds[kind] ?? "InternalError", ...parts.map(text));
    },
    pre_solve() { return asked.ask("onPreSolve", () => asked.world._preSolve(readContact(asked.world))); },
    filter() {
      return asked.ask("onFilter", () => {
        const n = view(Float64Array, calls.numbers(4), 4);
        return asked.world._filter(new Shape(asked.world, n[0], n[1]), new Shape(asked.world, n[2], n[3]));
      });
    },
    condition(index, generation) {
      return asked.ask("condition", () => asked.condition(new Shape(asked.world, index >>> 0, generation >>> 0)));
    },
    shortest(value, to) {
      const text = encoder.encode(Number.isFinite(value) ? String(value) : Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf");
      put(Uint8Array, to, text);
      return text.length;
    },
  },
  wasi_snapshot_preview1: new Proxy({
    clock_time_get(_clock, _precision, out) {
      view(DataView, out, 8).setBigUint64(0, BigInt(Math.round(performance.now() * 1e6)), true);
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

/// Views `count` elements of the program's memory at `place`. Memory that grows in a call detaches all earlier views: place
/// and count are arguments here, so their calls are made before the buffer is read. Nothing else reads it.
function view(Type, place, count) {
  return new Type(calls.memory.buffer, place, count);
}
/// Writes elements to `place`.
function put(Type, place, elements) {
  view(Type, place, elements.length).set(elements);
}
/// Writes bytes where the next call looks for them.
function putBytes(bytes) {
  put(Uint8Array, calls.bytes(bytes.length), bytes);
}

const decoder = new TextDecoder(), encoder = new TextEncoder();
function text(place) {
  const bytes = view(Uint8Array, 0);
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
    if (input !== null) put(Float64Array, calls.numbers(input.length), input);
    return calls[name](...args);
  });
}
/// The numbers that the last call left.
function result(place) {
  return view(Float64Array, place, calls.number_count());
}
function point(numbers, at = 0) {
  return {x: numbers[at], y: numbers[at + 1]};
}
function box(numbers) {
  return {lower: point(numbers), upper: point(numbers, 2)};
}

const kNoIndex = 0xFFFFFFFF;  // of an invalid handle
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
function contactsOf(world, place) {
  const n = result(place).slice();
  return Array.from({length: n.length / kContact}, (_, i) => contactAt(world, n, i * kContact));
}
function readContact(world) {
  return contactAt(world, view(Float64Array, calls.numbers(kContact), kContact), 0);
}

/// A call during which the engine asks the user's functions. An error of theirs must not leave by way of the engine, whose
/// stack nothing unwinds: it is kept, further questions are answered with yes, and it is thrown when the call has ended.
class Asking {
  constructor(world, condition = null) {
    this.world = world;
    this.condition = condition;
    this.thrown = null;
  }
  ask(field, question) {
    if (this.thrown !== null) return 1;
    try {
      return answered(question(), field) ? 1 : 0;
    } catch (error) {
      this.thrown = {error};
      return 1;
    }
  }
}
let asked = null;  // the call that asks now
/// Calls the engine; it asks `world` or `condition`. An error of the engine's leaves no lock behind.
function asking(world, condition, name, args, input) {
  const before = asked, mine = new Asking(world, condition), address = world._address;
  const locks = calls.world_locks(address), stepping = calls.world_stepping(address);
  asked = mine;
  let made;
  try {
    made = call(name, args, input);
  } catch (error) {
    calls.world_set_locks(address, locks, stepping);
    throw error;
  } finally {
    asked = before;
  }
  if (mine.thrown !== null) throw mine.thrown.error;
  return made;
}

/// Does `work`, which asks the user's functions, with the world locked as in the engine's callbacks.
function locked(world, work) {
  const address = world._address, locks = calls.world_locks(address), stepping = calls.world_stepping(address);
  calls.world_set_locks(address, locks + 1, stepping);
  try {
    return work();
  } finally {
    calls.world_set_locks(address, locks, stepping);
  }
}

// ---- Objects --------------------------------------------------------------------------------------------------------

/// Has only the properties of its class: others are refused. The proxy is the last prototype, so that it is asked about
/// nothing that exists. Fields of a derived class are its own.
class Closed {}
Object.setPrototypeOf(Closed.prototype, new Proxy({}, {
  set(_, name, value, object) {
    const others = settable(object).join(", ") || "nothing";
    refuse(String(name), value, `is not a property of a ${object._kind}; can be set: ${others}`, "UnknownName");
  },
}));
function settable(object) {
  const all = Object.entries(Object.getOwnPropertyDescriptors(kClosed[object._kind].prototype));
  return all.filter(([, {set}]) => set !== undefined && !set.refuses).map(([name]) => name);
}
/// Makes properties that are only read say so when they are set.
function refuseToSet({prototype}) {
  for (const [name, property] of Object.entries(Object.getOwnPropertyDescriptors(prototype))) {
    if (property.get === undefined || property.set !== undefined) continue;
    const set = (value) => refuse(name, value, "is read only", "Unsupported");
    Object.defineProperty(prototype, name, {...property, set: Object.assign(set, {refuses: true})});
  }
}

class Handle extends Closed {
  world;
  index;
  generation;
  constructor(world, index, generation) {
    super();
    this.world = world;
    this.index = index;
    this.generation = generation;
    Object.freeze(this);
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
  get _kind() { return "Body"; }  // a bundler may rename classes
  get valid() { return this.world._alive && this._call("body_valid") !== 0; }
  get position() { return point(result(this._call("body_position"))); }
  set position(p) { this._call("body_set_pose", ...pair(p), this.angle); }
  get centre() { return point(result(this._call("body_centre"))); }
  get angle() { return this._call("body_angle"); }
  set angle(value) { this._call("body_set_pose", ...pair(this.position), number(value, "angle")); }
  get velocity() { return point(result(this._call("body_velocity"))); }
  set velocity(v) { this._call("body_set_velocity", ...pair(v, "velocity")); }
  get angularVelocity() { return this._call("body_angular_velocity"); }
  set angularVelocity(value) { this._call("body_set_angular_velocity", number(value, "angularVelocity")); }
  get type() { return kNames.type[this._call("body_type")]; }
  set type(name) { this._call("body_set_type", named("type", name)); }
  get mass() { return this._call("body_mass"); }
  get inertia() { return this._call("body_inertia"); }
  get gravityScale() { return this._call("body_gravity_scale"); }
  set gravityScale(value) { this._call("body_set_gravity_scale", number(value, "gravityScale")); }
  get linearDamping() { return this._call("body_linear_damping"); }
  set linearDamping(value) { this._call("body_set_damping", number(value, "linearDamping"), this.angularDamping); }
  get angularDamping() { return this._call("body_angular_damping"); }
  set angularDamping(value) { this._call("body_set_damping", this.linearDamping, number(value, "angularDamping")); }
  get locks() {
    const bits = this._call("body_locks");
    return {x: (bits & 1) !== 0, y: (bits & 2) !== 0, rotation: (bits & 4) !== 0};
  }
  set locks(given) {
    const {x, y, rotation} = {...this.locks, ...knownLocks(given)};
    this._call("body_set_locks", flag(x, "x"), flag(y, "y"), flag(rotation, "rotation"));
  }
  get awake() { return this._call("body_awake") !== 0; }
  set awake(on) { this._call("body_set_awake", flag(on, "awake")); }
  get maySleep() { return this._call("body_may_sleep") !== 0; }
  set maySleep(on) { this._call("body_set_may_sleep", flag(on, "maySleep")); }
  get userData() { return BigInt.asUintN(64, this._call("body_user_data")); }
  set userData(data) { this._call("body_set_user_data", bits(data, "userData")); }
  get name() { return text(this._call("body_name")); }
  set name(name) {
    putBytes(encoder.encode(textOf(name, "name")));
    this._call("body_set_name");
  }
  get continuous() { return this._call("body_continuous") !== 0; }
  set continuous(on) { this._call("body_set_continuous", flag(on, "continuous")); }
  get enabled() { return this._call("body_enabled") !== 0; }
  set enabled(on) { this._call("body_set_enabled", flag(on, "enabled")); }
  get box() { return box(result(this._call("body_box"))); }
  get quarantined() { return this._call("body_quarantined") !== 0; }
  get shapes() { return handles(Shape, this.world, result(this._call("body_shapes"))); }
  get joints() { return handles(Joint, this.world, result(this._call("body_joints"))); }
  get contacts() { return contactsOf(this.world, this._call("body_contacts")); }
  velocityAt(at) { return point(result(this._call("body_velocity_at", ...pair(at, "point")))); }
  worldPoint(local) { return point(result(this._call("body_world_point", ...pair(local, "point")))); }
  localPoint(at) { return point(result(this._call("body_local_point", ...pair(at, "point")))); }

  setPose(position, angle) { this._call("body_set_pose", ...pair(position), number(angle, "angle")); }
  setMass(mass) { this._call("body_set_mass", ...massOf(mass)); }
  useDensities() { this._call("body_use_densities"); }
  setLocks(locks) { this.locks = locks; }
  moveTowards(position, angle, dt) {
    this._call("body_move_towards", ...pair(position), number(angle, "angle"), number(dt, "dt"));
  }
  applyForce(force, at = null) {
    if (at === null) this._call("body_apply_force", ...pair(force, "force"));
    else this._call("body_apply_force_at", ...pair(force, "force"), ...pair(at, "point"));
  }
  applyTorque(torque) { this._call("body_apply_torque", number(torque, "torque")); }
  applyImpulse(impulse, at = null) {
    if (at === null) this._call("body_apply_impulse", ...pair(impulse, "impulse"));
    else this._call("body_apply_impulse_at", ...pair(impulse, "impulse"), ...pair(at, "point"));
  }
  applyAngularImpulse(impulse) { this._call("body_apply_angular_impulse", number(impulse, "impulse")); }
  createShape(shape) {
    const made = result(call("shape_create", [this.world._address, this.index, this.generation], shapeOf(shape)));
    return new Shape(this.world, made[0], made[1]);
  }
  createChain(chain) {
    const made = result(call("chain_create", [this.world._address, this.index, this.generation], chainOf(chain)));
    return new Chain(this.world, made[0], made[1]);
  }
  release() { this._call("body_release"); }
  destroy() { this._call("body_destroy"); }
}

export class Shape extends Handle {
  get _kind() { return "Shape"; }
  get valid() { return this.world._alive && this._call("shape_valid") !== 0; }
  get body() {
    const n = result(this._call("shape_body"));
    return new Body(this.world, n[0], n[1]);
  }
  get userData() { return BigInt.asUintN(64, this._call("shape_user_data")); }
  set userData(data) { this._call("shape_set_user_data", bits(data, "userData")); }
  get density() { return this._call("shape_density"); }
  set density(value) { this._call("shape_set_density", number(value, "density")); }
  get sensor() { return this._call("shape_sensor") !== 0; }
  set sensor(on) { this._call("shape_set_sensor", flag(on, "sensor")); }
  get hitEvents() { return this._call("shape_hit_events") !== 0; }
  set hitEvents(on) { this._call("shape_set_hit_events", flag(on, "hitEvents")); }
  get preSolve() { return this._call("shape_pre_solve") !== 0; }
  set preSolve(on) { this._call("shape_set_pre_solve", flag(on, "preSolve")); }
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
  get filter() { return filterAt(result(this._call("shape_filter"))); }
  set filter(f) { call("shape_set_filter", [this.world._address, this.index, this.generation], filterOf(f)); }
  get chain() {
    const [index, generation] = result(this._call("shape_chain"));
    return index === kNoIndex ? null : new Chain(this.world, index, generation);
  }
  /// The present definition, in the body's frame: it could be created again. A box is a polygon then.
  get definition() {
    const {density, sensor, hitEvents, preSolve, userData} = this;
    return {...definitionOfShape(result(this._call("shape_geometry"))), density, ...this.material, filter: this.filter,
      sensor, hitEvents, preSolve, userData};
  }
  get overlapping() { return handles(Shape, this.world, result(this._call("shape_overlapping"))); }
  destroy() { this._call("shape_destroy"); }
}

export class Chain extends Handle {
  get _kind() { return "Chain"; }
  get valid() { return this.world._alive && this._call("chain_valid") !== 0; }
  get body() {
    const n = result(this._call("chain_body"));
    return new Body(this.world, n[0], n[1]);
  }
  get segments() { return handles(Shape, this.world, result(this._call("chain_segments"))); }
  destroy() { this._call("chain_destroy"); }
}

export class Joint extends Handle {
  get _kind() { return "Joint"; }
  get valid() { return this.world._alive && this._call("joint_valid") !== 0; }
  get bodies() { return handles(Body, this.world, result(this._call("joint_bodies"))); }
  get kind() { return kNames.joint[result(this._call("joint_definition"))[0]]; }
  /// The present definition, without its kind.
  get definition() { return definitionOfJoint(result(this._call("joint_definition"))); }
  get userData() { return BigInt.asUintN(64, this._call("joint_user_data")); }
  set userData(data) { this._call("joint_set_user_data", bits(data, "userData")); }
  change(kind, definition = {}) {
    call("joint_change", [this.world._address, this.index, this.generation], jointOf(kind, definition));
  }
  read() {
    const [force, torque, linearError, angularError, angle, translation, length] = result(this._call("joint_read"));
    return {force, torque, linearError, angularError, angle, translation, length};
  }
  /// The constants of its springs: stiffness in N/m and N m/rad, damping in N s/m and N m s/rad.
  stiffness() {
    const [linear, angular, linearDamping, angularDamping] = result(this._call("joint_stiffness"));
    return {linear, angular, linearDamping, angularDamping};
  }
  setLoadEvents(loads) {
    const {force = 0, torque = 0} = knownLoads(loads);
    this._call("joint_set_load_events", number(force, "force"), number(torque, "torque"));
  }
  destroy() { this._call("joint_destroy"); }
}

function query(name, args, input, world, filter) {
  return filter?.condition ? asking(world, filter.condition, name, args, input) : call(name, args, input);
}

const collected = new FinalizationRegistry((address) => calls.world_destroy(address));

export class World extends Closed {
  constructor(definition = {}) {
    super();
    this.#address = call("world_create", [], worldOf(definition));
    collected.register(this, this.#address, this);
  }
  get _kind() { return "World"; }
  #address;
  // The user's hooks. They are the world's alone: a list of all hooks would keep every world that its hook knows.
  _preSolve = null;
  _filter = null;
  get _address() {
    if (this.#address === 0) throw new PlumbError("UnknownName", "world: was destroyed", "world");
    return this.#address;
  }
  /// False once it was destroyed.
  get _alive() { return this.#address !== 0; }
  /// Frees the world's memory now; without it that happens when the object is collected. Refused in a hook.
  destroy() {
    if (!this._alive) return;
    call("world_destroy", [this.#address]);
    collected.unregister(this);
    this.#address = 0;
  }

  step(dt = 1 / 60, substeps = 4, count = 1) {
    number(dt, "dt"), whole(substeps, "substeps", 1, 1000), whole(count, "count", 0);
    for (let i = 0; i < count; ++i) asking(this, null, "world_step", [this._address, dt, substeps]);
  }
  get stepCount() { return call("world_step_count", [this._address]); }
  /// The settings as they are now; a world could be made of them again.
  get definition() { return definitionOfWorld(result(call("world_definition", [this._address]))); }
  get time() { return call("world_time", [this._address]); }
  /// 16 hexadecimal digits, the same as of a native program that makes the same calls.
  hash() { return hex(call("world_hash", [this._address])); }
  fullHash() { return hex(call("world_full_hash", [this._address])); }
  get gravity() { return point(result(call("world_gravity", [this._address]))); }
  set gravity(g) { call("world_set_gravity", [this._address, ...pair(g, "gravity")]); }
  get sleeping() { return this.definition.sleeping; }
  set sleeping(on) { call("world_set_sleeping", [this._address, flag(on, "sleeping")]); }
  get continuous() { return this.definition.continuous; }
  set continuous(on) { call("world_set_continuous", [this._address, flag(on, "continuous")]); }
  get directIslands() { return this.definition.directIslands; }
  set directIslands(on) { call("world_set_direct_islands", [this._address, flag(on, "directIslands")]); }
  get quarantine() { return this.definition.quarantine; }
  set quarantine(on) { call("world_set_quarantine", [this._address, flag(on, "quarantine")]); }
  get iterations() { return this.definition.iterations; }
  set iterations(count) { call("world_set_iterations", [this._address, whole(count, "iterations", 1, 1000)]); }
  get solver() { return this.definition.solver; }
  set solver(name) { call("world_set_solver", [this._address, named("solver", name)]); }
  get thresholds() {
    const [hit, bounce, sleep] = result(call("world_thresholds", [this._address]));
    return {hit, bounce, sleep};
  }
  set thresholds(t) {
    call("world_set_thresholds", [this._address], thresholdsOf({...this.thresholds, ...knownThresholds(t)}));
  }
  set profiling(on) { call("world_set_profiling", [this._address, flag(on, "profiling")]); }
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
    const input = bodyOf(definition), name = encoder.encode(textOf(definition.name ?? "", "name"));
    putBytes(name);
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
    const n = view(Uint32Array, call("world_bodies", [this._address]), 2 * calls.body_count(this._address));
    return handles(Body, this, n);
  }
  /// Bodies whose pose the last step may have changed; not sorted.
  get moved() { return handles(Body, this, result(call("world_moved", [this._address]))); }
  /// Bodies in quarantine and their faults, oldest first.
  get quarantined() {
    const n = result(call("world_quarantined", [this._address])).slice();
    return Array.from({length: n.length / 5}, (_, i) => ({body: new Body(this, n[5 * i], n[5 * i + 1]),
      field: text(n[5 * i + 2]), value: n[5 * i + 3], step: n[5 * i + 4]}));
  }
  get poses() { return this.#array("world_poses"); }
  get velocities() { return this.#array("world_velocities"); }
  #array(name) {
    return view(Float64Array, call(name, [this._address]), 3 * calls.body_count(this._address));
  }

  get contacts() { return contactsOf(this, call("world_contacts", [this._address])); }
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
    const on = called(hook, "hook") !== null;
    call("world_on_pre_solve", [this._address, Number(on)]);
    this._preSolve = hook ?? null;
  }
  onFilter(filter) {
    const on = called(filter, "filter") !== null;
    call("world_on_filter", [this._address, Number(on)]);
    this._filter = filter ?? null;
  }

  save() {
    const size = call("world_save", [this._address]);
    return view(Uint8Array, calls.bytes(size), size).slice();
  }
  restore(saved) {
    putBytes(bytesOf(saved, "bytes"));
    call("world_restore", [this._address]);
  }

  rayCast(origin, translation, filter) {
    return this.#hit(result(query("ray_cast", [this._address],
      [...pair(origin, "origin"), ...pair(translation, "translation"), ...queryOf(this, filter)], this, filter)), "fraction");
  }
  /// All hits, sorted by fraction.
  rayCastAll(origin, translation, filter) {
    const n = result(query("ray_cast_all", [this._address],
      [...pair(origin, "origin"), ...pair(translation, "translation"), ...queryOf(this, filter)], this, filter)).slice();
    return Array.from({length: n.length / 9}, (_, i) => this.#hit(n.subarray(9 * i, 9 * i + 9), "fraction"));
  }
  castShape(shape, position, angle, translation, filter) {
    const input = [...geometryOf(shape), ...pair(position), number(angle, "angle"), ...pair(translation, "translation"),
      ...queryOf(this, filter)];
    return this.#hit(result(query("cast_shape", [this._address], input, this, filter)), "fraction");
  }
  overlapShape(shape, position, angle = 0, filter = {}) {
    const input = [...geometryOf(shape), ...pair(position), number(angle, "angle"), ...queryOf(this, filter)];
    return handles(Shape, this, result(query("overlap_shape", [this._address], input, this, filter)));
  }
  overlapBox(box, filter) {
    return handles(Shape, this, result(query("overlap_box", [this._address],
      [...boundsOf(box, "box"), ...queryOf(this, filter)], this, filter)));
  }
  /// The distance of two shapes, negative where they overlap.
  distance(a, b) {
    own(this, a, "a", "Shape"), own(this, b, "b", "Shape");
    const n = result(call("distance", [this._address, a.index, a.generation, b.index, b.generation]));
    return {pointA: point(n), pointB: point(n, 2), normal: point(n, 4), distance: n[6]};
  }
  shapesAt(at, filter) {
    return handles(Shape, this, result(query("shapes_at", [this._address], [...pair(at, "point"), ...queryOf(this, filter)],
      this, filter)));
  }
  nearest(at, maxDistance, filter) {
    return this.#hit(result(query("nearest", [this._address], [...pair(at, "point"), number(maxDistance, "maxDistance"), ...queryOf(this, filter)],
      this, filter)), "distance");
  }
  move(capsule, position, velocity, dt, options = {}) {
    const {push, input} = moverOf(options), {filter} = options;
    const n = result(query("move", [this._address, push], [...geometryOf({capsule}), ...pair(position),
      ...pair(velocity, "velocity"), number(dt, "dt"), ...input, ...queryOf(this, filter)], this, filter));
    return {position: point(n), velocity: point(n, 2), onGround: n[4] !== 0, squeezed: n[5] !== 0,
      groundNormal: point(n, 6), ground: new Body(this, n[8], n[9]), groundVelocity: point(n, 10)};
  }

  // Force laws: each call adds the forces of the next step, `dt` s long.
  /// Applies a law of your own: it returns {force, torque} for each body, or nothing. It sees bodies as at the middle of
  /// the step, which keeps the energy of springs and orbits; with dt = 0 as they are.
  applyLaw(law, dt, options) {
    called(law, "law");
    const {wakes} = lawOf(options), n = result(call("law_bodies", [this._address, number(dt, "dt"), wakes])).slice();
    const wrenches = [];
    locked(this, () => {
      for (let i = 0; i < n.length; i += 12) {
        const userData = BigInt(n[i + 10]) | BigInt(n[i + 11]) << 32n;
        wrenches.push(...wrenchOf(law({body: new Body(this, n[i], n[i + 1]), centre: point(n, i + 2), angle: n[i + 4],
          velocity: point(n, i + 5), angularVelocity: n[i + 7], mass: n[i + 8], inertia: n[i + 9], userData})));
      }
    });
    asking(this, null, "apply_wrenches", [this._address, wakes], wrenches);
  }
  applyLinearDrag(rates, dt, options) {
    call("apply_linear_drag", [this._address, ...dragOf(rates), number(dt, "dt"), lawOf(options).wakes]);
  }
  applyQuadraticDrag(coefficient, dt, options) {
    call("apply_quadratic_drag", [this._address, number(coefficient, "coefficient"), number(dt, "dt"),
      lawOf(options).wakes]);
  }
  /// Attracts to a point, or to a body: the reaction acts on a dynamic one.
  applyAttraction(centre, law, dt, options) {
    const {wakes} = lawOf(options), input = attractionOf(law);
    if (centre instanceof Body) {
      own(this, centre, "centre");
      call("apply_attraction_to", [this._address, centre.index, centre.generation, number(dt, "dt"), wakes], input);
    } else {
      call("apply_attraction", [this._address, number(dt, "dt"), wakes], [...input, ...pair(centre, "centre")]);
    }
  }
  applyWind(wind, dt, options) { call("apply_wind", [this._address, ...windOf(wind), number(dt, "dt"), lawOf(options).wakes]); }
  applyWater(water, dt, options) { call("apply_water", [this._address, number(dt, "dt"), lawOf(options).wakes], waterOf(water)); }
  /// Pulls between points of two bodies, in the bodies' frames, without a joint.
  applySpring(a, pointA, b, pointB, spring, dt, options) {
    own(this, a, "a"), own(this, b, "b");
    call("apply_spring", [this._address, a.index, a.generation, b.index, b.generation, number(dt, "dt"),
      lawOf(options).wakes],
      [...pair(pointA, "pointA"), ...pair(pointB, "pointB"), ...elasticOf(spring)]);
  }
  /// Applies impulses at once to all dynamic bodies in reach.
  explode(blast) { query("explode", [this._address], blastOf(this, blast), this, blast.cover); }

  /// Calls the functions of `to` for each item: polygon, circle, capsule, segment, point, text. Those that are missing are
  /// left out, other functions refused. The world is locked meanwhile.
  draw(to, options) {
    drawnTo(to);
    const n = result(asking(this, null, "world_draw", [this._address], drawOf(options))).slice();
    locked(this, () => this.#drawItems(n, to));
  }
  #drawItems(n, to) {
    for (let i = 0; i < n.length;) {
      const item = n[i], role = kRoles[n[i + 1]];
      i += 2;
      if (item === 0) {
        const corners = Array.from({length: n[i + 1]}, (_, k) => point(n, i + 2 + 2 * k));
        to.polygon?.(corners, n[i], role);
        i += 2 + 2 * corners.length;
      } else if (item === 1) {
        to.circle?.(point(n, i), n[i + 2], point(n, i + 3), role);
        i += 5;
      } else if (item === 2) {
        to.capsule?.(point(n, i), point(n, i + 2), n[i + 4], role);
        i += 5;
      } else if (item === 3) {
        to.segment?.(point(n, i), point(n, i + 2), role);
        i += 4;
      } else if (item === 4) {
        to.point?.(point(n, i), role);
        i += 2;
      } else {
        const letters = Uint8Array.from(n.subarray(i + 3, i + 3 + n[i + 2]));
        to.text?.(point(n, i), decoder.decode(letters), role);
        i += 3 + letters.length;
      }
    }
  }

  #hit(n, last) {
    if (n.length === 0) return null;
    return {shape: new Shape(this, n[0], n[1]), body: new Body(this, n[2], n[3]), point: point(n, 4),
      normal: point(n, 6), [last]: n[8]};
  }
}

const forgotten = new FinalizationRegistry((address) => calls.rollback_destroy(address));

/// The last states of a world in memory, for network play: a late input is taken by going back and stepping again.
const kFarStep = Number.MAX_SAFE_INTEGER;
export class Rollback extends Closed {
  get _kind() { return "Rollback"; }
  #world;  // which stays as long as this does
  _address;
  constructor(world, frames) {
    super();
    if (!(world instanceof World)) refuse("world", world, "must be a World");
    this.#world = world;
    this._address = call("rollback_create", [world._address, whole(frames, "frames", 1, 10000)]);
    forgotten.register(this, this._address, this);
  }
  /// Saves the present state under its step count, instead of the oldest one if it is full.
  save() { this.#call("rollback_save"); }
  /// Restores the state after `step` steps, and drops later ones.
  backTo(step) { this.#call("rollback_back_to", whole(step, "step", -kFarStep, kFarStep)); }
  holds(step) { return this.#call("rollback_holds", whole(step, "step", -kFarStep, kFarStep)) !== 0; }
  get oldest() { return result(this.#call("rollback_range"))[0]; }
  get latest() { return result(this.#call("rollback_range"))[1]; }
  get size() { return result(this.#call("rollback_range"))[2]; }
  destroy() {
    forgotten.unregister(this);
    if (this._address !== 0) calls.rollback_destroy(this._address);
    this._address = 0;
  }
  #call(name, ...args) {
    if (this._address === 0 || !this.#world._alive)
      throw new PlumbError("UnknownName", "the rollback or its world was destroyed", "rollback");
    return call(name, [this._address, ...args]);
  }
}

const kClosed = {Body, Shape, Chain, Joint, World, Rollback};
for (const Type of Object.values(kClosed)) refuseToSet(Type);

function hex(bits) {
  return BigInt.asUintN(64, bits).toString(16).padStart(16, "0");
}
