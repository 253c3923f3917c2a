"""A planted bug for each feature of the world that docs/guide/README.md lists: the feature taken away, or bent, such
that only its own tests can tell. `tests` are the files of tests/ that must notice."""

from mutate import Mutation


def feature(row, file, old, new, *tests):
    """The bug of a row of the guide's table, by the row's first words."""
    return Mutation(row, file, old, new, suite="features", tests=tests)


WORLD, SOLVE, JOINTS, FORCES = "engine/world/", "engine/solve/", "engine/joints/", "engine/forces/"

FEATURES = [
    # Shapes.
    feature("Circle", WORLD + "shapes.cpp", "{disc_corner({}), circle.radius}", "{disc_corner({}), circle.radius / 2}",
            "world/shapes"),
    feature("Capsule", WORLD + "shapes.cpp", "capsule_corners(capsule.start, capsule.end), capsule.radius",
            "capsule_corners(capsule.start, capsule.end), 0", "world/shapes"),
    feature("Box", WORLD + "shapes.cpp", "box_corners(box.width / 2, box.height / 2)",
            "box_corners(box.height / 2, box.width / 2)", "world/shapes"),
    feature("Convex polygon, rounding radius", WORLD + "shapes.cpp", "convex_hull(polygon.points), polygon.radius",
            "convex_hull(polygon.points), 0", "world/shapes"),
    feature("Segment", WORLD + "shapes.cpp", "capsule_corners(segment.start, segment.end), 0",
            "capsule_corners(segment.start, segment.start), 0", "world/shapes"),
    feature("Chain with smooth seams", WORLD + "narrow_phase.cpp",
            "if (!w.forms[contact.shape_a].chain) return collide_convex", "return collide_convex", "world/shapes"),
    feature("Compound", WORLD + "bodies.cpp", "inertia += part.inertia + part.mass *", "inertia += part.inertia + 0 *",
            "world/shapes"),
    feature("Density, or mass, centre and inertia", WORLD + "bodies.cpp",
            "w.bodies[body].mass_given = true; apply_mass(w, body, mass);",
            "w.bodies[body].mass_given = true; apply_mass(w, body, {mass.mass, {}, mass.inertia});", "world/shapes"),
    feature("Reading back", WORLD + "shapes.cpp", "record.hit_events = definition.hit_events,",
            "record.density *= 2, record.hit_events = definition.hit_events,", "world/readers"),

    # Bodies.
    feature("Static, kinematic, dynamic", WORLD + "free_motion.cpp",
            "if (record.type != BodyType::Dynamic) return kick;", "", "world/motion"),
    feature("Kinematic motion to a pose", WORLD + "world_bodies.h",
            "set_velocity(body, velocity); set_angular_velocity(body, angular_velocity); }",
            "set_velocity(body, velocity); }", "world/motion"),
    feature("Locked axes", WORLD + "free_motion.cpp", "kick.locked_x = record.lock_x, kick.locked_y = record.lock_y;",
            "kick.locked_x = record.lock_x;", "world/motion"),
    feature("Gravity scale", WORLD + "free_motion.cpp", "own.gravity_scale * gravity", "gravity", "world/motion"),
    feature("Exponential damping", WORLD + "free_motion.cpp", "decay(time * double(own.linear_damping))",
            "1 / (1 + time * double(own.linear_damping))", "world/motion"),

    # Materials.
    feature("Friction", SOLVE + "soft_contacts.cpp", "most = c.friction * pressure;", "most = pressure / 2;",
            "world/contacts"),
    feature("Restitution", SOLVE + "bounces.cpp", "rebound = c.restitution * strike;", "rebound = strike;",
            "world/restitution"),
    feature("Rolling resistance", WORLD + "narrow_phase.cpp",
            "std::max(a.rolling_resistance, b.rolling_resistance)", "std::min(a.rolling_resistance, b.rolling_resistance)",
            "world/contacts"),
    feature("Surface speed (conveyor)", WORLD + "narrow_phase.cpp", "(a.surface_speed + b.surface_speed)",
            "(a.surface_speed - b.surface_speed)", "world/contacts"),
    feature("Combine rules", "engine/scene/scene.cpp", "case Combine::Average: return (a + b) / 2;",
            "case Combine::Average: return a;", "world/contacts"),
    feature("Combine rules of your own", WORLD + "world.cpp",
            "data_->friction_rule = friction, data_->restitution_rule = restitution;",
            "data_->restitution_rule = friction, data_->friction_rule = restitution;", "world/readers"),
    feature("Change of material", WORLD + "shapes.cpp", "put_material(w.shapes[shape], material);", "",
            "world/contacts"),

    # Joints.
    feature("Distance: rod, spring, rope, motor", JOINTS + "distance_joint.cpp",
            "along.add_limits(definition.range);", "", "solve/joint_set", "joints/kinds"),
    feature("Revolute: limits, motor, spring", JOINTS + "revolute_joint.cpp",
            "rules.turn.add_motor(definition.motor);", "", "solve/joint_set", "joints/kinds"),
    feature("Prismatic: limits, motor, spring", JOINTS + "prismatic_joint.cpp",
            "along.add_spring(definition.spring, definition.target_translation);",
            "along.add_spring(definition.spring, 0);", "solve/joint_set", "joints/kinds"),
    feature("Weld, rigid or soft", JOINTS + "weld_joint.cpp", "if (definition.angular_spring) turn =",
            "if (definition.linear_spring && definition.angular_spring) turn =", "solve/joint_set", "joints/kinds"),
    feature("Wheel", JOINTS + "wheel_joint.cpp", "rules.axial[1].add({});", "", "solve/joint_set", "joints/kinds"),
    feature("Motor (follows a pose)", JOINTS + "motor_joint.cpp", ".max_force = definition.max_torque",
            ".max_force = definition.max_force", "solve/joint_set", "joints/kinds"),
    feature("Mouse", JOINTS + "mouse_joint.cpp", ".max_force = definition.max_force", ".max_force = 1e9",
            "solve/joint_set", "joints/kinds"),
    feature("Gear", JOINTS + "gear_joint.cpp", "reference(definition.phase) {}", "reference(0) {}", "solve/joint_set",
            "joints/kinds"),
    feature("Pulley", JOINTS + "pulley_joint.cpp", "ratio(static_cast<Real>(definition.ratio)) {}", "ratio(1) {}",
            "solve/joint_set", "joints/kinds"),
    feature("Ratchet", JOINTS + "ratchet_joint.cpp", "definition.tooth > 0 ? 1.0 : -1.0", "1.0", "solve/joint_set",
            "joints/kinds"),
    feature("Friction (top-down)", JOINTS + "friction_joint.cpp",
            "rules.turn.add({.role = RowRole::Motor, .max_force = definition.max_torque});",
            "rules.turn.add({.role = RowRole::Motor, .max_force = definition.max_force});", "solve/joint_set",
            "joints/kinds"),
    feature("Break at a force or torque", WORLD + "joints.cpp",
            "double(w.joint_set.torque(record.slot, rate)) > record.break_torque", "false", "world/world"),
    feature("Collision of joined bodies", WORLD + "contacts.cpp",
            "[](const JointRecord& joint) { return !joint.collide; }", "[](const JointRecord&) { return true; }",
            "world/world"),
    feature("Change and reading", SOLVE + "joint_set.cpp",
            "hinge_impulse(p, joint, [&](Vec2<Real>& now) { now = impulse; });", "", "solve/joint_set",
            "solve/joint_state"),
    feature("Ragdolls", SOLVE + "joint_rule.h", "if (c > 0) {", "if (c > -0.2) {", "world/ragdoll"),
    feature("The same joints in `Simulation`", JOINTS + "kind_of.cpp",
            "j.length, j.spring, j.range, j.motor};", "j.length, j.spring, {}, j.motor};", "simulation/joints",
            "simulation/precise_joints"),

    # Forces.
    feature("Force, torque, impulse", WORLD + "free_motion.cpp", "t * motion.inverse_inertia * load.torque", "0",
            "world/motion"),
    feature("Gravity", WORLD + "world.cpp",
            "data_->bodies.for_each([&](int body, BodyRecord<Real>&) { wake_body(*data_, body); }); } "
            "template <class Real> Vec2d BasicWorld<Real>::gravity() const {",
            "} template <class Real> Vec2d BasicWorld<Real>::gravity() const {", "world/motion", "world/resting"),
    feature("Point attraction", WORLD + "force_laws.cpp", "reaction -= force;", "reaction += force;", "world/forces"),
    feature("Linear, quadratic drag", FORCES + "fluid_drag.h", "const double factor = coefficient * std::sqrt("
            "length_squared(middle));", "const double factor = first;", "world/forces"),
    feature("Wind on edges", FORCES + "wind.cpp", "if (into <= 0) return;", "", "world/forces"),
    feature("Buoyancy in water", FORCES + "submerged.cpp", "if (p.y >= 0 && q.y >= 0) return;",
            "if (p.y >= 0 || q.y >= 0) return;", "world/fluids"),
    feature("Spring without a joint", FORCES + "elastic_spring.h", "length + 0.5 * dt * rate - spring.rest_length",
            "length - spring.rest_length", "world/forces"),
    feature("Explosion", FORCES + "blast.h", "blast.impulse * (1 - distance / blast.radius)", "blast.impulse",
            "world/forces"),
    feature("A law of your own", WORLD + "force_laws.cpp", "w.body_data.get(body)};", "0};", "world/forces"),

    # Contacts.
    feature("Persistent manifolds, feature ids", WORLD + "narrow_phase.cpp", "if (features[j] != from.feature) continue;",
            "if (features[j] == from.feature) continue;", "world/contacts", "world/resting"),
    feature("Begin, end", WORLD + "contacts.cpp", "(touching ? w.log().begin : w.log().end)", "(w.log().begin)",
            "world/contacts"),
    feature("Hits", WORLD + "narrow_phase.cpp", "-static_cast<double>(c.approach[hardest])",
            "static_cast<double>(c.approach[hardest])", "world/contacts"),
    feature("Pre-solve hook (one-way platforms)", WORLD + "narrow_phase.cpp",
            "(contact.pre_solve && w.pre_solve && !w.pre_solve(c.contact, c))",
            "(contact.pre_solve && w.pre_solve && w.pre_solve(c.contact, c) && false)", "world/contacts"),
    feature("Sensors", WORLD + "sensors.cpp", "may_touch(w.shapes[shape].filter, w.shapes[other].filter) && "
            "overlap(w, shape, other)", "may_touch(w.shapes[shape].filter, w.shapes[other].filter)", "world/contacts"),
    feature("Category, mask, group", "engine/scene/scene.cpp",
            "if (a.group != 0 && a.group == b.group) return a.group > 0;", "", "world/contacts"),

    # Queries and movement.
    feature("Ray, shape cast, overlap, nearest, point", WORLD + "queries.cpp",
            "return !contains(placed.convex(), Vec2d{}) || visit(shape_id(w, shape));",
            "return visit(shape_id(w, shape));", "world/queries"),
    feature("Filters of queries", WORLD + "queries.cpp", "if (w.forms[shape].sensor && !filter.sensors) return false;",
            "", "world/queries_use"),
    feature("Continuous collision", WORLD + "step.cpp",
            "if (w.settings.continuous) stop_at_impacts(w, static_cast<Real>(dt));", "", "world/resting"),
    feature("Islands, sleeping, waking", WORLD + "islands.cpp",
            "for_each_tie(w, body, [&](int other) { wake_body(w, other); });", "", "world/resting"),
    feature("Character mover", WORLD + "mover.cpp", "if (step_up(speed)) return true;", "", "world/mover"),

    # State.
    feature("Snapshot and restore", WORLD + "snapshot.cpp", "check_state(fresh);", "fresh.time = 0; check_state(fresh);",
            "world/snapshot"),
    feature("State hash", WORLD + "world.cpp",
            "mix(w.motion[body].velocity), mix(w.motion[body].angular_velocity);", "mix(w.motion[body].velocity);",
            "world/world", "world/snapshot"),
    feature("Rollback", WORLD + "rollback.cpp", "copy_state(*ring_[place_of(nth)], world_->data()); size_ = nth + 1;",
            "copy_state(*ring_[place_of(nth)], world_->data());", "world/rollback"),
    feature("Recorder and replay", WORLD + "replay.cpp", "report_.first_difference = world_.step_count();",
            "report_.first_difference = world_.step_count() + 1;", "world/recorder"),
    feature("Same bits in all builds", WORLD + "free_motion.cpp", "(Real(0.5) * dt) * (before + motion.velocity)",
            "dt * (Real(0.5) * before + Real(0.5000001) * motion.velocity)", "world/world"),
    feature("Debug drawing", WORLD + "debug_draw.cpp", "out_.segment(pulley->ground_a, pulley->ground_b, "
            "DrawRole::JointLine);", "", "world/debug_draw"),

    # Solvers.
    feature("Soft steps", WORLD + "soft_step.cpp", "relax_contacts(bodies.motion, w.graph, contacts);", "",
            "world/resting", "world/restitution"),
    feature("Direct solution of small islands (heavy on light)", WORLD + "soft_step.cpp",
            "prepare_direct_islands(w, joints);", "", "world/resting", "world/world"),
    feature("Sequential impulses", WORLD + "sequential_impulses.cpp",
            "sweep < w.settings.iterations", "sweep < 1", "world/solvers",
            "world/sequential_impulses"),
    feature("Jakobsen's projections", WORLD + "jakobsen.cpp", "sweep < w.settings.iterations", "sweep < 1",
            "world/solvers", "world/jakobsen"),
    feature("XPBD", WORLD + "xpbd.cpp", "correct_contact_velocities(bodies.motion, w.graph, contacts);", "",
            "world/solvers", "world/xpbd"),
    feature("Direct solve of articulated islands", WORLD + "direct_islands.cpp",
            "w.settings.solver == Solver::Direct && !island.joints.empty();",
            "w.settings.solver == Solver::Direct && island.joints.size() > 1000;", "world/direct_solver"),

    # Ground rules.
    feature("Scenes are one way in", WORLD + "add_scene.cpp", ".break_force = j.break_force,", ".break_force = 0,",
            "world/add_scene"),
    feature("Constants in one place", WORLD + "narrow_phase.cpp",
            "Real(tuning::kContactReach) * smaller", "Real(tuning::kContactReach)", "world/world"),
    feature("Handles that know what is gone", WORLD + "slots.h", "generations_[index] == generation && ", "",
            "world/world"),
    feature("Typed errors", WORLD + "world.cpp", "if (substeps < 1 || substeps > 1000) {", "if (substeps < 1) {",
            "world/world"),
    feature("Quarantine of bodies that go bad", WORLD + "quarantine.cpp",
            "if (!w.settings.quarantine) report(why);", "report(why);", "world/quarantine"),
    feature("No allocation in a warm step", WORLD + "step.cpp", "const double h = dt / substeps;",
            "const double h = dt / substeps; w.scratch.fractions = std::vector<double>(8);", "world/world"),
]
