#include "harness/stress/family.h"

#include <algorithm>
#include <utility>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::harness::stress {
namespace {

std::vector<Family>& registered() {
  static std::vector<Family> families;
  return families;
}

}  // namespace

const std::vector<Family>& all() { return registered(); }

const Family& find_family(std::string_view name) {
  std::vector<std::string> names;
  for (const Family& family : all()) {
    if (family.name == name) return family;
    names.push_back(family.name);
  }
  throw Error(Error::Kind::Name, "family " + quoted(name), "", "",
              "is unknown" + did_you_mean(name, names) + "; see `plumb stress --list`");
}

Register::Register(Family family) {
  std::vector<Family>& families = registered();
  const auto place = std::lower_bound(families.begin(), families.end(), family.name,
                                      [](const Family& a, const std::string& b) { return a.name < b; });
  families.insert(place, std::move(family));
}

std::vector<Stretch> evenly(long steps, int samples) {
  const long every = std::max(1L, steps / samples), whole = steps / every, rest = steps - whole * every;
  std::vector<Stretch> out{{static_cast<int>(whole), static_cast<int>(every)}};
  if (rest > 0) out.push_back({1, static_cast<int>(rest)});
  return out;
}

}  // namespace plumb::harness::stress
