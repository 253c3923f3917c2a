// The page: the summary, the scenes, the places.
const data = JSON.parse(document.getElementById("data").textContent);
// plumb's own first, so that engines look alike in most reports.
data.engines.sort((a, b) => isPlumb(b) - isPlumb(a) || (a < b ? -1 : 1));
const look = looks(data.engines);
const sceneBoxes = new Map();

function counted() {
  const counts = new Map();
  let missed = 0, unexpected = 0, elsewhere = 0;
  for (const {runs} of data.scenes) {
    for (const [status, count] of Object.entries(runs.statuses)) counts.set(status, (counts.get(status) ?? 0) + count);
    missed += runs.missed;
    unexpected += runs.unexpected;
    elsewhere += runs.left_out;
  }
  const all = data.scenes.reduce((sum, scene) => sum + scene.runs.all, 0), here = data.scenes.reduce((sum, scene) => sum + scene.rows.length, 0);
  const sampled = here < all ? `Of these ${all}, ${here} are shown: fronts, series, each kind of failure, and an even selection of the others; ` +
    "results.jsonl beside this page has all, and all counts include all." : "";
  const leftOut = elsewhere ? `The costs of ${elsewhere} are left out, because they were measured on another kind of machine than the scene's others.` : "";
  const {endurances, thresholds} = data.extremes;
  const total = (key) => endurances.filter((row) => row.setting !== "any setting").reduce((sum, row) => sum + row[key], 0);
  const found = [endurances.length ? `${total("total")} cells of extremes, ${total("survived")} survived.` : "",
    thresholds.length ? `${thresholds.length} thresholds.` : ""].filter(Boolean);
  if (data.scenes.length === 0) return found.join(" ");
  const parts = [...counts].map(([status, count]) => `${count} ${status}`);
  return `${data.scenes.length} scenes, ${data.engines.length} engines; runs: ${parts.join(", ")}. ` +
    [`${missed} missed a check; ${unexpected ? `${unexpected} not as expected` : "all as expected"}.`, sampled, leftOut, ...found].filter(Boolean).join(" ");
}

// The largest position error of each engine in each scene: a dot a scene, a bar at the median.
function glance() {
  const rows = data.engines.map((engine) => {
    const own = data.scenes.map((scene) => [scene.label, bestOf(scene, engine)?.metrics.position_error])
      .filter(([, error]) => Number.isFinite(error)).map(([label, error]) => [label, Math.max(error, 1e-16)]);
    return {engine, own};
  }).filter(({own}) => own.length > 0);
  if (rows.length === 0) return false;
  const narrow = kNarrow, width = narrow ? 360 : 1180, left = narrow ? 118 : 150, right = 12, step = narrow ? 22 : 24, top = 8;
  const height = top + step * rows.length + 36, low = -16, high = 2;
  const x = (error) => left + (Math.min(Math.max(Math.log10(error), low), high) - low) / (high - low) * (width - left - right);
  const svg = makeSvg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img",
    "aria-label": "Position errors by engine; further left is more accurate"});
  for (let power = low; power <= high; power += narrow ? 6 : 2)
    svg.append(makeSvg("path", {d: `M${x(10 ** power)} ${top}V${height - 34}`, stroke: "var(--grid)"}),
      makeSvg("text", {x: x(10 ** power), y: height - 18, "text-anchor": "middle", text: power === 0 ? "1 m" : `10${raised(power)}`}));
  svg.append(makeSvg("text", {x: (left + width - right) / 2, y: height - 2, "text-anchor": "middle",
    text: narrow ? "largest position error, m; bar: the median" :
      "largest position error, m; a dot for each scene, a bar at the median; left is more accurate"}));
  rows.forEach(({engine, own}, i) => {
    const y = top + step * (i + 0.5), colour = look.get(engine).colour;
    svg.append(makeSvg("text", {x: left - 8, y: y + 4, "text-anchor": "end", text: engine}));
    for (const [label, error] of own)
      svg.append(makeSvg("circle", {cx: x(error).toFixed(1), cy: y, r: 3.2, fill: colour},
        makeSvg("title", {text: `${engine}, ${label}: ${figure(error)} m`})));
    const errors = own.map(([, error]) => error).sort((a, b) => a - b), middle = errors[Math.floor((errors.length - 1) / 2)];
    svg.append(makeSvg("path", {d: `M${x(middle).toFixed(1)} ${y - 9}V${y + 9}`, stroke: "var(--ink)", "stroke-width": 2.5}));
  });
  document.getElementById("glance").append(svg);
  return true;
}

