// Where engines break: maps of outcomes, an engine and setting a row, a value of the family's axis a column.

// By outcome: its colour's class, and a word that is short enough for a cell. Others are shown as they are.
const kOutcomes = {
  ok: ["all", "ok"], inaccurate: ["near", "inexact"], drifts: ["wrong", "drifts"], tunnels: ["wrong", "tunnels"],
  sinks: ["wrong", "sinks"], stretches: ["wrong", "stretches"], freezes: ["wrong", "freezes"], explodes: ["broken", "explodes"],
  NaN: ["broken", "NaN"], crashed: ["broken", "crashed"], timeout: ["broken", "timeout"], refused: ["refused", "refused"],
  skipped: ["none", "\u2013"],
};
const outcomeOf = (outcome) => kOutcomes[outcome] ?? ["broken", outcome];
const kLegend = [["all", "ok", "survived"], ["near", "inexact", "error up to ten times the bound"],
  ["wrong", "sinks \u2026", "the run continues with wrong physics"], ["broken", "NaN \u2026", "not finite, crashed, exploded or out of time"],
  ["refused", "refused", "the engine rejected the scene"], ["none", "\u2013", "the engine lacks a feature that the family needs: not counted"]];

// Steps are shares of a second: 1/60.
const axisText = (value) => (value > 1e-3 && value < 0.1 && figure4(value) !== String(value) ? stepText(value) : figure4(value).replace(/^1\u00b7/, ""));
const rowName = (row) => `${row.engine}, ${row.setting}`;
const shareClass = ({survived, total}) => (total === 0 ? "none" : survived === total ? "all" : survived >= 0.8 * total ? "near" :
  survived >= 0.5 * total ? "wrong" : "broken");

/// A table whose cells are coloured. `cell(row, column)` gives {kind, text, tip, data} or null. Arrows move between cells.
function heatMap(title, note, columns, rows, cell) {
  const tips = new WeakMap();
  const say = (target) => {
    const text = tips.get(target);
    if (!text) return untell();
    tell(text, target, target.offsetWidth - 12, 0);
  };
  const body = make("tbody", {}, ...rows.map((row) => make("tr", {},
    make("th", {scope: "row"}, make("b", {text: row.engine}), row.setting === undefined ? null : make("span", {text: ` ${row.setting}`})),
    ...columns.map((column) => {
      const content = cell(row, column);
      if (!content) return make("td", {class: "none"});
      const td = make("td", {class: content.kind, text: content.text, tabindex: -1, ...content.data});
      tips.set(td, content.tip);
      return td;
    }))));
  const table = make("table", {class: "map", role: "grid", "aria-label": title}, make("thead", {}, make("tr", {}, make("th", {scope: "col", text: "engine, setting"}),
    ...columns.map((column) => make("th", {scope: "col", class: column.slanted ? "upright" : undefined}, make("span", {text: column.text}))))), body);
  body.querySelector("td[tabindex]")?.setAttribute("tabindex", "0");
  table.addEventListener("pointerover", (event) => say(event.target));
  table.addEventListener("pointerleave", untell);
  table.addEventListener("focusin", (event) => {
    body.querySelector('td[tabindex="0"]')?.setAttribute("tabindex", "-1");
    event.target.setAttribute("tabindex", "0");
    say(event.target);
  });
  table.addEventListener("focusout", untell);
  table.addEventListener("keydown", (event) => {
    if (event.key === "Escape") untell();
    const [right, down] = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1]}[event.key] ?? [0, 0];
    if (!right && !down) return;
    event.preventDefault();
    const from = event.target.closest("td");
    body.rows[from.parentNode.sectionRowIndex + down]?.cells[from.cellIndex + right]?.focus();
  });
  return make("figure", {class: "chart"}, make("figcaption", {text: `${title} `}, make("span", {text: note})), make("div", {class: "scroll"}, table));
}

const settingsText = ({settings}) => Object.entries(settings ?? {}).map(([name, value]) =>
  `${words(name)} ${name === "dt" ? stepText(Number(value)) : value}`).join(", ");
