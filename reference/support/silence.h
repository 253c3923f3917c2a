#pragma once

namespace plumb::reference {

/// Drops what is written to standard output during its life, for libraries that greet there: only data may
/// go to it. What was printed before still arrives. Not for use beside threads that print.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int output_ = -1;  // the file that standard output was; -1 if it was closed
};

}  // namespace plumb::reference
