#include <algorithm>
#include <cmath>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

std::vector<Idiom>& registered() {
  static std::vector<Idiom> all;
  return all;
}

const Idiom* drawn(Random& random, const std::vector<const Idiom*>& from) {
  double sum = 0;
  for (const Idiom* idiom : from) sum += idiom->weight;
  double at = random.unit() * sum;
  for (const Idiom* idiom : from) {
    at -= idiom->weight;
    if (at < 0) return idiom;
  }
  return from.empty() ? nullptr : from.back();
}

std::vector<const Idiom*> of_role(Idiom::Role role) {
  std::vector<const Idiom*> out;
  for (const Idiom& idiom : idioms())
    if (idiom.role == role) out.push_back(&idiom);
  return out;
}

void build(Draft& draft, const Idiom& idiom) {
  draft.idiom = idiom.name;
  draft.out.idioms.push_back(idiom.name);
  idiom.build(draft);
}

void draw_world(Draft& draft) {
  Random& random = draft.random;
  Case& out = draft.out;
  out.dt = random.chance(0.7) ? 1.0 / 60 : 1.0 / random.pick({30, 50, 100, 120, 240});
  out.substeps = random.chance(0.7) ? 4 : random.pick({1, 2, 3, 8, 16});
  out.steps = static_cast<int>(random.within(1, 4) / out.dt);
  out.sleeping = random.chance(0.4);
  draft.size = random.chance(0.7) ? 1 : random.ladder(0.1, 10);
  out.scene.gravity = {0, random.chance(0.8) ? -9.81 : -random.ladder(1, 50)};
  draft.friction = random.chance(0.6) ? 0.6 : random.pick({0.0, 0.1, 0.3, 1.0, 2.0});
  draft.restitution = random.chance(0.6) ? 0.0 : random.pick({0.2, 0.5, 0.8, 1.0});
  draft.density = random.chance(0.6) ? 1 : random.ladder(0.01, 1000);
}

bool accepts(const Idiom& structure, const Site& site) {
  switch (site.kind) {
    case Site::Kind::Air:
      return structure.air;
    case Site::Kind::Enclosure:
      return structure.enclosure;
    case Site::Kind::Floor:
      break;
  }
  return structure.floor && (!structure.level || (site.level && !site.moves));
}

}  // namespace

const std::vector<Idiom>& idioms() { return registered(); }

const Idiom& find_idiom(std::string_view name) {
  std::vector<std::string> names;
  for (const Idiom& idiom : idioms()) {
    if (idiom.name == name) return idiom;
    names.push_back(idiom.name);
  }
  throw Error(Error::Kind::Name, "family " + quoted(name), "", "",
              "is unknown" + did_you_mean(name, names) + "; see `plumb hunt --list`");
}

Register::Register(Idiom idiom) {
  std::vector<Idiom>& all = registered();
  const auto place = std::lower_bound(all.begin(), all.end(), idiom.name,
                                      [](const Idiom& a, const std::string& b) { return a.name < b; });
  all.insert(place, std::move(idiom));
}

Case compose(std::uint64_t seed, std::uint64_t index, const std::vector<const Idiom*>& wanted) {
  Draft draft(seed, index);
  draw_world(draft);
  Random& random = draft.random;
  const Idiom* structure = drawn(random, wanted.empty() ? of_role(Idiom::Role::Structure) : wanted);
  // Draw supports until one accepts the structure.
  const std::vector<const Idiom*> supports = of_role(Idiom::Role::Support);
  for (int tries = 0;; ++tries) {
    Draft attempt = draft;
    const Idiom* support = drawn(random, supports);
    attempt.random = random;  // so that the next attempt draws different numbers
    build(attempt, *support);
    if (!accepts(*structure, attempt.site) && tries < 100) {
      random = attempt.random;
      continue;
    }
    draft = std::move(attempt);
    break;
  }
  if (draft.site.kind == Site::Kind::Air && draft.random.chance(0.5)) draft.out.scene.gravity = {0, 0};
  build(draft, *structure);
  const std::vector<const Idiom*> disturbances = of_role(Idiom::Role::Disturbance);
  const int count = draft.random.pick({0, 0, 1, 1, 1, 2});
  for (int i = 0; i < count; ++i) {
    const Idiom* chosen = drawn(draft.random, disturbances);
    if (!chosen->fits || chosen->fits(draft)) build(draft, *chosen);
  }
  std::stable_sort(draft.out.actions.begin(), draft.out.actions.end(),
                   [](const Action& a, const Action& b) { return a.step < b.step; });
  std::string name;
  for (const std::string& idiom : draft.out.idioms) name += (name.empty() ? "" : " + ") + idiom;
  draft.out.scene.name = name;
  return std::move(draft.out);
}

}  // namespace plumb::harness::hunt
