#include "harness/hunt/kinds.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/style.h"

namespace plumb::harness::hunt {
namespace {

using Json = nlohmann::ordered_json;

std::string structure_of(const Case& one) { return one.idioms.size() > 1 ? one.idioms[1] : ""; }

void add(std::vector<std::string>& to, const std::string& text) {
  if (std::find(to.begin(), to.end(), text) == to.end()) to.push_back(text);
}

std::size_t dynamic_bodies(const Case& one) {
  return static_cast<std::size_t>(
      std::count_if(one.scene.bodies.begin(), one.scene.bodies.end(),
                    [](const Body& body) { return body.type == BodyType::Dynamic; }));
}

bool smaller(const Finding& a, const Finding& b) {
  const auto size = [](const Finding& f) {
    return f.smallest.scene.bodies.size() * 4 + f.smallest.scene.joints.size() * 2 +
           f.smallest.actions.size();
  };
  return size(a) < size(b);
}

}  // namespace

std::string coarse_key(const Finding& finding) {
  return finding.objection.judge + " | " + finding.engine + " | " + structure_of(finding.smallest);
}

std::vector<Kind> kinds_of(const std::vector<Found>& findings) {
  std::map<std::string, Kind> kinds;
  std::map<std::string, std::string> kind_of_key;
  for (const Found& found : findings) {
    if (!found.finding.shrunk) continue;
    Kind& kind = kinds[found.finding.kind];
    if (kind.name.empty()) {
      kind = {.name = found.finding.kind, .first = found.scene + 1, .smallest = found.finding};
    }
    kind.first = std::min(kind.first, found.scene + 1);
    if (smaller(found.finding, kind.smallest)) kind.smallest = found.finding;
    add(kind.engines, found.finding.engine);
    add(kind.idioms, structure_of(found.finding.smallest));
    kind_of_key.try_emplace(coarse_key(found.finding), found.finding.kind);
  }
  for (const Found& found : findings) {
    if (found.finding.shrunk) continue;
    const auto at = kind_of_key.find(coarse_key(found.finding));
    Kind& kind = kinds[at != kind_of_key.end() ? at->second : found.finding.kind];
    if (kind.name.empty())
      kind = {.name = found.finding.kind, .first = found.scene + 1, .smallest = found.finding};
    ++kind.count;
    add(kind.engines, found.finding.engine);
    add(kind.idioms, structure_of(found.finding.smallest));
  }
  std::vector<Kind> out;
  for (auto& [name, kind] : kinds) out.push_back(std::move(kind));
  std::sort(out.begin(), out.end(), [](const Kind& a, const Kind& b) { return a.first < b.first; });
  int number = 0;
  for (Kind& kind : out) {
    kind.count = std::max<std::uint64_t>(kind.count, 1);
    std::string name = kind.smallest.objection.judge;
    kind.file = fmt::format("{:03}-{}", ++number, name);
  }
  return out;
}

std::string kinds_text(const Hunted& hunted) {
  std::string out = fmt::format("{:>6} {:>6} {:>6}  {:<20} {}\n", "after", "times", "bodies", "judge",
                                "smallest scene, engines, structures");
  for (const Kind& kind : hunted.kinds) {
    std::string engines, idioms;
    for (const std::string& engine : kind.engines) engines += (engines.empty() ? "" : ", ") + engine;
    for (const std::string& idiom : kind.idioms) idioms += (idioms.empty() ? "" : ", ") + idiom;
    out += fmt::format("{:>6} {:>6} {:>6}  {:<20} {}\n{:>22}{} ({})\n{:>22}{}\n", kind.first, kind.count,
                       kind.smallest.smallest.scene.bodies.size(), kind.smallest.objection.judge,
                       made_of(kind.smallest.smallest, kind.smallest.objection.law), "", engines, idioms, "",
                       kind.smallest.objection.what);
  }
  return out;
}

std::string kinds_json(const Hunted& hunted) {
  Json out = Json::array();
  for (const Kind& kind : hunted.kinds)
    out.push_back({{"kind", kind.name},
                   {"judge", kind.smallest.objection.judge},
                   {"engines", kind.engines},
                   {"idioms", kind.idioms},
                   {"after_scenes", kind.first},
                   {"findings", kind.count},
                   {"bodies", kind.smallest.smallest.scene.bodies.size()},
                   {"dynamic_bodies", dynamic_bodies(kind.smallest.smallest)},
                   {"what", kind.smallest.objection.what},
                   {"right", kind.smallest.objection.right},
                   {"file", "findings/" + kind.file + ".json"}});
  return out.dump(2);
}

}  // namespace plumb::harness::hunt
