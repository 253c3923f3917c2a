// One scene's part of the report, made when it is opened.

// Settings that runs share are there once, and without the step, which the run has.
const settingsOf = (row) => ({dt: String(row.dt), ...data.settings[row.settings]});

function rowText(row, metric, unit) {
  const lines = [`${words(metric)}: ${withUnit(row.metrics[metric], unit)}`];
  if (row.cost) lines.push(`${duration(row.cost.second)} a simulated second, ${duration(row.cost.step)} a step (quartiles ` +
    `${duration(row.cost.low)} to ${duration(row.cost.high)})`);
  lines.push(row.asked);
  return lines.join("\n");
}

// Whether a replay is not of the run that was measured: both sample every step, so that their largest errors are the same.
function isAnother(row) {
  const measured = row.metrics.position_error, replayed = Math.max(...row.replay.errors.filter((error) => error !== null), 0);
  return row.status === "ok" && measured !== undefined && row.dt > 1 / 240.5 && Math.abs(replayed - measured) > 1e-4 * measured + 1e-12;
}

/// From cheap to accurate, without what another point beats in both.
function frontOf(points) {
  const out = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
    if (out.length === 0 || point.y < out.at(-1).y) out.push(point);
  return out;
}

function workPrecision(scene, metric, unit, engines, look) {
  const series = engines.map((engine) => {
    const points = scene.rows.filter((row) => row.engine === engine && row.status === "ok" && row.cost &&
      row.metrics[metric] !== undefined).map((row) => ({x: row.cost.second / 1e3, y: Math.max(row.metrics[metric], 1e-12),
      text: rowText(row, metric, unit)}));
    return {engine, points, line: frontOf(points)};
  });
  return chart({name: "work-precision", title: "Work and precision", logX: true, logY: true,
    note: "left and low is better; lines: Pareto fronts; errors below 10\u207b\u00b9\u00b2 count as 10\u207b\u00b9\u00b2",
    x: "\u00b5s a simulated second", y: unit ? `${words(metric)}, ${unit}` : words(metric)}, series, look);
}

function againstTime(scene, name, title, key, y, engines, look) {
  const series = engines.map((engine, i) => {
    const row = scene.rows.find((one) => one.engine === engine && one.replay);
    const points = (row?.replay.times ?? []).map((time, k) => ({x: time, y: row.replay[key][k],
      text: `${figure(row.replay[key][k])} at ${Number(time.toPrecision(4))} s\n${row.asked}`}))
      .filter((point) => point.x > 0 && point.y !== null && Number.isFinite(point.y))
      .map((point) => ({...point, y: Math.max(point.y, 1e-16)}));
    return {engine, points, line: points, every: 30, offset: (7 * i) % 30};
  });
  return chart({name, title, note: "the largest since the sample before; below 10\u207b\u00b9\u2076 counts as that", logX: false, logY: true, x: "time, s", y}, series, look);
}

// The cost of a step at the step that most engines have in common.
function costs(scene, look) {
  const counts = new Map();
  for (const row of scene.rows) if (row.cost) counts.set(row.dt, (counts.get(row.dt) ?? new Set()).add(row.engine));
  const [dt] = [...counts].sort((a, b) => b[1].size - a[1].size || Math.abs(Math.log(a[0] * 60)) - Math.abs(Math.log(b[0] * 60)))[0] ?? [];
  const rows = [];
  for (const engine of counts.get(dt) ?? []) {
    const {cost, asked} = scene.rows.filter((row) => row.cost && row.dt === dt && row.engine === engine)
      .reduce((best, row) => (row.cost.step < best.cost.step ? row : best));
    rows.push({engine, value: cost.step, low: cost.low, high: cost.high,
      text: `${duration(cost.step)} a step (quartiles ${duration(cost.low)} to ${duration(cost.high)})\n${asked}`});
  }
  rows.sort((a, b) => a.value - b.value);
  const note = dt === undefined ? "" : `at dt = ${stepText(dt)} s with each engine's cheapest settings there; logarithmic; ` +
    "lines: the middle half of the repetitions";
  return bars({name: "costs", title: "Cost of a step", note}, rows, look);
}

