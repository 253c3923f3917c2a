// Reads what adapters need from a scene (docs/scene.md).

const area = (shape) => shape.type === "circle" ? Math.PI * shape.radius ** 2 : shape.width * shape.height;
const gyration = (shape) => shape.type === "circle" ? shape.radius ** 2 / 2 : (shape.width ** 2 + shape.height ** 2) / 12;

// Returns the inertia of a dynamic body about its centre of mass, kg m^2: as given, or from its shapes.
export function inertiaOf(body) {
  if (body.fixed_rotation) return 0;
  if (body.inertia !== undefined) return body.inertia;
  const weights = body.shapes.map((s) => area(s) * (s.density ?? 1));
  const total = weights.reduce((a, b) => a + b, 0);
  return body.shapes.reduce((sum, s, i) =>
    sum + body.mass * weights[i] / total * (gyration(s) + s.position[0] ** 2 + s.position[1] ** 2), 0);
}

// Returns a contact's coefficient from those of two shapes.
export function combine(rule, a, b) {
  return { geometric_mean: Math.sqrt(a * b), product: a * b, maximum: Math.max(a, b), minimum: Math.min(a, b),
           average: (a + b) / 2 }[rule];
}

// Returns true if two shapes' filters let them touch.
export function mayTouch(a, b) {
  if (a.group !== 0 && a.group === b.group) return a.group > 0;
  return (a.category & b.mask) !== 0 && (b.category & a.mask) !== 0;
}

// Returns true if no shape of the scene has a filter group, or a category beyond the lowest `bits`.
export function filtersFit(scene, bits) {
  return scene.bodies.every((body) => body.shapes.every((s) => s.filter.group === 0 && s.filter.category < 2 ** bits));
}

export const contactRules = (scene) => ({
  friction: "the scene's, " + scene.contact_rules.friction,
  restitution: "the scene's, " + scene.contact_rules.restitution,
});
