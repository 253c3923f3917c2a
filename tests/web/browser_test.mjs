// The page in Chromium, from disk, with mouse, fingers and keys:
//   node browser_test.mjs demos.html test_web_hashes chromium [FOLDER for pictures]
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdirSync, statSync, writeFileSync} from "node:fs";
import {join, resolve} from "node:path";
import test, {after, before} from "node:test";
import {pathToFileURL} from "node:url";
import {Chromium, Page} from "./chromium.mjs";

const [page_file, native, executable, pictures] = process.argv.slice(2);
const kPhone = {width: 390, height: 844, scale: 3, touch: true};
let browser;

before(() => { browser = new Chromium(executable); });
after(() => browser.close());

// In the page: where the body of a name is drawn, in pixels, and how large a figure is.
const kHelpers = `(() => {
  globalThis.where = (name) => {
    const shown = plumb.shown;
    plumb.shown = new Set(["names"]);
    const {numbers: n, words} = plumb.drawing(), sizes = {1: 7, 2: 7, 3: 6, 4: 4, 5: 6};
    plumb.shown = shown;
    for (let at = 0; at < n.length; at += n[at] === 0 ? 4 + 2 * n[at + 3] : sizes[n[at]]) {
      if (n[at] === 5 && plumb.text(words.subarray(n[at + 4], n[at + 4] + n[at + 5])) === name)
        return plumb.camera.to_pixel(n[at + 2], n[at + 3]);
    }
  };
  globalThis.figure = (name) => plumb.series.find((each) => each.name === name)?.values.at(-1);
  globalThis.control = (name) => plumb.controls.find((each) => each.name === name).value;
  return true;
})()`;

async function opened(demo, options) {
  const page = await Page.open(browser, `${pathToFileURL(resolve(page_file))}#${demo}`, options);
  await page.until("!!globalThis.plumb");
  await page.ask(kHelpers);
  assert.equal(await page.ask("plumb.about.name"), demo);
  await page.frames(3);
  return page;
}

async function closed(page, name) {
  if (pictures) {
    mkdirSync(pictures, {recursive: true});
    writeFileSync(join(pictures, `${name}.png`), await page.screenshot());
  }
  assert.deepEqual(page.complaints, []);
  await page.close();
}

const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

test("one file of less than 1.5 MB that asks the network for nothing", async () => {
  assert.ok(statSync(page_file).size < 1.5e6, `${statSync(page_file).size} bytes`);
  const page = await opened("bouncing_ball");
  await page.until("plumb.time > 0.5");
  assert.ok(await page.ask("plumb.demos.length") >= 5);
  await closed(page, "bouncing_ball");
});

test("the ball is painted where it is", async () => {
  for (const [dark, colour] of [[false, [250, 196, 132]], [true, [176, 104, 44]]]) {
    const page = await opened("bouncing_ball", {dark, scale: 2});
    await page.until("plumb.time > 0.3");
    await page.ask("plumb.paused = true");
    await page.frames(2);
    // Left and below, inside and outside: the colours at so many radii from the middle.
    const [left, below, outside, above] = await page.ask(`(() => {
      const {x, y} = where("ball"), radius = 0.3 * plumb.camera.scale, size = 2.6 * radius;
      const box = document.getElementById("stage").getContext("2d")
        .getImageData(2 * (x - size / 2), 2 * (y - size / 2), 2 * size, 2 * size);
      return [[-0.9, 0], [0, 0.9], [-1.2, 0], [0, -1.2]].map(([across, down]) => {
        const column = Math.round(size + 2 * radius * across), row = Math.round(size + 2 * radius * down);
        return [...box.data.slice(4 * (row * box.width + column)).slice(0, 3)];
      });
    })()`);
    assert.deepEqual([left, below], [colour, colour]);
    assert.notDeepEqual(outside, colour);
    assert.notDeepEqual(above, colour);
    await closed(page, dark ? "ball_dark" : "ball");
  }
});

