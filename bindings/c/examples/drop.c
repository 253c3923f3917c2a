/* Drops a box, casts a ray at it, saves, goes on, restores and goes on again: the same hash both times. */
#include <inttypes.h>
#include <plumb/plumb.h>
#include <stdio.h>
#include <stdlib.h>

static plumb_body add_box(plumb_world* world, plumb_body_type type, plumb_pose pose, double width,
                          double height) {
  plumb_body_definition body = plumb_default_body();
  plumb_shape_definition shape = plumb_default_shape();
  body.type = type;
  body.position = pose.position;
  body.angle = pose.angle;
  shape.geometry = plumb_box(width, height);
  return plumb_body_create(world, &body, &shape, 1);
}

static void step(plumb_world* world, int count) {
  for (int i = 0; i < count; ++i) plumb_world_step(world, 1.0 / 60, 4);
}

int main(void) {
  const plumb_pose below = {{0, -1}, 0}, above = {{0, 4}, 0.3};
  const plumb_vec2 sky = {0, 10}, down = {0, -20};
  plumb_world* world = plumb_world_create(NULL);
  add_box(world, PLUMB_STATIC, below, 40, 2);
  const plumb_body box = add_box(world, PLUMB_DYNAMIC, above, 1, 1);
  step(world, 60);

  plumb_ray_hit hit;
  if (plumb_ray_cast_closest(world, sky, down, NULL, &hit)) printf("the ray hits at %.6f m\n", hit.point.y);

  const size_t size = plumb_world_save(world, NULL, 0);
  void* saved = malloc(size);
  plumb_world_save(world, saved, size);
  step(world, 60);
  const uint64_t hash = plumb_world_hash(world);
  printf("the box is at %.6f m, hash %016" PRIx64 "\n", plumb_body_position(world, box).y, hash);

  plumb_world_restore(world, saved, size);
  step(world, 60);
  printf("restored: %s\n", plumb_world_hash(world) == hash ? "the same hash" : "another hash");
  free(saved);
  plumb_world_destroy(world);

  const plumb_error error = plumb_last_error();
  if (error.status != PLUMB_OK) fprintf(stderr, "%s\n", error.message);
  return error.status == PLUMB_OK ? 0 : 1;
}
