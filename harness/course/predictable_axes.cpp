#include <fmt/format.h>

#include "harness/course/predictable.h"

// The mistakes that mix up the x and y of a vector: each vector of an engine, in each possible way.
namespace plumb::course {
namespace {

struct Vector {
  const char* quantity;  ///< name for the learner's engine
  const char* chapters;
  const char* what;
};

constexpr Vector kVectors[] = {
    {"gravity", "1", "gravity"},
    {"velocity in the position's change", "1", "the velocity by which a position changes"},
    {"force", "2", "a force"},
    {"drag", "2", "drag"},
    {"direction of a spring", "2", "a spring's direction"},
    {"velocity in a spring", "2", "the velocity that damps a spring"},
    {"velocity in a contact", "134", "the velocity in vn = (vb - va) . n"},
    {"velocity before a bounce", "134", "the velocity in vn = (vb - va) . n, of which a bounce gives back e"},
    {"velocity in an impulse", "134", "the velocity in vn = (vb - va) . n, which the impulse changes"},
    {"impulse of a contact", "134", "the impulse of a contact"},
    {"impulse on the first", "34", "the impulse on the first body"},
    {"impulse on the second", "34", "the impulse on the second body"},
    {"push out of an overlap", "134", "the correction of an overlap"},
    {"tangent", "4", "the tangent (-ny, nx)"},
    {"direction of friction", "4", "the tangent (-ny, nx) of friction's speed and impulse"},
    {"w x r", "45", "w x r = (-w ry, w rx), a point's velocity by its spin"},
    {"velocity in a joint", "5", "the velocity in a joint's dC/dt"},
    {"impulse of a joint", "5", "the impulse of a joint"},
    {"error of a joint", "5", "the correction of a joint's positions"},
};

struct Mix {
  const char *axes, *name, *says;
};

constexpr Mix kMixes[] = {
    {"y,x", "axes_mixed", "The x and y of {} are swapped."},
    {"x,x", "axes_mixed", "The y of {} is taken from its x."},
    {"y,y", "axes_mixed", "The x of {} is taken from its y."},
    {"-x,y", "axis_reversed", "The x of {} has the wrong sign."},
    {"x,-y", "axis_reversed", "The y of {} has the wrong sign."},
    {"0,y", "axis_left_out", "The x of {} is left out."},
    {"x,0", "axis_left_out", "The y of {} is left out."},
};

}  // namespace

std::vector<Predictable> mistakes_of_axes() {
  std::vector<Predictable> out;
  for (const Vector& vector : kVectors)
    for (const Mix& mix : kMixes)
      out.push_back({fmt::format("{}@{}", vector.quantity, mix.axes), mix.name, vector.chapters,
                     fmt::format(fmt::runtime(mix.says), vector.what), true});
  return out;
}

}  // namespace plumb::course
