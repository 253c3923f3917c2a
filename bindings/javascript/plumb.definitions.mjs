// Writes definitions as numbers in the order in which buffer.cpp reads them; refuses unknown names and fields.

export const kNames = {
  precision: ["float", "double"],
  type: ["static", "kinematic", "dynamic"],
  combine: ["geometric_mean", "product", "maximum", "minimum", "average"],
  solver: ["soft_steps", "sequential_impulses", "jakobsen", "xpbd", "direct"],
  integrator: ["velocity_verlet", "semi_implicit_euler", "explicit_euler"],
  joint: ["distance", "revolute", "prismatic", "weld", "wheel", "motor", "mouse", "gear", "pulley", "ratchet",
    "friction"],
  falloff: ["inverse_square", "linear"],
  shape: ["circle", "box", "capsule", "polygon", "segment"],
};

/// Reports a refusal by plumb: `kind`, and the parts of the sentence in `message`.
export class PlumbError extends Error {
  constructor(kind, message, subject = "", field = "", value = "") {
    super(message);
    Object.assign(this, {name: "PlumbError", kind, subject, field, value});
  }
}

function shown(value) {
  if (typeof value !== "object") return String(value);
  if (value?._kind !== undefined) return `a ${value._kind}`;
  try {
    return JSON.stringify(value, (_, part) => (typeof part === "bigint" ? String(part) : part));
  } catch {
    return String(value);  // it contains itself
  }
}
export function refuse(field, value, problem, kind = "InvalidValue") {
  const text = shown(value);
  throw new PlumbError(kind, `${field} is ${text}: ${problem}`, "", field, text);
}
export function named(kind, name, field = kind) {
  const place = kNames[kind].indexOf(name);
  return place >= 0 ? place : refuse(field, name, `must be one of ${kNames[kind].join(", ")}`, "UnknownName");
}
/// Returns `object`; refuses one with another field than `fields`.
function known(fields, object, subject) {
  if (object === null || typeof object !== "object" || Array.isArray(object))
    refuse(subject.split(" ").pop(), object, `must be {${[...fields].join(", ")}}`);
  for (const field of Object.keys(object))
    if (!fields.has(field)) refuse(field, object[field], `is not a field of ${subject}, which has ${[...fields].join(", ")}`, "UnknownName");
  return object;
}
export function listed(list, field) {
  return Array.isArray(list) ? list : refuse(field, list, "must be an array");
}
/// Refuses a handle of another kind, or of another world than `world`: its numbers would name another object.
export function own(world, handle, field, kind = "Body") {
  if (handle?._kind !== kind) refuse(field, handle?._kind ? `a ${handle._kind}` : handle, `must be a ${kind}`);
  if (handle.world !== world) refuse(field, "of another world", "must be of this world");
  return handle;
}

