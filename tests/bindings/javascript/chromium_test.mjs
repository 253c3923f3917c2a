// The npm package in Chromium: a thousand bodies on a canvas at 60 steps a second, and Node's hash.
// The example page draws, and answers a click.
//   node chromium_test.mjs PACKAGE CHROMIUM [BUILT]
// BUILT is a folder with the example page as a bundler left it (docs/javascript.md); without it the page is served as it is.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {createServer} from "node:http";
import path from "node:path";
import test, {after, before} from "node:test";
import {pathToFileURL} from "node:url";
import {Chromium, Page} from "../../web/chromium.mjs";

const [folder, executable, built] = process.argv.slice(2);
const example = built ?? path.join(import.meta.dirname, "../../../bindings/javascript/examples/page");
const {World} = await import(pathToFileURL(path.resolve(folder, "plumb.mjs")));

// The same lines in the page and here.
const kScene = `(World) => {
  const world = new World();
  world.createBody({type: "static", shapes: [{box: {width: 60, height: 2}, position: {x: 0, y: -1}},
    {box: {width: 2, height: 80}, position: {x: -20, y: 38}}, {box: {width: 2, height: 80}, position: {x: 20, y: 38}}]});
  for (let i = 0; i < 1000; ++i) {
    const position = {x: -17 + 1.1 * (i % 32) + 0.3 * (Math.floor(i / 32) % 2), y: 1 + 1.1 * Math.floor(i / 32)};
    world.createBody({position, shapes: [i % 3 ? {box: {width: 1, height: 1}} : {circle: {radius: 0.5}}]});
  }
  return world;
}`;
const kPage = `<!doctype html><title>1000</title><canvas id="stage" width="800" height="600"></canvas><script type="module">
import {World} from "./plumb.mjs";
const world = (${kScene})(World), pen = document.getElementById("stage").getContext("2d");
const spent = [];
let first = 0;
function frame(now) {
  first ||= now;
  const before = performance.now();
  world.step(1 / 60, 4);
  spent.push(performance.now() - before);
  pen.clearRect(0, 0, 800, 600);
  const poses = world.poses;
  for (let i = 3; i < poses.length; i += 3) {
    pen.setTransform(Math.cos(poses[i + 2]) * 15, -Math.sin(poses[i + 2]) * 15, Math.sin(poses[i + 2]) * 15,
      Math.cos(poses[i + 2]) * 15, 400 + 15 * poses[i], 580 - 15 * poses[i + 1]);
    pen.fillRect(-0.5, -0.5, 1, 1);
  }
  pen.setTransform(1, 0, 0, 1, 0, 0);
  if (spent.length < 240) return requestAnimationFrame(frame);
  spent.sort((a, b) => a - b);
  globalThis.figures = {hash: world.hash(), frames: 1000 * 239 / (now - first), median: spent[120], slowest: spent[239]};
}
requestAnimationFrame(frame);
</script>`;

let server, browser;
before(async () => {
  server = createServer((request, response) => {
    const name = request.url.slice(1), asset = /^(assets\/)?(page|index)[\w.-]*(js|html)$/.exec(name);
    const file = /^plumb[a-z.]*\.mjs$/.test(name);
    response.setHeader("Content-Type", /js$/.test(name) ? "text/javascript" : "text/html");
    // Replaces the name of the package, as a bundler does.
    if (asset) response.end(readFileSync(path.join(example, name), "utf8").replace('"plumb-physics"', '"./plumb.mjs"'));
    else response.end(file ? readFileSync(path.join(folder, name)) : kPage);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  browser = new Chromium(executable);
});
after(async () => {
  await browser.close();
  server.close();
});

test("a thousand bodies take 60 steps a second on a canvas, with Node's bits", async () => {
  const page = await Page.open(browser, `http://127.0.0.1:${server.address().port}/`);
  const figures = await page.until("globalThis.figures", 120);
  const world = (0, eval)(kScene)(World);
  world.step(1 / 60, 4, 240);
  console.log(`1000 bodies: ${figures.frames.toFixed(1)} frames a second, a step ${figures.median.toFixed(2)} ms ` +
    `(median), ${figures.slowest.toFixed(2)} ms (slowest)`);
  assert.equal(figures.hash, world.hash());
  // The median: other programs of the machine may take the processor at times.
  assert.ok(figures.median < 1000 / 60, `${figures.median} ms a step`);
  await page.close();
});

test("the example page draws its pyramid, and drops a ball where it is clicked", async () => {
  const page = await Page.open(browser, `http://127.0.0.1:${server.address().port}/index.html`);
  await page.until(`document.getElementById("stage") !== null`);
  const colour = (x, y) => `Array.from(document.getElementById("stage").getContext("2d").getImageData(${x}, ${y}, 1, 1).data)`;
  // The middle of the lowest box on the left, at -3.5 m and 0.5 m: 40 pixels a metre, the ground 40 pixels above the edge.
  await page.until(`${colour(400 - 3.5 * 40, 560 - 20)}.join() === "68,170,119,255"`, 60);
  const {left, top} = await page.ask(`(({left, top}) => ({left, top}))(document.getElementById("stage").getBoundingClientRect())`);
  assert.deepEqual((await page.ask(colour(100, 540))).slice(0, 3), [0, 0, 0]);
  await page.click({x: left + 100, y: top + 500});
  // It falls and lies on the ground, its middle 20 pixels above.
  await page.until(`${colour(100, 540)}.join() === "204,102,51,255"`);
  // Reading pixels, as this test does, is slow: Chromium says so.
  assert.deepEqual(page.complaints.filter((each) => !/^(asked for http:..127|Canvas2D: .* readback)/.test(each)), []);
  await page.close();
});