// Of each engine the settings that were run with the most steps; those with a tolerance choose their own steps.
function againstStep(scene, metric, unit, engines, look) {
  const series = engines.map((engine) => {
    const bySettings = new Map();
    for (const row of scene.rows) {
      if (row.engine !== engine || row.status !== "ok" || row.metrics[metric] === undefined || /\btolerance\b/.test(row.asked)) continue;
      const others = row.asked.replace(/^dt [^,]+(, )?/, "");
      const points = bySettings.get(others) ?? bySettings.set(others, new Map()).get(others);
      points.set(row.dt, {x: row.dt, y: Math.max(row.metrics[metric], 1e-16), text: rowText(row, metric, unit)});
    }
    const longest = [...bySettings.values()].reduce((best, one) => (one.size > best.size ? one : best), new Map());
    const points = longest.size > 2 ? [...longest.values()].sort((a, b) => a.x - b.x) : [];
    return {engine, points, line: points};
  }).filter((one) => one.points.length > 0);
  return chart({name: "convergence", title: "Error against the step", logX: true, logY: true,
    note: "the steeper, the higher the order; other settings alike", x: "dt, s",
    y: unit ? `${words(metric)}, ${unit}` : words(metric)}, series, look);
}

function convergence(scene) {
  if (scene.orders.length === 0) return null;
  return make("div", {}, make("h3", {text: "Convergence"}),
    make("p", {class: "note", text: "The observed order: the median slope of error against dt, other settings alike, above rounding. " +
      "1 for semi-implicit Euler, 2 for Verlet, 4 for Runge-Kutta 4."}),
    make("div", {class: "scroll"}, table([
      {name: "engine", text: (row) => row.engine},
      {name: "order", number: true, text: (row) => row.order.toFixed(2), value: (row) => row.order},
      {name: "pairs of steps", number: true, text: (row) => String(row.pairs), value: (row) => row.pairs}], scene.orders)));
}

// The engines that agree with the truth and with each other, and what the others miss by how much and why.
function agreement(scene) {
  if (!scene.agreement) return null;
  const {agree, dissents, groups} = scene.agreement, ran = agree.length + dissents.length;
  if (ran === 0) return null;
  const others = groups.length === 1 && groups[0].length === ran ? `all ${ran}` : groups.map((names) => names.join(", ")).join("; ");
  const box = make("div", {"data-part": "agreement"}, make("h3", {text: "Who agrees"}),
    make("p", {text: `With the truth, each check within its bound: ${agree.length ? agree.join(", ") : "none"} (${agree.length} of ${ran}).`}));
  if (ran > 1 && groups.length) box.append(make("p", {text: `With each other, within the sum of both bounds: ${others}.`}));
  if (dissents.length === 0) return box;
  box.append(make("div", {class: "scroll"}, table([
    {name: "engine", text: (row) => row.engine},
    {name: "misses most", text: (row) => (row.misses[0] ? words(row.misses[0].check) : "diverged")},
    {name: "by", number: true, text: (row) => (row.misses[0] ? figure(row.misses[0].value) : ""), value: (row) => row.misses[0]?.value},
    {name: "of its bound", number: true, text: (row) => (row.misses[0] ? times(row.misses[0].times) : ""),
      value: (row) => row.misses[0]?.times ?? Infinity},
    {name: "also", text: (row) => row.misses.slice(1).map((miss) => words(miss.check)).join(", ")},
    {name: "reason", wide: true, text: (row) => row.reason}], dissents)));
  return box;
}

function checks(scene) {
  const missed = scene.rows.flatMap((row) => row.missed.map((check) => ({...check, engine: row.engine, asked: row.asked,
    unexpected: row.unexpected.length > 0})));
  const {checks: total, held} = scene.runs, left = total - held - missed.length;
  const box = make("div", {"data-part": "checks"}, make("h3", {text: "Checks"}),
    make("p", {text: `${held} of ${total} held${missed.length ? `; not these${left ? `, and ${left} of runs that are not listed here` : ""}:` : "."}`}));
  if (missed.length === 0) return box;
  box.append(make("div", {class: "scroll"}, table([
    {name: "engine", text: (row) => row.engine},
    {name: "check", text: (row) => words(row.name)},
    {name: "against", text: (row) => row.oracle},
    {name: "value", number: true, text: (row) => figure(row.value), value: (row) => row.value},
    {name: "tolerance", number: true, text: (row) => figure(row.tolerance), value: (row) => row.tolerance},
    {name: "known limit", wide: true, text: (row) => row.known_limit || "none declared for these settings", mark: (row) => (row.unexpected ? "bad" : "")},
    {name: "settings", wide: true, text: (row) => row.asked}], missed)));
  return box;
}

