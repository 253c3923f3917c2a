// Decides which part of the world is visible, and its scale. Pixels of CSS: (0, 0) at the top left, y down;
// the world: m, y up.

const kSmallest = 1e-3, kLargest = 1e6;  // pixels a metre
const kMargin = 16;                      // pixels
const kBelow = 36;                       // pixels, the height of the scale bar, which would cover bodies

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export class Camera {
  scale = 50;  // pixels a metre
  #width = 1;
  #height = 1;
  #centre = {x: 0, y: 0};  // m, in the middle of the picture

  resize(width, height) {
    this.#width = Math.max(width, 1);
    this.#height = Math.max(height, 1);
  }

  /// Shows all of `view` ([left, lower, right, upper]) as large as possible in the area that is not covered
  /// at the edges.
  fit([left, lower, right, upper], covered) {
    const wide = Math.max(this.#width - covered.left - covered.right - 2 * kMargin, 1);
    const high = Math.max(this.#height - covered.top - covered.bottom - kMargin - kBelow, 1);
    this.scale = clamp(Math.min(wide / (right - left), high / (upper - lower)), kSmallest, kLargest);
    this.#centre = {x: (left + right) / 2 + (covered.right - covered.left) / 2 / this.scale,
                    y: (lower + upper) / 2 + (covered.top - covered.bottom + kMargin - kBelow) / 2 / this.scale};
  }

  to_pixel(x, y) {
    return {x: this.#width / 2 + this.scale * (x - this.#centre.x),
            y: this.#height / 2 - this.scale * (y - this.#centre.y)};
  }
  to_world(pixel) {
    return {x: this.#centre.x + (pixel.x - this.#width / 2) / this.scale,
            y: this.#centre.y - (pixel.y - this.#height / 2) / this.scale};
  }

  /// Scales by `factor`; the point at `pixel` stays fixed.
  zoom(pixel, factor) {
    const held = this.to_world(pixel);
    this.scale = clamp(this.scale * factor, kSmallest, kLargest);
    const now = this.to_world(pixel);
    this.#centre.x += held.x - now.x;
    this.#centre.y += held.y - now.y;
  }
  /// Moves the picture by this many pixels.
  pan(x, y) {
    this.#centre.x -= x / this.scale;
    this.#centre.y += y / this.scale;
  }
}
