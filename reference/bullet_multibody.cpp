//! cmake: include(bullet/double.cmake)
//! link: plumb_with_bullet_double
//! missing: Bullet's double build was not found; install libbullet-dev and pkg-config and build again

// Bullet's articulated bodies in double, over the process protocol: workers/bullet_multibody.cpp is the other
// end.
#include "reference/process_backend.h"

namespace plumb::reference {
namespace {

const Registration registration{
    make_process_backend("bullet-multibody", {"plumb-worker-bullet-multibody"},
                         "Bullet's articulated bodies in double, joint angles as coordinates")};

}  // namespace
}  // namespace plumb::reference
