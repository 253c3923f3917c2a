// Charts by Chart.js: marks and lines over two axes, either of them logarithmic; what is under the pointer is told.

/// The colours of the page by name; `paper`: those of the light page.
function coloursOf(paper) {
  const probe = make("div", {class: paper ? "paper" : undefined});
  document.body.append(probe);
  const style = getComputedStyle(probe);
  const out = Object.fromEntries(["panel", "ink", "soft", "line", "grid"].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
  probe.remove();
  return out;
}

// What is drawn in the page's colours is drawn again when these change, and for the printer.
const kPainted = [];
function painted(paint) {
  kPainted.push(paint);
  paint(coloursOf(false));
}
const paintAll = (paper) => { const colours = coloursOf(paper); for (const paint of kPainted) paint(colours, paper); };
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => paintAll(false));
addEventListener("beforeprint", () => paintAll(true));
addEventListener("afterprint", () => paintAll(false));

const powerText = (power) => (power === 0 ? "1" : `10${raised(Math.round(power))}`);

/// Where a logarithmic axis has ticks, between two powers of ten: [{value, text}].
function logTicks(low, high) {
  const out = [];
  if (high - low < 2) {
    for (let power = Math.floor(low); power <= high; ++power)
      for (const lead of high - low < 1.2 ? [1, 2, 5] : [1, 3]) {
        const at = power + Math.log10(lead);
        const text = Math.abs(power) < 5 ? String(Number((lead * 10 ** power).toPrecision(1))) :
          lead === 1 ? powerText(power) : `${lead}\u00b7${powerText(power)}`;
        if (at >= low && at <= high) out.push({value: 10 ** at, text});
      }
    return out;
  }
  const step = Math.max(1, Math.ceil((high - low) / 7));
  for (let power = Math.ceil(low / step) * step; power <= high; power += step) out.push({value: 10 ** power, text: powerText(power)});
  return out;
}

/// An axis of Chart.js around the values. `say`: a logarithmic axis's ticks as text.
function axisOf(values, log, title, colours, say = null) {
  const text = {display: Boolean(title), text: title, color: colours.soft};
  const grid = {color: colours.grid, borderColor: colours.line, tickLength: 5};
  const ticks = {color: colours.soft, maxRotation: 0};
  if (!log) {
    const [min, max] = [Math.min(...values), Math.max(...values)];
    return {type: "linear", min, max, title: text, grid, ticks: {...ticks, includeBounds: false, maxTicksLimit: 8,
      callback: (value) => String(Number(value.toPrecision(6)))}};
  }
  let [low, high] = [Math.log10(Math.min(...values)), Math.log10(Math.max(...values))];
  if (high - low < 1) [low, high] = [(low + high) / 2 - 0.5, (low + high) / 2 + 0.5];
  const edge = 0.06 * (high - low), marks = logTicks(low - edge, high + edge);
  return {type: "logarithmic", min: 10 ** (low - edge), max: 10 ** (high + edge), title: text, grid,
    afterBuildTicks: (axis) => { axis.ticks = marks.map(({value}) => ({value})); },
    ticks: {...ticks, autoSkip: false, callback: (value, i) => (say ? say(value) : marks[i].text)}};
}

const tip = document.getElementById("tip");
let told = null;
const untell = () => { tip.hidden = true; told = null; };

/// Tells `text` about a part of `element`, which lies at (x, y) within it.
function tell(text, element, x, y) {
  tip.textContent = text;
  tip.hidden = false;
  told = {element, x, y};
  const box = element.getBoundingClientRect(), size = tip.getBoundingClientRect();
  const [left, top] = [box.x + x, box.y + y];
  tip.style.left = `${Math.max(6, Math.min(left + 12, innerWidth - size.width - 6))}px`;
  tip.style.top = `${top - size.height - 12 > 4 ? top - size.height - 12 : top + 16}px`;
}

// What the keyboard has gone to scrolls into view and is told there; the pointer stays behind.
addEventListener("scroll", () => {
  if (!told) return;
  document.activeElement === told.element ? tell(tip.textContent, told.element, told.x, told.y) : untell();
}, {passive: true, capture: true});