// WebAssembly and `BigInt` take almost anything for a number: what is none is refused here. Ranges are the engine's.
export function number(value, field) {
  return typeof value === "number" ? value : refuse(field, value, "must be a number");
}
/// Returns an integer of 32 bits.
export function whole(value, field, least = -(2 ** 31), most = 2 ** 31 - 1) {
  if (Number.isInteger(value) && value >= least && value <= most) return value;
  return refuse(field, value, `must be a whole number from ${least} to ${most}`);
}
export function flag(value, field) {
  return typeof value === "boolean" ? Number(value) : refuse(field, value, "must be true or false");
}
/// Returns the flag that `field` of `object` has, or `otherwise`.
const flagOf = (object, field, otherwise = false) => flag(object[field] ?? otherwise, field);
/// Returns 64 bits of a whole number; a negative one stands for the same bits, as -1 for all.
export function bits(value, field) {
  const ok = typeof value === "bigint" || Number.isInteger(value), wanted = ok ? BigInt(value) : 0n;
  if (!ok || wanted < -(2n ** 63n) || wanted >= 2n ** 64n)
    refuse(field, value, "must be a whole number of 64 bits: a bigint, or a number");
  return BigInt.asUintN(64, wanted);
}
function wide(value, field) {
  const all = bits(value ?? 0, field);
  return [Number(all & 0xFFFFFFFFn), Number(all >> 32n)];
}
export function pair(p, field = "position") {
  if (typeof p?.x !== "number" || typeof p?.y !== "number") refuse(field, p, "must be {x, y}");
  return [p.x, p.y];
}
/// Returns a function, or null for none.
export function called(value, field) {
  return value == null || typeof value === "function" ? value ?? null : refuse(field, value, "must be a function or null");
}
/// Returns a hook's answer: nothing is yes.
export function answered(value, field) {
  return value === undefined || typeof value === "boolean" ? value !== false
    : refuse(field, value, "must return true, false or nothing");
}
/// Returns the bytes of a buffer or of a view of one.
export function bytesOf(value, field) {
  if (value instanceof Uint8Array) return value;
  if (value instanceof ArrayBuffer) return new Uint8Array(value);
  return ArrayBuffer.isView(value) ? new Uint8Array(value.buffer, value.byteOffset, value.byteLength)
    : refuse(field, value, "must be a Uint8Array or an ArrayBuffer");
}
/// Returns a text.
export function textOf(value, field) {
  return typeof value === "string" ? value : refuse(field, value, "must be a string");
}
/// Returns the numbers that `object` has in fields, or those that stand here for missing ones.
const numbersOf = (object, otherwise) => Object.keys(otherwise).map((field) => number(object[field] ?? otherwise[field], field));
const kGeometryFields = {
  circle: new Set(["radius"]), box: new Set(["width", "height"]), capsule: new Set(["start", "end", "radius"]),
  polygon: new Set(["points", "radius"]), segment: new Set(["start", "end"]),
};
export function geometryOf(shape) {
  if (shape === null || typeof shape !== "object") refuse("shape", shape, `must have one of ${kNames.shape.join(", ")}`);
  const given = kNames.shape.filter((kind) => shape[kind] !== undefined);
  if (given.length !== 1) refuse("shape", given.join(" and ") || "empty", `must have one of ${kNames.shape.join(", ")}`);
  const kind = given[0], g = known(kGeometryFields[kind], shape[kind], `a ${kind}`), zero = {x: 0, y: 0};
  const points = listed(g.points ?? [], "points");
  return [named("shape", kind), ...numbersOf(g, {radius: 0, width: 0, height: 0}), ...pair(g.start ?? zero, "start"),
    ...pair(g.end ?? zero, "end"), points.length, ...points.flatMap((p) => pair(p, "points"))];
}
const kMaterialFields = new Set(["friction", "restitution", "rollingResistance", "surfaceSpeed"]);
export const knownMaterial = (m) => known(kMaterialFields, m, "a material");
const kChainFields = new Set(["points", "closed", "filter", "sensor", "hitEvents", "preSolve", "userData",
  "materials", ...kMaterialFields]);
export function chainOf(chain) {
  const {points, filter, userData, materials = []} = known(kChainFields, chain, "a chain");
  return [flagOf(chain, "closed"), ...materialOf(chain), ...filterOf(filter), flagOf(chain, "sensor"),
    flagOf(chain, "hitEvents"), flagOf(chain, "preSolve"), ...wide(userData, "userData"),
    listed(materials, "materials").length, ...materials.flatMap((m) => materialOf(knownMaterial(m))),
    listed(points, "points").length, ...points.flatMap((p) => pair(p, "points"))];
}
/// Returns the definition of a chain of these points (x and y in turn), whose segments have these materials.
export function definitionOfChain(closed, n, materials) {
  const points = Array.from({length: n.length / 2}, (_, i) => ({x: n[2 * i], y: n[2 * i + 1]}));
  const same = materials.every((m) => JSON.stringify(m) === JSON.stringify(materials[0]));
  return {points, closed: closed !== 0, ...(same ? materials[0] : {materials})};
}
export function materialOf(m) {
  return numbersOf(m, {friction: 0.6, restitution: 0, rollingResistance: 0, surfaceSpeed: 0});
}
const kFilterFields = new Set(["category", "mask", "group"]);
export function filterOf(f = {}) {
  known(kFilterFields, f, "a filter");
  return [...wide(f.category ?? 1, "category"), ...wide(f.mask ?? -1, "mask"), whole(f.group ?? 0, "group")];
}
const wideAt = (n, at) => BigInt(n[at]) | BigInt(n[at + 1]) << 32n;
export const filterAt = (n) => ({category: wideAt(n, 0), mask: wideAt(n, 2), group: n[4]});
const kThresholds = new Set(["hit", "bounce", "sleep"]);
export const knownThresholds = (t) => known(kThresholds, t, "the thresholds");
export function thresholdsOf(t) {
  return numbersOf(knownThresholds(t), {hit: -1, bounce: -1, sleep: -1});
}
const kLocks = new Set(["x", "y", "rotation"]), kLoads = new Set(["force", "torque"]), kBounds = new Set(["lower", "upper"]);
export const knownLocks = (locks) => known(kLocks, locks, "the locks");
export const knownLoads = (loads) => known(kLoads, loads, "the loads");
/// Returns the corners of a box along the axes.
export function boundsOf(box, field) {
  const {lower, upper} = known(kBounds, box, `a ${field}`);
  return [...pair(lower, "lower"), ...pair(upper, "upper")];
}
const kWorldFields = new Set(["precision", "gravity", "combineFriction", "combineRestitution", "sleeping", "continuous",
  "solver", "integrator", "iterations", "directIslands", "quarantine", "thresholds"]);