// The run of an engine that the reader of a comparison means: with its defaults, else its most accurate one.
function bestOf(scene, engine) {
  const own = scene.rows.filter((row) => row.engine === engine && row.status === "ok" && Number.isFinite(row.metrics.position_error));
  return own.length < 2 ? own[0] : own.reduce((best, row) => (row.metrics.position_error < best.metrics.position_error ? row : best));
}

function sentence() {
  const parts = [];
  for (const rival of data.engines.filter((engine) => !isPlumb(engine))) {
    let both = 0, nearer = 0;
    const costs = [];
    for (const scene of data.scenes) {
      const [mine, other] = [bestOf(scene, "plumb"), bestOf(scene, rival)];
      if (!mine || !other || scene.one_truth === false) continue;
      both += 1;
      nearer += Math.max(mine.metrics.position_error, 1e-12) <= Math.max(other.metrics.position_error, 1e-12);
      if (mine.cost && other.cost) costs.push(mine.cost.second / other.cost.second);
    }
    if (both === 0) continue;
    costs.sort((a, b) => a - b);
    const cost = costs.length ? ` (at ${figure(costs[Math.floor((costs.length - 1) / 2)])} times its cost)` : "";
    parts.push(`${rival}'s in ${nearer} of ${both}${cost}`);
  }
  return parts.length === 0 ? "" :
    `In the scenes that both run, plumb's positions are at least as near to the truth as ${parts.join(", ")}.`;
}

function goTo(label) {
  const box = sceneBoxes.get(label);
  if (!box) return;
  box.open = true;
  history.replaceState(null, "", `#${encodeURIComponent(label)}`);
  box.scrollIntoView({block: "start"});
}

function verdict(row) {
  if (row.points === 0) return row.why_none;
  if (row.worse === 0) return "in none";
  const noise = row.worse - row.clearly_worse;
  return `in ${row.worse} of ${row.points}${noise ? (noise === row.worse ? ", within noise" : `, ${noise} within noise`) : ""}`;
}

// A label may be broken after its slashes, rather than within a word.
const breakable = (label) => label.split(/(?<=\/)/).flatMap((part, i) => (i > 0 ? [make("wbr"), part] : [part]));

function standingTable() {
  return table([
    {name: "scene", text: (row) => make("a", {href: "#", click: (event) => { event.preventDefault(); goTo(row.label); }}, ...breakable(row.label)),
      value: (row) => row.label},
    {name: "rival", text: (row) => row.rival},
    {name: "plumb is worse", text: verdict,
      value: (row) => (row.points ? row.clearly_worse / row.points + 1e-3 * row.worse / row.points : null), number: false,
      mark: (row) => (row.clearly_worse ? "bad" : row.points && row.worse === 0 ? "good" : "")},
    {name: "cost at equal error", number: true, text: (row) => times(row.cost_ratio), value: (row) => row.cost_ratio,
      mark: (row) => (row.cost_ratio > 1 ? "bad" : "")},
    {name: "error at equal cost", number: true, text: (row) => times(row.error_ratio), value: (row) => row.error_ratio,
      mark: (row) => (row.error_ratio > 1 ? "bad" : "")},
    {name: "never as accurate", number: true, text: (row) => (row.unreached ? `${row.unreached} of ${row.points}` : "\u2013"),
      value: (row) => row.unreached},
    {name: "rival failed", number: true, text: (row) => (row.failed ? String(row.failed) : "\u2013"), value: (row) => row.failed},
    {name: "by", text: (row) => words(row.metric)},
  ], data.standings, (row) => (row.clearly_worse ? "bad-row" : ""));
}

