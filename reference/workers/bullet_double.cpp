// Bullet's double build as a worker: docs/protocol.md on standard input and output.
#include "reference/bullet/backend.h"
#include "reference/support/serve.h"

int main() {
  using namespace plumb::reference;
  return serve(*make_bullet_backend("bullet-double", "Bullet in double, in a program of its own"));
}
