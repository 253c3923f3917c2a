// Handles of bodies, shapes, chains and joints of a world, and contacts as they are read.
import {close, Closed} from "./plumb.closed.mjs";
import {bits, chainOf, definitionOfChain, definitionOfJoint, definitionOfShape, filterAt, filterOf, flag, geometryOf,
  jointOf, kNames, knownLoads, knownLocks, knownMaterial, massOf, materialOf, named, number, own, pair, shapeOf, textOf}
  from "./plumb.definitions.mjs";
import {box, call, calls, encoder, point, putBytes, result, text, view} from "./plumb.memory.mjs";

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
export function contactsOf(world, place) {
  const n = result(place).slice();
  return Array.from({length: n.length / kContact}, (_, i) => contactAt(world, n, i * kContact));
}
export function readContact(world) {
  return contactAt(world, view(Float64Array, calls.numbers(kContact), kContact), 0);
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
export const handles = (Type, world, numbers) =>
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
  /// Replaces the geometry, in the body's frame; all else stays.
  setGeometry(geometry, position = {x: 0, y: 0}, angle = 0) {
    call("shape_set_geometry", [this.world._address, this.index, this.generation],
      [...geometryOf(geometry), ...pair(position), number(angle, "angle")]);
  }
  /// The contact with another shape, or null.
  contact(other) {
    own(this.world, other, "other", "Shape");
    return contactsOf(this.world, this._call("shape_contact", other.index, other.generation))[0] ?? null;
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
  /// The present definition; filter and flags are those of the first segment.
  get definition() {
    const all = this.segments, materials = all.map((segment) => segment.material);
    const {filter, sensor, hitEvents, preSolve, userData} = all[0];
    const [closed, ...n] = result(this._call("chain_points"));
    return {...definitionOfChain(closed, n, materials), filter, sensor, hitEvents, preSolve, userData};
  }
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

close({Body, Shape, Chain, Joint});
