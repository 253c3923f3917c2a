#pragma once

#include <stdexcept>
#include <string>

namespace plumb {

/// A problem with a scene, a setting or a run that plumb cannot accept. `what()` is the whole sentence; the
/// parts are for programs.
class Error : public std::runtime_error {
 public:
  enum class Kind {
    Syntax,       ///< not JSON, or JSON of the wrong shape
    Value,        ///< a value out of its range: NaN, negative mass, dt <= 0
    Name,         ///< an unknown or duplicate name
    Unsupported,  ///< well formed, but not supported by this driver or engine
    Run,          ///< the run could not continue: a non-finite state, a work limit
    Io,           ///< a file or a program that cannot be opened, read or started
  };

  /// `subject` names the thing ("body 'ball'"), `field` its member ("mass"), `value` the value given,
  /// `problem` the problem and its remedy; `line` is 1-based, 0 without a text.
  Error(Kind kind, std::string subject, std::string field, std::string value, std::string problem,
        int line = 0);

  Kind kind() const { return kind_; }
  const std::string& subject() const { return subject_; }
  const std::string& field() const { return field_; }
  const std::string& value() const { return value_; }
  const std::string& problem() const { return problem_; }
  int line() const { return line_; }

  /// Returns the same error with a line of a text.
  Error at_line(int line) const { return {kind_, subject_, field_, value_, problem_, line}; }

 private:
  Kind kind_;
  std::string subject_, field_, value_, problem_;
  int line_;
};

}  // namespace plumb
