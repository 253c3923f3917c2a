#include "harness/stress/verdict.h"

#include <array>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::harness::stress {
namespace {

struct Words {
  std::string_view name, in_short, meaning;
};

constexpr std::array<Words, kVerdicts> kWords{{
    {"ok", "ok", "within its bounds"},
    {"inaccurate", "inacc", "error up to ten times the bound"},
    {"drifts", "drifts", "error of position or energy above ten times the bound"},
    {"sinks", "sinks", "shapes overlap"},
    {"stretches", "longer", "stretches: joints come apart"},
    {"freezes", "frozen", "freezes: a body does not move as it should"},
    {"tunnels", "tunnel", "passed through a wall"},
    {"explodes", "explod", "flies off"},
    {"NaN", "NaN", "a state is not finite"},
    {"crashed", "crash", "its process died"},
    {"timeout", "time", "took too long"},
    {"refused", "refuse", "the engine rejected the scene"},
    {"skipped", "-", "the engine lacks a feature; not counted"},
}};

const Words& words_of(Verdict verdict) { return kWords[static_cast<std::size_t>(verdict)]; }

}  // namespace

std::string_view name_of(Verdict verdict) { return words_of(verdict).name; }
std::string_view short_name_of(Verdict verdict) { return words_of(verdict).in_short; }
std::string_view meaning_of(Verdict verdict) { return words_of(verdict).meaning; }

Verdict verdict_of(std::string_view name) {
  for (std::size_t i = 0; i < kWords.size(); ++i)
    if (kWords[i].name == name) return static_cast<Verdict>(i);
  throw Error(Error::Kind::Name, "a cell", "outcome", quoted(name), "is not an outcome");
}

}  // namespace plumb::harness::stress
