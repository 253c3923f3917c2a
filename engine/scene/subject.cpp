#include "engine/scene/subject.h"

#include "engine/core/text.h"

namespace plumb {
namespace {

std::string named(const std::string& thing, std::size_t index, std::string_view name) {
  return thing + " " + (name.empty() ? std::to_string(index) : quoted(name));
}

}  // namespace

std::string scene_subject(std::string_view name) { return name.empty() ? "scene" : "scene " + quoted(name); }

std::string body_subject(std::size_t index, std::string_view name) { return named("body", index, name); }

std::string joint_subject(std::size_t index, std::string_view name) { return named("joint", index, name); }

std::string force_subject(std::size_t index, std::string_view law, std::string_view body) {
  std::string details(law);
  if (!body.empty()) details += (details.empty() ? "on " : " on ") + quoted(body);
  return "force " + std::to_string(index) + (details.empty() ? "" : " (" + details + ")");
}

std::string drive_subject(std::size_t index) { return "drive " + std::to_string(index); }

}  // namespace plumb
