// State and actions of the player: time, keys, earlier states. Corresponds to the window's
// (demos/window/player.h).
import {Engine} from "./engine.mjs";
import {Camera} from "./camera.mjs";

const kSlow = 0.1;
const kSamples = 300;         // of a figure
const kCalm = 0.25;           // s, time constant of the camera's motion
const kMostBytes = 48 << 20;  // bytes of stored earlier states

/// Drawings besides shapes, in the order of the bits of `draw`.
export const kShown = ["contacts", "normals", "impulses", "boxes", "centres", "joints", "names",
  "velocities", "forces", "masses"];

/// The keys of the page, which work for every demo.
export const kCommands = [
  ["p", "P", "pause, go on"], ["o", "O", "one step"], ["b", "B", "one step back"], ["r", "R", "restart"],
  ["s", "S", "slow motion"], ["[", "[", "previous demo"], ["]", "]", "next demo"], ["Tab", "Tab", "this panel"],
  ["v", "V", "the code of the demo"], ["w", "W", "write this state as a scene (JSON)"],
  ["Home", "Home", "show everything"],
];

export class Player {
  paused = false;
  slow = false;
  panel = true;
  code_shown = false;
  frame_ms = 0;          // mean time that a frame takes for stepping and drawing
  shown = new Set(["joints"]);
  impulse_length = 0.1;  // m for 1 N s
  arrow_length = 1;      // relative to the usual length
  write_scene = () => {};  // set by the page: takes the name and the text
  camera = new Camera();
  message = "";
  series = [];   // figures over time: {name, unit, times, values}
  changes = 0;   // increases when the controls may have changed other than by the panel
  #module;
  #engine;       // null while a new one is being started
  #place = 0;
  #demos;
  #states = [];
  #bytes = 0;
  #pressed = false;
  #at_home = true;
  #covered = {left: 0, right: 0, top: 0, bottom: 0};
  #view = [0, 0, 1, 1];  // the part of the world that the camera shows while it follows
  #last = {time: 0, code: "", controls: [], ghosts: [], view: [0, 0, 1, 1], drawing: {numbers: new Float64Array(), words: new Uint8Array()}};

