//! cmake: include(bullet/double.cmake)
//! link: plumb_with_bullet_double
//! missing: Bullet's double build was not found; install libbullet-dev and pkg-config and build again

// Bullet in double, over the process protocol: workers/bullet_double.cpp is the other end.
#include "reference/process_backend.h"

namespace plumb::reference {
namespace {

const Registration registration{make_process_backend("bullet-double", {"plumb-worker-bullet-double"},
                                                     "Bullet 3 in double, held to the plane")};

}  // namespace
}  // namespace plumb::reference
