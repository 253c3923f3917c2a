#pragma once

/// Tuning constants of Realtime's methods, each with its unit and its reason. None is an absolute length or
/// speed: they scale with the shapes, the step and gravity.
namespace plumb::constants {

/// Broad-phase AABB margin, as a fraction of a shape's reach. Larger: fewer tree updates, more pairs to test.
inline constexpr double kBoxMargin = 0.1;

/// Speculative margin, as a fraction of the smaller shape's reach, besides the approach of the shapes in the
/// step. It is not a kept gap: contacts hold at separation 0.
inline constexpr double kContactMargin = 0.05;

/// Multiple of the approach in a step within which contacts are prepared: impulses may accelerate bodies.
inline constexpr double kApproachReserve = 2;

/// Fraction of an overlap that a substep removes. Below 0.5, stacks do not tremble before the iterations
/// converge.
inline constexpr double kPushOut = 0.2;

/// Fraction of a gap, between shapes that pressed on each other, that may close in a substep.
inline constexpr double kGapClosing = 0.2;

/// Depenetration speed, in reaches of the smaller shape per second: deep overlaps dissolve without a burst.
inline constexpr double kPushSpeed = 4;

/// Approaches slower than this multiple of |acceleration| * substep are rest, not impacts. A body at rest
/// gains half of it in each half kick, so a bounce would be an artefact of the method.
inline constexpr double kRestingKicks = 2;

/// Fraction of a joint's gap that one substep of the Euler steppers corrects (Baumgarte, 1972).
inline constexpr double kJointFeedback = 0.2;

/// Natural frequency of an iterative joint's error, as a fraction of the substep rate: beyond 1/4 the
/// discrete spring is unstable. Its damping ratio is over-critical, so that errors decay without oscillation.
inline constexpr double kJointFrequencyShare = 0.25;
inline constexpr double kJointDampingRatio = 2;

/// Maximum quasi-Newton corrections of the joints' positions per substep. They end sooner if the gap is at
/// rounding or no longer falls.
inline constexpr int kPositionCorrections = 30;

/// Quasi-Newton corrections of joints after overlaps were pushed out. Displacements are short, so each
/// correction gains several digits.
inline constexpr int kSettlings = 3;

/// Maximum closing speed of a joint gap that existed at the start of the substep, in spans of the jointed
/// bodies per second. A scene that starts with its joints apart is pulled together without a burst.
inline constexpr double kGapSpeed = 4;

/// Maximum number of impacts per substep, for each contact and in all. Beyond, bodies chatter faster than
/// anybody can see, and the rest is resolved as resting contact.
inline constexpr int kImpactsPerContact = 16;
inline constexpr int kImpactsAtLeast = 1 << 17;

/// Maximum number of impacts per substep at the time of the previous impact, in all and for each contact. An
/// impact travels through a rack and back. If friction or a second wall turns bodies back at once they never
/// end, and the rest is resolved as resting contact.
inline constexpr int kImpactsAtOnce = 64, kImpactsAtOnceEach = 8;

/// Factor on the iterations of the first step, which has no impulses to warm start from. A stack that is
/// built at rest stays at rest.
inline constexpr int kColdSweeps = 20;

/// Mass ratio of a load to its support above which it gets more iterations; and the maximum contacts and
/// joints that a pass then processes over all its iterations.
inline constexpr double kHeavyLoad = 30;
inline constexpr int kLoadWork = 4000;

/// Number of substeps per step that have these additional iterations, and impacts, in full. More substeps
/// share this budget, as each starts with the impulses of the last. This bounds the cost of a step.
inline constexpr int kFullSubsteps = 16;

/// Newton iterations for the time of a contact; they converge quadratically and end at rounding.
inline constexpr int kTimeIterations = 12;

}  // namespace plumb::constants
