// The report in headless Chromium, from a comparison made for it: browser_test.mjs PLUMB CHROMIUM [PICTURES]
// With a folder for PICTURES, what was seen is kept there.
import {strict as assert} from "node:assert";
import {spawnSync} from "node:child_process";
import {mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {Chromium, Page} from "../web/chromium.mjs";

const [plumb, chromium, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "plumb-report-"));
const made = spawnSync(plumb, ["compare", "elastic_collision/oblique", "pendulum_chain[2]", "harmonic_oscillator", "--out", folder],
  {encoding: "utf8"});
assert.equal(made.status, 0, made.stderr);
assert.match(made.stdout, /the report is in .*report\.html/);

const browser = new Chromium(chromium);
const labels = ["elastic_collision/oblique", "pendulum_chain[2]", "harmonic_oscillator"];
const scene = (label) => `document.querySelector('details.scene[data-label="${label}"]')`;

async function open(options, name) {
  const page = await Page.open(browser, `file://${folder}/report.html`, options);
  await page.until("document.querySelector('details.scene[open] svg')");
  await page.ask("document.getElementById('open-all').click()");
  await page.until(`${scene(labels[2])}.querySelector('svg')`);
  if (pictures) {
    writeFileSync(join(pictures, `${name}-top.png`), await page.screenshot());
    for (const label of labels) {
      await page.ask(`(${scene(label)}.scrollIntoView(), 0)`);
      await page.frames(2);
      writeFileSync(join(pictures, `${name}-${label.replaceAll("/", "-")}.png`), await page.screenshot());
    }
  }
  return page;
}

async function hasAllParts(page) {
  for (const label of labels) {
    for (const chart of ["set-up", "replay", "work-precision", "costs", "error", "energy"])
      assert.ok(await page.ask(`Boolean(${scene(label)}.querySelector('[data-chart="${chart}"] svg'))`), `${label} ${chart}`);
    assert.ok(await page.ask(`${scene(label)}.querySelector('[data-part="checks"]').textContent.includes("held")`));
    const rows = await page.ask(`(() => { const runs = ${scene(label)}.querySelector('[data-part="runs"]');
      runs.open = true; return new Promise((done) => setTimeout(() => done(runs.querySelectorAll("tbody tr").length), 100)); })()`);
    assert.ok(rows >= 5, `${label} ${rows}`);
  }
  const text = await page.ask("document.body.textContent");
  assert.match(text, /skipped: /);
  assert.match(await page.ask("document.getElementById('environments').textContent"), /GNU|Clang/);
  assert.equal(await page.ask("document.documentElement.scrollWidth <= innerWidth"), true, "wider than the screen");
}

async function sorts(page) {
  const column = (i) => `[...document.querySelectorAll("#standing-table tbody tr")].map((row) => row.cells[${i}].textContent)`;
  const press = (i) => page.ask(`(document.querySelectorAll("#standing-table th button")[${i}].click(), ${column(i)})`);
  const up = await press(0), down = await press(0);
  assert.deepEqual([...up].sort(), up);
  assert.deepEqual([...down].sort(), up);
  assert.notDeepEqual(up, down);
}

async function hoverTells(page, label) {
  const at = await page.ask(`(() => { const svg = ${scene(label)}.querySelector('[data-chart="work-precision"] svg');
    svg.scrollIntoView({block: "center"});
    const mark = [...svg.querySelectorAll("path")].find((path) => path.getAttribute("transform")).getBoundingClientRect();
    return {x: mark.x + mark.width / 2, y: mark.y + mark.height / 2}; })()`);
  assert.equal(await page.ask("document.getElementById('tip').hidden"), true);
  await page.mouse("move", at);
  await page.until("!document.getElementById('tip').hidden");
  assert.match(await page.ask("document.getElementById('tip').textContent"), /dt 1\/60/);
  await page.mouse("move", {x: 2, y: 2});
  await page.until("document.getElementById('tip').hidden");
  const tips = [];
  await page.ask(`(${scene(label)}.querySelector('[data-chart="work-precision"] svg').focus(), 0)`);
  for (let i = 0; i < 3; ++i) {
    await page.key("ArrowRight");
    tips.push(await page.ask("document.getElementById('tip').textContent"));
  }
  assert.equal(new Set(tips).size, 3, "the arrows go from mark to mark");
  await page.key("Escape");
  assert.equal(await page.ask("document.getElementById('tip').hidden"), true);
}

async function hides(page, label) {
  const marks = () => page.ask(`${scene(label)}.querySelectorAll('[data-chart="work-precision"] svg path[transform]').length`);
  const press = () => page.ask(`(${scene(label)}.querySelector('.legend button[data-engine="box2d"], .legend button[data-engine^="bullet"], ` +
    `.legend button:last-child').click(), 0)`);
  const before = await marks();
  await press();
  assert.equal(await marks(), before - 1);
  await press();
  assert.equal(await marks(), before);
}

async function plays(page, label) {
  const body = `${scene(label)}.querySelector('[data-chart="replay"] svg g g g')`;
  const pose = () => page.ask(`${body}.getAttribute("transform")`);
  const time = () => page.ask(`Number(${scene(label)}.querySelector(".scrub").value)`);
  const start = await pose();
  await page.ask(`(${scene(label)}.querySelector(".play").click(), 0)`);
  await page.until(`Number(${scene(label)}.querySelector(".scrub").value) > 0.1`);
  assert.notEqual(await pose(), start);
  await page.ask(`(${scene(label)}.querySelector(".play").click(), 0)`);
  const stopped = await time();
  await page.frames(5);
  assert.equal(await time(), stopped, "it plays on");
  await page.ask(`(() => { const scrub = ${scene(label)}.querySelector(".scrub"); scrub.value = 0;
    scrub.dispatchEvent(new Event("input")); })()`);
  assert.equal(await pose(), start);
  // At a twentieth of the speed time goes slower.
  await page.ask(`(() => { ${scene(label)}.querySelector(".speed").value = "0.05"; ${scene(label)}.querySelector(".play").click(); })()`);
  const clock = await page.ask("new Promise((done) => { const from = performance.now(); setTimeout(() => done(performance.now() - from), 400); })");
  assert.ok(await time() < 0.2 * clock / 1000, "slow motion is not slow");
}

try {
  const wide = await open({width: 1250, height: 1500}, "wide-light");
  await hasAllParts(wide);
  await sorts(wide);
  await hoverTells(wide, "harmonic_oscillator");
  await hides(wide, "harmonic_oscillator");
  await plays(wide, "elastic_collision/oblique");
  assert.deepEqual(wide.complaints, []);
  await wide.close();
  for (const [options, name] of [[{width: 1250, height: 1500, dark: true}, "wide-dark"],
    [{width: 390, height: 1500, touch: true}, "narrow-light"], [{width: 390, height: 1500, touch: true, dark: true}, "narrow-dark"]]) {
    const page = await open(options, name);
    await hasAllParts(page);
    assert.deepEqual(page.complaints, []);
    await page.close();
  }
  console.log("report: all parts, sorting, hover, hiding and replay work, light and dark, wide and narrow");
} finally {
  await browser.close();
  rmSync(folder, {recursive: true, force: true});
}
