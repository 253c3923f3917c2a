// The scene's force laws (docs/scene.md) for an engine that takes a force and a torque per step. They are
// evaluated at the start of the step; laws that depend on time are averaged over it.

// Returns the fraction of [from, to] in which a law acts that begins at `start` and lasts for `duration`.
function share(law, from, to) {
  const end = law.start + (law.duration ?? Infinity);
  return Math.max(0, Math.min(to, end) - Math.max(from, law.start)) / (to - from);
}

const turned = ([x, y], angle) => {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c * x - s * y, s * x + c * y];
};
const cross = (a, b) => a[0] * b[1] - a[1] * b[0];

export class Forces {
  constructor(scene) {
    this.laws = scene.forces;
    this.masses = scene.bodies.map((body) => body.mass);
    this.index = new Map(scene.bodies.map((body, i) => [body.name, i]));
    this.dynamic = scene.bodies.map((body) => body.type === "dynamic");
  }

  get empty() { return this.laws.length === 0; }

  // Evaluates all laws on [from, to] and pushes the bodies of `world`.
  apply(from, to, world) {
    const state = (name) => {
      const i = this.index.get(name);
      return i === undefined ? [0, 0, 0, 0, 0, 0] : world.state(i);
    };
    const push = (name, force, arm = [0, 0], torque = 0) => {
      const i = this.index.get(name);
      if (i === undefined || !this.dynamic[i]) return;
      world.push(i, force[0], force[1], torque + cross(arm, force));
    };
    // Position and velocity of a point of a body.
    const point = (s, anchor) => {
      const arm = turned(anchor, s[2]);
      return { arm, at: [s[0] + arm[0], s[1] + arm[1]], rate: [s[3] - s[5] * arm[1], s[4] + s[5] * arm[0]] };
    };
    for (const law of this.laws) this.one(law, from, to, { state, push, point });
  }

  one(law, from, to, { state, push, point }) {
    switch (law.type) {
      case "linear_drag": {
        const s = state(law.body);
        return push(law.body, [-law.coefficient * s[3], -law.coefficient * s[4]]);
      }
      case "quadratic_drag": {
        const s = state(law.body), k = -law.coefficient * Math.hypot(s[3], s[4]);
        return push(law.body, [k * s[3], k * s[4]]);
      }
      case "point_force": {
        const s = state(law.body), part = share(law, from, to);
        const force = law.frame === "body" ? turned(law.force, s[2]) : law.force;
        return push(law.body, [part * force[0], part * force[1]], turned(law.point, s[2]));
      }
      case "torque":
        return push(law.body, [0, 0], [0, 0], share(law, from, to) * law.torque);
      case "spring": {
        const a = point(state(law.body_a), law.anchor_a), b = point(state(law.body_b), law.anchor_b);
        const way = [b.at[0] - a.at[0], b.at[1] - a.at[1]], length = Math.hypot(...way);
        if (length === 0) return;
        const n = [way[0] / length, way[1] / length];
        const rate = n[0] * (b.rate[0] - a.rate[0]) + n[1] * (b.rate[1] - a.rate[1]);
        const tension = law.stiffness * (length - law.rest_length) + law.damping * rate;
        push(law.body_a, [tension * n[0], tension * n[1]], a.arm);
        return push(law.body_b, [-tension * n[0], -tension * n[1]], b.arm);
      }
      case "attraction": {
        const s = state(law.body), c = point(state(law.centre_body), law.centre);
        const way = [c.at[0] - s[0], c.at[1] - s[1]], r = Math.hypot(...way);
        if (r === 0) return;
        const size = law.strength * this.masses[this.index.get(law.body)] / r ** law.exponent / r;
        push(law.body, [size * way[0], size * way[1]]);
        return push(law.centre_body, [-size * way[0], -size * way[1]], c.arm);
      }
      case "sinusoidal_force": {
        const s = state(law.body), w = law.angular_frequency;
        const part = w * (to - from) < 1e-6 ? Math.sin(w * (from + to) / 2 + law.phase)
          : (Math.cos(w * from + law.phase) - Math.cos(w * to + law.phase)) / (w * (to - from));
        return push(law.body, [part * law.amplitude[0], part * law.amplitude[1]], turned(law.point, s[2]));
      }
      default:
        throw new Error("there is no law " + law.type);
    }
  }
}