  static async start(module, name) {
    const player = new Player();
    player.#module = module;
    player.#engine = await Engine.start(module);
    player.#demos = player.#engine.list();
    player.open(Math.max(0, player.#demos.findIndex((demo) => demo.name === name)));
    return player;
  }

  get demos() { return this.#demos; }
  get place() { return this.#place; }
  get about() { return this.#demos[this.#place]; }
  get remembered() { return this.#states.length - 1; }

  // While there is no engine, the following return the last answer.
  get time() { return this.#ask("time", (engine) => engine.time()); }
  get controls() { return this.#ask("controls", (engine) => engine.controls()); }
  /// Returns the C++ of the demo, or the scene that is open.
  get code() {
    return this.#ask("code", (engine) => (engine.code() || engine.scene()));
  }
  get ghosts() { return this.#ask("ghosts", (engine) => engine.ghosts()); }
  hash() { return this.#engine.hash(); }
  text(bytes) { return new TextDecoder().decode(bytes); }
  drawing() {
    const bits = kShown.reduce((bits, name, i) => bits | (this.shown.has(name) ? 1 << i : 0), 0);
    return this.#ask("drawing", (engine) => engine.draw(bits, this.impulse_length, this.arrow_length));
  }
  #ask(what, question) {
    this.#guarded((engine) => { this.#last[what] = question(engine); });
    return this.#last[what];
  }

  open(place) {
    this.#place = place;
    this.#pressed = false;
    this.message = "";
    this.#forget();
    this.#guarded((engine) => {
      engine.open(this.about.name);
      this.#remember();
    });
    this.home();
    ++this.changes;
  }

  /// Shows or hides an outline over a scenario, and the plot of its error.
  show_ghost(ghost, shown) {
    this.#guarded((engine) => {
      engine.show_ghost(ghost, shown);
      const {name, shown: there} = engine.ghosts()[ghost];
      if (!there) this.series = this.series.filter((series) => series.name !== `${name} error`);
    });
    ++this.changes;
  }
  set(control, value) { this.#guarded((engine) => engine.set(control, value)); }

  press(point) {
    if (this.#pressed) return;
    this.#pressed = true;
    this.#guarded((engine) => engine.press(point));
  }
  drag(point) { if (this.#pressed) this.#guarded((engine) => engine.drag(point)); }
  release(point) {
    if (!this.#pressed) return;
    this.#pressed = false;
    this.#guarded((engine) => engine.release(point));
  }
  hover(point) { this.#guarded((engine) => engine.hover(point)); }

  /// Handles a key by its name: a key of the page, or else of the demo. Returns true if it was one.
  key(name) {
    const lower = name.length === 1 ? name.toLowerCase() : name;
    const count = this.#demos.length;
    switch (lower) {
      case "p": this.paused = !this.paused; return true;
      case "o": this.step(); return true;
      case "b": this.back(); return true;
      case "r": this.restart(); return true;
      case "s": this.slow = !this.slow; return true;
      case "[": this.open((this.#place + count - 1) % count); return true;
      case "]": this.open((this.#place + 1) % count); return true;
      case "Tab": this.panel = !this.panel; return true;
      case "v": this.code_shown = !this.code_shown; return true;
      case "w": this.#guarded((engine) => this.write_scene(this.about.name, engine.scene())); return true;
      case "Home": this.home(); return true;
    }
    if (!this.about.keys.some((key) => key.key === lower)) return false;
    this.#guarded((engine) => engine.key(lower));
    ++this.changes;
    return true;
  }

  /// Lets real seconds pass.
  advance(seconds) {
    if (this.paused) return;
    this.#guarded((engine) => {
      if (engine.advance(this.slow ? kSlow * seconds : seconds) > 0) this.#remember();
    });
    this.#follow(seconds);
  }
  step() {
    this.paused = true;
    this.#guarded((engine) => {
      engine.step();
      this.#remember();
    });
  }
  back() {
    this.paused = true;
    if (this.#states.length < 2) {
      this.message = "no earlier state is remembered";
      return;
    }
    this.#pressed = false;
    this.#bytes -= this.#states.pop().length;
    this.#guarded((engine) => {
      engine.restore(this.#states.at(-1));
      this.#sample(engine);
    });
    ++this.changes;
  }
  restart() {
    this.#pressed = false;
    this.message = "";
    this.#guarded((engine) => {
      engine.restart();
      this.#forget();
      this.#remember();
    });
  }

  /// Sets the size of the picture, and how much of it is covered at its edges.
  resize(width, height, covered) {
    this.camera.resize(width, height);
    this.#covered = covered;
    if (this.#at_home) this.camera.fit(this.#view, covered);
  }
  home() {
    this.#view = this.#ask("view", (engine) => engine.view());
    this.camera.fit(this.#view, this.#covered);
    this.#at_home = true;
  }
  // Follows like the window's camera: the picture stays fixed under a pressed pointer, and a jump of a body
  // does not make it jump.
  #follow(seconds) {
    if (!this.#at_home || this.#pressed) return;
    const share = 1 - Math.exp(-seconds / kCalm), wanted = this.#ask("view", (engine) => engine.view());
    this.#view = this.#view.map((edge, i) => edge + share * (wanted[i] - edge));
    this.camera.fit(this.#view, this.#covered);
  }
  zoom(pixel, factor) {
    this.camera.zoom(pixel, factor);
    this.#at_home = false;
  }
  pan(x, y) {
    this.camera.pan(x, y);
    this.#at_home = false;
  }

  #forget() {
    this.#states = [];
    this.#bytes = 0;
    this.series = [];
  }
  #remember() {
    const state = this.#engine.save();
    this.#states.push(state);
    this.#bytes += state.length;
    while (this.#bytes > kMostBytes && this.#states.length > 2) this.#bytes -= this.#states.shift().length;
    this.#sample(this.#engine);
  }
  #sample(engine) {
    const time = engine.time();
    for (const {name, unit, value} of engine.figures()) {
      let series = this.series.find((each) => each.name === name);
      if (!series) this.series.push(series = {name, unit, times: [], values: []});
      // When time goes back, later samples are removed.
      while (series.times.length > 0 && series.times.at(-1) >= time) series.times.pop(), series.values.pop();
      series.times.push(time), series.values.push(value);
      if (series.times.length > kSamples) series.times.shift(), series.values.shift();
    }
  }

  // An engine that throws has ended: the message is shown, and a new one continues from the last state.
  #guarded(act) {
    const engine = this.#engine;
    if (!engine) return;
    try {
      act(engine);
    } catch (error) {
      this.message = error.message;
      this.paused = true;
      this.#pressed = false;
      this.#engine = null;
      this.#revive();
    }
  }
  async #revive() {
    const engine = await Engine.start(this.#module);
    engine.open(this.about.name);
    const state = this.#states.at(-1);
    if (state) engine.restore(state);
    this.#engine = engine;
    ++this.changes;
  }
}
