/** plumb, a 2D rigid-body engine. SI units: m, kg, s, rad, N; y up; angles counter-clockwise. */

export interface Vec2 { x: number; y: number }
export type BodyType = "static" | "kinematic" | "dynamic";
export type Combine = "geometric_mean" | "product" | "maximum" | "minimum" | "average";
export type Solver = "soft_steps" | "sequential_impulses" | "jakobsen" | "xpbd" | "direct";
export type JointKind = "distance" | "revolute" | "prismatic" | "weld" | "wheel" | "motor" | "mouse" | "gear" |
  "pulley" | "ratchet" | "friction";

/** Something that plumb refuses. `message` is the whole sentence. */
export class PlumbError extends Error {
  kind: "SyntaxError" | "InvalidValue" | "UnknownName" | "Unsupported" | "RunError" | "FileError" | "InternalError";
  subject: string;
  field: string;
  value: string;
}

/** Exactly one of these; lengths in m. A box is given by its whole sides. */
export interface Geometry {
  circle?: {radius: number};
  box?: {width: number; height: number};
  capsule?: Capsule;
  polygon?: {points: Vec2[]; radius?: number};
  segment?: {start: Vec2; end: Vec2};
}
export interface Capsule { start: Vec2; end: Vec2; radius: number }
export interface Material {
  friction?: number;
  restitution?: number;
  rollingResistance?: number;
  /** m/s */
  surfaceSpeed?: number;
}
/** 64 bits; numbers beyond 2^53 need bigints, and -1 stands for all bits */
export interface Filter { category?: number | bigint; mask?: number | bigint; group?: number }
export interface ShapeDefinition extends Geometry, Material {
  position?: Vec2;
  angle?: number;
  /** kg/m^2, 1 by default */
  density?: number;
  filter?: Filter;
  sensor?: boolean;
  hitEvents?: boolean;
  preSolve?: boolean;
  userData?: number | bigint;
}
/** A line of one-sided segments: the front is to the right when walking from point to point. */
export interface ChainDefinition extends Material {
  /** one for each segment, in place of the chain's own */
  materials?: Material[];
  points: Vec2[];
  closed?: boolean;
  filter?: Filter;
  sensor?: boolean;
  hitEvents?: boolean;
  preSolve?: boolean;
  userData?: number | bigint;
}
export interface BodyDefinition {
  type?: BodyType;
  position?: Vec2;
  angle?: number;
  velocity?: Vec2;
  angularVelocity?: number;
  /** kg, kg m^2; without it the shapes' densities count */
  mass?: {mass: number; inertia: number; centre?: Vec2};
  gravityScale?: number;
  /** 1/s */
  linearDamping?: number;
  angularDamping?: number;
  lockX?: boolean;
  lockY?: boolean;
  lockRotation?: boolean;
  maySleep?: boolean;
  awake?: boolean;
  /** true by default: it does not tunnel */
  continuous?: boolean;
  userData?: number | bigint;
  name?: string;
  shapes?: ShapeDefinition[];
}
export interface Spring { hertz: number; dampingRatio?: number }
export interface JointDefinition {
  collide?: boolean;
  /** N and N m; 0: never */
  breakForce?: number;
  breakTorque?: number;
  /** N and N m, beyond which its load is in `events.loaded`; 0: never */
  reportForce?: number;
  reportTorque?: number;
  userData?: number | bigint;
  anchorA?: Vec2;
  anchorB?: Vec2;
  axis?: Vec2;
  referenceAngle?: number;
  spring?: Spring;
  linearSpring?: Spring;
  angularSpring?: Spring;
  limits?: {lower?: number; upper?: number};
  motor?: {speed: number; maxForce: number};
  length?: number;
  targetAngle?: number;
  targetTranslation?: number;
  targetPosition?: Vec2;
  maxForce?: number;
  maxTorque?: number;
  ratio?: number;
  phase?: number;
  tooth?: number;
  groundA?: Vec2;
  groundB?: Vec2;
}

