#include "demos/core/registry.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "engine/core/suggest.h"
#include "engine/scene/error.h"

namespace plumb::demos {
namespace {

// A function-local list, because files register in no particular order, before main.
std::vector<Entry>& entries() {
  static std::vector<Entry> list;
  return list;
}

}  // namespace

Register::Register(int order, const About& about, std::unique_ptr<Demo> (*make)()) {
  entries().push_back({order, about, make});
  std::ranges::sort(entries(), {},
                    [](const Entry& entry) { return std::tie(entry.order, entry.about.name); });
}

const std::vector<Entry>& all() { return entries(); }

std::unique_ptr<Demo> make(std::string_view name) {
  std::vector<std::string> names;
  for (const Entry& entry : all()) {
    if (entry.about.name == name) return entry.make();
    names.push_back(entry.about.name);
  }
  throw Error(Error::Kind::Name, "demos", "name", std::string(name),
              "is not a demo" + did_you_mean(name, names));
}

}  // namespace plumb::demos
