// The report in headless Chromium, from a comparison made for it: browser_test.mjs PLUMB CHROMIUM [PICTURES]
// With a folder for PICTURES, what was seen is kept there.
import {strict as assert} from "node:assert";
import {spawnSync} from "node:child_process";
import {copyFileSync, mkdtempSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {Chromium, Page} from "../web/chromium.mjs";

const [plumb, chromium, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "plumb-report-"));
const made = spawnSync(plumb, ["compare", "elastic_collision/oblique", "pendulum_chain[2]", "harmonic_oscillator", "--out", folder],
  {encoding: "utf8"});
assert.equal(made.status, 0, made.stderr);
assert.match(made.stdout, /the report is in .*report\.html/);

// The maps of extremes are drawn from data that is made up.
for (const name of ["stress.jsonl", "thresholds.jsonl"]) copyFileSync(new URL(`data/${name}`, import.meta.url), join(folder, name));
const again = spawnSync(plumb, ["report", folder], {encoding: "utf8"});
assert.equal(again.status, 0, again.stderr);

const browser = new Chromium(chromium);
const labels = ["elastic_collision/oblique", "pendulum_chain[2]", "harmonic_oscillator"];
const kCharts = ["work-precision", "costs", "error", "energy"];
const scene = (label) => `document.querySelector('details.scene[data-label="${label}"]')`;

async function open(options, name) {
  const page = await Page.open(browser, `file://${folder}/report.html`, options);
  await page.until("document.querySelector('details.scene[open] svg')");
  await page.ask("document.getElementById('open-all').click()");
  await page.until(`${scene(labels[2])}.querySelector('svg')`);
  if (pictures) {
    writeFileSync(join(pictures, `${name}-top.png`), await page.screenshot());
    const places = [...labels.map((label) => [label.replaceAll("/", "-"), scene(label)]),
      ...["extremes", "thresholds"].map((id) => [id, `document.getElementById("${id}")`])];
    for (const [place, element] of places) {
      await page.ask(`(${element}.scrollIntoView(), 0)`);
      await page.frames(10);
      writeFileSync(join(pictures, `${name}-${place}.png`), await page.screenshot());
    }
    await page.ask("(scrollTo(0, 0), 0)");
  }
  return page;
}

