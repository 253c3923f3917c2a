#include "extremes/parts/overlap.h"

namespace plumb::extremes {
namespace {

const Register r{
    {.name = "overlap_discs",
     .title = "two free discs of 1 m start in each other, for 5 s",
     .axis = "share of the size",
     .values = {0, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.9, 1},
     .usual = 0,
     .rule = "never faster than 10 m/s (a drop from 5 m), and at most 1 cm in each other at the end",
     .build = [](double share) { return overlapping("overlap_discs", Circle{0.5}, share); }}};

}  // namespace
}  // namespace plumb::extremes