export function worldOf(definition) {
  const {precision = "float", gravity = {x: 0, y: -9.81}, combineFriction = "geometric_mean",
    combineRestitution = "maximum", sleeping = true, continuous = true, solver = "soft_steps",
    integrator = "velocity_verlet", iterations = 10, directIslands = true, quarantine = true,
    thresholds = {}} = known(kWorldFields, definition, "a world");
  return [named("precision", precision), ...pair(gravity, "gravity"),
    named("combine", combineFriction, "combineFriction"), named("combine", combineRestitution, "combineRestitution"),
    flag(sleeping, "sleeping"), flag(continuous, "continuous"), named("solver", solver), named("integrator", integrator),
    whole(iterations, "iterations", 1, 1000), flag(directIslands, "directIslands"), flag(quarantine, "quarantine"),
    ...thresholdsOf(thresholds)];
}
/// Returns the definition of which `worldOf` makes these numbers.
export function definitionOfWorld(n) {
  return {precision: kNames.precision[n[0]], gravity: {x: n[1], y: n[2]}, combineFriction: kNames.combine[n[3]],
    combineRestitution: kNames.combine[n[4]], sleeping: n[5] !== 0, continuous: n[6] !== 0, solver: kNames.solver[n[7]],
    integrator: kNames.integrator[n[8]], iterations: n[9], directIslands: n[10] !== 0, quarantine: n[11] !== 0,
    thresholds: {hit: n[12], bounce: n[13], sleep: n[14]}};
}
/// Returns geometry, position and angle of a shape from kind, radius, start, end, position, angle and points.
export function definitionOfShape(n) {
  const at = (i) => ({x: n[i], y: n[i + 1]}), kind = kNames.shape[n[0]], radius = n[1];
  const points = Array.from({length: (n.length - 9) / 2}, (_, i) => at(9 + 2 * i));
  const geometry = {circle: {radius}, capsule: {start: at(2), end: at(4), radius}, polygon: {points, radius},
    segment: {start: at(2), end: at(4)}}[kind];
  return {[kind]: geometry, position: at(6), angle: n[8]};
}
const kShapeFields = new Set([...kNames.shape, "position", "angle", "density", "friction", "restitution",
  "rollingResistance", "surfaceSpeed", "filter", "sensor", "hitEvents", "preSolve", "userData"]);
export function shapeOf(s) {
  known(kShapeFields, s, "a shape");
  return [...geometryOf(s), ...pair(s.position ?? {x: 0, y: 0}), ...numbersOf(s, {angle: 0, density: 1}), ...materialOf(s),
    ...filterOf(s.filter), flagOf(s, "sensor"), flagOf(s, "hitEvents"), flagOf(s, "preSolve"),
    ...wide(s.userData, "userData")];
}
const kBodyFields = new Set(["type", "position", "angle", "velocity", "angularVelocity", "mass", "gravityScale",
  "linearDamping", "angularDamping", "lockX", "lockY", "lockRotation", "maySleep", "awake", "continuous", "userData",
  "name", "shapes"]);
