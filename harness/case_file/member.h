#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::harness::case_file {

using Json = nlohmann::ordered_json;

/// A value in a case file, with its path for errors: "expect[0].tolerance". The document must outlive it.
class Member {
 public:
  Member(const Json& json, std::string file, std::string path = "")
      : json_(&json), file_(std::move(file)), path_(std::move(path)) {}

  [[noreturn]] void fail(Error::Kind kind, const std::string& problem) const {
    const std::string value = json_->is_primitive() ? text_or_dump() : "";
    throw Error(kind, "case file " + plumb::quoted(file_), path_, printable(value), problem);
  }

  bool has(const char* key) const { return json_->is_object() && json_->contains(key); }

  Member at(const std::string& key) const {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!json_->is_object()) fail(Error::Kind::Syntax, "must be an object {...}");
    if (!json_->contains(key))
      throw Error(Error::Kind::Syntax, "case file " + plumb::quoted(file_), path, "", "is missing");
    return {json_->at(key), file_, path};
  }

  /// Throws for a member that is not in `keys`.
  void only(std::initializer_list<const char*> keys) const {
    if (!json_->is_object()) fail(Error::Kind::Syntax, "must be an object {...}");
    const std::vector<std::string> known(keys.begin(), keys.end());
    for (const auto& [key, value] : json_->items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        at(key).fail(Error::Kind::Name, "is not a member of this object" + did_you_mean(key, known));
  }

  bool is_text() const { return json_->is_string(); }
  bool is_number() const { return json_->is_number(); }
  bool is_list() const { return json_->is_array(); }

  double number() const {
    if (!json_->is_number()) fail(Error::Kind::Syntax, "must be a number");
    return json_->get<double>();
  }

  std::string text() const {
    if (!json_->is_string()) fail(Error::Kind::Syntax, "must be a string \"...\"");
    return json_->get<std::string>();
  }

  std::string dump() const { return json_->dump(-1, ' ', false, Json::error_handler_t::replace); }
  std::string text_or_dump() const { return json_->is_string() ? json_->get<std::string>() : dump(); }

  /// Calls `visit` with each entry of a list.
  template <class Visit>
  void each(Visit visit) const {
    if (!json_->is_array()) fail(Error::Kind::Syntax, "must be a list [...]");
    for (std::size_t i = 0; i < json_->size(); ++i)
      visit(Member((*json_)[i], file_, path_ + "[" + std::to_string(i) + "]"));
  }

  /// Calls `visit` with the name and the value of each member.
  template <class Visit>
  void each_member(Visit visit) const {
    if (!json_->is_object()) fail(Error::Kind::Syntax, "must be an object {...}");
    for (const auto& [key, value] : json_->items()) visit(key, at(key));
  }

  /// Returns the result of `work`; adds this file and member to an error thrown in it.
  template <class Work>
  auto naming(Work work) const {
    try {
      return work();
    } catch (const Error& error) {
      std::string problem = error.field().empty() ? error.problem() : error.field() + " " + error.problem();
      if (error.subject() != "formula") problem = error.subject() + ": " + problem;
      if (error.line() > 0) problem += " (line " + std::to_string(error.line()) + ")";
      throw Error(error.kind(), "case file " + plumb::quoted(file_), path_, error.value(), problem);
    }
  }

 private:
  const Json* json_;
  std::string file_, path_;
};

}  // namespace plumb::harness::case_file
