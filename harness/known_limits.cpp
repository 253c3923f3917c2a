#include "harness/known_limits.h"

namespace plumb::harness {
namespace {

// Reasons that several scenes share.
constexpr std::string_view kSkin =
    "Box2D surrounds polygons with a skin of 0.01 m (b2_polygonRadius) and leaves 0.005 m of overlap "
    "(b2_linearSlop): boxes come to rest 0.015 m apart, discs 0.005 m above a box or 0.005 m inside each "
    "other.";
constexpr std::string_view kHeavy =
    "The iterations of a step (Box2D 8, Bullet 10) are too few to carry a box a thousand times heavier: "
    "within a second it sinks half a metre into the light one.";
constexpr std::string_view kBrink =
    "The first steps push the block out of the engine's skin (Box2D 0.015 m, Bullet 0.003 m) and load its "
    "corners one after the other. A block within 0.1 % to 5 % of its tipping point may then tip when it "
    "should stand, or stand when it should tip.";
constexpr std::string_view kGrowth =
    "The motion amplifies errors: by a factor e in 0.3 s or less for a pendulum near its top and a "
    "whipping rod, and tenfold in each off-centre impact of discs. The bound is of first order along "
    "the truth and does not include such growth.";
constexpr std::string_view kSweeps =
    "The iterations of a step (Box2D 8, Bullet 10) are too few for chains of joints or contacts to "
    "converge. The remaining error moves the bodies until later steps correct it.";
constexpr std::string_view kOnset =
    "Friction is limited by the normal impulse found so far. In the first steps that impulse is still too "
    "small, and a block that friction should hold slides by 2 to 20 mm.";
constexpr std::string_view kSettling =
    "A step solves normal forces before friction, unless friction grows at once. A sliding ladder misses its "
    "bound by up to a tenth at 1/30 s.";
constexpr std::string_view kStale =
    "The world keeps the points of a contact until its bodies have moved by 0.2 % of their size against each "
    "other. Lever arms lag by up to 2 mrad meanwhile: 3 mm after 1 s for a block that tips by itself. The "
    "bound falls with the step, and this does not.";
constexpr std::string_view kFewDigits =
    "At long steps the world in float solves a mechanism with a heavy tip to fewer digits than the bound, "
    "which "
    "follows from the order of its method, presumes.";
constexpr std::string_view kCrowded =
    "Many of the last of the 314 impacts fall into one step. An engine that resolves one impact per pair "
    "and step leaves the others to later steps.";

constexpr KnownLimit kLimits[] = {
    {"box2d", "off_centre_torque/spin_100",
     "angle_error|angular_velocity_error|discrete_angle|discrete_angular_velocity|energy_drift|angular_"
     "momentum_drift",
     "Box2D limits a body's rotation to pi/2 per step (b2_maxRotation), which is 94 rad/s at 1/60 s, and "
     "reduces its angular velocity to that."},
    {"bullet|bullet-double", "off_centre_torque/spin_100", "angle_error|discrete_angle",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), but computes the quaternion "
     "of the step with the unlimited angular velocity: at 100 rad/s a body turns by 1.442 rad in 1/60 s "
     "instead of 1.667 rad."},
    {"box2d", "pendulum_chain[20]", "velocity_error",
     "Each of Box2D's 8 iterations per step propagates a force by one joint; a chain of 20 needs more of "
     "them to carry its own weight."},
    {"box2d", "pendulum_chain[100]", "velocity_error",
     "Each of Box2D's 8 iterations per step propagates a force by one joint; through a chain of 100 it takes "
     "several steps, and the chain stretches."},
    {"bullet|bullet-double", "pendulum_chain[20]", "velocity_error",
     "Each of Bullet's 10 iterations per step propagates a force by one joint; a chain of 20 needs more of "
     "them to carry its own weight."},
    {"bullet|bullet-double", "pendulum_chain[100]", "position_error|velocity_error",
     "Each of Bullet's 10 iterations per step propagates a force by one joint; through a chain of 100 it "
     "takes several steps, and the chain stretches."},
    {"box2d", "free_fall/*",
     "position_error|velocity_error|discrete_position|discrete_velocity|energy_drift|momentum_drift",
     "Box2D limits a body's displacement to 2 m per step (b2_maxTranslation), which free fall exceeds at "
     "1/30 s.",
     true},
    {"bullet|bullet-double", "off_centre_torque/*",
     "position_error|angle_error|velocity_error|discrete_position|discrete_angle|discrete_velocity",
     "Bullet limits the rotation of a step to pi/4 (ANGULAR_MOTION_THRESHOLD), which a longer step reaches "
     "at a lower angular velocity.",
     true},
    {"box2d|bullet|bullet-double", "pendulum_chain*",
     "position_error|angle_error|velocity_error|angular_velocity_error|energy_drift|joint_gap",
     "Sequential impulses stop after a fixed number of iterations. As the step gets shorter, the error of "
     "convergence decreases more slowly than that of the integration.",
     true},
    // Scenes of the catalogue, ordered by reason and by the missed checks.
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
    {"bullet-double", "pi_billiard/314", "velocity_error", kCrowded},
    // Limits that hold only at settings other than the default ones.
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
    {"plumb|plumb-float", "toppling_block/topples", "position_error|angle_error|velocity_error", kStale,
     true},
    {"plumb|plumb-float", "ladder", "velocity_error", kSettling, true},
    {"box2d",
     "block_on_cart|circle_stack[2]|circle_stack[5]|disc_in_groove|high_mass_ratio/"
     "10|ladder|large_pyramid[2]|large_pyramid[3]|leaning_ladder/stands|leaning_ladder/slips|pulled_plate/"
     "rolls|pulled_plate/slips|ramp_disc/rolls|ramp_disc/barely_rolls|ramp_disc/barely_slips|ramp_disc/"
     "slips|slide_to_roll/slide|slide_to_roll/spin|slide_to_roll/backspin|vertical_stack[3]|wedge",
     "angle_error|penetration|energy_drift|velocity_error|position_error|angular_velocity_error", kSkin,
     true},
    {"plumb-float", "double_pendulum/heavy_tip", "angular_velocity_error|angle_error", kFewDigits, true},
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