const kMassFields = new Set(["mass", "inertia", "centre"]);
/// Returns mass, centre and inertia.
export function massOf(given) {
  const {mass, inertia, centre = {x: 0, y: 0}} = known(kMassFields, given, "a mass");
  return [number(mass, "mass"), ...pair(centre, "centre"), number(inertia, "inertia")];
}
export function bodyOf(d) {
  known(kBodyFields, d, "a body");
  const zero = {x: 0, y: 0}, shapes = listed(d.shapes ?? [], "shapes").map(shapeOf);
  return [named("type", d.type ?? "dynamic"), ...pair(d.position ?? zero), number(d.angle ?? 0, "angle"),
    ...pair(d.velocity ?? zero, "velocity"), number(d.angularVelocity ?? 0, "angularVelocity"), Number(d.mass != null),
    ...massOf(d.mass ?? {mass: 1, inertia: 1}), ...numbersOf(d, {gravityScale: 1, linearDamping: 0, angularDamping: 0}),
    flagOf(d, "lockX"), flagOf(d, "lockY"), flagOf(d, "lockRotation"), flagOf(d, "maySleep", true), flagOf(d, "awake", true),
    flagOf(d, "continuous", true), ...wide(d.userData, "userData"), shapes.length, ...shapes.flat()];
}
const kQueryFields = new Set(["category", "mask", "sensors", "ignore", "condition"]);
export function queryOf(world, q = {}) {
  known(kQueryFields, q, "a query's filter");
  if (q.ignore) own(world, q.ignore, "ignore");
  return [...wide(q.category ?? -1, "category"), ...wide(q.mask ?? -1, "mask"), flagOf(q, "sensors"),
    q.ignore?.index ?? 0xFFFFFFFF, q.ignore?.generation ?? 0, Number(called(q.condition, "condition") !== null)];
}
const kLawFields = new Set(["wakes"]), kDragFields = new Set(["linear", "angular"]);
export const lawOf = (options = {}) => ({wakes: flagOf(known(kLawFields, options, "a law's options"), "wakes")});
export const dragOf = (rates) => numbersOf(known(kDragFields, rates, "a drag"), {linear: 0, angular: 0});
const kWrenchFields = new Set(["force", "torque"]);
export function wrenchOf(wrench) {
  const {force = {x: 0, y: 0}, torque = 0} = known(kWrenchFields, wrench ?? {}, "a law's result");
  return [...pair(force, "force"), number(torque, "torque")];
}
const kAttractionFields = new Set(["strength", "falloff", "softening"]);
export function attractionOf(law) {
  const {strength = 1, falloff = "inverse_square", softening = 0.1} = known(kAttractionFields, law, "an attraction");
  return [number(strength, "strength"), named("falloff", falloff), number(softening, "softening")];
}
const kWindFields = new Set(["velocity", "density"]);
export function windOf(wind) {
  const {velocity = {x: 0, y: 0}, density = 1.2} = known(kWindFields, wind, "a wind");
  return [...pair(velocity, "velocity"), number(density, "density")];
}
const kWaterFields = new Set(["level", "density", "velocity", "linearDrag", "angularDrag"]);
export function waterOf(water) {
  const {velocity = {x: 0, y: 0}} = known(kWaterFields, water, "a water");
  return [...numbersOf(water, {level: 0, density: 1}), ...pair(velocity, "velocity"),
    ...numbersOf(water, {linearDrag: 0, angularDrag: 0})];
}
const kElasticFields = new Set(["stiffness", "damping", "restLength", "pullsOnly"]);
export function elasticOf(spring) {
  known(kElasticFields, spring, "a spring");
  return [...numbersOf(spring, {stiffness: 100, damping: 0, restLength: 1}), flagOf(spring, "pullsOnly")];
}
const kBlastFields = new Set(["centre", "radius", "impulse", "occlusion", "cover"]);
export function blastOf(world, blast) {
  const {centre = {x: 0, y: 0}, cover} = known(kBlastFields, blast, "a blast");
  return [...pair(centre, "centre"), ...numbersOf(blast, {radius: 5, impulse: 100}), flagOf(blast, "occlusion"),
    ...queryOf(world, cover)];
}
/// Meanings of drawn items, by the C interface's numbers.
export const kRoles = ["static", "kinematic", "awake", "asleep", "sensor", "contact", "normal", "impulse", "box", "centre",
  "joint", "name"];
const kDrawFields = new Set(["shapes", "joints", "contacts", "normals", "impulses", "boxes", "centres", "names",
  "normalLength", "impulseLength", "bounds"]);
