// The demos and the engine, compiled to WebAssembly (exports.cpp lists the calls). Nothing here needs a page.

const kNoSystem = 52;  // WASI's ENOSYS

// The parts of WASI that are used: the clock. There are no files.
function system(memory) {
  const known = {
    clock_time_get(_clock, _precision, out) {
      const now = BigInt(Math.round(performance.now() * 1e6));
      new DataView(memory().buffer).setBigUint64(out, now, true);
      return 0;
    },
    proc_exit() {
      throw new Error("the program ended");
    },
  };
  return new Proxy(known, {get: (all, name) => all[name] ?? (() => kNoSystem)});
}

/// Names, values and choices are those of demos/core/demo.h. A call that throws ends the engine, because its
/// memory may be half changed; continue with a new engine and a saved state.
export class Engine {
  static async start(module) {
    const engine = new Engine();
    const fail = (sentence) => {
      throw new Error(engine.#c_text(sentence));
    };
    const wasi = system(() => engine.#memory);
    const imports = {plumb: {fail}, wasi_snapshot_preview1: {}};
    for (const {module: from, name} of WebAssembly.Module.imports(module))
      if (from === "wasi_snapshot_preview1") imports[from][name] = wasi[name];
    const instance = await WebAssembly.instantiate(module, imports);
    engine.#calls = instance.exports;
    engine.#memory = instance.exports.memory;
    engine.#calls._initialize();
    return engine;
  }

  #calls;
  #memory;
  #decoder = new TextDecoder();
  #encoder = new TextEncoder();

  list() { this.#calls.list(); return this.#json(); }
  open(name) { this.#calls.open(this.#give(this.#encoder.encode(name))); }
  /// Returns [{name, shown, remark}]: what can be drawn over a scenario.
  ghosts() { this.#calls.ghosts(); return this.#json(); }
  show_ghost(ghost, shown) { this.#calls.show_ghost(ghost, shown ? 1 : 0); }
  controls() { this.#calls.controls(); return this.#json(); }
  set(name, value) { this.#calls.set(this.#give(this.#encoder.encode(name)), value); }

  press(point) { this.#calls.press(point.x, point.y); }
  drag(point) { this.#calls.drag(point.x, point.y); }
  release(point) { this.#calls.release(point.x, point.y); }
  hover(point) { this.#calls.hover(point.x, point.y); }
  key(key) { this.#calls.key(key.charCodeAt(0)); }

  advance(seconds) { return this.#calls.advance(seconds); }
  step() { this.#calls.step(); }
  restart() { this.#calls.restart(); }
  time() { return this.#calls.time(); }
  figures() { this.#calls.figures(); return this.#json(); }
  view() { this.#calls.view(); return this.#json(); }
  /// 64 bits as 16 hexadecimal digits.
  hash() { return BigInt.asUintN(64, this.#calls.hash()).toString(16).padStart(16, "0"); }

  /// Return the C++ of the demo, and the present state as a scene (JSON).
  code() { this.#calls.code(); return this.#decoder.decode(this.#answer()); }
  scene() { this.#calls.scene(); return this.#decoder.decode(this.#answer()); }

  save() { this.#calls.save(); return this.#answer().slice(); }
  restore(state) { this.#calls.restore(this.#give(state)); }

  /// Returns the commands that command_buffer.h describes; valid until the next call.
  draw(shown, impulse_length, arrow_length) {
    const first = this.#calls.draw(shown, impulse_length, arrow_length);
    const numbers = new Float64Array(this.#memory.buffer, first, this.#calls.draw_size());
    return {numbers, words: this.#answer()};
  }

  // Memory may move whenever the program runs, so views are created anew each time.
  #give(bytes) {
    const place = this.#calls.argument(bytes.length);
    new Uint8Array(this.#memory.buffer, place, bytes.length).set(bytes);
    return bytes.length;
  }
  #answer() {
    return new Uint8Array(this.#memory.buffer, this.#calls.answer(), this.#calls.answer_size());
  }
  #json() { return JSON.parse(this.#decoder.decode(this.#answer())); }
  #c_text(place) {
    const bytes = new Uint8Array(this.#memory.buffer);
    return this.#decoder.decode(bytes.subarray(place, bytes.indexOf(0, place)));
  }
}
