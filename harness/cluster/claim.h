#pragma once

#include <memory>
#include <string>

namespace plumb::harness::cluster {

/// A process's claim to a unit: a file in claims/ that a link creates, so that one of several gets it. Claims
/// spare work, no more: a unit that two do after all is renamed to its place by the first alone.
class Claim {
 public:
  /// Takes the claim to a unit. Returns nothing if another holds it: one whose process lives, as far as can
  /// be known, and that was renewed within `expiry` s by the clock of the file system. With `force` it takes
  /// it from whoever holds it. `died` is set if it was a dead one's. Throws `Error` (Io).
  static std::unique_ptr<Claim> take(const std::string& folder, int number, double expiry, bool force,
                                     bool& died);
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim();  ///< gives it up if it is still this one's

  void renew() const;
  const std::string& nonce() const { return nonce_; }

 private:
  Claim(std::string path, std::string nonce) : path_(std::move(path)), nonce_(std::move(nonce)) {}
  std::string path_, nonce_;
};

/// Removes what dead processes have left of claims: to units that are done, and while they took one.
void remove_dead_claims(const std::string& folder, double expiry);

/// Returns true if a unit is claimed by a process that lives, as far as this machine's clock can tell.
bool is_claimed(const std::string& folder, int number, double expiry);

}  // namespace plumb::harness::cluster