async function hasAllParts(page) {
  for (const label of labels) {
    for (const picture of ["set-up", "replay"])
      assert.ok(await page.ask(`Boolean(${scene(label)}.querySelector('[data-chart="${picture}"] svg'))`), `${label} ${picture}`);
    for (const chart of kCharts) assert.ok(await drawn(page, label, chart), `${label} ${chart}`);
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

const canvas = (label, chart) => `${scene(label)}.querySelector('[data-chart="${chart}"] canvas')`;

/// Scrolls to a chart, which is drawn then, and gives whether it says what it shows and has marks within it.
async function drawn(page, label, chart) {
  await page.ask(`(${scene(label)}.querySelector('[data-chart="${chart}"]').scrollIntoView({block: "center"}), 0)`);
  await page.until(canvas(label, chart));
  assert.match(await page.ask(`${canvas(label, chart)}.getAttribute("aria-label")`), /plumb/);
  return page.ask(`(() => { const chart = Chart.getChart(${canvas(label, chart)}), {left, right, top, bottom} = chart.chartArea;
    return chart.data.datasets.every((set, i) => chart.getDatasetMeta(i).data.every(({x, y}) =>
      x >= left - 1 && x <= right + 1 && y >= top - 1 && y <= bottom + 1)) && chart.data.datasets.some((set) => set.told && set.data.length > 0); })()`);
}

const tip = "document.getElementById('tip')";

async function hoverTells(page, label) {
  await drawn(page, label, "work-precision");
  const at = await page.ask(`(() => { const canvas = ${canvas(label, "work-precision")}, box = canvas.getBoundingClientRect();
    const mark = Chart.getChart(canvas).getDatasetMeta(0).data[0]; return {x: box.x + mark.x, y: box.y + mark.y}; })()`);
  assert.equal(await page.ask(`${tip}.hidden`), true);
  await page.mouse("move", at);
  await page.until(`!${tip}.hidden`);
  assert.match(await page.ask(`${tip}.textContent`), /dt 1\/60/);
  await page.mouse("move", {x: 2, y: 2});
  await page.until(`${tip}.hidden`);
  const tips = [];
  await page.ask(`(${canvas(label, "work-precision")}.focus(), 0)`);
  for (let i = 0; i < 3; ++i) {
    await page.key("ArrowRight");
    tips.push(await page.ask(`${tip}.textContent`));
  }
  assert.equal(new Set(tips).size, 3, "the arrows go from mark to mark");
  await page.key("Escape");
  assert.equal(await page.ask(`${tip}.hidden`), true);
}

async function hides(page, label) {
  await drawn(page, label, "work-precision");
  const engines = () => page.ask(`Chart.getChart(${canvas(label, "work-precision")}).data.datasets.filter((set) => set.told).map((set) => set.engine)`);
  const before = await engines(), rival = before.find((engine) => !engine.startsWith("plumb"));
  const press = () => page.ask(`(${scene(label)}.querySelector('.legend button[data-engine="${rival}"]').click(), 0)`);
  await press();
  assert.deepEqual(await engines(), before.filter((engine) => engine !== rival));
  await press();
  assert.deepEqual(await engines(), before);
}

/// A scene that is closed, or far away, has no canvas; on paper all that are open are drawn, dark on white.
async function prints(page, label) {
  await page.ask("(scrollTo(0, 0), 0)");
  await page.until(`!${canvas(labels[1], "costs")} || !${canvas(labels[2], "costs")}`);
  await page.ask("dispatchEvent(new Event('beforeprint'))");
  for (const chart of kCharts) {
    const colour = await page.ask(`Chart.getChart(${canvas(label, chart)}).options.scales.x.ticks.color`);
    assert.equal(colour, "#5c5c57", "the light page's ink");
  }
  await page.ask("dispatchEvent(new Event('afterprint'))");
}

async function mapsTell(page) {
  const map = (family) => `document.querySelector('#extremes [data-family="${family}"]')`;
  const said = await page.ask(`[...${map("mass_ratio_stack")}.querySelectorAll("tbody tr")].map((row) => [row.cells[0].textContent,
    ...[...row.cells].slice(1).map((cell) => cell.textContent)])`);
  assert.deepEqual(said.find(([name]) => name === "box2d default"), ["box2d default", "ok", "sinks", "explodes", "NaN"]);
  assert.deepEqual(said[0], ["plumb-float default", "ok", "ok", "sinks", "sinks"], "plumb's worst comes first");
  assert.deepEqual(await page.ask(`[...${map("mass_ratio_stack")}.querySelectorAll("thead th")].slice(1).map((cell) => cell.textContent)`),
    ["1", "1000", "10\u2076", "10\u2079"]);
  // No two kinds of outcome look alike, and none as the page behind them.
  const colours = await page.ask(`[...document.querySelectorAll("#extremes .keys b")].map((key) => {
    const {backgroundColor, boxShadow} = getComputedStyle(key); return backgroundColor + boxShadow; })`);
  assert.equal(new Set(colours).size, 6);
  const cell = `${map("stiff_spring")}.querySelector('td[data-outcome="refused"]')`;
  const at = await page.ask(`(() => { ${cell}.scrollIntoView({block: "center", inline: "center"}); const box = ${cell}.getBoundingClientRect();
    return {x: box.x + box.width / 2, y: box.y + box.height / 2}; })()`);
  await page.frames(3);
  await page.mouse("move", at);
  await page.until(`!${tip}.hidden`);
  const text = await page.ask(`${tip}.textContent`);
  for (const part of ["plumb-float, default: omega dt 10000", "refused: the spring turns faster", "600 steps, 120 ms, 12.3 MB", "substeps 4"])
    assert.ok(text.includes(part), text);
  await page.mouse("move", {x: 2, y: 2});
  await page.until(`${tip}.hidden`);
  await page.ask(`(${map("bullet")}.querySelector('td[tabindex="0"]').focus(), 0)`);
  await page.key("ArrowRight");
  await page.key("ArrowDown");
  assert.match(await page.ask(`${tip}.textContent`), /^plumb-float, careful: speed 10000 m\/s\nok\npasses the wall by 2.0\u00b710\u207b\u2075 m, bound 0.001 m/);
  // A cell that has to scroll into view is told there.
  await page.ask(`(scrollTo(0, 0), ${map("bullet")}.querySelector('tbody tr:last-child td:last-child').focus(), 0)`);
  await page.frames(5);
  assert.match(await page.ask(`${tip}.hidden ? "" : ${tip}.textContent`), /^box2d, default: speed 10\u2078 m\/s\ntunnels/);
  const gap = await page.ask(`(() => { const cell = document.activeElement.getBoundingClientRect(), box = ${tip}.getBoundingClientRect();
    return Math.min(Math.abs(cell.top - box.bottom), Math.abs(cell.top - box.top)); })()`);
  assert.ok(gap < 30, `the tip is ${gap} px away`);
  await page.key("Escape");
  assert.equal(await page.ask(`${tip}.hidden`), true);
  assert.match(await page.ask(`${map("all")}.querySelector("tbody tr").textContent`), /^any of plumb's any setting12\/12/);
  assert.equal(await page.ask(`document.querySelector("#extremes .table tbody tr:nth-child(2)").cells[2].textContent`), "8 of 12, 66.7 %");
}

async function thresholdsSort(page) {
  const rows = () => page.ask(`[...document.querySelectorAll("#thresholds tbody tr")].map((row) => [...row.cells].slice(0, 5).map((cell) => cell.textContent))`);
  assert.deepEqual((await rows())[0], ["friction on a ramp", "plumb-float", "0.364", "0.364", "+0.0027 %"]);
  assert.deepEqual((await rows())[1].slice(2), ["0.3711", "0.364", "+2 %"]);
  assert.equal((await rows()).find(([name, engine]) => name.startsWith("fastest") && engine === "plumb-float")[2], "none of 1 \u2026 10\u2078");
  await page.ask(`([...document.querySelectorAll("#thresholds th button")].find((button) => button.textContent === "off by").click(), 0)`);
  assert.equal((await rows())[0][1], "box2d");
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
  await prints(wide, "pendulum_chain[2]");
  await mapsTell(wide);
  await thresholdsSort(wide);
  await plays(wide, "elastic_collision/oblique");
  assert.deepEqual(wide.complaints, []);
  await wide.close();
  for (const [options, name] of [[{width: 1250, height: 1500, dark: true}, "wide-dark"],
    [{width: 390, height: 1500, touch: true}, "narrow-light"], [{width: 390, height: 1500, touch: true, dark: true}, "narrow-dark"]]) {
    const page = await open(options, name);
    await hasAllParts(page);
    await mapsTell(page);
    if (options.dark) await prints(page, "pendulum_chain[2]");
    assert.deepEqual(page.complaints, []);
    await page.close();
  }
  console.log("report: all parts, sorting, hover, hiding, printing, maps and replay work, light and dark, wide and narrow");
} finally {
  await browser.close();
  rmSync(folder, {recursive: true, force: true});
}
