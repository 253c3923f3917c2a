#include "harness/known_limits.h"

namespace plumb::harness {
namespace {

// Reasons that several scenes share.
constexpr std::string_view kSkin =
    "Box2D surrounds polygons with a skin of 0.01 m (b2_polygonRadius) of which 0.005 m (b2_linearSlop) stay "
    "overlapped: boxes come to rest 0.015 m apart, discs 0.005 m off a box or into each other.";
constexpr std::string_view kHeavy =
    "The sweeps of a step do not carry a box a thousand times heavier: within a second it sinks by half a "
    "metre into the light one (Box2D 8 sweeps, Bullet 10).";
constexpr std::string_view kBrink =
    "A block within a thousandth to a twentieth of what tips it is tipped, or held back, by the first steps: "
    "it is lifted into the engine's skin (Box2D 0.015 m, Bullet 0.003 m) and its corners are loaded in turn.";
constexpr std::string_view kGrowth =
    "The motion multiplies errors: a pendulum near its top, a rod that whips and a disc on a cylinder by e "
    "in 0.3 s or less, discs off-centre tenfold an impact. The bound is of first order along the truth, "
    "without such growth.";
constexpr std::string_view kSweeps =
    "What the few sweeps of a step leave undone in rows of joints or contacts (Box2D 8 sweeps, Bullet 10) "
    "moves the bodies until later steps make up for it.";
constexpr std::string_view kOnset =
    "Friction is limited by the normal impulse that a sweep has found so far: in the first steps, which load "
    "the contact, a block that friction holds slides by 2 to 20 mm.";
constexpr std::string_view kSettling =
    "Contacts of the world are damped springs that take some substeps to carry a weight: until then a block "
    "within a hundredth of tipping is rocked, and a sliding ladder is up to a sixth beyond its bound.";
constexpr std::string_view kSoft =
    "Joints of the world are damped springs that the substeps sweep once: under a weight that begins at once "
    "a chain of 7 to 10 sags by 3 to 9 mm, a spinning weld turns by 0.001 rad, and a limit takes some "
    "substeps to stop what meets it.";
constexpr std::string_view kCrowded =
    "The last of 314 impacts come many to a step; an engine that resolves one a step and pair leaves some to "
    "the next.";

constexpr KnownLimit kLimits[] = {
    {"box2d", "off_centre_torque/spin_100",
     "angle_error|angular_velocity_error|discrete_angle|discrete_angular_velocity|energy_drift|angular_"
     "momentum_drift",
     "Box2D lets a body turn by at most pi/2 a step (b2_maxRotation), which is 94 rad/s at 1/60 s, "
     "and slows it down to that."},
    {"bullet|bullet-double", "off_centre_torque/spin_100", "angle_error|discrete_angle",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), but builds the "
     "quaternion of the step with the unlimited spin: of the 1.667 rad that 100 rad/s make in 1/60 "
     "s, 1.442 rad are left."},
    {"box2d", "pendulum_chain[20]", "velocity_error",
     "Box2D's sequential impulses carry a pull from one joint to the next in each of its 8 sweeps a "
     "step; a chain of 20 needs more of them to feel its own weight."},
    {"box2d", "pendulum_chain[100]", "velocity_error",
     "Box2D's sequential impulses carry a pull from one joint to the next in each of its 8 sweeps a "
     "step; through a chain of 100 it comes steps too late, and the chain stretches."},
    {"bullet|bullet-double", "pendulum_chain[20]", "velocity_error",
     "Bullet's sequential impulses carry a pull from one joint to the next in each of its 10 sweeps "
     "a step; a chain of 20 needs more of them to feel its own weight."},
    {"bullet|bullet-double", "pendulum_chain[100]", "position_error|velocity_error",
     "Bullet's sequential impulses carry a pull from one joint to the next in each of its 10 sweeps "
     "a step; through a chain of 100 it comes steps too late, and the chain stretches."},
    {"box2d", "free_fall/*",
     "position_error|velocity_error|discrete_position|discrete_velocity|energy_drift|momentum_drift",
     "Box2D lets a body move by at most 2 m a step (b2_maxTranslation), which is less than free fall "
     "makes at 1/30 s.",
     true},
    {"bullet|bullet-double", "off_centre_torque/*",
     "position_error|angle_error|velocity_error|discrete_position|discrete_angle|discrete_velocity",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), which a long step "
     "reaches at a lower spin.",
     true},
    {"box2d|bullet|bullet-double", "pendulum_chain*",
     "position_error|angle_error|velocity_error|angular_velocity_error|energy_drift|joint_gap",
     "Sequential impulses are stopped after a few sweeps, whatever the step: what they leave undone "
     "falls more slowly than the error of the step.",
     true},
    // Scenes of the catalogue, by reason, and by which checks miss.
    {"box2d",
     "block_on_cart|circle_stack[2]|circle_stack[5]|conveyor|disc_in_groove|friction_rules/"
     "geometric_mean|friction_rules/product|friction_rules/maximum|friction_rules/minimum|friction_rules/"
     "average|high_mass_ratio/10|leaning_ladder/stands|leaning_ladder/slips|pulled_plate/rolls|pulled_plate/"
     "slips|pushed_block/holds|pushed_block/barely_slips|pushed_block/slips|ramp_block/holds|ramp_block/"
     "barely_holds|ramp_block/barely_slips|ramp_block/slips|sliding_stop|wedge",
     "position_error", kSkin},
    {"box2d", "ladder|large_pyramid[2]|large_pyramid[3]|vertical_stack[1]|vertical_stack[3]",
     "position_error|energy_drift", kSkin},
    {"box2d", "high_mass_ratio/1e6", "position_error|velocity_error|energy_drift|penetration", kHeavy},
    {"box2d|bullet|bullet-double", "high_mass_ratio/1000",
     "position_error|angle_error|velocity_error|energy_drift|penetration", kHeavy},
    {"bullet|bullet-double", "high_mass_ratio/1e6",
     "position_error|angle_error|velocity_error|energy_drift|penetration", kHeavy},
    {"box2d", "overhang[1]|table_edge/lies", "position_error|energy_drift", kBrink},
    {"box2d", "overhang[5]",
     "position_error|angle_error|velocity_error|angular_velocity_error|energy_drift|penetration", kBrink},
    {"box2d", "table_edge/tips", "position_error|angle_error|energy_drift", kBrink},
    {"box2d", "toppling_block/stands|toppling_block/topples",
     "position_error|angle_error|velocity_error|energy_drift", kBrink},
    {"bullet", "toppling_block/stands|toppling_block/topples", "position_error|angle_error|velocity_error",
     kBrink},
    {"bullet-double", "toppling_block/stands", "position_error|velocity_error", kBrink},
    {"bullet-double", "toppling_block/topples",
     "position_error|angle_error|velocity_error|angular_velocity_error", kBrink},
    {"bullet|bullet-double", "overhang[1]",
     "position_error|angle_error|velocity_error|angular_velocity_error", kBrink},
    {"bullet|bullet-double", "overhang[5]",
     "position_error|angle_error|velocity_error|angular_velocity_error|energy_drift", kBrink},
    {"bullet|bullet-double", "table_edge/lies", "position_error|angle_error|velocity_error", kBrink},
    {"box2d", "double_pendulum/light_tip|pendulum/170", "velocity_error", kGrowth},
    {"box2d|bullet|bullet-double", "billiard_table", "position_error|velocity_error", kGrowth},
    {"plumb|plumb-float", "cylinder/slides", "velocity_error", kGrowth},
    {"plumb|plumb-float", "cylinder/rolls", "velocity_error|angular_velocity_error", kGrowth},
    {"box2d", "bead_on_arm", "velocity_error|angular_velocity_error", kSweeps},
    {"box2d", "small_modes[10]", "position_error|velocity_error", kSweeps},
    {"box2d", "vertical_stack[10]", "position_error|velocity_error|energy_drift", kSweeps},
    {"box2d", "welded_pair", "angle_error", kSweeps},
    {"box2d|bullet|bullet-double", "double_pendulum/heavy_tip", "velocity_error", kSweeps},
    {"bullet", "circle_stack[5]", "position_error|velocity_error", kSweeps},
    {"bullet-double", "circle_stack[5]", "position_error|energy_drift", kSweeps},
    {"bullet-double", "large_pyramid[2]", "position_error", kSweeps},
    {"bullet|bullet-double", "block_on_cart", "velocity_error", kSweeps},
    {"bullet|bullet-double", "hanging_chain[7]", "position_error|angle_error", kSweeps},
    {"bullet|bullet-double", "high_mass_ratio/10|large_pyramid[3]", "position_error", kSweeps},
    {"bullet|bullet-double", "pulled_plate/rolls|pulled_plate/slips|vertical_stack[3]",
     "position_error|velocity_error", kSweeps},
    {"bullet|bullet-double", "small_modes[10]", "position_error|velocity_error|energy_drift", kSweeps},
    {"bullet|bullet-double", "vertical_stack[10]", "position_error|angle_error|velocity_error|energy_drift",
     kSweeps},
    {"bullet-double", "ramp_block/holds", "position_error", kOnset},
    {"bullet|bullet-double", "pushed_block/holds", "position_error|velocity_error", kOnset},
    {"bullet|bullet-double", "ramp_block/barely_holds", "position_error", kOnset},
    {"plumb|plumb-float", "toppling_block/stands", "position_error|angle_error|velocity_error", kSettling},
    {"plumb|plumb-float", "toppling_block/topples",
     "position_error|angle_error|velocity_error|angular_velocity_error", kSettling},
    {"plumb", "welded_pair", "angle_error", kSoft},
    {"plumb|plumb-float", "hanging_chain[7]", "position_error|velocity_error", kSoft},
    {"plumb|plumb-float", "small_modes[10]", "position_error|velocity_error|energy_drift", kSoft},
    {"bullet-double", "pi_billiard/314", "velocity_error", kCrowded},
    // The same at other steps.
    {"box2d", "overhang[1]|table_edge/lies|toppling_block/stands|toppling_block/topples",
     "angle_error|angular_velocity_error", kBrink, true},
    {"bullet", "overhang[1]", "energy_drift", kBrink, true},
    {"bullet-double", "overhang[1]|toppling_block/stands", "energy_drift|angle_error", kBrink, true},
    {"bullet", "pi_billiard/31", "velocity_error", kCrowded, true},
    {"bullet-double", "pi_billiard/31", "velocity_error", kCrowded, true},
    {"box2d", "pendulum/120|pendulum/170", "position_error|velocity_error", kGrowth, true},
    {"bullet", "pendulum/170", "velocity_error", kGrowth, true},
    {"bullet-double", "pendulum/170", "velocity_error", kGrowth, true},
    {"box2d", "high_mass_ratio/1e6", "angle_error", kHeavy, true},
    {"bullet", "high_mass_ratio/1000|high_mass_ratio/1e6", "angular_velocity_error", kHeavy, true},
    {"bullet-double", "high_mass_ratio/1000|high_mass_ratio/1e6", "angular_velocity_error", kHeavy, true},
    {"bullet", "ramp_block/holds", "position_error", kOnset, true},
    {"plumb", "large_pyramid[3]|toppling_block/stands", "position_error|angular_velocity_error", kSettling,
     true},
    {"plumb-float", "toppling_block/stands", "position_error|angular_velocity_error", kSettling, true},
    {"plumb|plumb-float", "ladder", "velocity_error", kSettling, true},
    {"box2d",
     "block_on_cart|circle_stack[2]|circle_stack[5]|disc_in_groove|high_mass_ratio/"
     "10|ladder|large_pyramid[2]|large_pyramid[3]|leaning_ladder/stands|leaning_ladder/slips|pulled_plate/"
     "rolls|pulled_plate/slips|ramp_disc/rolls|ramp_disc/barely_rolls|ramp_disc/barely_slips|ramp_disc/"
     "slips|slide_to_roll/slide|slide_to_roll/spin|slide_to_roll/backspin|vertical_stack[3]|wedge",
     "angle_error|penetration|energy_drift|velocity_error|position_error|angular_velocity_error", kSkin,
     true},
    {"plumb", "hanging_chain[2]|hinge_limit", "angle_error|velocity_error|angular_velocity_error", kSoft,
     true},
    {"plumb-float", "hinge_limit|double_pendulum/heavy_tip|welded_pair",
     "velocity_error|angular_velocity_error|angle_error", kSoft, true},
    {"box2d", "vertical_stack[10]", "angle_error|penetration", kSweeps, true},
    {"bullet", "large_pyramid[3]|circle_stack[5]|large_pyramid[2]",
     "velocity_error|energy_drift|position_error", kSweeps, true},
    {"bullet-double", "high_mass_ratio/10|large_pyramid[3]|vertical_stack[10]",
     "angle_error|velocity_error|penetration|position_error", kSweeps, true},
};

bool matches_one(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern.front() != '*') {
    return !text.empty() && text.front() == pattern.front() && matches_one(pattern.substr(1), text.substr(1));
  }
  for (std::size_t skip = 0; skip <= text.size(); ++skip)
    if (matches_one(pattern.substr(1), text.substr(skip))) return true;
  return false;
}

}  // namespace

std::span<const KnownLimit> known_limits() { return kLimits; }

bool matches(std::string_view pattern, std::string_view text) {
  while (true) {
    const std::size_t bar = pattern.find('|');
    if (matches_one(pattern.substr(0, bar), text)) return true;
    if (bar == std::string_view::npos) return false;
    pattern.remove_prefix(bar + 1);
  }
}

const KnownLimit* find_known_limit(std::span<const KnownLimit> limits, std::string_view engine,
                                   std::string_view instance, std::string_view check, bool defaults) {
  for (const KnownLimit& limit : limits) {
    if (defaults && limit.elsewhere_only) continue;
    if (matches(limit.engine, engine) && matches(limit.instance, instance) && matches(limit.check, check))
      return &limit;
  }
  return nullptr;
}

}  // namespace plumb::harness
