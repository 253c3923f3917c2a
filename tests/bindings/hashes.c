/* Prints the hashes of some worlds, in both precisions: the same on every platform. */
#include <inttypes.h>
#include <plumb/plumb.h>
#include <stdio.h>

static plumb_body add(plumb_world* world, double x, double y, double angle, plumb_geometry geometry,
                      double restitution) {
  plumb_body_definition body = plumb_default_body();
  plumb_shape_definition shape = plumb_default_shape();
  body.position.x = x;
  body.position.y = y;
  body.angle = angle;
  shape.geometry = geometry;
  shape.material.restitution = restitution;
  shape.material.rolling_resistance = 0.01;
  return plumb_body_create(world, &body, &shape, 1);
}

static void pyramid(plumb_world* world) {
  for (int row = 0; row < 10; ++row)
    for (int i = 0; i < 10 - row; ++i)
      add(world, i + 0.5 * row - 5, 0.5 + row, 0, plumb_box(1, 1), 0);
  add(world, -15, 4, 0, plumb_circle(0.6), 0.2);
}

static void rain(plumb_world* world) {
  const plumb_vec2 corners[] = {{-0.5, -0.4}, {0.6, -0.3}, {0.4, 0.5}, {-0.3, 0.6}, {-0.6, 0.1}};
  const plumb_vec2 start = {-0.4, 0}, end = {0.4, 0};
  for (int i = 0; i < 150; ++i) {
    const plumb_geometry kinds[] = {plumb_circle(0.4), plumb_box(0.9, 0.6), plumb_capsule(start, end, 0.3),
                                    plumb_polygon(corners, 5, 0.05)};
    add(world, 1.3 * (i % 12) - 8, 2 + 1.1 * (i / 12), 0.37 * i, kinds[i % 4], 0.1 * (i % 5));
  }
}

static void joints(plumb_world* world) {
  for (int row = 0; row < 6; ++row) {
    plumb_body last = add(world, 0, 14 + row, 0, plumb_box(0.8, 0.2), 0);
    for (int i = 1; i < 8; ++i) {
      const plumb_body next = add(world, i, 14 + row, 0, plumb_box(0.8, 0.2), 0);
      plumb_joint_definition joint = plumb_default_joint(row % 2 ? PLUMB_REVOLUTE : PLUMB_WELD);
      joint.anchor_a.x = 0.5;
      joint.anchor_b.x = -0.5;
      if (row % 2) joint.limits.on = true, joint.limits.lower = -0.5, joint.limits.upper = 0.5;
      if (row == 4) joint.angular_spring.on = true, joint.angular_spring.hertz = 3;
      plumb_joint_create(world, last, next, &joint);
      last = next;
    }
  }
}

static void pool(plumb_world* world) {
  plumb_water water = plumb_default_water();
  plumb_wind wind = plumb_default_wind();
  water.level = 3;
  water.density = 2;
  water.linear_drag = 2;
  wind.velocity.x = 3;
  rain(world);
  for (int i = 0; i < 60; ++i) {
    plumb_world_apply_water(world, &water, 1.0 / 60, false);
    plumb_world_apply_wind(world, &wind, 1.0 / 60, false);
    plumb_world_step(world, 1.0 / 60, 4);
  }
}

int main(void) {
  const struct {
    const char* name;
    void (*make)(plumb_world*);
  } scenes[] = {{"pyramid", pyramid}, {"rain", rain}, {"joints", joints}, {"pool", pool}};
  for (int precision = PLUMB_FLOAT; precision <= PLUMB_DOUBLE; ++precision) {
    for (int solver = PLUMB_SOFT_STEPS; solver <= PLUMB_DIRECT; ++solver) {
      for (int scene = 0; scene < 4; ++scene) {
        plumb_world_definition definition = plumb_default_world();
        plumb_body_definition body = plumb_default_body();
        plumb_shape_definition shape = plumb_default_shape();
        definition.precision = precision;
        definition.solver = solver;
        plumb_world* world = plumb_world_create(&definition);
        body.type = PLUMB_STATIC;
        body.position.y = -1;
        shape.geometry = plumb_box(60, 2);
        plumb_body_create(world, &body, &shape, 1);
        scenes[scene].make(world);
        for (int i = 0; i < 120; ++i) plumb_world_step(world, 1.0 / 60, 4);
        printf("%s, precision %d, solver %d: %016" PRIx64 "\n", scenes[scene].name, precision, solver,
               plumb_world_full_hash(world));
        plumb_world_destroy(world);
      }
    }
  }
  const plumb_error error = plumb_last_error();
  if (error.status != PLUMB_OK) fprintf(stderr, "%s\n", error.message);
  return error.status;
}
