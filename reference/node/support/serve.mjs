// Implements docs/protocol.md for an engine from npm: a script describes its engine and passes it to `serve`.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import path from "node:path";
import readline from "node:readline";
import { Forces } from "./forces.mjs";

// Arguments: the folder in which the package is installed, and "default" for the engine's own settings.
export const folder = path.resolve(process.argv[2] ?? ".");
export const outOfTheBox = process.argv[3] === "default";

// Path of a file of a package below the folder, and the installed version.
export const fileOf = (name, ...parts) => path.join(folder, "node_modules", name, ...parts);
export const versionOf = (name) => JSON.parse(readFileSync(fileOf(name, "package.json"), "utf8")).version;
export const requireFrom = createRequire(path.join(folder, "package.json"));

const kForces = ["linear_drag", "quadratic_drag", "point_force", "torque", "spring", "attraction", "sinusoidal_force"];
const kEpsilon = { float: 1.1920929e-7, double: 2.220446049250313e-16 };

// Engines print to standard output, which must contain only answers.
const write = process.stdout.write.bind(process.stdout);
console.log = console.info = console.warn = console.error;
const send = (message) => write(JSON.stringify(message) + "\n");

// Serves `engine`: name, version, precision, summary, limits, joints, features, options, innerSubsteps (the
// substeps that the engine itself makes of a step) and create(scene, settings). `create` returns { effective,
// step(), state(i), push(i, fx, fy, torque), turn }, or a reason as text. `settings` has substep (s),
// substeps and options.
export function serve(engine) {
  const hello = {
    protocol: 1, name: engine.name, version: engine.version, precision: engine.precision, summary: engine.summary,
    limits: engine.limits,
    method: { scheme: engine.scheme ?? "semi_implicit_euler", order: 1, epsilon: kEpsilon[engine.precision],
              substeps: engine.innerSubsteps ?? 1 },
    shapes: ["circle", "box"], joints: engine.joints, forces: kForces, features: engine.features,
    options: engine.options ?? [],
  };
  let run = null;

  function load({ scene, settings }) {
    const substeps = settings.substeps ?? 1;
    const options = Object.fromEntries((engine.options ?? []).map((o) => [o.name, settings.options?.[o.name] ?? o.fallback]));
    run?.world.free?.();
    run = null;
    // JavaScript's bitwise operators use 32 bits. Masks are signed, so that -1 is all bits.
    const beyond = (shape) => shape.filter.category < 0 || shape.filter.category >= 2 ** 32;
    if (scene.bodies.some((body) => body.shapes.some(beyond))) return { unsupported: "a filter has categories beyond 32" };
    const world = engine.create(scene, { dt: settings.dt, substep: settings.dt / substeps, substeps, options });
    if (typeof world === "string") return { unsupported: world };
    run = { world, scene, substeps, substep: settings.dt / substeps, dt: settings.dt, done: 0, steps: 0,
            forces: new Forces(scene), turns: scene.bodies.map((body) => body.angle) };
    return { effective_settings: { dt: settings.dt, substeps, settings: outOfTheBox ? "out of the box" : "equalised",
                                   ...world.effective, forces: "at the start of each substep", precision: engine.precision } };
  }

  // Angles must count whole turns. For an engine that returns only rotations (`wraps`), the angular velocity
  // tells how many.
  function follow(index, state, time) {
    if (!run.world.wraps) return state;
    const guess = run.turns[index] + state[5] * time;
    state[2] += 2 * Math.PI * Math.round((guess - state[2]) / (2 * Math.PI));
    run.turns[index] = state[2];
    return state;
  }

  function step() {
    for (let i = 0; i < run.substeps; ++i) {
      if (!run.forces.empty) run.forces.apply(run.done * run.substep, (run.done + 1) * run.substep, run.world);
      run.world.step();
      ++run.done;
    }
    ++run.steps;
    if (run.world.wraps) run.scene.bodies.forEach((_, i) => follow(i, run.world.state(i), run.dt));
  }

  function simulate({ samples, every }) {
    let spent = 0n;
    for (let i = 0; i < samples; ++i) {
      const start = process.hrtime.bigint();
      for (let k = 0; k < every; ++k) step();
      spent += process.hrtime.bigint() - start;
      const states = run.scene.bodies.map((_, body) => follow(body, run.world.state(body), 0));
      if (!states.every((row) => row.every(Number.isFinite)))
        return { error: { kind: "diverged", problem: "a state is not finite" } };
      send({ t: run.steps * run.dt, states });
    }
    return { done: true, ns: Number(spent) };
  }

  const answers = { hello: () => hello, load, run: simulate };
  readline.createInterface({ input: process.stdin }).on("line", (line) => {
    const message = JSON.parse(line);
    if (message.request === "quit") process.exit(0);
    try {
      const answer = answers[message.request];
      send(answer ? answer(message) : { error: "no such request: " + message.request });
    } catch (error) {
      send({ error: { kind: "run", problem: String(error?.message ?? error) } });
    }
  }).on("close", () => process.exit(0));
}
