// The learner's engine as a program of its own: `plumb_course_student [MISTAKE]`.
#include "harness/course/student/student.h"
#include "reference/support/serve.h"

int main(int count, char** arguments) {
  return plumb::reference::serve(*plumb::course::make_student(count > 1 ? arguments[1] : ""));
}