test("every demo and every scenario has the native hash after 1000 steps", async () => {
  const lines = execFileSync(native, {encoding: "utf8"}).split("\n").map((line) => line.split(" "));
  const expected = lines.filter(([, how]) => how === "untouched").map(([name, , , hash]) => [name, hash]);
  assert.ok(expected.length >= 5);
  const page = await opened("bouncing_ball");
  await page.ask("plumb.paused = true");
  for (const [name, hash] of expected) {
    const found = await page.ask(`(() => {
      plumb.open(plumb.demos.findIndex((demo) => demo.name === ${JSON.stringify(name)}));
      for (let i = 0; i < 1000; ++i) plumb.step();
      return plumb.hash();
    })()`);
    assert.equal(found, hash, name);
  }
  await closed(page, "hashes");
});

// Where it is, from the start and in slow motion, so that it is still there when it is taken hold of.
async function still_torso(page) {
  await page.ask("plumb.slow = true, plumb.restart()");
  return page.ask('where("torso")');
}

test("the mouse picks the ragdoll up and flings it", async () => {
  const page = await opened("ragdoll");
  const start = await still_torso(page);
  await page.mouse("press", start);
  await page.ask("plumb.slow = false");
  for (let i = 1; i <= 40; ++i) {
    await page.mouse("move", {x: start.x + 4 * i, y: start.y - 2 * i});
    await page.frames(1);
  }
  const pointer = {x: start.x + 160, y: start.y - 80};
  await page.until(`(() => { const at = where("torso"); return Math.hypot(at.x - ${pointer.x}, at.y - ${pointer.y}) < 40; })()`);
  const held = await page.ask('where("torso")');
  await page.mouse("release", pointer);
  const let_go = await page.ask("plumb.time");
  await page.until(`plumb.time > ${let_go + 0.5}`);
  assert.ok((await page.ask('where("torso")')).y > held.y, "it falls when it is let go");
  await closed(page, "ragdoll");
});

test("a click fires a ball towards the pointer", async () => {
  const page = await opened("cannonballs");
  await page.ask('plumb.set("balls", 0)');
  assert.equal(await page.ask('figure("balls")'), 0);
  for (let count = 1; count <= 3; ++count) {
    await page.click({x: 900 + 60 * count, y: 200});
    await page.until(`figure("balls") === ${count}`);
  }
  await page.key("3");
  await page.key(" ");
  await page.until('figure("balls") === 5');
  await page.frames(20);
  await closed(page, "cannonballs");
});

test("wheel and right button move the picture, Home brings it back", async () => {
  const page = await opened("pool_break");
  const at = {x: 700, y: 300};
  const [scale, home] = await page.ask("[plumb.camera.scale, plumb.camera.to_pixel(0, 0)]");
  const held = await page.ask(`plumb.camera.to_world(${JSON.stringify(at)})`);
  await page.wheel(at, -200);
  await page.until(`plumb.camera.scale > ${scale * 1.2}`);
  const after = await page.ask(`plumb.camera.to_pixel(${held.x}, ${held.y})`);
  assert.ok(distance(after, at) < 1e-6, "what is under the pointer stays there");
  await page.mouse("press", at, "right");
  await page.mouse("move", {x: at.x + 50, y: at.y + 20}, "right");
  await page.mouse("release", {x: at.x + 50, y: at.y + 20}, "right");
  const moved = await page.ask(`plumb.camera.to_pixel(${held.x}, ${held.y})`);
  assert.ok(distance(moved, {x: at.x + 50, y: at.y + 20}) < 1e-6);
  await page.key("Home");
  assert.ok(distance(await page.ask("plumb.camera.to_pixel(0, 0)"), home) < 1e-6);
  await page.key(" ");
  await page.until('figure("collisions") > 15');
  await closed(page, "pool_break");
});

test("a slider changes the world", async () => {
  const page = await opened("bouncing_ball");
  const slider = await page.middle('input[aria-label="gravity"]');
  await page.click({x: slider.left + 3, y: slider.y});
  await page.until('control("gravity") < 0.5');
  await page.key("Home");  // of the slider, which has the focus
  await page.until('control("gravity") === 0');
  await page.until('figure("time") > 0');
  // In free flight without gravity nothing gets faster.
  await page.ask("plumb.paused = true");
  const before = await page.ask('figure("speed")');
  await page.ask("for (let i = 0; i < 100; ++i) plumb.step()");
  assert.ok(await page.ask('figure("speed")') <= before);
  await page.ask('plumb.set("gravity", 20), plumb.set("damping", 0)');
  const energy = await page.ask('plumb.step(), figure("energy")');
  assert.ok(energy > 0);
  await closed(page, "sliders");
});

