// Serves the engine that its argument names, to be compared with the same engine called directly.
#include <cstdio>

#include "reference/backend.h"
#include "reference/support/serve.h"

int main(int count, char** arguments) {
  using namespace plumb::reference;
  if (count != 2) {
    std::fputs("usage: plumb_test_worker ENGINE\n", stderr);
    return 2;
  }
  return serve(find_backend(arguments[1]));
}
