#include "engine/driver/sensitivity.h"

#include <array>

#include "engine/core/text.h"

namespace plumb {
namespace {

struct Words {
  std::string_view name, problem;
};

constexpr std::array<Words, 7> kWords{{
    {"grazing", "shapes met without approaching, and a slight change decides whether they meet"},
    {"simultaneous", "impacts at one instant are separated by the parameter, and their order decides"},
    {"zeno", "bounces were brought to their limit, where infinitely many follow each other"},
    {"start", "the parameter opens a contact of the start, or presses it together"},
    {"kink", "an impact or a force has a kink here: it sticks on one side and slips on the other"},
    {"paradox", "no force, or several, obey Coulomb's law (Painleve's paradox)"},
    {"singular",
     "a linkage crossed a kinematic singularity or has redundant joints, or a derivative is not finite"},
}};

const Words& words_of(NoDerivative reason) { return kWords[static_cast<std::size_t>(reason)]; }

}  // namespace

std::string_view name_of(NoDerivative reason) { return words_of(reason).name; }

NotDifferentiable::NotDifferentiable(const std::string& parameter, NoDerivative reason, double time)
    : Error(Kind::Run, "sensitivity", parameter, std::string(words_of(reason).name),
            std::string(words_of(reason).problem) + ", at t = " + shortest(time) +
                " s; there is no derivative from then on, and differences of runs would not converge"),
      reason_(reason),
      time_(time) {}

}  // namespace plumb
