#pragma once

/// Tuning constants of the real-time world, each with its unit and its reason. None is an absolute length or
/// speed: they scale with the shapes, the substep and gravity. So a scene of millimetres and one of
/// kilometres behave alike.
namespace plumb::tuning {

/// Natural frequency of the contact spring, as a fraction of the substep rate; beyond 1/4 the discrete spring
/// is unstable. Contacts with a body that is not dynamic are twice as hard.
inline constexpr double kContactFrequencyRatio = 0.125;
inline constexpr double kStiffFrequencyRatio = 0.25;
/// Damping ratio far above critical, so that overlaps dissolve without a bounce.
inline constexpr double kContactDampingRatio = 10;

/// Compliance of a contact under load, as a fraction of its spring's compliance. At 1 large heaps oscillate.
/// At 0.2 a heap of 100 rows collapses (at 0.4 with two substeps); with two substeps, one of 75 rows sways,
/// but stands.
inline constexpr double kContactComplianceScale = 0.35;
/// Fraction of a persistent load that becomes the load estimate. Contacts are compliant only to the rest of
/// the load, so a persistent load causes little penetration. At 1, loads would creep among redundant
/// supports, and overlaps would grow again.
inline constexpr double kLoadEstimateFraction = 0.9;
/// Penetration, as a fraction of the smaller extent, from which the load estimate is the full load; below it
/// the fraction rises linearly. (A few points of a heap bear much more than the others.) A heap of 100 rows
/// of 1 m penetrates by 0.95 mm and sways by 3 cm. With 0.002 it penetrates by 1.04 mm. With 0.0015 it sways
/// by 4.7 cm, and the sway grows over minutes.
inline constexpr double kLoadEstimateOverlap = 0.0017;
/// Low-pass filter: fraction of the difference by which the load estimate approaches the load in a step. From
/// 0.03 on, heaps of 100 rows oscillate; from 0.5 on, heaps of 20 rows.
inline constexpr double kLoadEstimateRate = 0.01;

/// Fraction of a penetration that a directly solved contact corrects in a substep.
inline constexpr double kDirectPushFraction = 0.1;

/// Limits up to which an island of contacts is solved directly: rows, and multiplications for the
/// factorisation.
inline constexpr int kMaxDirectRows = 128;
inline constexpr double kMaxDirectCost = 20000;
/// Limits up to which a larger island without joints is slender, and solved directly too: rows, loops of
/// contacts, and contacts on any one body.
inline constexpr int kMaxSlenderRows = 4096;
inline constexpr int kMaxSlenderLoops = 8;
inline constexpr int kMaxSlenderContacts = 8;
/// Separation, as a fraction of the thinner body's thickness, up to which a point may press without a further
/// approach. It must be below 1: the sheet after the next one is apart by the thickness of the next.
inline constexpr double kNearThickness = 0.1;
/// Mass ratio of the heaviest to the lightest body above which an island with joints is solved directly; with
/// Solver::Direct any ratio suffices. Iterations are accurate for chains of equal links, and cost less.
inline constexpr double kDirectMassRatio = 8;
/// Mass ratio up to which an island of contacts is solved as one system. Its errors are relative to the
/// energy of the heaviest body: a load 1e6 times as heavy as the box below it yields by 9 um, one of 3e7
/// times sinks. Beyond, normals are solved directly at any ratio, and friction by iterations.
inline constexpr double kMaxSystemMassRatio = 1e5;
/// Least and largest number of links with which a hinge tree with masses within kDirectMassRatio is solved by
/// iterations instead of as an articulated body (except with Solver::Direct). Iterations hold such trees to
/// within a thousandth, at half the cost. With fewer links the articulated body costs little; with more,
/// iterations leave the tree stretched.
inline constexpr int kMinIteratedLinks = 6;
inline constexpr int kMaxIteratedLinks = 16;
/// Limits up to which an island with joints is solved as one system, whatever its masses: rows with bounds
/// (limits and motors), contacts, and multiplications per joint for the factorisation. Within them, the
/// solution costs at most some ten times as much as an iteration, and is a hundred times as accurate or more.
/// Each row with bounds may need another factorisation: ragdolls of ten hinges with limits and friction have
/// 20 such rows, and would cost 40 times as much.
inline constexpr int kFewBoundedRows = 16;
inline constexpr int kFewContacts = 16;
inline constexpr double kFewCost = 1000;
/// Limits up to which an island with joints is solved as one system: joints, contacts, and multiplications to
/// factorise its rows. Larger islands are solved by iterations. With a limit of 2e6 multiplications, a step
/// of four substeps would take some 20 ms.
inline constexpr int kMaxJointedJoints = 4096;
inline constexpr int kMaxJointedContacts = 512;
inline constexpr double kMaxJointedCost = 2e5;
/// Multiplications in a substep from which such an island is solved less exactly (some 1.5 ms). At 8e5,
/// ragdolls that start inside each other leave at 25 m/s (96 of 100) in place of 15.
inline constexpr double kJointedEffort = 1.6e6;
/// Fraction of a joint's gap that a step closes by moving the bodies, and relative compliance of the rows for
/// this correction. No body moves by more than 1 / (2 sqrt(kCorrectionSoftness)) = 5 times the gaps. With a
/// softness of 1e-4 (50 times), links of a taut bridge rotate so far for a gap of 0.4 mm that the bridge
/// sags. At 0.1, chains close half as fast.
inline constexpr double kJointCorrectionFraction = 0.5;
inline constexpr double kCorrectionSoftness = 1e-2;
/// The same for Solver::Direct, which closes gaps in each substep: a chain of ten links that is pulled around
/// stays closed within 1e-6 m. With a softness of 1e-2 it opens by 7e-6 m; with 1e-4 bridges sag here as
/// well. If whole gaps were closed only once per step, bridges would sag too.
inline constexpr double kDirectCorrectionFraction = 1;
inline constexpr double kDirectCorrectionSoftness = 1e-3;
/// rad, largest rotation of a body in a step by that correction.
inline constexpr double kMaxCorrectionRotation = 0.125;

/// Natural frequency of the joint spring, as a fraction of the substep rate, and its damping ratio.
inline constexpr double kJointFrequencyRatio = 0.25;
inline constexpr double kJointDampingRatio = 2;

/// Impacts drive revolute joints past their limits farther than velocity iterations can stop. After the
/// motion, angles beyond a limit by more than kLimitSlack (rad) are corrected, in up to kLimitIterations
/// iterations. Each turns a joint by at most kLimitMaxRotation (rad). Joints that began the step beyond a
/// limit are only kept from turning farther.
inline constexpr double kLimitSlack = 0.01;
inline constexpr double kLimitMaxRotation = 0.1;
inline constexpr int kLimitIterations = 4;

/// Fraction of a penetration or joint error that a substep of sequential impulses corrects (Baumgarte, 1972).
/// A larger fraction would oscillate, because the correction stays in the velocities.
inline constexpr double kBaumgarteFraction = 0.2;
/// Penetration that sequential impulses do not correct, as a fraction of the smaller extent, so that resting
/// contacts do not come and go.
inline constexpr double kSlop = 0.002;

/// Depenetration speed, in extents of the smaller shape a second, so that deep overlaps dissolve without a
/// burst.
inline constexpr double kDepenetrationSpeed = 4;
/// Additional depenetration speed between dynamic bodies that an impact has driven into each other, as a
/// fraction of the velocity that their contact impulse gives them in a substep. At 0.2, shapes that overlap
/// initially separate a fifth faster.
inline constexpr double kLoadPushFraction = 0.05;

/// Constant part of the speculative margin, as a fraction of the smaller shape's extent; the possible
/// approach in the step is added.
inline constexpr double kSpeculativeMargin = 0.02;
/// Upper limit of that approach, as a fraction of the smaller extent, because a contact normal is inaccurate
/// at a distance.
inline constexpr double kMaxSpeculativeApproach = 0.5;

/// Relative displacement up to which a manifold is recycled, as a fraction of the smaller extent. The error
/// of the first-order update of separations is of second order in it.
inline constexpr double kRecycleDistance = 0.002;

/// Height of steps that are ignored in a surface of several shapes, as a fraction of the smaller extent of
/// the shapes in contact. Gaps may be three times as wide. With a smaller value, planks that are level to a
/// thousandth would act as stairs; with a larger one, real steps would be ignored.
inline constexpr double kInternalEdgeTolerance = 0.002;
/// Penetration, as a fraction of the smaller extent, above which a shape in such a surface keeps the normal
/// of a single shape, because the corrected normal across an internal edge would push it out fast. Contact
/// points farther apart than this belong to no internal edge.
inline constexpr double kInternalEdgeDepth = 0.25;

/// Margin of a fat AABB, as a fraction of the shape's extent, and number of steps of future motion that it
/// covers for a body without a contact. Larger values mean fewer updates of the tree, but more pairs; bodies
/// in free flight cost a quarter more at 2 steps.
inline constexpr double kAabbMargin = 0.1;
inline constexpr double kPredictedSteps = 4;
/// Largest predicted motion in the fat AABB of a body with contacts, in extents: at most two steps, at least
/// the next one. A crowd that moves together (a drum's filling) has three times as many pairs as contacts at
/// 4 steps, and costs a tenth more instructions than at 2. A body that is stirred by more than an extent per
/// step leaves any AABB after one or two steps. A margin beyond the next step would only add pairs with
/// twenty others that end in the next step.
inline constexpr double kMaxCrowdPrediction = 2;

/// The self-overlap pass runs when the move buffer holds at least kMinOverlapPassMoves shapes, and one in
/// kOverlapPassDivisor of all, most of them without a contact.
inline constexpr int kMinOverlapPassMoves = 64;
inline constexpr int kOverlapPassDivisor = 8;

/// Approach speed up to which contacts do not bounce, in units of |gravity| dt: a body at rest gains
/// |gravity| dt before its contact acts.
inline constexpr double kBounceThresholdSteps = 4;

/// Displacement in a step, as a fraction of the body's smallest half width, above which continuous collision
/// treats the body as fast. Slower bodies cannot pass through anything between two steps.
inline constexpr double kFastFraction = 0.5;

/// Depth of a shape's core below its surface, as a fraction of the body's half width. A body is stopped where
/// its core would enter another shape. With a deeper core, contacts would push the body out on the wrong
/// side; with a shallower one, bodies that slide under load would be stopped.
inline constexpr double kCoreDepth = 0.5;
/// Depth of the inner core, for shapes that loads, joints or the user have already put deeper than
/// kCoreDepth: they get no deeper than this.
inline constexpr double kInnerCoreDepth = 0.9;
/// Penetration, as a fraction of the smaller extent, from which a contact is checked for entering the core.
inline constexpr double kCoreCheckOverlap = 0.002;
/// Overlap, as a fraction of the smaller radius, at which two fast circles without a contact are stopped.
inline constexpr double kCircleStopOverlap = 0.01;
/// Separation at which a fast body stops in front of an obstacle, as a fraction of the smaller extent.
inline constexpr double kImpactTolerance = 1e-3;

/// Iterations of one time-of-impact search, and extra ones for all searches of a step together. Shapes that
/// rotate by thousands of radians beside each other need these. A search that runs out of them reports an
/// impact at the time it has reached: until then the shapes are apart.
inline constexpr int kToiIterations = 64, kToiIterationBudget = 4096;

/// Separation at which a rebound within a step takes place, relative to the bodies' sizes and displacements.
/// The search has rounding errors of some 1e-15 of these. A much smaller value could not distinguish touching
/// from overlapping; a larger one would make impacts too early by that much.
inline constexpr double kReboundTolerance = 1e-14;

/// Maximum number of impacts of a body within a step. At the next impact the body, and the body that it
/// meets, wait for the next step. From kMaxBouncesPerStep on, impacts with restitution below 1 are inelastic,
/// because a box that lands flat has endlessly many, ever smaller impacts. kMaxLandingsPerStep limits these
/// inelastic impacts.
inline constexpr int kMaxImpactsPerStep = 256, kMaxBouncesPerStep = 16;
/// The same limit for impacts without restitution: when a side lands, its corners hit alternately. The last
/// impact ends the landing: no point of the side approaches after it. With a limit of 3, sharp polygons that
/// spin by tens of radians per step lose a part of one step in 7 of 100 landings; with 8 in 1.
inline constexpr int kMaxLandingsPerStep = 8;

/// A body may fall asleep after its speed was below kSleepSpeed, in extents a second, for kSleepTime, s, in
/// which it also moved no farther than the next two constants allow. The speed limit is the quick test, and
/// lets the jitter of contacts pass.
inline constexpr double kSleepSpeed = 0.05;
inline constexpr double kSleepTime = 0.5;

/// Net displacement within kSleepTime, as a fraction of the extent, up to which a body is at rest: a
/// twentieth of what kSleepSpeed lets pass. Slower drifts, belts and motors than 0.005 extents a second still
/// stop. With a larger fraction faster ones stop too; a smaller one keeps small heaps awake that still
/// settle: a pyramid of 20 rows of 0.1 m boxes sleeps after 6.6 s, with twice the fraction after 5.1 s.
inline constexpr double kRestDisplacement = 0.0025;
/// The same limit for bodies on which gravity acts, as a fraction of the free fall in kSleepTime: a body that
/// begins to tip, roll or fall at more than this fraction of gravity is not at rest, whatever its size. It is
/// the lower limit above an extent of 0.5 m on earth (1.2 mm). With ten times as much, large discs stay on
/// slopes of 0.4 degrees (0.04 with this); with a tenth of it, a pyramid of 20 rows of 10 m boxes sleeps
/// after 7.2 s in place of 2.9 s.
inline constexpr double kRestFall = 0.001;
/// Lowest limit, in roundings of the extent: by so much poses of resting bodies change by rounding alone. At
/// 0.001 m/s^2 a float pyramid of 100 m boxes sleeps after 3.4 s without it, after 0.5 s with it. On earth it
/// is below the other limits up to an extent of 1.2 km.
inline constexpr double kRestRoundings = 8;

/// Overlap, as a fraction of the smaller extent, above which no body falls asleep: deeper shapes are being
/// pushed apart, and sleep would keep them deep. It is the largest overlap that the invariant monitor accepts
/// at rest; a heap of 100 rows has 0.002.
inline constexpr double kSleepOverlap = 0.02;

/// Separation, as a fraction of the smaller extent, up to which shapes count as touching for events.
inline constexpr double kTouchSeparation = 1e-3;

/// Approach speed, in extents of the smaller shape a second, from which impacts are reported as hits.
inline constexpr double kHitSpeed = 1;

}  // namespace plumb::tuning
