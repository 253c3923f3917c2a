#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "harness/course/predictable.h"

// The mistakes that mix up the x and y of a vector: each vector of an engine, in each possible way. Then the
// mistakes of motion and of forces that are made in one of the two components only.
namespace plumb::course {
namespace {

struct Vector {
  const char* quantity;  ///< name for the learner's engine
  const char* chapters;
  const char* what;
};

constexpr Vector kVectors[] = {
    {"gravity", "1", "gravity"},
    {"first velocity", "1", "the velocity at the start"},
    {"first position", "1", "the position at the start"},
    {"velocity in the position's change", "1", "the velocity by which a position changes"},
    {"force", "2", "a force"},
    {"drag", "2", "drag"},
    {"direction of a spring", "2", "a spring's direction"},
    {"velocity in a spring", "2", "the velocity that damps a spring"},
    {"normal of a wall", "1", "a wall's normal"},
    {"normal of two circles", "3", "the normal of two circles"},
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
    {"|x|,|y|", "sign_lost", "The x and y of {} lose their signs, as by abs()."},
    {"|x|,y", "sign_lost", "The x of {} loses its sign, as by abs()."},
    {"x,|y|", "sign_lost", "The y of {} loses its sign, as by abs()."},
    {"-|x|,-|y|", "sign_lost", "The x and y of {} are always negative."},
    {"-|x|,y", "sign_lost", "The x of {} is always negative."},
    {"x,-|y|", "sign_lost", "The y of {} is always negative."},
};

struct Halved {
  const char *mistake, *name, *chapters, *says;
};

// Each is completed by the component.
constexpr Halved kHalved[] = {
    {"dt_missing", "dt_missing", "12",
     "dt is missing in the change of the velocity's {0}: it is (g{0} + F{0}/m) dt."},
    {"dt_twice", "dt_twice", "12",
     "dt enters twice in the change of the velocity's {0}: it is (g{0} + F{0}/m) dt."},
    {"per_frame", "per_frame", "12",
     "The velocity's {0} changes by 1/60 s of gravity and forces a step, whatever dt is: multiply by dt."},
    {"move_per_frame", "per_frame", "12",
     "The {0} of a position changes by v{0}/60 a step, whatever dt is: by v{0} dt."},
    {"velocity_without_dt", "velocity_without_dt", "1",
     "Each step moves a body by v{0} along {0}, not by v{0} dt."},
    {"velocity_with_dt_twice", "velocity_with_dt_twice", "1",
     "Each step moves a body by v{0} dt dt along {0}, not by v{0} dt."},
    {"explicit_euler", "explicit_euler", "12",
     "The {0} of a position changes by the velocity of before the step: update the velocity first, both "
     "components, "
     "then move with the new one."},
    {"half_a_step_twice", "half_a_step_twice", "1",
     "Each step moves g{0} dt^2/2 too far along {0}: the new velocity already includes g{0} dt."},
    {"moves_by_first_velocity", "constant_speed", "12",
     "The {0} of a position changes by the first velocity in all steps: move by the velocity of now."},
    {"gravity*2", "gravity_twice", "12", "The {0} of gravity acts twice a step."},
    {"gravity*0.5", "gravity_halved", "12", "Half of gravity's {0} acts: v{0} grows by g{0} dt."},
    {"velocity in the position's change*0.5", "moves_half", "1",
     "A step moves a body by half of v{0} dt along {0}."},
    {"velocity in the position's change*2", "moves_twice", "1",
     "A step moves a body by twice v{0} dt along {0}."},
    {"damping", "damping", "1", "Each step multiplies the velocity's {0} by 0.99: leave that out."},
    {"force_not_cleared", "force_not_cleared", "24",
     "The {0} of the forces piles up from step to step: set both components of the sum to zero at the start "
     "of each "
     "step."},
    {"mass_not_divided", "mass_not_divided", "2",
     "The {0} of a force is not divided by the mass: v{0} changes by F{0} dt/m."},
    {"mass_divided_twice", "mass_divided_twice", "2", "The {0} of a force is divided by the mass twice."},
    {"mass_multiplied", "mass_multiplied", "2", "The {0} of a force is multiplied by the mass: divide."},
    {"gravity_divided_by_mass", "gravity_divided_by_mass", "2", "The {0} of gravity is divided by the mass."},
    {"force_without_dt", "force_without_dt", "2",
     "dt is missing where forces change v{0}: it grows by F{0} dt/m."},
    {"force_dt_twice", "force_dt_twice", "2",
     "dt enters twice where forces change v{0}: it grows by F{0} dt/m."},
    {"last_force_only", "last_force_only", "2",
     "Only the last force acts along {0}: add them up, both components."},
    {"first_force_only", "first_force_only", "2",
     "Only the first force acts along {0}: add them up, both components."},
    {"drag_quadratic", "drag_quadratic", "2",
     "The {0} of drag grows with the square of the speed: it is -c v{0}."},
    {"drag_constant", "drag_constant", "2", "The {0} of drag does not grow with the speed: it is -c v{0}."},
    {"drag_not_divided", "drag_not_divided", "2",
     "The {0} of drag is not divided by the mass: v{0} changes by -c v{0} dt/m."},
    {"push_never_ends", "push_never_ends", "2",
     "A push never ends along {0}: it ends at \"start\" + \"duration\"."},
    {"spring_pulls_the_first_only", "spring_at_one_end", "2",
     "A spring pulls only its first end along {0}: it pulls both, along x and y."},
    {"spring_pulls_the_second_only", "spring_at_one_end", "2",
     "A spring pulls only its second end along {0}: it pulls both, along x and y."},
    {"spring_same_direction", "same_direction_for_both", "2",
     "A spring pulls both ends in the same direction along {0}: a is pulled towards b, and b towards a."},
};

}  // namespace

std::vector<Predictable> mistakes_of_axes() {
  std::vector<Predictable> out;
  for (const Vector& vector : kVectors)
    for (const Mix& mix : kMixes)
      out.push_back({fmt::format("{}@{}", vector.quantity, mix.axes), mix.name, vector.chapters,
                     fmt::format(fmt::runtime(mix.says), vector.what), true});
  for (const Halved& halved : kHalved)
    for (const char* axis : {"x", "y"})
      out.push_back({fmt::format("{} in {} only", halved.mistake, axis), halved.name, halved.chapters,
                     fmt::format(fmt::runtime(halved.says), axis), true});
  // The other mistakes with forces.
  for (const Predictable& whole : mistakes_of_motion()) {
    const bool listed = std::any_of(std::begin(kHalved), std::end(kHalved),
                                    [&](const Halved& halved) { return whole.planted == halved.mistake; });
    if (listed || whole.generated || whole.exactly || whole.chapters.find('2') == std::string::npos) continue;
    for (const char* axis : {"x", "y"})
      out.push_back({fmt::format("{} in {} only", whole.planted, axis), whole.name, whole.chapters,
                     fmt::format("Along {} only: {}", axis, whole.says), true});
  }
  return out;
}

}  // namespace plumb::course
