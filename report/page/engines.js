// How each engine looks: a colour, a mark and a dash, so that no two differ by colour alone.
const kColours = ["#0072b2", "#d55e00", "#009e73", "#b8860b", "#cc79a7", "#3f8fd2", "#8a5cc2", "#7a7a72", "#c2384a",
  "#2f9c9c", "#9a6b3f"];
const kDashes = ["", "7 4", "2 3", "10 3 2 3", "5 2", "1 4", "12 4", "4 4 1 4", "8 2 2 2 2 2", "3 6", "14 3 3 3"];

const polygon = (corners, turn = 0, waist = 1) => {
  const points = [];
  const count = waist === 1 ? corners : 2 * corners;
  for (let i = 0; i < count; ++i) {
    const angle = turn + 2 * Math.PI * i / count;
    const radius = i % 2 && waist !== 1 ? waist : 1;
    points.push(`${(radius * Math.sin(angle)).toFixed(3)} ${(-radius * Math.cos(angle)).toFixed(3)}`);
  }
  return `M${points.join("L")}Z`;
};
const kMarks = [
  "M1 0A1 1 0 1 1 -1 0A1 1 0 1 1 1 0Z", "M-.85 -.85H.85V.85H-.85Z", polygon(3), polygon(4), polygon(3, Math.PI),
  polygon(5, 0, 0.42), polygon(6), "M-.35 -1H.35V-.35H1V.35H.35V1H-.35V.35H-1V-.35H-.35Z", polygon(4, Math.PI / 4, 0.4),
  polygon(3, Math.PI / 2), "M-1 -.5H1V.5H-1Z",
];

const isPlumb = (engine) => engine === "plumb" || engine.startsWith("plumb-");

/// By name: {colour, dash, mark, filled}. plumb's own marks are filled, rivals' are hollow.
function looks(engines) {
  const out = new Map();
  engines.forEach((engine, i) => {
    out.set(engine, {colour: kColours[i % kColours.length], dash: kDashes[i % kDashes.length],
      mark: kMarks[i % kMarks.length], filled: isPlumb(engine)});
  });
  return out;
}

function markOf(look, x, y, size = 5) {
  return makeSvg("path", {d: look.mark, transform: `translate(${x.toFixed(2)} ${y.toFixed(2)}) scale(${size})`,
    fill: look.filled ? look.colour : "var(--panel)", stroke: look.colour, "stroke-width": 1.6 / size});
}

/// Buttons that hide and show engines. `changed` is called with the set of hidden ones.
function legend(engines, look, hidden, changed) {
  const box = make("div", {class: "legend", role: "group", "aria-label": "engines shown"});
  for (const engine of engines) {
    const style = look.get(engine);
    const key = makeSvg("svg", {viewBox: "0 0 34 14", "aria-hidden": "true"},
      makeSvg("line", {x1: 0, x2: 34, y1: 7, y2: 7, stroke: style.colour, "stroke-width": 2,
        "stroke-dasharray": style.dash}), markOf(style, 17, 7));
    const button = make("button", {type: "button", "aria-pressed": "true", "data-engine": engine,
      click: () => {
        hidden.has(engine) ? hidden.delete(engine) : hidden.add(engine);
        button.setAttribute("aria-pressed", String(!hidden.has(engine)));
        changed();
      }}, key, make("span", {text: engine}));
    box.append(button);
  }
  return box;
}
