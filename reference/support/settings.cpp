#include "reference/support/settings.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/names.h"

namespace plumb::reference {
namespace {

std::string subject_of(std::string_view engine) { return "engine '" + std::string(engine) + "'"; }

/// Parses `text` into `out`. Returns true if all of it is a number.
bool parse(const std::string& text, int& out) {
  const char* end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, out);
  return problem == std::errc{} && rest == end;
}
bool parse(const std::string& text, double& out) {
  const char* end = text.data() + text.size();
#ifdef __cpp_lib_to_chars
  const auto [rest, problem] = std::from_chars(text.data(), end, out);
  return problem == std::errc{} && rest == end;
#else  // the browser build's library has from_chars for integers only
  char* rest = nullptr;
  out = std::strtod(text.c_str(), &rest);
  return rest != text.c_str() && rest == end;
#endif
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? " or " : ", ";
    out += "'" + names[i] + "'";
  }
  return out;
}

}  // namespace

void check_steps(std::string_view engine, const StepSettings& settings, Stepping stepping) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  const std::string subject = subject_of(engine);
  if (!positive(settings.dt)) {
    throw Error(Error::Kind::Value, subject, "dt", shortest(settings.dt),
                "must be a positive number of seconds");
  }
  if (settings.substeps && stepping == Stepping::Adaptive) {
    throw Error(Error::Kind::Unsupported, subject, "substeps", std::to_string(*settings.substeps),
                "it chooses its steps by itself; give a tolerance");
  }
  if (settings.substeps && *settings.substeps < 1) {
    throw Error(Error::Kind::Value, subject, "substeps", std::to_string(*settings.substeps),
                "must be at least 1");
  }
  if (settings.tolerance && stepping == Stepping::Fixed) {
    throw Error(Error::Kind::Unsupported, subject, "tolerance", shortest(*settings.tolerance),
                "it steps by fixed steps; give dt and substeps");
  }
  if (settings.tolerance && !positive(*settings.tolerance)) {
    throw Error(Error::Kind::Value, subject, "tolerance", shortest(*settings.tolerance),
                "must be a positive number");
  }
}

void require_float_step(std::string_view engine, double substep) {
  // Bullet skips a step below its roundoff.
  constexpr double kLeast = 2 * static_cast<double>(std::numeric_limits<float>::epsilon());
  if (substep >= kLeast && substep <= std::numeric_limits<float>::max()) return;
  throw Error(Error::Kind::Value, subject_of(engine), "dt / substeps", shortest(substep),
              "must be at least " + shortest(kLeast) + " s: this engine computes in float");
}

std::string_view name_of(Combine rule) { return kCombineNames[static_cast<std::size_t>(rule)]; }

void append_contact_rules(Settings& out, const Scene& scene) {
  const ContactRules& rules = scene.contact_rules;
  out.emplace_back("friction_rule", name_of(rules.friction));
  out.emplace_back("restitution_rule", name_of(rules.restitution));
  out.emplace_back("restitution_threshold", shortest(rules.restitution_threshold));
}

OptionReader::OptionReader(std::string_view engine, const StepSettings& settings,
                           std::vector<Option> declared)
    : engine_(engine), settings_(settings), declared_(std::move(declared)) {
  std::vector<std::string> names;
  for (const Option& option : declared_) names.push_back(option.name);
  for (const auto& [name, value] : settings.options) {
    bool known = false;
    for (const std::string& each : names) known = known || each == name;
    if (!known) {
      throw Error(Error::Kind::Name, subject_of(engine_) + ": option", "", name,
                  "there is no such option" + did_you_mean(name, names));
    }
  }
}

std::string OptionReader::text(std::string_view name) const {
  const auto given = settings_.options.find(std::string(name));
  if (given != settings_.options.end()) return given->second;
  for (const Option& option : declared_) {
    if (option.name == name) return option.fallback;
  }
  return "";
}

int OptionReader::integer(std::string_view name, int least) const {
  const std::string given = text(name);
  int out = 0;
  if (!parse(given, out) || out < least) {
    throw bad(name, given, "must be a whole number of at least " + std::to_string(least));
  }
  return out;
}

double OptionReader::number(std::string_view name, double least) const {
  const std::string given = text(name);
  double out = 0;
  if (!parse(given, out) || !std::isfinite(out) || out < least) {
    throw bad(name, given, "must be a number of at least " + shortest(least));
  }
  return out;
}

bool OptionReader::toggle(std::string_view name) const {
  return choice<bool>(name, {{"on", true}, {"off", false}});
}

Error OptionReader::bad(std::string_view name, std::string value, std::string problem) const {
  return {Error::Kind::Value, subject_of(engine_), std::string(name), plumb::quoted(value),
          std::move(problem)};
}

Error OptionReader::not_a_choice(std::string_view name, const std::string& given,
                                 const std::vector<std::string>& names) const {
  return bad(name, given, "must be " + listed(names) + did_you_mean(given, names));
}

}  // namespace plumb::reference