// Called by Chart.js when what is under the pointer changes.
function tellPoint({chart, tooltip}) {
  const point = tooltip.opacity ? tooltip.dataPoints?.[0] : null;
  if (!point) return untell();
  tell(`${point.raw.engine}\n${point.raw.text}`, chart.canvas, point.element.x, point.element.y);
}

// With the keyboard the arrows go from mark to mark.
function walk(chart) {
  let chosen = -1;
  const choose = (elements) => {
    if (!chart.canvas) return;  // taken away while it had the focus
    const point = elements.length ? chart.getDatasetMeta(elements[0].datasetIndex).data[elements[0].index] : {x: 0, y: 0};
    chart.setActiveElements(elements);
    chart.tooltip.setActiveElements(elements, {x: point.x, y: point.y});
    chart.update("none");
  };
  chart.canvas.addEventListener("keydown", (event) => {
    const way = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    if (event.key === "Escape") choose([]);
    if (!way) return;
    const all = chart.data.datasets.flatMap((set, datasetIndex) => (set.told ? set.data.map((_, index) => ({datasetIndex, index})) : []));
    if (all.length === 0) return;
    event.preventDefault();
    chosen = (chosen + way + all.length) % all.length;
    choose([all[chosen]]);
  });
  chart.canvas.addEventListener("blur", () => { chosen = -1; choose([]); });
}

// A canvas is there only while it is near the screen: phones have no memory for hundreds.
const kNear = new IntersectionObserver((entries) => {
  for (const {target, isIntersecting} of entries) target.comeNear(isIntersecting);
}, {rootMargin: "600px"});

/// A figure with a chart. `configure(hidden, colours)` gives what Chart.js draws, `inWords(hidden)` what it says.
/// Gives {element, draw(hidden)}.
function plot({name, title, note}, height, configure, inWords) {
  const box = make("div", {class: "plot"});
  const element = make("figure", {class: "chart", "data-chart": name}, make("figcaption", {text: `${title} `}, make("span", {text: note ?? ""})), box);
  let drawn = null, near = false, shown = new Set(), colours = null, ratio = 1;
  const drop = () => {
    drawn?.destroy();
    drawn = null;
    box.replaceChildren();
  };
  const show = () => {
    drop();
    const canvas = make("canvas", {role: "img", tabindex: 0, "aria-label": `${title}. ${inWords(shown)}`});
    box.style.height = `${height(shown)}px`;
    box.append(canvas);
    const {type, data, options} = configure(shown, colours);
    drawn = new Chart(canvas, {type, data, options: {...options, animation: false, maintainAspectRatio: false,
      devicePixelRatio: ratio, interaction: {mode: "nearest", intersect: true},
      font: {family: "system-ui, sans-serif"},
      plugins: {legend: {display: false}, tooltip: {enabled: false, external: tellPoint}}}});
    walk(drawn);
  };
  box.comeNear = (now) => {
    near = now;
    near ? show() : drop();
  };
  painted((now, paper) => {
    colours = now;
    ratio = paper ? 3 : Math.min(devicePixelRatio, 2);
    (paper ? box.offsetParent : near) ? show() : drop();
  });
  const draw = (hidden) => {
    shown = new Set(hidden);
    box.style.height = `${height(shown)}px`;
    if (drawn) show();
  };
  kNear.observe(box);
  return {element, draw};
}

// Points are in order and as the library would make them; those that are told are found near the pointer.
const kPlain = {parsing: false, normalized: true, hitRadius: 0};
const kTold = {told: true, hitRadius: 10};

/// How Chart.js draws an engine's marks.
const markStyle = (style, colours) => ({pointStyle: style.mark, rotation: style.turn, borderColor: style.colour,
  backgroundColor: style.filled ? style.colour : colours.panel, pointBorderWidth: 1.6, hoverRadius: 8, hoverBorderWidth: 2.5});

