// Ten million steps of a pendulum.
#include <gtest/gtest.h>

#include "tests/extremes/figures.h"

namespace plumb::test {
namespace {

TEST(LongRun, APendulumKeepsItsEnergyForTenMillionStepsInAWorld) {
  for (const Engine engine : {Engine::World, Engine::DoubleWorld}) {
    const double change = energy_change(engine, 10'000'000);
    report(name_of(engine), change);
    EXPECT_LT(change, 1e-3);
  }
}

TEST(LongRun, APendulumKeepsItsEnergyForTenMillionStepsInPrecise) {
  const double change = energy_change(Engine::Precise, 10'000'000);
  report("Precise", change);
  EXPECT_LT(change, 1e-8);
}

}  // namespace
}  // namespace plumb::test
