#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "reference/backend.h"

/// Guests are engines whose misses are reported and fail nothing. Those that are linked in add themselves
/// with a `GuestRegistration`; others come from npm (node_engines.h). `backends` leaves them out,
/// `find_backend` finds them.
namespace plumb::reference {

/// Adds a guest that lives as long as the program.
struct GuestRegistration {
  explicit GuestRegistration(std::unique_ptr<Backend> backend);
};

/// Returns the guests that are linked in, by name. Names that end in "-default" are second rows: the engine
/// with its own settings out of the box, in place of the equalised ones.
std::vector<const Backend*> linked_guests();

/// Returns these, and those from npm of which a version is installed, each in both rows.
std::vector<const Backend*> guests();

/// Returns the guest called `name`: one that is linked in, or one from npm: an engine's own ("rapier"), in a
/// version
/// ("rapier@0.19.3"), or out of the box ("rapier-default", "rapier-default@0.19.3"). Without a version it is
/// the script's, else the newest that is installed. A guest that is not installed is not available, with the
/// command that installs it. Null if there is no such name.
const Backend* find_guest(std::string_view name);

}  // namespace plumb::reference
