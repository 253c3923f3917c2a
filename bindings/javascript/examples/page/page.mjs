// A pyramid of boxes on a canvas; a click drops a ball there.
import {World} from "plumb-physics";

const kScale = 40, kRadius = 0.5, kDt = 1 / 60;  // pixels a metre, m, s
const canvas = document.getElementById("stage"), pen = canvas.getContext("2d");
const world = new World();
world.createBody({type: "static", position: {x: 0, y: -1}, shapes: [{box: {width: 20, height: 2}}]});
const boxes = [];
for (let row = 0; row < 8; ++row)
  for (let i = 0; i < 8 - row; ++i)
    boxes.push(world.createBody({position: {x: i + row / 2 - 3.5, y: row + 0.5}, shapes: [{box: {width: 1, height: 1}}]}));
const balls = [];

canvas.addEventListener("pointerdown", (event) => {
  const position = {x: (event.offsetX - canvas.width / 2) / kScale, y: (canvas.height - 40 - event.offsetY) / kScale};
  balls.push(world.createBody({position, shapes: [{circle: {radius: kRadius}, density: 5, restitution: 0.3}]}));
});

function draw(poses, body) {
  const [x, y, angle] = poses.subarray(3 * body.index);  // a row of each body, by its index
  pen.setTransform(kScale, 0, 0, -kScale, canvas.width / 2, canvas.height - 40);
  pen.translate(x, y);
  pen.rotate(angle);
}

let last = performance.now(), due = 0;
function frame(now) {
  // As many steps as the time asks for, at most five: displays have other rates than 60 a second.
  due = Math.min(due + (now - last) / 1000, 5 * kDt);
  last = now;
  for (; due >= kDt; due -= kDt) world.step(kDt);

  pen.resetTransform();
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = "#888";
  pen.fillRect(0, canvas.height - 40, canvas.width, 40);
  const poses = world.poses;
  pen.fillStyle = "#4a7";
  for (const box of boxes) {
    draw(poses, box);
    pen.fillRect(-0.48, -0.48, 0.96, 0.96);
  }
  pen.fillStyle = "#c63";
  for (const ball of balls) {
    draw(poses, ball);
    pen.beginPath();
    pen.arc(0, 0, kRadius, 0, 2 * Math.PI);
    pen.fill();
  }
  requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
