#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/scene/error.h"
#include "engine/scene/scene.h"
#include "reference/backend.h"

/// Helpers for adapters that read settings and print those in effect.
namespace plumb::reference {

/// The members of `StepSettings` that an engine takes.
enum class Stepping { Fixed, Adaptive };

/// Throws `Error` (Value) unless dt is positive and finite, substeps >= 1 and tolerance positive and finite,
/// and `Error` (Unsupported) for substeps of an adaptive engine or a tolerance of a fixed-step one.
void check_steps(std::string_view engine, const StepSettings& settings, Stepping stepping);

/// Throws `Error` (Value) for a substep, in s, that would vanish by rounding in an engine whose time is in
/// float.
void require_float_step(std::string_view engine, double substep);

/// Returns the combine rule's name in scene files.
std::string_view name_of(Combine rule);

/// Appends the scene's contact rules, which every adapter equalises.
void append_contact_rules(Settings& out, const Scene& scene);

/// Reads an engine's options, or their fallbacks. Every reader throws `Error` (Value) with the option's name,
/// the given value and the permitted ones.
class OptionReader {
 public:
  /// Throws `Error` (Name) for an option that is not among `declared`, and suggests the nearest.
  OptionReader(std::string_view engine, const StepSettings& settings, std::vector<Option> declared);

  std::string text(std::string_view name) const;
  int integer(std::string_view name, int least) const;
  double number(std::string_view name, double least) const;
  bool toggle(std::string_view name) const;  ///< "on" or "off"

  /// Returns the value for the given name.
  template <class Value>
  Value choice(std::string_view name, const std::vector<std::pair<std::string, Value>>& choices) const {
    const std::string given = text(name);
    std::vector<std::string> names;
    for (const auto& [text, value] : choices) {
      if (text == given) return value;
      names.push_back(text);
    }
    throw not_a_choice(name, given, names);
  }

 private:
  Error bad(std::string_view name, std::string value, std::string problem) const;
  Error not_a_choice(std::string_view name, const std::string& given,
                     const std::vector<std::string>& names) const;

  std::string engine_;
  const StepSettings& settings_;
  std::vector<Option> declared_;
};

}  // namespace plumb::reference
