#pragma once

#include <stdexcept>
#include <string>

namespace plumb {

/// Something about a scene, a setting or a run that plumb cannot accept. `what()` is the whole sentence;
/// the parts are there for programs.
class Error : public std::runtime_error {
 public:
  enum class Kind {
    Syntax,       ///< not JSON, or JSON of the wrong shape
    Value,        ///< a value out of its range: NaN, negative mass, dt <= 0
    Name,         ///< an unknown or duplicate name
    Unsupported,  ///< well formed, but not something that this driver or engine does
    Run,          ///< the run could not go on: a state that is not finite, a work limit
    Io,           ///< a file or a program that cannot be opened, read or started
  };

  /// `subject` names the thing ("body 'ball'"), `field` its member ("mass"), `value` what was given,
  /// `problem` what is wrong and what to do; `line` is 1-based, 0 when there is no text.
  Error(Kind kind, std::string subject, std::string field, std::string value, std::string problem,
        int line = 0);

  Kind kind() const { return kind_; }
  const std::string& subject() const { return subject_; }
  const std::string& field() const { return field_; }
  const std::string& value() const { return value_; }
  const std::string& problem() const { return problem_; }
  int line() const { return line_; }

  /// The same error, placed at a line of a text.
  Error at_line(int line) const { return {kind_, subject_, field_, value_, problem_, line}; }

 private:
  Kind kind_;
  std::string subject_, field_, value_, problem_;
  int line_;
};

}  // namespace plumb