test("keys: pause, step, back, restart, next, panel", async () => {
  const page = await opened("bouncing_ball");
  await page.until("plumb.time > 0.2");
  await page.key("p");
  const [time, hash, dt] = await page.ask('[plumb.time, plumb.hash(), control("dt")]');
  await page.frames(5);
  assert.equal(await page.ask("plumb.time"), time);
  await page.key("o");
  assert.ok(Math.abs(await page.ask("plumb.time") - time - dt) < 1e-12);
  assert.notEqual(await page.ask("plumb.hash()"), hash);
  await page.key("b");
  assert.equal(await page.ask("plumb.hash()"), hash);
  await page.key("r");
  assert.equal(await page.ask("plumb.time"), 0);
  await page.key("Tab");
  await page.frames(2);
  assert.equal(await page.ask('getComputedStyle(document.getElementById("rest")).display'), "none");
  await page.key("]");
  assert.notEqual(await page.ask("plumb.about.name"), "bouncing_ball");
  await page.key("[");
  assert.equal(await page.ask("plumb.about.name"), "bouncing_ball");
  await closed(page, "folded");
});

test("an error is said, and the demo goes on from its last state", async () => {
  const page = await opened("bouncing_ball");
  await page.until("plumb.time > 0.2");
  await page.ask('plumb.paused = true, plumb.step()');
  const hash = await page.ask("plumb.hash()");
  await page.ask('plumb.set("gravity", 1000)');
  await page.until('document.getElementById("message").textContent.includes("must be a number from 0 to 20")');
  await page.frames(10);
  assert.equal(await page.ask("plumb.hash()"), hash);
  const time = await page.ask("plumb.time");
  await page.key("p");
  await page.until(`plumb.time > ${time + 0.2}`);
  await closed(page, "error");
});

test("the mouse carries the bouncing ball, and it falls from there", async () => {
  const page = await opened("bouncing_ball");
  const start = await page.ask('where("ball")');
  await page.mouse("press", start);
  for (let i = 1; i <= 10; ++i) {
    await page.mouse("move", {x: start.x + 15 * i, y: start.y - 4 * i});
    await page.frames(1);
  }
  const end = {x: start.x + 150, y: start.y - 40};
  await page.until(`(() => { const at = where("ball"); return Math.hypot(at.x - ${end.x}, at.y - ${end.y}) < 3; })()`);
  await page.frames(60);  // held still, or it would be thrown
  await page.mouse("release", end);
  await page.until(`where("ball").y > ${end.y + 30}`);
  assert.ok(Math.abs((await page.ask('where("ball")')).x - end.x) < 60, "it falls where it was let go");
  await closed(page, "bouncing_ball_carried");
});

