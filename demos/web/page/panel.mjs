// The panel: what can be opened, set and drawn, and what is measured.
import {kCommands, kShown} from "./player.mjs";

const kPlot = {width: 64, height: 20};  // pixels
const kSliderStops = 1000;

const the = (id) => document.getElementById(id);

function made(kind, properties = {}, ...inside) {
  const element = Object.assign(document.createElement(kind), properties);
  element.append(...inside);
  return element;
}

const number = (value) => (value === null ? "-" : Number(value.toPrecision(4)).toString());

function control_number({value, low, high, whole}) {
  if (whole) return value.toFixed(0);
  return high - low < 0.2 ? value.toFixed(4) : number(Number(value.toPrecision(3)));
}

export class Panel {
  #player;
  #theme;
  #opened = null;  // what the lists were built for
  #coded = null;   // what the code belongs to
  #changes = -1;
  #updates = [];   // by control: function that takes its new value
  #plots = [];

  constructor(player, theme) {
    this.#player = player;
    this.#theme = theme;
    const options = (wanted) => player.demos.filter(({kind}) => kind === wanted)
      .map(({name, summary}) => made("option", {textContent: name, title: summary}));
    the("list").append(made("optgroup", {label: "demos"}, ...options("demo")),
                       made("optgroup", {label: "scenarios"}, ...options("scene")));
    the("list").onchange = () => player.open(the("list").selectedIndex);
    for (const [id, key] of [["restart", "r"], ["back", "b"], ["pause", "p"], ["step", "o"], ["fold", "Tab"]])
      the(id).onclick = () => player.key(key);
    the("slow").onchange = () => { player.slow = the("slow").checked; };
    this.#list_shown();
    // After a click in the panel, keys go to the demo again.
    the("panel").addEventListener("click", (event) => {
      if (event.detail > 0 && event.target.matches("button, input[type=checkbox]")) event.target.blur();
    });
    the("panel").addEventListener("change", (event) => {
      if (event.target.matches("select")) event.target.blur();
    });
  }

  /// Shows how things are now.
  update() {
    const player = this.#player;
    if (this.#opened !== player.place) this.#open();
    if (this.#changes !== player.changes) {
      this.#changes = player.changes;
      player.controls.forEach((control, i) => this.#updates[i](control));
      this.#show_ghosts();
    }
    document.body.classList.toggle("folded", !player.panel);
    the("fold").setAttribute("aria-expanded", player.panel);
    the("pause").textContent = player.paused ? "go on" : "pause";
    the("slow").checked = player.slow;
    the("clock").textContent = `t = ${player.time.toFixed(2)} s`;
    if (player.panel) the("frame").textContent = `time of a frame: ${player.frame_ms.toFixed(1)} ms`;
    the("code").hidden = !player.code_shown;
    if (player.code_shown && this.#coded !== player.place) {
      this.#coded = player.place;
      the("code").textContent = player.code;
      the("code").scrollTop = 0;
    }
    const message = player.paused ? `paused${player.message && `: ${player.message}`}` : player.message;
    if (the("message").textContent !== message) the("message").textContent = message;
    if (player.panel) this.#draw_figures();
  }

  #open() {
    const player = this.#player;
    this.#opened = player.place;
    the("list").selectedIndex = player.place;
    the("play").textContent = player.about.play;
    the("actions").replaceChildren(...player.about.keys.map(({key, about}) =>
      made("button", {textContent: about, title: key === " " ? "space" : key, onclick: () => player.key(key)})));
    the("controls").replaceChildren(...player.controls.map((control, i) => this.#control(control, i)));
    the("figures").replaceChildren();
    this.#plots = [];
    const keys = [...player.about.keys.map(({key, about}) => [key === " " ? "space" : key, about]),
                  ...kCommands.map(([, label, about]) => [label, about]),
                  ["wheel, two fingers", "zoom"], ["right drag, two fingers", "move the picture"]];
    the("keys").replaceChildren(...keys.flatMap(([key, about]) =>
      [made("dt", {textContent: key}), made("dd", {textContent: about})]));
  }

  // Lists the truth and other engines, with their source or the reason why they are missing.
  #show_ghosts() {
    const player = this.#player;
    const remarks = [];
    const labels = player.ghosts.map(({name, shown, remark}, i) => {
      const box = made("input", {type: "checkbox", checked: shown !== 0, onchange: () => player.show_ghost(i, box.checked)});
      const label = made("label", {title: remark}, box, made("span", {className: "ghost", textContent: name}));
      label.lastChild.style.borderBottomColor = this.#theme.ghost(i);
      // Settings are shown in the tooltip; a reason, and the source of the truth, are shown as text.
      if (remark && (shown === 0 || i === 0)) remarks.push(made("p", {className: "unit", textContent: `${name}: ${remark}`}));
      return label;
    });
    the("ghosts").replaceChildren(...(labels.length > 0 ? [made("div", {className: "row"}, ...labels)] : []), ...remarks);
  }

  #control(control, i) {
    const set = (value) => this.#player.set(control.name, value);
    const unit = made("span", {className: "unit", textContent: control.unit && ` ${control.unit}`});
    if (control.kind === "switch") {
      const box = made("input", {type: "checkbox", onchange: () => set(box.checked ? 1 : 0)});
      this.#updates[i] = ({value}) => { box.checked = value !== 0; };
      return made("div", {className: "control", title: control.about}, made("label", {}, box, control.name));
    }
    if (control.kind === "choice") {
      const list = made("select", {onchange: () => set(list.selectedIndex)},
        ...control.choices.map((choice) => made("option", {textContent: choice})));
      list.setAttribute("aria-label", control.name);
      this.#updates[i] = ({value}) => { list.selectedIndex = value; };
      return made("div", {className: "control", title: control.about}, made("span", {}, control.name), list);
    }
    // A slider of HTML has stops counted from its lower end. This one has its own stops, so that both ends
    // are reached exactly.
    const {low, high, whole} = control;
    const stops = whole ? high - low : kSliderStops;
    const shown = made("output");
    const slider = made("input", {type: "range", min: 0, max: stops, step: 1, oninput() {
      const at = Number(slider.value);
      const value = at === stops ? high : whole ? low + at : Number((low + (high - low) * at / stops).toPrecision(6));
      shown.textContent = control_number({...control, value});
      set(Math.min(Math.max(value, low), high));
    }});
    slider.setAttribute("aria-label", control.name);
    this.#updates[i] = (now) => {
      slider.value = Math.round((now.value - low) / (high - low) * stops);
      shown.textContent = control_number(now);
    };
    return made("div", {className: "control", title: control.about},
      made("span", {}, control.name), made("span", {}, shown, unit), slider);
  }

