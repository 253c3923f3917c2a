// Mouse, pen and fingers on the stage. One finger or the left button plays; two fingers, the right or the
// middle button, and the wheel move the picture.

const kPatience = 80;  // ms for which a finger waits for a second one before it presses
const kStill = 6;      // pixels by which a waiting finger may move

export function follow_pointer(stage, player) {
  const fingers = new Map();  // positions in pixels, by the pointer's number
  let playing = null;         // the pointer that is pressed
  let waiting = null;         // {pointer, start, timer}: a finger that may become the first of two
  let panning = null;         // {pointer, at}

  const pixel_of = (event) => ({x: event.offsetX, y: event.offsetY});
  const point_of = (pixel) => player.camera.to_world(pixel);
  const middle = ([a, b]) => ({x: (a.x + b.x) / 2, y: (a.y + b.y) / 2});
  const apart = ([a, b]) => Math.hypot(a.x - b.x, a.y - b.y);

  function press(pointer, pixel) {
    playing = pointer;
    player.press(point_of(pixel));
  }
  function press_waiting() {
    if (!waiting) return;
    clearTimeout(waiting.timer);
    const {pointer, start} = waiting;
    waiting = null;
    press(pointer, start);
  }

  function finger_down(event, pixel) {
    fingers.set(event.pointerId, pixel);
    if (fingers.size === 1) {
      waiting = {pointer: event.pointerId, start: pixel, timer: setTimeout(press_waiting, kPatience)};
    } else if (waiting) {
      clearTimeout(waiting.timer);
      waiting = null;
    } else if (playing !== null) {
      player.release(point_of(fingers.get(playing) ?? pixel));
      playing = null;
    }
  }

  function fingers_moved(event, pixel) {
    const before = [...fingers.values()].slice(0, 2);
    fingers.set(event.pointerId, pixel);
    const now = [...fingers.values()].slice(0, 2);
    if (now.length < 2) return;
    const from = middle(before), to = middle(now);
    player.pan(to.x - from.x, to.y - from.y);
    if (apart(before) > 0) player.zoom(to, apart(now) / apart(before));
  }

  stage.addEventListener("pointerdown", (event) => {
    const pixel = pixel_of(event);
    stage.setPointerCapture(event.pointerId);
    if (event.pointerType === "touch") {
      finger_down(event, pixel);
    } else if (event.button === 0) {
      press(event.pointerId, pixel);
    } else {
      panning = {pointer: event.pointerId, at: pixel};
    }
    event.preventDefault();
    document.activeElement?.blur();
  });

  stage.addEventListener("pointermove", (event) => {
    const pixel = pixel_of(event);
    if (waiting?.pointer === event.pointerId) {
      if (Math.hypot(pixel.x - waiting.start.x, pixel.y - waiting.start.y) > kStill) press_waiting();
    }
    if (fingers.has(event.pointerId)) fingers_moved(event, pixel);
    if (panning?.pointer === event.pointerId) {
      player.pan(pixel.x - panning.at.x, pixel.y - panning.at.y);
      panning.at = pixel;
    } else if (playing === event.pointerId) {
      player.drag(point_of(pixel));
    } else if (event.pointerType !== "touch") {
      player.hover(point_of(pixel));
    }
  });

  function up(event) {
    if (waiting?.pointer === event.pointerId) press_waiting();
    fingers.delete(event.pointerId);
    if (panning?.pointer === event.pointerId) panning = null;
    if (playing !== event.pointerId) return;
    playing = null;
    player.release(point_of(pixel_of(event)));
  }
  stage.addEventListener("pointerup", up);
  stage.addEventListener("pointercancel", up);
  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  stage.addEventListener("wheel", (event) => {
    const lines = event.deltaMode === 0 ? event.deltaY / 100 : event.deltaY / 3;
    player.zoom(pixel_of(event), 1.15 ** -Math.min(Math.max(lines, -5), 5));
    event.preventDefault();
  }, {passive: false});
}
