// The motion, played: the truth as filled shapes, the engines' runs as outlines over it.

// The poses at `time`, along straight lines between frames.
function poseAt(motion, time) {
  const {times, poses} = motion;
  let i = Math.min(times.length - 2, Math.max(0, Math.floor(time / (times[1] - times[0] || 1))));
  while (i > 0 && times[i] > time) --i;
  while (i < times.length - 2 && times[i + 1] <= time) ++i;
  if (times.length < 2 || i < 0) return poses[0];
  const share = Math.min(1, Math.max(0, (time - times[i]) / (times[i + 1] - times[i])));
  return poses[i].map((from, k) => (from === null || poses[i + 1][k] === null ? NaN : from + share * (poses[i + 1][k] - from)));
}

/// `motions`: Map from an engine to {times, poses}; `truth` likewise or null. Gives {element, draw(hidden)}.
function replay(scene, length, truth, motions, look) {
  const view = viewOf(scene, truth ? truth.poses : [...motions.values()].flatMap((motion) => motion.poses));
  const stage = picture(scene, view, "the motion");
  const layers = [];
  if (truth) layers.push({motion: truth, ...stage.add({stroke: "var(--soft)", fill: "var(--shape)", links: true})});
  for (const [engine, motion] of motions) {
    const style = look.get(engine);
    layers.push({engine, motion, ...stage.add({stroke: style.colour, dash: style.dash, width: 1.8})});
  }
  let time = 0, playing = false, last = 0;
  const show = () => {
    for (const {motion, pose} of layers) pose(poseAt(motion, time));
    scrub.value = time;
    clock.textContent = `${time.toFixed(2)} s`;
  };
  const frame = (now) => {
    if (!playing || !stage.svg.isConnected) return;
    time += Math.min(0.1, (now - last) / 1000) * Number(speed.value);
    last = now;
    if (time >= length) { time = length; play(false); }
    show();
    requestAnimationFrame(frame);
  };
  const play = (start) => {
    playing = start;
    button.textContent = playing ? "Pause" : "Play";
    if (!playing) return;
    if (time >= length) time = 0;
    last = performance.now();
    requestAnimationFrame(frame);
  };
  const button = make("button", {type: "button", class: "play", text: "Play", click: () => play(!playing)});
  const scrub = make("input", {type: "range", class: "scrub", min: 0, max: length, step: length / 1000, value: 0,
    "aria-label": "time", input: () => { play(false); time = Number(scrub.value); show(); }});
  const speed = make("select", {class: "speed", "aria-label": "speed"},
    ...[0.05, 0.1, 0.25, 0.5, 1, 2, 5].map((rate) => make("option", {value: rate, text: `${rate} \u00d7`})));
  speed.value = "1";
  const clock = make("output");
  const note = motions.size === 0 ? "the truth" : truth ? "filled: the truth; outlines: the engines" : "outlines: the engines";
  const element = make("figure", {"data-chart": "replay"}, make("figcaption", {text: "Replay "}, make("span", {text: note})),
    stage.svg, make("div", {class: "player"}, button, scrub, clock, speed));
  show();
  const draw = (hidden) => {
    for (const {engine, layer} of layers) if (engine) layer.setAttribute("visibility", hidden.has(engine) ? "hidden" : "visible");
  };
  return {element, draw};
}
