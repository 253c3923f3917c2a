#ifndef PLUMB_PLUMB_H
#define PLUMB_PLUMB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The C interface of plumb, a 2D rigid-body engine: C99, SI units, double precision, y up, angles in rad and
 * counter-clockwise.
 *
 * Every function that fails sets the error of the calling thread (`plumb_last_error`), changes nothing else,
 * and returns a `plumb_status` or, where it has another result, the zero value or an invalid handle of that
 * result. The error stays until `plumb_clear_error`, so a program may make many calls and look once. Readers
 * cost a few nanoseconds; those that fill arrays cost one call for all bodies.
 *
 * A world is used by one thread at a time. Queries may run in parallel with each other. */

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32) && defined(PLUMB_SHARED)
#ifdef PLUMB_BUILDS
#define PLUMB_API __declspec(dllexport)
#else
#define PLUMB_API __declspec(dllimport)
#endif
#elif defined(__wasm__) && defined(PLUMB_BUILDS)
#define PLUMB_API __attribute__((used, visibility("default")))
#elif defined(__GNUC__)
#define PLUMB_API __attribute__((visibility("default")))
#else
#define PLUMB_API
#endif

/* ---- Errors ------------------------------------------------------------------------------------------ */

typedef enum plumb_status {
  PLUMB_OK = 0,
  PLUMB_SYNTAX,      /* not JSON, or JSON of the wrong shape */
  PLUMB_VALUE,       /* a value out of its range: NaN, negative mass, dt <= 0 */
  PLUMB_NAME,        /* an unknown or duplicate name, a handle of a destroyed object */
  PLUMB_UNSUPPORTED, /* well formed, but not supported */
  PLUMB_RUN,         /* the run could not continue: a non-finite state, a work limit */
  PLUMB_IO,          /* a file that cannot be opened, read or written */
  PLUMB_MEMORY,      /* memory ran out */
  PLUMB_INTERNAL     /* an error of another kind; the message says which */
} plumb_status;

/* An error; its texts are valid until the thread's next failure or `plumb_clear_error`. */
typedef struct plumb_error {
  plumb_status status;
  const char* message; /* the whole sentence */
  const char* subject; /* the thing, for example "body 'ball'"; may be empty, like the next two */
  const char* field;   /* its member, for example "mass" */
  const char* value;   /* the value given */
  int line;            /* of a text, from 1; 0 without a text */
} plumb_error;

PLUMB_API plumb_error plumb_last_error(void); /* PLUMB_OK and empty texts if there is none */
PLUMB_API void plumb_clear_error(void);
PLUMB_API const char* plumb_version(void); /* "0.1.0" */

/* ---- Plain data -------------------------------------------------------------------------------------- */

typedef struct plumb_vec2 {
  double x, y;
} plumb_vec2;

/* Position of the body's origin, m, and its angle, rad; whole turns are counted. */
typedef struct plumb_pose {
  plumb_vec2 position;
  double angle;
} plumb_pose;

/* Velocity of the centre of mass, m/s, and angular velocity, rad/s. */
typedef struct plumb_velocity {
  plumb_vec2 linear;
  double angular;
} plumb_velocity;

/* State of a body at its centre of mass. */
typedef struct plumb_body_state {
  plumb_vec2 position;     /* m */
  double angle;            /* rad */
  plumb_vec2 velocity;     /* m/s */
  double angular_velocity; /* rad/s */
} plumb_body_state;

/* A box along the axes, m. */
typedef struct plumb_box_bounds {
  plumb_vec2 lower, upper;
} plumb_box_bounds;

/* Handles of a world's objects. They know when their object is gone. */
#define PLUMB_NO_INDEX 0xFFFFFFFFu /* index of an invalid handle */
typedef struct plumb_body {
  uint32_t index, generation;
} plumb_body;
typedef struct plumb_shape {
  uint32_t index, generation;
} plumb_shape;
typedef struct plumb_joint {
  uint32_t index, generation;
} plumb_joint;
typedef struct plumb_chain {
  uint32_t index, generation;
} plumb_chain;

typedef enum plumb_precision { PLUMB_FLOAT, PLUMB_DOUBLE } plumb_precision;
typedef enum plumb_body_type { PLUMB_STATIC, PLUMB_KINEMATIC, PLUMB_DYNAMIC } plumb_body_type;
typedef enum plumb_combine {
  PLUMB_GEOMETRIC_MEAN,
  PLUMB_PRODUCT,
  PLUMB_MAXIMUM,
  PLUMB_MINIMUM,
  PLUMB_AVERAGE
} plumb_combine;
typedef enum plumb_solver {
  PLUMB_SOFT_STEPS,
  PLUMB_SEQUENTIAL_IMPULSES,
  PLUMB_JAKOBSEN,
  PLUMB_XPBD,
  PLUMB_DIRECT
} plumb_solver;
typedef enum plumb_integrator {
  PLUMB_VELOCITY_VERLET,
  PLUMB_SEMI_IMPLICIT_EULER,
  PLUMB_EXPLICIT_EULER
} plumb_integrator;

/* Speeds at which behaviour changes, m/s. Negative: by the sizes of the shapes or by gravity. */
typedef struct plumb_thresholds {
  double hit;    /* approach from which impacts are hits */
  double bounce; /* approach up to which nothing bounces */
  double sleep;  /* up to which a body may fall asleep */
} plumb_thresholds;

/* Settings of a world. */
typedef struct plumb_world_definition {
  plumb_precision precision; /* of the solver; positions are always double */
  plumb_vec2 gravity;        /* m/s^2 */
  plumb_combine combine_friction, combine_restitution;
  bool sleeping;   /* islands at rest fall asleep */
  bool continuous; /* fast bodies do not tunnel */
  plumb_solver solver;
  plumb_integrator integrator;
  int iterations;      /* a substep, 1..1000: sequential impulses and Jakobsen */
  bool direct_islands; /* soft steps solve small islands directly */
  bool quarantine;     /* takes non-finite bodies out; false: PLUMB_RUN ends the step */
  plumb_thresholds thresholds;
  int threads; /* that share a step, 1..64: the same bits for every number; not in snapshots */
} plumb_world_definition;

/* Mass of a body that does not follow from its shapes. */
typedef struct plumb_mass {
  double mass;       /* kg, > 0 */
  plumb_vec2 centre; /* m, in the body's frame */
  double inertia;    /* kg m^2 about the centre of mass, > 0 */
} plumb_mass;

typedef struct plumb_body_definition {
  const char* name; /* for messages; may be NULL */
  plumb_body_type type;
  plumb_vec2 position;     /* m, of the body's origin */
  double angle;            /* rad */
  plumb_vec2 velocity;     /* m/s */
  double angular_velocity; /* rad/s */
  bool mass_given;         /* false: `mass` is ignored, densities count */
  plumb_mass mass;
  double gravity_scale;
  double linear_damping, angular_damping; /* 1/s, >= 0: the velocity decays as exp(-damping t) */
  bool lock_x, lock_y, lock_rotation;
  bool may_sleep, awake;
  uint64_t user_data;
  bool continuous; /* it does not tunnel */
} plumb_body_definition;

typedef enum plumb_shape_kind {
  PLUMB_CIRCLE,
  PLUMB_BOX,
  PLUMB_CAPSULE,
  PLUMB_POLYGON,
  PLUMB_SEGMENT
} plumb_shape_kind;

