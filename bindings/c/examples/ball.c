/* A ball bounces on the ground. */
#include <plumb/plumb.h>
#include <stdio.h>

int main(void) {
  plumb_world* world = plumb_world_create(NULL); /* gravity 9.81 m/s^2 downwards */
  plumb_body_definition body = plumb_default_body();
  plumb_shape_definition shape = plumb_default_shape();

  body.type = PLUMB_STATIC;
  body.position.y = -1;
  shape.geometry = plumb_box(40, 2);
  plumb_body_create(world, &body, &shape, 1);

  body.type = PLUMB_DYNAMIC;
  body.position.y = 4;
  shape.geometry = plumb_circle(0.5);
  shape.material.restitution = 0.8;
  const plumb_body ball = plumb_body_create(world, &body, &shape, 1);

  for (int i = 1; i <= 8; ++i) {
    for (int frame = 0; frame < 15; ++frame) plumb_world_step(world, 1.0 / 60, 4);
    printf("%.2f s: %.2f m\n", plumb_world_time(world), plumb_body_position(world, ball).y);
  }
  plumb_world_destroy(world);

  const plumb_error error = plumb_last_error(); /* of any call above */
  if (error.status != PLUMB_OK) fprintf(stderr, "%s\n", error.message);
  return error.status;
}
