#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

/// The program `plumb` as its users have it: arguments in, stdout, stderr and an exit code out.
namespace plumb::app {

struct Ran {
  int code = -1;  ///< exit code; -signal where it was killed
  std::string out, err;
};

/// Runs `plumb` with `arguments`; `environment` holds more variables ("NO_COLOR=1"), `input` goes to stdin.
Ran plumb(std::vector<std::string> arguments, std::vector<std::string> environment = {},
          const std::string& input = "");

/// Starts `plumb`; its stdout goes to /dev/null. The caller waits for it.
pid_t start_plumb(std::vector<std::string> arguments);

/// Waits; the exit code, or -signal.
int wait_for(pid_t process);

/// A folder of its own that is gone with it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path(const std::string& name = "") const;
  std::string write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

std::vector<std::string> lines_of(const std::string& text);

/// Bad usage: exit code 2, nothing on stdout, one line on stderr. `what` was run, for the message.
void expect_refused(const Ran& ran, const std::string& what);

}  // namespace plumb::app
