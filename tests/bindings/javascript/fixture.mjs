// Loads the package that the command line names, and makes small worlds, for all tests of the npm package.
import assert from "node:assert/strict";
import path from "node:path";
import {pathToFileURL} from "node:url";

export const folder = path.resolve(process.argv[2]);
export const {World, Body, Shape, Joint, Chain, Rollback, PlumbError} =
  await import(pathToFileURL(path.join(folder, "plumb.mjs")));
export const kG = 9.81;

export function withGround() {
  const world = new World();
  const ground = world.createBody({type: "static", position: {x: 0, y: -1}, shapes: [{box: {width: 40, height: 2}}]});
  return {world, ground};
}
export function near(value, wanted, tolerance) {
  assert.ok(Math.abs(value - wanted) <= tolerance, `${value} is not within ${tolerance} of ${wanted}`);
}
export function overlapping(definition = {}) {
  const world = new World(definition);
  const shapes = [{circle: {radius: 1}, preSolve: true}];
  const a = world.createBody({shapes}), b = world.createBody({position: {x: 1, y: 0}, shapes});
  return {world, a, b};
}
