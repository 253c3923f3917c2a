import {bytes_of_base85} from "./base85.mjs";
import {Painter} from "./painter.mjs";
import {Panel} from "./panel.mjs";
import {Player} from "./player.mjs";
import {Theme} from "./theme.mjs";
import {follow_pointer} from "./pointer.mjs";

// The page contains the program in compressed form.
async function unpacked(text) {
  const stream = new Blob([bytes_of_base85(text.trim())]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// Returns the demo in the address: `#ragdoll`, `#pendulum_chain[5]`, whether or not its brackets are escaped.
function named_place() {
  const name = location.hash.slice(1);
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

const kWide = 700;  // pixels: on narrower windows the panel is at the lower edge

async function play() {
  // Sets the page's colours before the program is unpacked.
  const light = window.matchMedia("(prefers-color-scheme: light)");
  document.documentElement.classList.toggle("dark", !light.matches);
  const module = await WebAssembly.compile(await unpacked(document.getElementById("module").textContent));
  const player = await Player.start(module, named_place());
  const theme = new Theme(!light.matches);
  light.addEventListener("change", () => { theme.dark = !light.matches; });
  if (window.innerWidth <= kWide) player.panel = false;
  const panel = new Panel(player, theme);
  const stage = document.getElementById("stage");
  const context = stage.getContext("2d", {alpha: false});
  const painter = new Painter(context, player.camera, theme);
  follow_pointer(stage, player);

  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("select")) return;
    // Once something in the panel has the focus, Tab moves on through the panel.
    const free = document.activeElement === null || document.activeElement === document.body;
    if (!free && ["Tab", " ", "Enter", "Home"].includes(event.key)) return;
    if (event.shiftKey && event.key === "Tab") return;
    if (player.key(event.key)) event.preventDefault();
  });
  // The address contains the place, and a new address opens another place. It is written only if the place
  // changes, so that a name set by hand is not overwritten before it is read.
  let written = null;
  function write_place() {
    if (written === player.place) return;
    written = player.place;
    if (named_place() !== player.about.name) history.replaceState(null, "", `#${player.about.name}`);
  }
  window.addEventListener("hashchange", () => {
    const wanted = named_place(), place = player.demos.findIndex(({name}) => name === wanted);
    if (place >= 0) {
      if (place !== player.place) player.open(place);
    } else {
      player.message = `there is no demo or scenario '${wanted}'`;
    }
    written = place >= 0 ? place : null;
  });

  // Reads the sizes when they are needed, so that no event is needed when the panel folds or the phone is
  // turned.
  function fit() {
    const width = stage.clientWidth, height = stage.clientHeight, ratio = window.devicePixelRatio || 1;
    const rows = Math.round(height * ratio), columns = Math.round(width * ratio);
    if (stage.width !== columns || stage.height !== rows) stage.width = columns, stage.height = rows;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const box = document.getElementById("panel").getBoundingClientRect();
    const covered = {left: 0, right: 0, top: 0, bottom: 0};
    if (player.code_shown && width > kWide)
      covered.right = document.getElementById("code").getBoundingClientRect().width;
    if (width <= kWide) covered.bottom = box.height;
    else if (player.panel) covered.left = box.width;
    else covered.top = box.height;
    player.resize(width, height, covered);
    painter.scale_bar_x = width - covered.right - 20;
    painter.scale_bar_y = height - covered.bottom - 14;
    return {width, height};
  }

  let before = null;
  function frame(now) {
    const begin = performance.now();
    document.documentElement.classList.toggle("dark", theme.dark);
    if (before !== null) player.advance((now - before) / 1000);
    before = now;
    panel.update();
    const {width, height} = fit();
    painter.frame(width, height, player.drawing(), (bytes) => player.text(bytes));
    const took = performance.now() - begin;
    player.frame_ms += (player.frame_ms > 0 ? 0.1 : 1) * (took - player.frame_ms);
    write_place();
    requestAnimationFrame(frame);
  }
  requestAnimationFrame(frame);
  window.plumb = player;  // for the console
}

play().catch((error) => {
  document.getElementById("message").textContent =
    `This browser cannot run the demos (${error.message}): it needs WebAssembly with SIMD and DecompressionStream, ` +
    "as in Chrome 91, Firefox 113, Safari 16.4 and later.";
});
