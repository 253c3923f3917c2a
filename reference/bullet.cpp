//! cmake: include(bullet/float.cmake)
//! link: plumb_bullet_float
//! missing: Bullet was not found; install libbullet-dev and build again

// Bullet in float, linked in: see bullet/backend.h.
#include "reference/backend.h"
#include "reference/bullet/backend.h"

namespace plumb::reference {
namespace {

const Registration registration{make_bullet_backend("bullet", "Bullet 3 in float, held to the plane")};

}  // namespace
}  // namespace plumb::reference