export function drawOf(options = {}) {
  const o = known(kDrawFields, options, "what is drawn");
  return [flagOf(o, "shapes", true), flagOf(o, "joints", true),
    ...["contacts", "normals", "impulses", "boxes", "centres", "names"].map((field) => flagOf(o, field)),
    ...numbersOf(o, {normalLength: 0.2, impulseLength: 0.1}), Number(o.bounds != null),
    ...(o.bounds != null ? boundsOf(o.bounds, "bounds") : [0, 0, 0, 0])];
}
const kDrawn = ["polygon", "circle", "capsule", "segment", "point", "text"];
/// Refuses what cannot be drawn to: a member of another type, or another function, which would not be called.
export function drawnTo(to) {
  if (to === null || typeof to !== "object") refuse("to", to, `must have some of the functions ${kDrawn.join(", ")}`);
  for (const name of kDrawn) called(to[name], name);
  for (const name of Object.keys(to))
    if (typeof to[name] === "function" && !kDrawn.includes(name))
      refuse(name, "a function", `is not called by draw, which calls ${kDrawn.join(", ")}`, "UnknownName");
}
const kMoverFields = new Set(["up", "maxSlope", "stepHeight", "skin", "mass", "pushForce", "push", "filter"]);
export function moverOf(options) {
  const {up = {x: 0, y: 1}} = known(kMoverFields, options, "the mover's options");
  return {push: flagOf(options, "push", true), input: [...pair(up, "up"),
    ...numbersOf(options, {maxSlope: 0.8, stepHeight: 0.3, skin: 0, mass: 0, pushForce: 1e12})]};
}
const kSpringFields = new Set(["hertz", "dampingRatio"]), kLimitFields = new Set(["lower", "upper"]);
const kMotorFields = new Set(["speed", "maxForce"]);
function spring(s) {
  if (s != null) known(kSpringFields, s, "a spring");
  return [Number(s != null), ...numbersOf(s ?? {}, {hertz: 0, dampingRatio: 1})];
}
const kJointFields = new Set(["collide", "breakForce", "breakTorque", "reportForce", "reportTorque", "userData",
  "anchorA", "anchorB", "axis", "referenceAngle", "spring", "linearSpring", "angularSpring", "limits", "motor", "length",
  "targetAngle", "targetTranslation", "targetPosition", "maxForce", "maxTorque", "ratio", "phase", "tooth", "groundA",
  "groundB"]);
export function jointOf(kind, d) {
  known(kJointFields, d, "a joint");
  if (d.limits != null) known(kLimitFields, d.limits, "limits");
  if (d.motor != null) known(kMotorFields, d.motor, "a motor");
  const zero = {x: 0, y: 0};
  const axis = d.axis ?? (kind === "wheel" ? {x: 0, y: 1} : {x: 1, y: 0});
  const drive = kind === "motor" ? {hertz: 2, dampingRatio: 1} : kind === "mouse" ? {hertz: 5, dampingRatio: 0.7} : null;
  return [named("joint", kind), flagOf(d, "collide"), ...numbersOf(d, {breakForce: 0, breakTorque: 0}),
    ...wide(d.userData, "userData"), ...numbersOf(d, {reportForce: 0, reportTorque: 0}),
    ...pair(d.anchorA ?? zero, "anchorA"), ...pair(d.anchorB ?? zero, "anchorB"), ...pair(axis, "axis"),
    number(d.referenceAngle ?? 0, "referenceAngle"), ...spring(d.spring ?? drive), ...spring(d.linearSpring),
    ...spring(d.angularSpring), Number(d.limits != null), ...numbersOf(d.limits ?? {}, {lower: -Infinity, upper: Infinity}),
    Number(d.motor != null), ...numbersOf(d.motor ?? {}, {speed: 0, maxForce: 0}),
    ...numbersOf(d, {length: kind === "pulley" ? -1 : 1, targetAngle: 0, targetTranslation: 0}),
    ...pair(d.targetPosition ?? zero, "targetPosition"),
    ...numbersOf(d, {maxForce: 0, maxTorque: 0, ratio: kind === "gear" ? -1 : 1, phase: 0, tooth: 0.1}),
    ...pair(d.groundA ?? zero, "groundA"), ...pair(d.groundB ?? zero, "groundB")];
}
/// Returns the definition of which `jointOf` makes these numbers.
export function definitionOfJoint(n) {
  const at = (i) => ({x: n[i], y: n[i + 1]});
  const springAt = (i) => (n[i] ? {hertz: n[i + 1], dampingRatio: n[i + 2]} : undefined);
  return {collide: n[1] !== 0, breakForce: n[2], breakTorque: n[3], userData: wideAt(n, 4), reportForce: n[6],
    reportTorque: n[7], anchorA: at(8), anchorB: at(10), axis: at(12), referenceAngle: n[14], spring: springAt(15),
    linearSpring: springAt(18), angularSpring: springAt(21), limits: n[24] ? {lower: n[25], upper: n[26]} : undefined,
    motor: n[27] ? {speed: n[28], maxForce: n[29]} : undefined, length: n[30], targetAngle: n[31], targetTranslation: n[32],
    targetPosition: at(33), maxForce: n[35], maxTorque: n[36], ratio: n[37], phase: n[38], tooth: n[39], groundA: at(40),
    groundB: at(42)};
}