function runs(scene, metrics) {
  const present = Object.keys(metrics).filter((name) => scene.rows.some((row) => row.metrics[name] !== undefined));
  const columns = [
    {name: "engine", text: (row) => row.engine},
    {name: "status", text: (row) => row.status, mark: (row) => (row.status === "ok" ? "" : row.status === "skipped" ? "note" : "bad")},
    {name: "asked for", wide: true, text: (row) => row.asked},
    ...present.map((name) => ({name: words(name) + (metrics[name] ? `, ${metrics[name]}` : ""), number: true,
      text: (row) => figure(row.metrics[name]), value: (row) => row.metrics[name]})),
    {name: "a step", number: true, text: (row) => duration(row.cost?.step), value: (row) => row.cost?.step},
    {name: "a simulated s", number: true, text: (row) => duration(row.cost?.second), value: (row) => row.cost?.second},
    {name: "set up", number: true, text: (row) => duration(row.cost?.setup), value: (row) => row.cost?.setup},
    {name: "effective settings", wide: true, text: (row) => Object.entries(settingsOf(row)).map(([k, v]) => `${words(k)} ${v}`).join(", ")},
    {name: "version", text: (row) => `${row.version} ${row.precision}`},
  ];
  const details = make("details", {"data-part": "runs"}, make("summary", {text: scene.rows.length < scene.runs.all ?
    `${scene.rows.length} of ${scene.runs.all} runs with settings` : `All ${scene.rows.length} runs with settings`}));
  details.addEventListener("toggle", () => {
    if (details.open && details.children.length === 1) details.append(make("div", {class: "scroll"}, table(columns, scene.rows)));
  });
  return details;
}

// Engines that did not run to the end, with the reason.
function failures(scene) {
  const {failures: kinds, failure_kinds: count} = scene.runs;
  if (kinds.length === 0) return null;
  const items = kinds.map(({text, status, runs}) => make("li", {class: status === "skipped" ? "note" : "bad",
    text: runs > 1 ? `${text} (${runs} runs)` : text}));
  if (kinds.length < count) items.push(make("li", {class: "note", text: `${count - kinds.length} more kinds, of fewer runs each`}));
  return make("div", {"data-part": "failures"}, make("h3", {text: "Skipped and failed"}), make("ul", {}, ...items));
}

function fillScene(box, scene, data, look) {
  const engines = data.engines.filter((engine) => scene.rows.some((row) => row.engine === engine && row.status !== "skipped"));
  const unit = data.metrics[scene.metric];
  const hidden = new Set();
  const parts = [];
  const motions = new Map();
  for (const engine of engines) {
    const row = scene.rows.find((one) => one.engine === engine && one.replay);
    if (row) motions.set(engine, row.replay);
  }
  const pictures = make("div", {class: "grid"}), charts = make("div", {class: "grid"});
  if (scene.scene) {
    pictures.append(setUp(scene.scene, scene.motion ? scene.motion.poses : []));
    if (scene.motion || motions.size) parts.push([pictures, replay(scene.scene, scene.duration, scene.motion ?? null, motions, look)]);
    const others = scene.rows.filter((row) => row.replay && isAnother(row)).map((row) => row.engine);
    if (others.length) pictures.append(make("p", {class: "bad", text: `Run again for the replay, these moved otherwise than when ` +
      `they were measured, as another version of an engine does: ${others.join(", ")}.`}));
    const still = engines.filter((engine) => !motions.has(engine));
    if (still.length) pictures.append(make("p", {class: "note", text: `Not replayed here: ${still.join(", ")}.`}));
  } else {
    pictures.append(make("p", {class: "note", text: "This scene is not one of plumb's own, so it is not drawn."}));
  }
  parts.push([charts, workPrecision(scene, scene.metric, unit, engines, look)], [charts, costs(scene, look)],
    [charts, againstStep(scene, scene.metric, unit, engines, look)]);
  if (motions.size) {
    parts.push([charts, againstTime(scene, "error", "Error against time", "errors", "distance from the truth, m", engines, look)],
      [charts, againstTime(scene, "energy", "Energy against time", "energies", "relative energy drift", engines, look)]);
  }
  const drawAll = () => { for (const [, part] of parts) part.draw(hidden); };
  for (const [place, part] of parts) if (!part.empty) place.append(part.element);
  box.append(make("p", {text: `${scene.summary ? `${scene.summary}; ` : ""}${Number(scene.duration.toPrecision(6))} s. ` +
    `Truth: ${scene.truth || "not known"}. Judged by ${words(scene.metric)}.`}),
    legend(engines, look, hidden, drawAll), pictures, charts);
  for (const part of [failures(scene), agreement(scene), checks(scene), convergence(scene), runs(scene, data.metrics)]) if (part) box.append(part);
  drawAll();
}
