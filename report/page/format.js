// Numbers and elements as text.
const kNarrow = Math.min(innerWidth, screen.width) < 600;
const kSvg = "http://www.w3.org/2000/svg";

/// An element; `attributes` may have "text", and functions are listeners.
function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  return fill(element, attributes, children);
}
function makeSvg(name, attributes = {}, ...children) {
  return fill(document.createElementNS(kSvg, name), attributes, children);
}
function fill(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key === "text") element.textContent = value;
    else if (typeof value === "function") element.addEventListener(key, value);
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const kRaised = {"-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075",
  6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079"};
const raised = (power) => [...String(power)].map((c) => kRaised[c]).join("");

/// Three digits, powers of ten where they are shorter.
function figure(value) {
  if (value === null || value === undefined) return "\u2013";
  if (value === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(value)));
  if (power >= -3 && power < 5) return String(Number(value.toPrecision(3)));
  const digits = value.toExponential(1).split("e")[0];
  return `${digits}\u00b710${raised(power)}`;
}
/// Four digits: one more than is asked of a threshold.
function figure4(value) {
  const power = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
  return power >= -3 && power < 6 ? String(Number(value.toPrecision(4))) : `${Number((value / 10 ** power).toPrecision(4))}\u00b710${raised(power)}`;
}
/// A share with its sign.
function percent(share) {
  if (share === null || share === undefined) return "\u2013";
  const size = Math.abs(100 * share);
  return `${share < 0 ? "\u2212" : "+"}${size < 1e-3 && size > 0 ? figure(size) : String(Number(size.toPrecision(2)))} %`;
}
const withUnit = (value, unit) => (unit ? `${figure(value)} ${unit}` : figure(value));

/// A time in ns, for people.
function duration(ns) {
  if (ns === null || ns === undefined) return "\u2013";
  for (const [size, unit] of [[1e9, "s"], [1e6, "ms"], [1e3, "\u00b5s"]])
    if (ns >= size) return `${Number((ns / size).toPrecision(3))} ${unit}`;
  return `${Number(ns.toPrecision(3))} ns`;
}
const times = (ratio) => (ratio === null || ratio === undefined ? "\u2013" : `${figure(ratio)} \u00d7`);
/// dt as a share of a second where it is one: 1/60.
function stepText(dt) {
  const rate = 1 / dt;
  return Math.abs(rate - Math.round(rate)) < 1e-6 * rate && rate > 1.5 ? `1/${Math.round(rate)}` : String(dt);
}
const words = (name) => name.replaceAll("_", " ");
