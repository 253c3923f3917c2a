// Scenes as pictures: bodies in their poses, joints and springs between them. x to the right, y up.
const kPicture = kNarrow ? {width: 340, height: 260} : {width: 480, height: 330};

const turned = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];

/// The corners of the convex hull, counter-clockwise.
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list) => {
    const out = [];
    for (const p of list) {
      while (out.length > 1) {
        const [a, b] = out.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        out.pop();
      }
      out.push(p);
    }
    return out.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/// A shape's outline in the body's frame: points, and how far around them it goes.
function outline(shape) {
  const [px, py] = shape.position ?? [0, 0];
  const at = (points) => points.map((p) => { const [x, y] = turned(p, shape.angle ?? 0); return [x + px, y + py]; });
  const [w, h] = [(shape.width ?? 0) / 2, (shape.height ?? 0) / 2];
  switch (shape.type) {
    case "circle": return {points: [[px, py]], round: shape.radius, closed: true};
    case "box": return {points: at([[-w, -h], [w, -h], [w, h], [-w, h]]), round: 0, closed: true};
    case "capsule": return {points: at([shape.start, shape.end]), round: shape.radius, closed: true};
    case "polygon": return {points: at(hull(shape.points)), round: shape.radius ?? 0, closed: true};
    case "segment": return {points: at([shape.start, shape.end]), round: 0, closed: false};
    default: return {points: at(shape.points), round: 0, closed: Boolean(shape.closed)};
  }
}

// The path around a convex outline at the distance `round`.
function pathOf({points, round, closed}) {
  const text = (x, y) => `${x} ${y}`;
  if (points.length === 1) {
    const [[x, y]] = points;
    return `M${x + round} ${y}A${round} ${round} 0 1 1 ${x - round} ${y}A${round} ${round} 0 1 1 ${x + round} ${y}M${x} ${y}h${round}`;
  }
  if (round === 0) return `M${points.map(([x, y]) => text(x, y)).join("L")}${closed ? "Z" : ""}`;
  const parts = points.map((a, i) => {
    const b = points[(i + 1) % points.length];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const [nx, ny] = [round * (b[1] - a[1]) / length, -round * (b[0] - a[0]) / length];
    return [text(a[0] + nx, a[1] + ny), text(b[0] + nx, b[1] + ny)];
  });
  return `M${parts.map(([from, to]) => `${from}L${to}`).join(`A${round} ${round} 0 0 1 `)}A${round} ${round} 0 0 1 ${parts[0][0]}Z`;
}

const poseAtStart = (scene) => scene.bodies.flatMap((body) => [...(body.position ?? [0, 0]), body.angle ?? 0]);
const moves = (body) => (body.type ?? "dynamic") !== "static";

function reachOf(body) {
  let reach = 0;
  for (const shape of body.shapes ?? []) {
    const {points, round} = outline(shape);
    for (const [x, y] of points) reach = Math.max(reach, Math.hypot(x, y) + round);
  }
  return reach;
}

/// What a picture has to show so that all that moves stays in it: {x, y, width, height} in m.
function viewOf(scene, motions) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const add = (x, y, reach) => {
    box[0] = Math.min(box[0], x - reach); box[1] = Math.min(box[1], y - reach);
    box[2] = Math.max(box[2], x + reach); box[3] = Math.max(box[3], y + reach);
  };
  const any = scene.bodies.some(moves);
  scene.bodies.forEach((body, i) => {
    if (any && !moves(body)) return;
    const reach = reachOf(body);
    for (const poses of [poseAtStart(scene), ...motions]) add(poses[3 * i], poses[3 * i + 1], reach);
  });
  const start = poseAtStart(scene);
  for (const {from, to} of linksOf(scene))
    for (const end of [from, to]) add(...end(start), 0);
  if (!Number.isFinite(box[0])) return {x: -1, y: -1, width: 2, height: 2};
  const least = Math.max(box[2] - box[0], box[3] - box[1], 1e-3);
  const margin = 0.06 * least;
  let [width, height] = [box[2] - box[0] + 2 * margin, box[3] - box[1] + 2 * margin];
  const shape = kPicture.width / kPicture.height;
  if (width < shape * height) width = shape * height; else height = width / shape;
  return {x: (box[0] + box[2] - width) / 2, y: (box[1] + box[3] - height) / 2, width, height};
}

