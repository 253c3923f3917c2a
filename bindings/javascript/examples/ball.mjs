// A ball bounces on the ground.
import {World} from "plumb-physics";

const world = new World();  // gravity 9.81 m/s^2 downwards
world.createBody({type: "static", position: {x: 0, y: -1}, shapes: [{box: {width: 40, height: 2}}]});
const ball = world.createBody({position: {x: 0, y: 4}, shapes: [{circle: {radius: 0.5}, restitution: 0.8}]});

for (let i = 0; i < 8; ++i) {
  world.step(1 / 60, 4, 15);
  console.log(`${world.time.toFixed(2)} s: ${ball.position.y.toFixed(2)} m`);
}
