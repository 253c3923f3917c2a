#include "reference/node_engines.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>

#include "reference/guests.h"
#include "reference/process_backend.h"
#include "reference/support/unavailable.h"

namespace plumb::reference {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDefault = "-default";

// Marks a process backend as a guest, with costs of another platform.
class Guest final : public Backend {
 public:
  explicit Guest(std::unique_ptr<Backend> program) : program_(std::move(program)) {}

  std::string_view name() const override { return program_->name(); }
  std::string_view summary() const override { return program_->summary(); }
  Identity identity() const override {
    Identity identity = program_->identity();
    identity.guest = identity.foreign_cost = true;
    return identity;
  }
  std::vector<Option> options() const override { return program_->options(); }
  std::vector<Knob> knobs() const override { return program_->knobs(); }
  Method method(const StepSettings& settings) const override { return program_->method(settings); }
  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    return program_->unsupported(scene, settings);
  }
  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    return program_->effective_settings(scene, settings);
  }
  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return program_->create(scene, settings);
  }

 private:
  std::unique_ptr<Backend> program_;
};

// Function-local static, because registrations run before main in an unspecified order.
std::vector<std::unique_ptr<Backend>>& linked() {
  static std::vector<std::unique_ptr<Backend>> all;
  return all;
}

std::string scripts_folder() {
  if (const char* given = std::getenv("PLUMB_NODE_SCRIPTS"); given != nullptr && *given != 0) return given;
  std::error_code code;
  const fs::path here = fs::read_symlink("/proc/self/exe", code).parent_path();
  for (const char* way : {"../share/plumb/node", "../../../reference/node"})
    if (fs::is_directory(here / way, code)) return (here / way).lexically_normal().string();
  return "";
}

std::string directive(const std::string& script, const std::string& key) {
  std::ifstream file(script);
  const std::string start = "//! " + key + ": ";
  for (std::string line; std::getline(file, line) && line.starts_with("//!");)
    if (line.starts_with(start)) return line.substr(start.size());
  return "";
}

// Returns the numbers of a version, and the text after a hyphen. With such a text, a version is older than
// the same one without.
std::pair<std::vector<int>, std::string> parts_of(std::string_view version) {
  std::vector<int> numbers;
  const std::size_t hyphen = version.find('-');
  std::string_view rest = version.substr(0, hyphen);
  while (!rest.empty()) {
    int number = 0;
    const auto [stop, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    numbers.push_back(number);
    const auto used = static_cast<std::size_t>(stop - rest.data());
    rest.remove_prefix(std::min(rest.size(), used + 1));
  }
  return {numbers, hyphen == std::string_view::npos ? "" : std::string(version.substr(hyphen))};
}

std::unique_ptr<Backend> make_guest(const std::string& name, const NodeEngine& engine, std::string version,
                                    bool out_of_the_box) {
  const std::vector<std::string> there = installed_versions(engine);
  const auto has = [&](const std::string& wanted) {
    return std::find(there.begin(), there.end(), wanted) != there.end();
  };
  if (version.empty()) version = has(engine.version) || there.empty() ? engine.version : there.back();
  if (!has(version))
    return make_unavailable(name, "npm's " + engine.package + " " + version +
                                      " is not installed; `plumb engines --install " + engine.name + "@" +
                                      version + "` does it");
  std::vector<std::string> command{"node", engine.script, folder_of(engine, version)};
  if (out_of_the_box) command.emplace_back("default");
  const std::string summary = directive(engine.script, "summary") +
                              (out_of_the_box ? "; with its default settings" : "; settings equalised");
  return std::make_unique<Guest>(make_process_backend(name, std::move(command), summary));
}

}  // namespace

std::vector<NodeEngine> node_engines() {
  std::vector<NodeEngine> out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(scripts_folder(), code)) {
    if (entry.path().extension() != ".mjs") continue;
    const std::string script = entry.path().string();
    out.push_back(
        {entry.path().stem().string(), directive(script, "package"), directive(script, "version"), script});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return out;
}

std::string engines_folder() {
  const auto given = [](const char* name) -> std::string {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  if (const std::string folder = given("PLUMB_ENGINES"); !folder.empty()) return folder;
  const std::string data = given("XDG_DATA_HOME");
  return (data.empty() ? given("HOME") + "/.local/share" : data) + "/plumb/engines";
}

std::string folder_of(const NodeEngine& engine, const std::string& version) {
  return (fs::path(engines_folder()) / engine.name / version).string();
}

std::vector<std::string> installed_versions(const NodeEngine& engine) {
  std::vector<std::string> out;
  std::error_code code;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(engines_folder()) / engine.name, code))
    if (fs::is_directory(entry.path() / "node_modules" / engine.package, code))
      out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end(), older);
  return out;
}

bool older(std::string_view a, std::string_view b) {
  const auto [a_numbers, a_rest] = parts_of(a);
  const auto [b_numbers, b_rest] = parts_of(b);
  if (a_numbers != b_numbers) return a_numbers < b_numbers;
  if (a_rest.empty() != b_rest.empty()) return !a_rest.empty();
  return a_rest < b_rest;
}

GuestRegistration::GuestRegistration(std::unique_ptr<Backend> backend) {
  linked().push_back(std::move(backend));
}

std::vector<const Backend*> linked_guests() {
  std::vector<const Backend*> all;
  for (const auto& backend : linked()) all.push_back(backend.get());
  std::sort(all.begin(), all.end(), [](auto* a, auto* b) { return a->name() < b->name(); });
  return all;
}

const Backend* find_guest(std::string_view name) {
  for (const Backend* guest : linked_guests())
    if (guest->name() == name) return guest;
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<Backend>> made;
  const std::lock_guard lock(mutex);
  const std::size_t at = name.find('@');
  std::string base(name.substr(0, at)), version(at == std::string_view::npos ? "" : name.substr(at + 1));
  const bool out_of_the_box = base.ends_with(kDefault);
  if (out_of_the_box) base.resize(base.size() - kDefault.size());
  // The version becomes a folder's name.
  const bool sound = std::all_of(version.begin(), version.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '+';
  });
  if (!sound || version.starts_with('.')) return nullptr;
  for (const NodeEngine& engine : node_engines()) {
    if (engine.name != base) continue;
    std::unique_ptr<Backend>& guest = made[std::string(name)];
    if (!guest) guest = make_guest(std::string(name), engine, version, out_of_the_box);
    return guest.get();
  }
  return nullptr;
}

std::vector<const Backend*> guests() {
  std::vector<const Backend*> out = linked_guests();
  for (const NodeEngine& engine : node_engines()) {
    if (installed_versions(engine).empty()) continue;
    out.push_back(find_guest(engine.name));
    out.push_back(find_guest(engine.name + std::string(kDefault)));
  }
  return out;
}

}  // namespace plumb::reference
