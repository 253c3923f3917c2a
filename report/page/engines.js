// How each engine looks: a colour, a mark and a dash, so that no two differ by colour alone. There are 13 colours and 11
// marks: 143 engines look different.
const kColours = ["#0072b2", "#d55e00", "#009e73", "#b8860b", "#cc79a7", "#3f8fd2", "#8a5cc2", "#7a7a72", "#c2384a",
  "#2f9c9c", "#9a6b3f", "#5b8c00", "#b3478f"];
const kDashes = [[], [7, 4], [2, 3], [10, 3, 2, 3], [5, 2], [1, 4], [12, 4], [4, 4, 1, 4], [8, 2, 2, 2, 2, 2], [3, 6], [14, 3, 3, 3]];
// Marks of Chart.js, some of them turned, in degrees.
const kMarks = [["circle", 0], ["rect", 0], ["triangle", 0], ["rectRot", 0], ["triangle", 180], ["star", 0], ["triangle", 90], ["crossRot", 0],
  ["rectRounded", 0], ["triangle", 270], ["cross", 0]];

const isPlumb = (engine) => engine === "plumb" || engine.startsWith("plumb-");

/// By name: {colour, dash, mark, turn, filled}. plumb's own marks are filled, rivals' are hollow.
function looks(engines) {
  const out = new Map();
  engines.forEach((engine, i) => {
    const [mark, turn] = kMarks[i % kMarks.length];
    out.set(engine, {colour: kColours[i % kColours.length], dash: kDashes[i % kDashes.length], mark, turn, filled: isPlumb(engine)});
  });
  return out;
}

// A line with a mark, as the charts have them.
function key(style) {
  const [width, height] = [34, 14], canvas = make("canvas", {width: 2 * width, height: 2 * height, "aria-hidden": "true"});
  const context = canvas.getContext("2d");
  context.scale(2, 2);
  painted((colours) => {
    context.clearRect(0, 0, width, height);
    context.strokeStyle = style.colour;
    context.fillStyle = style.filled ? style.colour : colours.panel;
    context.lineWidth = 2;
    context.setLineDash(style.dash);
    context.beginPath();
    context.moveTo(0, height / 2);
    context.lineTo(width, height / 2);
    context.stroke();
    context.setLineDash([]);
    context.lineWidth = 1.6;
    Chart.helpers.drawPoint(context, {pointStyle: style.mark, rotation: style.turn, radius: 5.5, borderWidth: 1.6}, width / 2, height / 2);
  });
  return canvas;
}

/// Buttons that hide and show engines. `changed` is called with the set of hidden ones.
function legend(engines, look, hidden, changed) {
  const box = make("div", {class: "legend", role: "group", "aria-label": "engines shown"});
  for (const engine of engines) {
    const button = make("button", {type: "button", "aria-pressed": "true", "data-engine": engine,
      click: () => {
        hidden.has(engine) ? hidden.delete(engine) : hidden.add(engine);
        button.setAttribute("aria-pressed", String(!hidden.has(engine)));
        changed();
      }}, key(look.get(engine)), make("span", {text: engine}));
    box.append(button);
  }
  return box;
}