/** frozen: its members cannot be set, and others not be added */
declare class Handle {
  readonly world: World;
  readonly index: number;
  readonly generation: number;
  equals(other: unknown): boolean;
}
export interface Box {
  lower: Vec2;
  upper: Vec2;
}
export interface Locks { x?: boolean; y?: boolean; rotation?: boolean }
export class Body extends Handle {
  readonly valid: boolean;
  position: Vec2;
  readonly centre: Vec2;
  angle: number;
  velocity: Vec2;
  angularVelocity: number;
  type: BodyType;
  readonly mass: number;
  readonly inertia: number;
  gravityScale: number;
  linearDamping: number;
  angularDamping: number;
  awake: boolean;
  maySleep: boolean;
  get locks(): Required<Locks>;
  /** members that are left out stay as they are */
  set locks(locks: Locks);
  get userData(): bigint;
  set userData(data: bigint | number);
  name: string;
  continuous: boolean;
  enabled: boolean;
  /** m, around its shapes */
  readonly box: Box;
  readonly quarantined: boolean;
  readonly shapes: Shape[];
  readonly joints: Joint[];
  readonly contacts: Contact[];
  /** m/s, of the body at a point of the world */
  velocityAt(point: Vec2): Vec2;
  worldPoint(local: Vec2): Vec2;
  localPoint(point: Vec2): Vec2;
  setPose(position: Vec2, angle: number): void;
  setMass(mass: {mass: number; inertia: number; centre?: Vec2}): void;
  useDensities(): void;
  /** the same as setting `locks` */
  setLocks(locks: Locks): void;
  moveTowards(position: Vec2, angle: number, dt: number): void;
  /** N, during the next step; at the centre of mass, or at a point of the world */
  applyForce(force: Vec2, at?: Vec2 | null): void;
  applyTorque(torque: number): void;
  /** N s, at once */
  applyImpulse(impulse: Vec2, at?: Vec2 | null): void;
  applyAngularImpulse(impulse: number): void;
  createShape(shape: ShapeDefinition): Shape;
  createChain(chain: ChainDefinition): Chain;
  release(): void;
  destroy(): void;
}
export class Shape extends Handle {
  readonly valid: boolean;
  readonly body: Body;
  get userData(): bigint;
  set userData(data: bigint | number);
  /** kg/m^2 */
  density: number;
  sensor: boolean;
  hitEvents: boolean;
  preSolve: boolean;
  /** of a segment; null for other shapes */
  readonly chain: Chain | null;
  /** in the body's frame; it could be created again. A box is a polygon */
  readonly definition: ShapeDefinition;
  /** m */
  readonly box: Box;
  /** the hit of a ray with this shape alone, m */
  rayCast(origin: Vec2, translation: Vec2): {point: Vec2; normal: Vec2; fraction: number} | null;
  contains(point: Vec2): boolean;
  material: Material;
  /** replaces the geometry, in the body's frame (m, rad); all else stays. Contacts end, and begin anew in the next step */
  setGeometry(geometry: Geometry, position?: Vec2, angle?: number): void;
  /** after a begin event, normal and separations are those at the beginning of the step that made it */
  contact(other: Shape): Contact | null;
  get filter(): {category: bigint; mask: bigint; group: number};
  set filter(filter: Filter);
  readonly overlapping: Shape[];
  destroy(): void;
}
export class Chain extends Handle {
  readonly valid: boolean;
  readonly body: Body;
  readonly segments: Shape[];
  /** as at present; it could be created again */
  readonly definition: ChainDefinition;
  destroy(): void;
}
export interface JointReading {
  force: number;
  torque: number;
  linearError: number;
  angularError: number;
  angle: number;
  translation: number;
  length: number;
}
export interface JointStiffness {
  linear: number;
  angular: number;
  linearDamping: number;
  angularDamping: number;
}
export class Joint extends Handle {
  readonly valid: boolean;
  readonly bodies: Body[];
  readonly kind: JointKind;
  readonly definition: JointDefinition;
  get userData(): bigint;
  set userData(data: bigint | number);
  change(kind: JointKind, definition?: JointDefinition): void;
  read(): JointReading;
  /** N/m, N m/rad, N s/m and N m s/rad; throws for a joint without springs */
  stiffness(): JointStiffness;
  /** N and N m, beyond which its load is in `events.loaded`; 0: never */
  setLoadEvents(loads: {force?: number; torque?: number}): void;
  destroy(): void;
}
export interface Contact {
  shapeA: Shape;
  shapeB: Shape;
  normal: Vec2;
  points: {point: Vec2; separation: number; impulse: number}[];
  approach: number;
  /** N s, of the whole step and both points; 0 without hitEvents or preSolve */
  stepImpulse: number;
}
export interface Touch { shapeA: Shape; shapeB: Shape }
export interface Events {
  begin: Touch[];
  end: Touch[];
  hits: (Touch & {point: Vec2; normal: Vec2; speed: number; impulse: number})[];
  sensorBegin: {sensor: Shape; visitor: Shape}[];
  sensorEnd: {sensor: Shape; visitor: Shape}[];
  broken: Joint[];
  /** N, N m: mean reactions over the last step */
  loaded: {joint: Joint; force: number; torque: number}[];
  fellAsleep: Body[];
  woke: Body[];
  quarantined: Body[];
}
export interface QueryFilter {
  category?: number | bigint;
  mask?: number | bigint;
  sensors?: boolean;
  ignore?: Body;
  /** tested last; must not change the world */
  condition?: (shape: Shape) => boolean | void;
}
export interface Hit { shape: Shape; body: Body; point: Vec2; normal: Vec2 }
export interface MoverOptions {
  up?: Vec2;
  maxSlope?: number;
  stepHeight?: number;
  skin?: number;
  mass?: number;
  pushForce?: number;
  push?: boolean;
  filter?: QueryFilter;
}
export interface MoverResult {
  position: Vec2;
  velocity: Vec2;
  onGround: boolean;
  squeezed: boolean;
  groundNormal: Vec2;
  ground: Body;
  groundVelocity: Vec2;
}
/** m/s; negative: by the sizes of the shapes or by gravity */
export interface Thresholds {
  /** approach from which impacts are hits */
  hit?: number;
  /** approach up to which nothing bounces */
  bounce?: number;
  /** up to which a body may fall asleep */
  sleep?: number;
}
export interface WorldDefinition {
  precision?: "float" | "double";
  gravity?: Vec2;
  combineFriction?: Combine;
  combineRestitution?: Combine;
  sleeping?: boolean;
  continuous?: boolean;
  solver?: Solver;
  integrator?: "velocity_verlet" | "semi_implicit_euler" | "explicit_euler";
  iterations?: number;
  directIslands?: boolean;
  quarantine?: boolean;
  thresholds?: Thresholds;
}

