// One kind of chart: marks and lines over two axes, either of them logarithmic; what is under the pointer is told.
// On a phone fewer units are as wide as the screen, so that text stays readable.
const kNarrow = Math.min(innerWidth, screen.width) < 600;
const kWidth = kNarrow ? 340 : 480, kHeight = kNarrow ? 260 : 300, kLeft = 62, kRight = 12, kTop = 8, kBottom = 42;

/// From the values to a position between 0 and 1, with the axis's ticks: [{at, text}].
function axisOf(values, log) {
  const finite = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
  if (finite.length === 0) return null;
  const change = log ? Math.log10 : (value) => value;
  let low = Infinity, high = -Infinity;
  for (const value of finite) { low = Math.min(low, change(value)); high = Math.max(high, change(value)); }
  if (high - low < (log ? 1 : 1e-12)) { const middle = (low + high) / 2; low = middle - 0.5; high = middle + 0.5; }
  const edge = log ? 0.06 * (high - low) : 0;
  low -= edge;
  high += edge;
  const ticks = [];
  if (log && high - low < 2) {
    for (let power = Math.floor(low); power <= high; ++power)
      for (const lead of high - low < 1.2 ? [1, 2, 5] : [1, 3]) {
        const at = power + Math.log10(lead);
        const text = Math.abs(power) < 5 ? String(Number((lead * 10 ** power).toPrecision(1))) :
          lead === 1 ? powerText(power) : `${lead}\u00b7${powerText(power)}`;
        if (at >= low && at <= high) ticks.push({at: (at - low) / (high - low), text});
      }
    return {place: (value) => (change(value) - low) / (high - low), ticks};
  }
  const step = log ? Math.max(1, Math.ceil((high - low) / 7)) : niceStep((high - low) / 6);
  for (let at = Math.ceil(low / step) * step; at <= high + 1e-9 * step; at += step)
    ticks.push({at: (at - low) / (high - low), text: log ? powerText(at) : String(Number(at.toPrecision(6)))});
  return {place: (value) => (change(value) - low) / (high - low), ticks};
}
const powerText = (power) => (power === 0 ? "1" : `10${raised(Math.round(power))}`);
function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9));
}

function axes(svg, x, y, options) {
  const right = kWidth - kRight, bottom = kHeight - kBottom;
  for (const {at, text} of x.ticks) {
    const place = kLeft + at * (right - kLeft);
    svg.append(makeSvg("line", {class: "grid-line", x1: place, x2: place, y1: kTop, y2: bottom}),
      makeSvg("text", {x: place, y: bottom + 16, "text-anchor": "middle", text}));
  }
  for (const {at, text} of y.ticks) {
    const place = bottom - at * (bottom - kTop);
    svg.append(makeSvg("line", {class: "grid-line", x1: kLeft, x2: right, y1: place, y2: place}),
      makeSvg("text", {x: kLeft - 6, y: place + 4, "text-anchor": "end", text}));
  }
  svg.append(makeSvg("rect", {class: "frame", x: kLeft, y: kTop, width: right - kLeft, height: bottom - kTop}),
    makeSvg("text", {x: (kLeft + right) / 2, y: kHeight - 6, "text-anchor": "middle", text: options.x}),
    makeSvg("text", {transform: `translate(13 ${(kTop + bottom) / 2}) rotate(-90)`, "text-anchor": "middle",
      text: options.y}));
}

