// The page: the summary, the scenes, the places.
const data = JSON.parse(document.getElementById("data").textContent);
// plumb's own first, so that engines look alike in most reports.
data.engines.sort((a, b) => isPlumb(b) - isPlumb(a) || (a < b ? -1 : 1));
const look = looks(data.engines);
const sceneBoxes = new Map();

function counted() {
  const counts = new Map();
  let missed = 0, unexpected = 0;
  for (const scene of data.scenes)
    for (const row of scene.rows) {
      counts.set(row.status, (counts.get(row.status) ?? 0) + 1);
      missed += isMissed(row);
      unexpected += row.unexpected.length > 0;
    }
  const elsewhere = data.scenes.reduce((sum, scene) => sum + scene.rows.filter((row) => row.cost_left_out).length, 0);
  const leftOut = elsewhere ? `The costs of ${elsewhere} are left out: measured on another kind of machine than the scene's others.` : "";
  const {endurances, thresholds} = data.extremes;
  const total = (key) => endurances.filter((row) => row.setting !== "any setting").reduce((sum, row) => sum + row[key], 0);
  const found = [endurances.length ? `${total("total")} cells of extremes, ${total("survived")} survived.` : "",
    thresholds.length ? `${thresholds.length} thresholds.` : ""].filter(Boolean);
  if (data.scenes.length === 0) return found.join(" ");
  const parts = [...counts].map(([status, count]) => `${count} ${status}`);
  return `${data.scenes.length} scenes, ${data.engines.length} engines; runs: ${parts.join(", ")}. ` +
    [`${missed} missed a check; ${unexpected} not as expected.`, leftOut, ...found].filter(Boolean).join(" ");
}

function goTo(label) {
  const box = sceneBoxes.get(label);
  box.open = true;
  box.scrollIntoView({block: "start"});
}

function verdict(row) {
  if (row.points === 0) return row.why_none;
  if (row.worse === 0) return "in none";
  const noise = row.worse - row.clearly_worse;
  return `in ${row.worse} of ${row.points}${noise ? (noise === row.worse ? ", within noise" : `, ${noise} within noise`) : ""}`;
}

function standingTable() {
  return table([
    {name: "scene", text: (row) => make("a", {href: "#", text: row.label, click: (event) => { event.preventDefault(); goTo(row.label); }}),
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
  const box = document.getElementById("exceptions");
  box.querySelector("summary").textContent = rows.length === 0 ? "No rival's point is worse for plumb" :
    `${rows.length === 1 ? "The point of a rival" : `The ${rows.length} points of rivals`} that plumb does not dominate`;
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
    const bad = scene.rows.filter((row) => !["ok", "skipped"].includes(row.status)).length;
    const missed = scene.rows.filter(isMissed).length;
    const notes = [`${scene.rows.length} runs`];
    if (bad) notes.push(`${bad} failed`);
    if (missed) notes.push(`${missed} with a check missed`);
    const box = make("details", {class: "scene", "data-label": scene.label},
      make("summary", {}, make("b", {text: scene.label}), make("span", {class: "note", text: ` \u2013 ${notes.join(", ")}`})), content);
    box.addEventListener("toggle", () => {
      if (box.open && !content.hasChildNodes()) fillScene(content, scene, data, look);
    });
    sceneBoxes.set(scene.label, box);
    section.append(box);
  }
  document.getElementById("open-all").addEventListener("click", () => { for (const box of sceneBoxes.values()) box.open = true; });
  if (data.scenes.length > 0) sceneBoxes.get(data.standings[0]?.label ?? data.scenes[0].label).open = true;
}

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
  document.getElementById("standing-table").append(standingTable());
  exceptionTable();
  sceneList();
} else {
  document.getElementById("standing").hidden = document.getElementById("scenes").hidden = true;
}
showExtremes(data.extremes);
showThresholds(data.extremes.thresholds);
environmentTable();
sectionLinks();
