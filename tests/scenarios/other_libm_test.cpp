// Scenes under another libm: this program has functions of libm whose last bits can be changed.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/scene/json.h"
#include "scenarios/scenario.h"

namespace {

bool off = false;  // true: results are one unit in the last place too large

template <class Real>
Real moved(Real value) {
  return off ? std::nextafter(value, std::numeric_limits<Real>::infinity()) : value;
}

template <class Function>
Function libm(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// The linker takes these instead of libm's.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define OTHER_1(name, Real)                              \
  extern "C" Real name(Real x) noexcept {                \
    static const auto own = libm<Real (*)(Real)>(#name); \
    return moved(own(x));                                \
  }
#define OTHER_2(name, Real)                                    \
  extern "C" Real name(Real x, Real y) noexcept {              \
    static const auto own = libm<Real (*)(Real, Real)>(#name); \
    return moved(own(x, y));                                   \
  }
#define OTHER_SINCOS(name, Real)                                       \
  extern "C" void name(Real x, Real* sine, Real* cosine) noexcept {    \
    static const auto own = libm<void (*)(Real, Real*, Real*)>(#name); \
    own(x, sine, cosine);                                              \
    *sine = moved(*sine), *cosine = moved(*cosine);                    \
  }
#define OTHER(name, kind) OTHER_##kind(name, double) OTHER_##kind(name##l, long double)
OTHER(sin, 1)
OTHER(cos, 1)
OTHER(tan, 1)
OTHER(asin, 1)
OTHER(acos, 1)
OTHER(atan, 1)
OTHER(exp, 1)
OTHER(log, 1)
OTHER(cbrt, 1)
OTHER(sinh, 1)
OTHER(cosh, 1)
OTHER(tanh, 1)
OTHER(expm1, 1)
OTHER(atan2, 2)
OTHER(hypot, 2)
OTHER(pow, 2)
OTHER(sincos, SINCOS)
// NOLINTEND(bugprone-macro-parentheses)

namespace plumb::scenarios {
namespace {

// libm's last bits differ by platform. The numbers of a scene must not depend on them, or its states do.
TEST(OtherLibm, LeavesEverySceneAsItIs) {
  volatile double one = 1;
  const double usual = std::sin(one);
  off = true;
  EXPECT_NE(std::sin(one), usual) << "the functions above are not those that are called";
  off = false;
  for (const Scenario& scenario : all()) {
    for (const Instance& instance : select(scenario.name)) {
      const std::string scene = to_json(instance.build().scene);
      off = true;
      const std::string other = to_json(instance.build().scene);
      off = false;
      EXPECT_EQ(other, scene) << instance.label();
    }
  }
}

}  // namespace
}  // namespace plumb::scenarios
