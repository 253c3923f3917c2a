// Paints the drawing of a demo (the commands of command_buffer.h) on a canvas.

const kPoint = 3;      // pixels, radius of a point
const kGridStep = 70;  // pixels, least distance between grid lines
const kLine = 15;      // pixels, height of a label

// Returns 1, 2 or 5 times a power of ten: the smallest such number that is at least `least`.
function round_step(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= least * (1 - 1e-9));
}

export class Painter {
  #context;
  #camera;
  #theme;

  constructor(context, camera, theme) {
    this.#context = context;
    this.#camera = camera;
    this.#theme = theme;
  }

  /// Paints everything on a canvas of `width` by `height` pixels of CSS. `decode` converts bytes to a text.
  frame(width, height, {numbers, words}, decode) {
    const context = this.#context;
    context.fillStyle = this.#theme.ground;
    context.fillRect(0, 0, width, height);
    context.lineJoin = context.lineCap = "round";
    this.#grid(width, height);
    const labels = [];
    for (let at = 0; at < numbers.length;) {
      const role = numbers[at + 1], n = numbers.subarray(at + 2);
      switch (numbers[at]) {
        case 0: {
          const corners = [];
          for (let i = 0; i < n[1]; ++i) corners.push([n[2 + 2 * i], n[3 + 2 * i]]);
          this.#shape(corners, n[0], role);
          at += 4 + 2 * n[1];
          break;
        }
        case 1: this.#circle(n[0], n[1], n[2], n[3], n[4], role); at += 7; break;
        case 2:
          if (n[4] > 0) this.#shape([[n[0], n[1]], [n[2], n[3]]], n[4], role);
          else this.#segment(n[0], n[1], n[2], n[3], role);
          at += 7;
          break;
        case 3: this.#segment(n[0], n[1], n[2], n[3], role); at += 6; break;
        case 4: this.#point(n[0], n[1], role); at += 4; break;
        case 5:
          labels.push({at: this.#camera.to_pixel(n[0], n[1]), role,
                       text: decode(words.subarray(n[2], n[2] + n[3]))});
          at += 6;
          break;
        default: throw new Error(`no command ${numbers[at]}`);
      }
    }
    this.#scale_bar(width, height);
    this.#labels(labels, width, height);
  }

