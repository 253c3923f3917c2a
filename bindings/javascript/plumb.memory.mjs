// The engine's program and its memory: calls that pass numbers through one buffer.
import {PlumbError} from "./plumb.definitions.mjs";
import packed from "./plumb.wasm.mjs";

async function unpack() {
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

const kKinds = ["SyntaxError", "InvalidValue", "UnknownName", "Unsupported", "RunError", "FileError"];
const kNoSystem = 52;  // WASI's ENOSYS: there are no files and no processes

/// Holds the functions that the engine calls back, for answers of the user; plumb.asking.mjs sets them.
export const answers = {preSolve: null, filter: null, condition: null};

const imports = {
  plumb: {
    fail(kind, ...parts) {
      throw new PlumbError(kKinds[kind] ?? "InternalError", ...parts.map(text));
    },
    pre_solve: () => answers.preSolve(),
    filter: () => answers.filter(),
    condition: (index, generation) => answers.condition(index >>> 0, generation >>> 0),
    shortest(value, to) {
      const text = encoder.encode(Number.isFinite(value) ? String(value) : Number.isNaN(value) ? "nan" : value < 0 ? "-inf" : "inf");
      put(Uint8Array, to, text);
      return text.length;
    },
  },
  wasi_snapshot_preview1: new Proxy({
    clock_time_get(_clock, _precision, out) {
      view(DataView, out, 8).setBigUint64(0, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
  }, {get: (all, name) => all[name] ?? (() => kNoSystem)}),
};
const module = await WebAssembly.compile(await unpack());
export const calls = (await WebAssembly.instantiate(module, {
  plumb: imports.plumb,
  wasi_snapshot_preview1: Object.fromEntries(WebAssembly.Module.imports(module)
    .filter((each) => each.module === "wasi_snapshot_preview1")
    .map(({name}) => [name, imports.wasi_snapshot_preview1[name]])),
})).exports;
calls._initialize();

/// Views `count` elements of the program's memory at `place`. Memory that grows in a call detaches all earlier views: place
/// and count are arguments here, so their calls are made before the buffer is read. Nothing else reads it.
export function view(Type, place, count) {
  return new Type(calls.memory.buffer, place, count);
}
/// Writes elements to `place`.
export function put(Type, place, elements) {
  view(Type, place, elements.length).set(elements);
}
/// Writes bytes where the next call looks for them.
export function putBytes(bytes) {
  put(Uint8Array, calls.bytes(bytes.length), bytes);
}

export const decoder = new TextDecoder(), encoder = new TextEncoder();
export function text(place) {
  const bytes = view(Uint8Array, 0);
  return decoder.decode(bytes.slice(place, bytes.indexOf(0, place)));
}

// A call that fails leaves the program by an exception: its stack is put back here.
function guarded(call) {
  const stack = calls.__stack_pointer.value;
  try {
    return call();
  } catch (error) {
    calls.__stack_pointer.value = stack;
    throw error;
  }
}
/// Calls the function `name` of the engine, after writing `input` where it is looked for.
export function call(name, args = [], input = null) {
  return guarded(() => {
    if (input !== null) put(Float64Array, calls.numbers(input.length), input);
    return calls[name](...args);
  });
}
/// The numbers that the last call left.
export function result(place) {
  return view(Float64Array, place, calls.number_count());
}
export function point(numbers, at = 0) {
  return {x: numbers[at], y: numbers[at + 1]};
}
export function box(numbers) {
  return {lower: point(numbers), upper: point(numbers, 2)};
}