  #list_shown() {
    const box = (name, checked, change) => {
      const input = made("input", {type: "checkbox", checked, onchange: () => change(input.checked)});
      return made("label", {}, input, name);
    };
    const player = this.#player, theme = this.#theme;
    const impulse = made("input", {type: "range", min: -3, max: 1, step: 0.01, value: Math.log10(player.impulse_length),
      oninput: () => { player.impulse_length = 10 ** impulse.value; }});
    const length = made("label", {className: "wide", hidden: true}, "impulses' length", impulse);
    const arrow = made("input", {type: "range", min: -1, max: 1, step: 0.01, value: 0,
      oninput: () => { player.arrow_length = 10 ** arrow.value; }});
    const arrows = made("label", {className: "wide", hidden: true}, "arrows' length", arrow);
    player.write_scene = save_scene;
    the("shown").append(
      ...kShown.map((name) => box(name, player.shown.has(name), (on) => {
        player.shown[on ? "add" : "delete"](name);
        if (name === "impulses") length.hidden = !on;
        arrows.hidden = !player.shown.has("velocities") && !player.shown.has("forces");
      })),
      box("sleep", theme.sleep_shows, (on) => { theme.sleep_shows = on; }),
      box("dark", theme.dark, (on) => { theme.dark = on; }),
      length, arrows,
      made("button", {textContent: "code", title: "the code of the demo (V)", onclick: () => player.key("v")}),
      made("button", {textContent: "scene", title: "this state as a scene, JSON (W)", onclick: () => player.key("w")}),
      made("button", {textContent: "picture", title: "this frame as a PNG file", onclick: () => save_picture(player)}));
  }

  #draw_figures() {
    const series_shown = this.#player.series;
    this.#plots = this.#plots.filter((plot) => {
      const there = series_shown.some(({name}) => name === plot.name);
      if (!there) plot.row.remove();
      return there;
    });
    for (const series of series_shown) {
      if (series.name === "time") continue;  // shown at the top
      let plot = this.#plots.find((each) => each.name === series.name);
      if (!plot) this.#plots.push(plot = this.#new_plot(series));
      plot.value.textContent = `${number(series.values.at(-1))} ${series.unit}`;
      draw_plot(plot.canvas, series.values, this.#theme.plot);
    }
  }

  #new_plot({name}) {
    const canvas = made("canvas"), value = made("output");
    const row = made("div", {className: "figure", title: name}, canvas, made("span", {textContent: name}), value);
    the("figures").append(row);
    return {name, canvas, value, row};
  }
}

function draw_plot(canvas, values, colour) {
  const ratio = window.devicePixelRatio || 1, {width, height} = kPlot;
  if (canvas.width !== Math.round(width * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  const known = values.filter((value) => value !== null);
  const low = Math.min(...known), range = Math.max(...known) - low;
  context.beginPath();
  values.forEach((value, i) => {
    if (value === null) return;
    const x = 1 + (width - 2) * i / Math.max(values.length - 1, 1);
    context.lineTo(x, range > 0 ? height - 2 - (height - 4) * (value - low) / range : height / 2);
  });
  context.strokeStyle = colour;
  context.lineWidth = 1.2;
  context.stroke();
}

function save(name, blob) {
  const link = made("a", {href: URL.createObjectURL(blob), download: name});
  link.click();
  URL.revokeObjectURL(link.href);
}

function save_picture(player) {
  the("stage").toBlob((picture) => save(`${player.about.name}.png`, picture));
}

function save_scene(name, text) {
  save(`${name}.json`, new Blob([text], {type: "application/json"}));
}
