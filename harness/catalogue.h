#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/agreement.h"
#include "scenarios/scenario.h"

namespace plumb::harness {

/// Returns "closed_form", "integrated" or "equilibrium".
std::string_view name_of(scenarios::TruthKind kind);

/// Topic of a case, from its scene: joints before contacts, contacts before forces.
enum class Topic { FreeMotion, Forces, Joints, Impacts, LastingContacts, Equilibrium };
std::string_view name_of(Topic topic);  ///< for headings: "lasting contacts"

/// One case with its entries in the catalogue.
struct CatalogueEntry {
  scenarios::Instance instance;
  Topic topic{};
  scenarios::TruthKind kind{};
  std::string source;
  std::vector<std::string> needs{};  ///< see `needs_of`
};

/// Which cases to list.
struct CatalogueFilter {
  std::string text{};                ///< of the label, the summary or the source, ignoring case; empty: all
  std::string truth{};               ///< name of a kind; empty: all
  std::vector<std::string> needs{};  ///< names from `all_needs`: cases that need each of them
};

/// Returns the cases that pass `filter`, by topic and then by name.
std::vector<CatalogueEntry> catalogue(const CatalogueFilter& filter = {});

/// Returns docs/scenarios.md: every case with its picture, its source and the engines that agree on it, in
/// Markdown. `agreement` has the engines that agree; cases that are not in it show none. Second rows of
/// engines, whose names end in "-default", are left out.
std::string catalogue_page(std::span<const Agreement> agreement);

/// Returns the pictures that the page shows, by their file names.
std::map<std::string, std::string> catalogue_pictures();

}  // namespace plumb::harness