/** State of a body, as passed to a law: m, rad, m/s, rad/s, kg, kg m^2. */
export interface LawBody {
  body: Body;
  centre: Vec2;
  angle: number;
  velocity: Vec2;
  angularVelocity: number;
  mass: number;
  inertia: number;
  userData: bigint;
}
/** N, and N m about the centre of mass */
export interface Wrench { force?: Vec2; torque?: number }
/** Laws act on awake dynamic bodies; with `wakes` on sleeping ones as well, and wake those that they push. */
export interface LawOptions { wakes?: boolean }
export interface Attraction {
  /** m^3/s^2 (inverse square) or 1/s^2 (linear); negative repels */
  strength?: number;
  falloff?: "inverse_square" | "linear";
  /** m, below which the inverse square grows linearly from 0 */
  softening?: number;
}
/** m/s and kg/m^2 of the air */
export interface Wind { velocity?: Vec2; density?: number }
/** Water below a plane across gravity: m along "up", kg/m^2, m/s, N s/m and N m s for each m^2 under water. */
export interface Water {
  level?: number;
  density?: number;
  velocity?: Vec2;
  linearDrag?: number;
  angularDrag?: number;
}
/** N/m, N s/m, m */
export interface ElasticSpring { stiffness?: number; damping?: number; restLength?: number; pullsOnly?: boolean }
/** m, and N s for each m of surface square to it, at the centre */
export interface Blast {
  centre?: Vec2;
  radius?: number;
  impulse?: number;
  /** spares points that another body covers from the centre */
  occlusion?: boolean;
  cover?: QueryFilter;
}
export type DrawRole = "static" | "kinematic" | "awake" | "asleep" | "sensor" | "contact" | "normal" | "impulse" | "box" |
  "centre" | "joint" | "name";
/** Functions that draw items: m, in the world's frame, y up. Polygons are counter-clockwise. */
export interface DebugDraw {
  polygon?(corners: Vec2[], radius: number, role: DrawRole): void;
  circle?(centre: Vec2, radius: number, axis: Vec2, role: DrawRole): void;
  capsule?(start: Vec2, end: Vec2, radius: number, role: DrawRole): void;
  segment?(start: Vec2, end: Vec2, role: DrawRole): void;
  point?(point: Vec2, role: DrawRole): void;
  text?(point: Vec2, text: string, role: DrawRole): void;
}
/** Items to draw: shapes and joints by default. */
export interface DrawOptions {
  shapes?: boolean;
  joints?: boolean;
  contacts?: boolean;
  normals?: boolean;
  impulses?: boolean;
  boxes?: boolean;
  centres?: boolean;
  names?: boolean;
  /** m */
  normalLength?: number;
  /** m per N s */
  impulseLength?: number;
  /** m: leaves out what certainly lies outside */
  bounds?: Box;
}