/// Lines that joints and springs are drawn as: {from(poses), to(poses), dashed}.
function linksOf(scene) {
  const places = new Map(scene.bodies.map((body, i) => [body.name, i]));
  const anchor = (name, point = [0, 0]) => (poses) => {
    const i = places.get(name);
    if (i === undefined) return point;
    const [x, y] = turned(point, poses[3 * i + 2]);
    return [poses[3 * i] + x, poses[3 * i + 1] + y];
  };
  const out = [];
  for (const joint of scene.joints ?? []) {
    const [a, b] = [anchor(joint.body_a, joint.anchor_a), anchor(joint.body_b, joint.anchor_b)];
    if (joint.type === "pulley") {
      out.push({from: () => joint.ground_a, to: a}, {from: () => joint.ground_b, to: b},
        {from: () => joint.ground_a, to: () => joint.ground_b});
    } else if (joint.type === "mouse") {
      out.push({from: () => joint.target, to: b, dashed: true});
    } else if (!["gear", "ratchet", "motor"].includes(joint.type)) {
      out.push({from: a, to: b, dashed: Boolean(joint.spring)});
    }
  }
  for (const force of scene.forces ?? [])
    if (force.type === "spring")
      out.push({from: anchor(force.body_a, force.anchor_a), to: anchor(force.body_b, force.anchor_b), dashed: true});
  return out;
}

/// A picture of one or more layers over the same view: {svg, add(style) giving a layer whose pose(poses) moves it}.
function picture(scene, view, title) {
  const scale = kPicture.width / view.width;
  const svg = makeSvg("svg", {class: "stage", viewBox: `0 0 ${kPicture.width} ${kPicture.height}`, role: "img",
    "aria-label": title, style: "overflow: hidden"});
  const world = makeSvg("g", {transform: `translate(${-view.x * scale} ${kPicture.height + view.y * scale}) scale(${scale} ${-scale})`});
  svg.append(world, scaleBar(view, scale));
  const add = ({stroke, dash, fill, width = 1.5, links = false}) => {
    const layer = makeSvg("g", {stroke, fill: fill ?? "none", "stroke-width": width, "stroke-dasharray": dash || undefined});
    const bodies = scene.bodies.map((body) => {
      const shapes = (body.shapes ?? []).map((shape) => makeSvg("path", {d: pathOf(outline(shape)),
        "vector-effect": "non-scaling-stroke", fill: outline(shape).closed ? undefined : "none"}));
      if (shapes.length === 0)
        shapes.push(makeSvg("circle", {r: 4 / scale, "vector-effect": "non-scaling-stroke"}));
      const group = makeSvg("g", {}, ...shapes);
      layer.append(group);
      return group;
    });
    const lines = !links ? [] : linksOf(scene).map((link) => {
      const line = makeSvg("line", {"vector-effect": "non-scaling-stroke", "stroke-dasharray": link.dashed ? "3 3" : undefined});
      const dot = makeSvg("circle", {r: 2.6 / scale, fill: stroke, stroke: "none"});
      layer.append(line, dot);
      return {link, line, dot};
    });
    world.append(layer);
    const pose = (poses) => {
      bodies.forEach((group, i) => {
        const [x, y, angle] = poses.slice(3 * i, 3 * i + 3);
        const known = Number.isFinite(x) && Number.isFinite(y) && Number.isFinite(angle) && x !== null;
        group.setAttribute("visibility", known ? "visible" : "hidden");
        if (known) group.setAttribute("transform", `translate(${x} ${y}) rotate(${angle * 180 / Math.PI})`);
      });
      for (const {link, line, dot} of lines) {
        const [from, to] = [link.from(poses), link.to(poses)];
        for (const [key, value] of Object.entries({x1: from[0], y1: from[1], x2: to[0], y2: to[1]})) line.setAttribute(key, value);
        dot.setAttribute("cx", to[0]);
        dot.setAttribute("cy", to[1]);
      }
    };
    return {layer, pose};
  };
  return {svg, world, scale, add};
}

