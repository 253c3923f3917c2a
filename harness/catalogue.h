#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

namespace plumb::harness {

/// "closed_form", "integrated" or "equilibrium".
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
};

/// Which cases to list.
struct CatalogueFilter {
  std::string text{};   ///< of the label, the summary or the source, in any case; empty: all
  std::string truth{};  ///< name of a kind; empty: all
};

/// Returns the cases that pass `filter`, by topic and then by name.
std::vector<CatalogueEntry> catalogue(const CatalogueFilter& filter = {});

/// Returns docs/scenarios.md: every case with its source, in Markdown.
std::string catalogue_page();

}  // namespace plumb::harness
