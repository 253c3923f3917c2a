// Writes definitions as numbers in the order in which buffer.cpp reads them; refuses unknown names and fields.

export const kNames = {
  precision: ["float", "double"],
  type: ["static", "kinematic", "dynamic"],
  combine: ["geometric_mean", "product", "maximum", "minimum", "average"],
  solver: ["soft_steps", "sequential_impulses", "jakobsen", "xpbd", "direct"],
  integrator: ["velocity_verlet", "semi_implicit_euler", "explicit_euler"],
  joint: ["distance", "revolute", "prismatic", "weld", "wheel", "motor", "mouse", "gear", "pulley", "ratchet",
    "friction"],
  shape: ["circle", "box", "capsule", "polygon", "segment"],
};

/// Reports a refusal by plumb: `kind`, and the parts of the sentence in `message`.
export class PlumbError extends Error {
  constructor(kind, message, subject = "", field = "", value = "") {
    super(message);
    Object.assign(this, {name: "PlumbError", kind, subject, field, value});
  }
}

function refuse(field, value, problem, kind = "InvalidValue") {
  throw new PlumbError(kind, `${field} is ${value}: ${problem}`, "", field, String(value));
}
export function named(kind, name, field = kind) {
  const place = kNames[kind].indexOf(name);
  return place >= 0 ? place : refuse(field, name, `must be one of ${kNames[kind].join(", ")}`, "UnknownName");
}
function known(fields, object, subject) {
  for (const field of Object.keys(object))
    if (!fields.has(field)) refuse(field, object[field], `is not a field of ${subject}`, "UnknownName");
}

export const flag = (value) => (value ? 1 : 0);
function wide(value = 0) {
  const bits = BigInt.asUintN(64, BigInt(value));
  return [Number(bits & 0xFFFFFFFFn), Number(bits >> 32n)];
}
export function pair(p, field = "position") {
  if (typeof p?.x !== "number" || typeof p?.y !== "number") refuse(field, JSON.stringify(p), "must be {x, y}");
  return [p.x, p.y];
}
export function geometryOf(shape) {
  const given = kNames.shape.filter((kind) => shape[kind] !== undefined);
  if (given.length !== 1) refuse("shape", given.join(" and ") || "empty", `must have one of ${kNames.shape.join(", ")}`);
  const kind = given[0], g = shape[kind], zero = {x: 0, y: 0};
  const points = g.points ?? [];
  return [named("shape", kind), g.radius ?? 0, g.width ?? 0, g.height ?? 0, ...pair(g.start ?? zero, "start"),
    ...pair(g.end ?? zero, "end"), points.length, ...points.flatMap((p) => pair(p, "points"))];
}
export function materialOf(m) {
  return [m.friction ?? 0.6, m.restitution ?? 0, m.rollingResistance ?? 0, m.surfaceSpeed ?? 0];
}
export function filterOf(f = {}) {
  return [...wide(f.category ?? 1), ...wide(f.mask ?? -1), f.group ?? 0];
}
export const thresholdsOf = ({hit = -1, bounce = -1, sleep = -1}) => [hit, bounce, sleep];
const kShapeFields = new Set([...kNames.shape, "position", "angle", "density", "friction", "restitution",
  "rollingResistance", "surfaceSpeed", "filter", "sensor", "hitEvents", "preSolve", "userData"]);
export function shapeOf(s) {
  known(kShapeFields, s, "a shape");
  return [...geometryOf(s), ...pair(s.position ?? {x: 0, y: 0}), s.angle ?? 0, s.density ?? 1, ...materialOf(s),
    ...filterOf(s.filter), flag(s.sensor), flag(s.hitEvents), flag(s.preSolve), ...wide(s.userData)];
}
const kBodyFields = new Set(["type", "position", "angle", "velocity", "angularVelocity", "mass", "gravityScale",
  "linearDamping", "angularDamping", "lockX", "lockY", "lockRotation", "maySleep", "awake", "continuous", "userData",
  "name", "shapes"]);
export function bodyOf(d) {
  known(kBodyFields, d, "a body");
  const zero = {x: 0, y: 0}, shapes = (d.shapes ?? []).map(shapeOf);
  return [named("type", d.type ?? "dynamic"), ...pair(d.position ?? zero), d.angle ?? 0,
    ...pair(d.velocity ?? zero, "velocity"), d.angularVelocity ?? 0, flag(d.mass), d.mass?.mass ?? 1,
    ...pair(d.mass?.centre ?? zero, "centre"), d.mass?.inertia ?? 1, d.gravityScale ?? 1, d.linearDamping ?? 0,
    d.angularDamping ?? 0, flag(d.lockX), flag(d.lockY), flag(d.lockRotation), flag(d.maySleep ?? true),
    flag(d.awake ?? true), flag(d.continuous ?? true), ...wide(d.userData), shapes.length, ...shapes.flat()];
}
export function queryOf(q = {}) {
  return [...wide(q.category ?? -1), ...wide(q.mask ?? -1), flag(q.sensors), q.ignore?.index ?? 0xFFFFFFFF,
    q.ignore?.generation ?? 0];
}
const spring = (s) => [flag(s), s?.hertz ?? 0, s?.dampingRatio ?? 1];
export function jointOf(kind, d) {
  const zero = {x: 0, y: 0};
  const axis = d.axis ?? (kind === "wheel" ? {x: 0, y: 1} : {x: 1, y: 0});
  const drive = kind === "motor" ? {hertz: 2, dampingRatio: 1} : kind === "mouse" ? {hertz: 5, dampingRatio: 0.7} : null;
  const ratio = d.ratio ?? (kind === "gear" ? -1 : 1);
  return [named("joint", kind), flag(d.collide), d.breakForce ?? 0, d.breakTorque ?? 0, ...wide(d.userData),
    d.reportForce ?? 0, d.reportTorque ?? 0,
    ...pair(d.anchorA ?? zero, "anchorA"), ...pair(d.anchorB ?? zero, "anchorB"), ...pair(axis, "axis"),
    d.referenceAngle ?? 0, ...spring(d.spring ?? drive), ...spring(d.linearSpring), ...spring(d.angularSpring),
    flag(d.limits), d.limits?.lower ?? -Infinity, d.limits?.upper ?? Infinity,
    flag(d.motor), d.motor?.speed ?? 0, d.motor?.maxForce ?? 0,
    d.length ?? (kind === "pulley" ? -1 : 1), d.targetAngle ?? 0, d.targetTranslation ?? 0,
    ...pair(d.targetPosition ?? zero, "targetPosition"), d.maxForce ?? 0, d.maxTorque ?? 0, ratio, d.phase ?? 0,
    d.tooth ?? 0.1, ...pair(d.groundA ?? zero, "groundA"), ...pair(d.groundB ?? zero, "groundB")];
}
