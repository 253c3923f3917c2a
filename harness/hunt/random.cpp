#include "harness/hunt/random.h"

#include <array>
#include <cmath>

namespace plumb::harness::hunt {
namespace {

// Mixes the bits of a number. Source: splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

constexpr std::array<double, 10> kRungs{1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8};
// Literals, which are rounded once; a product of tens would be rounded at each factor.
constexpr std::array<double, 19> kTens{1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1,
                                       1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9};

double rung(int index) {
  return kRungs[static_cast<std::size_t>(index % 10)] * kTens[static_cast<std::size_t>(index / 10)];
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t index) : engine_(mixed(mixed(seed) ^ index)) {}

double Random::unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double Random::within(double low, double high) {
  return low + (high - low) * (std::floor(unit() * 1001) / 1000);
}

int Random::whole(int low, int high) { return low + static_cast<int>(unit() * (high - low + 1)); }

bool Random::chance(double probability) { return unit() < probability; }

double Random::ladder(double low, double high) {
  int first = 0, last = 189;
  while (first < last && rung(first) < low * (1 - 1e-12)) ++first;
  while (last > first && rung(last) > high * (1 + 1e-12)) --last;
  return rung(whole(first, last));
}

}  // namespace plumb::harness::hunt