  // Returns the texts that do not overlap. In their order, each is placed above its point, else below it,
  // else left out; it is moved sideways if the edge would cut it. Texts have an outline in the background's
  // colour, so that they are readable over any body.
  #labels(labels, width, height) {
    const context = this.#context;
    context.font = "13px system-ui, sans-serif";
    context.textAlign = "left";
    context.strokeStyle = this.#theme.ground;
    context.lineWidth = 3;
    const taken = new Map();  // one list per line of a text's height; a text reaches into two of them
    for (const {at, role, text} of labels) {
      if (!(at.x >= 0 && at.x <= width && at.y >= 0 && at.y <= height)) continue;
      const wide = context.measureText(text).width;
      const left = Math.max(Math.min(at.x - wide / 2, width - wide), 0), right = left + wide;
      for (const base of [at.y - 5, at.y - 5 + kLine]) {
        const line = Math.floor(base / kLine), lines = [line, line + 1].map((key) => taken.get(key) ?? []);
        if (lines.some((line) => line.some((other) => left < other.right && right > other.left &&
            Math.abs(base - other.base) < kLine))) continue;
        [line, line + 1].forEach((key, i) => taken.set(key, [...lines[i], {left, right, base}]));
        context.strokeText(text, left, base);
        context.fillStyle = this.#theme.style(role).line;
        context.fillText(text, left, base);
        break;
      }
    }
  }

  // Fills all points within `radius` m of the convex hull of corners, which are counter-clockwise: an arc
  // about each corner.
  #shape(corners, radius, role) {
    const context = this.#context, r = radius * this.#camera.scale, count = corners.length;
    context.beginPath();
    // Returns the direction, as an angle of the canvas, of the outward normal of the edge after a corner.
    const facing = (i) => {
      const [ax, ay] = corners[i % count], [bx, by] = corners[(i + 1) % count];
      return Math.atan2(bx - ax, by - ay);
    };
    for (let i = 0; i < count; ++i) {
      const {x, y} = this.#camera.to_pixel(...corners[i]);
      if (r > 0) context.arc(x, y, r, facing(i + count - 1), facing(i), true);
      else context.lineTo(x, y);
    }
    context.closePath();
    this.#fill_and_stroke(role);
  }

  #circle(x, y, radius, axis_x, axis_y, role) {
    const context = this.#context, r = radius * this.#camera.scale, centre = this.#camera.to_pixel(x, y);
    context.beginPath();
    context.arc(centre.x, centre.y, r, 0, 2 * Math.PI);
    this.#fill_and_stroke(role);
    // What spins shows it.
    if (r > kPoint) this.#segment(x, y, x + radius * axis_x, y + radius * axis_y, role);
  }

  #fill_and_stroke(role) {
    const style = this.#theme.style(role), context = this.#context;
    if (style.fill) {
      context.fillStyle = style.fill;
      context.fill();
    }
    context.strokeStyle = style.line;
    context.lineWidth = style.width;
    context.stroke();
  }

  #segment(ax, ay, bx, by, role) {
    const context = this.#context, style = this.#theme.style(role);
    const a = this.#camera.to_pixel(ax, ay), b = this.#camera.to_pixel(bx, by);
    context.strokeStyle = style.line;
    context.lineWidth = style.width;
    this.#line(a.x, a.y, b.x, b.y);
  }

  #point(x, y, role) {
    const context = this.#context, at = this.#camera.to_pixel(x, y);
    context.fillStyle = this.#theme.style(role).line;
    context.beginPath();
    context.arc(at.x, at.y, kPoint, 0, 2 * Math.PI);
    context.fill();
  }

  #line(ax, ay, bx, by) {
    this.#context.beginPath();
    this.#context.moveTo(ax, ay);
    this.#context.lineTo(bx, by);
    this.#context.stroke();
  }

  // Draws lines at a spacing of a round number of metres.
  #grid(width, height) {
    const context = this.#context, camera = this.#camera, step = round_step(kGridStep / camera.scale);
    const lower = camera.to_world({x: 0, y: height}), upper = camera.to_world({x: width, y: 0});
    const sharp = (pixel) => Math.floor(pixel) + 0.5;
    context.strokeStyle = this.#theme.grid;
    for (let i = Math.ceil(lower.x / step); i * step <= upper.x; ++i) {
      const x = sharp(camera.to_pixel(i * step, 0).x);
      context.lineWidth = i === 0 ? 2 : 1;
      this.#line(x, 0, x, height);
    }
    for (let i = Math.ceil(lower.y / step); i * step <= upper.y; ++i) {
      const y = sharp(camera.to_pixel(0, i * step).y);
      context.lineWidth = i === 0 ? 2 : 1;
      this.#line(0, y, width, y);
    }
  }

  // Returns the spacing of the grid.
  #scale_bar(width, height) {
    const context = this.#context, camera = this.#camera, step = round_step(kGridStep / camera.scale);
    context.strokeStyle = this.#theme.text;
    context.lineWidth = 2;
    const right = this.scale_bar_x ?? width - 20, left = right - step * camera.scale, y = this.scale_bar_y ?? height - 14;
    // Draws a plate behind the bar, so that it is readable over bodies and ground.
    context.fillStyle = this.#theme.plate;
    context.fillRect(left - 8, y - 20, right - left + 16, 28);
    context.fillStyle = this.#theme.text;
    this.#line(left, y, right, y);
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "left";
    context.fillText(`${Number(step.toPrecision(1))} m`, left, y - 5);
  }
}
