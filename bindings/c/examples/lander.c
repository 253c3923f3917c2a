/* A small game in a terminal: ./lander KEYS, a letter each half second: w up, a left, d right, others none.
 * Touch the ground at less than 2 m/s. The engine is a force law; the world draws itself into letters. */
#include <plumb/plumb.h>
#include <stdio.h>
#include <string.h>

enum { COLUMNS = 60, ROWS = 6 };
typedef struct screen {
  char cells[ROWS][COLUMNS];
} screen;

/* Two columns and one row a metre; the middle of the lowest row but one is at (0, 0.5). */
static void plot(screen* to, double x, double y, char letter) {
  const int column = (int)(COLUMNS / 2 + 2 * x), row = ROWS - 1 - (int)(y + 1);
  if (column >= 0 && column < COLUMNS && row >= 0 && row < ROWS) to->cells[row][column] = letter;
}
static void draw_polygon(const plumb_vec2* corners, size_t count, double radius, plumb_draw_role role,
                         void* context) {
  const int ground = role == PLUMB_DRAW_STATIC; /* its edge is drawn in the row below it */
  (void)radius;
  for (size_t i = 0; i < count; ++i) { /* its edges, in a hundred points each */
    const plumb_vec2 a = corners[i], b = corners[(i + 1) % count];
    for (int k = 0; k < 100; ++k)
      plot(context, a.x + (b.x - a.x) * k / 100, a.y + (b.y - a.y) * k / 100 - 0.5 * ground,
           ground ? '=' : '#');
  }
}

static plumb_wrench engine(const plumb_law_body* body, void* context) {
  const char key = *(const char*)context;
  plumb_wrench thrust = {{0, 0}, 0};
  if (key == 'w') thrust.force.y = 3.2 * body->mass;
  if (key == 'a') thrust.force.x = -3 * body->mass;
  if (key == 'd') thrust.force.x = 3 * body->mass;
  return thrust;
}

int main(int count, char** arguments) {
  const char* keys = count > 1 ? arguments[1] : "dd.aawwwww..w..";
  plumb_world_definition moon = plumb_default_world();
  moon.gravity.y = -1.6;
  moon.thresholds.hit = 0.1; /* slower touches are no hits */
  plumb_world* world = plumb_world_create(&moon);
  plumb_body_definition body = plumb_default_body();
  plumb_shape_definition shape = plumb_default_shape();
  body.type = PLUMB_STATIC;
  shape.geometry = plumb_box(40, 1);
  body.position.y = -0.5;
  plumb_body_create(world, &body, &shape, 1);
  body.type = PLUMB_DYNAMIC;
  body.position.x = -8;
  body.position.y = 12;
  shape.geometry = plumb_box(2, 1);
  shape.hit_events = true;
  const plumb_body ship = plumb_body_create(world, &body, &shape, 1);

  double hardest = 0; /* m/s */
  for (const char* key = keys; *key != '\0'; ++key) {
    for (int frame = 0; frame < 30; ++frame) {
      plumb_world_apply_law(world, engine, (void*)key, 1.0 / 60, true);
      plumb_world_step(world, 1.0 / 60, 4);
      const plumb_events events = plumb_world_events(world);
      for (size_t i = 0; i < events.hit_count; ++i)
        if (events.hits[i].speed > hardest) hardest = events.hits[i].speed;
    }
    const plumb_body_state now = plumb_body_get_state(world, ship);
    printf("%c %4.1f s: at %4.1f m, %4.1f m high, %4.1f m/s\n", *key, plumb_world_time(world), now.position.x,
           now.position.y, now.velocity.y);
  }

  screen picture;
  memset(&picture, ' ', sizeof picture);
  plumb_debug_draw draw = {0}; /* what is not set is not drawn */
  draw.polygon = draw_polygon;
  draw.context = &picture;
  plumb_world_draw(world, &draw, NULL);
  for (int row = 0; row < ROWS; ++row) printf("|%.*s|\n", COLUMNS, picture.cells[row]);
  printf(hardest > 2 ? "crashed at %.1f m/s\n" : "landed at %.1f m/s\n", hardest);
  plumb_world_destroy(world);

  const plumb_error error = plumb_last_error();
  if (error.status != PLUMB_OK) fprintf(stderr, "%s\n", error.message);
  return error.status;
}
