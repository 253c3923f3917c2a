#include "engine/scene/json/json_place.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

#include "engine/scene/subject.h"

namespace plumb::json {
namespace {

std::string string_member(const Node& node, std::string_view name) {
  const Node* member = node.find(name);
  return member != nullptr && member->kind == Kind::String ? member->text : std::string();
}

std::size_t index_in(const Node& list, const Node& item) {
  return static_cast<std::size_t>(&item - list.items.data());
}

/// Returns the subject of entry `item` of `list`; empty if that is not one of the scene's lists.
std::string entry_subject(const Node& list, const Node& item) {
  if (list.kind != Kind::Array) return "";
  const std::size_t index = index_in(list, item);
  if (list.key == "bodies") return body_subject(index, string_member(item, "name"));
  if (list.key == "joints") return joint_subject(index, string_member(item, "name"));
  if (list.key == "forces")
    return force_subject(index, string_member(item, "type"),
                         string_member(item, item.find("body_a") != nullptr ? "body_a" : "body"));
  if (list.key == "drives") return drive_subject(index);
  return "";
}

/// Returns true if errors name the whole list instead of an entry: a position, not its x.
bool is_vector(const Node& list) {
  return list.kind == Kind::Array && list.key != "bodies" && list.key != "joints" && list.key != "forces" &&
         list.key != "drives" && list.key != "shapes" && list.key != "points";
}

const char* list_key(SceneLocation::List list) {
  return list == SceneLocation::List::Bodies   ? "bodies"
         : list == SceneLocation::List::Joints ? "joints"
         : list == SceneLocation::List::Forces ? "forces"
                                               : "drives";
}

/// Removes the first name or index from `field` and returns it: "shapes[1].radius" is shapes, 1, radius.
std::string_view next_step(std::string_view& field) {
  const std::size_t end = std::min(field.find_first_of(".[]"), field.size());
  const std::string_view step = field.substr(0, end);
  field.remove_prefix(std::min(field.find_first_not_of(".[]", end), field.size()));
  return step;
}

const Node* child(const Node& node, std::string_view step) {
  if (node.kind != Kind::Array) return node.find(step);
  std::size_t index = node.items.size();
  std::from_chars(step.data(), step.data() + step.size(), index);
  return index < node.items.size() ? &node.items[index] : nullptr;
}

}  // namespace

Naming naming_of(const std::vector<const Node*>& path) {
  if (path.empty()) return {"scene", ""};
  Naming naming{scene_subject(string_member(*path[0], "name")), ""};
  std::size_t first = 1;
  if (path.size() > 2) {
    if (std::string subject = entry_subject(*path[1], *path[2]); !subject.empty()) {
      naming.subject = std::move(subject);
      first = 3;
    }
  }
  for (std::size_t i = first; i < path.size(); ++i) {
    const Node& parent = *path[i - 1];
    if (is_vector(parent)) break;
    if (parent.kind == Kind::Array) {
      naming.field += "[" + std::to_string(index_in(parent, *path[i])) + "]";
    } else {
      naming.field += (naming.field.empty() ? "" : ".") + path[i]->key;
    }
  }
  return naming;
}

int line_of(const Node& root, const SceneLocation& location, std::string_view field) {
  const Node* node = &root;
  if (location.list != SceneLocation::List::None) {
    const Node* list = root.find(list_key(location.list));
    if (list != nullptr && location.index < list->items.size()) node = &list->items[location.index];
  }
  while (!field.empty()) {
    const Node* next = child(*node, next_step(field));
    if (next == nullptr) break;
    node = next;
  }
  return node->line;
}

}  // namespace plumb::json
