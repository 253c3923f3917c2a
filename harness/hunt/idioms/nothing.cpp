#include "harness/hunt/idiom.h"

namespace plumb::harness::hunt {
namespace {

const Register r{
    {.name = "nothing", .title = "no ground", .role = Idiom::Role::Support, .weight = 3, .build = [](Draft&) {
     }}};

}  // namespace
}  // namespace plumb::harness::hunt
