#include "extremes/parts/overlap.h"

namespace plumb::extremes {
namespace {

const Register r{
    {.name = "overlap_boxes",
     .title = "two free boxes of 1 m overlap at the start, for 5 s",
     .axis = "overlap / size",
     .values = {0, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.9, 1},
     .usual = 0,
     .rule = "never faster than 10 m/s (the speed after a fall of 5 m), overlap at the end at most 1 cm",
     .build = [](double share) {
       return overlapping("overlap_boxes", Box{1, 1}, share);
     }}};

}  // namespace
}  // namespace plumb::extremes