/** A world of bodies, shapes and joints that advances in fixed steps. */
export class World {
  constructor(definition?: WorldDefinition);
  destroy(): void;
  step(dt?: number, substeps?: number, count?: number): void;
  readonly time: number;
  readonly stepCount: number;
  /** as it is now */
  readonly definition: Required<WorldDefinition>;
  /** 16 hexadecimal digits; equal on every platform and in every language for the same calls */
  hash(): string;
  fullHash(): string;
  gravity: Vec2;
  sleeping: boolean;
  continuous: boolean;
  directIslands: boolean;
  quarantine: boolean;
  iterations: number;
  solver: Solver;
  /** members that are left out stay as they are when it is set */
  thresholds: Thresholds;
  set profiling(on: boolean);
  /** ns */
  readonly profile: {broadPhase: number; narrowPhase: number; solver: number; finalize: number; continuous: number;
    events: number; sleep: number; steps: number};
  readonly counts: {bodies: number; awake: number; shapes: number; contacts: number; touching: number; joints: number};
  createBody(definition?: BodyDefinition): Body;
  createJoint(a: Body, b: Body, kind: JointKind, definition?: JointDefinition): Joint;
  /** All bodies, by index: the order of the rows of `poses` and `velocities`. */
  readonly bodies: Body[];
  /** x, y (m) and angle (rad) of each body, three numbers a body; valid until the next call */
  readonly poses: Float64Array;
  /** x, y (m/s) and angular velocity (rad/s) of each body; valid until the next call */
  readonly velocities: Float64Array;
  /** bodies whose pose the last step may have changed; not sorted */
  readonly moved: Body[];
  /** bodies in quarantine and their faults, oldest first */
  readonly quarantined: {body: Body; field: string; value: number; step: number}[];
  readonly contacts: Contact[];
  readonly events: Events;
  /** Asked about contacts of shapes with `preSolve`, in a step; false drops one in this step, and no result keeps it. An
   * error of a hook is thrown by `step` once the step is finished; in this one nothing more is asked, and all act. */
  onPreSolve(hook: ((contact: Contact) => boolean | void) | null): void;
  /** Asked about shapes that come near each other and that their filters let touch; false: they do not collide. It
   * must depend on the world's state alone. Errors are thrown as by `onPreSolve`. */
  onFilter(filter: ((a: Shape, b: Shape) => boolean | void) | null): void;
  save(): Uint8Array;
  restore(bytes: Uint8Array | ArrayBuffer): void;
  rayCast(origin: Vec2, translation: Vec2, filter?: QueryFilter): (Hit & {fraction: number}) | null;
  /** all hits, sorted by fraction */
  rayCastAll(origin: Vec2, translation: Vec2, filter?: QueryFilter): (Hit & {fraction: number})[];
  castShape(shape: Geometry, position: Vec2, angle: number, translation: Vec2, filter?: QueryFilter):
    (Hit & {fraction: number}) | null;
  overlapShape(shape: Geometry, position: Vec2, angle?: number, filter?: QueryFilter): Shape[];
  overlapBox(box: Box, filter?: QueryFilter): Shape[];
  /** m, negative where they overlap */
  distance(a: Shape, b: Shape): {pointA: Vec2; pointB: Vec2; normal: Vec2; distance: number};
  shapesAt(point: Vec2, filter?: QueryFilter): Shape[];
  nearest(point: Vec2, maxDistance: number, filter?: QueryFilter): (Hit & {distance: number}) | null;
  move(capsule: Capsule, position: Vec2, velocity: Vec2, dt: number, options?: MoverOptions): MoverResult;
  /** Force laws: each call adds the forces of the next step, `dt` s long. */
  /** Bodies are seen as at the middle of the step, which keeps the energy of springs and orbits; with dt = 0 as they are.
   *  The law may read the world and not change it. */
  applyLaw(law: (body: LawBody) => Wrench | void, dt: number, options?: LawOptions): void;
  /** N s/m and N m s */
  applyLinearDrag(rates: {linear?: number; angular?: number}, dt: number, options?: LawOptions): void;
  /** N s^2/m^2 */
  applyQuadraticDrag(coefficient: number, dt: number, options?: LawOptions): void;
  applyAttraction(centre: Vec2 | Body, law: Attraction, dt: number, options?: LawOptions): void;
  applyWind(wind: Wind, dt: number, options?: LawOptions): void;
  applyWater(water: Water, dt: number, options?: LawOptions): void;
  applySpring(a: Body, pointA: Vec2, b: Body, pointB: Vec2, spring: ElasticSpring, dt: number, options?: LawOptions): void;
  /** applies impulses at once to all dynamic bodies in reach */
  explode(blast: Blast): void;
  /** calls the functions of `to`, which may read the world and not change it; another function of it is refused */
  draw(to: DebugDraw, options?: DrawOptions): void;
}

/** The last states of a world in memory, for network play. */
export class Rollback {
  /** keeps up to `frames` states, 1 to 10000 */
  constructor(world: World, frames: number);
  /** under the present step count, instead of the oldest if it is full */
  save(): void;
  /** restores the state after `step` steps, and drops later ones */
  backTo(step: number): void;
  holds(step: number): boolean;
  /** -1: it is empty */
  readonly oldest: number;
  readonly latest: number;
  readonly size: number;
  destroy(): void;
}