/* Geometry of a shape; made by `plumb_circle` and the like. Members that a kind does not use are ignored. */
typedef struct plumb_geometry {
  plumb_shape_kind kind;
  double radius;            /* m, of a circle or capsule > 0, of a polygon's rounding >= 0 */
  double width, height;     /* m, of a box, > 0 */
  plumb_vec2 start, end;    /* m, of a capsule or segment */
  const plumb_vec2* points; /* m, of a polygon: 3 or more in any order; their hull, of at most 64 corners */
  size_t point_count;
} plumb_geometry;

typedef struct plumb_material {
  double friction;           /* Coulomb's coefficient, >= 0 */
  double restitution;        /* Newton's coefficient, 0..1 */
  double rolling_resistance; /* lever arm over the rounding radius, >= 0 */
  double surface_speed;      /* m/s, positive to the right of someone standing on the surface */
} plumb_material;

/* Shapes touch if each one's category is in the other's mask; an equal non-zero group takes precedence:
 * positive always, negative never. */
typedef struct plumb_filter {
  uint64_t category, mask;
  int32_t group;
} plumb_filter;

typedef struct plumb_shape_definition {
  plumb_geometry geometry;
  plumb_vec2 position; /* m, in the body's frame */
  double angle;        /* rad, in the body's frame */
  double density;      /* kg/m^2, >= 0 */
  plumb_material material;
  plumb_filter filter;
  bool sensor, hit_events, pre_solve;
  uint64_t user_data;
} plumb_shape_definition;

/* A line of one-sided segments: the front is to the right when walking from point to point. */
typedef struct plumb_chain_definition {
  const plumb_vec2* points; /* m, in the body's frame; 2 or more, 3 or more when closed */
  size_t point_count;
  bool closed;
  plumb_material material; /* of all segments, unless there are `materials` */
  plumb_filter filter;
  bool sensor, hit_events, pre_solve;
  uint64_t user_data;
  const plumb_material* materials; /* one per segment, or none */
  size_t material_count;
} plumb_chain_definition;

/* Parts of joints; `on` says that they are there. */
typedef struct plumb_spring {
  bool on;
  double hertz;         /* 1/s, > 0 */
  double damping_ratio; /* >= 0, 1 is critical */
} plumb_spring;
typedef struct plumb_range {
  bool on;
  double lower, upper; /* rad or m, lower <= upper */
} plumb_range;
typedef struct plumb_motor {
  bool on;
  double speed;     /* m/s or rad/s */
  double max_force; /* N or N m, >= 0 */
} plumb_motor;

typedef enum plumb_joint_kind {
  PLUMB_DISTANCE,
  PLUMB_REVOLUTE,
  PLUMB_PRISMATIC,
  PLUMB_WELD,
  PLUMB_WHEEL,
  PLUMB_MOTOR,
  PLUMB_MOUSE,
  PLUMB_GEAR,
  PLUMB_PULLEY,
  PLUMB_RATCHET,
  PLUMB_FRICTION
} plumb_joint_kind;

/* A joint; `plumb_default_joint(kind)` has the kind's defaults. The last words name the kinds that use a
 * member; other kinds ignore it. */
typedef struct plumb_joint_definition {
  plumb_joint_kind kind;
  bool collide;                     /* the joined bodies may collide */
  double break_force, break_torque; /* N, N m; 0: never */
  uint64_t user_data;
  double report_force, report_torque;         /* N, N m, beyond which its load is an event; 0: never */
  plumb_vec2 anchor_a, anchor_b;              /* m, in the bodies' frames; all but motor and gear */
  plumb_vec2 axis;                            /* in a's frame, any length > 0: prismatic, wheel */
  double reference_angle;                     /* rad: revolute, prismatic, weld */
  plumb_spring spring;                        /* distance, revolute, prismatic, wheel, motor, mouse */
  plumb_spring linear_spring, angular_spring; /* weld */
  plumb_range limits;                         /* rad or m: distance, revolute, prismatic, wheel */
  plumb_motor motor;                          /* distance, revolute, prismatic, wheel */
  double length;                              /* m: distance; pulley, where < 0 means as placed */
  double target_angle;                        /* rad: revolute's spring, motor */
  double target_translation;                  /* m: prismatic's spring */
  plumb_vec2 target_position;                 /* m: motor in a's frame, mouse in the world */
  double max_force, max_torque;               /* N, N m: motor, mouse, friction */
  double ratio;                               /* gear (not 0), pulley (> 0) */
  double phase;                               /* rad: gear, ratchet */
  double tooth;                               /* rad, not 0: ratchet */
  plumb_vec2 ground_a, ground_b;              /* m, in the world: pulley */
} plumb_joint_definition;

PLUMB_API plumb_world_definition plumb_default_world(void);
PLUMB_API plumb_body_definition plumb_default_body(void);
PLUMB_API plumb_shape_definition plumb_default_shape(void);
PLUMB_API plumb_chain_definition plumb_default_chain(void);
PLUMB_API plumb_joint_definition plumb_default_joint(plumb_joint_kind kind);
PLUMB_API plumb_geometry plumb_circle(double radius);
PLUMB_API plumb_geometry plumb_box(double width, double height);
PLUMB_API plumb_geometry plumb_capsule(plumb_vec2 start, plumb_vec2 end, double radius);
PLUMB_API plumb_geometry plumb_polygon(const plumb_vec2* points, size_t count, double radius);
PLUMB_API plumb_geometry plumb_segment(plumb_vec2 start, plumb_vec2 end);

/* ---- World ------------------------------------------------------------------------------------------- */

typedef struct plumb_world plumb_world;

PLUMB_API plumb_world* plumb_world_create(const plumb_world_definition* definition); /* NULL: the defaults */
/* NULL: nothing. From a callback of the world, or of a call of it, it is refused like any change: it sets the
 * error PLUMB_UNSUPPORTED and the world stays. */
PLUMB_API void plumb_world_destroy(plumb_world* world);
/* Advances by `dt` s in `substeps` substeps, 4 as a rule. */
PLUMB_API plumb_status plumb_world_step(plumb_world* world, double dt, int substeps);
PLUMB_API double plumb_world_time(const plumb_world* world); /* s */
PLUMB_API int64_t plumb_world_step_count(const plumb_world* world);
/* The settings as they are now; it could be created again. */
PLUMB_API plumb_world_definition plumb_world_get_definition(const plumb_world* world);
/* Hash of all bodies' states: equal on every platform and in every language for the same calls. */
PLUMB_API uint64_t plumb_world_hash(const plumb_world* world);
/* Hash of all that the future depends on. */
PLUMB_API uint64_t plumb_world_full_hash(const plumb_world* world);

PLUMB_API plumb_status plumb_world_set_gravity(plumb_world* world, plumb_vec2 gravity);
PLUMB_API plumb_vec2 plumb_world_gravity(const plumb_world* world);
PLUMB_API plumb_status plumb_world_set_sleeping(plumb_world* world, bool on);
PLUMB_API plumb_status plumb_world_set_continuous(plumb_world* world, bool on);
PLUMB_API plumb_status plumb_world_set_solver(plumb_world* world, plumb_solver solver);
PLUMB_API plumb_status plumb_world_set_iterations(plumb_world* world, int iterations);
PLUMB_API plumb_status plumb_world_set_direct_islands(plumb_world* world, bool on);
PLUMB_API plumb_status plumb_world_set_quarantine(plumb_world* world, bool on);
PLUMB_API plumb_status plumb_world_set_thresholds(plumb_world* world, plumb_thresholds thresholds);
PLUMB_API plumb_thresholds plumb_world_get_thresholds(const plumb_world* world);
/* Combine rules of your own, pure and symmetric; NULL: those of the definition. */
typedef double (*plumb_combine_function)(double a, double b);
PLUMB_API plumb_status plumb_world_combine_with(plumb_world* world, plumb_combine_function friction,
                                                plumb_combine_function restitution);

