#include "engine/math/rotations.h"

#include <cmath>
#include <cstddef>
#include <iterator>

#include "engine/math/four.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

// pi as parts of 33 bits and a remainder. A part times a number of half turns below 2^20 is exact.
constexpr double kPi1 = 0x1.921fb544p+1, kPi2 = 0x1.0b4611a6p-33, kPiRest = 0x1.3198a2e037073p-68;
constexpr double kMaxPosition = 0x1p20;

// Coefficients of sin r = r + r^3 (...) and cos r = 1 - r^2/2 + r^4 (...), from the highest power of r^2
// down.
constexpr double kSine[] = {1.0 / 51090942171709440000.0,
                            -1.0 / 121645100408832000,
                            1.0 / 355687428096000,
                            -1.0 / 1307674368000,
                            1.0 / 6227020800,
                            -1.0 / 39916800,
                            1.0 / 362880,
                            -1.0 / 5040,
                            1.0 / 120,
                            -1.0 / 6};
constexpr double kCosine[] = {-1.0 / 1124000727777607680000.0,
                              1.0 / 2432902008176640000,
                              -1.0 / 6402373705728000,
                              1.0 / 20922789888000,
                              -1.0 / 87178291200,
                              1.0 / 479001600,
                              -1.0 / 3628800,
                              1.0 / 40320,
                              -1.0 / 720,
                              1.0 / 24};

constexpr std::size_t kLanes = 4;

/// Computes cosine and sine of angle = n pi + r, |r| <= pi/2, by Taylor's series; the first terms left out
/// are below 1e-17.
void four_rotations(const double* angle, double* cosine, double* sine) {
  using Four = Four<double>;
  const auto all = [](double x) { return Four(x); };
  const Four to_integer = all(0x1.8p52),
             over_pi = all(0x1.45f306dc9c883p-2);  // adding it rounds to an integer
  const Four x = Four::load(angle);
  const Four n = (x * over_pi + to_integer) - to_integer;
  const Four r = ((x - n * all(kPi1)) - n * all(kPi2)) - n * all(kPiRest);
  const Four odd = n - all(2) * ((all(0.5) * n + to_integer) - to_integer);  // -1, 0 or 1
  const Four sign = all(1) - all(2) * odd * odd;
  const Four z = r * r;
  Four s = all(kSine[0]), c = all(kCosine[0]);
  for (std::size_t k = 1; k < std::size(kSine); ++k) s = all(kSine[k]) + z * s, c = all(kCosine[k]) + z * c;
  (sign * (r + r * z * s)).store(sine);
  (sign * ((all(1) - all(0.5) * z) + z * z * c)).store(cosine);
}

}  // namespace

void rotations_of(std::span<const double> angles, std::span<double> cosines, std::span<double> sines) {
  const std::size_t count = angles.size(), whole = count - count % kLanes;
  bool far = false;
  for (const double angle : angles) far |= !(std::abs(angle) <= kMaxPosition);
  if (far) {
    for (std::size_t i = 0; i < count; ++i) {
      const Rotation<double> q = rotation_of(angles[i]);
      cosines[i] = q.c, sines[i] = q.s;
    }
    return;
  }
  for (std::size_t i = 0; i < whole; i += kLanes) four_rotations(&angles[i], &cosines[i], &sines[i]);
  if (whole == count) return;
  double rest[kLanes] = {}, c[kLanes], s[kLanes];
  for (std::size_t i = whole; i < count; ++i) rest[i - whole] = angles[i];
  four_rotations(rest, c, s);
  for (std::size_t i = whole; i < count; ++i) cosines[i] = c[i - whole], sines[i] = s[i - whole];
}

}  // namespace plumb
