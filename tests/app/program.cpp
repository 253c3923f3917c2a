#include "tests/app/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace plumb::app {
namespace {

[[noreturn]] void become_plumb(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), PLUMB_PROGRAM);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  _exit(127);
}

void redirect(const std::string& path, int flags, int descriptor) {
  const int file = open(path.c_str(), flags, 0600);
  if (file < 0) _exit(126);
  dup2(file, descriptor);
}

}  // namespace

int wait_for(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

Ran plumb(std::vector<std::string> arguments, std::vector<std::string> environment,
          const std::string& input) {
  const Folder folder;
  folder.write("in", input);
  const pid_t process = fork();
  if (process == 0) {
    for (std::string& variable : environment) putenv(variable.data());
    redirect(folder.path("in"), O_RDONLY, STDIN_FILENO);
    redirect(folder.path("out"), O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect(folder.path("err"), O_WRONLY | O_CREAT, STDERR_FILENO);
    become_plumb(std::move(arguments));
  }
  Ran ran;
  ran.code = wait_for(process);
  ran.out = folder.read("out");
  ran.err = folder.read("err");
  return ran;
}

pid_t start_plumb(std::vector<std::string> arguments) {
  const pid_t process = fork();
  if (process == 0) {
    redirect("/dev/null", O_WRONLY, STDOUT_FILENO);
    redirect("/dev/null", O_WRONLY, STDERR_FILENO);
    become_plumb(std::move(arguments));
  }
  return process;
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "plumb-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for a test");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::path(const std::string& name) const {
  return name.empty() ? path_.string() : (path_ / name).string();
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::string Folder::read(const std::string& name) const {
  std::ifstream file(path(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void expect_refused(const Ran& ran, const std::string& what) {
  EXPECT_EQ(ran.code, 2) << what << "\n" << ran.err;
  EXPECT_EQ(ran.out, "") << what;
  const std::vector<std::string> lines = lines_of(ran.err);
  EXPECT_EQ(lines.size(), 1u) << what << "\n" << ran.err;
  EXPECT_TRUE(lines.empty() || lines.back().starts_with("plumb:")) << what << "\n" << ran.err;
}

}  // namespace plumb::app
