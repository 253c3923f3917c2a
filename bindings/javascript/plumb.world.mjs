// A world: its settings, what is in it, its steps, queries, forces and drawing.
import {asking, locked, query} from "./plumb.asking.mjs";
import {close, Closed} from "./plumb.closed.mjs";
import {attractionOf, blastOf, bodyOf, boundsOf, bytesOf, called, definitionOfWorld, dragOf, drawnTo, drawOf,
  elasticOf, flag, geometryOf, jointOf, kRoles, knownThresholds, lawOf, moverOf, named, number, own, pair,
  PlumbError, queryOf, textOf, thresholdsOf, waterOf, whole, windOf, worldOf, wrenchOf}
  from "./plumb.definitions.mjs";
import {Body, contactsOf, handles, Joint, Shape} from "./plumb.handles.mjs";
import {call, calls, decoder, encoder, point, putBytes, result, text, view} from "./plumb.memory.mjs";

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

function hex(bits) {
  return BigInt.asUintN(64, bits).toString(16).padStart(16, "0");
}

close({World});
