#include "reference/support/unavailable.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/scene/error.h"

namespace plumb::reference {
namespace {

class Unavailable final : public Backend {
 public:
  Unavailable(std::string name, std::string reason) : name_(std::move(name)), reason_(std::move(reason)) {
    // Adapters are named after their files, whose names have no hyphens.
    std::replace(name_.begin(), name_.end(), '_', '-');
  }

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return "not available in this build"; }
  Identity identity() const override { return {.available = false, .reason = reason_}; }
  Method method(const StepSettings&) const override { throw error(); }
  std::string unsupported(const Scene&, const StepSettings&) const override { return reason_; }
  Settings effective_settings(const Scene&, const StepSettings&) const override { return {}; }
  std::unique_ptr<Simulator> create(const Scene&, const StepSettings&) const override { throw error(); }

 private:
  Error error() const { return {Error::Kind::Unsupported, "engine '" + name_ + "'", "", "", reason_}; }

  std::string name_, reason_;
};

}  // namespace

std::unique_ptr<Backend> make_unavailable(std::string name, std::string reason) {
  return std::make_unique<Unavailable>(std::move(name), std::move(reason));
}

}  // namespace plumb::reference
