#pragma once

#include <memory>
#include <string>

namespace plumb::harness::cluster {

/// A process's claim to a unit: a file in claims/, created by a hard link so that only one process gets it.
/// Claims only save work: if two processes do the same unit anyway, the results that are moved into place
/// first count.
class Claim {
 public:
  /// Takes the claim to a unit. Returns null if another process holds it, is alive as far as can be known,
  /// and has renewed its claim within `expiry` s by the file system's clock. With `force`, takes the claim
  /// from any holder. Sets `died` if the previous holder was dead. Throws `Error` (Io).
  static std::unique_ptr<Claim> take(const std::string& folder, int number, double expiry, bool force,
                                     bool& died);
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim();  ///< releases the claim if this process still holds it

  void renew() const;
  const std::string& nonce() const { return nonce_; }

 private:
  Claim(std::string path, std::string nonce) : path_(std::move(path)), nonce_(std::move(nonce)) {}
  std::string path_, nonce_;
};

/// Removes the files that dead processes left in claims/: claims to units that are done, and temporary
/// files.
void remove_dead_claims(const std::string& folder, double expiry);

/// Returns true if a unit is claimed by a process that is alive, as far as this machine can know.
bool is_claimed(const std::string& folder, int number, double expiry);

}  // namespace plumb::harness::cluster
