"""The planted bugs. Runs of white space in `old` stand for any white space, so that laying the sources out anew
does not lose a place."""

from mutate import Mutation

MUTATIONS = [
    # Forces and torques.
    Mutation("gravity twice, realtime", "engine/simulation/realtime.cpp",
             "bodies_.acceleration[body].velocity = gravity_;",
             "bodies_.acceleration[body].velocity = gravity_ + gravity_;"),
    Mutation("gravity twice, precise flight", "engine/simulation/precise_flight.cpp",
             "? gravity_ : Vec2d{}", "? gravity_ + gravity_ : Vec2d{}"),
    Mutation("flipped r x F", "engine/forces/point_force.h",
             "cross(pose.rotation * point, acting)", "cross(acting, pose.rotation * point)"),
    Mutation("thrust does not turn with the body", "engine/forces/point_force.h",
             "? pose.rotation * force : force", "? force : force"),
    Mutation("drag pushes", "engine/forces/linear_drag.h",
             "{-coefficient * twist.velocity, 0}", "{coefficient * twist.velocity, 0}"),
    Mutation("half of the quadratic drag", "engine/forces/quadratic_drag.h",
             "(-coefficient * speed)", "(-coefficient / 2 * speed)"),
    Mutation("a force does not end", "engine/forces/laws.cpp",
             "if (start <= t0 && end >= t1) return 1;", "if (start <= t0) return 1;"),

    # Masses.
    Mutation("inertia of a box by 1/6", "engine/scene/geometry.cpp",
             "box.height * box.height) / 12", "box.height * box.height) / 6"),
    Mutation("inertia of a ring for a disc", "engine/scene/geometry.cpp",
             "{}, circle.radius * circle.radius / 2}", "{}, circle.radius * circle.radius}"),
    Mutation("mass for inverse mass, realtime", "engine/simulation/realtime.cpp",
             "dynamic ? 1 / body.mass : 0", "dynamic ? body.mass : 0"),
    Mutation("mass for inverse mass, precise", "engine/simulation/precise_motion.cpp",
             "inverse.mass[i] = 1 / body.mass;", "inverse.mass[i] = body.mass;"),

    # Time stepping.
    Mutation("a lost substep", "engine/simulation/realtime.cpp",
             "substep < accuracy_.substeps;", "substep + 1 < accuracy_.substeps;"),
    Mutation("the second half kick is missing", "engine/simulation/velocity_verlet.cpp",
             "kick(half); }); // v += a' h/2", "}); // v += a' h/2"),
    Mutation("a wrong digit in a Runge-Kutta weight", "engine/integrate/dop853_coefficients.h",
             "3.1116436695781989440891606237e-1", "3.1116463695781989440891606237e-1"),
    Mutation("flight falls g t^2", "engine/simulation/precise_flight.cpp",
             "(0.5 * s) * arc.motion.acceleration", "s * arc.motion.acceleration"),

    # Joints.
    Mutation("an anchor does not turn with its body", "engine/joints/revolute.cpp",
             "arm_b = pose_b.rotation * anchor_b", "arm_b = anchor_b"),
    Mutation("the sign of a joint's lever", "engine/joints/revolute.cpp",
             "arm_a.y, -arm_b.y", "arm_a.y, arm_b.y"),
    Mutation("centripetal bias the wrong way", "engine/joints/revolute.cpp",
             "spin_a * arm_a - spin_b * arm_b", "spin_b * arm_b - spin_a * arm_a"),
    Mutation("no projection on the joints", "engine/simulation/realtime.cpp",
             "stage(JointHold, [&] { joints_->finish_hold(bodies_, h); });", ""),

    # Contacts.
    Mutation("normal flipped", "engine/collide/circles.cpp",
             "{between.x / distance, between.y / distance}", "{-between.x / distance, -between.y / distance}"),
    Mutation("action without reaction", "engine/solve/impact_stage.cpp",
             "jump_[contact.a].velocity -= contact.inverse_mass_a * impulse;",
             "jump_[contact.a].velocity += contact.inverse_mass_a * impulse;"),
    Mutation("restitution from the wrong velocity, realtime", "engine/solve/impact.cpp",
             "-impact.restitution * impact.velocity[i]", "-impact.restitution * impact.velocity[i + 1]"),
    Mutation("restitution of the wrong sign, precise", "engine/simulation/precise_impacts.cpp",
             "-restitution(touch, index) * closing", "restitution(touch, index) * closing"),
    Mutation("impacts at the wrong time", "engine/solve/time_of_contact.cpp",
             "t - point.separation / speed", "t + point.separation / speed"),
    Mutation("flipped r x n in a contact", "engine/solve/contact_solver.cpp",
             "pair.b.angular_velocity += contact.inverse_inertia_b * cross(point.arm_b, impulse);",
             "pair.b.angular_velocity += contact.inverse_inertia_b * cross(impulse, point.arm_b);"),
    Mutation("friction from a stale impulse", "engine/solve/contact_solver.cpp",
             "contact.friction * (impulse.normal + earlier.normal)", "contact.friction * earlier.normal"),
    Mutation("product for the geometric mean", "engine/scene/scene.cpp",
             "return std::sqrt(a * b);", "return a * b;"),

    # Precise.
    Mutation("precise: a hinge's push turns its body the wrong way", "engine/simulation/precise_hinges.cpp",
             "motion[line.b].angular_velocity += line.inertia_b * cross(block.arm_b, push);",
             "motion[line.b].angular_velocity -= line.inertia_b * cross(block.arm_b, push);", "precise"),
    Mutation("precise: a limit takes no part in impacts", "engine/simulation/precise_impacts.cpp",
             "return t.stop.has_value() || &t == &touches[worst];", "return &t == &touches[worst];", "precise"),
    Mutation("precise: a motor at its speed has no force one way", "engine/solve/coulomb.cpp",
             "q_[n_ + f + k] = 2 * bound(free_[k]);", "q_[n_ + f + k] = 0;", "precise"),
    Mutation("precise: ropes are looked at where steps end", "engine/simulation/precise_stops.cpp",
             "return std::max(f / speed, std::min(bent, half));",
             "return std::max(until - time, std::min(bent, half));", "precise"),
    Mutation("precise: friction pushes what slips", "engine/simulation/precise_contact_motion.cpp",
             "sum(rows.normal, -patch.mode * patch.friction, rows.tangent)",
             "sum(rows.normal, patch.mode * patch.friction, rows.tangent)", "precise"),
    Mutation("precise: the companion is no finer than the run", "engine/simulation/precise_companion.cpp",
             "kFiner = 0.1,", "kFiner = 1,", "precise"),

    # The real-time world.
    Mutation("world: a limit pulls", "engine/solve/joint_rule.h",
             "return role == RowRole::Limit ? 0 : -most;", "return -most;", "world"),
]
