// What a program in TypeScript writes, and what the types must refuse. It is checked and not run.
import {Rollback, World, type Body, type DebugDraw, type JointReading, type LawBody, type Wrench} from "plumb-physics";

const world = new World({precision: "double", thresholds: {hit: 1}});
const ground: Body = world.createBody({type: "static", shapes: [{box: {width: 40, height: 2}, friction: 0.5}]});
const ball = world.createBody({position: {x: 0, y: 4}, shapes: [{circle: {radius: 0.5}, filter: {category: 1n << 40n}}]});
const joint = world.createJoint(ground, ball, "revolute", {anchorA: {x: 0, y: 5}, motor: {speed: 1, maxForce: 2}});
const reading: JointReading = joint.read();
const stiffness: number = joint.stiffness().angular;
joint.change(joint.kind, joint.definition);

const thrust = (body: LawBody): Wrench => ({force: {x: 0, y: body.mass * 9.81}});
world.applyLaw(thrust, 1 / 60, {wakes: true});
world.applyWind({velocity: {x: 5, y: 0}}, 1 / 60);
world.applyAttraction(ball, {falloff: "linear"}, 1 / 60);
const rollback = new Rollback(world, 60);
rollback.save();
world.step();
rollback.backTo(rollback.latest);

const lines: string[] = [];
const to: DebugDraw = {circle: (centre, radius, _axis, role) => lines.push(`${role} ${centre.x} ${radius}`)};
world.draw(to, {bounds: {lower: {x: 0, y: 0}, upper: {x: 1, y: 1}}});
const [shape] = ball.shapes;
const category: bigint = shape!.filter.category;
shape!.filter = {mask: -1};
shape!.setGeometry({box: {width: 1, height: 2}}, {x: 0, y: 1});
const began: number | undefined = shape!.contact(shape!)?.stepImpulse;
const chained = ground.createChain({points: [{x: 1, y: 0}, {x: 0, y: 0}], materials: [{friction: 1}]});
ground.createChain(chained.definition);
ball.locks = {rotation: true};
const locked: boolean = ball.locks.x;
const hit = world.rayCast({x: 0, y: 9}, {x: 0, y: -9}, {condition: (each) => !each.sensor});
const y: number | undefined = hit?.point.y;
const copy = new World(world.definition);

// @ts-expect-error: a misspelt field
world.createBody({positon: {x: 0, y: 0}});
// @ts-expect-error: an unknown kind of joint
world.createJoint(ground, ball, "hinge");
// @ts-expect-error: a point is {x, y}
ball.position = [1, 2];
// @ts-expect-error: it cannot be set
ball.mass = 3;
// @ts-expect-error: an unknown role is no function
world.draw({triangle() {}});

export {began, category, copy, lines, locked, reading, y};
