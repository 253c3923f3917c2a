#pragma once

#include <cstdio>
#include <iosfwd>

#include "reference/backend.h"

namespace plumb::reference {

/// Answers the process protocol on standard input and output with `backend`, until "quit" or the end of the
/// input. `int main() { return serve(*make_my_backend()); }` makes any adapter a worker. The engine's own
/// output on standard output is redirected to standard error. Returns the exit code.
int serve(const Backend& backend);

/// Does the same between `requests` and `answers`, without redirecting the engine's own output.
int serve(const Backend& backend, std::istream& requests, std::FILE* answers);

}  // namespace plumb::reference