const megabytes = (bytes) => (bytes ? `${Number((bytes / 1e6).toPrecision(3))} MB` : "");

function cellText(cell, family) {
  const lines = [`${rowName(cell)}: ${family.axis} ${axisText(cell.value)} ${family.unit}`.trim()];
  lines.push(cell.reason ? `${cell.outcome}: ${cell.reason}` : cell.outcome);
  if (Number.isFinite(cell.figure))
    lines.push(`${cell.measure} ${withUnit(cell.figure, cell.figure_unit)}${Number.isFinite(cell.bound) ? `, bound ${withUnit(cell.bound, cell.figure_unit)}` : ""}`);
  const costs = [cell.steps ? `${cell.steps} steps` : "", Number.isFinite(cell.seconds) ? duration(1e9 * cell.seconds) : "", megabytes(cell.memory)];
  lines.push(costs.filter(Boolean).join(", "), settingsText(cell));
  return lines.filter(Boolean).join("\n");
}

// Families with their cells, first where plumb survives least.
function familiesOf(cells) {
  const families = new Map();
  for (const cell of cells) {
    const known = families.get(cell.family) ?? families.set(cell.family, {name: cell.family, title: cell.title ?? words(cell.family), axis: cell.axis,
      unit: cell.unit, cells: []}).get(cell.family);
    known.cells.push(cell);
  }
  const count = (some) => {
    const counted = some.filter((cell) => cell.outcome !== "skipped");
    return {survived: counted.filter((cell) => cell.outcome === "ok").length, total: counted.length};
  };
  for (const family of families.values()) {
    family.plumb = count(family.cells.filter((cell) => isPlumb(cell.engine)));
    family.rivals = count(family.cells.filter((cell) => !isPlumb(cell.engine)));
  }
  const share = ({plumb}) => (plumb.total ? plumb.survived / plumb.total : 2);
  return [...families.values()].sort((a, b) => share(a) - share(b));
}

function familyMap(family, rows, rule) {
  const values = [...new Set(family.cells.map((cell) => cell.value))].sort((a, b) => a - b);
  const places = new Map(family.cells.map((cell) => [`${rowName(cell)}|${cell.value}`, cell]));
  const of = ({survived, total}, who) => (total ? `${who} ${survived} of ${total}` : "");
  const note = `${family.axis}${family.unit ? `, ${family.unit}` : ""}; survived: ` +
    [of(family.plumb, "plumb"), of(family.rivals, "the others")].filter(Boolean).join(", ");
  const seen = rows.filter((row) => family.cells.some((cell) => rowName(cell) === rowName(row)));
  const map = heatMap(family.title, note, values.map((value) => ({value, text: axisText(value)})), seen, (row, {value}) => {
    const cell = places.get(`${rowName(row)}|${value}`);
    if (!cell) return null;
    const [kind, text] = outcomeOf(cell.outcome);
    return {kind, text, tip: cellText(cell, family), data: {"data-outcome": cell.outcome}};
  });
  map.dataset.family = family.name;
  if (rule) map.querySelector("figcaption").after(make("p", {class: "note", text: `Survives: ${rule}.`}));
  return map;
}

// How many cells of each family an engine survives.
function overview(families, rows) {
  const columns = [{text: "all"}, ...families.map((family) => ({text: words(family.name), family, slanted: true}))];
  const map = heatMap("All families", "cells survived of those run; colours: all, four fifths, half, fewer", columns, rows, (row, {family}) => {
    const count = family ? row.families[family.name] ?? {survived: 0, total: 0} : row;
    const text = count.total ? `${count.survived}/${count.total}` : "\u2013";
    return {kind: shareClass(count), text, tip: `${rowName(row)}: ${family ? family.title : "all families"}\n` +
      (count.total ? `${count.survived} of ${count.total} cells survived` : "the engine lacks a feature that the family needs")};
  });
  map.dataset.family = "all";
  return map;
}

