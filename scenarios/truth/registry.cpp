#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "scenarios/scenario.h"

namespace plumb::scenarios {
namespace {

constexpr int kLargestSize = 1'000'000;  // a scene of a GB; more would exhaust the memory of most machines

/// Filled before main() by the scenario files, in whatever order they are linked.
struct Registry {
  std::vector<Scenario> scenarios;
  std::optional<Error> problem;  // kept for the first caller that can catch it
};

Registry& registry() {
  static Registry instance;
  return instance;
}

std::string subject(std::string_view name) { return "scenario " + quoted(name); }

std::optional<Error> problem_with(const Scenario& scenario) {
  const auto error = [&](Error::Kind kind, std::string field, std::string value, std::string problem) {
    return Error(kind, subject(scenario.name), std::move(field), std::move(value), std::move(problem));
  };
  if (scenario.name.empty() || scenario.name.find_first_of("/[]") != std::string::npos)
    return error(Error::Kind::Name, "name", scenario.name, "must not be empty nor contain '/', '[' or ']'");
  if (!scenario.build) return error(Error::Kind::Value, "build", "", "is missing");
  if (scenario.variants.empty()) return error(Error::Kind::Value, "variants", "", "must not be empty");
  if (scenario.sizes.empty() || std::ranges::min(scenario.sizes) < 1)
    return error(Error::Kind::Value, "sizes", "", "must be at least one, each of them >= 1");
  for (const Scenario& other : registry().scenarios)
    if (other.name == scenario.name)
      return error(Error::Kind::Name, "name", scenario.name, "is registered by two files");
  return std::nullopt;
}

/// Parts of "name", "name/variant", "name[size]" or "name/variant[size]".
struct Selector {
  std::string name;
  std::optional<std::string> variant;
  std::optional<std::string> size;
};

Selector parse(std::string_view text) {
  Selector selector;
  if (const auto bracket = text.find('['); bracket != text.npos) {
    std::string_view size = text.substr(bracket + 1);
    if (size.empty() || size.back() != ']')
      throw Error(Error::Kind::Value, subject(text.substr(0, bracket)), "size", std::string(size),
                  "must end in ']', as in \"name[20]\"");
    size.remove_suffix(1);
    selector.size = size;
    text = text.substr(0, bracket);
  }
  if (const auto slash = text.find('/'); slash != text.npos) {
    selector.variant = text.substr(slash + 1);
    text = text.substr(0, slash);
  }
  selector.name = text;
  return selector;
}

const Scenario& find(const std::string& name) {
  std::vector<std::string> names;
  for (const Scenario& scenario : all()) {
    if (scenario.name == name) return scenario;
    names.push_back(scenario.name);
  }
  throw Error(Error::Kind::Name, "scenario", "", name,
              "there is none by this name" + did_you_mean(name, names));
}

int parse_size(const Scenario& scenario, const std::string& text) {
  int size = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, size);
  if (failure != std::errc{} || stop != end || size < 1)
    throw Error(Error::Kind::Value, subject(scenario.name), "size", text,
                "must be a whole number, from 1 to " + std::to_string(kLargestSize));
  return size;
}

std::vector<std::string> chosen_variants(const Scenario& scenario,
                                         const std::optional<std::string>& variant) {
  if (!variant) return scenario.variants;
  if (variant->empty() || std::ranges::find(scenario.variants, *variant) == scenario.variants.end())
    throw Error(Error::Kind::Name, subject(scenario.name), "variant", *variant,
                "there is no such variant" + did_you_mean(*variant, scenario.variants));
  return {*variant};
}

std::vector<int> chosen_sizes(const Scenario& scenario, const std::optional<std::string>& text, int size) {
  if (!text && size <= 0) return scenario.sizes;
  const int wanted = text ? parse_size(scenario, *text) : size;
  const auto error = [&](std::string problem) {
    return Error(Error::Kind::Value, subject(scenario.name), "size", std::to_string(wanted),
                 std::move(problem));
  };
  if (text && size > 0 && size != wanted)
    throw error("contradicts the size " + std::to_string(size) + " that was given as well");
  if (wanted > kLargestSize) throw error("must be at most " + std::to_string(kLargestSize));
  if (!scenario.scales && std::ranges::find(scenario.sizes, wanted) == scenario.sizes.end())
    throw error("does not apply: this scenario does not scale, leave the size out");
  return {wanted};
}

}  // namespace

std::string Instance::label() const {
  std::string label = scenario->name;
  if (scenario->variants.size() > 1) label += "/" + variant;
  if (scenario->scales) label += "[" + std::to_string(size) + "]";
  return label;
}

const std::vector<Scenario>& all() {
  if (registry().problem) throw *registry().problem;
  return registry().scenarios;
}

std::vector<Instance> select(std::string_view name, int size) {
  const Selector selector = parse(name);
  const Scenario& scenario = find(selector.name);
  const auto sizes = chosen_sizes(scenario, selector.size, size);
  std::vector<Instance> instances;
  for (const std::string& variant : chosen_variants(scenario, selector.variant))
    for (const int n : sizes) instances.push_back({&scenario, variant, n});
  return instances;
}

Register::Register(Scenario scenario) {
  auto& [scenarios, problem] = registry();
  if (!problem) problem = problem_with(scenario);
  const auto place = std::ranges::upper_bound(scenarios, scenario.name, {}, &Scenario::name);
  scenarios.insert(place, std::move(scenario));
}

}  // namespace plumb::scenarios