/* Threads that share a step: PLUMB_VALUE for a number out of 1..64, PLUMB_RUN if the system has no more. */
PLUMB_API plumb_status plumb_world_set_threads(plumb_world* world, int threads);
/* A program's own job system, through which a world runs the loops of a step. Both functions must be given;
 * the same bits come out however they run the tasks. */
typedef void (*plumb_task)(void* data, int item);
typedef struct plumb_task_system {
  /* Starts `count` tasks: `task(data, i)` once for each i from 0 to count - 1, on any threads, or in
   * `finish`. Returns a handle for `finish`, which may be NULL. */
  void* (*start)(void* user, plumb_task task, void* data, int count);
  void (*finish)(void* user, void* started); /* returns after all tasks of a start have returned */
  void* user;                                /* passed on to both; outlives the world */
} plumb_task_system;
/* Shares steps with `threads - 1` tasks at a time; NULL: the world's own threads again. */
PLUMB_API plumb_status plumb_world_set_task_system(plumb_world* world, const plumb_task_system* tasks);

typedef struct plumb_counts {
  int bodies, awake, shapes, contacts, touching, joints;
} plumb_counts;
PLUMB_API plumb_counts plumb_world_counts(const plumb_world* world);

/* Wall time of a step's stages since profiling was switched on, ns. */
typedef struct plumb_profile {
  double broad_phase, narrow_phase, solver, finalize, continuous, events, sleep;
  int64_t steps;
} plumb_profile;
PLUMB_API plumb_status plumb_world_set_profiling(plumb_world* world, bool on);
PLUMB_API plumb_profile plumb_world_profile(const plumb_world* world);

/* Arrays of all bodies, in the order of their indices. Each fills at most `capacity` elements and returns how
 * many there are in all; `out` may be NULL if `capacity` is 0. */
PLUMB_API size_t plumb_world_bodies(const plumb_world* world, plumb_body* out, size_t capacity);
PLUMB_API size_t plumb_world_poses(const plumb_world* world, plumb_pose* out, size_t capacity);
PLUMB_API size_t plumb_world_velocities(const plumb_world* world, plumb_velocity* out, size_t capacity);
PLUMB_API size_t plumb_world_states(const plumb_world* world, plumb_body_state* out, size_t capacity);

/* Bodies whose pose the last step may have changed; not sorted. */
PLUMB_API size_t plumb_world_moved(const plumb_world* world, plumb_body* out, size_t capacity);

/* ---- Bodies ------------------------------------------------------------------------------------------ */

PLUMB_API plumb_body plumb_body_create(plumb_world* world, const plumb_body_definition* definition,
                                       const plumb_shape_definition* shapes, size_t shape_count);
PLUMB_API plumb_status plumb_body_destroy(plumb_world* world, plumb_body body); /* with shapes and joints */
PLUMB_API bool plumb_body_valid(const plumb_world* world, plumb_body body);

PLUMB_API plumb_body_state plumb_body_get_state(const plumb_world* world, plumb_body body);
PLUMB_API plumb_pose plumb_body_pose(const plumb_world* world, plumb_body body);
PLUMB_API plumb_vec2 plumb_body_position(const plumb_world* world, plumb_body body); /* m, of the origin */
PLUMB_API plumb_vec2 plumb_body_centre(const plumb_world* world, plumb_body body);   /* m, centre of mass */
PLUMB_API double plumb_body_angle(const plumb_world* world, plumb_body body);        /* rad */
PLUMB_API plumb_vec2 plumb_body_velocity(const plumb_world* world, plumb_body body);
PLUMB_API double plumb_body_angular_velocity(const plumb_world* world, plumb_body body);
PLUMB_API plumb_vec2 plumb_body_velocity_at(const plumb_world* world, plumb_body body, plumb_vec2 point);
PLUMB_API plumb_vec2 plumb_body_world_point(const plumb_world* world, plumb_body body, plumb_vec2 local);
PLUMB_API plumb_vec2 plumb_body_local_point(const plumb_world* world, plumb_body body, plumb_vec2 point);

PLUMB_API plumb_status plumb_body_set_pose(plumb_world* world, plumb_body body, plumb_pose pose);
PLUMB_API plumb_status plumb_body_set_velocity(plumb_world* world, plumb_body body, plumb_vec2 velocity);
PLUMB_API plumb_status plumb_body_set_angular_velocity(plumb_world* world, plumb_body body, double velocity);
/* Sets the velocities such that it reaches the pose after `dt` s, if nothing stops it. */
PLUMB_API plumb_status plumb_body_move_towards(plumb_world* world, plumb_body body, plumb_pose pose,
                                               double dt);

/* Forces (N) act during the next step, impulses (N s) at once; points in the world, m. */
PLUMB_API plumb_status plumb_body_apply_force(plumb_world* world, plumb_body body, plumb_vec2 force);
PLUMB_API plumb_status plumb_body_apply_force_at(plumb_world* world, plumb_body body, plumb_vec2 force,
                                                 plumb_vec2 point);
PLUMB_API plumb_status plumb_body_apply_torque(plumb_world* world, plumb_body body, double torque);
PLUMB_API plumb_status plumb_body_apply_impulse(plumb_world* world, plumb_body body, plumb_vec2 impulse);
PLUMB_API plumb_status plumb_body_apply_impulse_at(plumb_world* world, plumb_body body, plumb_vec2 impulse,
                                                   plumb_vec2 point);
PLUMB_API plumb_status plumb_body_apply_angular_impulse(plumb_world* world, plumb_body body, double impulse);

