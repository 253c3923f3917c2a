// What hashes.cpp does, by the calls that the page makes: the lines that it prints.

function point(engine, across, up) {
  const [left, lower, right, upper] = engine.view();
  return {x: left + across * (right - left), y: lower + up * (upper - lower)};
}

function another({kind, value, low, high, whole}) {
  if (kind === "switch") return 1 - value;
  if (kind === "choice") return high;
  const between = low + 0.4 * (high - low);
  return whole ? Math.floor(between) : between;
}

function play(engine, keys, step) {
  if (step === 100) engine.press(point(engine, 0.5, 0.6));
  if (step > 100 && step < 160) engine.drag(point(engine, 0.5 + 0.005 * (step - 100), 0.6));
  if (step === 160) engine.release(point(engine, 0.8, 0.6));
  if (step === 200) engine.hover(point(engine, 0.3, 0.7));
  keys.forEach(({key}, i) => { if (step === 300 + 20 * i) engine.key(key); });
  if (step >= 500 && step % 10 === 0) {
    const control = engine.controls()[(step - 500) / 10];
    if (control) engine.set(control.name, another(control));
  }
  if (step === 700) engine.press(point(engine, 0.4, 0.5));
  if (step === 720) engine.release(point(engine, 0.2, 0.5));
}

export function hashes(engine) {
  const lines = [];
  for (const {kind, name, keys} of engine.list()) {
    engine.open(name);
    for (let step = 0; step < 1000; ++step) engine.step();
    lines.push(`${name} untouched 1000 ${engine.hash()}`);
    if (kind === "scene") continue;
    engine.open(name);
    for (let step = 0; step < 1000; ++step) {
      play(engine, keys, step);
      engine.step();
      if (step % 100 === 99) lines.push(`${name} played ${step + 1} ${engine.hash()}`);
    }
  }
  return lines;
}
