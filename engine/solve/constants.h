#pragma once

/// The numbers that Realtime's methods are tuned with, each with its unit and its reason. None is a length or
/// a speed of its own: they scale with the shapes, the step and gravity.
namespace plumb::constants {

/// Broad-phase margin, as a share of a shape's reach. Larger: fewer updates of the tree, more pairs to look
/// at.
inline constexpr double kBoxMargin = 0.1;

/// A contact is prepared when its separation is below this share of the smaller shape's reach, besides the
/// way that the shapes may come closer in the step. Not a gap that is kept: contacts hold at separation 0.
inline constexpr double kContactMargin = 0.05;

/// How many times the approach in a step contacts are prepared for: impulses may speed bodies up.
inline constexpr double kApproachReserve = 2;

/// Share of an overlap that a substep pushes out. 1 would be all at once; below 0.5 stacks do not tremble
/// while the sweeps have not converged.
inline constexpr double kPushOut = 0.2;

/// Share of a gap that shapes which pressed on each other may close in a substep.
inline constexpr double kGapClosing = 0.2;

/// Fastest push out of an overlap, in reaches of the smaller shape a second: deep overlaps dissolve without a
/// burst.
inline constexpr double kPushSpeed = 4;

/// Slower approaches than this many times |acceleration| * substep are not impacts but rest: a body at rest
/// gains half of it in each half kick, so that a bounce would be one of the method, not of the body.
inline constexpr double kRestingKicks = 2;

/// Share of a joint's gap that one substep of the Euler steppers takes back (Baumgarte, 1972).
inline constexpr double kJointFeedback = 0.2;

/// Natural frequency of an iterative joint's error, as a share of the substep's rate: beyond 1/4 the discrete
/// spring is not stable. Its damping ratio is over-critical, so that errors die without a swing.
inline constexpr double kJointFrequencyShare = 0.25;
inline constexpr double kJointDampingRatio = 2;

/// Most quasi-Newton corrections of the joints' positions a substep; they end sooner, when the gap is at
/// rounding or no longer falls.
inline constexpr int kPositionCorrections = 30;

/// Quasi-Newton corrections of joints after overlaps have been pushed out: the way is short, each gains
/// several digits.
inline constexpr int kSettlings = 3;

/// Fastest closing of a joint's gap that was there at the substep's start, in spans of the jointed bodies a
/// second: a scene that starts with its joints apart is pulled together without a burst.
inline constexpr double kGapSpeed = 4;

/// Most impacts a substep, for each contact and in all: beyond, bodies chatter faster than anybody can see,
/// and what is left is resolved as rest.
inline constexpr int kImpactsPerContact = 16;
inline constexpr int kImpactsAtLeast = 1 << 17;

/// Most impacts a substep at the time of the impact before, in all and for each contact: what is struck
/// passes it on through a rack and back. Where friction or a second wall presses back at once what an impact
/// has turned back, there is no end of them, and what is left is resolved as rest, too.
inline constexpr int kImpactsAtOnce = 64, kImpactsAtOnceEach = 8;

/// How many times as many sweeps the first step makes, which starts without impulses of a step before: a
/// stack that is built at rest stays there.
inline constexpr int kColdSweeps = 20;

/// How many times heavier than what it rests on a load must be to be given more sweeps, and how many contacts
/// and joints a pass then works on at most in all its sweeps.
inline constexpr double kHeavyLoad = 30;
inline constexpr int kLoadWork = 4000;

/// Of how many substeps a step has these additional sweeps, and its impacts, in full; more share what so many
/// have, as each begins with the impulses of the one before. What a step costs is bounded so.
inline constexpr int kFullSubsteps = 16;

/// Newton iterations for the time of a contact; they converge quadratically and end at rounding.
inline constexpr int kTimeIterations = 12;

}  // namespace plumb::constants
