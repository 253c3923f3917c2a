/* plumb as an engine behind the process protocol (docs/protocol.md):
 * plumb compare --engine-command "mine=./worker". Scenes run in fixed steps, in double. */
#define _POSIX_C_SOURCE 200809L
#include <plumb/plumb.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char* hello =
    "{\"protocol\":1,\"name\":\"plumb from C\",\"version\":\"%s\",\"precision\":\"double\","
    "\"method\":{\"scheme\":\"soft_step\",\"order\":2,\"epsilon\":2.220446049250313e-16,\"substeps\":4},"
    "\"shapes\":[\"circle\",\"box\"],\"joints\":[\"revolute\",\"distance\"],"
    "\"forces\":[\"linear_drag\",\"quadratic_drag\",\"point_force\",\"torque\",\"spring\",\"attraction\","
    "\"sinusoidal_force\"],\"features\":[\"contacts\",\"filters\",\"kinematic\",\"fixed_rotation\"]}\n";

/* The text after "name": at the top level of a request or of one of its objects; NULL if it is not there. */
static char* member(char* text, const char* name) {
  char quoted[32];
  char* found;
  snprintf(quoted, sizeof quoted, "\"%s\":", name);
  found = strstr(text, quoted);
  return found != NULL ? found + strlen(quoted) : NULL;
}

/* The end of the object at `text`: its braces close there. */
static char* end_of_object(char* text) {
  int depth = 0, in_string = 0;
  for (; *text != '\0'; ++text) {
    if (in_string && *text == '\\') {
      ++text; /* what it escapes */
    } else if (*text == '"') {
      in_string = !in_string;
    } else if (!in_string && *text == '{') {
      ++depth;
    } else if (!in_string && *text == '}' && --depth == 0) {
      return text + 1;
    }
  }
  return text;
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Writes the error of the thread as JSON. */
static void complain(void) {
  const plumb_error error = plumb_last_error();
  printf("{\"%s\":\"", error.status == PLUMB_UNSUPPORTED ? "unsupported" : "error");
  for (const char* letter = error.message; *letter != '\0'; ++letter) {
    if (*letter == '"' || *letter == '\\') putchar('\\');
    if ((unsigned char)*letter >= ' ') putchar(*letter);
  }
  printf("\"}\n");
}

static plumb_simulation* load(char* request) {
  plumb_accuracy accuracy = plumb_default_realtime();
  char* settings = member(request, "settings"); /* a scene has no member of this name */
  char* scene = member(request, "scene");
  const char* substeps = member(settings, "substeps");
  plumb_simulation* simulation;
  accuracy.precision = PLUMB_DOUBLE;
  accuracy.dt = strtod(member(settings, "dt"), NULL);
  if (substeps != NULL) accuracy.substeps = (int)strtol(substeps, NULL, 10);
  *end_of_object(scene) = '\0';
  simulation = plumb_simulation_create(scene, &accuracy);
  if (simulation == NULL) {
    complain();
  } else {
    printf("{\"effective_settings\":{\"dt\":%.17g,\"substeps\":%d,\"sleeping\":\"off\"}}\n", accuracy.dt,
           accuracy.substeps);
  }
  return simulation;
}

static void run(plumb_simulation* simulation, char* request) {
  const long samples = strtol(member(request, "samples"), NULL, 10);
  const int every = (int)strtol(member(request, "every"), NULL, 10);
  const size_t count = plumb_simulation_body_count(simulation);
  plumb_body_state* states = malloc((count + 1) * sizeof *states);
  double spent = 0;
  for (long sample = 0; sample < samples; ++sample) {
    const double begin = seconds();
    if (plumb_simulation_step(simulation, every) != PLUMB_OK) {
      complain();
      free(states);
      return;
    }
    spent += seconds() - begin;
    plumb_simulation_states(simulation, states, count);
    printf("{\"t\":%.17g,\"states\":[", plumb_simulation_time(simulation));
    for (size_t i = 0; i < count; ++i) {
      const plumb_body_state s = states[i];
      printf("%s[%.17g,%.17g,%.17g,%.17g,%.17g,%.17g]", i > 0 ? "," : "", s.position.x, s.position.y, s.angle,
             s.velocity.x, s.velocity.y, s.angular_velocity);
    }
    printf("]}\n");
  }
  printf("{\"done\":true,\"ns\":%.0f}\n", 1e9 * spent);
  free(states);
}

int main(void) {
  plumb_simulation* simulation = NULL;
  char* line = NULL;
  size_t room = 0;
  while (getline(&line, &room, stdin) > 0) {
    const char* request = member(line, "request");
    if (request == NULL || strncmp(request, "\"quit\"", 6) == 0) break;
    plumb_clear_error();
    if (strncmp(request, "\"hello\"", 7) == 0) {
      printf(hello, plumb_version());
    } else if (strncmp(request, "\"load\"", 6) == 0) {
      plumb_simulation_destroy(simulation);
      simulation = load(line);
    } else {
      run(simulation, line);
    }
    fflush(stdout);
  }
  plumb_simulation_destroy(simulation);
  free(line);
  return 0;
}
