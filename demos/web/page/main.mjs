import {Painter} from "./painter.mjs";
import {Panel} from "./panel.mjs";
import {Player} from "./player.mjs";
import {Theme} from "./theme.mjs";
import {follow_pointer} from "./pointer.mjs";

// The program lies in the page, compressed.
async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

const kWide = 700;  // pixels: on less the panel lies at the lower edge

async function play() {
  const module = await WebAssembly.compile(await unpacked(document.getElementById("module").textContent));
  const player = await Player.start(module, decodeURIComponent(location.hash.slice(1)));
  const light = window.matchMedia("(prefers-color-scheme: light)");
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
    // Tab walks on through the panel once something there has the focus.
    const free = document.activeElement === null || document.activeElement === document.body;
    if (!free && ["Tab", " ", "Enter", "Home"].includes(event.key)) return;
    if (event.shiftKey && event.key === "Tab") return;
    if (player.key(event.key)) event.preventDefault();
  });
  window.addEventListener("hashchange", () => {
    const place = player.demos.findIndex(({name}) => name === decodeURIComponent(location.hash.slice(1)));
    if (place >= 0 && place !== player.place) player.open(place);
  });

  // Sizes are read where they are: nothing has to be told when the panel folds or the phone turns.
  function fit() {
    const width = stage.clientWidth, height = stage.clientHeight, ratio = window.devicePixelRatio || 1;
    const rows = Math.round(height * ratio), columns = Math.round(width * ratio);
    if (stage.width !== columns || stage.height !== rows) stage.width = columns, stage.height = rows;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const box = document.getElementById("panel").getBoundingClientRect();
    const covered = {left: 0, top: 0, bottom: 0};
    if (width <= kWide) covered.bottom = box.height;
    else if (player.panel) covered.left = box.width;
    else covered.top = box.height;
    player.resize(width, height, covered);
    painter.scale_bar_y = height - covered.bottom - 14;
    return {width, height};
  }

  let before = null;
  function frame(now) {
    document.documentElement.classList.toggle("dark", theme.dark);
    if (before !== null) player.advance((now - before) / 1000);
    before = now;
    panel.update();
    const {width, height} = fit();
    painter.frame(width, height, player.drawing(), (bytes) => player.text(bytes));
    if (location.hash.slice(1) !== player.about.name) history.replaceState(null, "", `#${player.about.name}`);
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