function exceptionTable() {
  const rows = data.standings.flatMap((row) => row.exceptions.map((point) => ({...point, label: row.label, rival: row.rival, unit: row.unit})));
  const all = data.standings.reduce((sum, row) => sum + row.worse, 0);
  const box = document.getElementById("exceptions");
  box.querySelector("summary").textContent = rows.length === 0 ? "No rival's point is worse for plumb" :
    `${all === 1 ? "The point of a rival" : `The ${all} points of rivals`} that plumb does not dominate` +
    (rows.length < all ? `; the ${rows.length} worst are here` : "");
  if (rows.length === 0) return;
  box.querySelector("div").append(table([
    {name: "scene", text: (row) => row.label},
    {name: "rival", text: (row) => row.rival},
    {name: "its settings", wide: true, text: (row) => row.settings},
    {name: "error", number: true, text: (row) => withUnit(row.error, row.unit), value: (row) => row.error},
    {name: "a simulated s", number: true, text: (row) => duration(row.cost), value: (row) => row.cost},
    {name: "plumb's cost for this (interpolated)", number: true, text: (row) => (row.cost_ratio === null ? "never as accurate" : times(row.cost_ratio)),
      value: (row) => row.cost_ratio ?? Infinity},
    {name: "noise", text: (row) => (row.noise ? "hides it" : "")},
  ], rows));
}

function sceneList() {
  const section = document.getElementById("scenes");
  for (const scene of data.scenes) {
    const content = make("div");
    const {all, statuses, missed} = scene.runs;
    const bad = Object.entries(statuses).reduce((sum, [status, count]) => sum + (["ok", "skipped"].includes(status) ? 0 : count), 0);
    const notes = [`${all} runs`];
    if (bad) notes.push(`${bad} failed`);
    if (missed) notes.push(`${missed} with a check missed`);
    const box = make("details", {class: "scene", "data-label": scene.label},
      make("summary", {}, make("b", {text: scene.label}), make("span", {class: "note", text: ` \u2013 ${notes.join(", ")}`})), content);
    box.addEventListener("toggle", () => {
      if (!box.open) return;
      if (!content.hasChildNodes()) fillScene(content, scene, data, look);
    });
    sceneBoxes.set(scene.label, box);
    section.append(box);
  }
  document.getElementById("open-all").addEventListener("click", () => { for (const box of sceneBoxes.values()) box.open = true; });
  // The first scene is filled after the first screen has been painted.
  const first = sceneBoxes.get(data.standings[0]?.label ?? data.scenes[0]?.label);
  if (first) requestAnimationFrame(() => setTimeout(() => { first.open = true; followHash(); }));
}

// Opens the place that the address names: a section or a scene.
function followHash() {
  const place = decodeURIComponent(location.hash.slice(1));
  if (sceneBoxes.has(place)) goTo(place);
}
addEventListener("hashchange", followHash);

function environmentTable() {
  document.querySelector("#environments div").append(table([
    {name: "runs", number: true, text: (row) => String(row.runs), value: (row) => row.runs},
    {name: "plumb", text: (row) => `${row.plumb_version}, ${row.commit}`},
    {name: "compiler", text: (row) => row.compiler},
    {name: "flags", wide: true, text: (row) => `${row.build_type} ${row.flags}`},
    {name: "processor", text: (row) => row.cpu},
    {name: "system", text: (row) => row.os},
    {name: "when (UTC)", text: (row) => (row.first === row.last ? row.first : `${row.first} to ${row.last}`)},
  ], data.environments));
}

function sectionLinks() {
  for (const section of document.querySelectorAll("main > section:not([hidden])"))
    document.querySelector("nav").append(make("a", {href: `#${section.id}`, text: section.querySelector("h2").textContent}), " ");
}

document.getElementById("title").textContent = data.title;
document.getElementById("counts").textContent = counted();
if (data.scenes.length > 0) {
  document.getElementById("sentence").textContent = sentence();
  document.getElementById("opening").hidden = !glance();
  // Without costs, and where no rival ran, there is nothing to rank.
  if (data.standings.some((row) => row.points > 0)) {
    document.getElementById("standing-table").append(standingTable());
    exceptionTable();
  } else {
    document.getElementById("standing").hidden = true;
  }
  sceneList();
} else {
  document.getElementById("standing").hidden = document.getElementById("scenes").hidden = true;
}
showExtremes(data.extremes);
showThresholds(data.extremes.thresholds);
environmentTable();
sectionLinks();