PLUMB_API plumb_body_type plumb_body_get_type(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_type(plumb_world* world, plumb_body body, plumb_body_type type);
PLUMB_API double plumb_body_mass(const plumb_world* world, plumb_body body);    /* kg, 0 unless dynamic */
PLUMB_API double plumb_body_inertia(const plumb_world* world, plumb_body body); /* kg m^2 */
PLUMB_API plumb_status plumb_body_set_mass(plumb_world* world, plumb_body body, plumb_mass mass);
PLUMB_API plumb_status plumb_body_use_densities(plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_gravity_scale(plumb_world* world, plumb_body body, double scale);
PLUMB_API double plumb_body_gravity_scale(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_damping(plumb_world* world, plumb_body body, double linear,
                                              double angular);
PLUMB_API double plumb_body_linear_damping(const plumb_world* world, plumb_body body);  /* 1/s */
PLUMB_API double plumb_body_angular_damping(const plumb_world* world, plumb_body body); /* 1/s */
PLUMB_API plumb_status plumb_body_set_locks(plumb_world* world, plumb_body body, bool x, bool y,
                                            bool rotation);
typedef struct plumb_locks {
  bool x, y, rotation;
} plumb_locks;
PLUMB_API plumb_locks plumb_body_locks(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_continuous(plumb_world* world, plumb_body body, bool on);
PLUMB_API bool plumb_body_continuous(const plumb_world* world, plumb_body body);
PLUMB_API bool plumb_body_awake(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_awake(plumb_world* world, plumb_body body, bool awake);
PLUMB_API plumb_status plumb_body_set_may_sleep(plumb_world* world, plumb_body body, bool may_sleep);
PLUMB_API bool plumb_body_may_sleep(const plumb_world* world, plumb_body body);
PLUMB_API uint64_t plumb_body_user_data(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_set_user_data(plumb_world* world, plumb_body body, uint64_t data);
/* NULL: no name. */
PLUMB_API plumb_status plumb_body_set_name(plumb_world* world, plumb_body body, const char* name);
/* Takes a body out of the simulation, or puts it back with its pose and velocity. */
PLUMB_API plumb_status plumb_body_set_enabled(plumb_world* world, plumb_body body, bool enabled);
PLUMB_API bool plumb_body_enabled(const plumb_world* world, plumb_body body);
/* The smallest box around the body's shapes, m. */
PLUMB_API plumb_box_bounds plumb_body_box(const plumb_world* world, plumb_body body);
/* Valid until the body is changed or destroyed; "" if it has none. */
PLUMB_API const char* plumb_body_name(const plumb_world* world, plumb_body body);
PLUMB_API bool plumb_body_quarantined(const plumb_world* world, plumb_body body);
PLUMB_API plumb_status plumb_body_release(plumb_world* world, plumb_body body); /* from quarantine */

/* As for the arrays of all bodies: at most `capacity` are filled in, the whole number is returned. */
PLUMB_API size_t plumb_body_shapes(const plumb_world* world, plumb_body body, plumb_shape* out,
                                   size_t capacity);
PLUMB_API size_t plumb_body_joints(const plumb_world* world, plumb_body body, plumb_joint* out,
                                   size_t capacity);

/* Two touching shapes. */
typedef struct plumb_contact {
  plumb_shape shape_a, shape_b;
  plumb_vec2 normal; /* from a to b */
  int count;
  plumb_vec2 points[2];  /* m */
  double separations[2]; /* m, negative: overlap */
  double impulses[2];    /* N s, along the normal, of the last substep */
  double approach;       /* m/s, along the normal at the start of the step, negative: closing */
  double step_impulse;   /* N s, of the whole step and both points; 0 without hit_events or pre_solve */
} plumb_contact;
PLUMB_API size_t plumb_body_contacts(const plumb_world* world, plumb_body body, plumb_contact* out,
                                     size_t capacity);
PLUMB_API size_t plumb_world_contacts(const plumb_world* world, plumb_contact* out, size_t capacity);
/* Finds the contact of two shapes, in either order; false unless it has points. After a begin event its
 * normal and separations are those at the beginning of the step that made it, and its impulses those of that
 * step. */
PLUMB_API bool plumb_shape_contact(const plumb_world* world, plumb_shape a, plumb_shape b,
                                   plumb_contact* out);

/* ---- Shapes and chains ------------------------------------------------------------------------------- */

PLUMB_API plumb_shape plumb_shape_create(plumb_world* world, plumb_body body,
                                         const plumb_shape_definition* definition);
PLUMB_API plumb_status plumb_shape_destroy(plumb_world* world, plumb_shape shape);
PLUMB_API bool plumb_shape_valid(const plumb_world* world, plumb_shape shape);
PLUMB_API plumb_body plumb_shape_body(const plumb_world* world, plumb_shape shape);
PLUMB_API uint64_t plumb_shape_user_data(const plumb_world* world, plumb_shape shape);
PLUMB_API plumb_material plumb_shape_material(const plumb_world* world, plumb_shape shape);
PLUMB_API plumb_status plumb_shape_set_material(plumb_world* world, plumb_shape shape,
                                                plumb_material material);
/* Replaces the geometry, which lies in the body's frame (m, rad) as in a definition; all else stays. Its
 * contacts end, and begin anew in the next step; the body's mass follows, unless it was given. Refuses
 * segments of chains. */
PLUMB_API plumb_status plumb_shape_set_geometry(plumb_world* world, plumb_shape shape,
                                                const plumb_geometry* geometry, plumb_vec2 position,
                                                double angle);
PLUMB_API plumb_filter plumb_shape_filter(const plumb_world* world, plumb_shape shape);
PLUMB_API plumb_status plumb_shape_set_filter(plumb_world* world, plumb_shape shape, plumb_filter filter);
PLUMB_API plumb_status plumb_shape_set_user_data(plumb_world* world, plumb_shape shape, uint64_t data);
PLUMB_API plumb_status plumb_shape_set_density(plumb_world* world, plumb_shape shape, double density);
PLUMB_API plumb_status plumb_shape_set_sensor(plumb_world* world, plumb_shape shape, bool sensor);
PLUMB_API plumb_status plumb_shape_set_hit_events(plumb_world* world, plumb_shape shape, bool on);
PLUMB_API plumb_status plumb_shape_set_pre_solve(plumb_world* world, plumb_shape shape, bool on);
PLUMB_API plumb_box_bounds plumb_shape_box(const plumb_world* world, plumb_shape shape);
/* The chain of a segment; invalid for other shapes. */
PLUMB_API plumb_chain plumb_shape_chain(const plumb_world* world, plumb_shape shape);
/* One shape alone: no filter is asked. */
PLUMB_API bool plumb_shape_ray_cast(const plumb_world* world, plumb_shape shape, plumb_vec2 origin,
                                    plumb_vec2 translation, double* fraction, plumb_vec2* normal);
PLUMB_API bool plumb_shape_contains(const plumb_world* world, plumb_shape shape, plumb_vec2 point);
PLUMB_API double plumb_shape_density(const plumb_world* world, plumb_shape shape); /* kg/m^2 */
PLUMB_API bool plumb_shape_sensor(const plumb_world* world, plumb_shape shape);
PLUMB_API bool plumb_shape_hit_events(const plumb_world* world, plumb_shape shape);
PLUMB_API bool plumb_shape_pre_solve(const plumb_world* world, plumb_shape shape);
/* Returns the present definition, in the body's frame; a box is a polygon then. The points of a polygon are
 * valid until the next call of this function for the world. */
PLUMB_API plumb_shape_definition plumb_shape_get_definition(const plumb_world* world, plumb_shape shape);
/* Shapes that were in a sensor in the last step. */
PLUMB_API size_t plumb_shape_overlapping(const plumb_world* world, plumb_shape sensor, plumb_shape* out,
                                         size_t capacity);

PLUMB_API plumb_chain plumb_chain_create(plumb_world* world, plumb_body body,
                                         const plumb_chain_definition* definition);
PLUMB_API plumb_status plumb_chain_destroy(plumb_world* world, plumb_chain chain);
PLUMB_API bool plumb_chain_valid(const plumb_world* world, plumb_chain chain);
PLUMB_API plumb_body plumb_chain_body(const plumb_world* world, plumb_chain chain);
PLUMB_API size_t plumb_chain_segments(const plumb_world* world, plumb_chain chain, plumb_shape* out,
                                      size_t capacity);
/* Returns the present definition; its points and materials are valid until the next call of this function or
 * of `plumb_shape_get_definition` for the world. */
PLUMB_API plumb_chain_definition plumb_chain_get_definition(const plumb_world* world, plumb_chain chain);

/* ---- Joints ------------------------------------------------------------------------------------------ */

/* Measurements of a joint. */
typedef struct plumb_joint_reading {
  double force, torque;               /* N, N m: mean reaction over the last step */
  double linear_error, angular_error; /* m, rad: of the rigid rows */
  double angle;                       /* rad, of b relative to a minus the reference angle */
  double translation;                 /* m, along the axis (prismatic, wheel) */
  double length;                      /* m (distance, pulley) */
} plumb_joint_reading;

/* Constants of a joint's springs, 0 where it has none. */
typedef struct plumb_joint_constants {
  double linear, angular;                 /* N/m, N m/rad */
  double linear_damping, angular_damping; /* N s/m, N m s/rad */
} plumb_joint_constants;

PLUMB_API plumb_joint plumb_joint_create(plumb_world* world, plumb_body a, plumb_body b,
                                         const plumb_joint_definition* definition);
PLUMB_API plumb_status plumb_joint_destroy(plumb_world* world, plumb_joint joint);
PLUMB_API bool plumb_joint_valid(const plumb_world* world, plumb_joint joint);
PLUMB_API plumb_joint_definition plumb_joint_get_definition(const plumb_world* world, plumb_joint joint);
/* Sets new speeds, limits and targets and wakes the bodies; the kind may change too. What a joint is at
 * creation alone (collide, breaking, user data) stays. */
PLUMB_API plumb_status plumb_joint_change(plumb_world* world, plumb_joint joint,
                                          const plumb_joint_definition* definition);
PLUMB_API plumb_joint_reading plumb_joint_read(const plumb_world* world, plumb_joint joint);
/* Returns the stiffness and damping of the joint's springs, of the effective mass at the pose in which it was
 * created. Fails with PLUMB_UNSUPPORTED for a joint without springs. */
PLUMB_API plumb_joint_constants plumb_joint_stiffness(const plumb_world* world, plumb_joint joint);
PLUMB_API uint64_t plumb_joint_user_data(const plumb_world* world, plumb_joint joint);
PLUMB_API plumb_status plumb_joint_set_user_data(plumb_world* world, plumb_joint joint, uint64_t data);
/* Loads beyond which the joint is in the events, N and N m; 0: never. */
PLUMB_API plumb_status plumb_joint_set_load_events(plumb_world* world, plumb_joint joint, double force,
                                                   double torque);
PLUMB_API plumb_status plumb_joint_bodies(const plumb_world* world, plumb_joint joint, plumb_body* a,
                                          plumb_body* b);

/* ---- Events ------------------------------------------------------------------------------------------ */

typedef struct plumb_touch_event {
  plumb_shape shape_a, shape_b;
} plumb_touch_event;
typedef struct plumb_hit_event {
  plumb_shape shape_a, shape_b;
  plumb_vec2 point;  /* m */
  plumb_vec2 normal; /* from a to b */
  double speed;      /* m/s, of approach */
  double impulse;    /* N s, of the whole step and all points */
} plumb_hit_event;
typedef struct plumb_sensor_event {
  plumb_shape sensor, visitor;
} plumb_sensor_event;
/* A joint that bore more than the load from which it reports. */
typedef struct plumb_load_event {
  plumb_joint joint;
  double force, torque; /* N, N m: mean reaction over the step */
} plumb_load_event;
typedef struct plumb_quarantine_event {
  plumb_body body;
  const char* field; /* "force", "torque", "velocity" or "angular_velocity" */
  double value;      /* its first invalid component, in SI units */
  int64_t step;      /* from 1 */
} plumb_quarantine_event;

/* Events of the last step and of the time between it and the step before. The arrays belong to the world and
 * are valid until its next step or the next call of `plumb_world_events`. */
typedef struct plumb_events {
  const plumb_touch_event *begin, *end;
  const plumb_hit_event* hits;
  const plumb_sensor_event *sensor_begin, *sensor_end;
  const plumb_joint* broken; /* invalid now */
  const plumb_body *fell_asleep, *woke;
  const plumb_quarantine_event* quarantined;
  size_t begin_count, end_count, hit_count, sensor_begin_count, sensor_end_count, broken_count;
  size_t fell_asleep_count, woke_count, quarantined_count;
  const plumb_load_event* loaded;
  size_t loaded_count;
} plumb_events;
PLUMB_API plumb_events plumb_world_events(plumb_world* world);
/* The bodies in quarantine and their faults, oldest first. */
PLUMB_API size_t plumb_world_quarantined(const plumb_world* world, plumb_quarantine_event* out,
                                         size_t capacity);

/* Called for contacts of shapes with `pre_solve` before they are solved; false disables one in this step. It
 * may read the world and not change it. NULL: no hook. */
typedef bool (*plumb_pre_solve_function)(const plumb_contact* contact, void* context);
PLUMB_API plumb_status plumb_world_on_pre_solve(plumb_world* world, plumb_pre_solve_function hook,
                                                void* context);
/* Called for two shapes that come near each other and that their filters let touch; false: they do not
 * collide. It is called again when one of them has moved on, or after `plumb_shape_set_filter`. It must
 * depend on the world's state alone, and may read it and not change it. Recorded worlds cannot have one.
 * NULL: no filter. */
typedef bool (*plumb_filter_function)(plumb_shape a, plumb_shape b, void* context);
PLUMB_API plumb_status plumb_world_on_filter(plumb_world* world, plumb_filter_function filter, void* context);

/* ---- Queries ----------------------------------------------------------------------------------------- */

/* Sees shapes with a category in its mask, if their mask has one of its categories. */
typedef struct plumb_query_filter {
  uint64_t category, mask;
  bool sensors;                                        /* true: includes sensors */
  plumb_body ignore;                                   /* a body to skip */
  bool (*condition)(plumb_shape shape, void* context); /* tested last; may be NULL */
  void* context;
} plumb_query_filter;
PLUMB_API plumb_query_filter plumb_default_query_filter(void);

typedef struct plumb_ray_hit {
  plumb_shape shape;
  plumb_body body;
  double fraction;   /* of the translation, 0..1 */
  plumb_vec2 point;  /* m, on the surface */
  plumb_vec2 normal; /* unit, outward */
} plumb_ray_hit;
typedef struct plumb_cast_hit {
  plumb_shape shape;
  plumb_body body;
  double fraction;
  plumb_vec2 point;  /* m, on the surface of the shape hit */
  plumb_vec2 normal; /* unit, outward from the shape hit */
  bool overlapped;   /* they overlap before the motion */
} plumb_cast_hit;
typedef struct plumb_nearest_hit {
  plumb_shape shape;
  plumb_body body;
  plumb_vec2 point;  /* m, on the surface */
  plumb_vec2 normal; /* unit, outward */
  double distance;   /* m; negative: depth inside */
} plumb_nearest_hit;
typedef struct plumb_distance_result {
  plumb_vec2 point_a, point_b; /* m, nearest or deepest points */
  plumb_vec2 normal;           /* unit, from a to b */
  double distance;             /* m; negative: overlap */
} plumb_distance_result;

/* Visitors return the fraction up to which to search on: 1 goes on, hit->fraction excludes farther hits, 0
 * stops. */
typedef double (*plumb_ray_visitor)(const plumb_ray_hit* hit, void* context);
typedef double (*plumb_cast_visitor)(const plumb_cast_hit* hit, void* context);

/* `filter` may be NULL, `hit` may not. Functions that return bool say that something was found, and then fill
 * `hit`. */
PLUMB_API bool plumb_ray_cast_closest(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                                      const plumb_query_filter* filter, plumb_ray_hit* hit);
PLUMB_API plumb_status plumb_ray_cast(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                                      const plumb_query_filter* filter, plumb_ray_visitor visit,
                                      void* context);
/* All hits, sorted by fraction. */
PLUMB_API size_t plumb_ray_cast_all(const plumb_world* world, plumb_vec2 origin, plumb_vec2 translation,
                                    const plumb_query_filter* filter, plumb_ray_hit* out, size_t capacity);
PLUMB_API bool plumb_cast_shape_closest(const plumb_world* world, const plumb_geometry* shape,
                                        plumb_pose pose, plumb_vec2 translation,
                                        const plumb_query_filter* filter, plumb_cast_hit* hit);
PLUMB_API plumb_status plumb_cast_shape(const plumb_world* world, const plumb_geometry* shape,
                                        plumb_pose pose, plumb_vec2 translation,
                                        const plumb_query_filter* filter, plumb_cast_visitor visit,
                                        void* context);
PLUMB_API size_t plumb_overlap_shape(const plumb_world* world, const plumb_geometry* shape, plumb_pose pose,
                                     const plumb_query_filter* filter, plumb_shape* out, size_t capacity);
PLUMB_API size_t plumb_overlap_box(const plumb_world* world, plumb_vec2 lower, plumb_vec2 upper,
                                   const plumb_query_filter* filter, plumb_shape* out, size_t capacity);
PLUMB_API size_t plumb_shapes_at(const plumb_world* world, plumb_vec2 point, const plumb_query_filter* filter,
                                 plumb_shape* out, size_t capacity);
PLUMB_API bool plumb_nearest(const plumb_world* world, plumb_vec2 point, double max_distance,
                             const plumb_query_filter* filter, plumb_nearest_hit* hit);
PLUMB_API plumb_distance_result plumb_distance_between(const plumb_world* world, plumb_shape a,
                                                       plumb_shape b);

/* ---- Force laws -------------------------------------------------------------------------------------- */

/* Each call before a step adds the forces of that one step; `dt` is its length, s. Laws act on awake dynamic
 * bodies; with `wakes` on sleeping ones as well, and wake those that they push. A recorded world records the
 * state that they leave. */

typedef struct plumb_law_body {
  plumb_body body;
  plumb_vec2 centre;       /* m, of mass */
  double angle;            /* rad */
  plumb_vec2 velocity;     /* m/s, of the centre of mass */
  double angular_velocity; /* rad/s */
  double mass, inertia;    /* kg, kg m^2 about the centre of mass */
  uint64_t user_data;
} plumb_law_body;
typedef struct plumb_wrench {
  plumb_vec2 force; /* N */
  double torque;    /* N m, about the centre of mass */
} plumb_wrench;
/* Returns the force on a body. It may read the world and not change it; it must return, and not jump out. */
typedef plumb_wrench (*plumb_law_function)(const plumb_law_body* body, void* context);
/* Applies a law of your own. It sees bodies as at the middle of the step, of `dt` s, that follows (slightly
 * earlier for bodies with contacts), which keeps the energy of springs and orbits; with dt = 0 as they are. A
 * body for which it returns a number that is not finite, or beyond 1e12, is quarantined. */
PLUMB_API plumb_status plumb_world_apply_law(plumb_world* world, plumb_law_function law, void* context,
                                             double dt, bool wakes);

/* Applies F = -linear v and torque -angular w, in N s/m and N m s, >= 0. */
PLUMB_API plumb_status plumb_world_apply_linear_drag(plumb_world* world, double linear, double angular,
                                                     double dt, bool wakes);
/* Applies F = -coefficient |v| v, in N s^2/m^2, >= 0. */
PLUMB_API plumb_status plumb_world_apply_quadratic_drag(plumb_world* world, double coefficient, double dt,
                                                        bool wakes);

typedef enum plumb_falloff {
  PLUMB_INVERSE_SQUARE, /* acceleration strength / r^2 */
  PLUMB_LINEAR          /* acceleration strength r */
} plumb_falloff;
typedef struct plumb_attraction {
  double strength; /* m^3/s^2 or 1/s^2; negative repels */
  plumb_falloff falloff;
  double softening; /* m, > 0: below it the inverse square grows linearly from 0 */
} plumb_attraction;
PLUMB_API plumb_attraction plumb_default_attraction(void);
PLUMB_API plumb_status plumb_world_apply_attraction(plumb_world* world, plumb_vec2 centre,
                                                    const plumb_attraction* law, double dt, bool wakes);
/* Attracts to a body's centre of mass; the reaction acts on a dynamic one. */
PLUMB_API plumb_status plumb_world_apply_attraction_to(plumb_world* world, plumb_body centre,
                                                       const plumb_attraction* law, double dt, bool wakes);

typedef struct plumb_wind {
  plumb_vec2 velocity; /* m/s; zero: air at rest, which resists motion */
  double density;      /* kg/m^2, >= 0, of the air, for a depth of 1 m */
} plumb_wind;
PLUMB_API plumb_wind plumb_default_wind(void);
/* Presses on the outlines of all shapes but sensors and chains. */
PLUMB_API plumb_status plumb_world_apply_wind(plumb_world* world, const plumb_wind* wind, double dt,
                                              bool wakes);

/* Water below a plane across gravity. */
typedef struct plumb_water {
  double level;        /* m, of the surface, along "up": y if gravity points down */
  double density;      /* kg/m^2, >= 0 */
  plumb_vec2 velocity; /* m/s, of the current */
  double linear_drag;  /* N s/m for each m^2 under water, >= 0 */
  double angular_drag; /* N m s for each m^2 under water, >= 0 */
} plumb_water;
PLUMB_API plumb_water plumb_default_water(void);
PLUMB_API plumb_status plumb_world_apply_water(plumb_world* world, const plumb_water* water, double dt,
                                               bool wakes);

typedef struct plumb_elastic_spring {
  double stiffness;   /* N/m, >= 0 */
  double damping;     /* N s/m, >= 0 */
  double rest_length; /* m, >= 0 */
  bool pulls_only;    /* a rubber band: slack below its rest length */
} plumb_elastic_spring;
PLUMB_API plumb_elastic_spring plumb_default_elastic_spring(void);
/* Pulls between points of two bodies, in the bodies' frames, without a joint. */
PLUMB_API plumb_status plumb_world_apply_spring(plumb_world* world, plumb_body a, plumb_vec2 point_a,
                                                plumb_body b, plumb_vec2 point_b,
                                                const plumb_elastic_spring* spring, double dt, bool wakes);

typedef struct plumb_blast {
  plumb_vec2 centre;        /* m */
  double radius;            /* m, > 0: its range */
  double impulse;           /* N s for each m of surface square to it, at the centre; 0 at `radius` */
  bool occlusion;           /* spares points that another body covers from the centre */
  plumb_query_filter cover; /* shapes that count as cover */
} plumb_blast;
PLUMB_API plumb_blast plumb_default_blast(void);
/* Applies impulses at once to all dynamic bodies within its radius, sleeping ones too. */
PLUMB_API plumb_status plumb_world_explode(plumb_world* world, const plumb_blast* blast);

/* ---- Character mover --------------------------------------------------------------------------------- */

typedef struct plumb_mover_options {
  plumb_vec2 up;      /* any length but 0 */
  double max_slope;   /* rad, 0..pi/2: steepest ground to stand and walk on */
  double step_height; /* m, >= 0: highest step to climb */
  double skin;        /* m, gap kept to surfaces; 0: a fiftieth of the radius */
  double mass;        /* kg, for pushing dynamic bodies; 0: no pushes */
  double push_force;  /* N, >= 0: largest force on one body */
  plumb_query_filter filter;
} plumb_mover_options;
typedef struct plumb_mover_hit {
  plumb_shape shape;
  plumb_body body;
  plumb_vec2 point;  /* m, on the surface */
  plumb_vec2 normal; /* unit, outward from the shape */
  double impulse;    /* N s, >= 0, for `plumb_apply_pushes` */
} plumb_mover_hit;
typedef struct plumb_mover_result {
  plumb_vec2 position; /* m */
  plumb_vec2 velocity; /* m/s, relative to the ground while it stands */
  bool on_ground, squeezed;
  plumb_vec2 ground_normal; /* unit */
  plumb_body ground;
  plumb_vec2 ground_velocity; /* m/s */
  size_t hit_count;           /* all of them, also beyond the capacity given */
} plumb_mover_result;
PLUMB_API plumb_mover_options plumb_default_mover(void);
/* Moves a capsule by `velocity` for `dt` s, stopped by bodies; before the world's step of the same dt. Fills
 * `hits` up to `capacity`. `options` may be NULL. */
PLUMB_API plumb_mover_result plumb_move(const plumb_world* world, const plumb_geometry* capsule,
                                        plumb_vec2 position, plumb_vec2 velocity, double dt,
                                        const plumb_mover_options* options, plumb_mover_hit* hits,
                                        size_t capacity);
/* Applies the impulses of hits to dynamic bodies; PLUMB_VALUE, and none is applied, if one is negative or not
 * finite. */
PLUMB_API plumb_status plumb_apply_pushes(plumb_world* world, const plumb_mover_hit* hits, size_t count);

/* ---- Snapshots and recordings ------------------------------------------------------------------------ */

/* Saves all that the future depends on: at most `capacity` bytes are filled in, the whole number is
 * returned. Call it with capacity 0 to learn the size. */
PLUMB_API size_t plumb_world_save(const plumb_world* world, void* out, size_t capacity);
/* Restores a snapshot of this precision and version; the world is unchanged if it is refused. */
PLUMB_API plumb_status plumb_world_restore(plumb_world* world, const void* bytes, size_t count);

/* The last states of a world, in memory, for network play: inputs arrive late, and the steps since then are
 * repeated. Nothing allocates once each slot has been used. Handles created after a state are invalid when
 * the world is back there. Create it after `plumb_world_record`, if at all, which moves the world. */
typedef struct plumb_rollback plumb_rollback;
/* Keeps up to `frames` states, 1..10000. The world must outlive it. */
PLUMB_API plumb_rollback* plumb_rollback_create(plumb_world* world, int frames);
PLUMB_API void plumb_rollback_destroy(plumb_rollback* rollback);
/* Saves the present state under its step count, instead of the oldest one if it is full. Drops states of this
 * step and later ones. */
PLUMB_API plumb_status plumb_rollback_save(plumb_rollback* rollback);
/* Restores the state after `step` steps and drops later ones; PLUMB_VALUE if there is none. */
PLUMB_API plumb_status plumb_rollback_back_to(plumb_rollback* rollback, int64_t step);
PLUMB_API bool plumb_rollback_holds(const plumb_rollback* rollback, int64_t step);
PLUMB_API int plumb_rollback_size(const plumb_rollback* rollback);
PLUMB_API int64_t plumb_rollback_oldest(const plumb_rollback* rollback); /* step; -1: it is empty */
PLUMB_API int64_t plumb_rollback_latest(const plumb_rollback* rollback);

/* Writes all further calls to a file, from the present state on. `bodies`: with the hash of each awake body
 * after each step, so that a replay names those that differ. */
PLUMB_API plumb_status plumb_world_record(plumb_world* world, const char* file, bool bodies);

typedef struct plumb_replay_report {
  int calls;
  int64_t steps;
  int64_t first_difference; /* step after which the state differed; -1: none did */
  uint64_t recorded_hash;   /* `plumb_world_hash` after the last step that was compared, as recorded */
  uint64_t hash;            /* the same, of the replay; they are equal unless there is a difference */
  size_t difference_count;  /* bodies that differ then, if they were recorded */
  const char* message; /* a truncated end, a rejected call, a missing hook; else ""; until the next replay
                          of the thread */
} plumb_replay_report;
/* Replays a recording until a step differs, or to its end. */
PLUMB_API plumb_status plumb_replay(const char* file, plumb_precision precision, plumb_replay_report* report);
/* Does the same with the pre-solve hook that the world had; fills in the bodies that differ. */
PLUMB_API plumb_status plumb_replay_with(const char* file, plumb_precision precision,
                                         plumb_pre_solve_function hook, void* context,
                                         plumb_replay_report* report, plumb_body* differing, size_t capacity);

/* ---- Monitor of invariants --------------------------------------------------------------------------- */

/* Checks around each step that joints are closed, that shapes do not overlap and that no energy is gained
 * without a drive. A step with it costs about a tenth more. */
typedef struct plumb_monitor plumb_monitor;
/* Bounds, as fractions of the world's own sizes and energies. */
typedef struct plumb_monitor_bounds {
  double joint_gap; /* of the distance from the anchor to the farther body's centre */
  double overlap;   /* of the smaller shape's extent */
  double energy;    /* gained, of the largest kinetic energy so far */
  int lasting;      /* successive steps for which a bound must be missed */
} plumb_monitor_bounds;
PLUMB_API plumb_monitor_bounds plumb_default_monitor(void);
/* `bounds` may be NULL; negative ones are refused. The world must outlive it. Create it after
 * `plumb_world_record`, if at all. */
PLUMB_API plumb_monitor* plumb_monitor_create(const plumb_world* world, const plumb_monitor_bounds* bounds);
PLUMB_API void plumb_monitor_destroy(plumb_monitor* monitor);
/* Before a step, after the forces of it were applied. */
PLUMB_API plumb_status plumb_monitor_begin_step(plumb_monitor* monitor);
/* After a step that was begun: PLUMB_RUN if a bound was missed for `lasting` steps on end, and the error
 * names it. */
PLUMB_API plumb_status plumb_monitor_end_step(plumb_monitor* monitor);
/* Accepts the present state: after bodies were moved, or a snapshot was restored. */
PLUMB_API plumb_status plumb_monitor_reset(plumb_monitor* monitor);

/* ---- Drawing ----------------------------------------------------------------------------------------- */

/* Poses before a step, for frames that come at other times than steps: keep them before each step, and draw
 * between them and the present ones. From functions that draw between them, destroying them and keeping
 * others sets the error PLUMB_UNSUPPORTED and changes nothing. */
typedef struct plumb_past_poses plumb_past_poses;
PLUMB_API plumb_past_poses* plumb_past_poses_create(void);
PLUMB_API void plumb_past_poses_destroy(plumb_past_poses* past);
PLUMB_API plumb_status plumb_past_poses_keep(plumb_past_poses* past, const plumb_world* world);
/* The poses at `fraction` between the kept ones (0) and the present ones (1), like `plumb_world_poses`;
 * beyond 0 to 1 motions are continued. Bodies created since have their present pose. */
PLUMB_API size_t plumb_past_poses_between(const plumb_past_poses* past, const plumb_world* world,
                                          double fraction, plumb_pose* out, size_t capacity);

/* What an item is; the functions that draw choose its colour. */
typedef enum plumb_draw_role {
  PLUMB_DRAW_STATIC,    /* shapes of static bodies */
  PLUMB_DRAW_KINEMATIC, /* shapes of kinematic bodies */
  PLUMB_DRAW_AWAKE,     /* shapes of awake dynamic bodies */
  PLUMB_DRAW_ASLEEP,    /* shapes of sleeping bodies */
  PLUMB_DRAW_SENSOR,    /* shapes of sensors */
  PLUMB_DRAW_CONTACT,   /* points where shapes touch */
  PLUMB_DRAW_NORMAL,    /* contact normals, from a to b */
  PLUMB_DRAW_IMPULSE,   /* normal impulses of contacts */
  PLUMB_DRAW_BOX,       /* boxes around shapes */
  PLUMB_DRAW_CENTRE,    /* centres of mass, with the body's axes */
  PLUMB_DRAW_JOINT,     /* anchors, and the lines between them */
  PLUMB_DRAW_NAME       /* names of bodies */
} plumb_draw_role;

/* Functions that draw: m, in the world's frame, y up. Those that are NULL are left out. They may read the
 * world; calls that would change it fail with PLUMB_UNSUPPORTED. They must return, and not jump out. */
typedef struct plumb_debug_draw {
  /* A convex polygon, counter-clockwise, rounded by `radius`. */
  void (*polygon)(const plumb_vec2* corners, size_t count, double radius, plumb_draw_role role,
                  void* context);
  /* `axis`: direction of the body's x axis. */
  void (*circle)(plumb_vec2 centre, double radius, plumb_vec2 axis, plumb_draw_role role, void* context);
  void (*capsule)(plumb_vec2 start, plumb_vec2 end, double radius, plumb_draw_role role, void* context);
  void (*segment)(plumb_vec2 start, plumb_vec2 end, plumb_draw_role role, void* context);
  void (*point)(plumb_vec2 point, plumb_draw_role role, void* context);
  void (*text)(plumb_vec2 point, const char* text, plumb_draw_role role, void* context);
  void* context;
} plumb_debug_draw;

/* Items to draw. */
typedef struct plumb_draw_options {
  bool shapes, joints;
  bool contacts, normals, impulses, boxes, centres, names;
  double normal_length;    /* m */
  double impulse_length;   /* m per N s */
  bool bounded;            /* leaves out what certainly lies outside `bounds` */
  plumb_box_bounds bounds; /* m */
} plumb_draw_options;
PLUMB_API plumb_draw_options plumb_default_draw(void); /* shapes and joints */
/* Draws the world after its last step: shapes in the order of their bodies' indices, then the rest. `options`
 * may be NULL. */
PLUMB_API plumb_status plumb_world_draw(const plumb_world* world, const plumb_debug_draw* draw,
                                        const plumb_draw_options* options);
/* Draws it at `fraction` between the kept poses (0) and the present ones (1). */
PLUMB_API plumb_status plumb_world_draw_between(const plumb_world* world, const plumb_past_poses* past,
                                                double fraction, const plumb_debug_draw* draw,
                                                const plumb_draw_options* options);
/* Fills in a picture as SVG, `width` pixels wide, of `options->bounds` or of everything, if `capacity` has
 * room for it. Returns how many bytes it has, with the 0 at its end. */
PLUMB_API size_t plumb_world_svg(const plumb_world* world, const plumb_draw_options* options, int width,
                                 char* out, size_t capacity);

/* ---- Scenes as JSON ---------------------------------------------------------------------------------- */

/* Adds the bodies and joints of a scene (docs/scene.md) to a world; returns how many bodies, and fills their
 * handles in the scene's order up to `capacity`. */
PLUMB_API size_t plumb_world_add_scene(plumb_world* world, const char* json, plumb_body* out,
                                       size_t capacity);

/* A scene that was added to a world: handles of its parts, and its force laws. */
typedef struct plumb_added_scene plumb_added_scene;
/* The definition of a world with the gravity and the combine rules of a scene. */
PLUMB_API plumb_status plumb_scene_world(const char* json, plumb_world_definition* definition);
/* Adds a scene as `plumb_world_add_scene` does; NULL if it is refused. The world must outlive it. */
PLUMB_API plumb_added_scene* plumb_scene_add(plumb_world* world, const char* json);
PLUMB_API void plumb_scene_destroy(plumb_added_scene* scene); /* bodies and joints stay in the world */
/* Handles in the scene's order. */
PLUMB_API size_t plumb_scene_bodies(const plumb_added_scene* scene, plumb_body* out, size_t capacity);
PLUMB_API size_t plumb_scene_joints(const plumb_added_scene* scene, plumb_joint* out, size_t capacity);
/* The static body for joints to the world; invalid if there are none. */
PLUMB_API plumb_body plumb_scene_frame(const plumb_added_scene* scene);
/* Adds the forces of the scene's laws for the next step, of `dt` s, which must be positive. */
PLUMB_API plumb_status plumb_scene_apply_forces(plumb_added_scene* scene, double dt);

typedef enum plumb_method {
  PLUMB_REALTIME, /* a world in fixed steps */
  PLUMB_PRECISE   /* adaptive steps to a tolerance */
} plumb_method;
typedef enum plumb_motion { PLUMB_AUTOMATIC, PLUMB_EXPLICIT, PLUMB_IMPLICIT, PLUMB_SYMPLECTIC } plumb_motion;
typedef enum plumb_on_violation {
  PLUMB_IGNORE, /* no monitor of invariants */
  PLUMB_REPORT, /* goes on; `plumb_simulation_violation` has the first */
  PLUMB_STOP    /* takes the step back and fails with PLUMB_RUN */
} plumb_on_violation;

/* How to step a scene; `plumb_default_realtime` and `plumb_default_precise` make one. */
typedef struct plumb_accuracy {
  plumb_method method;
  double dt; /* s, > 0: of a step; steps of a precise motion may be longer */
  /* Realtime: */
  int substeps;   /* 1..1000 */
  int iterations; /* a substep, 1..1000: sequential impulses and Jakobsen */
  plumb_precision precision;
  plumb_integrator integrator;
  plumb_solver solver;
  bool continuous, sleeping;
  plumb_on_violation on_violation;
  /* Precise: */
  double tolerance; /* local error a step, relative to the scene's own length and speed, > 0 */
  plumb_motion motion;
  bool estimate_error;
} plumb_accuracy;
PLUMB_API plumb_accuracy plumb_default_realtime(void);
PLUMB_API plumb_accuracy plumb_default_precise(void);

typedef struct plumb_statistics {
  int64_t steps, rejected, impacts, evaluations;
  bool error_known;                                   /* the run estimates its error */
  double position_error, angle_error, velocity_error; /* m, rad, m/s */
} plumb_statistics;

typedef struct plumb_simulation plumb_simulation;
PLUMB_API plumb_simulation* plumb_simulation_create(const char* json, const plumb_accuracy* accuracy);
PLUMB_API void plumb_simulation_destroy(plumb_simulation* simulation);
PLUMB_API plumb_status plumb_simulation_step(plumb_simulation* simulation, int count);
PLUMB_API double plumb_simulation_time(const plumb_simulation* simulation); /* s */
PLUMB_API size_t plumb_simulation_body_count(const plumb_simulation* simulation);
/* Index of a body of the scene; -1 and PLUMB_NAME if there is none of that name. */
PLUMB_API int plumb_simulation_find(const plumb_simulation* simulation, const char* name);
PLUMB_API plumb_body_state plumb_simulation_state(const plumb_simulation* simulation, size_t body);
PLUMB_API size_t plumb_simulation_states(const plumb_simulation* simulation, plumb_body_state* out,
                                         size_t capacity);
PLUMB_API plumb_status plumb_simulation_set_state(plumb_simulation* simulation, size_t body,
                                                  plumb_body_state state);
PLUMB_API uint64_t plumb_simulation_hash(const plumb_simulation* simulation);
PLUMB_API size_t plumb_simulation_save(const plumb_simulation* simulation, void* out, size_t capacity);
PLUMB_API plumb_status plumb_simulation_restore(plumb_simulation* simulation, const void* bytes,
                                                size_t count);
PLUMB_API plumb_statistics plumb_simulation_statistics(const plumb_simulation* simulation);
/* The first violation of an invariant as a sentence, valid until the next step; NULL if there is none. */
PLUMB_API const char* plumb_simulation_violation(const plumb_simulation* simulation);

#ifdef __cplusplus
}
#endif

#endif
