#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/suggest.h"
#include "engine/scene/error.h"
#include "reference/backend.h"
#include "reference/guests.h"
#include "reference/node_engines.h"

namespace plumb::reference {
namespace {

// Function-local static, because registrations run before main in an unspecified order.
std::vector<std::unique_ptr<Backend>>& registry() {
  static std::vector<std::unique_ptr<Backend>> all;
  return all;
}

/// plumb's own adapters come first, then the alphabet.
std::pair<bool, std::string_view> rank(const Backend& backend) {
  return {!backend.name().starts_with("plumb"), backend.name()};
}

}  // namespace

Registration::Registration(std::unique_ptr<Backend> backend) { registry().push_back(std::move(backend)); }

std::vector<const Backend*> backends() {
  std::vector<const Backend*> all;
  for (const auto& backend : registry()) all.push_back(backend.get());
  std::sort(all.begin(), all.end(), [](auto* a, auto* b) { return rank(*a) < rank(*b); });
  return all;
}

const Backend& find_backend(std::string_view name) {
  std::vector<std::string> names;
  for (const Backend* backend : backends()) {
    if (backend->name() == name) return *backend;
    names.emplace_back(backend->name());
  }
  if (const Backend* guest = find_guest(name)) return *guest;
  for (const Backend* guest : linked_guests()) names.emplace_back(guest->name());
  for (const NodeEngine& engine : node_engines()) names.push_back(engine.name);
  throw Error(Error::Kind::Name, "engine", "", std::string(name),
              "there is no such engine" + did_you_mean(name, names));
}

}  // namespace plumb::reference
