#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "reference/backend.h"

/// Guests are engines whose misses are reported but are not failures. Guests that are linked in add
/// themselves with a `GuestRegistration`; others come from npm (node_engines.h). `backends` leaves guests
/// out, `find_backend` finds them.
namespace plumb::reference {

/// Adds a guest that lives as long as the program.
struct GuestRegistration {
  explicit GuestRegistration(std::unique_ptr<Backend> backend);
};

/// Returns the guests that are linked in, by name. Names that end in "-default" are second rows: the same
/// engine with its own default settings instead of the equalised ones.
std::vector<const Backend*> linked_guests();

/// Returns these guests, and those from npm of which a version is installed, each in both rows.
std::vector<const Backend*> guests();

/// Returns the guest called `name`: one that is linked in, or one from npm. A name from npm is that of an
/// engine ("rapier"), of a version ("rapier@0.19.3"), or of either with its own default settings
/// ("rapier-default", "rapier-default@0.19.3"). Without a version it is the script's version, else the newest
/// installed one. A guest that is not installed is returned as unavailable, with the command that installs
/// it. Null if there is no such name.
const Backend* find_guest(std::string_view name);

}  // namespace plumb::reference
