// Bullet's articulated bodies in double as a worker: docs/protocol.md on standard input and output.
#include "reference/bullet/multibody.h"
#include "reference/support/serve.h"

int main() {
  using namespace plumb::reference;
  return serve(*make_bullet_multibody_backend(
      "bullet-multibody", "Bullet's articulated bodies in double, joint angles as coordinates"));
}
