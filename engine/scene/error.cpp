#include "engine/scene/error.h"

#include <initializer_list>
#include <string_view>
#include <utility>

#include "engine/core/text.h"

namespace plumb {
namespace {

std::string_view name_of(Error::Kind kind) {
  switch (kind) {
    case Error::Kind::Syntax:
      return "syntax error";
    case Error::Kind::Value:
      return "unacceptable value";
    case Error::Kind::Name:
      return "unacceptable name";
    case Error::Kind::Unsupported:
      return "not supported";
    case Error::Kind::Run:
      return "the run could not go on";
    case Error::Kind::Io:
      return "cannot be opened, read or started";
  }
  return "error";
}

/// Returns `value` for the message; names are quoted.
std::string shown(Error::Kind kind, const std::string& value) {
  const bool bare = kind == Error::Kind::Name && !value.empty() && value[0] != '\'' && value[0] != '"';
  return bare ? quoted(value) : value;
}

/// "mass is -1"; either part may be empty.
std::string field_and_value(const std::string& field, const std::string& value) {
  return field.empty() || value.empty() ? field + value : field + " is " + value;
}

/// "line 12: body 'ball': mass is -1: must be a positive number of kg"; empty parts are left out.
std::string sentence(Error::Kind kind, const std::string& subject, const std::string& field,
                     const std::string& value, const std::string& problem, int line) {
  const std::string place = line > 0 ? "line " + std::to_string(line) : "";
  std::string what = subject;
  const std::string middle = field_and_value(field, shown(kind, value));
  if (!middle.empty()) {
    // A name without a field follows its subject: "scenario 'free_fal'".
    const bool alone = kind == Error::Kind::Name && field.empty();
    if (!what.empty()) what += alone ? " " : ": ";
    what += middle;
  }
  std::string out;
  for (const std::string& part : {place, what, problem.empty() ? std::string(name_of(kind)) : problem}) {
    if (part.empty()) continue;
    if (!out.empty()) out += ": ";
    out += part;
  }
  return out;
}

}  // namespace

Error::Error(Kind kind, std::string subject, std::string field, std::string value, std::string problem,
             int line)
    : std::runtime_error(sentence(kind, subject, field, value, problem, line)),
      kind_(kind),
      subject_(std::move(subject)),
      field_(std::move(field)),
      value_(std::move(value)),
      problem_(std::move(problem)),
      line_(line) {}

}  // namespace plumb