/// `series`: [{engine, points: [{x, y, text}], line: points or null, marks}]. `options`: {title, note, x, y, logX, logY}.
/// Gives {element, draw(hidden)}.
function chart(options, series, look) {
  const svg = makeSvg("svg", {viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": options.title});
  const element = make("figure", {class: "chart", "data-chart": options.name},
    make("figcaption", {text: options.title + " "}, make("span", {text: options.note ?? ""})), svg);
  const all = series.flatMap((one) => one.points);
  let shown = [];
  const draw = (hidden) => {
    svg.replaceChildren();
    shown = [];
    const seen = series.filter((one) => !hidden.has(one.engine));
    const of = (points, key) => points.map((point) => point[key]);
    const points = seen.length ? seen.flatMap((one) => one.points) : all;
    const x = axisOf(of(points, "x"), options.logX), y = axisOf(of(points, "y"), options.logY);
    if (!x || !y) return;
    axes(svg, x, y, options);
    const right = kWidth - kRight, bottom = kHeight - kBottom;
    const place = (point) => ({x: kLeft + x.place(point.x) * (right - kLeft),
      y: bottom - y.place(point.y) * (bottom - kTop)});
    for (const one of seen) {
      const style = look.get(one.engine);
      const path = one.line.map((point) => { const at = place(point); return `${at.x.toFixed(1)} ${at.y.toFixed(1)}`; });
      if (path.length > 1)
        svg.append(makeSvg("path", {d: `M${path.join("L")}`, fill: "none", stroke: style.colour, "stroke-width": 1.8,
          "stroke-dasharray": style.dash, "stroke-linejoin": "round"}));
      one.points.forEach((point, i) => {
        const at = place(point);
        shown.push({...at, text: point.text, engine: one.engine});
        if (one.every === undefined || i % one.every === one.offset) svg.append(markOf(style, at.x, at.y, one.every ? 4 : 5));
      });
    }
  };
  hover(svg, () => shown);
  return {element, draw, empty: axisOf(all.map((p) => p.x), options.logX) === null ||
    axisOf(all.map((p) => p.y), options.logY) === null};
}

// What is nearest to the pointer, if near, is told beside it. With the keyboard the arrows go from mark to mark.
function hover(svg, points) {
  const tip = document.getElementById("tip");
  let chosen = -1;
  const tell = (best) => {
    svg.querySelector(".near")?.remove();
    tip.hidden = !best;
    if (!best) return;
    svg.append(makeSvg("circle", {class: "near", cx: best.x, cy: best.y, r: 9, fill: "none", stroke: "var(--ink)"}));
    tip.textContent = `${best.engine}\n${best.text}`;
    const box = svg.getBoundingClientRect(), size = tip.getBoundingClientRect(), scale = box.width / kWidth;
    const [x, y] = [box.x + best.x * scale, box.y + best.y * scale];
    tip.style.left = `${Math.max(6, Math.min(x + 12, innerWidth - size.width - 6))}px`;
    tip.style.top = `${y - size.height - 12 > 4 ? y - size.height - 12 : y + 16}px`;
  };
  const point = (event) => {
    const box = svg.getBoundingClientRect(), scale = box.width / kWidth;
    let best = null, least = Math.max(12, 22 / scale);
    for (const one of points()) {
      const distance = Math.hypot(one.x - (event.clientX - box.x) / scale, one.y - (event.clientY - box.y) / scale);
      if (distance < least) [best, least] = [one, distance];
    }
    tell(best);
  };
  svg.setAttribute("tabindex", "0");
  svg.addEventListener("pointermove", point);
  svg.addEventListener("pointerdown", point);
  svg.addEventListener("pointerleave", () => tell(null));
  svg.addEventListener("blur", () => tell(null));
  svg.addEventListener("keydown", (event) => {
    const way = {ArrowRight: 1, ArrowLeft: -1}[event.key], all = points();
    if (event.key === "Escape") tell(null);
    if (!way || all.length === 0) return;
    event.preventDefault();
    chosen = (chosen + way + all.length) % all.length;
    tell(all[chosen]);
  });
}

/// Bars with the middle half of the repetitions as whiskers, on a logarithmic scale.
function bars(options, rows, look) {
  const element = make("figure", {class: "chart", "data-chart": options.name},
    make("figcaption", {text: options.title + " "}, make("span", {text: options.note})));
  const scale = axisOf(rows.flatMap((row) => [row.low, row.value, row.high]), true);
  let svg = null;
  const draw = (hidden) => {
    const seen = rows.filter((row) => !hidden.has(row.engine));
    const height = 26 * seen.length + 24, left = kNarrow ? 124 : 130;
    const place = (value) => left + scale.place(value) * (kWidth - left - 70);
    svg?.remove();
    svg = makeSvg("svg", {viewBox: `0 0 ${kWidth} ${height}`, role: "img", "aria-label": options.title});
    for (const {at, text} of scale?.ticks ?? []) {
      const x = left + at * (kWidth - left - 70);
      svg.append(makeSvg("line", {class: "grid-line", x1: x, x2: x, y1: 0, y2: height - 20}),
        makeSvg("text", {x, y: height - 4, "text-anchor": "middle", text}));
    }
    seen.forEach((row, i) => {
      const y = 26 * i + 13, style = look.get(row.engine);
      svg.append(makeSvg("text", {x: left - 8, y: y + 4, "text-anchor": "end", text: row.engine}),
        makeSvg("line", {x1: place(row.low), x2: place(row.high), y1: y, y2: y, stroke: style.colour, "stroke-width": 3}),
        markOf(style, place(row.value), y),
        makeSvg("text", {x: Math.max(place(row.high), place(row.value)) + 10, y: y + 4, text: duration(row.value)}));
    });
    hover(svg, () => seen.map((row, i) => ({x: place(row.value), y: 26 * i + 13, text: row.text, engine: row.engine})));
    element.append(svg);
  };
  return {element, draw, empty: rows.length === 0};
}