test("the address names the place, and a new one opens another", async () => {
  const page = await opened("bouncing_ball");
  for (const name of ["ragdoll", "pendulum_chain[5]", "kepler"]) {
    await page.ask(`location.hash = ${JSON.stringify(`#${name}`)}`);
    await page.until(`plumb.about.name === ${JSON.stringify(name)}`);
    await page.frames(3);
    assert.equal(decodeURIComponent(await page.ask("location.hash")), `#${name}`);
  }
  await page.key("]");
  await page.frames(3);
  assert.equal(decodeURIComponent(await page.ask("location.hash")), `#${await page.ask("plumb.about.name")}`);
  const before = await page.ask("plumb.about.name");
  await page.ask('location.hash = "#no_such_demo"');
  await page.until('document.getElementById("message").textContent.includes("no_such_demo")');
  await page.frames(3);
  assert.equal(decodeURIComponent(await page.ask("location.hash")), `#${before}`);
  await closed(page, "address");
});

test("the code stands beside the demo, and the picture keeps clear of it", async () => {
  const page = await opened("sandbox");
  const right = () => page.ask("plumb.camera.to_pixel(6, 0).x");
  const before = await right();
  await page.key("v");
  await page.until(`plumb.camera.to_pixel(6, 0).x < ${before - 50}`);
  const {left} = await page.middle("#code");
  assert.ok(await right() < left);
  assert.ok((await page.ask('document.getElementById("code").textContent')).includes("class Sandbox"));
  const scene = await page.ask(`(() => {
    let text = "";
    plumb.write_scene = (name, written) => { text = written; };
    plumb.key("w");
    return JSON.parse(text);
  })()`);
  assert.equal(scene.plumb_scene, 1);
  assert.equal(scene.joints.length, 2);
  await closed(page, "code");
});

test("what is fired out of the picture is followed", async () => {
  const page = await opened("cannonballs");
  await page.ask('plumb.set("impulse", 60), plumb.set("balls", 0)');
  const scale = await page.ask("plumb.camera.scale");
  await page.click(await page.ask("plumb.camera.to_pixel(12, 12)"));
  await page.until(`plumb.camera.scale < ${0.8 * scale}`);
  await closed(page, "followed");
});

test("a shot with the mouse breaks the rack", async () => {
  const page = await opened("pool_break");
  const cue = await page.ask('where("cue")'), first = await page.ask('where("1")');
  assert.equal(await page.ask('figure("kinetic energy")'), 0);
  await page.mouse("press", cue);
  await page.mouse("move", first);
  await page.frames(3);
  await page.mouse("release", {x: first.x + 40, y: first.y + 1});
  await page.until('figure("kinetic energy") > 0.1');
  const shot = await page.ask('figure("momentum x")');
  assert.ok(shot > 0, "towards the rack");
  await page.until('figure("collisions") > 15');
  // The head ball hands on what it gets; those at the corners fly.
  const corner = await page.ask('where("15")');
  await page.until(`(() => { const at = where("15"); return !at || Math.hypot(at.x - ${corner.x}, at.y - ${corner.y}) > 20; })()`);
  await closed(page, "pool_break_shot");
});

test("a push in the middle does not spin a box, the same at a corner does", async () => {
  const page = await opened("spinning_boxes");
  await page.ask('plumb.set("gravity", 0)');
  const pixel = (x, y) => page.ask(`plumb.camera.to_pixel(${x}, ${y})`);
  await page.click(await pixel(-3, 0));  // the middle of the square box there
  await page.until('figure("its speed") > 1.9');
  assert.equal(await page.ask('figure("its angular velocity")'), 0);
  await page.ask("plumb.restart()");
  await page.click(await pixel(-2.55, 0.45));  // near a corner
  await page.until('figure("its angular velocity") > 3');
  // A push of 20 N for 0.1 s at 0.5 m from the axis: w = r J / I = 0.5 * 2 * 6 = 6 rad/s, and a little less as it turns.
  assert.ok(await page.ask('figure("its angular velocity")') < 6.01);
  const boxes = await page.ask('figure("boxes")');
  await page.click(await pixel(5, 3));
  await page.until(`figure("boxes") === ${boxes + 1}`);
  await closed(page, "spinning_boxes_pushed");
});

test("a scenario: its truth and plumb's other engines lie over it, with errors and energy", async () => {
  const page = await opened("pendulum_chain[5]");
  assert.ok(await page.ask('plumb.demos.filter(({kind}) => kind === "scene").length') >= 23);
  await page.ask("plumb.paused = true, plumb.restart()");
  await page.ask("for (let i = 0; i < 30; ++i) plumb.step()");
  const [error, drift] = await page.ask('[figure("position error"), figure("energy drift")]');
  assert.ok(error > 1e-6 && error < 0.1, `position error ${error} m`);
  assert.ok(Math.abs(drift) > 0 && Math.abs(drift) < 0.01, `energy drift ${drift}`);
  // By the boxes of the panel.
  const box = (name) => page.middle(`#ghosts label:nth-child(${ghosts.findIndex((each) => each.name === name) + 1}) input`);
  const ghosts = await page.ask("plumb.ghosts");
  assert.equal(ghosts[0].name, "truth");
  assert.equal(ghosts[0].shown, 1);
  assert.match(ghosts[0].remark, /Lagrange/);
  await page.click(await box("plumb-precise"));
  await page.until('plumb.ghosts.find(({name}) => name === "plumb-precise").shown === 1');
  await page.key("o");
  const precise = await page.ask('figure("plumb-precise error")');
  assert.ok(precise < 1e-8, `plumb-precise is ${precise} m off`);
  await page.click(await box("plumb-precise"));
  await page.until('figure("plumb-precise error") === undefined');
  // A slider, a drag of a rod, pause and step by keys.
  const slider = await page.middle('input[aria-label="substeps"]');
  await page.click({x: slider.right - 2, y: slider.y});
  await page.key("End");
  await page.until(`control("substeps") === ${await page.ask("plumb.controls.find(({name}) => name === \"substeps\").high")}`);
  await page.key("r");
  await page.ask("document.activeElement.blur()");
  await page.ask("plumb.slow = true");
  await page.key("p");
  const rod = await page.ask('where("rod4")');
  await page.mouse("press", rod);
  for (let i = 1; i <= 20; ++i) {
    await page.mouse("move", {x: rod.x, y: rod.y - 3 * i});
    await page.frames(1);
  }
  await page.ask("plumb.slow = false");
  await page.until(`where("rod4").y < ${rod.y - 20}`, 3);
  await page.mouse("release", {x: rod.x, y: rod.y - 60});
  await closed(page, "scenario");
});

test("every scenario opens, and shows no complaint while plumb's engines run along", async () => {
  const page = await opened("free_fall/vacuum", {dark: true});
  const names = await page.ask('plumb.demos.filter(({kind}) => kind === "scene").map(({name}) => name)');
  for (const name of names) {
    const message = await page.ask(`(() => {
      plumb.open(plumb.demos.findIndex((demo) => demo.name === ${JSON.stringify(name)}));
      plumb.ghosts.forEach((_, ghost) => plumb.show_ghost(ghost, true));
      for (let i = 0; i < 20; ++i) plumb.step();
      return plumb.message;
    })()`);
    assert.equal(message, "", name);
    await page.frames(2);
  }
  await closed(page, "scenarios_dark");
});

test("everything that can be drawn is drawn, on a dark ground", async () => {
  const page = await opened("ragdoll", {dark: true});
  assert.ok(await page.ask('document.documentElement.classList.contains("dark")'));
  const boxes = '[...document.querySelectorAll("#shown label")].filter(({textContent}) => /contacts|normals|impulses$|boxes|centres/.test(textContent))';
  await page.ask(`${boxes}.forEach((label) => label.firstChild.click())`);
  await page.until("plumb.time > 0.5");
  assert.equal(await page.ask("plumb.shown.size"), 6);  // joints were on
  await closed(page, "dark");
});

test("fingers: a tap fires, two of them zoom and move", async () => {
  const page = await opened("cannonballs", kPhone);
  await page.ask('plumb.set("balls", 0)');
  await page.touch("touchStart", [{x: 300, y: 200}]);
  await page.touch("touchEnd", []);
  await page.until('figure("balls") === 1');
  const scale = await page.ask("plumb.camera.scale");
  const held = await page.ask("plumb.camera.to_world({x: 200, y: 300})");
  await page.touch("touchStart", [{x: 150, y: 300}]);
  await page.touch("touchStart", [{x: 150, y: 300}, {x: 250, y: 300}]);
  for (let i = 1; i <= 10; ++i)
    await page.touch("touchMove", [{x: 150 - 5 * i, y: 300 + 2 * i}, {x: 250 + 5 * i, y: 300 + 2 * i}]);
  await page.touch("touchEnd", []);
  assert.ok(Math.abs(await page.ask("plumb.camera.scale") / scale - 2) < 0.05, "twice as far apart, twice as large");
  const now = await page.ask(`plumb.camera.to_pixel(${held.x}, ${held.y})`);
  assert.ok(distance(now, {x: 200, y: 320}) < 2, "what was between the fingers stays between them");
  await page.frames(10);
  assert.equal(await page.ask('figure("balls")'), 1, "two fingers fire nothing");
  await closed(page, "phone_zoomed");
});

test("a finger drags the ragdoll on a phone", async () => {
  const page = await opened("ragdoll", kPhone);
  const start = await still_torso(page);
  await page.touch("touchStart", [start]);
  await page.frames(10);
  await page.ask("plumb.slow = false");
  for (let i = 1; i <= 30; ++i) {
    await page.touch("touchMove", [{x: start.x, y: start.y - 2 * i}]);
    await page.frames(1);
  }
  await page.until(`where("torso").y < ${start.y - 40}`);
  await page.touch("touchEnd", []);
  await closed(page, "phone");
  const dark = await opened("ragdoll", {...kPhone, dark: true});
  await dark.click(await dark.middle("#fold"));
  await dark.frames(30);
  assert.ok(await dark.ask("plumb.panel"));
  await closed(dark, "phone_panel_dark");
});
