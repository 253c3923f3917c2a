// Drops a box, casts a ray at it, saves, goes on, restores and goes on again: the same hash both times.
import {World} from "plumb-physics";

const world = new World();
world.createBody({type: "static", position: {x: 0, y: -1}, shapes: [{box: {width: 40, height: 2}}]});
const box = world.createBody({position: {x: 0, y: 4}, angle: 0.3, shapes: [{box: {width: 1, height: 1}}]});
world.step(1 / 60, 4, 60);

const hit = world.rayCast({x: 0, y: 10}, {x: 0, y: -20});
console.log(`the ray hits at ${hit.point.y.toFixed(6)} m`);

const saved = world.save();
world.step(1 / 60, 4, 60);
const hash = world.hash();
console.log(`the box is at ${box.position.y.toFixed(6)} m, hash ${hash}`);

world.restore(saved);
world.step(1 / 60, 4, 60);
console.log(`restored: ${world.hash() === hash ? "the same hash" : "another hash"}`);