/// `series`: [{engine, points: [{x, y, text}], line: points, every, offset: which points have marks}].
/// `options`: {name, title, note, x, y, logX, logY}. Gives {element, draw(hidden), empty}.
function chart(options, series, look) {
  const drawable = (point) => Number.isFinite(point.x) && Number.isFinite(point.y) && (!options.logX || point.x > 0) && (!options.logY || point.y > 0);
  const all = series.map((one) => {
    const clean = (points) => points.filter(drawable).map((point) => ({...point, engine: one.engine})).sort((a, b) => a.x - b.x);
    const points = clean(one.points);
    const line = clean(one.line), onLine = new Set(line.map(({x, y}) => `${x} ${y}`));
    const marked = points.filter((_, i) => !one.every || i % one.every === one.offset);
    // What lies beside the line is small.
    return {...one, points, line, marked, radius: marked.map(({x, y}) => (one.every ? 4 : onLine.has(`${x} ${y}`) ? 5 : 3))};
  }).filter((one) => one.points.length > 0);
  const seen = (hidden) => all.filter((one) => !hidden.has(one.engine));
  const configure = (hidden, colours) => {
    const sets = seen(hidden).flatMap((one) => {
      const style = look.get(one.engine);
      const marks = {...kPlain, type: "scatter", engine: one.engine, data: one.marked, radius: one.radius, ...markStyle(style, colours)};
      const line = {...kPlain, type: "line", engine: one.engine, data: one.line, ...markStyle(style, colours), radius: 0,
        borderWidth: 1.8, borderDash: style.dash};
      // Where not every point has a mark, the line has them all.
      return one.every ? [marks, {...line, ...kTold}] : [{...marks, ...kTold}, line];
    });
    const points = (seen(hidden).length ? seen(hidden) : all).flatMap((one) => one.points);
    return {type: "scatter", data: {datasets: sets}, options: {scales: {
      x: axisOf(points.map((point) => point.x), options.logX, options.x, colours),
      y: axisOf(points.map((point) => point.y), options.logY, options.y, colours)}}};
  };
  const ends = ({engine, line, points}) => {
    const [from, to] = [(line.length ? line : points)[0], (line.length ? line : points).at(-1)];
    return `${engine}: ${figure(from.y)} at ${figure(from.x)}${from === to ? "" : ` to ${figure(to.y)} at ${figure(to.x)}`}`;
  };
  return {...plot(options, () => (kNarrow ? 280 : 300), configure,
    (hidden) => `${options.y} over ${options.x}. ${seen(hidden).map(ends).join("; ")}.`), empty: all.length === 0};
}

/// Marks with the middle half of the repetitions as bars, on a logarithmic scale. `rows`: [{engine, value, low, high, text}].
function bars(options, rows, look) {
  const seen = (hidden) => rows.filter((row) => !hidden.has(row.engine));
  const configure = (hidden, colours) => {
    const some = seen(hidden);
    const of = (style) => some.map((row) => style(look.get(row.engine)));
    const marks = {type: "line", told: true, showLine: false, indexAxis: "y", radius: 6, hitRadius: 12,
      data: some.map((row) => ({x: row.value, y: row.engine, text: row.text, engine: row.engine})), pointStyle: of((style) => style.mark),
      rotation: of((style) => style.turn), pointBorderColor: of((style) => style.colour), pointBorderWidth: 1.6, hoverRadius: 9,
      pointBackgroundColor: of((style) => (style.filled ? style.colour : colours.panel))};
    const spread = {type: "bar", indexAxis: "y", barThickness: 3, backgroundColor: of((style) => style.colour),
      data: some.map((row) => ({x: [row.low, row.high], y: row.engine, text: row.text, engine: row.engine}))};
    const labels = some.map((row) => row.engine);
    const names = {type: "category", labels, offset: true, grid: {display: false, borderColor: colours.line}};
    return {type: "bar", data: {labels, datasets: [marks, spread]}, options: {indexAxis: "y", scales: {
      x: axisOf((some.length ? some : rows).flatMap((row) => [row.low, row.value, row.high]), true, "", colours, duration),
      // Left to itself, the library gives no axis more than a quarter of the width.
      y: {...names, afterFit: (axis) => { axis.width = Math.max(...labels.map((name) => axis.ctx.measureText(name).width), 0) + 14; },
        ticks: {color: colours.soft, autoSkip: false}},
      told: {...names, axis: "y", position: "right", ticks: {color: colours.ink, autoSkip: false,
        callback: (_, i) => duration(some[i].value)}}}}};
  };
  return {...plot(options, (hidden) => 26 * seen(hidden).length + 40, configure,
    (hidden) => seen(hidden).map((row) => `${row.engine} ${duration(row.value)}`).join(", ")), empty: rows.length === 0};
}