function enduranceTable(rows) {
  const outcomes = Object.keys(kOutcomes).filter((outcome) => rows.some((row) => row.outcomes[outcome]));
  const others = new Set(rows.flatMap((row) => Object.keys(row.outcomes)).filter((outcome) => !(outcome in kOutcomes)));
  return table([
    {name: "engine", text: (row) => row.engine},
    {name: "setting", text: (row) => row.setting},
    {name: "survived", number: true, value: (row) => (row.total ? row.survived / row.total : null),
      text: (row) => `${row.survived} of ${row.total}${row.total ? `, ${(100 * row.survived / row.total).toFixed(1)} %` : ""}`},
    ...[...outcomes, ...others].filter((outcome) => outcome !== "ok").map((outcome) => ({name: outcome, number: true,
      text: (row) => String(row.outcomes[outcome] ?? "\u2013"), value: (row) => row.outcomes[outcome] ?? 0,
      mark: (row) => (row.outcomes[outcome] && isPlumb(row.engine) && outcomeOf(outcome)[0] === "broken" ? "bad" : "")}))], rows);
}

/// The section of the maps, if `plumb stress` left any.
function showExtremes({cells, rules, endurances}) {
  const section = document.getElementById("extremes");
  section.hidden = cells.length === 0;
  if (section.hidden) return;
  const families = familiesOf(cells);
  section.querySelector(".table").append(enduranceTable(endurances));
  section.querySelector(".keys").append(...kLegend.map(([kind, word, text]) => make("li", {},
    make("b", {class: kind, text: word}), make("span", {text: ` ${text}`}))));
  section.querySelector(".maps").append(overview(families, endurances), ...families.map((family) => familyMap(family, endurances, rules[family.name])));
}

// What was found, for people: where every value that was tried is alike, these are told.
function foundText(row) {
  const tried = `${axisText(row.low)} \u2026 ${axisText(row.high)}`;
  if (row.outcome === "always") return `all of ${tried}`;
  if (row.outcome === "never") return `none of ${tried}`;
  if (!Number.isFinite(row.found)) return row.outcome;
  return row.outcome === "found" ? figure4(row.found) : `${row.outcome}, about ${figure4(row.found)}`;
}

/// The section of the thresholds, if `plumb thresholds` left any.
function showThresholds(rows) {
  const section = document.getElementById("thresholds");
  section.hidden = rows.length === 0;
  if (section.hidden) return;
  const found = (row) => (["found", "unclear"].includes(row.outcome) && Number.isFinite(row.found) ? row.found : null);
  const off = (row) => (found(row) !== null && row.exact ? row.found / row.exact - 1 : null);
  const names = [...new Set(rows.map((row) => row.name))];
  const sorted = [...rows].sort((a, b) => names.indexOf(a.name) - names.indexOf(b.name) || isPlumb(b.engine) - isPlumb(a.engine));
  const title = (row) => row.title ?? words(row.name);
  section.querySelector("ul").append(...names.map((name) => {
    const row = rows.find((one) => one.name === name);
    const rest = [row.quantity, row.source ? `exact: ${row.source}` : "", row.judged ? `failure: ${row.judged}` : ""];
    return make("li", {}, make("b", {text: title(row)}), `: ${rest.filter(Boolean).join("; ")}`);
  }));
  section.querySelector(".table").append(table([
    {name: "threshold", wide: true, text: title},
    {name: "engine", text: (row) => (row.setting === "default" ? row.engine : rowName(row))},
    {name: "found", number: true, text: foundText, value: found, mark: (row) => (row.outcome === "refused" ? "note" : row.outcome === "unclear" ? "bad" : "")},
    {name: "exact", number: true, text: (row) => (Number.isFinite(row.exact) ? figure4(row.exact) : "\u2013"), value: (row) => row.exact},
    {name: "off by", number: true, text: (row) => percent(off(row)), value: (row) => (off(row) === null ? null : Math.abs(off(row)))},
    {name: "unit", text: (row) => row.unit || ""},
    {name: "remarks", wide: true, text: (row) => row.reason ?? ""},
    {name: "runs", number: true, text: (row) => String(row.runs ?? "\u2013"), value: (row) => row.runs},
    {name: "settings", text: settingsText},
  ], sorted));
}