function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-9));
}

function scaleBar(view, scale) {
  const length = niceStep(view.width / 6);
  const y = kPicture.height - 10;
  return makeSvg("g", {}, makeSvg("path", {d: `M10 ${y - 4}v4h${length * scale}v-4`, fill: "none", stroke: "var(--soft)"}),
    makeSvg("text", {x: 14 + length * scale, y, text: `${Number(length.toPrecision(3))} m`}));
}

// An arrow in the picture's own coordinates.
function arrow(from, to, stroke, dash) {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const wing = (side) => `${to[0] - 7 * Math.cos(angle + side)} ${to[1] - 7 * Math.sin(angle + side)}`;
  return makeSvg("path", {d: `M${from.join(" ")}L${to.join(" ")}M${wing(0.45)}L${to.join(" ")}L${wing(-0.45)}`, fill: "none",
    stroke, "stroke-width": 1.8, "stroke-dasharray": dash});
}

/// The scene at its start: velocities as arrows, forces as dashed ones.
function setUp(scene, motions) {
  const view = viewOf(scene, motions);
  const {svg, scale, add} = picture(scene, view, "the scene at its start");
  const start = poseAtStart(scene);
  add({stroke: "var(--ink)", fill: "var(--shape)", links: true}).pose(start);
  const place = ([x, y]) => [(x - view.x) * scale, kPicture.height - (y - view.y) * scale];
  const fastest = Math.max(...scene.bodies.map((body) => Math.hypot(...(body.velocity ?? [0, 0]))));
  scene.bodies.forEach((body, i) => {
    const [vx, vy] = body.velocity ?? [0, 0];
    if (vx === 0 && vy === 0) return;
    const from = place([start[3 * i], start[3 * i + 1]]);
    const length = 12 + 50 * Math.hypot(vx, vy) / fastest, speed = Math.hypot(vx, vy);
    svg.append(arrow(from, [from[0] + length * vx / speed, from[1] - length * vy / speed], "var(--focus)"));
  });
  for (const force of scene.forces ?? []) {
    const i = scene.bodies.findIndex((body) => body.name === force.body);
    if (force.type !== "point_force" || i < 0) continue;
    const angle = start[3 * i + 2];
    const [px, py] = turned(force.point ?? [0, 0], angle);
    const [fx, fy] = force.frame === "body" ? turned(force.force, angle) : force.force;
    const to = place([start[3 * i] + px, start[3 * i + 1] + py]), size = Math.hypot(fx, fy) || 1;
    svg.append(arrow([to[0] - 45 * fx / size, to[1] + 45 * fy / size], to, "var(--bad)", "5 3"));
  }
  return make("figure", {"data-chart": "set-up"}, make("figcaption", {text: "At the start"}), svg,
    make("p", {class: "note", text: inWords(scene)}));
}

function inWords(scene) {
  const counted = (list, one) => {
    const kinds = new Map();
    for (const item of list ?? []) kinds.set(item[one], (kinds.get(item[one]) ?? 0) + 1);
    return [...kinds].map(([kind, count]) => `${count} \u00d7 ${words(kind)}`).join(", ");
  };
  const [gx, gy] = scene.gravity ?? [0, -9.81];
  const parts = [`${scene.bodies.length} ${scene.bodies.length === 1 ? "body" : "bodies"}`];
  if (scene.joints?.length) parts.push(`joints: ${counted(scene.joints, "type")}`);
  if (scene.forces?.length) parts.push(`forces: ${counted(scene.forces, "type")}`);
  parts.push(gx === 0 && gy === 0 ? "no gravity" : `gravity (${figure(gx)}, ${figure(gy)}) m/s\u00b2`);
  return `${parts.join("; ")}. Arrows: velocities; dashed arrows: forces; dashed lines: springs.`;
}
