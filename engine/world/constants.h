#pragma once

/// The numbers that the real-time world is tuned with, each with its unit and its reason. None is a length or
/// a speed of its own: they scale with the shapes, the substep and gravity, so that a scene of millimetres
/// and one of kilometres behave alike.
namespace plumb::tuning {

/// Natural frequency of the spring that stands for a contact, as a share of the substep's rate; beyond 1/4
/// the discrete spring is not stable. Against what does not give way it may be twice as hard.
inline constexpr double kContactFrequencyShare = 0.125;
inline constexpr double kStiffFrequencyShare = 0.25;
/// Far over-critical: overlaps dissolve without a bounce.
inline constexpr double kContactDampingRatio = 10;

/// How far contacts yield to a load, as a share of what their spring would: large heaps swing without it. A
/// heap of 100 rows falls at 0.2 (with two substeps at 0.4); one of 75 with two substeps sways, and stands.
inline constexpr double kContactYield = 0.35;
/// They expect this share of the load that they have had, and yield to the rest alone: what lasts is carried
/// with little overlap. With all of it nothing would keep loads from creeping among supports of which there
/// are more than needed, and overlaps would grow again.
inline constexpr double kExpectedShare = 0.9;
/// Where a load has pressed shapes into each other by this share of the smaller extent, all of it is
/// expected, and in proportion before: few points of a heap bear much more than the others. A heap of 100
/// rows of 1 m is 0.95 mm deep and sways by 3 cm; with 0.002 it is 1.04 mm deep, with 0.0015 it sways by 4.7
/// cm and more from minute to minute.
inline constexpr double kExpectedOverlap = 0.0017;
/// What is expected follows in a step by this share of the difference. Heaps of 100 rows swing from 0.03 on,
/// of 20 from 0.5.
inline constexpr double kExpectedRate = 0.01;

/// Share of an overlap that a contact which is solved directly takes back in a substep.
inline constexpr double kPushShare = 0.1;

/// Islands with no more rows than this, whose factorisation costs no more multiplications, are solved
/// directly.
inline constexpr int kDirectRows = 128;
inline constexpr double kDirectCost = 20000;
/// So are larger ones without joints when they are slender: this many rows at most, no more loops of contacts
/// than this, no more contacts on any body than this.
inline constexpr int kSlenderRows = 4096;
inline constexpr int kSlenderLoops = 8;
inline constexpr int kSlenderContacts = 8;
/// Islands with joints are so only when their heaviest body has more than this many times the mass of their
/// lightest: sweeps hold chains of equal links well, and cost less.
inline constexpr double kDirectMassRatio = 8;
/// Trees of hinges are moved as mechanisms, except, unless Solver::Direct asks for it, those with no fewer
/// and no more links than these and masses within that ratio: sweeps hold them within a thousandth, at half
/// the cost. Fewer links cost little; more, sweeps leave stretched.
inline constexpr int kSweptLinksLeast = 6;
inline constexpr int kSweptLinksMost = 16;
/// An island with joints is solved as one while it has no more joints and contacts than these, and
/// factorising its rows costs no more multiplications than this: at 2e6 a step of four substeps takes some 20
/// ms. Larger ones are left to the sweeps.
inline constexpr int kJointedJoints = 4096;
inline constexpr int kJointedContacts = 512;
inline constexpr double kJointedCost = 2e5;
/// Share of a joint's gap that is closed in a step, by moving its bodies, and by how much its rows give way:
/// no body moves by more than 1 / (2 sqrt(kCloseSoftness)) = 5 times the gaps. With 1e-4, 50 times, links of
/// a taut bridge turn so far for a gap of 0.4 mm that it sags; at 0.1 chains close half as fast.
inline constexpr double kJointShare = 0.5;
inline constexpr double kCloseSoftness = 1e-2;
/// The same with Solver::Direct, which closes them at each substep: a chain of ten links is pulled about
/// within 1e-6 m. At 1e-2 it opens by 7e-6 m; at 1e-4 bridges sag here as well. At once a step whole gaps let
/// them sag.
inline constexpr double kDirectJointShare = 1;
inline constexpr double kDirectCloseSoftness = 1e-3;
/// rad, the most that a body is turned for it in a step.
inline constexpr double kLinkTurn = 0.125;

/// Natural frequency of the spring that stands for a joint, as a share of the substep's rate, and its
/// damping.
inline constexpr double kJointFrequencyShare = 0.25;
inline constexpr double kJointDampingRatio = 2;

/// Impacts drive limits of revolute joints in farther than sweeps over velocities can stop. What has passed a
/// limit by more than this, rad, is turned back after the motion, by at most so much in a sweep (what was
/// placed beyond a limit comes back smoothly), in up to so many sweeps.
inline constexpr double kLimitSlack = 0.01;
inline constexpr double kLimitTurn = 0.1;
inline constexpr int kLimitSweeps = 4;

/// Share of an overlap, and of a joint's error, that a substep of sequential impulses feeds back (Baumgarte,
/// 1972): more would swing, as its speed stays in the velocities.
inline constexpr double kFeedback = 0.2;
/// Overlap that they leave, as a share of the smaller extent: contacts at rest do not come and go.
inline constexpr double kSlop = 0.002;

/// Fastest push out of an overlap, in extents of the smaller shape a second: deep overlaps dissolve without a
/// burst.
inline constexpr double kPushSpeed = 4;
/// What an impact has driven into each other may part faster, between bodies that give way: by this share of
/// the velocity that the load between them gives to them in a substep. At 0.2 what starts in each other flies
/// apart a fifth faster.
inline constexpr double kPushWithLoad = 0.05;

/// Contacts are prepared for shapes that are nearer than this share of the smaller shape's extent, besides
/// the way that they may come closer in the step.
inline constexpr double kContactReach = 0.02;
/// Most of that way, as a share of the smaller extent: a plane of contact is a guess at a distance.
inline constexpr double kContactReachMost = 0.5;

/// A manifold is kept while its shapes have moved less than this share of the smaller extent relative to each
/// other: the error of carrying separations on is of second order in it.
inline constexpr double kManifoldTravel = 0.002;

/// Steps in a surface made of several shapes that do not count, as a share of the smaller extent of what
/// touches there; gaps may be three times as wide. Below, planks that have settled to a thousandth would be
/// stairs; above, real steps would be passed over.
inline constexpr double kSeamTolerance = 0.002;
/// What lies deeper than this in such a surface, as a share of the smaller extent, is pushed out as out of a
/// single shape: across a seam it would be thrown.
inline constexpr double kSeamDepth = 0.25;

/// Broad-phase margin, as a share of the shape's extent, and how many steps of motion ahead it looks. Larger:
/// fewer updates of the tree, more pairs to look at.
inline constexpr double kBoxMargin = 0.1;
inline constexpr double kBoxSteps = 4;

/// Where at least so many shapes have left their stored boxes, and at least one in so many of all, most of
/// them without a contact, those that meet others are found at once.
inline constexpr int kScreenedMoves = 64;
inline constexpr int kScreenedShare = 8;

/// Approaches slower than this many times |gravity| dt do not bounce: a body at rest gains |gravity| dt
/// before its contact answers.
inline constexpr double kRestingSteps = 4;

/// A body is fast when it moves by more than this share of its smallest half width in a step: slower ones
/// cannot get through anything between two steps.
inline constexpr double kFastShare = 0.5;

/// How deep below a shape's surface its core lies, as a share of its half width: a body is stopped on its way
/// where its core would get into something. Deeper, contacts push it out on the wrong side; nearer to the
/// surface, what slides under load is stopped.
inline constexpr double kCoreDepth = 0.5;
/// The same for what is deeper in something than that already, as loads, joints or the user have put it
/// there: it gets no deeper than to here.
inline constexpr double kInnerDepth = 0.9;
/// Overlaps below this share of the smaller extent are not looked at for that.
inline constexpr double kDeepFrom = 0.002;
/// Two fast discs are stopped where they would overlap by more than this share of the smaller radius.
inline constexpr double kGraze = 0.01;
/// How near a fast body is brought to what it meets, as a share of the smaller extent.
inline constexpr double kImpactTolerance = 1e-3;

/// Iterations in the search for an impact that each may take, and how many more all of a step may: those that
/// spin through thousands of radians beside each other. A search that ends without them is taken for an
/// impact where it has come to: so far they are apart.
inline constexpr int kImpactIterations = 64, kLongSearches = 4096;

/// How near bodies are brought that throw each other back, as a share of their sizes and ways. Roundings of
/// the search are some 1e-15 of these: much nearer it could not tell apart what touches and what overlaps;
/// farther, impacts would come too soon by as much.
inline constexpr double kReboundTolerance = 1e-14;

/// Impacts that a body may have in flight in a step; at one more it waits for the next step, with what it
/// meets. From the lower number on those that take energy take all of the approach: a box that lands flat has
/// ever smaller ones, without an end.
inline constexpr int kImpactsInFlight = 256, kBouncesInFlight = 16;

/// A body that has moved slower than this, in extents a second, for this long, s, may sleep.
inline constexpr double kSleepSpeed = 0.05;
inline constexpr double kSleepTime = 0.5;

/// Overlaps below this share of the smaller extent count as touching for events.
inline constexpr double kTouch = 1e-3;

/// Impacts faster than this, in extents of the smaller shape a second, are reported as hits.
inline constexpr double kHitSpeed = 1;

}  // namespace plumb::tuning
