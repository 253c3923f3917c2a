// The report of a million runs: its size, and how long Chromium takes to show it.
//   large_report.mjs PLUMB CHROMIUM RESULTS [RUNS] [FOLDER]
// Multiplies the runs of RESULTS (a results.jsonl of `plumb compare`) over steps, substeps and a made-up option, with errors and costs
// that follow power laws with a scatter, until there are RUNS (1e6) in results.jsonl; has the report of them written, and opens it.
// Takes minutes, 3 GB of disk and 10 GB of memory. With a FOLDER, all is kept there, and what is there is taken.
import {strict as assert} from "node:assert";
import {spawnSync} from "node:child_process";
import {closeSync, existsSync, mkdirSync, mkdtempSync, openSync, readFileSync, rmSync, statSync, writeFileSync, writeSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {Chromium, Page} from "../web/chromium.mjs";

const kBytes = 20e6, kSeconds = 3;
const [plumb, chromium, template, runs = "1000000", kept] = process.argv.slice(2);
const folder = kept ?? mkdtempSync(join(tmpdir(), "plumb-large-"));

let seed = 39;
function chance() {  // 0 to 1, the same on each machine
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}

function multiply(path, wanted) {
  const rows = readFileSync(template, "utf8").split("\n").filter(Boolean).map((line) => JSON.parse(line));
  const settings = Math.ceil(wanted / rows.length);
  const file = openSync(path, "w");
  let count = 0, text = "";
  for (let k = 0; k < settings && count < wanted; ++k) {
    const finer = 2 ** -(k % 12), substeps = 2 ** (Math.floor(k / 12) % 5), tune = Math.floor(k / 60);
    for (const row of rows) {
      if (count === wanted) break;
      if (count++ < rows.length) {  // as they were, so that they can be replayed
        text += JSON.stringify(row) + "\n";
        continue;
      }
      const one = structuredClone(row), dt = row.dt * finer, cost = (substeps + 0.1 * tune) * (0.8 + 0.4 * chance());
      one.dt = one.asked.dt = dt;
      one.settings.dt = String(dt);
      one.asked.substeps = substeps;
      one.settings.substeps = String(substeps);
      one.asked.options = {tune: String(tune)};
      for (const [name, value] of Object.entries(one.metrics))
        if (typeof value === "number") one.metrics[name] = value * finer ** 2 / substeps * (0.5 + chance());
      one.cost = row.status !== "ok" ? null : {ns_per_step: 300 * cost, ns_per_step_low: 290 * cost, ns_per_step_high: 320 * cost,
        ns_per_simulated_second: 300 * cost / dt, setup_ns: 1e4, repetitions: 9, steps: Math.round(row.duration / dt),
        each_ns_per_step: Array.from({length: 9}, () => 300 * cost * (0.97 + 0.06 * chance()))};
      if (chance() < 0.01) Object.assign(one, {status: "diverged", reason: `at t = ${(row.duration * chance()).toFixed(4)}`, cost: null});
      text += JSON.stringify(one) + "\n";
    }
    writeSync(file, text);
    text = "";
  }
  closeSync(file);
}

const browser = new Chromium(chromium);
try {
  const path = join(folder, "results.jsonl");
  mkdirSync(folder, {recursive: true});
  if (!existsSync(path)) multiply(path, Number(runs));
  console.log(`${runs} runs, ${(statSync(path).size / 1e6).toFixed(0)} MB`);
  const began = Date.now();
  const made = spawnSync("/usr/bin/env", ["bash", "-c", 'ulimit -v 16000000; exec "$0" report "$1"', plumb, folder], {encoding: "utf8"});
  assert.equal(made.status, 0, made.stderr);
  const size = statSync(join(folder, "report.html")).size;
  console.log(`written in ${((Date.now() - began) / 1000).toFixed(0)} s: ${(size / 1e6).toFixed(1)} MB`);
  const opened = [];
  for (let i = 0; i < 3; ++i) {
    const page = await Page.open(browser, `file://${folder}/report.html`);
    await page.until("document.querySelector('details.scene[open] svg')", 60);
    // Since the navigation began: the first paint with content, and the first scene drawn.
    const paint = await page.ask("performance.getEntriesByName('first-contentful-paint')[0].startTime");
    opened.push([paint / 1000, (await page.ask("performance.now()")) / 1000]);
    if (i === 2) {
      console.log(await page.ask("document.getElementById('counts').textContent"));
      if (kept) writeFileSync(join(kept, "report.png"), await page.screenshot());
      assert.deepEqual(page.complaints, []);
    }
    await page.close();
  }
  console.log(`first screen after ${opened.map(([paint]) => paint.toFixed(2)).join(", ")} s; ` +
    `first scene drawn after ${opened.map(([, drawn]) => drawn.toFixed(2)).join(", ")} s`);
  assert.ok(size < kBytes, `${size} bytes`);
  assert.ok(Math.min(...opened.map(([, drawn]) => drawn)) < kSeconds, "opens too slowly");
} finally {
  await browser.close();
  if (!kept) rmSync(folder, {recursive: true, force: true});
}
